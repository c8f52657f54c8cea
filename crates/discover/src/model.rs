//! A model with an effect added, refitted in full.

use crate::{
    board::{Board, Fitted},
    gram,
    screen::Scored,
};
use identify::{
    Rig,
    effects::{Context, Key, Kind, Measure, Shape, Sign, WAVES},
    fit::{FitError, problem::Problem, search::Patience},
};
use std::f64::consts::{PI, TAU};

/// Enough to see whether a candidate is worth more, and enough for one that is.
const GLANCE: Patience = Patience { misfit: 2.0, share: 1e-3, simulations: 5 };
const PATIENCE: Patience = Patience { misfit: 2.0, share: 1e-4, simulations: 14 };

/// An effect and the model that has it.
#[derive(Debug, Clone)]
pub(crate) struct Candidate {
    /// The effect.
    pub(crate) kind: Kind,
    /// The model with it, fitted on the training blocks.
    pub(crate) fitted: Fitted,
}

/// Goes on with a candidate.
pub(crate) fn follow(board: &Board<'_>, candidate: Candidate) -> Result<Candidate, FitError> {
    let near = &candidate.fitted;
    let fitted = board.fit(&near.rig, Some((&near.x, &near.pieces)), &PATIENCE)?;
    let better = board.trained(&fitted) < board.trained(near);
    Ok(if better { Candidate { fitted, ..candidate } } else { candidate })
}

/// The model with an effect at what its score says, all of it free.
pub(crate) fn with(fitted: &Fitted, scored: &Scored) -> Rig {
    let about = scored.kind.about();
    let mut rig = fitted.rig.clone();
    let shapes: Vec<f64> = about
        .keys
        .iter()
        .zip(&scored.values)
        .filter(|(key, _)| key.shape != Shape::Amount)
        .map(|(_, value)| *value)
        .collect();
    gram::with(&mut rig, scored.kind, &shapes, 0);
    // What there may be more of is asked for where it is not as usual.
    let asked = |(key, value): &(&Key, &f64)| match key.shape {
        Shape::Fitted => true,
        Shape::Spare => key.usual != Some(**value),
        _ => false,
    };
    for (key, _) in about.keys.iter().zip(&scored.values).filter(asked) {
        rig.free.push(format!("{}.{}", about.name, key.name));
    }
    for (key, value) in about.keys.iter().zip(&scored.values) {
        let name = format!("{}.{}", about.name, key.name);
        identify::fit::binding::set(&mut rig, &name, *value);
    }
    rig
}

/// Refits the model with an effect, begun at what its score says, as far as a glance goes.
pub(crate) fn refit(
    board: &Board<'_>,
    fitted: &Fitted,
    scored: &Scored,
) -> Result<Candidate, FitError> {
    let rig = with(fitted, scored);
    let problem = board.problem(&rig, |_| true)?;
    let x = begin(&problem, fitted, scored);
    let patience = if scored.kind.tried().is_empty() { &GLANCE } else { &PATIENCE };
    let candidate = board.fit(&rig, Some((&x, &fitted.pieces)), patience)?;
    Ok(Candidate { kind: scored.kind, fitted: candidate })
}

/// A nominal variable moves no further than this before the first simulation.
const FIRST: f64 = 0.2;

/// The variables of the larger problem: those of the smaller with what the score moves them by, then what the effect
/// begins with.
fn begin(problem: &Problem<'_>, fitted: &Fitted, scored: &Scored) -> Vec<f64> {
    let by = scored.nominal.iter().map(|by| by.clamp(-FIRST, FIRST)).chain(std::iter::repeat(0.0));
    let own = fitted.x.iter().zip(by).map(|(x, by)| x + by);
    let more = problem.free.iter().skip(fitted.x.len()).map(|free| free.variable(free.given));
    own.chain(more).collect()
}

/// What a parameter may change by, in its logarithm, when an effect that it had taken up is given its own name.
const FAR: f64 = 3.0;

/// A refit that changes a parameter by so much, in its logarithm, may have made up for what is missing.
const DRAGGED: f64 = 0.5;

/// Whether what is missing may have dragged a parameter of a model away from where it was.
pub(crate) fn dragged(rig: &Rig, from: &Rig) -> bool {
    let far = |name: &String| match (rig.value(name), from.value(name)) {
        (Some(now), Some(then)) if then > 0.0 => !(now > 0.0 && (now / then).ln().abs() < DRAGGED),
        _ => false,
    };
    rig.free.iter().any(far)
}

/// Whether a parameter of a model is not absurd beside what it is in another.
fn near(name: &str, rig: &Rig, other: &Rig) -> bool {
    match (rig.value(name), other.value(name)) {
        (Some(now), Some(then)) if then > 0.0 && now > 0.0 && name != "v_s" && name != "f_s" => {
            (now / then).ln().abs() < FAR
        }
        _ => true,
    }
}

/// The free parameters of a model that are no effect's.
fn nominal(rig: &Rig) -> impl Iterator<Item = &String> {
    rig.free.iter().filter(|name| !name.contains('.'))
}

/// Whether no parameter of a model is absurd beside what it is in another.
pub(crate) fn reasonable(rig: &Rig, other: &Rig) -> bool {
    nominal(rig).all(|name| near(name, rig, other))
}

/// Whether friction that grows by the share s sin kq + c cos kq, k > 0, pushes nowhere between two `ends` of the motion
/// and is nowhere there more than (1 + `most`)/(1 − `most`) times what it is elsewhere. Of a long wave only a part is
/// seen, and how large it is as a whole says nothing; what it comes to everywhere is the nominal friction's.
fn varies([s, c, k]: [f64; 3], [low, high]: [f64; 2], most: f64) -> bool {
    let at = |q: f64| s * (k * q).sin() + c * (k * q).cos();
    let (amplitude, phase) = (s.hypot(c), s.atan2(c));
    // In halves of a wave from its crest: crests are at even numbers, troughs at odd ones.
    let [from, to] = [low, high].map(|q| (k * q - phase) / PI);
    let has = |odd: f64| 2.0 * ((from - odd) / 2.0).ceil() + odd <= to;
    let most_there = if has(0.0) { amplitude } else { at(low).max(at(high)) };
    let least_there = if has(1.0) { -amplitude } else { at(low).min(at(high)) };
    least_there > -1.0 && (1.0 + most_there) * (1.0 - most) <= (1.0 + most) * (1.0 + least_there)
}

/// What has fallen off before the motion reaches so much of its largest velocity has done so within presliding, where
/// it only moves a rest by less than a sensor's step: the records of the benchmark have v_S from 0.03, the paper's rig
/// has 5e-4.
const SLOWEST: f64 = 5e-4;

/// Where no friction is told of, drag that stops growing at so much of the largest velocity is dry friction.
const AT_ONCE: f64 = 0.08;

/// Of what does not begin smoothly so much less than is tried is none.
const TOO_LITTLE: f64 = 0.1;

/// What gives way under the largest drive by more than so much of all the way is no gear: its load would go a way of its own,
/// which is free in every window and takes up whatever else is missing.
const GIVES: f64 = 0.3;

/// What is less than this share of the mass is no load behind a joint.
const LIGHTEST: f64 = 0.01;

/// A force that repeats along the way does so on the record's.
const REPEATS: f64 = 0.75;

/// Whether every value has a plausible sign and size, and no nominal parameter went to one that is absurd beside those
/// of all `others`.
pub(crate) fn plausible(rig: &Rig, kind: Kind, context: &Context, others: &[&Rig]) -> bool {
    let about = kind.about();
    // No effect is stronger than what drives the plant; its friction may be weak.
    let driven = Context { force: context.drive, ..*context };
    let value = |key: &Key| rig.value(&format!("{}.{}", about.name, key.name)).unwrap_or(0.0);
    let wave: Vec<f64> = about.keys.iter().map(value).collect();
    let ends = [context.low, context.low + context.span];
    let bare = rig.friction.name == "none";
    let own = about.keys.iter().all(|key| {
        let value = value(key);
        let size = context.size(key.measure).max(driven.size(key.measure));
        let gives = GIVES * context.span / context.drive;
        let most = key.most * if key.measure == Measure::Flexibility { gives } else { size };
        let least = context.size(key.measure).min(driven.size(key.measure));
        let least = kind.tried().first().map_or(0.0, |tried| TOO_LITTLE * tried * least);
        let sign = match key.sign {
            Sign::Any => true,
            Sign::Positive => value >= 0.0,
            Sign::Negative => value <= 0.0,
        };
        let little = match (key.shape, key.measure, wave.as_slice()) {
            (_, Measure::Amplitude, [sine, cosine, wavenumber, ..]) => {
                varies([*sine, *cosine, *wavenumber], ends, key.most)
            }
            // What it has come to by the record's end.
            (Shape::Amount, ..) if kind == Kind::FrictionDrift => {
                (value * (1.0 - (-context.duration / wave[1]).exp())).abs() <= key.most
            }
            (Shape::Amount, ..) => (least..=most).contains(&value.abs()),
            // What does not repeat on the way is a constant force, or one that grows along it.
            (_, Measure::Wavenumber, _) if kind == Kind::Cogging => {
                value * context.span > REPEATS * TAU
            }
            (_, Measure::Speed, _) if kind == Kind::SublinearDrag && bare => {
                value.abs() >= AT_ONCE * context.speed
            }
            (_, Measure::One, _) if !kind.tried().is_empty() && key.name == "ratio" => {
                value >= LIGHTEST
            }
            (_, Measure::Speed, _) => value.abs() >= SLOWEST * context.speed,
            (Shape::Fitted, Measure::One, _) => value <= key.most,
            _ => true,
        };
        sign && value.is_finite() && little
    });
    own && nominal(rig).all(|name| others.iter().any(|other| near(name, rig, other)))
}

/// The sizes of a record, in which effects are measured.
pub(crate) fn context(board: &Board<'_>, fitted: &Fitted) -> Context {
    let data = board.data;
    let rig = &fitted.rig;
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let model = identify::fit::binding::model::<f64>(rig, &|_| None);
    let input = if board.imposed() { 1.0 } else { largest(&data.input).max(f64::MIN_POSITIVE) };
    let drive = data.force(rig);
    let level = model.contact.level();
    let moved = match (&data.displacement, board.imposed()) {
        (Some(seen), _) => seen.values.as_slice(),
        (None, _) => data.input.as_slice(),
    };
    let (low, high) =
        moved.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let speed = if board.imposed() {
        let steps = data.input.windows(2).zip(data.time.windows(2));
        steps.map(|(u, t)| ((u[1] - u[0]) / (t[1] - t[0])).abs()).fold(0.0, f64::max)
    } else {
        data.speed()
    };
    let pull =
        data.loads.as_ref().map_or(0.0, |l| largest(&l[0].values).max(largest(&l[1].values)));
    Context {
        input,
        force: if level > 0.0 { level } else { drive },
        drive,
        cells: data.loads.as_ref().map_or(0, |loads| loads.len()),
        pull: pull.max(1e-9),
        speed: speed.max(1e-12),
        low: if low.is_finite() { low } else { 0.0 },
        span: (high - low).max(1e-12),
        memory: model.contact.memory(),
        duration: data.time[data.time.len() - 1] - data.time[0],
        sample_time: data.sample_time(),
        mass: model.balance.mass,
        turns: identify::rig::Kind::of(rig.kind).is_some_and(identify::rig::Kind::turns),
        hidden: rig.kind == "axis",
        loaded: model.balance.stiffness != 0.0 || model.balance.gravity != 0.0,
        waves: [[0.0; WAVES]; 2],
        halves: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::plausible;
    use identify::{
        Rig,
        effects::{Context, Kind, WAVES},
    };

    const RIG: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n\
        [friction]\nname = \"coulomb\"\nf_c = 1.0\n\
        [channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n\
        [[effect]]\nname = \"position_friction\"\n";

    const CONTEXT: Context = Context {
        input: 1.0,
        force: 1.0,
        drive: 1.0,
        cells: 0,
        pull: 1.0,
        speed: 1.0,
        low: -0.25,
        span: 0.5,
        memory: 1e-3,
        duration: 60.0,
        sample_time: 0.005,
        mass: 2.0,
        turns: false,
        hidden: false,
        loaded: true,
        waves: [[0.0; WAVES]; 2],
        halves: 0,
    };

    /// Whether an effect with these keys is plausible in place of the rig's.
    fn plausibly(kind: Kind, keys: &str) -> bool {
        let effect = format!("name = \"{}\"\n{keys}", kind.about().name);
        let rig = Rig::parse(&RIG.replace("name = \"position_friction\"\n", &effect)).unwrap();
        plausible(&rig, kind, &CONTEXT, &[&rig])
    }

    /// Whether friction that grows by s sin kq + c cos kq is plausible on a record between -0.25 and 0.25 m.
    fn fits([s, c, k]: [f64; 3]) -> bool {
        let keys = format!("sine = {s:?}\ncosine = {c:?}\nwavenumber = {k:?}\n");
        plausibly(Kind::PositionFriction, &keys)
    }

    #[test]
    fn friction_that_falls_off_within_presliding_is_no_stribeck_effect() {
        let of = |v_s: f64| plausibly(Kind::Stribeck, &format!("drop = 0.3\nv_s = {v_s:?}\n"));
        // Of 1 m/s.
        assert!(of(0.01) && of(1e-3) && !of(1e-4));
    }

    #[test]
    fn a_contact_that_still_gives_way_where_it_has_slid_for_long_is_no_presliding() {
        let of = |gamma: f64| {
            plausibly(Kind::Presliding, &format!("sigma = 100.0\ngamma = {gamma:?}\n"))
        };
        assert!(of(0.25) && of(2.0) && !of(4.64));
    }

    #[test]
    fn what_weighs_nothing_is_no_load_and_what_gives_way_as_far_as_it_goes_no_gear() {
        let of = |compliance: f64, ratio: f64| {
            let keys = format!(
                "compliance = {compliance:?}\nratio = {ratio:?}\ndamping = 0.5\nrubs = 1e-3\n"
            );
            plausibly(Kind::Compliance, &keys)
        };
        assert!(of(0.01, 0.02) && !of(0.01, 0.004));
        // By 1 N on a way of 0.5 m.
        assert!(of(0.14, 0.2) && !of(0.16, 0.2));
    }

    #[test]
    fn a_wave_is_judged_by_its_extremes_where_the_record_goes() {
        // Along a slope friction changes by 3 · 0.125 = 0.37 of itself to either side; a wave of three times friction
        // would push.
        assert!(fits([3.0, 0.0, 0.5]) && !fits([3.0, 0.0, 50.0]));
        // A long wave's crest is what friction is everywhere, and its trough would push.
        assert!(fits([0.0, 3.0, 0.5]) && !fits([0.0, -3.0, 0.5]));
        // Between 1 - 0.89 and 1 + 0.89, or 1 - 0.905 and 1 + 0.905: a crest and a trough 1/6 m to either side.
        let k = std::f64::consts::PI;
        assert!(fits([0.89, 0.0, 3.0 * k]) && !fits([0.905, 0.0, 3.0 * k]));
        // A quarter of a wave with its crest in the middle goes from 1 + 3 cos(π/4) to 1 + 3.
        assert!(fits([0.0, 3.0, k]));
        // With its trough there, the friction is 1 - 0.98 in the middle and 1 - 0.98 cos(π/2) at the ends: 50 times.
        assert!(!fits([0.0, -0.98, 2.0 * k]) && fits([0.0, -0.9, 2.0 * k]));
    }
}
