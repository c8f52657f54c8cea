//! The scale of all forces, where the record does not tell it.
//!
//! With what drives, the mass and all forces free, twice as much of each moves alike. A fit then goes anywhere along that, and
//! no value is told, though their ratios are: which of them is wrong, and how large an effect is, is told against what drives.

use super::{Board, DRIVES, Fitted};
use crate::gram::{Gram, spreads};
use identify::{Rig, fit::FitError};

/// A value of which the record tells no more than this, in its logarithm, is better known as it was given.
const UNTOLD: f64 = 0.1;

impl Board<'_> {
    /// What a unit of the input gives, where it is free in `rig` and a model `fitted` to the record does not tell it: its name and
    /// given value.
    pub(crate) fn untold(
        &self,
        rig: &Rig,
        fitted: &Fitted,
    ) -> Result<Option<(String, f64)>, FitError> {
        let free = |key: &&&str| rig.free.iter().any(|free| free == **key);
        let Some(drive) = DRIVES.iter().find(free) else { return Ok(None) };
        let Some(given) = rig.value(drive).filter(|v| *v > 0.0) else { return Ok(None) };
        let gram = Gram::alone(self, fitted)?;
        let Some(place) = gram.names.iter().position(|name| name == drive) else { return Ok(None) };
        let mut sum = gram.sum(|_| true).view((0, 0), (gram.nominal, gram.nominal)).into_owned();
        for (i, name) in gram.names.iter().enumerate() {
            if self.holds(name) {
                sum[(i, i)] += gram.prior[i];
            }
        }
        let level = self.trained_level(fitted).max(1.0);
        let spread = spreads(&sum)[place] * level.sqrt();
        Ok((spread > UNTOLD).then(|| ((*drive).to_owned(), given)))
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        board::Board,
        discover,
        verdict::{Options, Verdict},
        walk::made,
    };
    use identify::{
        Rig,
        fit::{Data, binding},
    };

    /// A slide of 2 kg with a drag of 0.5 N·s/m on a motor of 4 N/V, of which all is free.
    fn slide() -> Rig {
        let text = "title = \"a slide\"\n[plant]\nkind = \"axis\"\ninertia = 2.0\ngain = 4.0\n\
                    [friction]\nname = \"none\"\nsigma_2 = 0.5\n\
                    [fit]\nfree = [\"inertia\", \"gain\", \"sigma_2\"]\n\
                    [channels]\ntime = \"t\"\nvoltage = \"u\"\nposition = \"x\"\n";
        Rig::parse(text).expect("a rig")
    }

    /// Its record: x = sin 2t + 0.4 sin 5t.
    fn data() -> Data {
        let mut data = made::data();
        let seen = data.displacement.as_mut().expect("it is seen");
        for ((x, u), t) in seen.values.iter_mut().zip(&mut data.input).zip(&data.time) {
            let ((s, c), (s_2, c_2)) = (f64::sin_cos(2.0 * t), f64::sin_cos(5.0 * t));
            *x += 0.4 * s_2;
            *u = (2.0 * (-4.0 * s - 10.0 * s_2) + 0.5 * (2.0 * c + 2.0 * c_2)) / 4.0;
        }
        data
    }

    /// What is said to be wrong where this was given, and what comes of the motor.
    fn wrong(given: (&str, f64)) -> (Vec<String>, f64) {
        let mut rig = slide();
        binding::set(&mut rig, given.0, given.1);
        let found = discover(&rig, &data(), &Options::default()).unwrap();
        let moved = found.parameters.iter().filter(|p| p.moved).map(|p| p.found.name.clone());
        let moved: Vec<String> = moved.collect();
        assert_eq!(found.verdict == Verdict::Parameter, !moved.is_empty());
        (moved, found.rig.value("gain").unwrap())
    }

    #[test]
    fn what_drives_is_not_told_beside_all_that_it_drives() {
        let (rig, data) = (slide(), data());
        let told = |free: &[&str]| {
            let rig = Rig { free: free.iter().map(|f| (*f).to_owned()).collect(), ..rig.clone() };
            let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
            board.untold(&rig, &board.judged(&rig, None).unwrap()).unwrap()
        };
        assert_eq!(told(&["inertia", "gain", "sigma_2"]), Some(("gain".to_owned(), 4.0)));
        assert_eq!(told(&["gain", "sigma_2"]), None, "the mass is the scale");
        assert_eq!(told(&["inertia", "sigma_2"]), None);
    }

    #[test]
    fn of_what_scales_alike_the_one_that_is_wrong_is_told() {
        let (moved, gain) = wrong(("sigma_2", 0.8));
        assert_eq!(moved, ["sigma_2"]);
        assert!((gain / 4.0 - 1.0).abs() < 0.02, "{gain} N/V");
        let (moved, gain) = wrong(("gain", 5.6));
        assert_eq!(moved, ["gain"]);
        assert!((gain / 4.0 - 1.0).abs() < 0.03, "{gain} N/V");
        assert!(wrong(("inertia", 2.03)).0.is_empty(), "nominal values are off as much");
    }
}
