//! The friction of one stage: its states and its force as functions of the stage's velocity alone.

use super::{Real, size};

/// A friction model without its viscous term, in numbers that may carry derivatives.
#[derive(Debug, Clone, PartialEq)]
pub enum Contact<D> {
    /// No friction.
    None,
    /// F = F_C sgn v, any force up to F_C at rest.
    Coulomb {
        /// Coulomb force F_C [N].
        f_c: D,
    },
    /// The state is the force itself, Ḟ = σ|w|^γ sgn(w) v with w = 1 − (F/F_C) sgn v.
    Dahl {
        /// Coulomb force F_C [N].
        f_c: D,
        /// Rest stiffness σ [N/m].
        sigma: D,
        /// Shape γ [1].
        gamma: D,
    },
    /// The state is the bristles' deflection z [m], ż = v − |v|/r(v) z and F = σ₀z + σ₁ż.
    LuGre {
        /// Coulomb force F_C [N].
        f_c: D,
        /// Stiction force F_S [N].
        f_s: D,
        /// Stribeck velocity v_S [m/s].
        v_s: D,
        /// Bristle stiffness σ₀ [N/m].
        sigma_0: D,
        /// Bristle damping σ₁ [N·s/m].
        sigma_1: D,
    },
    /// The states are the deflections of the elements [m], each between −Δᵢ and Δᵢ.
    MaxwellSlip {
        /// Stiffnesses kᵢ [N/m].
        k: Vec<D>,
        /// Deadbands Δᵢ [m].
        delta: Vec<D>,
    },
}

/// Beyond so many squared Stribeck velocities exp(−s²) is below the last digit of F_C; near its underflow the C
/// library takes ten times as long over it.
const FADED: f64 = 60.0;

/// The deflection of a contact that has none in its model [m]: that of its asperities.
const RIGID: f64 = 1e-5;

/// The force F_C + (F_S − F_C) exp(−(v/v_S)²) at which LuGre's bristles slip in steady sliding at the velocity `v` [m/s],
/// higher by the `rise` where there is one [N].
fn slips<D: Real>([f_c, f_s, v_s]: [D; 3], (v, rise): (D, Option<D>)) -> D {
    let mut level = f_c;
    if (v.re() / v_s.re()).powi(2) < FADED {
        let s = v / v_s;
        level += (f_s - f_c) * (-(s * s)).exp();
    }
    rise.map_or(level, |rise| level + rise)
}

/// The deflection of the bristles there [m].
pub(crate) fn deflection<D: Real>(parameters: [D; 3], sigma_0: D, at: (D, Option<D>)) -> D {
    slips(parameters, at) / sigma_0
}

impl<D: Real> Contact<D> {
    /// The number of states.
    pub fn states(&self) -> usize {
        match self {
            Self::None | Self::Coulomb { .. } => 0,
            Self::Dahl { .. } | Self::LuGre { .. } => 1,
            Self::MaxwellSlip { k, .. } => k.len(),
        }
    }

    /// The force that holds at rest whatever the velocity does next, F_C of Coulomb friction; none of the
    /// others has such a jump.
    pub(super) fn dry(&self) -> Option<D> {
        match self {
            Self::Coulomb { f_c } => Some(*f_c),
            _ => None,
        }
    }

    /// The force of slow sliding [N], 0 without friction.
    pub fn level(&self) -> D {
        match self {
            Self::None => D::from(0.0),
            Self::Coulomb { f_c } | Self::Dahl { f_c, .. } | Self::LuGre { f_c, .. } => *f_c,
            Self::MaxwellSlip { k, delta } => {
                k.iter().zip(delta).fold(D::from(0.0), |sum, (k, d)| sum + *k * *d)
            }
        }
    }

    /// The friction force [N] of a stage with velocity `v` [m/s], without the jump of [`Self::dry`]; writes
    /// its states z, which solve z = `base` + `dt` ż(z, v), dt [s] being the stage's own share of the step. Bristles
    /// slip at a level that is higher by `rise` [N]; the others do not know of it. All levels grow by a share where one
    /// is given [1].
    pub(super) fn stage(
        &self,
        base: &[D],
        dt: f64,
        (v, rise, share): (D, Option<D>, Option<D>),
        z: &mut [D],
    ) -> D {
        let grown = |level: D| share.map_or(level, |share| level + level * share);
        match self {
            Self::None | Self::Coulomb { .. } => D::from(0.0),
            Self::Dahl { f_c, sigma, gamma } => {
                z[0] = dahl([grown(*f_c), *sigma, *gamma], base[0], v * dt);
                z[0]
            }
            Self::LuGre { f_c, f_s, v_s, sigma_0, sigma_1 } => {
                let level = grown(slips([*f_c, *f_s, *v_s], (v, rise)));
                let path = v * dt;
                // (z_b + p)/(1 + |p|/r) with r = level/σ₀, and one division in place of three.
                z[0] = (base[0] + path) * level / (*sigma_0 * size(path) + level);
                *sigma_0 * z[0] + *sigma_1 * (z[0] - base[0]) / dt
            }
            Self::MaxwellSlip { k, delta } => {
                let mut force = D::from(0.0);
                for (i, (k, delta)) in k.iter().zip(delta).enumerate() {
                    z[i] = within(base[i] + v * dt, grown(*delta));
                    force += *k * z[i];
                }
                force
            }
        }
    }

    /// The same with every number turned into another kind.
    pub(super) fn map<E: Real>(&self, to: &dyn Fn(D) -> E) -> Contact<E> {
        match self {
            Self::None => Contact::None,
            Self::Coulomb { f_c } => Contact::Coulomb { f_c: to(*f_c) },
            Self::Dahl { f_c, sigma, gamma } => {
                Contact::Dahl { f_c: to(*f_c), sigma: to(*sigma), gamma: to(*gamma) }
            }
            Self::LuGre { f_c, f_s, v_s, sigma_0, sigma_1 } => Contact::LuGre {
                f_c: to(*f_c),
                f_s: to(*f_s),
                v_s: to(*v_s),
                sigma_0: to(*sigma_0),
                sigma_1: to(*sigma_1),
            },
            Self::MaxwellSlip { k, delta } => Contact::MaxwellSlip {
                k: k.iter().map(|k| to(*k)).collect(),
                delta: delta.iter().map(|d| to(*d)).collect(),
            },
        }
    }

    /// The states [N] or [m] of a contact that has been sliding at the velocity `v` for long.
    pub fn sliding(&self, v: f64) -> Vec<D> {
        let toward = |x: D| if v.is_sign_negative() { -x } else { x };
        match self {
            Self::None | Self::Coulomb { .. } => Vec::new(),
            Self::Dahl { f_c, .. } => vec![toward(*f_c)],
            Self::LuGre { f_c, f_s, v_s, sigma_0, .. } => {
                let at = (D::from(v), None);
                vec![toward(deflection([*f_c, *f_s, *v_s], *sigma_0, at))]
            }
            Self::MaxwellSlip { delta, .. } => delta.iter().map(|d| toward(*d)).collect(),
        }
    }

    /// The states [N] or [m] of a contact at rest that holds the `force` [N], at most what it can hold.
    pub fn holding(&self, force: D) -> Vec<D> {
        match self {
            Self::None | Self::Coulomb { .. } => Vec::new(),
            Self::Dahl { f_c, .. } => vec![within(force, *f_c)],
            Self::LuGre { f_c, f_s, sigma_0, .. } => {
                let most = if f_s.re() > f_c.re() { *f_s } else { *f_c };
                vec![within(force, most) / *sigma_0]
            }
            Self::MaxwellSlip { k, delta } => {
                let most = k.iter().zip(delta).fold(D::from(0.0), |sum, (k, d)| sum + *k * *d);
                let share = within(force / most, D::from(1.0));
                delta.iter().map(|d| *d * share).collect()
            }
        }
    }

    /// The same with bristles that slip at a level that is higher by `rise` [N]; the others do not know of it. All
    /// levels grow by the `share` where there is one [1].
    pub(crate) fn raised(&self, rise: Option<D>, share: Option<D>) -> Self {
        let mut raised = self.clone();
        if let Some(share) = share {
            let grow = |level: &mut D| *level += *level * share;
            match &mut raised {
                Self::None => {}
                Self::Coulomb { f_c } | Self::Dahl { f_c, .. } => grow(f_c),
                Self::LuGre { f_c, f_s, .. } => [f_c, f_s].into_iter().for_each(grow),
                Self::MaxwellSlip { delta, .. } => delta.iter_mut().for_each(grow),
            }
        }
        if let (Self::LuGre { f_c, f_s, .. }, Some(rise)) = (&mut raised, rise) {
            *f_c += rise;
            *f_s += rise;
        }
        raised
    }

    /// The states of elements that slip, after the displacement went from turn to turn of `path` [m]; none for other
    /// contacts, and without a path.
    pub fn slipped(&self, path: &[f64]) -> Option<Vec<D>> {
        let Self::MaxwellSlip { delta, .. } = self else { return None };
        if path.len() < 2 {
            return None;
        }
        let one = |delta: &D| {
            let moved = |z: D, step: &[f64]| within(z + (step[1] - step[0]), *delta);
            path.windows(2).fold(D::from(0.0), moved)
        };
        Some(delta.iter().map(one).collect())
    }

    /// The states `z` shifted by `share` of their natural size, no element beyond its deadband.
    pub fn shifted(&self, mut z: Vec<D>, share: D) -> Vec<D> {
        if let Self::MaxwellSlip { delta, .. } = self {
            for (z, delta) in z.iter_mut().zip(delta) {
                *z = within(*z + *delta * share, *delta);
            }
            return z;
        }
        for z in &mut z {
            *z += share * self.scale();
        }
        z
    }

    /// The distance [m] over which the contact forgets where it was.
    pub fn memory(&self) -> f64 {
        match self {
            Self::None | Self::Coulomb { .. } => 0.0,
            Self::Dahl { f_c, sigma, .. } => f_c.re() / sigma.re(),
            Self::LuGre { f_c, f_s, sigma_0, .. } => f_c.re().max(f_s.re()) / sigma_0.re(),
            Self::MaxwellSlip { delta, .. } => delta.iter().map(Real::re).fold(0.0, f64::max),
        }
    }

    /// Whether the level at which it slips is one of its bristles' deflection.
    pub(crate) fn bristles(&self) -> bool {
        matches!(self, Self::LuGre { .. })
    }

    /// The shortest deflection [m] at which it slips.
    pub(crate) fn grain(&self) -> f64 {
        match self {
            Self::None | Self::Coulomb { .. } => RIGID,
            Self::LuGre { f_c, sigma_0, .. } => f_c.re() / sigma_0.re(),
            Self::Dahl { .. } => self.memory(),
            Self::MaxwellSlip { delta, .. } => {
                delta.iter().map(Real::re).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// What share of its level the contact holds [1], and so what share of the motion is slip, after a stage of `dt` [s]
    /// with velocity `v` [m/s] from the states `z`: bristles' level is what they slip at at this velocity, higher by `rise`
    /// [N], and not F_C.
    pub(crate) fn held(&self, z: &[D], (dt, v, rise): (f64, D, D)) -> D {
        let share = match self {
            Self::None | Self::Coulomb { .. } => return D::from(1.0),
            Self::Dahl { f_c, .. } => z[0] / *f_c,
            Self::LuGre { f_c, f_s, v_s, sigma_0, .. } => {
                let level = slips([*f_c, *f_s, *v_s], (v, Some(rise)));
                let path = v * dt;
                *sigma_0 * (z[0] + path) / (*sigma_0 * size(path) + level)
            }
            Self::MaxwellSlip { k, .. } => {
                let force = k.iter().zip(z).fold(D::from(0.0), |sum, (k, z)| sum + *k * *z);
                force / self.level()
            }
        };
        size(share)
    }

    /// The natural size of the states [N] or [m].
    pub(super) fn scale(&self) -> f64 {
        match self {
            Self::Dahl { f_c, .. } => f_c.re(),
            _ => self.memory(),
        }
    }
}

fn within<D: Real>(x: D, most: D) -> D {
    if x.re() > most.re() {
        most
    } else if x.re() < -most.re() {
        -most
    } else {
        x
    }
}

/// The force at the end of a `path` [m] by the implicit rule F = `base` + σ|w|^γ sgn(w) path.
///
/// With s = sgn path and w = 1 − sF/F_C it is w + κ|w|^γ sgn w = w_b, κ = σ|path|/F_C, which has one solution.
fn dahl<D: Real>([f_c, sigma, gamma]: [D; 3], base: D, path: D) -> D {
    let up = path.re() >= 0.0;
    let along = |f: D| if up { f } else { -f };
    let w_base = -along(base) / f_c + 1.0;
    let kappa = sigma * size(path) / f_c;
    let w = root(w_base.re(), kappa.re(), gamma.re());
    if w == 0.0 {
        return along(f_c);
    }
    let excess = kappa * (gamma * w.abs().ln()).exp() * w.signum() + w - w_base;
    let slope = 1.0 + kappa.re() * gamma.re() * w.abs().powf(gamma.re() - 1.0);
    along((excess / slope - w + 1.0) * f_c)
}

/// w with w + κ|w|^γ sgn w = w_b, between 0 and w_b, to the last digits.
fn root(w_base: f64, kappa: f64, gamma: f64) -> f64 {
    if gamma == 0.0 {
        return w_base.signum() * (w_base.abs() - kappa).max(0.0);
    }
    if gamma == 1.0 {
        return w_base / (1.0 + kappa);
    }
    // In y = w^γ for γ < 1 and in w itself for γ ≥ 1 the function is convex and Newton's method monotone.
    let target = w_base.abs();
    let (p, q) = if gamma < 1.0 { (1.0 / gamma, 1.0) } else { (1.0, gamma) };
    let mut y = if gamma < 1.0 { target.powf(gamma) } else { target };
    for _ in 0..100 {
        let (value, slope) = (power(y, p), kappa * power(y, q));
        let excess = value + slope - target;
        let steep = (p * value + q * slope) / y;
        let next = (y - excess / steep).max(0.0);
        // Not a number ends it, too.
        if next.partial_cmp(&(y * (1.0 - 1e-15))) != Some(std::cmp::Ordering::Less) {
            break;
        }
        y = next;
    }
    w_base.signum() * power(y, p)
}

/// y to the power of `p`, which often is 1 and takes as long then.
fn power(y: f64, p: f64) -> f64 {
    if p == 1.0 { y } else { y.powf(p) }
}

#[cfg(test)]
mod tests {
    use super::Contact;

    #[test]
    fn what_slides_steadily_holds_its_level_and_all_its_motion_is_slip() {
        let contact =
            Contact::LuGre { f_c: 4.0, f_s: 6.0, v_s: 0.01, sigma_0: 1e5, sigma_1: 300.0 };
        for v in [1e-3, -0.02, 1.0] {
            for dt in [1e-5, 0.1] {
                let held = contact.held(&contact.sliding(v), (dt, v, 0.0));
                assert!((held - 1.0).abs() < 1e-12, "{held} at {v} m/s");
            }
        }
        // Bristles half as far as they go, 6 N / 1e5 N/m, hold half in a short while; 1.5 N more are held by none.
        let held = contact.held(&[3e-5], (1e-9, 0.0, 0.0));
        assert!((held - 0.5).abs() < 1e-9, "{held}");
        let held = contact.held(&[3e-5], (1e-9, 0.0, 1.5));
        assert!((held - 3.0 / 7.5).abs() < 1e-9, "{held}");
    }
}
