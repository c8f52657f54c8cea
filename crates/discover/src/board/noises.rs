//! The noise of the sensors, which residuals are divided by.

use identify::{
    Rig,
    fit::{Data, Seen, problem::Weights},
};

/// The noise of the channels; of one that is not seen what `unseen` has.
pub(super) fn noises((rig, data): (&Rig, &Data), unseen: Weights) -> Weights {
    let of = |seen: Option<&Seen>, unseen: f64| {
        let noise = |seen: &Seen| crate::floor::noise(seen, seen.noise.max(f64::MIN_POSITIVE));
        seen.map_or(unseen, noise)
    };
    let cell = |i: usize| of(data.loads.as_ref().map(|cells| &cells[i]), unseen.loads[i]);
    let alone = Weights {
        displacement: of(data.displacement.as_ref(), unseen.displacement),
        velocity: of(data.velocity.as_ref(), unseen.velocity),
        force: of(data.force.as_ref(), unseen.force),
        loads: [cell(0), cell(1)],
        ..unseen
    };
    alone.along_angle(rig)
}

#[cfg(test)]
mod tests {
    use crate::board::Board;
    use identify::{
        Hold, Rig,
        fit::{Data, Seen},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// A drum that swings by 0.3 rad at 2 rad/s, its springs' pulls seen with as much noise as that of the angle makes of
    /// them, and its velocity with a ten-thousandth.
    fn swings() -> (Rig, Data) {
        let rig = "title = \"t\"\n[plant]\nkind = \"drum\"\ninertia = 1e-3\nradius = 0.05\nk_1 = 40.0\nk_2 = 40.0\n\
             f_10 = 12.0\nf_20 = 12.0\nmotor_constant = 1.0\ngear_ratio = 50.0\n[friction]\nname = \"none\"\n\
             sigma_2 = 0.02\n[channels]\ntime = \"t\"\ncurrent = \"i\"\nangle = \"q\"\nvelocity = \"v\"\n\
             force_1 = \"a\"\nforce_2 = \"b\"\n";
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut noise = |size: f64| -> f64 {
            let drawn: f64 = StandardNormal.sample(&mut random);
            size * drawn
        };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let motion = |t: f64| (0.3 * (2.0 * t).sin(), 0.6 * (2.0 * t).cos());
        // I θ'' = K i - σ₂ θ' - r (F₁ - F₂), by hand: r² (k₁ + k₂) = 0.2 N·m/rad.
        let current = time.iter().map(|t| (0.2 - 4e-3) * motion(*t).0 + 0.02 * motion(*t).1);
        let current: Vec<f64> = current.collect();
        let mut seen = |name: &str, of: &dyn Fn(f64) -> f64, size: f64| {
            Seen::new(name, time.iter().map(|t| of(*t) + noise(size)).collect(), 0.0)
        };
        let angle = seen("angle", &|t| motion(t).0, 1e-3);
        let velocity = seen("velocity", &|t| motion(t).1, 1e-4);
        let pulls = [2.0, -2.0].map(|k| seen("force", &|t| 12.0 + k * motion(t).0, 2e-3));
        let driven = Data::driven(time.clone(), current, Hold::Linear, angle);
        (Rig::parse(rig).unwrap(), Data { velocity: Some(velocity), loads: Some(pulls), ..driven })
    }

    #[test]
    fn a_right_model_leaves_the_floor_in_every_channel() {
        let (rig, data) = swings();
        let board = Board::of(&rig, &data, 1, Vec::new()).unwrap();
        let fitted = board.judged(&rig, None).unwrap();
        let samples: f64 = board.samples().iter().sum();
        for channel in 0..4 {
            let left = fitted.blocks.iter().map(|block| block[channel]).sum::<f64>() / samples;
            assert!((left - 1.0).abs() < 0.1, "{left} floors in channel {channel}");
        }
    }
}
