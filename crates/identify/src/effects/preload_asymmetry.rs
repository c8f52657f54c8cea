//! `preload_asymmetry`: The two springs are not drawn alike at rest.

use super::{About, Act, At, Channel, Key, Law, Load, Measure, family::{has_springs, is_free}};
use crate::march::Real;

/// The two springs are not drawn alike at rest.
pub(super) struct PreloadAsymmetry;

impl Law for PreloadAsymmetry {
    const ABOUT: About = About {
        name: "preload_asymmetry",
        physics: "The two springs are not drawn alike at rest.",
        equation: "F_1 − F_2 is larger by force at rest; cable: 1 shared by both, 2 the first one's, 3 the second one's",
        channel: Channel::Loads,
        // Drawn more is the first and as much less the second, 1; the first alone, 2; the second alone is drawn less, 3.
        keys: &[Key::amount("force", Measure::Pull, 10.0), Key::probed("cable", Measure::One)],
        probes: |c| {
            let cables: &[f64] = if c.cells > 0 { &[1.0, 2.0, 3.0] } else { &[1.0] };
            cables.iter().map(|cable| vec![*cable]).collect()
        },
        applies: |rig| has_springs(rig) && !(is_free(rig, "f_10") && is_free(rig, "f_20")),
        confused: &["current_bias", "coulomb_asymmetry"],
        separated_by: "load cells at the springs",
        test: 0.1,
    };

    fn act<D: Real>(p: &[D], at: &At<D>, _: &[D], _: &mut [D]) -> Act<D> {
        Act::Force(p[0] * at.radius)
    }

    fn load<D: Real>(p: &[D], load: &Load, force: D) -> D {
        let cable = p[1].re();
        let shares = if cable > 2.5 { [0.0, -1.0] } else if cable > 1.5 { [1.0, 0.0] } else { [0.5, -0.5] };
        force + p[0] * shares[load.cell]
    }
}

#[cfg(test)]
mod tests {
    use super::{Law, Load, PreloadAsymmetry};

    #[test]
    fn one_cable_alone_may_be_drawn_otherwise() {
        let shown = |cable: f64| {
            [0, 1].map(|cell| {
                let load = Load { cell, t: 0.0, stretch: 0.0, radius: 0.1 };
                PreloadAsymmetry::load(&[6.0, cable], &load, 80.0)
            })
        };
        assert_eq!([1.0, 2.0, 3.0].map(shown), [[83.0, 77.0], [86.0, 80.0], [80.0, 74.0]]);
    }
}
