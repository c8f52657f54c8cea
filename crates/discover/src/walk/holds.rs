//! What the input does between its samples, where the record is not sure of it: of two answers the simpler.

use super::ALIKE;
use crate::verdict::{Discovery, Verdict};
use identify::{Hold, fit::hold};
use std::cmp::Ordering;

/// The other way between samples, if beside the model that was `found` with one the record speaks for it; or for neither
/// where something is found, which the wrong one of the two may have asked for.
pub(super) fn other_hold(found: &Discovery, hold: Hold, again: Option<hold::Told>) -> Option<Hold> {
    let again = again?;
    let other = if hold == Hold::Linear { Hold::ZeroOrder } else { Hold::Linear };
    let asked = !matches!(found.verdict, Verdict::NothingMissing | Verdict::Parameter);
    (again.hold == other || asked && !again.sure).then_some(other)
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
    use crate::walk::made;

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
        let effect = found(Verdict::Effect);
        assert_eq!(other_hold(&effect, line, told(step, true)), Some(step), "it says so");
        assert_eq!(other_hold(&effect, line, told(line, false)), Some(step), "it is not sure");
        assert_eq!(other_hold(&effect, step, told(step, true)), None);
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
