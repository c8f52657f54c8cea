//! A simpler rival of the nearest effect, looked for once more.

use super::{
    FIRST, Walk,
    candidates::AFRESH,
    named::{MOST, numbers},
    polish::lacking,
};
use crate::{
    board::Fitted,
    decide::{Judged, shrink},
    gram,
    model::{self, Candidate},
    screen::Scored,
};
use identify::{
    Rig,
    effects::{Context, Kind, LAWS},
};
use rayon::prelude::*;

/// It is begun with so much of the natural sizes of its amounts, at each of its probes.
const AMOUNTS: [f64; 2] = [0.1, 0.3];

/// After so many simulations so many of these go on: they come down a long valley.
const HEATS: [(usize, usize); 2] = [(6, 14), (12, 6)];

/// So many of what is begun are followed to their ends.
const ENDED: usize = 2;

/// What repeats once a turn does so at this wavenumber [1/rad], as nearly as this.
const TURN: f64 = 1.0;
const NEARLY: f64 = 0.1;

impl Walk<'_> {
    /// What the nearest candidate is confused with and needs fewer numbers, a shape among them, if it was a candidate as
    /// well, once more: from all of its probes and beside the given values. What has more numbers comes down from wherever
    /// it was begun; a Stribeck velocity that is too large ends in a minimum of its own, where the bristles are stiffer than
    /// they are, and friction that ages makes up for it.
    pub(super) fn simpler(
        &self,
        now: &Judged,
        all: &[Candidate],
        context: &Context,
    ) -> Vec<Candidate> {
        let plausible = all.iter().filter(|c| self.fits(c, context));
        let plausible: Vec<Candidate> = plausible.cloned().collect();
        let Some((best, least)) = self.nearest(&plausible) else { return Vec::new() };
        if shrink(now.level(), least) < MOST {
            return Vec::new();
        }
        let rival = |kind: &&Kind| {
            best.kind.about().confused.contains(&kind.about().name)
                && (2..numbers(best.kind)).contains(&numbers(**kind))
                && kind.tried().is_empty()
                && plausible.iter().any(|c| c.kind == **kind)
        };
        let begun = |kind: &Kind| -> Vec<(Kind, Rig)> {
            let probes = (kind.about().probes)(context);
            let each = probes.iter().flat_map(|probe| AMOUNTS.map(|amount| (probe, amount)));
            let one = |(probe, amount): (&Vec<f64>, f64)| {
                let values = gram::tried(*kind, probe, amount, context);
                (*kind, model::with(&self.origin, &Scored::unscored(*kind, values)))
            };
            each.map(one).collect()
        };
        let again = |kind: &Kind| {
            let board = if self.board.imposed() { &self.board } else { &self.short };
            let near = board.raced(&begun(kind), &HEATS, &AFRESH);
            let mut near = self.longer(near, (now, context));
            let level = |c: &Candidate| self.judged(&c.fitted.blocks).level();
            near.retain(|c| self.fits(c, context));
            near.sort_by(|a, b| level(a).total_cmp(&level(b)));
            near.truncate(ENDED);
            near
        };
        let mut all: Vec<Candidate> = LAWS.iter().filter(rival).flat_map(again).collect();
        all.extend(self.once_a_turn(best, context));
        let ended = |c: &Candidate| {
            Some(Candidate { kind: c.kind, fitted: self.ended(c.fitted.clone()).ok()? })
        };
        all.par_iter().filter_map(ended).collect()
    }

    /// A wave along the way that repeats about once a turn, as the weight that does so.
    fn once_a_turn(&self, wave: &Candidate, context: &Context) -> Option<Candidate> {
        let weight = Kind::GravityUnbalance;
        let value = |key: &str| wave.fitted.rig.value(&format!("cogging.{key}"));
        let turns = wave.kind == Kind::Cogging && !(weight.about().probes)(context).is_empty();
        if !turns || (value("wavenumber")? - TURN).abs() > NEARLY || !weight.applies(&self.best.rig)
        {
            return None;
        }
        let values = vec![value("sine")?, value("cosine")?];
        let bare = Fitted { rig: lacking(&wave.fitted.rig, "cogging"), ..wave.fitted.clone() };
        let rig = model::with(&bare, &Scored::unscored(weight, values));
        let fitted = self.board.fit_near(&rig, &wave.fitted.pieces, &FIRST).ok()?;
        Some(Candidate { kind: weight, fitted })
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        model::Candidate,
        walk::made::{DRY, context, taken, walk, with},
    };
    use identify::{Rig, effects::Kind, fit::Seen};

    #[test]
    fn a_simpler_rival_is_begun_once_more_beside_a_richer_one() {
        // Dry friction of 0.5 N that is higher by 0.3 N exp(−(v/0.2)²).
        let level = |v: f64| 0.5 + 0.3 * (-(v / 0.2).powi(2)).exp();
        let data = taken(|_, v| level(v) * v.signum());
        let rig = Rig::parse(DRY).unwrap();
        let walk = walk(&rig, &data, &[]);
        let (now, context) = (walk.judged(&walk.best.blocks), context(&walk));
        let candidate = |kind: Kind, rig: &Rig| Candidate {
            kind,
            fitted: walk.board.judged(rig, None).unwrap(),
        };
        let stribeck = |drop: f64, v_s: f64| with(&rig, Kind::Stribeck, &[drop, v_s, 1.0]);
        let level = |c: &Candidate| walk.judged(&c.fitted.blocks).level();
        // Ageing beside the truth is as near as can be; the other is not where it belongs.
        let ages = with(&stribeck(0.3, 0.2), Kind::DwellStiction, &[1e-6, 0.5, 1.0]);
        let richer = candidate(Kind::DwellStiction, &ages);
        let astray = candidate(Kind::Stribeck, &stribeck(0.05, 1.5));
        assert!(level(&richer) < 1.2 && level(&astray) > 2.0, "{}", level(&astray));
        let found = walk.simpler(&now, &[richer.clone(), astray.clone()], &context);
        let (nearest, left) = walk.nearest(&found).expect("it is begun");
        assert!(nearest.kind == Kind::Stribeck && left < 1.2, "{left}");
        // What was no candidate is not begun, nor what is richer itself.
        assert!(walk.simpler(&now, std::slice::from_ref(&richer), &context).is_empty());
        let right = candidate(Kind::Stribeck, &stribeck(0.3, 0.2));
        let aged =
            candidate(Kind::DwellStiction, &with(&rig, Kind::DwellStiction, &[0.1, 0.5, 1.0]));
        assert!(walk.simpler(&now, &[right, aged], &context).is_empty());
    }

    #[test]
    fn a_wave_that_repeats_once_a_turn_is_a_weight() {
        // A weight of 0.3 N·m on the side and 0.2 above, of a pulley that comes three radians far.
        let text = "title = \"t\"\n[plant]\nkind = \"axis\"\ninertia = 2.0\ngain = 1.0\n[friction]\nname = \"none\"\n\
                    sigma_2 = 0.5\n[fit]\nfree = [\"sigma_2\"]\n[channels]\ntime = \"t\"\nvoltage = \"u\"\nposition = \"x\"\n";
        let rig = Rig::parse(text).unwrap();
        let (mut data, turns) = (crate::walk::made::data(), 3.0);
        let noise: Vec<f64> = data
            .displacement
            .as_ref()
            .unwrap()
            .values
            .iter()
            .zip(&data.time)
            .map(|(x, t)| x - (2.0 * t).sin())
            .collect();
        let seen = data.time.iter().zip(noise).map(|(t, e)| turns * (2.0 * t).sin() + e).collect();
        for (u, t) in data.input.iter_mut().zip(&data.time) {
            let (s, c) = f64::sin_cos(2.0 * t);
            let (q, v, a) = (turns * s, turns * 2.0 * c, -turns * 4.0 * s);
            *u = 2.0 * a + 0.5 * v + 0.3 * q.sin() + 0.2 * q.cos();
        }
        data.displacement = Some(Seen::new("position", seen, 0.0));
        let walk = walk(&rig, &data, &[]);
        let (now, context) = (walk.judged(&walk.best.blocks), context(&walk));
        let wave = |wavenumber: f64| Candidate {
            kind: Kind::Cogging,
            fitted: walk
                .board
                .judged(&with(&rig, Kind::Cogging, &[0.3, 0.2, wavenumber]), None)
                .unwrap(),
        };
        let found = walk.simpler(&now, &[wave(1.001)], &context);
        let level = |c: &Candidate| walk.judged(&c.fitted.blocks).level();
        let [weight] = &found[..] else { panic!("{found:?}") };
        assert!(weight.kind == Kind::GravityUnbalance && level(weight) < 1.1, "{}", level(weight));
        assert!(walk.simpler(&now, &[wave(1.2)], &context).is_empty());
    }
}
