//! Several starts, for the misfit has more than one minimum.

use super::{
    Options,
    binding::{Scale, value},
    problem::Problem,
    search::{End, Found, Patience, TO_THE_END, search},
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// So many of the first looks are followed to the end: the best one after a look is not always the best at last.
const FOLLOWED: usize = 2;

/// A first look from each start.
const LOOK: Patience = Patience { misfit: 1.0, share: 0.0, simulations: 12 };

/// The fit's variables at the nominal values; what is nominally zero begins at its own size.
pub fn nominal(problem: &Problem<'_>) -> Vec<f64> {
    let f_c = value(problem.rig, "f_c").unwrap_or(0.0);
    problem
        .free
        .iter()
        .map(|free| match free.scale {
            Scale::Linear(_) => free.variable(free.given),
            Scale::Above(_) if free.given > f_c => free.variable(free.given - f_c),
            Scale::Logarithm(_) | Scale::InverseSquare(_) if free.given > 0.0 => {
                free.variable(free.given)
            }
            Scale::Above(_) | Scale::Logarithm(_) | Scale::InverseSquare(_) => 1.0,
        })
        .collect()
}

/// The minimum found from the best of the starts: the nominal values, and others drawn around them, up to
/// three times as large or small, and an `other` start if there is one.
pub(super) fn best(problem: &Problem<'_>, options: &Options, other: Option<&[f64]>) -> Found {
    let first = nominal(problem);
    let mut random = ChaCha8Rng::seed_from_u64(options.seed);
    let mut all = vec![first.clone()];
    all.extend(other.map(<[f64]>::to_vec));
    for _ in 0..options.starts {
        let mut x = first.clone();
        for (x, free) in x.iter_mut().zip(&problem.free) {
            let share: f64 = random.random_range(-1.0..1.0);
            match free.scale {
                Scale::Logarithm(_) | Scale::Above(_) => *x += share,
                Scale::InverseSquare(_) => *x *= (2.0 * share).exp(),
                Scale::Linear(_) => {}
            }
        }
        all.push(x);
    }
    let looks: Vec<Found> =
        all.par_iter().map(|x| search(problem, (x, None), None, &LOOK)).collect();
    let spent = looks
        .iter()
        .fold([0, 0], |sum: [usize; 2], f| [sum[0] + f.simulations[0], sum[1] + f.simulations[1]]);
    let mut looks: Vec<Found> = looks.into_iter().filter(|f| f.end != End::NoMotion).collect();
    looks.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    looks.truncate(FOLLOWED);
    let ends: Vec<Found> = looks
        .par_iter()
        .map(|look| search(problem, (&look.x, Some(&look.pieces)), None, &TO_THE_END))
        .collect();
    let all_spent =
        ends.iter().fold(spent, |sum, f| [sum[0] + f.simulations[0], sum[1] + f.simulations[1]]);
    match ends.into_iter().min_by(|a, b| a.misfit.total_cmp(&b.misfit)) {
        Some(best) => Found { simulations: all_spent, ..best },
        None => Found {
            x: first,
            misfit: f64::INFINITY,
            pieces: Vec::new(),
            end: End::NoMotion,
            simulations: spent,
        },
    }
}
