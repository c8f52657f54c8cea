//! A level of friction that drifts has no one value: what is given may be that of any time of the record.

use super::{Walk, answer::WRONG};
use crate::verdict::Value;

/// The effect, and what it takes along.
const NAME: &str = "friction_drift";
const LEVELS: [&str; 6] = ["f_c", "f_s", "sigma", "sigma_0", "k[", "delta["];

impl Walk<'_> {
    /// Whether the last model's friction drifts, and a value that is of its levels comes near the one that was `given` on the
    /// way: the model tells that at the record's begin, a rig file may tell that of the warm plant.
    pub(super) fn drifts_past(&self, found: &Value, given: f64) -> bool {
        let own = |level: &&str| {
            found.name == **level || level.ends_with('[') && found.name.starts_with(*level)
        };
        let of = |key: &str| self.best.rig.value(&format!("{NAME}.{key}"));
        let (Some(amount), Some(tau)) = (of("amount"), of("tau")) else { return false };
        let time = &self.board.data.time;
        let long = time.last().copied().unwrap_or(0.0) - time.first().copied().unwrap_or(0.0);
        let grows = 1.0 + amount * (1.0 - (-long / tau).exp());
        let [low, high] =
            [f64::min(1.0, grows), f64::max(1.0, grows)].map(|share| share * found.value);
        LEVELS.iter().any(own) && given > low * (1.0 - WRONG) && given < high * (1.0 + WRONG)
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        verdict::Value,
        walk::made::{data, rig, walk, with},
    };
    use identify::effects::Kind;

    #[test]
    fn a_level_that_drifts_is_given_as_at_any_time_of_the_record() {
        let data = data();
        let mut walk = walk(&rig(2.0), &data, &[]);
        let value = |name: &str| Value {
            name: name.to_owned(),
            value: 1.5,
            standard_error: 1e-3,
            unit: "N",
        };
        assert!(!walk.drifts_past(&value("f_c"), 1.3), "nothing drifts");
        // From 1.5 N down by a fifth.
        walk.best.rig = with(&walk.best.rig, Kind::FrictionDrift, &[-0.2, 0.5]);
        for (given, there) in
            [(1.6, true), (1.5, true), (1.3, true), (1.2, true), (1.05, false), (1.7, false)]
        {
            assert_eq!(walk.drifts_past(&value("f_c"), given), there, "{given} N");
        }
        assert!(!walk.drifts_past(&value("sigma_2"), 1.3) && walk.drifts_past(&value("k[2]"), 1.3));
    }
}
