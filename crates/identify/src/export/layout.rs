//! What stands in the C structures: every parameter of the rig, with its symbol, unit and value.

use super::ExportError;
use crate::Rig;
use duhem::{MODELS, Parameter};

/// A member of the structure of parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Member {
    /// Its name, the rig file's key.
    pub key: &'static str,
    /// What it is, with its symbol.
    pub what: &'static str,
    /// Its SI unit; empty for a pure number.
    pub unit: &'static str,
    /// Its value, or one for each element.
    pub value: Parameter,
}

/// Key, symbol, unit on a plant that slides and on one that turns; the values of a plant's own keys.
const KEYS: &[(&str, &str, &str, &str)] = &[
    ("inertia", "inertia I or M", "kg", "kg·m²"),
    ("mass", "mass m", "kg", "kg"),
    ("stiffness", "stiffness k_s", "N/m", "N·m/rad"),
    ("radius", "radius r", "m", "m"),
    ("k_1", "stiffness k_1", "N/m", "N/m"),
    ("k_2", "stiffness k_2", "N/m", "N/m"),
    ("f_10", "force F_10", "N", "N"),
    ("f_20", "force F_20", "N", "N"),
    ("motor_constant", "torque at the drum per current k_m", "N·m/A", "N·m/A"),
    ("gear_ratio", "turns of the motor for one of the drum, in k_m already", "", ""),
    ("gain", "force per unit of input", "N/V", "N·m/V"),
    ("length", "distance of the centre of mass l", "m", "m"),
    ("torque_constant", "torque per current K_t", "N·m/A", "N·m/A"),
    ("resistance", "resistance R", "Ω", "Ω"),
    ("f_c", "Coulomb force F_C", "N", "N·m"),
    ("f_s", "stiction force F_S", "N", "N·m"),
    ("v_s", "Stribeck velocity v_S", "m/s", "rad/s"),
    ("sigma", "rest stiffness σ", "N/m", "N·m/rad"),
    ("gamma", "shape γ", "", ""),
    ("sigma_0", "bristle stiffness σ₀", "N/m", "N·m/rad"),
    ("sigma_1", "bristle damping σ₁", "N·s/m", "N·m·s/rad"),
    ("k", "stiffnesses of the elements k_i", "N/m", "N·m/rad"),
    ("delta", "deadbands of the elements Δ_i", "m", "rad"),
    ("sigma_2", "viscous coefficient σ₂", "N·s/m", "N·m·s/rad"),
    ("offset", "constant part of the friction", "N", "N·m"),
];

/// A kind of plant: its name, whether it turns, what drives it, and the keys of its own; a value after a key
/// stands for it where the rig has none.
pub(super) struct Kind {
    pub name: &'static str,
    pub turns: bool,
    pub input: &'static str,
    pub keys: &'static [(&'static str, Option<f64>)],
    /// Its equation in C; none where the motion is imposed.
    pub code: Option<&'static str>,
}

pub(super) const KINDS: &[Kind] = &[
    Kind {
        name: "drum",
        turns: true,
        input: "current [A]",
        keys: &[
            ("inertia", None),
            ("radius", None),
            ("k_1", None),
            ("k_2", None),
            ("f_10", None),
            ("f_20", None),
            ("motor_constant", None),
        ],
        code: Some(include_str!("c/drum.h")),
    },
    Kind {
        name: "mass-spring",
        turns: false,
        input: "force [N]",
        keys: &[("mass", None), ("stiffness", None)],
        code: Some(include_str!("c/mass_spring.h")),
    },
    Kind {
        name: "axis",
        turns: false,
        input: "voltage [V], or force [N] where gain is 1",
        keys: &[("inertia", None), ("gain", Some(1.0))],
        code: Some(include_str!("c/axis.h")),
    },
    Kind {
        name: "pendulum",
        turns: true,
        input: "voltage [V]",
        keys: &[
            ("inertia", None),
            ("mass", None),
            ("length", None),
            ("torque_constant", None),
            ("resistance", None),
        ],
        code: Some(include_str!("c/pendulum.h")),
    },
    Kind { name: "prescribed", turns: false, input: "", keys: &[], code: None },
];

impl Kind {
    /// The kind of `rig`.
    pub(super) fn of(rig: &Rig) -> Result<&'static Self, ExportError> {
        KINDS.iter().find(|kind| kind.name == rig.kind).ok_or_else(|| ExportError::Unknown {
            what: "plant",
            found: rig.kind.to_owned(),
            known: KINDS.iter().map(|kind| kind.name).collect::<Vec<_>>().join(", "),
        })
    }
}

/// The parameters of `rig`: the plant's, the friction's, σ₂ and the offset.
pub(super) fn members(rig: &Rig) -> Result<Vec<Member>, ExportError> {
    let kind = Kind::of(rig)?;
    let member = |key: &'static str, value: Parameter| {
        let known = KEYS.iter().find(|entry| entry.0 == key).unwrap_or(&("", "", "", ""));
        let unit = if kind.turns { known.3 } else { known.2 };
        let finite = match &value {
            Parameter::Scalar(v) => v.is_finite(),
            Parameter::List(list) => list.iter().all(|v| v.is_finite()),
        };
        let what = known.1;
        if finite { Ok(Member { key, what, unit, value }) } else { Err(not_finite(key)) }
    };
    let missing = |key: &str| ExportError::Missing { key: key.to_owned(), of: rig.kind.to_owned() };
    let mut members = Vec::new();
    for (key, default) in kind.keys {
        let value = rig.plant.get(*key).copied().or(*default).ok_or_else(|| missing(key))?;
        members.push(member(key, value.into())?);
    }
    let friction = &rig.friction;
    let mut sigma_2 = friction.sigma_2;
    for key in friction_keys(&friction.name)? {
        let found = friction.parameters.0.get(*key);
        match (*key, found) {
            // A model with a viscous term of its own has it among its parameters.
            ("sigma_2", Some(Parameter::Scalar(own))) => sigma_2 += own,
            ("sigma_2", _) => {}
            (key, Some(value)) => members.push(member(key, value.clone())?),
            (key, None) => {
                let of = friction.name.clone();
                return Err(ExportError::Missing { key: key.to_owned(), of });
            }
        }
    }
    members.push(member("sigma_2", sigma_2.into())?);
    members.push(member("offset", rig.plant.get("offset").copied().unwrap_or(0.0).into())?);
    Ok(members)
}

/// The keys of the friction model `name`, none for `none`, where its parameters make a model.
fn friction_keys(name: &str) -> Result<&'static [&'static str], ExportError> {
    if name == "none" {
        return Ok(&[]);
    }
    let known = || MODELS.iter().map(|m| m.name).chain(["none"]).collect::<Vec<_>>().join(", ");
    let entry = MODELS.iter().find(|entry| entry.name == name);
    entry.map(|entry| entry.keys).ok_or_else(|| ExportError::Unknown {
        what: "friction",
        found: name.to_owned(),
        known: known(),
    })
}

fn not_finite(key: &str) -> ExportError {
    ExportError::NotFinite { key: key.to_owned() }
}
