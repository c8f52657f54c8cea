//! How far the value of a named effect is from the one in the key.
//!
//! Twin and library say some effects by other parameters, and no record tells the scale of all forces: a motor
//! constant that is 2 % wrong makes every torque 2 % wrong. What is compared is therefore the amount of the effect in
//! the library's words, with forces in units of the drive: the scale is that of the model that was found.

use discover::Discovery;
use identify::Rig;
use twin::{HiddenEffect as E, PlantKind, Scenario};

/// The relative error of the value of the one effect hidden in `scenario`, if it is among those found and both
/// speak of the same thing: position friction that rises along the way, slack cables and a bent drive have no
/// one number in common [1].
pub(super) fn error(scenario: &Scenario, answer: &Discovery) -> Option<f64> {
    let effect = scenario.hidden.first()?;
    let found = answer.effects.iter().find(|found| found.name == effect.name())?;
    let truth = amounts(effect, &scenario.plant, &answer.rig)?;
    let mut squares = (0.0, 0.0);
    for (name, truth) in truth {
        let value = found.values.iter().find(|value| value.name == name)?.value;
        squares = (squares.0 + (value - truth).powi(2), squares.1 + truth * truth);
    }
    Some((squares.0 / squares.1).sqrt())
}

/// The amounts of an effect by the library's keys, as a right model that is otherwise like `rig` would have them.
fn amounts(effect: &E, plant: &PlantKind, rig: &Rig) -> Option<Vec<(&'static str, f64)>> {
    let scale = gain(rig, plant)?;
    let one = |name, value| Some(vec![(name, value)]);
    match effect {
        E::Viscous(e) => one("sigma_2", scale * e.sigma_2),
        E::Stribeck(e) => one("drop", scale * e.drop),
        E::QuadraticDrag(e) => one("c", scale * e.c),
        E::SublinearDrag(e) => one("c", scale * e.c),
        E::Coulomb(e) => one("f_c", scale * e.f_c),
        E::CoulombAsymmetry(e) => one("ratio", e.ratio),
        E::ViscousAsymmetry(e) => one("c", scale * e.c),
        E::PositionFriction(e) if e.slope == 0.0 => {
            Some(vec![("sine", e.sine), ("cosine", e.cosine)])
        }
        E::LoadFriction(e) => one("ratio", e.ratio),
        E::FrictionDrift(e) => one("amount", e.amount),
        E::DwellStiction(e) => one("drop", scale * e.drop),
        E::Presliding(e) => one("sigma", scale * e.sigma),
        E::MaxwellSlip(e) => one("k", scale * e.k),
        E::Cogging(e) => Some(vec![("sine", scale * e.sine), ("cosine", scale * e.cosine)]),
        E::GravityUnbalance(e) => {
            Some(vec![("sine", scale * e.sine), ("cosine", scale * e.cosine)])
        }
        E::CubicSpring(e) => one("k_3", cubic(e.k_3, plant, rig)?),
        E::InputDelay(e) => one("delay", e.delay),
        E::Inertia(e) => one("ratio", (1.0 + e.ratio) * scale * inertia(plant, rig)? - 1.0),
        E::Backlash(e) => one("gap", e.gap),
        E::Compliance(e) => one("compliance", 1.0 / (scale * e.stiffness)),
        E::VelocityLag(e) => one("tau", e.tau),
        E::TachGain(e) => one("error", e.error),
        E::TachBias(e) => one("bias", e.bias),
        E::LoadCellDrift(e) => one("rate", e.rate),
        E::CurrentBias(e) => one("bias", e.bias),
        E::PreloadAsymmetry(e) => one("force", e.force),
        _ => None,
    }
}

/// What the rig says a drive of one gives, against what it gives in truth [1].
fn gain(rig: &Rig, plant: &PlantKind) -> Option<f64> {
    let of = |key: &str| rig.value(key);
    Some(match plant {
        PlantKind::Drum { motor_constant, .. } => of("motor_constant")? / motor_constant,
        PlantKind::Axis { gain, .. } => of("gain")? / gain,
        PlantKind::Pendulum { torque_constant, resistance, .. } => {
            of("torque_constant")? / of("resistance")? / (torque_constant / resistance)
        }
        // Their forces are measured.
        PlantKind::MassSpring { .. } | PlantKind::Prescribed { .. } => 1.0,
    })
}

/// The true inertia against the rig's [1].
fn inertia(plant: &PlantKind, rig: &Rig) -> Option<f64> {
    let key = if rig.kind == "mass-spring" { "mass" } else { "inertia" };
    let truth = match plant {
        PlantKind::Drum { inertia, .. }
        | PlantKind::Axis { inertia, .. }
        | PlantKind::Pendulum { inertia, .. } => *inertia,
        PlantKind::MassSpring { mass, .. } => *mass,
        PlantKind::Prescribed { .. } => return None,
    };
    Some(truth / rig.value(key)?)
}

/// On a drum the load cells say it: k₃(Rq)³ in each pair of springs, which the library has as a torque over the
/// rig's own radius.
fn cubic(k_3: f64, plant: &PlantKind, rig: &Rig) -> Option<f64> {
    match plant {
        PlantKind::Drum { radius, .. } => Some(k_3 * radius.powi(3) * rig.value("radius")?),
        _ => Some(k_3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twin::bench::{Between, Excitation, Family, FrictionKind, Hides, Noise, Recipe, case_of};

    /// A drum in which a bias or a brush is hidden, and an answer that names it with this value.
    fn answered(name: &str, key: &str, value: f64) -> (Scenario, Discovery) {
        let recipe = Recipe {
            family: Family::DrumAngle,
            excitation: Excitation::Sine,
            noise: Noise::Low,
            friction: FrictionKind::LuGre,
            hides: Hides::Effects(vec![name.to_owned()]),
            input: Between::Held,
            other: false,
        };
        let case = case_of(&recipe, 11).unwrap();
        let rig = Rig::parse(&case.rig).unwrap();
        let truth = amounts(&case.scenario.hidden[0], &case.scenario.plant, &rig).unwrap();
        assert_eq!(truth[0].0, key);
        let name = identify::effects::NAMES.iter().find(|n| **n == name).unwrap();
        let values = vec![discover::Value {
            name: key.to_owned(),
            value: truth[0].1 * value,
            standard_error: 0.0,
            unit: "",
        }];
        let found = discover::Found {
            name,
            set: vec![name],
            values,
            shrink: 1.0,
            t: 9.0,
            separated_by: String::new(),
        };
        let answer = Discovery {
            hold: None,
            complete: true,
            verdict: discover::Verdict::Effect,
            parameters: vec![],
            effects: vec![found],
            gap: vec![],
            shares: vec![],
            map: None,
            tone: None,
            ranking: vec![],
            detectability: vec![],
            chi_squared: [1.0; 3],
            rig,
        };
        (case.scenario, answer)
    }

    #[test]
    fn a_value_that_is_one_per_cent_larger_is_off_by_one_per_cent() {
        let (scenario, answer) = answered("current_bias", "bias", 1.01);
        let off = error(&scenario, &answer).unwrap();
        assert!((off - 0.01).abs() < 1e-12, "off by {off}");
        let (scenario, mut answer) = answered("quadratic_drag", "c", 0.98);
        let off = error(&scenario, &answer).unwrap();
        assert!((off - 0.02).abs() < 1e-12, "off by {off}");
        answer.effects.clear();
        assert_eq!(error(&scenario, &answer), None, "what is not named has no value");
    }

    #[test]
    fn a_drag_is_compared_in_units_of_the_drive_and_a_bias_in_amperes() {
        let (scenario, _) = answered("quadratic_drag", "c", 1.0);
        let PlantKind::Drum { motor_constant, .. } = scenario.plant else { panic!("a drum") };
        let E::QuadraticDrag(drag) = scenario.hidden[0] else { panic!("a drag") };
        let (_, answer) = answered("quadratic_drag", "c", 1.0);
        let told = answer.rig.value("motor_constant").unwrap();
        assert!((told / motor_constant - 1.0).abs() > 0.019, "the rig file is 2 % wrong");
        let expected = drag.c * told / motor_constant;
        let value = answer.effects[0].values[0].value;
        assert!((value / expected - 1.0).abs() < 1e-12, "{value}, expected {expected} N·m·s²/rad²");
        let (scenario, answer) = answered("current_bias", "bias", 1.0);
        let E::CurrentBias(bias) = scenario.hidden[0] else { panic!("a bias") };
        let value = answer.effects[0].values[0].value;
        assert!((value - bias.bias).abs() < 1e-15, "{value} A, expected {} A", bias.bias);
    }
}
