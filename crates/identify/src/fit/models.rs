//! The friction models against one another, on blocks that were not fitted.

use super::{
    Data, Options, binding, blocks,
    problem::{Lead, Piece, Problem, Weights},
    search::End,
    starts,
    window::{START, Window},
};
use crate::Rig;
use duhem::Parameter;
use rayon::prelude::*;

/// A friction model, fitted to half of the blocks and judged on the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The friction model; Maxwell-slip with the number of its elements.
    pub name: String,
    /// The root mean square of the residuals on the blocks not fitted, of the channels' weights [1].
    pub held_out_error: f64,
    /// The same on the blocks it was fitted to.
    pub trained_error: f64,
    /// How many parameters were free.
    pub free: usize,
    /// The rig with this friction, fitted.
    pub rig: Rig,
}

/// The numbers of Maxwell-slip elements that are tried.
const ELEMENTS: [usize; 4] = [1, 2, 4, 8];

/// The rigs with each friction model, started from what `rig` says of its own.
pub fn candidates(rig: &Rig) -> Vec<(String, Rig)> {
    let (f_c, stiffness) = (force(rig), stiffness(rig));
    let viscous = binding::value(rig, "sigma_2").unwrap_or(0.0);
    let with = |name: &str, parameters: Vec<(&str, Parameter)>, sigma_2: f64, free: &[&str]| {
        let mut rig = rig.clone();
        name.clone_into(&mut rig.friction.name);
        rig.friction.parameters = parameters.into_iter().collect();
        rig.friction.sigma_2 = sigma_2;
        let ours = ["f_c", "f_s", "v_s", "sigma", "gamma", "sigma_0", "sigma_1", "sigma_2"];
        rig.free.retain(|f| {
            !ours.contains(&f.as_str()) && !f.starts_with(['k', 'd']) || f == "k_1" || f == "k_2"
        });
        rig.free.extend(free.iter().map(|f| (*f).to_owned()));
        rig
    };
    let number = Parameter::Scalar;
    let coulomb = || vec![("f_c", number(f_c))];
    let mut all = vec![
        ("coulomb".to_owned(), with("coulomb", coulomb(), 0.0, &["f_c"])),
        ("coulomb + viscous".to_owned(), with("coulomb", coulomb(), viscous, &["f_c", "sigma_2"])),
        (
            "dahl".to_owned(),
            with(
                "dahl",
                vec![("f_c", number(f_c)), ("sigma", number(stiffness)), ("gamma", number(1.0))],
                viscous,
                &["f_c", "sigma", "sigma_2"],
            ),
        ),
        ("lugre".to_owned(), lugre(rig, f_c, stiffness, &with)),
    ];
    for count in ELEMENTS {
        let (k, delta) = elements(count, f_c, stiffness);
        let lists = vec![("k", Parameter::List(k)), ("delta", Parameter::List(delta))];
        let rig = with("maxwell-slip", lists, viscous, &["k", "delta", "sigma_2"]);
        all.push((format!("maxwell-slip, N = {count}"), rig));
    }
    all
}

fn lugre(
    rig: &Rig,
    f_c: f64,
    stiffness: f64,
    with: &dyn Fn(&str, Vec<(&str, Parameter)>, f64, &[&str]) -> Rig,
) -> Rig {
    let or = |key: &str, other: f64| {
        Parameter::Scalar(binding::value(rig, key).filter(|v| *v > 0.0).unwrap_or(other))
    };
    let viscous = binding::value(rig, "sigma_2").unwrap_or(0.0);
    let keys = ["f_c", "f_s", "v_s", "sigma_0", "sigma_1", "sigma_2"];
    let parameters = vec![
        ("f_c", Parameter::Scalar(f_c)),
        ("f_s", or("f_s", 1.2 * f_c)),
        ("v_s", or("v_s", 10.0 * f_c / stiffness)),
        ("sigma_0", Parameter::Scalar(stiffness)),
        ("sigma_1", or("sigma_1", stiffness.sqrt())),
        ("sigma_2", Parameter::Scalar(viscous)),
    ];
    with("lugre", parameters, 0.0, &keys)
}

/// The largest force of the friction of `rig` in slow sliding [N].
fn force(rig: &Rig) -> f64 {
    match (rig.friction.parameters.0.get("k"), rig.friction.parameters.0.get("delta")) {
        (Some(Parameter::List(k)), Some(Parameter::List(delta))) => {
            k.iter().zip(delta).map(|(k, d)| k * d).sum()
        }
        _ => binding::value(rig, "f_c").filter(|f| *f > 0.0).unwrap_or(1.0),
    }
}

/// The stiffness of the contact of `rig` before it slides [N/m].
fn stiffness(rig: &Rig) -> f64 {
    if let Some(Parameter::List(k)) = rig.friction.parameters.0.get("k") {
        return k.iter().sum();
    }
    let own = ["sigma_0", "sigma"].iter().find_map(|key| binding::value(rig, key));
    own.filter(|s| *s > 0.0).unwrap_or(1e3 * force(rig))
}

/// `count` elements that together hold `force` [N] and begin with `stiffness` [N/m]: equal stiffnesses, and
/// deadbands spread evenly about their mean.
fn elements(count: usize, force: f64, stiffness: f64) -> (Vec<f64>, Vec<f64>) {
    let n = count as f64;
    let mean = force / stiffness;
    let delta = (0..count).map(|i| mean * 2.0 * (i as f64 + 0.5) / n).collect();
    (vec![stiffness / n; count], delta)
}

/// Every model fitted to half of the blocks of the record and judged on the others, the best first; of
/// Maxwell-slip only the number of elements that is best. All are weighed alike, by `weights`.
pub(super) fn compare(
    rig: &Rig,
    data: &Data,
    options: &Options,
    weights: Weights,
) -> Vec<Candidate> {
    let windows = blocks::blocks(data, options.window);
    if windows.len() < 2 {
        return Vec::new();
    }
    let mut all: Vec<Candidate> = candidates(rig)
        .into_par_iter()
        .filter_map(|(name, rig)| judged(name, &rig, data, (&windows, weights)))
        .collect();
    all.sort_by(|a, b| a.held_out_error.total_cmp(&b.held_out_error));
    let mut seen = false;
    all.retain(|c| !c.name.starts_with("maxwell-slip") || !std::mem::replace(&mut seen, true));
    all
}

/// A model trained on half of the windows and judged on the others. In closed loop, and where the motion is
/// imposed, the record is simulated in one run, and the samples of the other windows do not count.
fn judged(
    name: String,
    rig: &Rig,
    data: &Data,
    (windows, weights): (&[Window], Weights),
) -> Option<Candidate> {
    let base = Problem { weights, ..super::problem(rig, data).ok()? };
    let (train, judge) = blocks::split(windows);
    let only = |some: &[Window]| {
        if base.closed_loop || data.force.is_some() {
            let mut shares = vec![0.0; data.time.len()];
            for window in some {
                shares[window.first..window.end].fill(1.0);
            }
            Problem { shares, ..base.clone() }
        } else {
            Problem { windows: some.to_vec(), ..base.clone() }
        }
    };
    let problem = only(&train);
    let options = Options { starts: 1, ..Options::default() };
    let found = starts::best(&problem, &options, None);
    if found.end == End::NoMotion {
        return None;
    }
    let rms = |problem: &Problem<'_>, some: &[Window]| {
        let samples: usize = some.iter().map(Window::len).sum();
        let pieces = settled(problem, &found.x, None, 2);
        let sum: f64 = pieces.iter().flat_map(|p| &p.residuals).map(|r| r * r).sum();
        (sum / (samples * problem.channels()).max(1) as f64).sqrt()
    };
    let (trained_error, held_out_error) = (rms(&problem, &train), rms(&only(&judge), &judge));
    let free = problem.free.len();
    let rig = super::fitted(&problem, &found);
    Some(Candidate { name, held_out_error, trained_error, free, rig })
}

/// The windows at `x`, their starts fitted, so many times; they begin where they did in `pieces` of a simulation
/// nearby, or, if there are none, as they were seen.
pub fn settled(
    problem: &Problem<'_>,
    x: &[f64],
    pieces: Option<&[Piece]>,
    times: usize,
) -> Vec<Piece> {
    let staying = |p: &Piece| Lead::staying(p.start, x.len());
    let leads: Option<Vec<Lead>> = pieces.map(|pieces| pieces.iter().map(staying).collect());
    let pieces = problem.pieces(x, leads.as_ref().map(|leads| (x, leads.as_slice())));
    followed(problem, x, pieces, times)
}

/// The windows at `x`, simulated already, their starts fitted so many times.
pub(super) fn followed(
    problem: &Problem<'_>,
    x: &[f64],
    mut pieces: Vec<Piece>,
    times: usize,
) -> Vec<Piece> {
    for _ in 0..times {
        let leads: Vec<_> = problem.all_slopes(x, &pieces).into_iter().map(|s| s.lead).collect();
        for (piece, next) in pieces.iter_mut().zip(problem.pieces(x, Some((x, &leads)))) {
            if next.misfit() < piece.misfit() {
                *piece = next;
            }
        }
    }
    pieces
}

/// The same, each window's start followed in so many steps at most.
pub fn converged(
    problem: &Problem<'_>,
    x: &[f64],
    pieces: Option<&[Piece]>,
    most: usize,
) -> Vec<Piece> {
    let first = settled(problem, x, pieces, 0);
    let one = |(window, piece): (&Window, Piece)| problem.nearest(x, window, piece, most);
    problem.windows.par_iter().zip(first).map(one).collect()
}

/// A window that is so much worse than the middle one began in another state of the contact; the second where the
/// model is near, for then all windows leave the same.
const ASTRAY: f64 = 5.0;
const BESIDE: f64 = 2.0;

/// One that is so much worse has gone another way than the record.
const LOST: f64 = 1e3;

/// Where else a contact may begin, from what the run-up says, of its natural size.
const ELSEWHERE: [f64; 8] = [-2.0, -1.0, -0.5, -0.25, 0.25, 0.5, 1.0, 2.0];

/// How far off its tooth a load may begin, of half its play.
const OFF: [f64; 3] = [0.5, 1.0, 2.0];

/// How much faster or slower it may begin, of the spread of the start.
const FASTER: f64 = 0.2;

/// The share of a window in which its start is judged.
const EARLY: usize = 5;

/// A model whose middle window leaves so much is far off, and one whose leaves less than this is near.
const FAR_OFF: f64 = 100.0;
const NEAR: f64 = 4.0;

/// `pieces` once more where they went astray: each begun in several states of the contact and at other speeds, the
/// best one kept.
pub fn rescued(problem: &Problem<'_>, x: &[f64], pieces: Vec<Piece>) -> Vec<Piece> {
    let mean = |p: &Piece| p.misfit() / p.residuals.len().max(1) as f64;
    let mut sorted: Vec<f64> = pieces.iter().map(mean).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(middle) = sorted.get(sorted.len() / 2).copied() else { return pieces };
    // If the middle one is far off it is the model, and little is known of where the windows begin.
    let [tried, followed] = if middle > FAR_OFF { [2, 2] } else { [4, 8] };
    let astray = if middle < NEAR { BESIDE } else { ASTRAY };
    let all: Vec<(&Window, Piece)> = problem.windows.iter().zip(pieces).collect();
    let one = |(window, piece): (&Window, Piece)| {
        if mean(&piece) < astray * middle.max(1.0) || problem.data.force.is_some() {
            return piece;
        }
        let [q, v, ..] = window.start;
        let near = FASTER * window.spread[1];
        let shifts = ELSEWHERE.into_iter().map(|shift| [q, v, shift, 0.0, 0.0]);
        // Whether it rests or creeps is a leap under Coulomb friction.
        let speeds = [0.0, v - near, v + near, -v].into_iter().map(|v| [q, v, 0.0, 0.0, 0.0]);
        // A load may be anywhere in its play.
        let places = if problem.starts() == START { &OFF[..] } else { &[] };
        let places = places.iter().map(|off| [q, v, 0.0, *off, 0.0]);
        // How a window began shows soon.
        let head = window.beginning(window.len() / EARLY);
        let early = |start| problem.piece(x, &head, start).misfit();
        let mut starts: Vec<([f64; START], f64)> =
            shifts.chain(speeds).chain(places).map(|start| (start, early(start))).collect();
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut best = piece;
        let near = middle.max(1.0) * best.residuals.len() as f64;
        let whole = |start| problem.nearest(x, window, problem.piece(x, window, start), followed);
        let farther = |start| problem.farther(x, window, start, followed);
        let ways: [(&dyn Fn([f64; START]) -> Piece, f64); 2] = [(&whole, 1.0), (&farther, LOST)];
        for (way, least) in ways {
            for (start, _) in starts.iter().take(tried) {
                if best.misfit() < least * near {
                    break;
                }
                let next = way(*start);
                if next.misfit() < best.misfit() {
                    best = next;
                }
            }
        }
        best
    };
    all.into_par_iter().map(one).collect()
}
