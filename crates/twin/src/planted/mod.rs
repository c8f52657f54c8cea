//! A plant with effects hidden in it.
//!
//! Its states are displacement and speed of the motor's side, the bristle, then displacement, speed and bristle of
//! the load if a joint parts the two, then those of the effects. Coulomb's law stays the set-valued one: a plant
//! that is stuck does not move before the pull exceeds what holds, whatever the effects do meanwhile.

mod follow;
mod joint;
mod record;

pub(crate) use record::record;

use crate::{
    Hidden, PlantKind, Scenario, TwinError,
    contact::Contact,
    hidden::{Effect, Joint, Now},
    plant::Balance,
    signal::Leg,
    wide::{Flow, MOST, State},
};
use joint::Load;

/// Where a state stands: displacement, speed, bristle; displacement, speed and bristle of the load.
const Q: usize = 0;
const V: usize = 1;
const Z: usize = 2;
const LOAD_Q: usize = 3;
const LOAD_V: usize = 4;
const LOAD_Z: usize = 5;

/// An effect with the place of its states.
struct Placed<'a> {
    effect: &'a dyn Effect,
    from: usize,
    to: usize,
}

impl Placed<'_> {
    fn own<'b>(&self, y: &'b State) -> &'b [f64] {
        &y[self.from..self.to]
    }
}

/// A plant with effects, while its input is smooth and its contacts go one way.
pub(crate) struct Planted<'a> {
    plant: PlantKind,
    /// Nothing if the motion is imposed.
    balance: Option<Balance>,
    contact: Contact,
    beside: Vec<Contact>,
    load: Option<Load>,
    effects: Vec<Placed<'a>>,
    hidden: &'a dyn Hidden,
    level: f64,
    grain: f64,
    states: usize,
    /// The true input, and how late it is [s].
    leg: Leg<'a>,
    delay: f64,
    /// The way the contacts go, ±1; 0 while stuck.
    way: f64,
}

/// The plant at one instant, with what acts on it.
struct Look {
    now: Now,
    z_dot: f64,
    /// The friction model's force with all that makes it stronger [N] or [N·m].
    rubbing: f64,
    /// All other friction on the motor's side, with the offset [N] or [N·m].
    drag: f64,
    /// What holds the motor's side back: the joint, or the load itself [N] or [N·m].
    back: f64,
}

impl<'a> Planted<'a> {
    /// The plant of a scenario; `effects` are its own, and the scenario is rewritten by them already.
    pub(crate) fn new(
        scenario: &Scenario,
        effects: Vec<&'a dyn Effect>,
        hidden: &'a dyn Hidden,
    ) -> Result<Self, TwinError> {
        let (friction, start) = (&scenario.friction, scenario.start);
        let balance = scenario.plant.balance();
        let (level, grain) = (friction.level(), friction.grain());
        let mut joint = Joint { stiffness: f64::INFINITY, gap: 0.0 };
        for effect in &effects {
            effect.joint(&mut joint);
        }
        let load = balance.and_then(|b| Load::new(&scenario.plant, &joint, b.inertia, level));
        let mut states = if load.is_some() { LOAD_Z + 1 } else { Z + 1 };
        let mut placed = Vec::new();
        for effect in effects {
            let from = states;
            states += effect.states();
            placed.push(Placed { effect, from, to: states });
        }
        if states > MOST {
            let expected = "fewer effects at once: there are twelve states in all";
            return Err(TwinError::value("hidden", format!("{states} states"), expected));
        }
        let beside = placed.iter().filter_map(|p| p.effect.beside());
        Ok(Self {
            plant: scenario.plant,
            balance,
            contact: Contact::new(friction, start.position),
            beside: beside.map(|friction| Contact::new(&friction, start.position)).collect(),
            load,
            delay: placed.iter().map(|p| p.effect.delay()).sum(),
            effects: placed,
            hidden,
            level,
            grain,
            states,
            leg: Leg::Held(0.0),
            way: 0.0,
        })
    }

    /// How late the converter is [s].
    pub(crate) fn delay(&self) -> f64 {
        self.delay
    }

    /// Displacement and speed of the motor's side.
    fn motion(&self, t: f64, y: &State) -> (f64, f64) {
        if self.balance.is_some() { (y[Q], y[V]) } else { self.leg.at(t - self.delay) }
    }

    /// Whether a reversal has to be told to a contact.
    fn remembers(&self) -> bool {
        self.contact.remembers() || !self.beside.is_empty()
    }

    /// Whether it can stick without moving at all.
    fn sticks(&self) -> bool {
        self.contact.sticks() && self.balance.is_some()
    }

    fn stuck(&self) -> bool {
        self.sticks() && self.way == 0.0
    }

    /// The contacts reverse at q and go this way.
    fn turn(&mut self, q: f64, way: f64) {
        self.contact.turn(q, way);
        self.beside.iter_mut().for_each(|contact| contact.turn(q, way));
        self.way = way;
    }

    /// The sum over all effects.
    fn sum(&self, y: &State, of: impl Fn(&dyn Effect, &[f64]) -> f64) -> f64 {
        self.effects.iter().map(|p| of(p.effect, p.own(y))).sum()
    }

    /// The true drive [N] or [N·m].
    fn drive(&self, t: f64) -> f64 {
        let Some(balance) = self.balance else { return 0.0 };
        let told = self.leg.at(t - self.delay).0;
        let u = self.effects.iter().fold(told, |u, p| p.effect.input(u));
        self.effects.iter().fold(balance.gain * u, |drive, p| p.effect.amplifier(u, drive))
    }

    /// Forces of the two springs [N]; the one of a mass counts as two.
    fn springs(&self, q: f64) -> [f64; 2] {
        let (drawn, forces) = match self.plant {
            PlantKind::Drum { radius, k_1, k_2, f_10, f_20, .. } => {
                let drawn = radius * self.effects.iter().fold(q, |q, p| p.effect.drawn(q));
                (drawn, [f_10 + k_1 * drawn, f_20 - k_2 * drawn])
            }
            PlantKind::MassSpring { stiffness, .. } => {
                (q, [0.5 * stiffness * q, -0.5 * stiffness * q])
            }
            _ => return [0.0; 2],
        };
        self.effects.iter().fold(forces, |forces, p| p.effect.springs(drawn, forces))
    }

    /// What springs, weight and effects hold the load back with [N] or [N·m].
    fn restoring(&self, now: &Now) -> f64 {
        let q = now.load_q;
        let [f_1, f_2] = self.springs(q);
        let held = match self.plant {
            PlantKind::Drum { radius, .. } => {
                self.effects.iter().fold(radius, |r, p| r * p.effect.lever(q)) * (f_1 - f_2)
            }
            _ => f_1 - f_2 + self.balance.map_or(0.0, |b| b.weight * q.sin()),
        };
        held + self.effects.iter().map(|p| p.effect.load(now)).sum::<f64>()
    }

    /// How much stronger the friction model is.
    fn share(&self, now: &Now, y: &State) -> f64 {
        let share = self.sum(y, |effect, x| effect.share(now, x));
        if self.contact.bristle.sigma_0 > 0.0 || self.level == 0.0 {
            return 1.0 + share;
        }
        // A bristle slips at a higher level; what has none is stronger as a whole.
        1.0 + share + self.sum(y, |effect, x| effect.rise(now, x)) / self.level
    }

    fn look(&self, t: f64, y: &State) -> Look {
        let (q, v) = self.motion(t, y);
        let (load_q, load_v) = if self.load.is_some() { (y[LOAD_Q], y[LOAD_V]) } else { (q, v) };
        let (level, grain) = (self.level, self.grain);
        let inertia = self.balance.map_or(0.0, |b| b.inertia);
        let drive = self.drive(t);
        let mut now =
            Now { t, drive, q, v, load_q, load_v, level, grain, inertia, ..Now::default() };
        let bristle = &self.contact.bristle;
        let mut z_dot = 0.0;
        if bristle.sigma_0 > 0.0 {
            let rise = self.sum(y, |effect, x| effect.rise(&now, x));
            now.slip = v.abs() * y[Z] / (bristle.settled(v) + rise / bristle.sigma_0);
            z_dot = v - now.slip;
            now.friction = bristle.sigma_0 * y[Z] + bristle.sigma_1 * z_dot;
        } else {
            now.friction = self.contact.force(q).0;
            now.slip = if level > 0.0 { v * now.friction.abs() / level } else { v };
        }
        let back = match &self.load {
            Some(load) => load.joint_force(q - load_q, v - load_v),
            None => self.restoring(&now),
        };
        let beside: f64 = self.beside.iter().map(|contact| contact.force(q).0).sum();
        let motor = self.balance.map_or(0.0, |b| b.drag);
        let drag = (motor + self.contact.sigma_2) * v
            + beside
            + self.plant.offset()
            + self.sum(y, |effect, x| effect.friction(&now, x))
            - self.hidden.drive(t, q, v);
        Look { now, z_dot, rubbing: now.friction * self.share(&now, y), drag, back }
    }

    /// By how much the pull exceeds what holds a stuck plant, and the pull [N] or [N·m].
    fn excess(&self, t: f64, y: &State) -> (f64, f64) {
        let look = self.look(t, y);
        let pull = look.now.drive - look.drag - look.back;
        let hold = self.contact.hold();
        let now = Now { friction: hold.copysign(pull), ..look.now };
        (pull.abs() - hold * self.share(&now, y), pull)
    }
}

impl Flow for Planted<'_> {
    fn states(&self) -> usize {
        self.states
    }

    fn slope(&self, t: f64, y: &State) -> State {
        let look = self.look(t, y);
        let mut slope = [0.0; MOST];
        if let Some(balance) = self.balance.filter(|_| !self.stuck()) {
            let inertia =
                self.load.as_ref().map_or(balance.inertia, |l| balance.inertia - l.inertia);
            slope[Q] = look.now.v;
            slope[V] = (look.now.drive - look.rubbing - look.drag - look.back) / inertia;
        }
        slope[Z] = look.z_dot;
        if let Some(load) = &self.load {
            let (force, bristle) = load.friction(y[LOAD_V], y[LOAD_Z]);
            slope[LOAD_Q] = y[LOAD_V];
            slope[LOAD_V] = (look.back - self.restoring(&look.now) - force) / load.inertia;
            slope[LOAD_Z] = bristle;
        }
        for placed in &self.effects {
            placed.effect.rates(&look.now, placed.own(y), &mut slope[placed.from..placed.to]);
        }
        slope
    }
}
