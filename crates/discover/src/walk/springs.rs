//! More springs that slip, where one was found and does not do.

use super::{ABOVE, FIRST, Walk, settled};
use crate::board::Fitted;
use identify::{
    Rig,
    fit::{FitError, binding},
};

/// The effect, and its springs beyond the first.
const NAME: &str = "maxwell_slip";
const MORE: [usize; 3] = [2, 3, 4];

/// A further spring slips so many times as late as the first, and as hard.
const LATER: [f64; 4] = [0.1, 0.3, 3.0, 10.0];
const HARD: f64 = 0.3;

/// It must lower the level to so much of what it was; where more than so many floors are left, a spring that does little
/// alone may be the one that makes room for the next: of Dahl's friction in the place of four springs the third took a
/// fourteenth of 37 floors, and the fourth came down to the floor.
const LOWER: f64 = 0.9;
const FAR: f64 = 3.0;
const LITTLE_LOWER: f64 = 0.97;

impl Walk<'_> {
    /// Gives springs that slip one more, and then another, for as long as the model comes much nearer with it.
    pub(super) fn more_springs(&mut self, seed: u64) -> Result<(), FitError> {
        for number in MORE {
            let level = |walk: &Self| walk.judged(&walk.best.blocks).level();
            let now = level(self);
            let rig = &self.best.rig;
            if rig.free.contains(&format!("{NAME}.share_{number}")) {
                continue;
            }
            if now < ABOVE || !rig.effects.iter().any(|effect| effect.name == NAME) {
                break;
            }
            let lower = now * if now > FAR { LITTLE_LOWER } else { LOWER };
            let all = LATER.map(|later| with(rig, number, later));
            let fitted = all.iter().filter_map(|rig| self.board.fit(rig, None, &FIRST).ok());
            let near = |fitted: &Fitted| self.judged(&fitted.blocks).level();
            let Some(best) = fitted.min_by(|a, b| near(a).total_cmp(&near(b))) else { break };
            if near(&best) > lower {
                break;
            }
            let before = (self.board.clone(), self.best.clone());
            self.best = settled(&mut self.board, best, seed)?;
            if level(self) > lower {
                (self.board, self.best) = before;
                break;
            }
        }
        Ok(())
    }
}

/// `rig` with a spring more, which slips `later` than the first.
fn with(rig: &Rig, number: usize, later: f64) -> Rig {
    let mut with = rig.clone();
    let delta = rig.value(&format!("{NAME}.delta")).unwrap_or(1.0);
    for (key, value) in [("share", HARD / later), ("delta", delta * later)] {
        let name = format!("{NAME}.{key}_{number}");
        binding::set(&mut with, &name, value);
        if !with.free.contains(&name) {
            with.free.push(name);
        }
    }
    with
}

#[cfg(test)]
mod tests {
    use super::with;
    use crate::walk::made;
    use identify::effects::Kind;

    #[test]
    fn a_further_spring_is_free_and_slips_later_or_earlier_than_the_first() {
        let mut rig = made::rig(2.0);
        rig.effects.push(identify::Effect {
            name: "maxwell_slip".to_owned(),
            values: Kind::MaxwellSlip
                .about()
                .keys
                .iter()
                .map(|k| (k.name.to_owned(), k.usual.unwrap_or(0.5)))
                .collect(),
        });
        let with = with(&rig, 2, 3.0);
        assert_eq!(with.value("maxwell_slip.delta_2"), Some(1.5));
        // It breaks at 0.3 of the first one's force.
        assert_eq!(with.value("maxwell_slip.share_2"), Some(super::HARD / 3.0));
        let free = ["maxwell_slip.share_2", "maxwell_slip.delta_2"].map(str::to_owned);
        assert!(
            free.iter().all(|name| with.free.contains(name))
                && rig.free.len() + 2 == with.free.len()
        );
    }
}
