//! What the input does between its samples, where the record is not sure of it: of two answers the simpler.

use super::ALIKE;
use crate::verdict::{Discovery, Verdict};
use identify::{
    Hold,
    effects::{Kind, LAWS},
    fit::hold,
};
use std::cmp::Ordering;

/// The other way between samples, if beside the model that was `found` with one the record speaks for it; or for neither
/// where something is found that the wrong one of the two may have asked for; and wherever something is left.
pub(super) fn other_hold(found: &Discovery, hold: Hold, again: Option<hold::Told>) -> Option<Hold> {
    let again = again?;
    let other = if hold == Hold::Linear { Hold::ZeroOrder } else { Hold::Linear };
    let asked = match (found.verdict, found.effects.as_slice()) {
        (Verdict::NothingMissing | Verdict::Parameter, _) => false,
        // A model that lacks more is no witness.
        (Verdict::Partial | Verdict::NotInLibrary, _) => return Some(other),
        (Verdict::Effect, [only]) => only.set.iter().any(|name| comes_late(name)),
        (Verdict::Effect, _) => true,
    };
    (again.hold == other || asked && !again.sure).then_some(other)
}

/// Whether an effect may be half a sample that an input comes late by, or what makes up for it: what is confused with a
/// delay, and what stands between motor and load.
fn comes_late(name: &str) -> bool {
    let Some(kind) = LAWS.iter().find(|kind| kind.about().name == name) else { return false };
    let delay = Kind::InputDelay.about();
    name == delay.name || delay.confused.contains(&name) || !kind.tried().is_empty()
}

/// Whether an answer leaves less than another, or as much with fewer effects.
pub(super) fn simpler(one: &Discovery, other: &Discovery) -> bool {
    let [own, its] = [one, other].map(|found| found.chi_squared[2]);
    let [few, many] = [one, other].map(|found| found.rig.effects.len());
    match few.cmp(&many) {
        Ordering::Less => own < ALIKE * its,
        Ordering::Equal => own < its,
        Ordering::Greater => ALIKE * own < its,
    }
}

#[cfg(test)]
mod tests {
    use super::{Discovery, Hold, Verdict, hold::Told, other_hold, simpler};
    use crate::{verdict::Found, walk::made};

    /// An answer with so many effects that leaves so much.
    fn answer(effects: usize, left: f64) -> Discovery {
        let mut rig = made::rig(2.0);
        let bias = made::with(&rig, identify::effects::Kind::CurrentBias, &[made::BIAS]);
        rig.effects = vec![bias.effects[0].clone(); effects];
        Discovery {
            verdict: Verdict::Effect,
            parameters: Vec::new(),
            effects: Vec::new(),
            gap: Vec::new(),
            shares: Vec::new(),
            map: None,
            tone: None,
            ranking: Vec::new(),
            detectability: Vec::new(),
            chi_squared: [9.0, 9.0, left],
            hold: None,
            rig,
        }
    }

    #[test]
    fn the_other_way_between_samples_is_tried_where_the_record_may_speak_for_it() {
        let found = |verdict: Verdict| Discovery { verdict, ..answer(1, 1.0) };
        let told = |hold: Hold, sure: bool| Some(Told { hold, sure });
        let (line, step) = (Hold::Linear, Hold::ZeroOrder);
        let named = |name: &'static str| {
            let (values, separated_by) = (Vec::new(), String::new());
            let only = Found { name, set: vec![name], values, shrink: 1.0, t: 9.0, separated_by };
            Discovery { effects: vec![only], ..found(Verdict::Effect) }
        };
        let effect = named("viscous");
        assert_eq!(other_hold(&effect, line, told(step, true)), Some(step), "it says so");
        assert_eq!(other_hold(&effect, line, told(line, false)), Some(step), "it is not sure");
        assert_eq!(other_hold(&effect, step, told(step, true)), None);
        let wave = named("cogging");
        assert_eq!(other_hold(&wave, line, told(step, true)), Some(step), "it says so");
        assert_eq!(other_hold(&wave, line, told(line, false)), None, "no time asks for a wave");
        let more = found(Verdict::Partial);
        assert_eq!(other_hold(&more, line, told(line, true)), Some(step), "something is left");
        let nothing = found(Verdict::NothingMissing);
        assert_eq!(other_hold(&nothing, line, told(line, false)), None, "nothing asks for it");
    }

    #[test]
    fn of_two_ways_between_samples_the_one_that_asks_for_fewer_effects_is_right() {
        assert!(simpler(&answer(1, 1.0), &answer(2, 0.95)));
        assert!(!simpler(&answer(1, 1.2), &answer(2, 0.95)), "but not where more is left");
        assert!(simpler(&answer(1, 0.9), &answer(1, 0.95)));
        assert!(
            !simpler(&answer(2, 0.92), &answer(1, 1.0))
                && simpler(&answer(2, 0.8), &answer(1, 1.0))
        );
    }
}
