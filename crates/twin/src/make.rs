//! The record of a scenario.

use crate::{
    Hidden, PlantKind, Scenario, Sensor, TwinError,
    contact::Contact,
    driven::Driven,
    hidden::Nothing,
    imposed::Imposed,
    plant::Instant,
    planted, sensor,
    signal::{Leg, Signal},
};
use serde::{Deserialize, Serialize};

/// A record, and what it was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Header and values of each column: the time [s], then the sensors as the scenario lists them.
    pub columns: Vec<(String, Vec<f64>)>,
    /// The same columns as perfect sensors would have shown them, in the same units; what is hidden in a sensor
    /// shows here.
    pub clean: Vec<(String, Vec<f64>)>,
    /// What each column is.
    pub about: Vec<Column>,
    /// What only those who judge may read.
    pub truth: Truth,
}

/// What a column is, for the record's card.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Its header.
    pub name: String,
    /// What it holds, as the channels of a rig file call it.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Whether it was measured on the motor's shaft.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub at_motor: bool,
}

/// What the record was made from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Seed of its noise and of its random drives.
    pub seed: u64,
    /// The scenario.
    pub scenario: Scenario,
}

/// Header of the time's column.
const TIME: &str = "time_s";
/// Local error of a step, relative to the largest values of the record so far.
const TOLERANCE: f64 = 1e-9;
/// The same for a record with effects.
const PLANTED_TOLERANCE: f64 = 1e-8;

/// Makes the record of a scenario. The same seed makes the same record.
///
/// # Errors
/// A scenario that makes no sense, or a motion that cannot be followed.
pub fn make(scenario: &Scenario, seed: u64) -> Result<Made, TwinError> {
    make_hidden(scenario, seed, &Nothing, 1.0)
}

/// Makes the record of a scenario with something hidden in it, with local errors `coarser` times as large as usual:
/// the difference between two such records is the error of the coarser one.
///
/// # Errors
/// A scenario that makes no sense, or a motion that cannot be followed.
pub fn make_hidden(
    scenario: &Scenario,
    seed: u64,
    hidden: &dyn Hidden,
    coarser: f64,
) -> Result<Made, TwinError> {
    scenario.check()?;
    let truths = truths(scenario, seed, hidden, coarser)?;
    let times: Vec<f64> = (0..scenario.samples()).map(|k| k as f64 / scenario.rate).collect();
    let mut columns = vec![(TIME.to_owned(), times)];
    let mut clean = columns.clone();
    let mut about = vec![Column {
        name: TIME.to_owned(),
        quantity: "time".to_owned(),
        unit: "s".to_owned(),
        at_motor: false,
    }];
    for (sensor, truth) in scenario.sensors.iter().zip(truths) {
        let (unit, truth) = shown(&scenario.plant, sensor, truth)?;
        columns.push((sensor.column.clone(), sensor::read(sensor, &truth, seed)));
        clean.push((sensor.column.clone(), truth));
        about.push(Column {
            name: sensor.column.clone(),
            quantity: sensor.quantity.name().to_owned(),
            unit: unit.to_owned(),
            at_motor: sensor.at_motor,
        });
    }
    Ok(Made { columns, clean, about, truth: Truth { seed, scenario: scenario.clone() } })
}

/// For each sensor the true values of what it measures [SI].
fn truths(
    scenario: &Scenario,
    seed: u64,
    hidden: &dyn Hidden,
    coarser: f64,
) -> Result<Vec<Vec<f64>>, TwinError> {
    if !scenario.hidden.is_empty() || scenario.controller.is_some() {
        return planted::record(scenario, seed, hidden, PLANTED_TOLERANCE * coarser);
    }
    let signal = Signal::new(&scenario.input, scenario.duration, seed);
    let motion = motion(scenario, &signal, hidden, TOLERANCE * coarser)?;
    let plant = &scenario.plant;
    let of = |sensor: &Sensor| motion.iter().map(|now| plant.read(sensor.quantity, now)).collect();
    scenario.sensors.iter().map(of).collect()
}

/// The values before a sensor, in its unit and on its side of the gear.
fn shown(
    plant: &PlantKind,
    sensor: &Sensor,
    mut truth: Vec<f64>,
) -> Result<(&'static str, Vec<f64>), TwinError> {
    let (unit, factor) = sensor.quantity.unit(sensor.unit.as_deref(), plant.rotary())?;
    let geared = match plant {
        PlantKind::Drum { gear_ratio, .. } if sensor.at_motor => *gear_ratio,
        _ => 1.0,
    };
    for value in &mut truth {
        *value = *value * factor * geared;
    }
    Ok((unit, truth))
}

/// The plant at every sample.
fn motion(
    scenario: &Scenario,
    signal: &Signal,
    hidden: &dyn Hidden,
    tolerance: f64,
) -> Result<Vec<Instant>, TwinError> {
    let start = scenario.start;
    if let Some(balance) = scenario.plant.balance() {
        let contact = Contact::new(&scenario.friction, start.position);
        let state = (start.position, start.velocity);
        let mut plant = Driven::new(balance, contact, hidden, state, tolerance);
        return sampled(scenario, signal, |leg, (from, end)| {
            let now =
                Instant { u: leg.at(from).0, q: plant.q(), v: plant.v(), ..Instant::default() };
            plant.follow(leg, end)?;
            Ok(now)
        });
    }
    let q = signal.leg_from(0.0).at(0.0).0;
    let mut plant = Imposed::new(Contact::new(&scenario.friction, q), q, tolerance);
    let offset = scenario.plant.offset();
    sampled(scenario, signal, |leg, (from, end)| {
        let (u, v) = leg.at(from);
        let force = plant.force(v) + offset;
        let now = Instant { u, q: plant.q(), v, force, ..Instant::default() };
        plant.follow(leg, end)?;
        Ok(now)
    })
}

/// Walks from leg to leg; what `go` says at the begin of a leg is kept where that is a sample.
fn sampled<'a>(
    scenario: &Scenario,
    signal: &'a Signal,
    mut go: impl FnMut(Leg<'a>, (f64, f64)) -> Result<Instant, TwinError>,
) -> Result<Vec<Instant>, TwinError> {
    let samples = scenario.samples();
    let mut corners = signal.corners(scenario.duration, 1.0 / scenario.rate).into_iter().peekable();
    let mut motion = Vec::with_capacity(samples);
    for k in 0..samples {
        let mut from = k as f64 / scenario.rate;
        let end = if k + 1 < samples { (k + 1) as f64 / scenario.rate } else { from };
        let mut first = None;
        while let Some(corner) = corners.next_if(|corner| *corner < end) {
            let now = go(signal.leg(f64::midpoint(from, corner)), (from, corner))?;
            first = first.or(Some(now));
            from = corner;
        }
        let leg =
            if end > from { signal.leg(f64::midpoint(from, end)) } else { signal.leg_from(from) };
        let now = go(leg, (from, end))?;
        motion.push(first.unwrap_or(now));
    }
    Ok(motion)
}
