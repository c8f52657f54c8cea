//! The gearbox rig: a drum on the output shaft, held by two springs (pp. 100–102).

use super::Plant;

/// The drum of the rig, its two springs and its motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rig {
    /// Inertia at the drum I [kg·m²].
    pub inertia: f64,
    /// Radius of the drum r [m].
    pub radius: f64,
    /// Stiffness of the first spring k₁ [N/m].
    pub k_1: f64,
    /// Stiffness of the second spring k₂ [N/m].
    pub k_2: f64,
    /// Force in the first spring at θ = 0, F₁₀ [N].
    pub f_10: f64,
    /// Force in the second spring at θ = 0, F₂₀ [N].
    pub f_20: f64,
    /// Torque at the drum per current k_m [N·m/A].
    pub motor_constant: f64,
    /// Turns of the motor for one of the drum [1]; k_m contains it already.
    pub gear_ratio: f64,
}

impl Rig {
    /// The rig of the paper (p. 101), its radius one inch.
    pub const PAPER: Self = Self {
        inertia: 3e-4,
        radius: 0.0254,
        k_1: 2.0,
        k_2: 2.0,
        f_10: 0.01,
        f_20: 0.01,
        motor_constant: 16.5,
        gear_ratio: 68.8,
    };

    /// F₁ = F₁₀ + k₁rθ and F₂ = F₂₀ − k₂rθ [N] at the angle θ [rad], negative where a string would have
    /// to push.
    pub fn spring_forces(&self, theta: f64) -> (f64, f64) {
        let stretch = self.radius * theta;
        (self.f_10 + self.k_1 * stretch, self.f_20 - self.k_2 * stretch)
    }

    /// The smallest |θ| [rad] at which a spring goes slack, in whichever direction.
    pub fn slack_angle(&self) -> f64 {
        (self.f_10 / self.k_1).min(self.f_20 / self.k_2) / self.radius
    }

    /// The sum of the torques Iθ̈ [N·m] at the angle θ [rad], with the motor's T_m and the friction T_f.
    ///
    /// Iθ̈ = T_m − T_f + F₂r − F₁r   (37)
    pub fn net_torque(&self, theta: f64, motor: f64, friction: f64) -> f64 {
        let (f_1, f_2) = self.spring_forces(theta);
        motor - friction + f_2 * self.radius - f_1 * self.radius
    }

    /// The same with the spring forces eliminated.
    ///
    /// Iθ̈ = T_m − T_f − (F₁₀ − F₂₀)r − (k₁ + k₂)r²θ   (38)
    pub fn net_torque_of_springs(&self, theta: f64, motor: f64, friction: f64) -> f64 {
        let r = self.radius;
        motor - friction - (self.f_10 - self.f_20) * r - (self.k_1 + self.k_2) * r * r * theta
    }

    /// The motor's torque at the drum [N·m] for the current i_m [A].
    ///
    /// T_m = k_m i_m   (39)
    pub fn motor_torque(&self, current: f64) -> f64 {
        self.motor_constant * current
    }

    /// Equation 38 divided by I [rad/s²].
    ///
    /// θ̈ = T_m/I − T_f/I − (F₁₀ − F₂₀)r/I − (k₁ + k₂)r²/I · θ   (40)
    pub fn acceleration(&self, theta: f64, motor: f64, friction: f64) -> f64 {
        self.net_torque_of_springs(theta, motor, friction) / self.inertia
    }

    /// The same plant as a mass on a spring; unequal prestress, which the paper leaves out of its map
    /// because F₁₀ = F₂₀, is a constant force.
    ///
    /// k_s/m = (k₁ + k₂)r²/I, F_e/m = k_m i_m/I, F/m = T_f/I   (41)
    pub fn plant(&self) -> Plant {
        Plant {
            mass: self.inertia,
            stiffness: (self.k_1 + self.k_2) * self.radius * self.radius,
            gain: self.motor_torque(1.0),
            offset: -(self.f_10 - self.f_20) * self.radius,
        }
    }
}
