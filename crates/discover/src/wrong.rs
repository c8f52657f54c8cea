//! Which given values are wrong: the fewest that have to move further than nominal values are off.
//!
//! Along a ridge of the misfit a fit moves many parameters far and gains nothing by it. So the question is not where
//! they went, but what is lost if all but a few stay where a nominal value may be.

use identify::{
    Rig,
    fit::{binding::Scale, problem::Problem},
};
use nalgebra::{DMatrix, DVector};

/// How much a nominal value is off, of itself.
const OFF: f64 = 0.02;

/// So many standard deviations of χ² more than expected are too many.
const TOO_MANY: f64 = 5.0;

/// More wrong values than this are not told one by one.
const MOST: usize = 8;

/// A fitted model near its minimum.
pub(crate) struct Minimum<'a> {
    /// The problem, its variables counted from the fitted values.
    pub(crate) problem: &'a Problem<'a>,
    /// The variables at the minimum.
    pub(crate) x: &'a [f64],
    /// JᵀJ, of all residuals divided by their standard deviation.
    pub(crate) curvature: DMatrix<f64>,
}

/// Which of the free parameters are wrong: their places.
pub(crate) fn wrong(minimum: &Minimum<'_>, rig: &Rig) -> Vec<usize> {
    let n = minimum.x.len();
    if n == 0 {
        return Vec::new();
    }
    let nominal: Vec<Option<(f64, f64)>> = (0..n).map(|i| near(minimum, rig, i)).collect();
    let count = nominal.iter().flatten().count() as f64;
    let enough = count + TOO_MANY * (2.0 * count).sqrt();
    let mut loose: Vec<usize> = Vec::new();
    while cost(minimum, &nominal, &loose) > enough && loose.len() < MOST.min(n) {
        let with = |i: &usize| {
            let more: Vec<usize> = loose.iter().copied().chain([*i]).collect();
            cost(minimum, &nominal, &more)
        };
        let rest = (0..n).filter(|i| nominal[*i].is_some() && !loose.contains(i));
        let Some(best) = rest.min_by(|a, b| with(a).total_cmp(&with(b))) else { break };
        loose.push(best);
    }
    loose
}

/// How far a parameter may be off because of what is given beside it and not free, each by [`OFF`]: as a root mean square
/// and at most.
pub(crate) fn besides(rig: &Rig, name: &str) -> [f64; 2] {
    let parts = match name {
        "sigma_2" => damping(rig),
        "k_1" => spring(rig, "k_2"),
        "k_2" => spring(rig, "k_1"),
        _ => Vec::new(),
    };
    let rms = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    [OFF * rms, OFF * parts.iter().sum::<f64>()]
}

/// The damping by a motor's back-EMF, K²/R, once for each of its constants: it cannot be told from viscous friction.
///
/// Where the inertia is free all forces may have another scale, that of K/R: with K u/R − K² q'/R − σ₂ q' of the drive
/// and of its model in that ratio, σ₂ makes up for (K/R) times the difference of the two K alone.
fn damping(rig: &Rig) -> Vec<f64> {
    let damping = identify::fit::binding::model::<f64>(rig, &|_| None).balance.damping;
    let scales = rig.free.iter().any(|free| free == "inertia");
    if scales { vec![damping] } else { vec![damping, 2.0 * damping] }
}

/// Of one spring of a drum without load cells, what the radius, the drive's constant and the `other` spring make of it: its
/// motion shows r²(k₁ + k₂)/K_m alone.
fn spring(rig: &Rig, other: &str) -> Vec<f64> {
    if rig.kind != "drum" || rig.channels.contains_key("force_1") {
        return Vec::new();
    }
    let value = |key: &str| rig.value(key).unwrap_or(0.0);
    let both = value("k_1") + value("k_2");
    vec![2.0 * both, both, value(other)]
}

/// Where the variable of parameter `i` is at its given value, and the inverse square of how far it may be off; none
/// if nothing is known of it beforehand.
fn near(minimum: &Minimum<'_>, rig: &Rig, i: usize) -> Option<(f64, f64)> {
    let free = &minimum.problem.free[i];
    let given = rig.value(&free.name).filter(|v| *v > 0.0 && !free.name.contains('.'))?;
    let (at, spread) = match free.scale {
        Scale::Linear(size) if free.name.starts_with("f_") => (given / size, OFF * given / size),
        Scale::Linear(_) => return None,
        Scale::Logarithm(_) => {
            (free.variable(given), OFF.hypot(besides(rig, &free.name)[0] / given))
        }
        Scale::InverseSquare(_) => {
            let at = free.variable(given);
            (at, 2.0 * OFF * at)
        }
        // Along the line through the minimum: a given value below the other has no place on the logarithmic scale.
        Scale::Above(_) => {
            let below = rig.value("f_c").unwrap_or(0.0);
            let found = free.value(minimum.x[i]);
            let slope = free.slope(found);
            let at = minimum.x[i] + (given - below - found) / slope;
            (at, OFF * given.hypot(below) / slope)
        }
    };
    at.is_finite().then_some((at, spread.powi(-2)))
}

/// The least of the misfit above its minimum and of the squares by which all but the `loose` parameters are off, in
/// standard deviations.
fn cost(minimum: &Minimum<'_>, nominal: &[Option<(f64, f64)>], loose: &[usize]) -> f64 {
    let n = nominal.len();
    let held = |i: usize| nominal[i].filter(|_| !loose.contains(&i)).unwrap_or((minimum.x[i], 0.0));
    let away = DVector::from_fn(n, |i, _| held(i).0 - minimum.x[i]);
    let weight = DVector::from_fn(n, |i, _| held(i).1);
    let mut sum = minimum.curvature.clone();
    for i in 0..n {
        // What neither the record nor a nominal value says anything of stays where it is.
        sum[(i, i)] += weight[i] + f64::MIN_POSITIVE.sqrt();
    }
    let scale = DVector::from_fn(n, |i, _| sum[(i, i)].sqrt().recip());
    let scaled = DMatrix::from_fn(n, n, |i, j| sum[(i, j)] * scale[i] * scale[j]);
    if scaled.iter().any(|value| !value.is_finite()) {
        return f64::INFINITY;
    }
    let right = DVector::from_fn(n, |i, _| weight[i] * away[i] * scale[i]);
    let Ok(solved) = scaled.svd(true, true).solve(&right, 1e-12) else { return f64::INFINITY };
    let moved = solved.component_mul(&scale);
    let pulled: f64 = (0..n).map(|i| weight[i] * (moved[i] - away[i]).powi(2)).sum();
    (moved.transpose() * &minimum.curvature * &moved)[(0, 0)] + pulled
}

#[cfg(test)]
mod tests {
    use super::{Minimum, besides, wrong};
    use identify::{
        Hold, Rig,
        fit::{Data, data::Seen, problem::Problem, starts},
    };
    use nalgebra::DMatrix;

    #[test]
    fn viscous_friction_is_no_better_known_than_the_motors_damping() {
        let text = "title = \"a\"\n[plant]\nkind = \"pendulum\"\ninertia = 0.01\nmass = 0.3\nlength = 0.2\n\
                    torque_constant = 0.2\nresistance = 2.0\n[friction]\nname = \"coulomb\"\nf_c = 0.03\n\
                    sigma_2 = 0.004\n[channels]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"q\"\n";
        let rig = Rig::parse(text).unwrap();
        // 0.2²/2 N·m·s/rad: both constants 2 % off, twice and once.
        let [rms, most] = besides(&rig, "sigma_2");
        assert!((rms / (0.02 * 0.02 * 5.0_f64.sqrt()) - 1.0).abs() < 1e-12, "{rms}");
        assert!((most / (0.02 * 0.06) - 1.0).abs() < 1e-12, "{most}");
        // With forces to another scale K alone.
        let free = text.replace("[channels]", "[fit]\nfree = [\"inertia\"]\n[channels]");
        let [rms, most] = besides(&Rig::parse(&free).unwrap(), "sigma_2");
        assert!((rms / (0.02 * 0.02) - 1.0).abs() < 1e-12 && rms.to_bits() == most.to_bits());
        assert_eq!(besides(&rig, "f_c"), [0.0; 2]);
    }

    #[test]
    fn one_of_two_springs_is_no_better_known_than_what_both_turn() {
        let rig = |cells: &str| {
            let text = format!(
                "title = \"a\"\n[plant]\nkind = \"drum\"\ninertia = 1e-3\nradius = 0.05\nk_1 = 40.0\nk_2 = 60.0\n\
                 f_10 = 12.0\nf_20 = 16.0\nmotor_constant = 10.0\ngear_ratio = 50.0\n[friction]\n\
                 name = \"coulomb\"\nf_c = 1.0\n[fit]\nfree = [\"k_1\"]\n[channels]\ntime = \"t\"\n\
                 current = \"i\"\nangle = \"q\"\n{cells}"
            );
            Rig::parse(&text).unwrap()
        };
        // A fiftieth of 100 N/m for the drive, twice that for the radius, a fiftieth of 60 N/m.
        let alone = rig("");
        let [rms, most] = besides(&alone, "k_1");
        let expected = 0.02_f64 * (200.0_f64.powi(2) + 100.0_f64.powi(2) + 60.0_f64.powi(2)).sqrt();
        assert!((rms - expected).abs() < 1e-12 && (most - 7.2).abs() < 1e-12, "{rms}, {most}");
        let cells = "force_1 = \"a\"\nforce_2 = \"b\"\n";
        assert_eq!(besides(&rig(cells), "k_1"), [0.0; 2], "it is seen");
    }

    #[test]
    fn a_stiction_that_is_given_below_the_sliding_friction_is_wrong() {
        let rig = |f_s: f64| {
            let text = format!(
                "title = \"a\"\n[plant]\nkind = \"axis\"\ninertia = 16.0\ngain = 35.0\n[friction]\n\
                 name = \"lugre\"\nf_c = 19.0\nf_s = {f_s:?}\nv_s = 0.01\nsigma_0 = 1e6\nsigma_1 = 5e3\n\
                 sigma_2 = 120.0\n[fit]\nfree = [\"f_c\", \"f_s\"]\n[channels]\ntime = \"t\"\n\
                 voltage = \"u\"\nposition = \"q\"\n"
            );
            Rig::parse(&text).unwrap()
        };
        let time: Vec<f64> = (0..400).map(|i| 0.005 * f64::from(i)).collect();
        let wave: Vec<f64> = time.iter().map(|t| (3.0 * t).sin()).collect();
        let position = Seen::new("position", wave.clone(), 0.0);
        let data = Data::driven(time, wave, Hold::ZeroOrder, position);
        let (given, fitted) = (rig(15.0), rig(29.0));
        let problem = Problem::of(&fitted, &data).unwrap();
        let x = starts::nominal(&problem);
        let place = |name: &str| problem.free.iter().position(|free| free.name == name).unwrap();
        let names = [place("f_c"), place("f_s")];
        // Both are known to a millionth.
        let curvature = DMatrix::from_diagonal_element(2, 2, 1e12);
        let found =
            wrong(&Minimum { problem: &problem, x: &x, curvature: curvature.clone() }, &given);
        assert_eq!(found, [names[1]]);
        let near = rig(28.6);
        assert!(wrong(&Minimum { problem: &problem, x: &x, curvature }, &near).is_empty());
    }
    #[test]
    fn all_values_that_are_wrong_are_told_where_they_are_not_more_than_eight() {
        let rig = |times: f64| {
            let [inertia, f_c, f_s, v_s] = [16.0, 19.0, 29.0, 0.01].map(|value| times * value);
            let [sigma_0, sigma_1, sigma_2] = [1e6, 5e3, 120.0].map(|value| times * value);
            let text = format!(
                "title = \"a\"\n[plant]\nkind = \"axis\"\ninertia = {inertia:?}\ngain = 35.0\n[friction]\n\
                 name = \"lugre\"\nf_c = {f_c:?}\nf_s = {f_s:?}\nv_s = {v_s:?}\nsigma_0 = {sigma_0:?}\n\
                 sigma_1 = {sigma_1:?}\nsigma_2 = {sigma_2:?}\n[fit]\nfree = [\"inertia\", \"f_c\", \"v_s\", \
                 \"sigma_0\", \"sigma_1\", \"sigma_2\"]\n[channels]\ntime = \"t\"\nvoltage = \"u\"\nposition = \"q\"\n"
            );
            Rig::parse(&text).unwrap()
        };
        let time: Vec<f64> = (0..400).map(|i| 0.005 * f64::from(i)).collect();
        let wave: Vec<f64> = time.iter().map(|t| (3.0 * t).sin()).collect();
        let position = Seen::new("position", wave.clone(), 0.0);
        let data = Data::driven(time, wave, Hold::ZeroOrder, position);
        let fitted = rig(1.0);
        let problem = Problem::of(&fitted, &data).unwrap();
        let x = starts::nominal(&problem);
        // Each is known to a millionth.
        let curvature = DMatrix::from_diagonal_element(x.len(), x.len(), 1e12);
        let told = |given: &Rig| {
            let minimum = Minimum { problem: &problem, x: &x, curvature: curvature.clone() };
            let mut places = wrong(&minimum, given);
            places.sort_unstable();
            places
        };
        assert_eq!(told(&rig(0.8)), (0..6).collect::<Vec<_>>());
        assert!(told(&rig(1.01)).is_empty(), "no further off than given values are");
    }
}
