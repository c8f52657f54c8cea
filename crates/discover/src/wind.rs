//! By how much a motor gets ahead of its load, read off a record that shows both.

use identify::fit::Data;
use nalgebra::{Matrix3, Vector3};

/// By how much the motor is further ahead of the displacement in the one direction than in the other [m]: the range between the
/// quartiles of the integral of the velocity less the displacement. What drifts, and what a wrong gain of the tachometer
/// makes, is taken out. A play that is used up on either side most of the time shows its width; `None` where the record does
/// not show both.
pub(crate) fn wind(data: &Data) -> Option<f64> {
    let (velocity, seen) = (data.velocity.as_ref()?, data.displacement.as_ref()?);
    let mut moved = vec![0.0];
    for (v, t) in velocity.values.windows(2).zip(data.time.windows(2)) {
        moved.push(moved[moved.len() - 1] + 0.5 * (v[0] + v[1]) * (t[1] - t[0]));
    }
    let ahead: Vec<f64> = moved.iter().zip(&seen.values).map(|(m, q)| m - q).collect();
    let mut left = without(&ahead, [&data.time, &seen.values])?;
    left.sort_by(f64::total_cmp);
    let quartile = |share: usize| left[share * (left.len() - 1) / 4];
    Some(quartile(3) - quartile(1))
}

/// `values` less their mean and what goes along with `others`.
fn without(values: &[f64], others: [&[f64]; 2]) -> Option<Vec<f64>> {
    let rows = || others[0].iter().zip(others[1]).map(|(a, b)| Vector3::new(1.0, *a, *b));
    let normal: Matrix3<f64> = rows().map(|row| row * row.transpose()).sum();
    let right: Vector3<f64> = rows().zip(values).map(|(row, v)| row * *v).sum();
    let along = normal.cholesky()?.solve(&right);
    Some(values.iter().zip(rows()).map(|(v, row)| v - row.dot(&along)).collect())
}

#[cfg(test)]
mod tests {
    use super::wind;
    use identify::{
        Hold,
        fit::{Data, Seen},
    };

    const GAP: f64 = 0.02;

    /// A load on an angle of two tones, its motor half the play ahead of it, as far as it is through it.
    fn data() -> Data {
        let time: Vec<f64> = (0..12_000).map(|i| 0.005 * f64::from(i)).collect();
        let angle = |t: f64| (2.0 * t).sin() + 0.4 * (5.3 * t).sin();
        let rate = |t: f64| 2.0 * (2.0 * t).cos() + 2.12 * (5.3 * t).cos();
        let ahead = |t: f64| 0.5 * GAP * (rate(t) / 0.05).tanh();
        let speed = |t: f64| 1.01 * (rate(t) + (ahead(t + 1e-5) - ahead(t - 1e-5)) / 2e-5) + 1e-3;
        let seen = time.iter().map(|t| angle(*t)).collect();
        let velocity = time.iter().map(|t| speed(*t)).collect();
        let input = vec![0.0; time.len()];
        let mut data = Data::driven(time, input, Hold::Smooth, Seen::new("angle", seen, 0.0));
        data.velocity = Some(Seen::new("velocity", velocity, 0.0));
        data
    }

    #[test]
    fn a_play_is_read_off_whatever_the_tachometer_drifts() {
        let wide = wind(&data()).unwrap();
        assert!((wide - GAP).abs() < 0.05 * GAP, "{wide}");
    }

    #[test]
    fn without_the_motors_velocity_nothing_is_read_off() {
        let mut data = data();
        data.velocity = None;
        assert!(wind(&data).is_none());
    }
}
