//! The motion between two events: a mass on a spring under a sine, in closed form.

/// m p̈ + K p = R + a sin(ωτ + θ) from p = 0, ṗ = v₀ at τ = 0.
///
/// p is the displacement since the last event, so that the deflections of the sticking elements are
/// their old ones plus p. Written with (sin x)/x it holds for K = 0, at resonance, and between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arc {
    /// Mass m [kg].
    pub mass: f64,
    /// Stiffness K of the spring and the sticking elements [N/m].
    pub stiffness: f64,
    /// Natural angular frequency Ω = √(K/m) [rad/s].
    pub natural: f64,
    /// Angular frequency ω of the drive [rad/s].
    pub omega: f64,
    /// The drive's parts a cos θ, with sin ωτ, and a sin θ, with cos ωτ [N].
    pub drive: (f64, f64),
    /// Constant force R [N].
    pub constant: f64,
    /// Velocity v₀ [m/s].
    pub v0: f64,
}

/// The motion at one time: velocity and its first two derivatives, and p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    /// Time since the last event τ [s].
    pub tau: f64,
    /// Displacement since the last event [m].
    pub p: f64,
    /// Velocity [m/s].
    pub v: f64,
    /// Acceleration [m/s²].
    pub a: f64,
    /// Jerk [m/s³].
    pub j: f64,
}

/// (sin x)/x.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

impl Arc {
    /// The motion at the time `tau` [s] since the last event.
    pub(super) fn at(&self, tau: f64) -> Point {
        let (natural, omega, m) = (self.natural, self.omega, self.mass);
        let (drive_sin, drive_cos) = self.drive;
        let (forced_cos, forced_cos_dot, forced_sin) = self.forced(tau);
        // τ sinc Ωτ is (sin Ωτ)/Ω, and (1 − cos Ωτ)/Ω² is ½τ² sinc²(Ωτ/2).
        let lag = tau * sinc(natural * tau);
        let half = sinc(0.5 * natural * tau);
        let rise = 0.5 * tau * tau * half * half;
        let p = self.v0 * lag
            + (self.constant * rise + drive_cos * forced_cos + drive_sin * forced_sin) / m;
        let v = self.v0 * (natural * tau).cos()
            + (self.constant * lag + drive_cos * forced_cos_dot + drive_sin * omega * forced_cos)
                / m;
        let (sin, cos) = (omega * tau).sin_cos();
        let force = self.constant + drive_sin * sin + drive_cos * cos;
        let force_dot = omega * (drive_sin * cos - drive_cos * sin);
        let a = (force - self.stiffness * p) / m;
        Point { tau, p, v, a, j: (force_dot - self.stiffness * v) / m }
    }

    /// The response from rest of ẍ + Ω²x to cos ωτ, its derivative, and the response to sin ωτ.
    fn forced(&self, tau: f64) -> (f64, f64, f64) {
        let (natural, omega) = (self.natural, self.omega);
        let (d, s) = (0.5 * (natural - omega), 0.5 * (natural + omega));
        if d.abs() > 0.25 * natural.max(omega) {
            let gap = natural * natural - omega * omega;
            let (sin, cos) = (omega * tau).sin_cos();
            let (own_sin, own_cos) = (natural * tau).sin_cos();
            let forced_sin = (sin - omega * tau * sinc(natural * tau)) / gap;
            return ((cos - own_cos) / gap, (natural * own_sin - omega * sin) / gap, forced_sin);
        }
        if s == 0.0 {
            return (0.5 * tau * tau, tau, 0.0);
        }
        // The differences of two nearby harmonics as products, with (sin dτ)/d → τ at resonance.
        let (sin_s, cos_s) = (s * tau).sin_cos();
        let (beat, cos_d) = (tau * sinc(d * tau), (d * tau).cos());
        let forced_cos = sin_s * beat / (2.0 * s);
        let forced_cos_dot = 0.5 * cos_s * beat + 0.5 * sin_s * cos_d / s;
        let forced_sin = 0.5 * (sin_s * cos_d / s - cos_s * beat) / natural;
        (forced_cos, forced_cos_dot, forced_sin)
    }

    /// A step in which the motion turns little: a sixteenth of the shortest period, or `most` [s].
    pub(super) fn step(&self, most: f64) -> f64 {
        let fastest = self.natural.max(self.omega);
        most.min(std::f64::consts::TAU / (16.0 * fastest))
    }

    /// Bounds on |v̈| and |d³v/dt³| over the time `h` [s] after `at`.
    ///
    /// The velocity obeys v̈ = (ẇ − Kv)/m; from `at` on |v| ≤ |v| + |a|h + ½aω h²/m with the values there,
    /// because no response of a mass on a spring is above that of the free mass.
    pub(super) fn bounds(&self, at: &Point, h: f64) -> (f64, f64) {
        let w_dot = self.omega * self.drive.0.hypot(self.drive.1);
        let v = at.v.abs() + at.a.abs() * h + 0.5 * h * h * w_dot / self.mass;
        let second = (w_dot + self.stiffness * v) / self.mass;
        let a = at.a.abs() + second * h;
        (second, (w_dot * self.omega + self.stiffness * a) / self.mass)
    }
}
