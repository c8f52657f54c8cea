//! How a record is cut: into windows that are simulated apart, for training and for judging.

use super::{data::Data, window::Window};

/// The length of a block [s] that design and discovery have.
const BLOCK: f64 = 3.0;

/// At least so many blocks, however short the record.
const LEAST: usize = 8;

/// All samples as one window.
pub fn whole(data: &Data) -> Vec<Window> {
    vec![Window::new(data, 0, data.time.len())]
}

/// Windows of `length` [s], or of 3 s, or an eighth of the record if that is less.
pub fn blocks(data: &Data, length: Option<f64>) -> Vec<Window> {
    let n = data.time.len();
    let duration = data.time[n - 1] - data.time[0];
    let length = length.unwrap_or_else(|| BLOCK.min(duration / LEAST as f64));
    let count = ((duration / length).round()).max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below n")]
    let cut = |k: usize| ((n as f64) * k as f64 / count).round() as usize;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below n")]
    let count = (count as usize).clamp(1, n / 4 + 1);
    (0..count)
        .map(|k| (cut(k).min(n), cut(k + 1).min(n)))
        .filter(|(first, end)| end > first)
        .map(|(first, end)| Window::new(data, first, end))
        .collect()
}

/// Half of the windows for training, the others for judging.
///
/// Not every second one: a drive whose period is two windows would show its way up in one half and its way
/// down in the other. The parity of a window's number in binary has no period.
pub fn split(windows: &[Window]) -> (Vec<Window>, Vec<Window>) {
    let half = |odd: bool| {
        let mine = |k: &usize| (k.count_ones() % 2 == 1) == odd;
        (0..windows.len()).filter(mine).map(|k| windows[k].clone()).collect()
    };
    (half(false), half(true))
}
