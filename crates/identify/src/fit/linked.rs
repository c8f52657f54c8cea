//! How the errors of an imposed displacement follow from each other.

use super::{colour::Colour, data::Band, displacement::REST};

/// How the error of a sample follows from those of the two before it, and what of it is new, each in its standard deviation [1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    /// The share of each of these.
    pub(super) by: [f64; 2],
    /// What is new.
    pub(super) new: f64,
}

impl Link {
    /// One of its own.
    pub(super) const OWN: Self = Self { by: [0.0; 2], new: 1.0 };
    /// That of the sample before.
    pub(super) const SAME: Self = Self { by: [1.0, 0.0], new: 0.0 };

    /// One that has this correlation with that of the sample before.
    fn after(correlation: f64) -> Self {
        Self { by: [correlation, 0.0], new: (1.0 - correlation * correlation).sqrt() }
    }
}

/// The standard deviation of every sample of the displacement `u` [m], each sample having so much `noise` but for what its `band`
/// took away, and how its error follows from those before it.
pub(super) fn errors(u: &[f64], (noise, band): (f64, Option<&Band>)) -> (Vec<f64>, Vec<Link>) {
    let (mut own, mut links) = (vec![noise; u.len()], vec![Link::OWN; u.len()]);
    if let Some(band) = band {
        let colour = Colour::within(band, noise);
        let [all, next] = [0, 1].map(|apart| colour.together(apart));
        let size = all.sqrt();
        let inside = |i: Option<usize>| i.is_some_and(|i| band.inside[i]);
        for i in (0..u.len()).filter(|i| band.inside[*i]) {
            own[i] = size;
            links[i] = match (inside(i.checked_sub(1)), inside(i.checked_sub(2))) {
                (false, _) => Link::OWN,
                (true, false) => Link::after(next / all),
                (true, true) => Link { by: colour.by, new: colour.new / size },
            };
        }
    }
    let mut first = 0;
    for rest in u.chunk_by(|a, b| a == b) {
        let end = first + rest.len();
        if rest.len() >= REST {
            own[first..end].fill(noise / (rest.len() as f64).sqrt());
            links[first..end].fill(Link::SAME);
            links[first] = Link::OWN;
        }
        first = end;
    }
    (own, links)
}

#[cfg(test)]
mod tests {
    use super::{Band, Link, errors};

    #[test]
    fn errors_in_a_band_are_as_large_as_what_is_left_there() {
        // White noise of 1 µm of which a tenth of all frequencies is left, from sample 100 to 900.
        let inside: Vec<bool> = (0..1000).map(|i| (100..900).contains(&i)).collect();
        let band = Band { edge: 0.1 * std::f64::consts::PI, inside };
        // It rests from sample 240 on.
        let u: Vec<f64> =
            (0..1000).map(|i| f64::from(i) - f64::from((i - 240).clamp(0, 100))).collect();
        let (own, links) = errors(&u, (1e-6, Some(&band)));
        let rests = |i: usize| links[i] == Link::SAME || links[i + 1] == Link::SAME;
        for i in (0..999).filter(|i| !rests(*i)) {
            let share =
                if band.inside[i] { own[i].powi(2) / 1e-13 } else { own[i].powi(2) / 1e-12 };
            assert!((share - 1.0).abs() < 0.2, "{share} at {i}");
        }
        // Their covariances are those of a stationary sequence wherever it begins.
        let mut ahead = [[1.0, 0.0], [0.0, 0.0]];
        for link in &links[100..140] {
            let [a, b] = link.by;
            let own = a * a * ahead[0][0] + b * b * ahead[1][1] + 2.0 * a * b * ahead[0][1];
            let both = a * ahead[0][0] + b * ahead[0][1];
            ahead = [[own + link.new * link.new, both], [both, ahead[0][0]]];
            assert!((ahead[0][0] - 1.0).abs() < 1e-9, "{}", ahead[0][0]);
        }
    }
}
