//! Motor and load as two masses, with a joint between them.
//!
//! The displacement q and the velocity v of the model are the motor's, and so is its friction; springs, weight and
//! the displacement that is measured are the load's. For a load of mass m at x with the speed w
//!
//! m ẇ = F − S(x) − φ sgn w,   M v̇ = all that drives the motor − F,
//!
//! where F is the force of the joint, S that of springs and weight, and φ the load's own friction. Within a stage all
//! of it is one equation for w with a closed form, so that the motor's velocity stays the only unknown.
//!
//! An axis with its encoder on the motor shows the motor's displacement: the load is then seen by its reaction alone.

use super::{Act, At, Key, Measure};
use crate::march::Real;

/// Which of the two the displacement is that is measured: 1 for the load's, 2 for the motor's.
pub(super) const ENCODER: Key = Key::probed("encoder", Measure::One);

/// Its place among the parameters of a joint.
const PLACE: usize = 4;

/// The displacement is the motor's.
pub(super) const AT_MOTOR: f64 = 2.0;

/// Whether a joint with these parameters hides its load behind the motor.
pub(crate) fn hides_load<D: Real>(p: &[D]) -> bool {
    p.get(PLACE).is_some_and(|encoder| encoder.re() > 1.5)
}

/// A joint, and the load beyond it.
#[derive(Debug, Clone, Copy)]
pub struct Joint<D> {
    /// Mass of the load [kg].
    pub mass: D,
    /// Stiffness of the joint where it touches [N/m].
    pub stiffness: D,
    /// Its damping [N·s/m].
    pub damping: D,
    /// Half of its play [m]; none for a spring that never parts.
    pub half: Option<D>,
    /// The load's own friction [N].
    pub rubs: D,
}

/// The motion of the load in a stage, whatever the joint does.
struct Free<D> {
    /// Where it would be at rest, and how fast it was [m, m/s].
    x: D,
    w: D,
    /// Its momentum per speed, with what its spring adds in the stage [kg].
    heavy: D,
    /// What pulls it back [N].
    pull: D,
    dt: f64,
}

impl<D: Real> Joint<D> {
    /// The force of springs and weight on the load at `x` [N], and its slope [N/m].
    fn pull(at: &At<D>, x: D) -> (D, D) {
        let b = at.balance;
        let (mut pull, mut slope) = (b.stiffness * x - b.constant, b.stiffness);
        if b.gravity.re() != 0.0 {
            pull += b.gravity * x.sin();
            slope += b.gravity * x.cos();
        }
        (pull, slope)
    }

    /// What the joint holds the motor back with [N], in place of springs and weight; the load's displacement and speed
    /// go to `z`.
    pub(crate) fn act(&self, at: &At<D>, base: &[D], z: &mut [D]) -> Act<D> {
        let (x, w) = (base[0], base[1]);
        let (pull, slope) = Self::pull(at, x + w * at.dt);
        let free = Free { x, w, heavy: self.mass + slope * (at.dt * at.dt), pull, dt: at.dt };
        let (force, speed) = self.force(at, &free);
        z[0] = x + speed * at.dt;
        z[1] = speed;
        Act::force(force - Self::pull(at, at.q).0)
    }

    /// The force of the joint and the speed of the load at the end of the stage.
    fn force(&self, at: &At<D>, free: &Free<D>) -> (D, D) {
        let Some(half) = self.half else { return self.touching(at, free, D::from(0.0)) };
        let loose = self.slowed(free.heavy * free.w - free.pull * free.dt, free.heavy, free.dt);
        let ahead = at.q - free.x - loose * free.dt;
        if ahead.re().abs() <= half.re() {
            return (D::from(0.0), loose);
        }
        let side = if ahead.re() > 0.0 { half } else { -half };
        let (force, speed) = self.touching(at, free, side);
        // Teeth push and do not pull.
        if force.re() * side.re() <= 0.0 {
            return (D::from(0.0), loose);
        }
        let gap = at.q - side - free.x;
        if (gap.re() - speed.re() * free.dt) * side.re() >= 0.0 || free.dt == 0.0 {
            return (force, speed);
        }
        // Damping alone would throw it back over the edge: it stays there.
        let speed = gap / free.dt;
        let way = if speed.re() == 0.0 { 0.0 } else { speed.re().signum() };
        let taken = free.heavy * (speed - free.w) / free.dt;
        (taken + free.pull + self.rubs * way, speed)
    }

    /// The same where the joint touches, the motor that much ahead of the load.
    fn touching(&self, at: &At<D>, free: &Free<D>, side: D) -> (D, D) {
        let dt = free.dt;
        let gap = at.q - side - free.x;
        let drives = self.stiffness * gap + self.damping * at.v;
        let heavy = free.heavy + (self.stiffness * dt + self.damping) * dt;
        let speed = self.slowed(free.heavy * free.w + (drives - free.pull) * dt, heavy, dt);
        (drives - (self.stiffness * dt + self.damping) * speed, speed)
    }

    /// The speed of so much momentum after the load's own friction.
    fn slowed(&self, momentum: D, heavy: D, dt: f64) -> D {
        let most = self.rubs * dt;
        let left = if momentum.re() > most.re() {
            momentum - most
        } else if momentum.re() < -most.re() {
            momentum + most
        } else {
            D::from(0.0)
        };
        left / heavy
    }

    /// By how much the motor is ahead of a load that is driven along, or held at rest if `way` is 0 [m]. Sliding the
    /// `way` it goes, the motor's own friction takes its level. The load may be `off` its tooth by so many halves of
    /// the play, or off its place by what so many times the motor's friction does [1].
    pub(crate) fn ahead(&self, at: &At<D>, (way, off): (f64, D)) -> D {
        let pull = Self::pull(at, at.q).0;
        let mut force = pull;
        if way != 0.0 {
            let drives = at.drive - pull - at.f_c() * way - at.balance.damping * at.v;
            let share = self.mass / (self.mass + at.mass);
            force += drives * share + self.rubs * way;
        }
        let Some(half) = self.half else { return (force + off * at.f_c()) / self.stiffness };
        let off = if off.re() < 0.0 { -off } else { off };
        let off = if off.re() > 2.0 { D::from(2.0) } else { off };
        let side = half * (D::from(1.0) - off) * if force.re() < 0.0 { -1.0 } else { 1.0 };
        side + force / self.stiffness
    }
}
