//! The forms an effect may take, against what is known in closed form.

use identify::{
    Hold, Recording, Rig,
    effects::{Context, LAWS, Shape},
    fit::{Data, binding},
    march::{Drive, Motion, Start, Tolerance, march},
};

/// An axis of 2 kg with this friction and effect.
fn axis(friction: &str, effect: &str) -> Rig {
    let text = format!(
        "title = \"t\"\n[plant]\nkind = \"axis\"\ninertia = 2.0\ngain = 1.0\noffset = 0.0\n[friction]\n{friction}\n\
         [channels]\ntime = \"t\"\nvoltage = \"u\"\nposition = \"q\"\n[[effect]]\n{effect}\n"
    );
    Rig::parse(&text).expect("a rig")
}

/// The motion under a constant `drive` [N] for so many samples of 10 ms, from a velocity on.
fn moved(rig: &Rig, drive: f64, samples: u32, v: f64) -> Motion {
    let model = binding::model::<f64>(rig, &|_| None);
    let time: Vec<f64> = (0..samples).map(|i| 0.01 * f64::from(i)).collect();
    let values = vec![drive; time.len()];
    let drive = Drive::Recorded { values: &values, first: 0, hold: Hold::ZeroOrder };
    let start = Start { q: 0.0, v, z: vec![0.0; model.states()], shown: None };
    let tolerance = Tolerance { q: 1e-10, v: 1e-10, z: 1e-10, steps: 10_000_000 };
    march(&model, &drive, &time, &start, &tolerance).expect("a motion")
}

/// The speed at which it ends under a constant drive [N].
fn ends(rig: &Rig, drive: f64) -> f64 {
    moved(rig, drive, 4000, 0.3).v[3999]
}

#[test]
fn eyring_s_drag_is_an_inverse_hyperbolic_sine() {
    let rig = axis("name = \"none\"", "name = \"sublinear_drag\"\nc = 50.0\nv_0 = 0.02\nform = 2");
    for drive in [1.0, -3.0] {
        let exact = 0.02 * f64::sinh(drive / (50.0 * 0.02));
        let v = ends(&rig, drive);
        assert!((v / exact - 1.0).abs() < 1e-8, "{v} m/s for {exact} m/s");
    }
    // Slowly it is viscous.
    let v = ends(&rig, 1e-6);
    assert!((v / (1e-6 / 50.0) - 1.0).abs() < 1e-6, "{v} m/s");
}

#[test]
fn a_drive_without_a_knee_gives_the_tanh_of_what_is_asked() {
    let saturation = "name = \"torque_saturation\"\nloss = 0.8\nknee = 3.0\nwidth = 1.0\nform = 2";
    let rig = axis("name = \"none\"\nsigma_2 = 4.0", saturation);
    for drive in [0.5_f64, 4.0, -20.0] {
        let given = 0.2 * drive + 0.8 * 3.0 * (drive / 3.0).tanh();
        let v = ends(&rig, drive);
        assert!((v / (given / 4.0) - 1.0).abs() < 1e-8, "{v} m/s at {drive} N");
    }
}

#[test]
fn a_drive_may_bend_as_a_power_towards_its_knee() {
    let saturation = "name = \"torque_saturation\"\nloss = 0.8\nknee = 3.0\nwidth = 0.5\nform = 3";
    let rig = axis("name = \"none\"\nsigma_2 = 4.0", saturation);
    for drive in [0.5_f64, 3.0, -20.0] {
        let bent = drive / (1.0 + (drive / 3.0).abs().powi(6)).powf(1.0 / 6.0);
        let given = 0.2 * drive + 0.8 * bent;
        let v = ends(&rig, drive);
        assert!((v / (given / 4.0) - 1.0).abs() < 1e-8, "{v} m/s at {drive} N");
    }
    assert_eq!(
        ends(&rig, 0.0),
        moved(
            &axis("name = \"none\"\nsigma_2 = 4.0", "name = \"quadratic_drag\"\nc = 0.0"),
            0.0,
            4000,
            0.3
        )
        .v[3999]
    );
}

#[test]
fn an_input_that_goes_on_smoothly_is_known_between_its_samples() {
    // 2 kg under 3 N sin ωt with twenty samples a period; ωh = 0.31, and a line would lose (ωh)²/12 = 0.8 % of it.
    let rig = axis("name = \"none\"", "name = \"quadratic_drag\"\nc = 0.0");
    let model = binding::model::<f64>(&rig, &|_| None);
    let (omega, samples) = (0.1 * std::f64::consts::PI, 200_u32);
    let time: Vec<f64> = (0..samples).map(f64::from).collect();
    let values: Vec<f64> = time.iter().map(|t| 3.0 * (omega * t).sin()).collect();
    let start = Start { q: 0.0, v: 0.0, z: vec![0.0; model.states()], shown: None };
    let tolerance = Tolerance { q: 1e-10, v: 1e-10, z: 1e-10, steps: 10_000_000 };
    let worst = |hold: Hold| {
        let drive = Drive::Recorded { values: &values, first: 0, hold };
        let seen = march(&model, &drive, &time, &start, &tolerance).expect("a motion").v;
        let exact = |t: &f64| 1.5 / omega * (1.0 - (omega * t).cos());
        let off = seen.iter().zip(&time).map(|(v, t)| (v - exact(t)).abs());
        off.fold(0.0, f64::max) / (2.0 * 1.5 / omega)
    };
    let (smooth, line) = (worst(Hold::Smooth), worst(Hold::Linear));
    // What the first and the last interval lack of their neighbours is the most of it.
    assert!(smooth < 5e-4 && (line / (omega * omega / 12.0) - 1.0).abs() < 0.1, "{smooth}, {line}");
}

#[test]
fn friction_may_fall_off_with_the_square_of_the_speed() {
    let stribeck = "name = \"stribeck\"\ndrop = 1.0\nv_s = 0.1\nform = 5";
    let rig = axis("name = \"coulomb\"\nf_c = 2.0\nsigma_2 = 40.0", stribeck);
    let v = ends(&rig, 12.0);
    let held = 2.0 + 1.0 / (1.0 + (v / 0.1).powi(2)) + 40.0 * v;
    assert!((held - 12.0).abs() < 1e-6 && v > 0.2, "{held} N at {v} m/s");
}

#[test]
fn friction_that_grows_takes_its_drop_along_or_leaves_it_as_it_is() {
    let (f_c, f_s, v_s, share) = (2.0, 3.0, 0.1_f64, 0.4);
    let bristles = format!(
        "name = \"lugre\"\nf_c = {f_c}\nf_s = {f_s}\nv_s = {v_s}\nsigma_0 = 1e4\nsigma_1 = 10.0\nsigma_2 = 40.0"
    );
    let stronger = [
        format!("name = \"friction_drift\"\namount = {share}\ntau = 1e-3\n"),
        format!("name = \"position_friction\"\nsine = 0.0\ncosine = {share}\nwavenumber = 1e-9\n"),
        // By as much under the drive of 8 N.
        format!("name = \"load_friction\"\nratio = {}\n", share * f_c / 8.0),
    ];
    for (place, effect) in stronger.iter().enumerate() {
        let forms = if place == 2 { [2, 5] } else { [2, 3] };
        for (form, along) in forms.into_iter().zip([true, false]) {
            let v = ends(&axis(&bristles, &format!("{effect}form = {form}")), 8.0);
            let drop = (f_s - f_c) * (-(v / v_s).powi(2)).exp();
            let held = f_c + drop + share * (f_c + if along { drop } else { 0.0 }) + 40.0 * v;
            assert!((held - 8.0).abs() < 1e-6, "{effect}, {form}: {held} N at {v} m/s");
            assert!(drop > 0.1, "it shows: {drop} N");
        }
    }
}

#[test]
fn a_load_is_what_drives_what_pulls_or_what_a_gear_carries_of_both() {
    let (inertia, f_c, ratio, volts, k) = (0.01, 0.02, 0.3, 2.0, 0.4);
    let (q, dt) = (0.3_f64, 1e-7);
    for (form, motor) in (1..=9).map(|form| (form, 1.0)).chain([(7, 3.0), (7, 0.2)]) {
        let rig = format!(
            "title = \"t\"\n[plant]\nkind = \"pendulum\"\ninertia = {inertia}\nmass = 0.5\nlength = 0.1\n\
             torque_constant = {k}\nresistance = 2.0\n[friction]\nname = \"coulomb\"\nf_c = {f_c}\n\
             [channels]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"q\"\n\
             [[effect]]\nname = \"load_friction\"\nratio = {ratio}\nform = {form}\nmotor = {motor}\n"
        );
        let model = binding::model::<f64>(&Rig::parse(&rig).expect("a rig"), &|_| None);
        for v in [0.5, -0.5] {
            let drive = Drive::Recorded { values: &[volts; 2], first: 0, hold: Hold::ZeroOrder };
            let start = Start { q, v, z: vec![0.0; model.states()], shown: None };
            let tolerance = Tolerance { q: 1e-12, v: 1e-12, z: 1e-12, steps: 1000 };
            let motion = march(&model, &drive, &[0.0, dt], &start, &tolerance).expect("a motion");
            let (gives, pulls) = (k * volts / 2.0, 0.5 * 9.81 * 0.1 * q.sin());
            let load = match form {
                1 | 2 | 5 => gives,
                3 | 4 | 6 => pulls,
                _ => (motor * (gives - k * k * v / 2.0) + pulls) / (motor + 1.0),
            };
            let rubs = (f_c + ratio * load) * f64::signum(v);
            let exact = (gives - k * k * v / 2.0 - pulls - rubs) / inertia;
            let found = (motion.v[1] - v) / dt;
            assert!((found / exact - 1.0).abs() < 1e-5, "{form}: {found} for {exact} rad/s²");
        }
    }
}

#[test]
fn what_grows_as_a_whole_takes_viscous_friction_along() {
    let share = 0.4;
    let whole = [
        format!("name = \"friction_drift\"\namount = {share}\ntau = 1e-3\nform = 4"),
        format!(
            "name = \"position_friction\"\nsine = 0.0\ncosine = {share}\nwavenumber = 1e-9\nform = 4"
        ),
        format!("name = \"coulomb_asymmetry\"\nratio = {share}\nform = 2"),
    ];
    let bristles = "f_c = 2.0\nf_s = 2.0\nv_s = 0.1\nsigma_0 = 1e4\nsigma_1 = 10.0\nsigma_2 = 40.0";
    for (place, effect) in whole.iter().enumerate() {
        for friction in [
            &format!("name = \"lugre\"\n{bristles}"),
            "name = \"coulomb\"\nf_c = 2.0\nsigma_2 = 40.0",
        ] {
            for drive in [8.0, -8.0] {
                // An asymmetry is as much less on the way back.
                let more = if place == 2 { share * f64::signum(drive) } else { share };
                let exact = (8.0 / (1.0 + more) - 2.0) / 40.0 * f64::signum(drive);
                let v = ends(&axis(friction, effect), drive);
                assert!((v / exact - 1.0).abs() < 1e-6, "{effect}: {v} m/s for {exact} m/s");
                // So much of it may be an effect.
                let without = friction.replace("\nsigma_2 = 40.0", "");
                let beside = format!("{effect}\n[[effect]]\nname = \"viscous\"\nsigma_2 = 40.0");
                let v = ends(&axis(&without, &beside), drive);
                assert!((v / exact - 1.0).abs() < 1e-6, "{beside}: {v} m/s for {exact} m/s");
            }
        }
    }
}

#[test]
fn what_slips_at_another_level_each_way_is_as_stiff_both_ways() {
    let bristles = "name = \"lugre\"\nf_c = 2.0\nf_s = 3.0\nv_s = 0.1\nsigma_0 = 1e4\nsigma_1 = 10.0\nsigma_2 = 40.0";
    let with = |form: u8, ratio: f64| {
        axis(bristles, &format!("name = \"coulomb_asymmetry\"\nratio = {ratio}\nform = {form}"))
    };
    for drive in [8.0, -8.0] {
        let v = ends(&with(3, 0.3), drive);
        let level = 2.0 + (-(v / 0.1_f64).powi(2)).exp();
        let held = level * (1.0 + 0.3 * v.signum()) + 40.0 * v.abs();
        assert!((held - 8.0).abs() < 1e-6, "{held} N at {v} m/s");
    }
    // Under 0.5 N bristles bend by 50 µm, whatever the level at which they slip; in the first form they are stiffer.
    let bends = |form: u8, ratio: f64| moved(&with(form, ratio), 0.5, 4000, 0.0).q[3999];
    let own = bends(3, 0.0);
    assert!((bends(3, 0.3) / own - 1.0).abs() < 0.2 && bends(1, 0.3) < 0.8 * own, "{own} m");
    // Without bristles they are one.
    let dry = |form: u8| {
        let effect = format!("name = \"coulomb_asymmetry\"\nratio = 0.3\nform = {form}");
        moved(&axis("name = \"coulomb\"\nf_c = 2.0", &effect), -2.5, 400, 0.3)
    };
    assert_eq!(dry(1).q, dry(3).q);
}

#[test]
fn a_wave_with_its_overtone_gives_back_what_it_took() {
    let (sine, cosine, k, share, phase) = (0.3, -0.2, 9.0, 0.4, 2.0);
    let cogging = format!(
        "name = \"cogging\"\nsine = {sine}\ncosine = {cosine}\nwavenumber = {k}\nshare_2 = {share}\nphase_2 = {phase}"
    );
    let motion = moved(&axis("name = \"none\"", &cogging), 0.0, 400, 0.6);
    // The integral of the force along the way.
    let potential = |q: f64| {
        let wave = |x: f64| -sine * x.cos() + cosine * x.sin();
        (wave(k * q) + 0.5 * share * wave(2.0 * k * q + phase)) / k
    };
    let energy = |q: f64, v: f64| v * v + potential(q);
    let whole = energy(0.0, 0.6);
    for (q, v) in motion.q.iter().zip(&motion.v) {
        assert!((energy(*q, *v) - whole).abs() < 1e-7, "{q} m, {v} m/s");
    }
    let slowest = motion.v.iter().fold(f64::INFINITY, |least, v| least.min(*v));
    assert!(slowest < 0.59, "the wave is felt");
}

#[test]
fn a_contact_that_gives_way_does_so_with_dahl_s_exponent() {
    let dahl = "title = \"t\"\n[plant]\nkind = \"mass-spring\"\nmass = 2.0\nstiffness = 3.0\n[friction]\nname = \"dahl\"\n\
                f_c = 0.4\nsigma = 90.0\ngamma = 0.8\n[channels]\ntime = \"t\"\nforce = \"f\"\nposition = \"x\"\n";
    let coulomb =
        dahl.replace("\"dahl\"", "\"coulomb\"").replace("sigma = 90.0\ngamma = 0.8\n", "")
            + "[[effect]]\nname = \"presliding\"\nsigma = 90.0\ngamma = 0.8\n";
    let of = |text: &str| binding::model::<f64>(&Rig::parse(text).expect("a rig"), &|_| None);
    assert_eq!(format!("{:?}", of(&coulomb).contact), format!("{:?}", of(dahl).contact));
    let usual = coulomb.replace("gamma = 0.8\n", "");
    assert_eq!(Rig::parse(&usual).expect("a rig").value("presliding.gamma"), Some(1.0));
}

#[test]
fn a_clock_may_count_from_anywhere() {
    let rig = axis("name = \"none\"", "name = \"current_bias\"\nbias = 0.0");
    let of = |began: f64| {
        let time: Vec<f64> = (0..100).map(|i| began + 0.25 * f64::from(i)).collect();
        let q: Vec<f64> = (0..100).map(|i| f64::from(i % 7)).collect();
        let column = |name: &str| Ok(if name == "t" { time.as_slice() } else { q.as_slice() });
        Data::of(&rig, &Recording::new(&rig, &column).expect("a recording"))
    };
    // Quarters of a second since 1970 have no rounding.
    assert_eq!(of(1_731_999_100.25), of(0.0));
    assert_eq!(of(-7.5).time[..2], [0.0, 0.25]);
}

#[test]
fn every_form_in_which_an_effect_is_looked_for_is_one_that_it_may_take() {
    let context = Context {
        input: 1.0,
        force: 1.0,
        drive: 1.0,
        cells: 2,
        pull: 1.0,
        speed: 1.0,
        low: 0.0,
        span: 1.0,
        memory: 0.01,
        duration: 60.0,
        sample_time: 0.005,
        mass: 1.0,
        turns: true,
        loaded: true,
        hidden: true,
        waves: [[20.0, 40.0, 0.0, 0.0, 0.0, 0.0], [30.0, 0.0, 0.0, 0.0, 0.0, 0.0]],
        halves: 0,
    };
    let mut several = Vec::new();
    for kind in LAWS {
        let about = kind.about();
        // Amounts are no part of a probe.
        let mut shapes = about.keys.iter().filter(|key| key.shape != Shape::Amount);
        let Some(place) = shapes.position(|key| key.name == "form") else { continue };
        let mut forms: Vec<f64> = (about.probes)(&context).iter().map(|p| p[place]).collect();
        forms.sort_by(f64::total_cmp);
        forms.dedup();
        let unlisted: Vec<&f64> = forms.iter().filter(|f| !kind.forms().contains(f)).collect();
        // What is looked for in one form alone may list none; what lists some takes no other from a rig file.
        assert!(unlisted.is_empty() || kind.forms().is_empty(), "{}: {unlisted:?}", about.name);
        assert!(!kind.forms().is_empty() || forms.len() == 1, "{}: {forms:?}", about.name);
        several.extend((forms.len() > 1).then_some(about.name));
    }
    assert!(several.contains(&"load_friction") && several.len() > 2, "{several:?}");
}
