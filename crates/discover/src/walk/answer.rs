//! What is told of the way's end.

use super::{
    FIRST, Walk,
    named::{LEAST, SURE},
    says::verdict,
};
use crate::{
    board::{Fitted, strays},
    decide::{Judged, shrink},
    gram::{Gram, spreads},
    verdict::{Discovery, Found, Gap, Moved, Value, Verdict, limits},
    wrong::{Minimum, besides, wrong},
};
use identify::{
    Rig,
    effects::Context,
    fit::{FitError, binding},
};

/// What is left may be so much larger than the floor before it is said that more is missing: right models of 84 records
/// left 0.64 to 1.12 floors, with one of 1.42, wrong ones 1.23 and more.
pub(super) const MORE: f64 = 1.2;

/// What is known is so much better known than the record tells.
const KNOWN: f64 = 1e9;

/// What leaves so much may leave noise that is not white, if it takes away so much of the excess.
pub(super) const NOISY: f64 = 1.6;
pub(super) const NEARLY_ALL: f64 = 0.99;

/// A nominal parameter that moves further was wrong: nominal values are a little off, always.
pub(super) const WRONG: f64 = 0.08;

/// It is worse for it by so many squared standard errors besides the two blocks that lose most, if not by as much in all.
const RARELY: f64 = 2.0 * LEAST;

impl Walk<'_> {
    /// What the search has come to with what was `found` last, in a line.
    pub(super) fn comes_to(&self, found: &[Found]) -> String {
        let names: Vec<&str> = found.iter().map(|effect| effect.name).collect();
        format!("with {} χ² {:.4}", names.join(" and "), self.judged(&self.best.blocks).level())
    }

    /// Whether what is named explains all but what noise that is not white may leave.
    pub(super) fn explained(&self, level: f64) -> bool {
        level < NOISY && shrink(self.refit, level) > NEARLY_ALL
    }

    pub(super) fn answer(
        mut self,
        (rig, before, refit): (&Rig, &Fitted, &Fitted),
        (mut effects, start): (Vec<Found>, &Gram),
        context: &Context,
    ) -> Result<Discovery, FitError> {
        let (mut values, mut parameters) = self.moved(rig)?;
        if self.unmoved(rig, &effects, &parameters) {
            (values, parameters) = self.moved(rig)?;
        }
        let [first, nominal, last] =
            [before, refit, &self.best].map(|f| self.judged(&f.blocks).level());
        let mostly = [refit, &self.best].map(|f| self.leaves(f));
        let tone = self.tone(&self.best);
        let struck = self.struck() || tone.is_some();
        let hangs = !effects.is_empty() && self.hangs_together(&self.best);
        let unexplained = mostly[1] > MORE || struck || hangs;
        let mut map = if unexplained { self.map(context)? } else { None };
        if effects.is_empty()
            && self.unsure_which(rig, &parameters)
            && let Some(one) = self.one_wrong(rig)?
        {
            (values, parameters) = self.moved(rig)?;
            for parameter in &mut parameters {
                parameter.moved = parameter.found.name == one;
            }
        }
        for effect in &mut effects {
            effect.values = values
                .iter()
                .filter(|v| v.name.starts_with(&format!("{}.", effect.name)))
                .map(|v| Value { name: v.name[effect.name.len() + 1..].to_owned(), ..v.clone() })
                .collect();
        }
        let levels = ([first, nominal, last], mostly);
        let mut verdict = verdict(&effects, &parameters, levels, (struck, hangs));
        let beyond = match verdict {
            Verdict::NothingMissing => self.faint((rig, &mut parameters), context)?,
            Verdict::Effect => match self.series(refit, (effects.len(), true), context)? {
                None => self.resembled(refit, context)?,
                map => map,
            },
            Verdict::Partial => self.series(refit, (effects.len(), false), context)?,
            _ => None,
        };
        if beyond.is_some() {
            (verdict, map) = (Verdict::NotInLibrary, beyond);
        }
        if verdict == Verdict::NotInLibrary {
            effects.clear();
        }
        Ok(Discovery {
            verdict,
            parameters,
            effects,
            gap: self.gaps(before, refit),
            shares: self.shares(refit),
            map,
            tone,
            ranking: std::mem::take(&mut self.ranking),
            detectability: limits(start, rig),
            chi_squared: [first, nominal, self.judged(&self.best.blocks).level()],
            hold: None,
            complete: true,
            rig: self.best.rig,
        })
    }

    /// All free values of the last model, and which of those of `rig` moved further than nominal values are off.
    fn moved(&self, rig: &Rig) -> Result<(Vec<Value>, Vec<Moved>), FitError> {
        let (values, wrong) = self.values(rig, &|_| false)?;
        let one = |found: &Value| {
            let given = rig.value(&found.name).unwrap_or(f64::NAN);
            let surely = self.own(&found.name) && wrong.contains(&found.name) && moved(rig, found);
            let surely = surely && !self.drifts_past(found, given);
            Moved { given, found: found.clone(), moved: surely }
        };
        let nominal = values.iter().filter(|v| !v.name.contains('.'));
        let mut parameters: Vec<Moved> = nominal.map(one).collect();
        if parameters.iter().any(|p| p.moved) && !self.far(&parameters)? {
            for parameter in &mut parameters {
                parameter.moved = false;
            }
        }
        Ok((values, parameters))
    }

    /// Whether a value may be told as wrong: it is free in the rig file, or is not held near the given one.
    pub(super) fn own(&self, name: &str) -> bool {
        !self.board.holds(name) || self.given.free.iter().any(|free| free == name)
    }

    /// Whether the model is surely worse with the values that were given of what moved.
    pub(super) fn far(&self, parameters: &[Moved]) -> Result<bool, FitError> {
        let mut rig = self.best.rig.clone();
        for moved in parameters.iter().filter(|p| p.moved) {
            binding::set(&mut rig, &moved.found.name, moved.given);
            rig.free.retain(|name| *name != moved.found.name);
        }
        // What is given and only a little loose must not go as far in its place.
        rig.free.retain(|name| !self.board.holds(name));
        let worse = |rig: &Rig| -> Result<bool, FitError> {
            let near = self.board.fit_near(rig, &self.best.pieces, &FIRST)?;
            let (near, best) = (self.judged(&near.blocks), self.judged(&self.best.blocks));
            // A bristle's stiffness shows where the motion turns slowly: in a few blocks of a chirp.
            Ok(surely_worse(&near, &best) || near.gained_besides(&best) > RARELY)
        };
        if !worse(&rig)? {
            return Ok(false);
        }
        // What went as far with it but is not known so well stands far from where the model is as good: a Stribeck velocity
        // forty times too large, where the stiction is as good as gone.
        let along = |p: &&Moved| !p.moved && p.given > 0.0 && strays(p.found.value, p.given);
        let before = rig.clone();
        for gone in parameters.iter().filter(along) {
            binding::set(&mut rig, &gone.found.name, gone.given);
        }
        Ok(rig == before || worse(&rig)?)
    }

    /// All free values of the last model with their standard errors, as if those that are `known` were, and the names
    /// of those for which `rig` has a wrong value.
    pub(super) fn values(
        &self,
        rig: &Rig,
        known: &dyn Fn(&str) -> bool,
    ) -> Result<(Vec<Value>, Vec<String>), FitError> {
        let problem = self.board.problem(&self.best.rig, |_| true)?;
        let gram = Gram::alone(&self.board, &self.best)?;
        let n = gram.nominal;
        let mut all = gram.sum(|_| true);
        let variance = self.judged(&self.best.blocks).mean().max(1.0);
        // What is held near its value is not as uncertain as the record leaves it.
        for (i, name) in gram.names.iter().enumerate() {
            if self.board.holds(name) {
                all[(i, i)] += gram.prior[i] * variance;
            }
            if known(name) {
                all[(i, i)] *= KNOWN;
            }
        }
        let spread = spreads(&all.view((0, 0), (n, n)).into_owned());
        let values = (0..n).map(|i| {
            let value = problem.value(i, &self.best.x);
            let own = problem.free[i].value(self.best.x[i]);
            let slope = problem.free[i].slope(own).abs();
            let error = variance.sqrt() * spread[i] * slope;
            let name = problem.free[i].name.clone();
            let unit = self.best.rig.unit(&name);
            Value { name, value, standard_error: error, unit }
        });
        let values = values.collect();
        // What is free may be as far off as any: that it is held is for what the record does not tell.
        for (i, name) in gram.names.iter().enumerate() {
            if self.board.holds(name) && self.own(name) {
                all[(i, i)] -= gram.prior[i] * variance;
            }
        }
        let curvature = all.view((0, 0), (n, n)) / variance;
        let wrong = wrong(&Minimum { problem: &problem, x: &self.best.x, curvature }, rig);
        let names = wrong.into_iter().map(|i| problem.free[i].name.clone()).collect();
        Ok((values, names))
    }

    fn gaps(&self, before: &Fitted, refit: &Fitted) -> Vec<Gap> {
        let data = self.board.data;
        let w = &self.board.weights;
        let mut channels: Vec<(String, f64)> = Vec::new();
        if let Some(seen) = &data.force {
            channels.push((seen.name.clone(), w.force));
        }
        if let Some(seen) = &data.displacement {
            channels.push((seen.name.clone(), w.displacement));
        }
        if let Some(seen) = &data.velocity {
            channels.push((seen.name.clone(), w.velocity));
        }
        if data.loads.is_some() {
            channels.push(("force_1".to_owned(), w.loads[0]));
            channels.push(("force_2".to_owned(), w.loads[1]));
        }
        let samples = self.board.samples();
        let samples: f64 = self.judging().map(|k| samples[k]).sum();
        let rms = |f: &Fitted, c: usize, weight: f64| {
            let sum: f64 = self.judging().map(|k| f.blocks[k][c]).sum();
            weight * (sum / samples).sqrt()
        };
        let one = |(c, (channel, weight)): (usize, (String, f64))| Gap {
            unit: unit_of(&self.best.rig, &channel),
            before: rms(before, c, weight),
            refit: rms(refit, c, weight),
            after: rms(&self.best, c, weight),
            floor: weight,
            channel,
        };
        channels.into_iter().enumerate().map(one).collect()
    }

    fn judging(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.board.trains.len()).filter(|k| !self.board.trains[*k])
    }
}

/// Whether a model is surely worse on the judging blocks than another, by however small a share: among many channels
/// and much noise a stiffness that is a fifth off leaves 4 % more.
pub(super) fn surely_worse(one: &Judged, other: &Judged) -> bool {
    one.against(other) > SURE && one.gained(other) > LEAST
}

/// The unit of a channel.
fn unit_of(rig: &Rig, channel: &str) -> &'static str {
    let turns = identify::rig::Kind::of(rig.kind).is_some_and(identify::rig::Kind::turns);
    match (channel, turns) {
        ("angle", _) => "rad",
        ("velocity", true) => "rad/s",
        ("velocity", false) => "m/s",
        ("position" | "displacement", _) => "m",
        _ => "N",
    }
}

/// Whether a nominal value was wrong by more than nominal values are, and surely.
pub(super) fn moved(rig: &Rig, found: &Value) -> bool {
    let given = rig.value(&found.name).unwrap_or(f64::NAN);
    let away = (found.value - given).abs();
    away > 5.0 * found.standard_error && away > WRONG * given.abs() + besides(rig, &found.name)[1]
}

#[cfg(test)]
mod tests {
    use super::{Judged, Moved, Value, surely_worse};
    use crate::{
        verdict::Options,
        walk::{made, walked},
    };
    use identify::{
        Hold, Rig,
        fit::{Data, Seen, simulate},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};
    use std::sync::Mutex;

    /// A slide with this stiction force [N] and Stribeck velocity [m/s].
    fn bristles(f_s: f64, v_s: f64) -> Rig {
        let text = format!(
            "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"lugre\"\nf_c = 1.0\n\
             f_s = {f_s:?}\nv_s = {v_s:?}\nsigma_0 = 1e5\nsigma_1 = 0.0\nsigma_2 = 1.0\n[fit]\n\
             free = [\"f_c\", \"f_s\", \"v_s\", \"sigma_2\"]\n[channels]\ntime = \"t\"\n\
             displacement = \"x\"\nforce = \"f\"\n"
        );
        Rig::parse(&text).unwrap()
    }

    /// A slide with a stiction force of 1.5 N below 1 mm/s, forth and back at speeds far above; noise of 1 mN.
    fn fast() -> Data {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let (mut x, mut input) = (0.0, Vec::new());
        for i in 0..6000 {
            let way = if i % 200 < 100 { 1.0 } else { -1.0 };
            input.push(x);
            x += 0.005 * way * [0.02, 0.05, 0.1, 0.2][i / 200 % 4];
        }
        let time: Vec<f64> = (0..6000).map(|i| 0.005 * f64::from(i)).collect();
        // What was seen of the force is not yet known.
        let seen = Seen::new("force", input.clone(), 0.0);
        let driven = Data::driven(time, input, Hold::Linear, seen.clone());
        let mut data = Data { displacement: None, force: Some(seen), ..driven };
        let run = simulate(&bristles(1.5, 1e-3), &data, None).unwrap();
        let force = run.traces[0].after.iter().map(|f| f + 1e-3 * noise());
        data.force = Some(Seen::new("force", force.collect(), 0.0));
        data
    }

    static HEARD: Mutex<Vec<String>> = Mutex::new(Vec::new());

    #[test]
    fn who_listens_is_told_how_far_the_search_has_come() {
        let listens: fn(&str) = |line| HEARD.lock().unwrap().push(line.to_owned());
        let options = Options { told: Some(listens), ..Options::default() };
        walked((&made::rig(2.0), Vec::new()), &made::data(), &[], &options).unwrap();
        let heard = HEARD.lock().unwrap();
        assert!(heard[0].starts_with("refitted it leaves χ² "), "{heard:?}");
        assert!(heard[1].starts_with("with current_bias χ² "), "{heard:?}");
    }

    #[test]
    fn what_moved_where_another_went_along_unseen_did_not_have_to() {
        let data = fast();
        // Without a stiction above F_C its velocity is not seen; with one a velocity that is too large is never left.
        let mut walk = made::walk(&bristles(1.0, 1.0), &data, &[]);
        assert!(walk.judged(&walk.best.blocks).level() < 1.05);
        let of = |name: &str, found: f64, given: f64, moved: bool| {
            let value =
                Value { name: name.to_owned(), value: found, standard_error: 0.0, unit: "" };
            Moved { given, found: value, moved }
        };
        let with = |given: f64| [of("f_s", 1.0, 1.5, true), of("v_s", 1.0, given, false)];
        assert!(walk.far(&with(1.0)).unwrap(), "given as it is now");
        assert!(!walk.far(&with(1e-3)).unwrap());
        walk.best = walk.board.judged(&bristles(1.5, 1e-3), None).unwrap();
        assert!(walk.judged(&walk.best.blocks).level() < 1.05, "the truth");
    }

    #[test]
    fn what_is_a_little_worse_in_every_block_is_surely_worse() {
        let of = |level: f64, apart: f64| {
            let blocks = (0..20).map(|k| level + if k % 2 == 0 { apart } else { -apart });
            Judged { blocks: blocks.collect(), counts: vec![1200.0; 20] }
        };
        // 0.04 of 24 000 residuals are 31 standard errors.
        assert!(surely_worse(&of(1.02, 0.01), &of(0.98, 0.008)));
        assert!(!surely_worse(&of(1.02, 0.2), &of(0.98, 0.008)), "in half of them it is better");
        assert!(!surely_worse(&of(0.982, 0.01), &of(0.98, 0.01)), "0.002 of them are seven");
    }

    #[test]
    fn what_holds_a_value_does_not_say_that_it_is_wrong() {
        // 2.2 kg of which the record tells no more than a twentieth, given as 2 kg.
        let data = made::data();
        let free = Rig { free: vec!["mass".to_owned()], ..made::rig(2.2) };
        let error = |walk: &crate::walk::Walk<'_>| {
            let values = walk.values(&made::rig(2.0), &|_| false).unwrap();
            (values.0[0].standard_error, values.1)
        };
        for held in [false, true] {
            let loose = if held { vec![("mass".to_owned(), 2.0)] } else { Vec::new() };
            let mut walk = made::walk(&free, &data, &[]);
            // What it leaves beside more noise is less, and tells more.
            for _ in 0..4 {
                walk.board.weights.displacement *= 0.1 / error(&walk).0;
                walk.best = walk.board.judged(&free, None).unwrap();
            }
            (walk.board.loose, walk.given.free) = (loose, free.free.clone());
            let (told, wrong) = error(&walk);
            assert!((told < 0.05) == held, "± {told} kg");
            assert!(wrong.is_empty(), "{held}");
        }
    }
}
