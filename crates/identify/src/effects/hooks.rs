//! Where an effect takes hold.

use super::{About, Kind, joint::Joint};
use crate::march::{Balance, Contact, Real, Shown};

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

/// What an effect adds to the friction F of the model.
#[derive(Debug, Clone, Copy)]
pub enum Act<D> {
    /// Nothing.
    None,
    /// A force beside it [N], smooth in the velocity.
    Force(D),
    /// F grows by this share of itself [1].
    More(D),
    /// F grows by this share of itself where it is positive, and falls where it is negative [1].
    Skew(D),
    /// As [`Act::More`], of F and of all viscous friction [1].
    MoreOfAll(D),
    /// As [`Act::Skew`], of F and of all viscous friction [1].
    SkewOfAll(D),
    /// Viscous friction beside that of the model [N].
    Drag(D),
    /// The level at which the contact slips is higher by so much [N]: bristles slip at a larger deflection, what has
    /// none grows as a whole.
    Rise(D),
    /// The level at which the contact slips grows by this share of itself, and its stiffness stays [1].
    Level(D),
    /// A force against the motion that holds at rest [N].
    Dry(D),
}

/// What all effects together add to it, each as [`Act`] has it. With zeros in place of what is not there a motion took
/// a quarter longer, and its derivatives half as long again.
#[derive(Debug, Clone, Copy)]
pub struct Acts<D> {
    /// Of all [`Act::Force`] [N].
    pub force: Option<D>,
    /// Of all [`Act::More`] [1].
    pub more: Option<D>,
    /// Of all [`Act::Skew`] [1].
    pub skew: Option<D>,
    /// Of all [`Act::Rise`] [N].
    pub rise: Option<D>,
    /// Of all [`Act::Level`] [1].
    pub level: Option<D>,
    /// Of all [`Act::Dry`] [N].
    pub dry: Option<D>,
    /// Of all [`Act::Drag`] [N].
    pub drag: Option<D>,
    /// By what share viscous friction grows in both directions, and by what share as it goes forward [1].
    pub thicker: [Option<D>; 2],
}

/// Adds to what may be there.
fn add<D: Real>(sum: &mut Option<D>, more: D) {
    if let Some(sum) = sum {
        *sum += more;
    } else {
        *sum = Some(more);
    }
}

impl<D: Real> Acts<D> {
    /// None at all.
    pub fn none() -> Self {
        Self {
            force: None,
            more: None,
            skew: None,
            rise: None,
            level: None,
            dry: None,
            drag: None,
            thicker: [None; 2],
        }
    }

    /// Adds what an effect does.
    pub(crate) fn add(&mut self, act: Act<D>) {
        match act {
            Act::None => {}
            Act::Force(force) => add(&mut self.force, force),
            Act::More(more) => add(&mut self.more, more),
            Act::Skew(skew) => add(&mut self.skew, skew),
            Act::MoreOfAll(more) => {
                add(&mut self.more, more);
                add(&mut self.thicker[0], more);
            }
            Act::SkewOfAll(skew) => {
                add(&mut self.skew, skew);
                add(&mut self.thicker[1], skew);
            }
            Act::Drag(drag) => add(&mut self.drag, drag),
            Act::Rise(rise) => add(&mut self.rise, rise),
            Act::Level(level) => add(&mut self.level, level),
            Act::Dry(dry) => add(&mut self.dry, dry),
        }
    }

    /// Where no bristle has taken the rise of the level, all of the friction of level `f_c` grows by it.
    pub(crate) fn risen(&mut self, f_c: impl Fn() -> D, bristles: bool) {
        let Some(rise) = self.rise.filter(|_| !bristles) else { return };
        let f_c = f_c();
        if f_c.re() > 0.0 {
            add(&mut self.more, rise / f_c);
        }
    }

    /// By what share of itself friction grows that goes the `way` [1]; none if it stays as it is.
    pub(crate) fn share(&self, way: f64) -> Option<D> {
        let mut share = self.more;
        if let Some(skew) = self.skew {
            add(&mut share, skew * way);
        }
        share
    }

    /// What viscous friction there is at the velocity `v` [m/s] beside the model's of `sigma_2` [N·s/m], and by how much all of
    /// it is more than it would be [N].
    pub(crate) fn viscous(&self, sigma_2: D, v: D) -> Option<D> {
        let [mut share, skew] = self.thicker;
        if let Some(skew) = skew {
            add(&mut share, if v.re() < 0.0 { -skew } else { skew });
        }
        let Some(share) = share else { return self.drag };
        let own = sigma_2 * v;
        Some(match self.drag {
            Some(drag) => (own + drag) * share + drag,
            None => own * share,
        })
    }

    /// The friction `own` [N], which goes the `way`, with what it grows by.
    pub(crate) fn grown(&self, own: D, way: f64) -> D {
        self.share(way).map_or(own, |share| own + own * share)
    }
}

/// What the sensors show at a sample.
#[derive(Debug)]
pub struct Sense<D> {
    /// Displacement [m].
    pub q: D,
    /// Velocity [m/s].
    pub v: D,
    /// By how much the velocity was more in the mean since the sample before than along a line: it follows a jump of the
    /// drive at once, or late; 0 at the first [m/s].
    pub bulge: D,
    /// How fast the velocity changes, as a line since the sample before; at the first, until the next [m/s²].
    pub slope: D,
    /// How fast that changes, by the first three samples; 0 at all but the first [m/s³].
    pub bend: D,
    /// How fast the drive changes [N/s].
    pub rate: f64,
    /// Time since the sample before [s]; 0 at the first.
    pub dt: f64,
    /// What the velocity sensor was seen to show there, if it is the first and that was looked at.
    pub shown: Option<Shown>,
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

    /// Turns the input `u` as it was recorded into the true one.
    fn input<D: Real>(_p: &[D], _u: &mut D) {}

    /// By how much the input comes late [s].
    fn delay<D: Real>(_p: &[D]) -> Option<D> {
        None
    }

    /// Turns the drive `force` [N] of the plant's equation into the true one.
    fn drive<D: Real>(_p: &[D], _force: &mut D) {}

    /// Turns the `mass` [kg] of the plant's equation into the true one.
    fn mass<D: Real>(_p: &[D], _mass: &mut D) {}

    /// What it adds to the friction; its states after a stage that began with `base` go to `z`.
    fn act<D: Real>(_p: &[D], _at: &At<D>, _base: &[D], _z: &mut [D]) -> Act<D> {
        Act::None
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

    /// What the sensors show; `memory` is what the effect remembers from sample to sample.
    fn sense<D: Real>(_p: &[D], _sense: &mut Sense<D>, _memory: &mut D) {}

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
