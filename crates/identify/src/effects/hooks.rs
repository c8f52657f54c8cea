//! Where an effect takes hold.

use super::{About, Kind, joint::Joint};
use crate::march::{Balance, Contact, Real};

/// An instant of a motion, as a law sees it.
#[derive(Debug, Clone, Copy)]
pub struct At<'a, D> {
    /// Time since the record began [s].
    pub t: f64,
    /// The stage's own share of a step [s].
    pub dt: f64,
    /// What drives the plant [N].
    pub drive: D,
    /// Displacement [m].
    pub q: D,
    /// Velocity [m/s].
    pub v: D,
    /// Radius of a drum [m], 1 for others.
    pub radius: f64,
    /// The contact, and its states before the stage.
    pub contact: (&'a Contact<D>, &'a [D]),
    /// What drives the plant.
    pub balance: &'a Balance<D>,
    /// The mass that moves, the motor's where the load is another [kg].
    pub mass: D,
}

impl<D: Real> At<'_, D> {
    /// The Coulomb force of the nominal friction [N], 0 if it has none.
    pub fn f_c(&self) -> D {
        self.contact.0.level()
    }

    /// The shortest deflection at which the contact slips [m].
    pub fn grain(&self) -> f64 {
        self.contact.0.grain()
    }

    /// What springs and weight pull back with [N].
    pub fn pull(&self) -> D {
        let pull = self.balance.stiffness * self.q - self.balance.constant;
        if self.balance.gravity.re() == 0.0 {
            return pull;
        }
        pull + self.balance.gravity * self.q.sin()
    }

    /// What share of its level, higher by `rise` [N], the contact holds [1]: so much of the motion is slip.
    pub fn held(&self, rise: D) -> D {
        self.contact.0.held(self.contact.1, (self.dt, self.v, rise))
    }
}

/// A rest beside which every other is short [s].
pub const LONG: f64 = 1e9;

/// What was before a motion.
#[derive(Debug, Clone, Copy)]
pub struct Past<'a> {
    /// Where the displacement has turned [m], without the turns inside larger ones; empty if nobody asked.
    pub path: &'a [f64],
    /// For how long it has been at rest [s].
    pub rested: f64,
    /// The last samples: how long each took [s], and how far it had come then since it last turned [m].
    pub lately: &'a [[f64; 2]],
}

impl Past<'_> {
    /// Of what nothing is known: a rest as long as can be.
    pub fn unknown() -> Self {
        Self { path: &[], rested: LONG, lately: &[] }
    }
}

/// What an effect adds to the friction F of the model: most add one of these. With zeros in place of what is not there
/// a motion took a quarter longer, and its derivatives half as long again.
#[derive(Debug, Clone, Copy)]
pub struct Act<D> {
    /// A force beside it [N], smooth in the velocity.
    pub force: Option<D>,
    /// F grows by this share of itself [1].
    pub more: Option<D>,
    /// F grows by this share of itself where it is positive, and falls where it is negative [1].
    pub skew: Option<D>,
    /// The level at which the contact slips is higher by so much [N]: bristles slip at a larger deflection, what has
    /// none grows as a whole.
    pub rise: Option<D>,
    /// The level at which the contact slips grows by this share of itself, and its stiffness stays [1].
    pub level: Option<D>,
    /// A force against the motion that holds at rest [N].
    pub dry: Option<D>,
}

/// Adds what may be there to what may be there.
fn add<D: Real>(sum: &mut Option<D>, more: Option<D>) {
    if let Some(more) = more {
        *sum = Some(sum.map_or(more, |sum| sum + more));
    }
}

impl<D: Real> Act<D> {
    /// None at all.
    pub fn none() -> Self {
        Self { force: None, more: None, skew: None, rise: None, level: None, dry: None }
    }

    /// A force beside the friction [N].
    pub fn force(force: D) -> Self {
        Self { force: Some(force), ..Self::none() }
    }

    /// A share by which the friction grows [1].
    pub fn more(more: D) -> Self {
        Self { more: Some(more), ..Self::none() }
    }

    /// A share by which the level grows at which the contact slips [1].
    pub fn level(level: D) -> Self {
        Self { level: Some(level), ..Self::none() }
    }

    /// A share by which the friction grows where it is positive, and falls where it is negative [1].
    pub fn skew(skew: D) -> Self {
        Self { skew: Some(skew), ..Self::none() }
    }

    /// By how much the level is higher [N].
    pub fn rise(rise: D) -> Self {
        Self { rise: Some(rise), ..Self::none() }
    }

    /// A force against the motion that holds at rest [N].
    pub fn dry(dry: D) -> Self {
        Self { dry: Some(dry), ..Self::none() }
    }

    /// Adds what another effect does.
    pub(crate) fn add(&mut self, other: &Self) {
        add(&mut self.force, other.force);
        add(&mut self.more, other.more);
        add(&mut self.skew, other.skew);
        add(&mut self.rise, other.rise);
        add(&mut self.level, other.level);
        add(&mut self.dry, other.dry);
    }

    /// Where no bristle has taken the rise of the level, all of the friction of level `f_c` grows by it.
    pub(crate) fn risen(&mut self, f_c: impl Fn() -> D, bristles: bool) {
        let Some(rise) = self.rise.filter(|_| !bristles) else { return };
        let f_c = f_c();
        if f_c.re() > 0.0 {
            add(&mut self.more, Some(rise / f_c));
        }
    }

    /// By what share of itself friction grows that goes the `way` [1]; none if it stays as it is.
    pub(crate) fn share(&self, way: f64) -> Option<D> {
        let mut share = self.more;
        add(&mut share, self.skew.map(|skew| skew * way));
        share
    }

    /// The friction `own` [N], which goes the `way`, with what it grows by.
    pub(crate) fn grown(&self, own: D, way: f64) -> D {
        self.share(way).map_or(own, |share| own + own * share)
    }
}

/// What the sensors show at a sample.
#[derive(Debug)]
pub struct Sense<'a, D> {
    /// Displacement [m].
    pub q: D,
    /// Velocity [m/s].
    pub v: D,
    /// How far the displacement has come since the sample before [m].
    pub moved: D,
    /// How fast the velocity changes, as a line since the sample before; at the first, until the next [m/s²].
    pub slope: D,
    /// How fast that changes, by the first three samples; 0 at all but the first [m/s³].
    pub bend: D,
    /// How fast the drive changes [N/s].
    pub rate: f64,
    /// Time since the sample before [s]; 0 at the first.
    pub dt: f64,
    /// What the effect remembers from sample to sample.
    pub memory: &'a mut D,
}

/// A load cell at a sample.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    /// 0 for the first, 1 for the second.
    pub cell: usize,
    /// Time since the record began [s].
    pub t: f64,
    /// How far the drum has drawn at this spring [m].
    pub stretch: f64,
    /// Radius of the drum [m].
    pub radius: f64,
}

/// An effect: what it says of itself, and where it takes hold. All but the first have a neutral default.
pub trait Law {
    /// What it says of itself.
    const ABOUT: About;
    /// How many states it has beside the contact's.
    const STATES: usize = 0;
    /// Whether it is friction that can hold whatever the velocity does next.
    const DRY: bool = false;

    /// Whether motor and load are two masses where its first value, the amount, is above 0. The second is then the
    /// ratio of the load's mass to the motor's, and the states are displacement and speed of the load.
    const JOINS: bool = false;
    /// The amounts at which it is tried, of their natural size, if it does not begin smoothly.
    const TRIED: &[f64] = &[];
    /// The forms that it may take, if there is more than one: values of its key `form`.
    const FORMS: &[f64] = &[];

    /// The input as it truly is where `u` was recorded.
    fn input<D: Real>(_p: &[D], u: D) -> D {
        u
    }

    /// By how much the input comes late [s].
    fn delay<D: Real>(_p: &[D]) -> Option<D> {
        None
    }

    /// The drive [N] as it truly is where the plant's equation says `force`.
    fn drive<D: Real>(_p: &[D], force: D) -> D {
        force
    }

    /// The mass [kg].
    fn mass<D: Real>(_p: &[D], mass: D) -> D {
        mass
    }

    /// What it adds to the friction; its states after a stage that began with `base` go to `z`.
    fn act<D: Real>(_p: &[D], _at: &At<D>, _base: &[D], _z: &mut [D]) -> Act<D> {
        Act::none()
    }

    /// Its state number `place` after long sliding in the direction `way`, or at rest if that is 0, with what was before;
    /// the contact slips at deflections of a `grain` [m] or more.
    fn start<D: Real>(_p: &[D], _place: usize, (_way, _grain, _past): (f64, f64, Past<'_>)) -> D {
        D::from(0.0)
    }

    /// The joint between motor and load.
    fn joint<D: Real>(_p: &[D], _at: &At<D>) -> Option<Joint<D>> {
        None
    }

    /// What the sensors show.
    fn sense<D: Real>(_p: &[D], _sense: &mut Sense<'_, D>) {}

    /// What a load cell shows [N] where the nominal spring pulls with `force`.
    fn load<D: Real>(_p: &[D], _load: &Load, force: D) -> D {
        force
    }
}

/// An effect with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Term<D> {
    /// Which one.
    pub kind: Kind,
    /// Its values, in the order of its keys.
    pub p: Vec<D>,
}

impl<D: Real> Term<D> {
    /// The same in another kind of number.
    pub fn map<E: Real>(&self, to: &dyn Fn(D) -> E) -> Term<E> {
        Term { kind: self.kind, p: self.p.iter().map(|p| to(*p)).collect() }
    }
}
