//! What several effects ask of a rig.

use crate::Rig;

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
