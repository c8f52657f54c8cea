//! A walk at its beginning, for the tests of its steps.

use super::Walk;
use crate::{
    board::{Board, Fitted},
    verdict::{Discovery, Found, Verdict},
};
use identify::{
    Hold, Rig,
    effects::{Context, Kind},
    fit::{Data, Seen},
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// The force that the rig's equation does not ask for [N].
pub(crate) const BIAS: f64 = 0.3;

/// A mass of `mass` [kg] on a spring of 3 N/m.
pub(crate) fn rig(mass: f64) -> Rig {
    let text = format!(
        "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = {mass:?}\nstiffness = 3.0\n\
         [friction]\nname = \"none\"\nsigma_2 = 0.5\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n"
    );
    Rig::parse(&text).expect("a rig")
}

/// x = sin 2t of 2 kg under the force that its equation asks for, but for the bias; noise of 1 mm.
pub(crate) fn data() -> Data {
    noisy(5)
}

/// The same with the noise of another seed.
pub(crate) fn noisy(seed: u64) -> Data {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
    let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
    let input = time.iter().map(|t| {
        let (s, c) = f64::sin_cos(2.0 * t);
        (3.0 - 2.0 * 4.0) * s + 0.5 * 2.0 * c - BIAS
    });
    let input = input.collect();
    let seen = time.iter().map(|t| (2.0 * t).sin() + 1e-3 * noise()).collect();
    Data::driven(time, input, Hold::Linear, Seen::new("position", seen, 0.0))
}

/// The walk on `data` with the model `rig`, in which all is as given.
pub(super) fn walk<'a>(rig: &Rig, data: &'a Data, loose: &[(String, f64)]) -> Walk<'a> {
    let board = Board::of(rig, data, 1, loose.to_vec()).expect("a board");
    let short = Board::of(rig, data, super::SHORT, loose.to_vec()).expect("a board");
    let counts = board.samples();
    let best = board.judged(rig, None).expect("a motion");
    let given = Fitted::holding(rig);
    Walk {
        board,
        short,
        counts,
        origin: best.clone(),
        best,
        given,
        refit: f64::INFINITY,
        ranking: Vec::new(),
        joins: true,
        firsts: Vec::new(),
        strayed: Vec::new(),
        before_held: None,
        others: &[],
        turned: None,
        reached: 1.0,
        simulations: u64::MAX,
    }
}

/// The same with an effect.
pub(crate) fn with(rig: &Rig, kind: Kind, values: &[f64]) -> Rig {
    let mut rig = rig.clone();
    crate::gram::with(&mut rig, kind, &[], 0);
    let about = kind.about();
    for (key, value) in about.keys.iter().zip(values) {
        let name = format!("{}.{}", about.name, key.name);
        identify::fit::binding::set(&mut rig, &name, *value);
    }
    rig
}

/// The sizes of the record.
pub(super) fn context(walk: &Walk<'_>) -> Context {
    crate::model::context(&walk.board, &walk.best)
}

/// An effect as it is found.
pub(super) fn found(name: &'static str) -> Found {
    let (values, separated_by) = (Vec::new(), String::new());
    Found { name, set: vec![name], values, shrink: 0.9, t: 9.0, separated_by }
}

/// An answer with a model that leaves so much, and nothing else.
pub(super) fn answer(rig: &Rig, verdict: Verdict, left: f64) -> Discovery {
    Discovery {
        verdict,
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
        complete: true,
        rig: rig.clone(),
    }
}

/// Dry friction of 1.5 N to 1 mN, forth and back with rests between, to so many metres.
pub(crate) fn slide(trembles: f64) -> Data {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut noise = |size: f64| -> f64 {
        let drawn: f64 = StandardNormal.sample(&mut random);
        size * drawn
    };
    let (mut x, mut last, mut input, mut force) = (0.0, 0.0, Vec::new(), Vec::new());
    for i in 0..8000 {
        if i % 200 >= 100 {
            last = if i % 400 < 200 { 1.0 } else { -1.0 };
            x += 1e-4 * last;
        }
        input.push(x + noise(trembles));
        force.push(1.5 * last + noise(1e-3));
    }
    let time = (0..8000).map(|i| 0.005 * f64::from(i)).collect();
    let seen = Seen::new("force", force, 0.0);
    let driven = Data::driven(time, input, Hold::Linear, seen.clone());
    Data { displacement: None, force: Some(seen), ..driven }
}

/// A slide with this much dry friction [N].
pub(crate) fn slides(f_c: f64) -> Rig {
    let text = format!(
        "title = \"a slide\"\n[plant]\nkind = \"prescribed\"\n[friction]\nname = \"coulomb\"\n\
         f_c = {f_c:?}\n[channels]\ntime = \"t\"\ndisplacement = \"x\"\nforce = \"f\"\n"
    );
    Rig::parse(&text).unwrap()
}

/// The same mass with dry friction besides.
pub(crate) const DRY: &str = "title = \"a mass\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n[friction]\n\
    name = \"coulomb\"\nf_c = 0.5\nsigma_2 = 0.5\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";

/// x = sin 2t of 2 kg on 3 N/m, viscous by 0.5 N·s/m, under a force that this much is taken from; noise of 0.1 mm.
pub(crate) fn taken(much: impl Fn(f64, f64) -> f64) -> Data {
    taken_in_turn(much)
}

/// The same of a force that hangs on what was before.
pub(crate) fn taken_in_turn(mut much: impl FnMut(f64, f64) -> f64) -> Data {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
    let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
    let input = time.iter().map(|t| {
        let (s, c) = f64::sin_cos(2.0 * t);
        (3.0 - 2.0 * 4.0) * s + 0.5 * 2.0 * c + much(s, 2.0 * c)
    });
    let input = input.collect();
    let seen = time.iter().map(|t| (2.0 * t).sin() + 1e-4 * noise()).collect();
    Data::driven(time, input, Hold::Linear, Seen::new("position", seen, 0.0))
}
