//! Motor and load as two masses, with a joint between them.
//!
//! The displacement q and the velocity v of the model are the motor's, and so is its friction; springs, weight and
//! the displacement that is measured are the load's. For a load of mass m at x with the speed w
//!
//! m ẇ = F − S(x) − φ sgn w − d w,   M v̇ = all that drives the motor − F,
//!
//! where F is the force of the joint, S that of springs and weight, φ the load's own dry friction and d its viscous one. Within a stage all
//! of it is one equation for w with a closed form, so that the motor's velocity stays the only unknown.
//!
//! An axis with its encoder on the motor shows the motor's displacement: the load is then seen by its reaction alone.

use super::{Act, At, Key, Measure};
use crate::march::Real;

/// Which of the two the displacement is that is measured: 1 for the load's, 2 for the motor's.
pub(super) const ENCODER: Key = Key::probed("encoder", Measure::One);

/// Its place among the parameters of a joint.
const PLACE: usize = 4;

/// The way in which the load's friction builds up; so short a one does not show.
pub(super) const GIVES: Key = Key::spare("gives", Measure::Length, 1e-9);

/// The load's own viscous friction; so little does not show.
pub(super) const DRAGS: Key = Key::spare("drags", Measure::Damping, 1e-12);

/// The damping ratio ζ of the load on the teeth; below 1 it bounces off them.
pub(super) const ZETA: Key = Key::spare("zeta", Measure::One, 1.0);

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
    /// The way in which it builds up [m].
    pub gives: D,
    /// The load's own viscous friction [N·s/m].
    pub drags: D,
}

/// The motion of the load in a stage, whatever the joint does.
struct Free<D> {
    /// Where it would be at rest, and how fast it was [m, m/s].
    x: D,
    w: D,
    /// Its momentum per speed, with what its spring and its viscous friction add in the stage [kg].
    heavy: D,
    /// What pulls it back [N].
    pull: D,
    /// The deflection of its bristles [m].
    bent: D,
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
        let (x, w, bent) = (base[0], base[1], base[2]);
        let (pull, slope) = Self::pull(at, x + w * at.dt);
        let heavy = self.mass + slope * (at.dt * at.dt) + self.drags * at.dt;
        let free = Free { x, w, heavy, pull: pull + self.drags * w, bent, dt: at.dt };
        let (force, speed) = self.force(at, &free);
        z[0] = x + speed * at.dt;
        z[1] = speed;
        z[2] = self.gives * self.rubbed(&free, speed);
        Act::Force(force - Self::pull(at, at.q).0)
    }

    /// The force of the joint and the speed of the load at the end of the stage.
    fn force(&self, at: &At<D>, free: &Free<D>) -> (D, D) {
        let Some(half) = self.half else { return self.touching(at, free, D::from(0.0)) };
        let loose = self.slowed(free, free.heavy * free.w - free.pull * free.dt, free.heavy);
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
        let taken = free.heavy * (speed - free.w) / free.dt;
        (taken + free.pull + self.rubs * self.rubbed(free, speed), speed)
    }

    /// The same where the joint touches, the motor that much ahead of the load.
    fn touching(&self, at: &At<D>, free: &Free<D>, side: D) -> (D, D) {
        let dt = free.dt;
        let gap = at.q - side - free.x;
        let (mut stiffness, mut damping) = (self.stiffness, self.damping);
        // Teeth that meet in this stage damp for the part of it in which they touch, which is how deep they are at its end
        // over how fast they came: so no force jumps, and the derivatives know that the time of the impact moves.
        if self.half.is_some() && dt > 0.0 && (gap.re() - at.v.re() * dt) * side.re() < 0.0 {
            (stiffness, damping) = (stiffness + damping / dt, D::from(0.0));
        }
        let drives = stiffness * gap + damping * at.v;
        let heavy = free.heavy + (stiffness * dt + damping) * dt;
        let speed = self.slowed(free, free.heavy * free.w + (drives - free.pull) * dt, heavy);
        (drives - (stiffness * dt + damping) * speed, speed)
    }

    /// The load's friction with which a stage ends at this `speed`, of its largest [1].
    fn rubbed(&self, free: &Free<D>, speed: D) -> D {
        let way = speed * free.dt;
        (free.bent + way) / (self.gives + if way.re() < 0.0 { -way } else { way })
    }

    /// The speed w of so much `momentum` p and mass h after the load's own friction:
    /// h w = p − dt φ (ζ + w dt)/(d + |w| dt), which is quadratic on either side of 0 and rises through it.
    fn slowed(&self, free: &Free<D>, momentum: D, heavy: D) -> D {
        let (d, dt) = (self.gives, free.dt);
        let most = self.rubs * dt;
        let leads = momentum * d - most * free.bent;
        let side = if leads.re() < 0.0 { -1.0 } else { 1.0 };
        let (a, b, c) = (heavy * dt, heavy * d + (most - momentum * side) * dt, leads * side);
        let root = (b * b + a * c * 4.0).sqrt();
        // Of the two forms of the root the one that takes no difference.
        let speed = if b.re() < 0.0 { (root - b) / (a * 2.0) } else { c * 2.0 / (root + b) };
        speed * side
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
            force += drives * share + self.rubs * way + self.drags * at.v;
        }
        let Some(half) = self.half else { return (force + off * at.f_c()) / self.stiffness };
        let off = if off.re() < 0.0 { -off } else { off };
        let off = if off.re() > 2.0 { D::from(2.0) } else { off };
        let side = half * (D::from(1.0) - off) * if force.re() < 0.0 { -1.0 } else { 1.0 };
        side + force / self.stiffness
    }
}
