//! The two plain parts of friction together, where no friction is told of: each alone is far from what both leave.

use super::{
    REFIT, Walk,
    named::{LEAST, NOTHING, SURE},
};
use crate::{
    board::Fitted,
    decide::{Judged, shrink},
    gram,
    verdict::Found,
};
use identify::{
    Rig,
    effects::{Context, Kind},
    fit::{FitError, binding, search::Patience},
};

/// Dry and viscous friction are begun at so much of what drives the plant, at rest and at its largest speed.
const BEGUN: [f64; 3] = [0.01, 0.05, 0.25];

/// After so many simulations so many are left.
const HEATS: [(usize, usize); 2] = [(2, 4), (6, 1)];

/// Enough to come near on short windows.
const NEAR: Patience = Patience { misfit: 20.0, share: 2e-3, simulations: 16 };

/// Drag that stops growing at less than this of the largest speed is dry friction, and two parts of friction are plainer
/// than its law even where they leave so many times as much.
const AT_ONCE: f64 = 0.01;
const PLAINER: f64 = 2.0;

impl Walk<'_> {
    /// Whether no friction is told of.
    pub(super) fn bare(&self) -> bool {
        self.given.friction.name == "none" && self.given.friction.sigma_2 == 0.0
    }

    /// The plain parts of friction in place of the one effect that was `found` beside the model `before`, or of none, if
    /// they leave less and neither is enough; else what was found.
    pub(super) fn plain(
        &mut self,
        found: Option<&Found>,
        context: &Context,
        before: &Fitted,
    ) -> Result<Vec<Found>, FitError> {
        let one = || found.into_iter().cloned().collect::<Vec<Found>>();
        let [now, there] = [before, &self.best].map(|fitted| self.judged(&fitted.blocks));
        if there.level() < NOTHING {
            return Ok(one());
        }
        let rigs: Vec<(Kind, Rig)> = BEGUN
            .iter()
            .flat_map(|dry| BEGUN.map(|wet| (Kind::Coulomb, self.rubbing([*dry, wet], context))))
            .collect();
        let near = self.short.raced(&rigs, &HEATS, &NEAR).into_iter().next();
        let Some((_, _, near)) = near else { return Ok(one()) };
        let both = self.board.fit(&near, None, &REFIT)?;
        let left = self.judged(&both.blocks);
        let dry = |found: &Found| {
            let bends = self.best.rig.value("sublinear_drag.v_0").unwrap_or(f64::INFINITY);
            found.name == "sublinear_drag" && bends < AT_ONCE * context.speed
        };
        let most = if found.is_some_and(dry) { PLAINER } else { 1.0 };
        if left.level() > most * there.level() || now.gained(&left) < LEAST {
            return Ok(one());
        }
        let mut parts = Vec::new();
        for kind in [Kind::Coulomb, Kind::Viscous] {
            let alone = self.judged(&self.without(&both, kind.about().name)?.blocks);
            let t = alone.against(&left);
            if t < SURE && alone.level() < PLAINER * left.level() {
                return Ok(one());
            }
            parts.push((alone.level(), part(kind, [&alone, &left], t)));
        }
        // What is missed most goes first.
        parts.sort_by(|a, b| b.0.total_cmp(&a.0));
        self.best = both;
        Ok(parts.into_iter().map(|(_, found)| found).collect())
    }

    /// The model before its refit with dry and viscous friction that take so much of the drive.
    fn rubbing(&self, [dry, wet]: [f64; 2], context: &Context) -> Rig {
        let mut rig = self.origin.rig.clone();
        gram::with(&mut rig, Kind::Coulomb, &[], 0);
        gram::with(&mut rig, Kind::Viscous, &[], 0);
        binding::set(&mut rig, "coulomb.f_c", dry * context.drive);
        binding::set(&mut rig, "viscous.sigma_2", wet * context.drive / context.speed);
        rig
    }
}

/// A part of friction as it is found beside the other: of what that leaves `alone` so much is gone with both.
pub(super) fn part(kind: Kind, [alone, left]: [&Judged; 2], t: f64) -> Found {
    let name = kind.about().name;
    Found {
        name,
        set: vec![name],
        values: Vec::new(),
        shrink: shrink(alone.level(), left.level()),
        t,
        separated_by: String::new(),
    }
}

#[cfg(test)]
mod tests {
    use crate::walk::made::{context, rig, walk};
    use identify::{
        Hold, Rig,
        fit::{Data, Seen},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// x = sin 2t of 2 kg on 3 N/m, rubbed by f_c sgn v + sigma_2 v; noise of 1 mm.
    fn rubbed(f_c: f64, sigma_2: f64) -> Data {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let input = time.iter().map(|t| {
            let (s, c) = f64::sin_cos(2.0 * t);
            (3.0 - 2.0 * 4.0) * s + 2.0 * sigma_2 * c + f_c * c.signum()
        });
        let input = input.collect();
        let seen = time.iter().map(|t| (2.0 * t).sin() + 1e-3 * noise()).collect();
        Data::driven(time, input, Hold::Linear, Seen::new("position", seen, 0.0))
    }

    /// The rig without any friction.
    fn bare() -> Rig {
        let mut rig = rig(2.0);
        rig.friction.sigma_2 = 0.0;
        rig
    }

    #[test]
    fn both_parts_of_friction_are_found_where_each_alone_is_far_off() {
        let data = rubbed(0.8, 0.6);
        let mut walk = walk(&bare(), &data, &[]);
        let (context, before) = (context(&walk), walk.best.clone());
        let found = walk.plain(None, &context, &before).unwrap();
        let mut names: Vec<&str> = found.iter().map(|found| found.name).collect();
        names.sort_unstable();
        assert_eq!(names, ["coulomb", "viscous"]);
        let value = |name: &str| walk.best.rig.value(name).unwrap();
        let (dry, wet) = (value("coulomb.f_c"), value("viscous.sigma_2"));
        assert!((dry - 0.8).abs() < 0.02 && (wet - 0.6).abs() < 0.02, "{dry} N, {wet} N·s/m");
        assert!(found.iter().all(|found| found.shrink > 0.5), "{found:?}");
    }

    #[test]
    fn one_part_of_friction_that_is_enough_stays_alone() {
        let data = rubbed(0.8, 0.0);
        let mut walk = walk(&bare(), &data, &[]);
        let (context, before) = (context(&walk), walk.best.clone());
        assert!(walk.plain(None, &context, &before).unwrap().is_empty());
        assert!(walk.best.rig.effects.is_empty());
    }
}
