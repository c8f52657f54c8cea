//! A given value that is not free, and wrong by itself.

use super::{
    FIRST, Walk,
    answer::{MORE, WRONG, surely_worse},
    exchange::kind_of,
    named::{LEAST, TELLS, numbers},
};
use crate::{
    board::{Board, Fitted, OFFSET},
    verdict::Found,
};
use identify::{Rig, fit::FitError};
use rayon::prelude::*;
use std::mem;

/// Where a free value goes further than this, in its logarithm, the given one is not wrong by itself: a radius twice as large
/// with springs half as stiff is what the record does not tell.
const TOO_FAR: f64 = 0.3;

/// An effect of so many numbers is as simple as a wrong value.
const SIMPLE: usize = 1;

impl Walk<'_> {
    /// The model without effects in which one given value that is not free is another one, if it is surely no worse than the
    /// last model and that has more numbers, or leaves more than noise. It takes that one's place, its effects go.
    ///
    /// Such a value looks like whatever acts as it does: a level of friction that is too high like one that wears off within
    /// a moment.
    pub(super) fn wrong_given(
        &mut self,
        rig: &Rig,
        effects: &mut Vec<Found>,
    ) -> Result<Option<Fitted>, FitError> {
        let many: usize = effects.iter().filter_map(|e| kind_of(e.name)).map(numbers).sum();
        if many <= SIMPLE && self.leaves(&self.best) < MORE {
            return Ok(None);
        }
        let one = |name: &String| {
            let loose = self.besides(name);
            let board = Board { loose: loose.clone(), ..self.board.clone() };
            let freed = Rig { free: all_free(rig, &loose, name), ..rig.clone() };
            let short = Board { loose, ..self.short.clone() };
            let short = Some(short).filter(|short| !short.imposed());
            let fitted = board.refit(&freed, short.as_ref(), &FIRST).ok()?;
            let alone = board.strayed(&fitted).is_empty() && is_far(&fitted.rig, rig, name);
            alone.then(|| (name.clone(), fitted))
        };
        let names = told(rig, &self.off());
        let mut all: Vec<(String, Fitted)> = names.par_iter().filter_map(one).collect();
        let level = |fitted: &Fitted| self.judged(&fitted.blocks).level();
        all.sort_by(|a, b| level(&a.1).total_cmp(&level(&b.1)));
        // Of two that scale the drive alike the nearer may ask for more than its own.
        for (name, fitted) in all {
            if let Some(fitted) = self.wrong_alone(rig, &name, fitted)? {
                effects.clear();
                return Ok(Some(fitted));
            }
        }
        Ok(None)
    }

    /// The model in which the value of this name is wrong, at its end, if nothing else is and it is no worse than the
    /// last one, whose place it takes.
    fn wrong_alone(
        &mut self,
        rig: &Rig,
        name: &str,
        fitted: Fitted,
    ) -> Result<Option<Fitted>, FitError> {
        let loose = self.besides(name);
        let before = mem::replace(&mut self.board.loose, loose);
        let fitted = self.ended(fitted)?;
        let (with, last) = (self.judged(&fitted.blocks), self.judged(&self.best.blocks));
        // What is worth fewer squared standard errors is no effect, however surely it is told: where windows start may be it.
        let told = || with.gained(&last) > LEAST && self.evidence(&fitted, &self.best) > TELLS;
        let worse = surely_worse(&with, &last) || told();
        let mut others = rig.free.iter().filter(|own| *own != name && !own.contains('.'));
        let alone = self.board.strayed(&fitted).is_empty()
            && is_far(&fitted.rig, rig, name)
            && others.all(|own| strays_by(&fitted.rig, rig, own) < TOO_FAR);
        if worse || !alone || self.leaves(&fitted) > MORE {
            self.board.loose = before;
            return Ok(None);
        }
        self.short.loose.clone_from(&self.board.loose);
        self.strayed.clear();
        self.best = fitted.clone();
        Ok(Some(fitted))
    }

    /// What is a little loose where the value of this name is free: all that may be, but for that.
    fn besides(&self, name: &str) -> Vec<(String, f64)> {
        let mut all = self.off();
        all.retain(|(own, _)| own != name);
        all
    }

    /// What is given and not free but may be off: what is a little loose, and what was until it strayed.
    fn off(&self) -> Vec<(String, f64)> {
        self.board.loose.iter().chain(&self.strayed).cloned().collect()
    }
}

/// Whether a value is further from the given one than nominal values are.
fn is_far(found: &Rig, given: &Rig, name: &str) -> bool {
    strays_by(found, given, name) > WRONG
}

/// By how much the value of this name is off the given one, in its logarithm; 0 where one is none.
fn strays_by(found: &Rig, given: &Rig, name: &str) -> f64 {
    let [found, given] = [found, given].map(|rig| rig.value(name).unwrap_or(f64::NAN));
    off_by(found, given)
}

/// By how much a value is off the `given` one, in its logarithm; 0 where one is none.
pub(super) fn off_by(found: f64, given: f64) -> f64 {
    let off = (found / given).ln().abs();
    if off.is_finite() { off } else { 0.0 }
}

/// What is given, positive and not free but for being `loose`. A stiction that is the sliding friction is none.
fn told(rig: &Rig, loose: &[(String, f64)]) -> Vec<String> {
    let stiction = rig.value("f_s") != rig.value("f_c");
    let own = |name: &String| {
        let stribeck = name == "f_s" || name == "v_s";
        let given = rig.value(name).is_some_and(|value| value > 0.0);
        let held = !rig.free.contains(name) || loose.iter().any(|(own, _)| own == name);
        given && held && name != OFFSET && (stiction || !stribeck)
    };
    rig.parameters().into_iter().filter(own).filter(|name| !name.contains('.')).collect()
}

/// The names that are free in `rig` or `loose`, and this one.
fn all_free(rig: &Rig, loose: &[(String, f64)], name: &str) -> Vec<String> {
    let mut free = rig.free.clone();
    let loose = loose.iter().map(|(own, _)| own.clone());
    for own in loose.chain([name.to_owned()]) {
        if !free.contains(&own) {
            free.push(own);
        }
    }
    free
}

#[cfg(test)]
mod tests {
    use super::told;
    use crate::{
        verdict::Found,
        walk::made::{self, found, rig, taken, walk, with},
    };
    use identify::{
        Hold, Rig,
        effects::Kind,
        fit::{Data, Seen, binding},
    };

    /// The model with this much viscous friction, and no free value but the mass.
    fn given(sigma_2: f64) -> Rig {
        let mut rig = Rig { free: vec!["mass".to_owned()], ..rig(2.0) };
        binding::set(&mut rig, "sigma_2", sigma_2);
        rig
    }

    /// What is found wrong beside these effects where so much was given and the last model has that much, of 0.5 N·s/m.
    fn wrong((given, last): (&Rig, &Rig), mut effects: Vec<Found>) -> (Option<f64>, usize) {
        let data = taken(|_, _| 0.0);
        let mut walk = walk(given, &data, &[]);
        walk.best = walk.board.judged(last, None).unwrap();
        let refit = walk.wrong_given(given, &mut effects).unwrap();
        let same = |own: &Rig| own.value("sigma_2") == walk.best.rig.value("sigma_2");
        assert!(refit.as_ref().is_none_or(|refit| same(&refit.rig)));
        let value = |refit: crate::board::Fitted| refit.rig.value("sigma_2");
        (refit.and_then(value), effects.len())
    }

    #[test]
    fn a_given_value_that_is_not_free_is_found_wrong() {
        let off = given(0.8);
        let (value, _) = wrong((&off, &off), Vec::new());
        assert!((value.expect("a value") - 0.5).abs() < 0.01, "{value:?}");
        let right = given(0.5);
        assert_eq!(wrong((&right, &right), Vec::new()).0, None, "nothing is missing");
        let near = given(0.53);
        assert_eq!(
            wrong((&near, &near), Vec::new()).0,
            None,
            "no further off than given values are"
        );
    }

    #[test]
    fn it_takes_the_place_of_what_has_more_numbers_and_is_no_nearer() {
        let (off, last) = (given(0.8), given(0.5));
        let (value, effects) = wrong((&off, &last), vec![found("maxwell_slip")]);
        assert!(value.is_some() && effects == 0);
        let (value, effects) = wrong((&off, &last), vec![found("current_bias")]);
        assert!(value.is_none() && effects == 1);
    }

    #[test]
    fn where_an_effect_surely_does_better_no_given_value_is_wrong() {
        let wrong = |drag: f64| {
            let data = taken(|_, v| drag * v * v.abs());
            let (off, mut walk) = (given(0.8), walk(&given(0.8), &data, &[]));
            let right = with(&given(0.5), Kind::QuadraticDrag, &[drag]);
            walk.best = walk.board.judged(&right, None).unwrap();
            let mut freed = given(0.5);
            freed.free.push("sigma_2".to_owned());
            let other = walk.board.fit(&freed, None, &crate::walk::REFIT).unwrap();
            let [there, here] = [&other, &walk.best].map(|f| walk.judged(&f.blocks));
            assert!(!super::surely_worse(&there, &here), "by what is left it is no worse");
            let found = walk.wrong_given(&off, &mut vec![found("maxwell_slip")]).unwrap();
            found.is_some()
        };
        // The drag is there to three standard errors, and to six.
        assert!(wrong(0.003) && !wrong(0.0055));
    }

    #[test]
    fn an_effect_that_is_hardly_there_does_no_better_however_surely_it_is_told() {
        // A fortieth of the drag that there is changes the right thing, and next to nothing.
        let data = taken(|_, v| 0.012 * v * v.abs());
        let off = given(0.8);
        let mut walk = walk(&off, &data, &[]);
        let free = vec!["mass".to_owned(), "sigma_2".to_owned()];
        let fit = |rig: Rig| {
            let rig = Rig { free: free.clone(), ..rig };
            walk.board.fit(&rig, None, &crate::walk::REFIT).unwrap()
        };
        let other = fit(given(0.5));
        let little = fit(with(&given(0.5), Kind::QuadraticDrag, &[3e-4]));
        walk.best = little;
        assert!(walk.evidence(&other, &walk.best) > super::TELLS);
        assert!(walk.wrong_given(&off, &mut vec![found("maxwell_slip")]).unwrap().is_some());
    }

    #[test]
    fn a_value_with_which_a_free_one_goes_far_is_not_wrong_by_itself() {
        let wrong = |mass: f64| {
            let data = taken(|_, _| 0.0);
            let mut off = given(0.8);
            binding::set(&mut off, "mass", mass);
            let mut walk = walk(&off, &data, &[]);
            walk.best = walk.board.judged(&given(0.5), None).unwrap();
            walk.wrong_given(&off, &mut vec![found("maxwell_slip")]).unwrap().is_some()
        };
        // Not at all, and by 1.45 times.
        assert!(wrong(2.0) && !wrong(2.9));
    }

    #[test]
    fn where_one_value_drags_another_along_the_next_is_asked() {
        // A pendulum that swings by 1 rad at 2 rad/s. K/R is right with either value, and σ₂ makes up for K²/R, so that noise
        // decides which of the two is nearer.
        let rig = |resistance: f64| {
            let text = format!(
                "title = \"a pendulum\"\n[plant]\nkind = \"pendulum\"\ninertia = 0.021\nmass = 0.62\nlength = 0.14\n\
                 torque_constant = 0.42\nresistance = {resistance:?}\n[friction]\nname = \"coulomb\"\nf_c = 0.11\n\
                 sigma_2 = 0.05\n[fit]\nfree = [\"f_c\", \"sigma_2\"]\n[channels]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"q\"\n"
            );
            Rig::parse(&text).unwrap()
        };
        let voltage = |t: &f64| {
            let (s, v) = ((2.0 * t).sin(), 2.0 * (2.0 * t).cos());
            let weighs = 0.62 * 9.81 * 0.14 * s.sin();
            2.4 / 0.42 * (-0.021 * 4.0 * s + weighs + 0.11 * v.signum() + 0.05 * v) + 0.42 * v
        };
        let off = rig(3.0);
        for seed in [1, 2] {
            let swings = made::noisy(seed);
            let input = swings.time.iter().map(voltage).collect();
            let seen = swings.displacement.unwrap().values;
            let data =
                Data::driven(swings.time, input, Hold::Linear, Seen::new("angle", seen, 0.0));
            let mut walk = walk(&off, &data, &[]);
            let mut effects = vec![found("inertia"), found("cogging")];
            let refit = walk.wrong_given(&off, &mut effects).unwrap();
            let value = refit.expect("one is wrong").rig.value("resistance");
            assert!(value.is_some_and(|value| (value - 2.4).abs() < 0.03), "{value:?}");
        }
    }

    #[test]
    fn what_goes_far_with_another_is_no_value_that_is_wrong_by_itself() {
        let [off, right] = [given(0.8), given(0.5)];
        let far = |name: &str| super::strays_by(&off, &right, name);
        assert!((far("sigma_2") - 1.6_f64.ln()).abs() < 1e-12 && far("sigma_2") > super::TOO_FAR);
        assert_eq!(far("mass"), 0.0);
        assert_eq!(super::strays_by(&off, &given(0.0), "sigma_2"), 0.0, "nothing was given");
    }

    #[test]
    fn what_is_told_is_given_and_not_free() {
        let names = told(&given(0.5), &[]);
        assert_eq!(names, ["stiffness", "sigma_2"]);
        let loose = [("mass".to_owned(), 2.0)];
        assert_eq!(told(&given(0.5), &loose).len(), 3, "what is only loose is not free");
        assert_eq!(told(&given(0.0), &[]), ["stiffness"]);
    }
}
