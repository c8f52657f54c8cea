//! The plant as the march sees it: one equation for all five kinds.

use super::{Contact, Real};

/// What drives the plant beside friction: T = gain·u + constant − stiffness·q − damping·v − gravity·sin q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance<D> {
    /// Mass M [kg] or inertia [kg·m²].
    pub mass: D,
    /// Driving force per unit of input [N per unit].
    pub gain: D,
    /// Constant driving force [N].
    pub constant: D,
    /// Stiffness [N/m].
    pub stiffness: D,
    /// Damping that is no friction of the contact, as a motor's back-EMF [N·s/m].
    pub damping: D,
    /// Largest moment of gravity m g l [N·m].
    pub gravity: D,
}

/// A plant and its friction.
#[derive(Debug, Clone, PartialEq)]
pub struct Model<D> {
    /// The plant.
    pub balance: Balance<D>,
    /// The friction.
    pub contact: Contact<D>,
    /// Viscous coefficient σ₂ [N·s/m].
    pub sigma_2: D,
    /// A constant force on the side of the friction [N].
    pub offset: D,
}

impl<D: Real> Model<D> {
    /// The force [N] on the mass, all but the friction of the contact, at the input `u`.
    pub fn drive(&self, u: D, q: D, v: D) -> D {
        let b = &self.balance;
        let mut force = b.gain * u + b.constant
            - b.stiffness * q
            - (b.damping + self.sigma_2) * v
            - self.offset;
        if b.gravity.re() != 0.0 {
            force -= b.gravity * q.sin();
        }
        force
    }

    /// The same with every number turned into another kind.
    pub fn map<E: Real>(&self, to: impl Fn(D) -> E) -> Model<E> {
        let b = &self.balance;
        Model {
            balance: Balance {
                mass: to(b.mass),
                gain: to(b.gain),
                constant: to(b.constant),
                stiffness: to(b.stiffness),
                damping: to(b.damping),
                gravity: to(b.gravity),
            },
            contact: self.contact.map(&to),
            sigma_2: to(self.sigma_2),
            offset: to(self.offset),
        }
    }
}
