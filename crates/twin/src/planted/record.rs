//! What sensors would show of a plant with effects, sample by sample.

use super::{Placed, Planted, follow::Followed};
use crate::{
    Controller, Hidden, HiddenEffect, PlantKind, Quantity, Scenario, TwinError,
    hidden::Effect,
    plant::Instant,
    sensor::Reader,
    signal::{Leg, Signal, count},
};

/// For each sensor of a scenario what a perfect one would show, in SI units, with what its effects make of it.
pub(crate) fn record(
    scenario: &Scenario,
    seed: u64,
    hidden: &dyn Hidden,
    tolerance: f64,
) -> Result<Vec<Vec<f64>>, TwinError> {
    let mut nature = scenario.clone();
    let effects: Vec<&dyn Effect> = scenario.hidden.iter().map(HiddenEffect::effect).collect();
    for effect in &effects {
        effect.rewrite(&mut nature);
    }
    let plant = Planted::new(&nature, effects, hidden)?;
    let signal = Signal::new(&scenario.input, scenario.duration, seed);
    let start = (scenario.start.position, scenario.start.velocity);
    if let Some(controller) = scenario.controller {
        let plant = Followed::new(plant, Leg::Held(0.0), start, tolerance);
        return controlled(scenario, seed, controller, (plant, &signal));
    }
    let first = Leg::Held(signal.leg_from(0.0).at(0.0).0);
    let leg = if plant.delay() > 0.0 { first } else { signal.leg_from(0.0) };
    let delay = plant.delay();
    let mut plant = Followed::new(plant, leg, start, tolerance);
    let late = |inside: f64| if inside < delay { first } else { signal.leg(inside - delay) };
    let mut shown = vec![Vec::new(); scenario.sensors.len()];
    let mut corners = late_corners(scenario, &signal, delay).into_iter().peekable();
    for k in 0..scenario.samples() {
        let mut from = k as f64 / scenario.rate;
        let now = Instant { u: signal.leg_from(from).at(from).0, ..Instant::default() };
        // At a sample the leg that begins there is in force.
        plant.plant.leg = late(from + 1e-7);
        plant.show(scenario, from, now, &mut shown)?;
        let end = (k + 1) as f64 / scenario.rate;
        if k + 1 == scenario.samples() {
            break;
        }
        while let Some(corner) = corners.next_if(|corner| *corner < end) {
            plant.follow(late(f64::midpoint(from, corner)), corner)?;
            from = corner;
        }
        plant.follow(late(f64::midpoint(from, end)), end)?;
    }
    Ok(shown)
}

/// The corners of a late input that lie between samples.
fn late_corners(scenario: &Scenario, signal: &Signal, delay: f64) -> Vec<f64> {
    let (duration, sample) = (scenario.duration, 1.0 / scenario.rate);
    if delay == 0.0 {
        return signal.corners(duration, sample);
    }
    // With a sample time that is longer than the record, no corner counts as a sample.
    let mut times = signal.corners(duration, 1e12);
    times.insert(0, 0.0);
    for t in &mut times {
        *t += delay;
    }
    times.retain(|t| *t < duration && ((t / sample).round() * sample - t).abs() > 1e-9);
    times
}

/// A controlled axis: at each sample the controller reads, and its command is held until the next.
fn controlled(
    scenario: &Scenario,
    seed: u64,
    Controller::Pd { kp, kv, limit }: Controller,
    (mut plant, reference): (Followed<'_>, &Signal),
) -> Result<Vec<Vec<f64>>, TwinError> {
    let added =
        scenario.added_input.as_ref().map(|input| Signal::new(input, scenario.duration, !seed));
    let at = |signal: &Signal, t: f64| signal.leg_from(t).at(t).0;
    let eye = scenario.sensors.iter().find(|sensor| sensor.quantity == Quantity::Position);
    let unit = eye.map_or(Ok(1.0), |s| Ok(s.quantity.unit(s.unit.as_deref(), false)?.1))?;
    let mut reader = eye.map(|sensor| Reader::new(sensor, seed));
    let mut shown = vec![Vec::new(); scenario.sensors.len()];
    let sample = 1.0 / scenario.rate;
    let (whole, rest) = late(plant.plant.delay(), sample);
    let mut commands: Vec<f64> = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for k in 0..scenario.samples() {
        let t = k as f64 / scenario.rate;
        let seen = plant.seen(Quantity::Position, t, &Instant::default())? * unit;
        let q = reader.as_mut().map_or(seen, |reader| reader.read(seen)) / unit;
        let (last, mean) = before.unwrap_or((q, q));
        let speed = (f64::midpoint(q, last) - mean) * scenario.rate;
        before = Some((q, f64::midpoint(q, last)));
        let wanted = at(reference, t);
        let more = added.as_ref().map_or(0.0, |signal| at(signal, t));
        let u = (kv * (kp * (wanted - q) - speed)).clamp(-limit, limit) + more;
        commands.push(u);
        let now = Instant { u, reference: wanted, added: more, ..Instant::default() };
        let told = |back: usize| commands[k.saturating_sub(whole + back)];
        plant.plant.leg = Leg::Held(told(usize::from(rest > 0.0)));
        plant.show(scenario, t, now, &mut shown)?;
        if k + 1 == scenario.samples() {
            break;
        }
        if rest > 0.0 {
            plant.follow(Leg::Held(told(1)), t + rest)?;
        }
        plant.follow(Leg::Held(told(0)), (k + 1) as f64 / scenario.rate)?;
    }
    Ok(shown)
}

/// A delay in whole samples, and what is left of it [s].
fn late(delay: f64, sample: f64) -> (usize, f64) {
    let whole = count(delay / sample + 1e-9);
    let rest = delay - whole as f64 * sample;
    (whole, if rest > 1e-9 { rest } else { 0.0 })
}

impl Followed<'_> {
    /// Notes what every sensor is shown at t.
    fn show(
        &self,
        scenario: &Scenario,
        t: f64,
        now: Instant,
        shown: &mut [Vec<f64>],
    ) -> Result<(), TwinError> {
        for (sensor, shown) in scenario.sensors.iter().zip(shown) {
            shown.push(self.seen(sensor.quantity, t, &now)?);
        }
        Ok(())
    }

    /// What a sensor of a quantity is shown at t [SI].
    fn seen(&self, quantity: Quantity, t: f64, now: &Instant) -> Result<f64, TwinError> {
        let plant = &self.plant;
        let look = plant.look(t, &self.y);
        let force =
            look.rubbing + look.drag + if plant.balance.is_none() { look.back } else { 0.0 };
        let at = Instant { q: look.now.load_q, v: look.now.v, force, ..*now };
        let truth = match (quantity, plant.plant) {
            (Quantity::Force1, PlantKind::Drum { .. }) => plant.springs(at.q)[0],
            (Quantity::Force2, PlantKind::Drum { .. }) => plant.springs(at.q)[1],
            _ => plant.plant.read(quantity, &at)?,
        };
        let sense = |value: f64, placed: &Placed<'_>| {
            placed.effect.sense(quantity, &look.now, placed.own(&self.y), value)
        };
        Ok(plant.effects.iter().fold(truth, sense))
    }
}
