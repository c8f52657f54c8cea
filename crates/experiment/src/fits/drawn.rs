//! The curves of a fit or a search: what was recorded, and what the rig does as given and as it was found.

use super::{Motions, Runs, Which};
use crate::{curves::Series, spec::PanelSpec};

/// The largest number of samples that is drawn of a curve.
const MOST: usize = 1000;

/// The curves of one panel.
pub(crate) fn series(runs: &Runs<'_>, panel: &PanelSpec) -> Result<Series, String> {
    let time = &runs.recording.time;
    let range = match panel.between {
        Some(between) => Motions::within(time, between),
        None => 0..time.len(),
    };
    let stride = range.len().div_ceil(MOST).max(1);
    let pick = |x: &[f64], y: &[f64]| {
        range.clone().step_by(stride).filter_map(|i| Some((*x.get(i)?, *y.get(i)?))).collect()
    };
    let channel = |name: &str| runs.recording.channels.get(name).map_or(&[][..], Vec::as_slice);
    if panel.show == "loads-time" {
        let of = |name: &str, label: &str| (label.to_owned(), pick(time, channel(name)));
        return Ok(vec![of("force_1", "F_1"), of("force_2", "F_2")]);
    }
    if panel.show == "input-time" {
        return Ok(vec![(runs.label(Which::Record).to_owned(), pick(time, &runs.data.input))]);
    }
    let record = ["record".to_owned()];
    let names = if panel.of.is_empty() { &record[..] } else { &panel.of[..] };
    let mut series = Series::new();
    for name in names {
        let which = Which::of(name)?;
        let mut motion = Motions::of(runs, which, 1.0)?;
        if panel.centred {
            let middle = middle(&motion.q[range.clone()]);
            motion.q.iter_mut().for_each(|q| *q -= middle);
            motion.drive.iter_mut().for_each(|t| *t -= motion.constant);
        }
        let gear = runs.given.value("gear_ratio").unwrap_or(1.0);
        let motor: Vec<f64> = motion.v.iter().map(|v| gear * v).collect();
        let points = match panel.show.as_str() {
            "displacement-drive" => pick(&motion.drive, &motion.q),
            "drive-time" => pick(time, &motion.drive),
            "velocity-time" => pick(time, &motion.v),
            "motor-speed-time" => pick(time, &motor),
            _ => pick(time, &motion.q),
        };
        series.push((runs.label(which).to_owned(), points));
    }
    Ok(series)
}

/// The middle between the smallest and the largest value.
pub(crate) fn middle(values: &[f64]) -> f64 {
    let [low, high] = ends(values);
    0.5 * (low + high)
}

/// The smallest and the largest value.
pub(crate) fn ends(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)])
}
