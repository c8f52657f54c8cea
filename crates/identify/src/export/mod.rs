//! The model leaves: a rig as a C header that a controller can use.
//!
//! The C stands in `c/`, one file for each plant and each friction; here the structures with the fitted values are
//! written around it. Friction under an imposed motion is exact for velocities that are constant over a step; a plant
//! is of first order in the step and solves one scalar equation for the velocity.

mod layout;

use crate::Rig;
use duhem::Parameter;
use layout::{Kind, Member, members};

/// Why a rig does not become C.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// The plant or the friction is not one of those there are.
    #[error("{what} {found} has no model in C: expected one of {known}")]
    Unknown {
        /// Plant or friction.
        what: &'static str,
        /// What was found.
        found: String,
        /// Those there are.
        known: String,
    },
    /// A parameter has no value.
    #[error("{key} is missing in {of}: expected a value")]
    Missing {
        /// Its key.
        key: String,
        /// Of what it is a parameter.
        of: String,
    },
    /// A parameter is no number.
    #[error("{key} is not finite: expected a number")]
    NotFinite {
        /// Its key.
        key: String,
    },
    /// The friction's parameters do not make a model.
    #[error(transparent)]
    Friction(#[from] duhem::ParameterError),
    /// The rig has an effect that the C model does not know.
    #[error("effect {name} has no model in C: take it out of the rig, or use the rig file")]
    Effect {
        /// Its name.
        name: String,
    },
}

/// The model of `rig` as a C99 header that needs `math.h` alone: structures for parameters and state, initialisers
/// with the rig's values, `duhem_friction_step`, and `duhem_plant_step` unless the motion is imposed. An effect is
/// refused rather than left out in silence.
pub fn c_header(rig: &Rig) -> Result<String, ExportError> {
    if let Some(effect) = rig.effects.first() {
        return Err(ExportError::Effect { name: effect.name.clone() });
    }
    let (kind, members) = (Kind::of(rig)?, members(rig)?);
    if let Some(entry) = duhem::MODELS.iter().find(|entry| entry.name == rig.friction.name) {
        (entry.build)(&complete(rig, entry.keys))?;
    }
    let (contact, states) = match rig.friction.name.as_str() {
        "coulomb" => (include_str!("c/coulomb.h"), 0),
        "dahl" => (include_str!("c/dahl.h"), 1),
        "lugre" => (include_str!("c/lugre.h"), 1),
        "maxwell-slip" => (include_str!("c/maxwell_slip.h"), elements(&members)),
        _ => (include_str!("c/none.h"), 0),
    };
    let dry = if rig.friction.name == "coulomb" { "((p)->f_c)" } else { "((void)(p), 0.0)" };
    let mut parts = vec![
        opening(rig),
        parameters(&members),
        state(kind, states),
        include_str!("c/common.h").to_owned(),
        contact.to_owned(),
        include_str!("c/friction_step.h").to_owned(),
    ];
    if let Some(plant) = kind.code {
        parts.push(format!("/* Input: {}, held over a step. */\n{plant}", kind.input));
        if states == 0 {
            parts
                .push(format!("/* The force that holds at rest. */\n#define DUHEM_DRY(p) {dry}\n"));
            parts.push(include_str!("c/solve_dry.h").to_owned());
        } else {
            parts.push(include_str!("c/solve.h").to_owned());
        }
        parts.push(include_str!("c/plant_step.h").to_owned());
    }
    parts.push("#endif\n".to_owned());
    Ok(parts.join("\n"))
}

/// The friction's parameters with σ₂ among them where the model has it, 0 if it is not said.
fn complete(rig: &Rig, keys: &[&str]) -> duhem::Parameters {
    let mut parameters = rig.friction.parameters.clone();
    if keys.contains(&"sigma_2") {
        parameters.0.entry("sigma_2".to_owned()).or_insert(Parameter::Scalar(0.0));
    }
    parameters
}

fn elements(members: &[Member]) -> usize {
    let lists = members.iter().filter_map(|member| match &member.value {
        Parameter::List(list) => Some(list.len()),
        Parameter::Scalar(_) => None,
    });
    lists.max().unwrap_or(0)
}

fn opening(rig: &Rig) -> String {
    let (title, kind, friction) = (escape(&rig.title), rig.kind, &rig.friction.name);
    format!(
        "/* {title}\n * Plant {kind}, friction {friction}; SI units. Format 1.\n *\n \
         * duhem_params p = DUHEM_PARAMS; duhem_friction f = DUHEM_FRICTION; duhem_state s = DUHEM_STATE; */\n\
         #ifndef DUHEM_MODEL_H\n#define DUHEM_MODEL_H\n\n#include <math.h>\n"
    )
}

fn parameters(members: &[Member]) -> String {
    let declared = |Member { key, what, unit, value }: &Member| {
        let length = match value {
            Parameter::Scalar(_) => String::new(),
            Parameter::List(list) => format!("[{}]", list.len()),
        };
        let unit = if unit.is_empty() { "1" } else { unit };
        format!("    double {key}{length}; /* {what} [{unit}] */\n")
    };
    let given = |Member { key, value, .. }: &Member| {
        // Debug prints the shortest digits that come back as the same number.
        let value = match value {
            Parameter::Scalar(v) => format!("{v:?}"),
            Parameter::List(list) => {
                let list: Vec<String> = list.iter().map(|v| format!("{v:?}")).collect();
                format!("{{ {} }}", list.join(", "))
            }
        };
        format!("    .{key} = {value}, \\\n")
    };
    let declared: Vec<String> = members.iter().map(declared).collect();
    let given: Vec<String> = members.iter().map(given).collect();
    format!(
        "/* The parameters. */\ntypedef struct {{\n{}}} duhem_params;\n\n\
         /* Those of the rig. */\n#define DUHEM_PARAMS {{ \\\n{}}}\n",
        declared.concat(),
        given.concat()
    )
}

fn state(kind: &Kind, states: usize) -> String {
    let (q, force) = if kind.turns { ("rad", "N·m") } else { ("m", "N") };
    let (z, zeros) = if states == 0 {
        (String::new(), String::new())
    } else {
        let of = "    double z[DUHEM_STATES]; /* the model's own: F of Dahl, else deflections */\n";
        (of.to_owned(), ".z = { 0.0 }, ".to_owned())
    };
    let count =
        if states == 0 { String::new() } else { format!("#define DUHEM_STATES {states}\n\n") };
    let plant = format!(
        "\n/* The state of the plant. */\ntypedef struct {{\n    double q; /* displacement [{q}] */\n    \
         double v; /* velocity [{q}/s] */\n    duhem_friction friction;\n}} duhem_state;\n\n\
         #define DUHEM_STATE {{ .q = 0.0, .v = 0.0, .friction = DUHEM_FRICTION }}\n"
    );
    format!(
        "{count}/* The state of the contact. */\ntypedef struct {{\n{z}    double force; /* friction at the end of \
         the last step [{force}] */\n}} duhem_friction;\n\n\
         #define DUHEM_FRICTION {{ {zeros}.force = 0.0 }}\n{}",
        if kind.code.is_some() { plant.as_str() } else { "" }
    )
}

/// Text that cannot end a comment, nor turn a line or its direction.
fn escape(text: &str) -> String {
    let plain = |c: char| c == ' ' || c.is_ascii_graphic() || c.is_alphanumeric();
    let written: String = text
        .chars()
        .map(|c| if plain(c) { c.to_string() } else { c.escape_unicode().to_string() })
        .collect();
    // With the last a line would go on: ??/ is an old spelling of the backslash.
    written.replace("*/", "* /").replace("/*", "/ *").replace("??/", "?? /")
}
