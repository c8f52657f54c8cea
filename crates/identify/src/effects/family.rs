//! What several effects ask of a rig.

use super::{Act, Context};
use crate::{Rig, march::Real};

/// Whether it moves under a drive.
pub(super) fn driven(rig: &Rig) -> bool {
    rig.kind != "prescribed"
}

/// Whether it is driven, and motor and load are one mass so far.
pub(super) fn is_joined(rig: &Rig) -> bool {
    driven(rig) && !rig.two_masses()
}

/// Whether it has friction of its own.
pub(super) fn rubs(rig: &Rig) -> bool {
    rig.friction.name != "none"
}

/// Whether its velocity is measured.
pub(super) fn has_tachometer(rig: &Rig) -> bool {
    driven(rig) && rig.channels.contains_key("velocity")
}

/// Whether it is a drum between springs.
pub(super) fn has_springs(rig: &Rig) -> bool {
    rig.kind == "drum"
}

/// Whether its springs' forces are measured.
pub(super) fn has_cells(rig: &Rig) -> bool {
    has_springs(rig) && rig.channels.contains_key("force_1") && rig.channels.contains_key("force_2")
}

/// The value of a key of rig, 0 if there is none.
pub(super) fn value(rig: &Rig, key: &str) -> f64 {
    rig.value(key).unwrap_or(0.0)
}

/// Whether a key of rig is free.
pub(super) fn is_free(rig: &Rig, key: &str) -> bool {
    rig.free.iter().any(|name| name == key)
}

/// Friction of level `f_c` that grows by a `share` of itself, in one of four forms: 1, as a contact that presses harder,
/// whose stiffness grows as well; 2, by the level at which it slips alone, at each speed by its own; 3, by this share of
/// `f_c` at any speed, so that a drop towards `f_c` stays what it is; 4, as 1, and viscous friction with it.
pub(super) fn grows<D: Real>(form: f64, share: D, f_c: D) -> Act<D> {
    match form {
        form if form < 1.5 => Act::More(share),
        form if form < 2.5 => Act::Level(share),
        form if form < 3.5 => Act::Rise(share * f_c),
        _ => Act::MoreOfAll(share),
    }
}

/// Every probe in each of the `forms`; without a deflection they are all one.
pub(super) fn in_forms(c: &Context, probes: &[Vec<f64>], forms: &[f64]) -> Vec<Vec<f64>> {
    let tell = |form: &&f64| c.memory > 0.0 || **form % 2.0 == 1.0;
    let with = |form: &f64| {
        let form = *form;
        probes.iter().map(move |probe| probe.iter().copied().chain([form]).collect())
    };
    forms.iter().filter(tell).flat_map(with).collect()
}
