//! The integrator: a Rosenbrock method of order 4 with an embedded one of order 3, stiffly accurate.
//!
//! The coefficients are those of RODAS: E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*,
//! section IV.7, in the form that needs no product with the Jacobian.
//! The tests find the order from the errors.

use nalgebra::{Matrix3, Vector3};

/// What flows: ẏ = f(t, y) with its exact Jacobian and its slope in time.
pub(crate) trait Flow {
    /// f(t, y).
    fn slope(&self, t: f64, y: &Vector3<f64>) -> Vector3<f64>;
    /// ∂f/∂y.
    fn jacobian(&self, t: f64, y: &Vector3<f64>) -> Matrix3<f64>;
    /// ∂f/∂t.
    fn slope_in_time(&self, t: f64, y: &Vector3<f64>) -> Vector3<f64>;
}

pub(crate) const GAMMA: f64 = 0.25;
pub(crate) const C: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
pub(crate) const D: [f64; 4] = [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23];
pub(crate) const A: [&[f64]; 5] = [
    &[],
    &[1.544],
    &[0.946_678_528_081_582_6, 0.255_701_169_898_328_4],
    &[3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7],
    &[1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895],
];
pub(crate) const COUPLING: [&[f64]; 6] = [
    &[],
    &[-5.6688],
    &[-2.430_093_356_833_875, -0.206_359_915_709_191_5],
    &[-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16],
    &[7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6],
    &[
        8.083_246_795_921_522,
        -7.981_132_988_064_893,
        -31.521_594_328_743_71,
        16.319_305_431_231_36,
        -6.058_818_238_834_054,
    ],
];

/// One step of length h: the new state and an estimate of its error. `None` if the matrix cannot be solved.
pub(crate) fn step(
    flow: &impl Flow,
    t: f64,
    y: &Vector3<f64>,
    h: f64,
) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let matrix = Matrix3::identity() / (h * GAMMA) - flow.jacobian(t, y);
    let inverse = matrix.lu();
    let in_time = flow.slope_in_time(t, y) * h;
    let mut u = [Vector3::zeros(); 6];
    let mut at = *y;
    for i in 0..6 {
        at = if i < 5 {
            A[i].iter().zip(&u).fold(*y, |sum, (a, u)| sum + u * *a)
        } else {
            at + u[4]
        };
        let mut right = flow.slope(t + C[i] * h, &at);
        for (c, u) in COUPLING[i].iter().zip(&u) {
            right += u * (*c / h);
        }
        if let Some(d) = D.get(i) {
            right += in_time * *d;
        }
        u[i] = inverse.solve(&right)?;
    }
    Some((at + u[5], u[5]))
}

/// The length of steps, and what they are judged by.
#[derive(Debug, Clone)]
pub(crate) struct Pace {
    h: f64,
    tolerance: f64,
    /// The largest values seen so far, which the tolerance is relative to.
    scale: Vector3<f64>,
}

/// The shortest step, relative to the time or one second.
pub(crate) const SHORTEST: f64 = 1e-15;

impl Pace {
    /// A pace that begins with steps of h; errors are relative to the largest values seen, and to `least`.
    pub(crate) fn new(h: f64, tolerance: f64, least: Vector3<f64>) -> Self {
        Self { h, tolerance, scale: least }
    }

    /// The state has been of this size.
    pub(crate) fn saw(&mut self, size: Vector3<f64>) {
        self.scale = self.scale.sup(&size.abs());
    }

    /// One accepted step from t towards `end`: its length, and the state then.
    pub(crate) fn step(
        &mut self,
        flow: &impl Flow,
        t: f64,
        y: &Vector3<f64>,
        end: f64,
    ) -> Option<(f64, Vector3<f64>)> {
        loop {
            // A step that nearly reaches the end reaches it.
            let h = if self.h * 1.01 >= end - t { end - t } else { self.h };
            let (error, next) = match step(flow, t, y, h) {
                Some((next, error)) if next.iter().all(|v| v.is_finite()) => {
                    ((error.component_div(&self.scale) / self.tolerance).amax(), next)
                }
                _ => (f64::INFINITY, *y),
            };
            let factor = (0.9 * error.powf(-0.25)).clamp(0.1, 5.0);
            if error <= 1.0 {
                // A step cut short by the end says little about the next one.
                self.h = if h < self.h { self.h.max(h * factor) } else { h * factor };
                return Some((h, next));
            }
            self.h = h * factor.min(0.9);
            if self.h < SHORTEST * t.abs().max(1.0) {
                return None;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth problem that is not linear and knows the time: y = (sin t, cos t, e^(sin t)).
    struct Smooth;

    impl Flow for Smooth {
        fn slope(&self, t: f64, y: &Vector3<f64>) -> Vector3<f64> {
            Vector3::new(
                y[1],
                -y[0] + (t.cos() - y[1]),
                y[2] * y[1] + 0.1 * (y[0] * y[0] - t.sin().powi(2)),
            )
        }
        fn jacobian(&self, _t: f64, y: &Vector3<f64>) -> Matrix3<f64> {
            Matrix3::new(0.0, 1.0, 0.0, -1.0, -1.0, 0.0, 0.2 * y[0], y[2], y[1])
        }
        fn slope_in_time(&self, t: f64, _y: &Vector3<f64>) -> Vector3<f64> {
            Vector3::new(0.0, -t.sin(), -0.2 * t.sin() * t.cos())
        }
    }

    fn exact(t: f64) -> Vector3<f64> {
        Vector3::new(t.sin(), t.cos(), t.sin().exp())
    }

    fn error_with(steps: u32) -> f64 {
        let h = 2.0 / f64::from(steps);
        let mut y = exact(0.0);
        for k in 0..steps {
            y = step(&Smooth, f64::from(k) * h, &y, h).unwrap().0;
        }
        (y - exact(2.0)).amax()
    }

    #[test]
    fn the_method_is_of_order_four() {
        for steps in [20, 40, 80] {
            let order = (error_with(steps) / error_with(2 * steps)).log2();
            assert!((order - 4.0).abs() < 0.25, "{steps} steps: order {order:.2}");
        }
    }

    #[test]
    fn a_stiff_decay_is_damped_in_one_step_however_long() {
        struct Decay;
        impl Flow for Decay {
            fn slope(&self, _t: f64, y: &Vector3<f64>) -> Vector3<f64> {
                -1e9 * y
            }
            fn jacobian(&self, _t: f64, _y: &Vector3<f64>) -> Matrix3<f64> {
                Matrix3::identity() * -1e9
            }
            fn slope_in_time(&self, _t: f64, _y: &Vector3<f64>) -> Vector3<f64> {
                Vector3::zeros()
            }
        }
        let y = step(&Decay, 0.0, &Vector3::repeat(1.0), 1.0).unwrap().0;
        assert!(y.amax() < 1e-8, "{} is left", y.amax());
    }
}
