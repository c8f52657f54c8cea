//! The amounts at which what does not begin smoothly is tried, and which of them are begun with.

use crate::board::Ahead;
use identify::{
    Rig,
    effects::{Kind, Measure},
};

/// The amounts at which what does not begin smoothly is tried, of its natural size, the least first: a play also at what the
/// record itself has `shown`.
pub(super) fn amounts(kind: Kind, shown: Option<f64>) -> Vec<f64> {
    let mut all = kind.tried().to_vec();
    let is_play = kind.about().keys[0].measure == Measure::Length;
    let within = |wide: &f64| all[0] < *wide && *wide < all[all.len() - 1];
    if let Some(wide) = shown.filter(|_| is_play).filter(within) {
        all.insert(all.partition_point(|tried| *tried < wide), wide);
    }
    all
}

/// Of `all` that was tried, in the amounts of each shape one after another, what is nearer than the amounts beside it, in
/// the order of `all`. Beside the least amount is none, of which the model `alone` is as far.
pub(super) fn dips(
    rigs: &[(Kind, Rig)],
    (alone, all): (f64, &[Ahead]),
    many: impl Fn(Kind) -> usize,
) -> Vec<Ahead> {
    let mut far = vec![f64::INFINITY; rigs.len()];
    for a in all {
        far[a.place] = a.far;
    }
    let mut dip = vec![false; rigs.len()];
    let mut from = 0;
    while let Some((kind, _)) = rigs.get(from) {
        let end = from + many(*kind).max(1);
        for i in from..end {
            let less = if i == from { alone } else { far[i - 1] };
            dip[i] = far[i] < less && (i + 1 == end || far[i] < far[i + 1]);
        }
        from = end;
    }
    all.iter().filter(|a| dip[a.place]).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::{amounts, dips};
    use crate::{board::Ahead, walk::made};
    use identify::effects::Kind;

    #[test]
    fn a_play_is_tried_as_wide_as_the_record_shows_it() {
        let own = Kind::Backlash.tried().len();
        let all = amounts(Kind::Backlash, Some(0.011));
        assert!(all.len() == own + 1 && all.is_sorted() && all.contains(&0.011));
        for (kind, shown) in
            [(Kind::Backlash, 1.0), (Kind::Backlash, 0.0), (Kind::Compliance, 0.011)]
        {
            assert_eq!(amounts(kind, Some(shown)), kind.tried());
        }
        assert_eq!(amounts(Kind::Backlash, None), Kind::Backlash.tried());
    }

    #[test]
    fn of_each_shape_the_amounts_nearer_than_those_beside_them_are_begun_with() {
        let kind = Kind::Backlash;
        let many = kind.tried().len();
        let rigs = vec![(kind, made::rig(2.0)); 2 * many];
        // The first shape has dips at its fourth, to which it falls over two amounts, and at its last; the second has one
        // at its fifth, and perhaps one beside its sixth, which could not be simulated.
        let mut far: Vec<f64> = (0..2 * many).map(|i| 3.0 + 0.01 * (i % many) as f64).collect();
        for (place, left) in [(2, 2.4), (3, 2.0), (many - 1, 2.5), (many + 4, 1.0)] {
            far[place] = left;
        }
        let ahead = |place: usize| Ahead { far: far[place], kind, place, rig: made::rig(2.0) };
        let mut all: Vec<Ahead> = (0..2 * many).filter(|i| *i != many + 5).map(ahead).collect();
        all.sort_by(|a, b| a.far.total_cmp(&b.far));
        let places = |alone: f64| -> Vec<usize> {
            dips(&rigs, (alone, &all), |_| many).iter().map(|a| a.place).collect()
        };
        assert_eq!(places(2.9), [many + 4, 3, many - 1, many + 6]);
        // Without it the model is farther than with the least amount of either shape, nearer than the one above it.
        assert_eq!(places(3.1), [many + 4, 3, many - 1, 0, many, many + 6]);
        assert!(dips(&[], (3.0, &[]), |_| many).is_empty());
    }
}
