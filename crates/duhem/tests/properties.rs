//! What holds of every model of friction under every motion, on exact solutions; and that each of these
//! properties can fail where theory says that it does.

use duhem::{
    Dahl, Input, LuGre, MaxwellSlip,
    closed_form::{
        dahl, lugre,
        maxwell_slip::{self, saturation_force, stop},
    },
};
use proptest::{collection::vec, prelude::*};

fn cases() -> ProptestConfig {
    ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() }
}

/// Turning points in units of the model's own length, and the speeds of the legs in units of its own.
fn path() -> impl Strategy<Value = Vec<(f64, f64)>> {
    vec((-10.0..10.0_f64, 1e-3..1e2_f64), 1..8)
}

fn any_dahl() -> impl Strategy<Value = Dahl> {
    (0.1..10.0_f64, 0.1..1e5_f64, prop_oneof![Just(0.0), Just(1.0), 0.0..3.0_f64])
        .prop_map(|(f_c, sigma, gamma)| Dahl { f_c, sigma, gamma })
}

fn any_lugre() -> impl Strategy<Value = LuGre> {
    let damping = (0.0..1e3_f64, 0.0..10.0_f64);
    (0.1..10.0_f64, 1.0..3.0_f64, 1e-4..0.1_f64, 1e2..1e6_f64, damping).prop_map(
        |(f_c, stiction, v_s, sigma_0, (sigma_1, sigma_2))| LuGre {
            f_c,
            f_s: f_c * stiction,
            v_s,
            sigma_0,
            sigma_1,
            sigma_2,
        },
    )
}

fn any_maxwell_slip() -> impl Strategy<Value = MaxwellSlip> {
    vec((0.1..10.0_f64, 1e-3..1e-1_f64), 1..6).prop_map(|elements| {
        let (k, delta) = elements.into_iter().unzip();
        MaxwellSlip { k, delta }
    })
}

fn of_the_paper() -> LuGre {
    LuGre { f_c: 1.0, f_s: 1.5, v_s: 0.001, sigma_0: 1e5, sigma_1: 1e5_f64.sqrt(), sigma_2: 0.4 }
}

/// The sampled input through the turning points, times `length` [m], with legs at the speeds, times `speed` [m/s].
fn through(path: &[(f64, f64)], length: f64, speed: f64) -> (Input, f64) {
    let (mut t, mut u) = (vec![0.0], vec![0.0]);
    for (turn, pace) in path {
        let (now, last) = (*t.last().expect("a point"), *u.last().expect("a point"));
        let way = (turn * length - last).abs().max(1e-9 * length);
        t.push(now + way / (pace * speed));
        u.push(turn * length);
    }
    let end = *t.last().expect("a point");
    (Input::sampled(t, u).expect("an input"), end)
}

fn rest(model: &MaxwellSlip) -> Vec<f64> {
    vec![0.0; model.k.len()]
}

/// The force at the end of a path, by the exact solution from rest or from `share` of the largest state.
fn dahl_force(model: &Dahl, (input, end): &(Input, f64), share: f64) -> f64 {
    dahl::Trajectory::new(model, input, share * model.f_c, (0.0, *end))
        .expect("an exact answer")
        .force(*end)
}

fn lugre_deflection(model: &LuGre, (input, end): &(Input, f64), share: f64) -> f64 {
    let x0 = share * model.f_s / model.sigma_0;
    lugre::Trajectory::new(model, input, x0, (0.0, *end)).expect("an exact answer").deflection(*end)
}

fn maxwell_force(model: &MaxwellSlip, (input, end): &(Input, f64), share: f64) -> f64 {
    let x0: Vec<f64> = model.delta.iter().map(|delta| -share * delta).collect();
    maxwell_slip::Trajectory::new(model, input, &x0, (0.0, *end))
        .expect("an exact answer")
        .force(*end)
}

fn largest(model: &MaxwellSlip) -> f64 {
    model.delta.iter().copied().fold(0.0, f64::max)
}

/// Legs cut in two at random places, with speeds of their own: the same displacements in another time.
fn in_other_time(path: &[(f64, f64)], cuts: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut last = 0.0;
    let mut cut = Vec::new();
    for ((turn, pace), (share, factor)) in path.iter().zip(cuts.iter().cycle()) {
        cut.push((last + share * (turn - last), pace * factor));
        cut.push((*turn, pace / factor));
        last = *turn;
    }
    cut
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn dahl_s_force_stays_within_f_c(model in any_dahl(), path in path(), share in -1.0..=1.0_f64) {
        let force = dahl_force(&model, &through(&path, model.f_c / model.sigma, 1.0), share);
        prop_assert!(force.abs() <= model.f_c * (1.0 + 4.0 * f64::EPSILON), "{} N of {} N", force, model.f_c);
    }

    #[test]
    fn lugre_s_deflection_stays_within_f_s_over_sigma_0(
        model in any_lugre(), path in path(), share in -1.0..=1.0_f64,
    ) {
        let most = model.f_s / model.sigma_0;
        let x = lugre_deflection(&model, &through(&path, most, model.v_s), share);
        prop_assert!(x.abs() <= most * (1.0 + 4.0 * f64::EPSILON), "{} m of {} m", x, most);
    }

    #[test]
    fn maxwell_slip_s_force_stays_within_its_saturation(
        model in any_maxwell_slip(), path in path(), share in -1.0..=1.0_f64,
    ) {
        let force = maxwell_force(&model, &through(&path, 0.3 * largest(&model), 1.0), share);
        let most = saturation_force(&model);
        prop_assert!(force.abs() <= most * (1.0 + 1e-13), "{} N of {} N", force, most);
    }

    #[test]
    fn the_mirror_image_of_a_motion_has_the_mirror_image_of_the_force(
        dahl in any_dahl(), lugre in any_lugre(), slip in any_maxwell_slip(), path in path(), share in -1.0..=1.0_f64,
    ) {
        let mirrored: Vec<_> = path.iter().map(|(turn, pace)| (-turn, *pace)).collect();
        let both = |length: f64, speed: f64| [through(&path, length, speed), through(&mirrored, length, speed)];
        let [a, b] = both(dahl.f_c / dahl.sigma, 1.0);
        prop_assert_eq!(dahl_force(&dahl, &a, share), -dahl_force(&dahl, &b, -share));
        let [a, b] = both(lugre.f_s / lugre.sigma_0, lugre.v_s);
        prop_assert_eq!(lugre_deflection(&lugre, &a, share), -lugre_deflection(&lugre, &b, -share));
        let [a, b] = both(0.3 * largest(&slip), 1.0);
        prop_assert_eq!(maxwell_force(&slip, &a, share), -maxwell_force(&slip, &b, -share));
    }

    #[test]
    fn another_time_changes_nothing_for_dahl_and_maxwell_slip(
        dahl in any_dahl(), slip in any_maxwell_slip(), path in path(),
        cuts in vec((0.01..0.99_f64, 0.01..100.0_f64), 1..8),
    ) {
        let other = in_other_time(&path, &cuts);
        let length = dahl.f_c / dahl.sigma;
        let (a, b) = (through(&path, length, 1.0), through(&other, length, 1.0));
        let off = dahl_force(&dahl, &a, 0.3) - dahl_force(&dahl, &b, 0.3);
        // For γ < 1 the power of a number of two roundings near zero: their (1 − γ)-th share of digits is lost.
        prop_assert!(off.abs() <= 1e-9 * dahl.f_c, "{:e} N of {} N", off, dahl.f_c);
        let length = 0.3 * largest(&slip);
        let (a, b) = (through(&path, length, 1.0), through(&other, length, 1.0));
        let off = maxwell_force(&slip, &a, 0.3) - maxwell_force(&slip, &b, 0.3);
        prop_assert!(off.abs() <= 1e-12 * saturation_force(&slip), "{:e} N", off);
    }

    #[test]
    fn another_time_changes_lugre(way in 1.0..20.0_f64, pace in 0.1..0.5_f64) {
        // From creep to twice v_S the bristles give way from F_S to F_C.
        let model = of_the_paper();
        let most = model.f_s / model.sigma_0;
        let slow = lugre_deflection(&model, &through(&[(way, 0.1 * pace)], most, model.v_s), 0.0);
        let fast = lugre_deflection(&model, &through(&[(way, 5.0 * pace)], most, model.v_s), 0.0);
        prop_assert!((slow - fast).abs() > 1e-3 * most, "{:e} and {:e} m", slow, fast);
    }

    #[test]
    fn dahl_s_loop_scales_with_the_units(
        model in any_dahl(), reach in 0.1..10.0_f64, n in 1e-3..1e3_f64, m in 1e-3..1e3_f64,
    ) {
        let scaled = Dahl { f_c: model.f_c * n, sigma: model.sigma * n / m, gamma: model.gamma };
        let half = reach * model.f_c / model.sigma;
        let (a, b) = (dahl::Loop::new(&model, (-half, half)), dahl::Loop::new(&scaled, (-half * m, half * m)));
        near(b.force_at_u_max, a.force_at_u_max * n)?;
        // An elastic loop, of γ = 0, encloses rounding: relative to the rectangle around the loop.
        let size = a.force_at_u_max * half;
        prop_assert!((b.area() / (n * m) - a.area()).abs() < 1e-11 * size, "{} and {} J", a.area(), b.area());
        near(b.lag(), a.lag() * m)?;
    }

    #[test]
    fn lugre_scales_with_the_units(
        model in any_lugre(), path in path(), n in 1e-3..1e3_f64, m in 1e-3..1e3_f64, s in 1e-3..1e3_f64,
    ) {
        let scaled = in_units(&model, n, m, s);
        let (length, speed) = (model.f_s / model.sigma_0, model.v_s);
        let run = |model: &LuGre, (input, end): &(Input, f64)| {
            lugre::Trajectory::new(model, input, 0.0, (0.0, *end)).expect("an exact answer")
        };
        let a = run(&model, &through(&path, length, speed));
        let b = run(&scaled, &through(&path, length * m, speed * m / s));
        let size = a.work().abs() + model.f_s * length;
        prop_assert!((b.work() / (n * m) - a.work()).abs() < 1e-9 * size, "{} and {} J", a.work(), b.work());
        if let (Some(a), Some(b)) = (lugre::steady_extrema(&model), lugre::steady_extrema(&scaled)) {
            near(b.maximum, a.maximum * m / s)?;
        }
        let (a, b) = (lugre::returning_speed(&model), lugre::returning_speed(&scaled));
        if let (Some(a), Some(b)) = (a, b) {
            prop_assert!((b * s / m / a - 1.0).abs() < 1e-9, "{} and {} m/s", a, b);
        }
    }

    #[test]
    fn maxwell_slip_s_loop_scales_with_the_units(
        model in any_maxwell_slip(), reach in 0.5..3.0_f64, n in 1e-3..1e3_f64, m in 1e-3..1e3_f64,
    ) {
        let scaled = MaxwellSlip {
            k: model.k.iter().map(|k| k * n / m).collect(),
            delta: model.delta.iter().map(|delta| delta * m).collect(),
        };
        let half = reach * largest(&model);
        let settled = |model: &MaxwellSlip, half: f64| maxwell_slip::Loop::new(model, (-half, half), 0.0, &rest(model));
        let (a, b) = (settled(&model, half), settled(&scaled, half * m));
        near(b.force_at_u_max(), a.force_at_u_max() * n)?;
        // The area is a difference of lengths: relative to the rectangle around the loop.
        let size = saturation_force(&model) * half;
        prop_assert!((b.area() / (n * m) - a.area()).abs() < 1e-12 * size, "{} and {} J", a.area(), b.area());
    }

    #[test]
    fn dahl_loses_energy_on_closed_loops(
        model in any_dahl(), turns in vec(-3.0..3.0_f64, 2..6),
    ) {
        let length = model.f_c / model.sigma;
        let (mut force, mut lost, mut moved) = (0.0, 0.0, f64::INFINITY);
        for _ in 0..100 {
            let start = force;
            lost = 0.0;
            let legs = turns.iter().zip(turns.iter().cycle().skip(1));
            for way in legs.map(|(from, to)| (to - from) * length) {
                lost += dahl::work(&model, force, way);
                force = dahl::advance(&model, force, way);
            }
            moved = f64::abs(force - start);
        }
        prop_assume!(moved <= 1e-12 * model.f_c);
        let size = model.f_c * length;
        prop_assert!(lost >= -1e-11 * size, "{:e} J of {:e} J", lost, size);
    }

    #[test]
    fn maxwell_slip_loses_energy_on_closed_loops(
        model in any_maxwell_slip(), turns in vec(-2.0..2.0_f64, 2..6), share in -1.0..=1.0_f64,
    ) {
        let length = largest(&model);
        let mut z: Vec<f64> = model.delta.iter().map(|delta| share * delta).collect();
        let mut lost = 0.0;
        // The second time round every element is where it was: the largest excursion has wiped out the start.
        for _ in 0..2 {
            lost = 0.0;
            let legs = turns.iter().zip(turns.iter().cycle().skip(1));
            for way in legs.map(|(from, to)| (to - from) * length) {
                lost += maxwell_slip::work(&model, &z, way);
                z = z.iter().zip(&model.delta).map(|(z, delta)| stop(*z, way, *delta)).collect();
            }
        }
        let size = saturation_force(&model) * length;
        prop_assert!(lost >= -1e-12 * size, "{:e} J of {:e} J", lost, size);
    }

    #[test]
    fn lugre_loses_energy_on_closed_loops_below_its_speed(
        turns in vec((-10.0..10.0_f64, 0.0..1.0_f64), 2..7), model in any_lugre(),
    ) {
        // The slowest third creeps, the fastest third is at the limit.
        let limit = lugre::returning_speed(&model).unwrap_or(10.0 * model.v_s).min(1e3 * model.v_s);
        let pace = |p: f64| limit * 10f64.powf((6.0 * p - 4.0).min(0.0)) * (1.0 - 1e-9);
        let lost = lost_on(&model, &turns.iter().map(|(u, p)| (*u, pace(*p))).collect::<Vec<_>>());
        prop_assert!(lost > 0.0, "{:e} J", lost);
    }

    #[test]
    fn the_power_lost_is_never_negative_below_the_speeds(
        model in any_lugre(), x in -1.0..=1.0_f64, far in -1e3..1e3_f64, part in -1.0..=1.0_f64,
    ) {
        let most = model.f_s / model.sigma_0;
        let scale = |v: f64| 1e-12 * model.f_s * f64::abs(v);
        let v = part * lugre::returning_speed(&model).unwrap_or(1.0);
        let lost = lugre::dissipation(&model, x * most, v);
        prop_assert!(lost >= -scale(v), "{:e} W at x = {} F_S/σ₀, {} m/s", lost, x, v);
        let v = part * lugre::dissipative_speed(&model).min(1e3);
        let lost = lugre::dissipation(&model, far * most, v);
        prop_assert!(lost >= -scale(v) * far * far, "{:e} W at x = {} F_S/σ₀, {} m/s", lost, far, v);
    }
}

fn near(a: f64, b: f64) -> Result<(), TestCaseError> {
    prop_assert!((a - b).abs() <= 1e-11 * a.abs().max(b.abs()), "{:e} and {:e}", a, b);
    Ok(())
}

/// The same model with the newton n, the metre m and the second s times as small.
fn in_units(model: &LuGre, n: f64, m: f64, s: f64) -> LuGre {
    LuGre {
        f_c: model.f_c * n,
        f_s: model.f_s * n,
        v_s: model.v_s * m / s,
        sigma_0: model.sigma_0 * n / m,
        sigma_1: model.sigma_1 * n * s / m,
        sigma_2: model.sigma_2 * n * s / m,
    }
}

/// The energy [J] lost in a settled period through these turning points, in F_S/σ₀, at these speeds [m/s].
fn lost_on(model: &LuGre, turns: &[(f64, f64)]) -> f64 {
    let length = model.f_s / model.sigma_0;
    let (mut t, mut u) = (vec![0.0], vec![turns[0].0 * length]);
    for (turn, speed) in turns.iter().skip(1).chain([&turns[0]]) {
        let way = (turn * length - u.last().expect("a point")).abs().max(1e-6 * length);
        t.push(t.last().expect("a point") + way / speed);
        u.push(turn * length);
    }
    lugre::settled(model, &Input::polyline(t, u).expect("an input"))
        .expect("an exact answer")
        .work()
}

#[test]
fn outside_the_admissible_states_the_bounds_do_not_hold() {
    let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 1.0 };
    let still = through(&[(1e-3, 1.0)], 0.5, 1.0);
    assert!(dahl_force(&dahl, &still, 1.01) > 0.75);
    let model = of_the_paper();
    let still = through(&[(1e-3, 1.0)], 1.5e-5, model.v_s);
    assert!(lugre_deflection(&model, &still, 1.01) > 1.5e-5);
    let slip = MaxwellSlip { k: vec![2.0], delta: vec![0.25] };
    assert!(maxwell_force(&slip, &through(&[(10.0, 1.0)], 1.0, 1.0), 1.01) > 0.5);
}

#[test]
fn a_unit_of_time_forgotten_in_the_damping_does_not_scale() {
    let model = of_the_paper();
    let right = in_units(&model, 1.0, 1.0, 60.0);
    let wrong = LuGre { sigma_1: model.sigma_1, ..right.clone() };
    let path = [(4.0, 1.0), (-3.0, 0.5)];
    let work = |model: &LuGre, speed: f64| {
        let (input, end) = through(&path, 1.5e-5, speed);
        lugre::Trajectory::new(model, &input, 0.0, (0.0, end)).expect("an exact answer").work()
    };
    let (given, scaled) = (work(&model, 1e-3), work(&right, 1e-3 / 60.0));
    assert!((scaled / given - 1.0).abs() < 1e-12, "{given} and {scaled} J");
    let off = work(&wrong, 1e-3 / 60.0) / given - 1.0;
    assert!(off.abs() > 1e-4, "off by {off:e} only");
}

#[test]
fn above_its_speed_lugre_gives_energy_back_and_without_a_stribeck_effect_it_does_not() {
    // A jump at 1 m/s after a creep, and creep back.
    let turns = [(0.0, 1e-5), (3.3, 1.0), (-6.7, 1e-5)];
    let lost = lost_on(&of_the_paper(), &turns);
    assert!(lost < -1e-3, "{lost} J");
    let flat = LuGre { f_s: 1.0, ..of_the_paper() };
    let lost = lost_on(&flat, &turns);
    assert!(lost > 0.0, "{lost} J");
    assert!(lugre::dissipation(&of_the_paper(), 1.5e-5, 0.0143) < 0.0);
}

#[test]
fn on_an_open_path_the_springs_give_back_what_they_stored() {
    // So that a loss on every closed loop says something: on the way back to zero force there is none.
    let slip = MaxwellSlip { k: vec![2.0], delta: vec![0.25] };
    assert!((maxwell_slip::work(&slip, &[0.25], -0.25) + 0.0625).abs() < 1e-15);
    let dahl = Dahl { f_c: 0.75, sigma: 1.5, gamma: 1.0 };
    assert!(dahl::work(&dahl, 0.5, -0.1) < -0.03);
}

#[test]
fn equation_24_as_printed_is_not_its_own_mirror_image_at_the_deadband() {
    let slip = MaxwellSlip { k: vec![2.0], delta: vec![0.25] };
    let (mut up, mut down) = ([0.0], [0.0]);
    slip.x_dot_as_printed(&[-0.25], 0.0, 1.0, &mut up);
    slip.x_dot_as_printed(&[0.25], 0.0, -1.0, &mut down);
    assert_eq!((up, down), ([1.0], [0.0]), "m/s");
}
