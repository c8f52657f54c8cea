//! What a model can lack: the effects, one file and one line of the list each.
//!
//! An effect is a law with parameters. It may change the input before it drives the plant, the drive, the mass,
//! the friction (a force beside it, or by how much it is multiplied), what the sensors show, and what the load
//! cells show. With its amounts at zero it changes nothing, to the last bit.
//!
//! Read first: [`Law`], what an effect may do; [`About`], what it says of itself; [`LAWS`], all of them.

mod about;
mod family;
mod hooks;
mod joint;

pub use about::{About, Channel, Context, Key, Measure, Shape, Sign, WAVES};
pub use hooks::{Act, Acts, At, LONG, Law, Load, Past, Sense, Term};
pub use joint::Joint;
pub(crate) use joint::hides_load;

use crate::{Rig, march::Real};
use std::ops::RangeInclusive;

/// Declares the list: the kinds, and every hook passed on to the law that is meant.
macro_rules! effects {
    ($($module:ident :: $law:ident),* ; $($other:ident :: $hidden:ident),* $(,)?) => {
        $(mod $module;)*
        $(mod $other;)*

        /// An effect of the library.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Kind {
            $(#[doc = concat!("`", stringify!($module), "`")] $law,)*
            $(#[doc = concat!("`", stringify!($other), "`, in no rig file")] $hidden,)*
        }

        /// All effects.
        pub const LAWS: &[Kind] = &[$(Kind::$law),*];

        /// The names of all effects.
        pub const NAMES: &[&str] = &[$($module::$law::ABOUT.name),*];

        impl Kind {
            /// What it says of itself.
            pub fn about(self) -> &'static About {
                match self {
                    $(Self::$law => &$module::$law::ABOUT,)*
                    $(Self::$hidden => &$other::$hidden::ABOUT,)*
                 }
            }

            /// How many states it has.
            pub(crate) fn states(self) -> usize {
                match self {
                    $(Self::$law => $module::$law::STATES,)*
                    $(Self::$hidden => $other::$hidden::STATES,)*
                 }
            }

            pub(crate) fn input<D: Real>(self, p: &[D], u: &mut D) {
                match self {
                    $(Self::$law => $module::$law::input(p, u),)*
                    $(Self::$hidden => $other::$hidden::input(p, u),)*
                 }
            }

            pub(crate) fn delay<D: Real>(self, p: &[D]) -> Option<D> {
                match self {
                    $(Self::$law => $module::$law::delay(p),)*
                    $(Self::$hidden => $other::$hidden::delay(p),)*
                 }
            }

            pub(crate) fn drive<D: Real>(self, p: &[D], force: &mut D) {
                match self {
                    $(Self::$law => $module::$law::drive(p, force),)*
                    $(Self::$hidden => $other::$hidden::drive(p, force),)*
                 }
            }

            pub(crate) fn mass<D: Real>(self, p: &[D], mass: &mut D) {
                match self {
                    $(Self::$law => $module::$law::mass(p, mass),)*
                    $(Self::$hidden => $other::$hidden::mass(p, mass),)*
                 }
            }

            pub(crate) fn act<D: Real>(self, p: &[D], at: &At<D>, base: &[D], z: &mut [D]) -> Act<D> {
                match self {
                    $(Self::$law => $module::$law::act(p, at, base, z),)*
                    $(Self::$hidden => $other::$hidden::act(p, at, base, z),)*
                 }
            }

            /// Whether it is friction that can hold.
            pub fn dry(self) -> bool {
                match self {
                    $(Self::$law => $module::$law::DRY,)*
                    $(Self::$hidden => $other::$hidden::DRY,)*
                 }
            }

            pub(crate) fn start<D: Real>(self, p: &[D], place: usize, (way, grain, past): (f64, f64, Past<'_>)) -> D {
                match self {
                    $(Self::$law => $module::$law::start(p, place, (way, grain, past)),)*
                    $(Self::$hidden => $other::$hidden::start(p, place, (way, grain, past)),)*
                 }
            }

            /// The forms that it may take, if there is more than one: values of its key `form`.
            pub fn forms(self) -> &'static [f64] {
                match self {
                    $(Self::$law => $module::$law::FORMS,)*
                    $(Self::$hidden => $other::$hidden::FORMS,)*
                 }
            }

            /// The amounts at which it is tried, of their natural size; none if it begins smoothly.
            pub fn tried(self) -> &'static [f64] {
                match self {
                    $(Self::$law => $module::$law::TRIED,)*
                    $(Self::$hidden => $other::$hidden::TRIED,)*
                 }
            }

            /// Whether it can part motor and load.
            pub(crate) fn is_joint(self) -> bool {
                match self {
                    $(Self::$law => $module::$law::JOINS,)*
                    $(Self::$hidden => $other::$hidden::JOINS,)*
                 }
            }

            /// The joint between motor and load, where these values part them.
            pub(crate) fn joint<D: Real>(self, p: &[D], at: &At<D>) -> Option<Joint<D>> {
                if !self.joins(p) {
                    return None;
                }
                match self {
                    $(Self::$law => $module::$law::joint(p, at),)*
                    $(Self::$hidden => $other::$hidden::joint(p, at),)*
                 }
            }

            pub(crate) fn sense<D: Real>(self, p: &[D], sense: &mut Sense<D>, memory: &mut D) {
                match self {
                    $(Self::$law => $module::$law::sense(p, sense, memory),)*
                    $(Self::$hidden => $other::$hidden::sense(p, sense, memory),)*
                 }
            }

            pub(crate) fn load<D: Real>(self, p: &[D], load: &Load, force: D) -> D {
                match self {
                    $(Self::$law => $module::$law::load(p, load, force),)*
                    $(Self::$hidden => $other::$hidden::load(p, load, force),)*
                 }
            }
        }
    };
}

effects! {
    current_bias::CurrentBias,
    coulomb_asymmetry::CoulombAsymmetry,
    preload_asymmetry::PreloadAsymmetry,
    viscous::Viscous,
    viscous_asymmetry::ViscousAsymmetry,
    quadratic_drag::QuadraticDrag,
    sublinear_drag::SublinearDrag,
    stribeck::Stribeck,
    coulomb::Coulomb,
    presliding::Presliding,
    maxwell_slip::MaxwellSlip,
    dwell_stiction::DwellStiction,
    load_friction::LoadFriction,
    position_friction::PositionFriction,
    friction_drift::FrictionDrift,
    cogging::Cogging,
    gravity_unbalance::GravityUnbalance,
    cubic_spring::CubicSpring,
    cable_slack::CableSlack,
    torque_saturation::TorqueSaturation,
    input_delay::InputDelay,
    inertia::Inertia,
    backlash::Backlash,
    compliance::Compliance,
    velocity_lag::VelocityLag,
    tach_gain::TachGain,
    tach_bias::TachBias,
    load_cell_drift::LoadCellDrift;
    map::Map,
}

/// The wavenumbers of so many half periods over the record's stretch, and those that it shows most of.
fn wavenumbers(
    context: &Context,
    halves: RangeInclusive<u32>,
    seen: [f64; WAVES],
) -> Vec<Vec<f64>> {
    let one = std::f64::consts::PI / context.span;
    let (least, most) = (*halves.start(), context.halves.max(*halves.end()));
    let long = (least..=most).map(|j| f64::from(j) * one);
    let most = one * f64::from(most);
    long.chain(seen.into_iter().filter(|k| *k > most)).map(|k| vec![k]).collect()
}

impl Kind {
    /// Whether it parts motor and load with these values.
    pub(crate) fn joins<D: Real>(self, p: &[D]) -> bool {
        self.is_joint() && p[0].re() > 0.0
    }

    /// The effect of this name.
    pub fn named(name: &str) -> Option<Self> {
        // A map has many hats, each with a number behind its name.
        if name.starts_with("map-") {
            return Some(Self::Map);
        }
        // Several probes of one effect at once have numbers behind its name.
        let name = name.split_once('#').map_or(name, |(name, _)| name);
        LAWS.iter().copied().find(|kind| kind.about().name == name)
    }

    /// Whether a model of `rig` can lack it, and a record of it could show it.
    pub fn applies(self, rig: &Rig) -> bool {
        !rig.effects.iter().any(|effect| effect.name == self.about().name)
            && (self.about().applies)(rig)
    }

    /// The effect with these values.
    pub(crate) fn term<D: Real>(self, value: &dyn Fn(&str) -> D) -> Term<D> {
        Term { kind: self, p: self.about().keys.iter().map(|key| value(key.name)).collect() }
    }
}
