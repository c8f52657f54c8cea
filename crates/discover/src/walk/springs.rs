//! More springs that slip, where one was found and does not do.

use super::{ABOVE, FIRST, Walk, forms::spared, polish::lacking, settled};
use crate::{
    board::Fitted,
    gram::{self, Gram},
};
use identify::{
    Rig,
    effects::Kind,
    fit::{FitError, binding},
};
use nalgebra::{DMatrix, DVector};

/// The effect, and its springs beyond the first.
const NAME: &str = "maxwell_slip";
const MORE: [usize; 3] = [2, 3, 4];

/// A further spring slips so many times as late as the first, and as hard.
const LATER: [f64; 4] = [0.1, 0.3, 3.0, 10.0];
const HARD: f64 = 0.3;

/// It must lower the level to so much of what it was; where more than so many floors are left, a spring that does little
/// alone may be the one that makes room for the next: of Dahl's friction in the place of four springs the third took a
/// fourteenth of 37 floors, and the fourth came down to the floor.
const LOWER: f64 = 0.9;
const FAR: f64 = 3.0;
const LITTLE_LOWER: f64 = 0.97;

/// Springs that slip at so many deadbands, each so many times the one before, the last of half the way, are tried all at once.
const PLACES: i32 = 7;
const WIDER: f64 = 2.5;
const WEAK: f64 = 0.1;

impl Walk<'_> {
    /// Gives springs that slip more of them, one after another; where that does not do, from those of many that pull when all
    /// are there at once, beside the given values: each of them alone is a minimum that one after another does not leave.
    pub(super) fn all_springs(&mut self, span: f64, seed: u64) -> Result<(), FitError> {
        self.more_springs(seed)?;
        let level = |walk: &Self| walk.judged(&walk.best.blocks).level();
        let now = level(self);
        if !self.springs_miss() {
            return Ok(());
        }
        let given = self.board.judged(&lacking(&self.beside_given()?.rig, NAME), None)?;
        let Some(rig) = as_one(&given.rig, self.pulling(&given, span)?) else { return Ok(()) };
        let before = (self.board.clone(), self.best.clone());
        let fitted = self.ended(self.board.fit(&rig, None, &FIRST)?)?;
        self.best = settled(&mut self.board, fitted, seed)?;
        self.more_springs(seed)?;
        if level(self) > LOWER * now {
            (self.board, self.best) = before;
        }
        Ok(())
    }

    /// Those of many springs beside a model that pull, in one step of Gauss and Newton's method.
    fn pulling(&self, beside: &Fitted, span: f64) -> Result<Vec<Spring>, FitError> {
        let places: Vec<f64> = (0..PLACES).map(|i| 0.5 * span * WIDER.powi(-i)).collect();
        let mut rig = beside.held();
        for (number, delta) in (1..).zip(&places) {
            gram::with(&mut rig, Kind::MaxwellSlip, &[*delta], number);
        }
        let all = Gram::beside(&self.board, beside, &[rig])?;
        let Some(all) = all.first() else { return Ok(Vec::new()) };
        let step = not_negative(&all.held(true, |k| self.board.trains[k]), all.nominal);
        let stiff = step.iter().zip(&all.probes[0].sizes).map(|(step, size)| step * size);
        Ok(stiff.zip(places).map(<[f64; 2]>::from).filter(|[k, _]| *k > 0.0).collect())
    }

    /// Whether springs that slip were found and leave something.
    fn springs_miss(&self) -> bool {
        let found = self.best.rig.effects.iter().any(|effect| effect.name == NAME);
        found && self.judged(&self.best.blocks).level() >= ABOVE
    }

    /// Gives springs that slip one more, and then another, for as long as the model comes much nearer with it.
    fn more_springs(&mut self, seed: u64) -> Result<(), FitError> {
        for number in MORE {
            let level = |walk: &Self| walk.judged(&walk.best.blocks).level();
            let now = level(self);
            let rig = &self.best.rig;
            if rig.free.contains(&format!("{NAME}.share_{number}")) {
                continue;
            }
            if !self.springs_miss() {
                break;
            }
            let lower = now * if now > FAR { LITTLE_LOWER } else { LOWER };
            let all = LATER.map(|later| with(rig, number, later));
            let fitted = all.iter().filter_map(|rig| self.board.fit(rig, None, &FIRST).ok());
            let near = |fitted: &Fitted| self.judged(&fitted.blocks).level();
            let Some(best) = fitted.min_by(|a, b| near(a).total_cmp(&near(b))) else { break };
            if near(&best) > lower {
                break;
            }
            let before = (self.board.clone(), self.best.clone());
            self.best = settled(&mut self.board, best, seed)?;
            if level(self) > lower {
                (self.board, self.best) = before;
                break;
            }
        }
        Ok(())
    }
}

/// The numbers after the first `free` ones of those that make xᵀHx + 2gᵀx least and are not negative; `all` is H and, as its
/// last column, g (Lawson and Hanson, Solving Least Squares Problems, SIAM 1995, chapter 23).
fn not_negative(all: &DMatrix<f64>, free: usize) -> Vec<f64> {
    let n = all.ncols() - 1;
    let mut x = DVector::zeros(n);
    let mut taken: Vec<usize> = (0..free).collect();
    let solved = |taken: &[usize]| {
        let rows = all.select_rows(taken);
        let solved = rows.select_columns(taken).cholesky()?.solve(&-rows.column(n));
        let mut all = DVector::zeros(n);
        taken.iter().zip(solved.iter()).for_each(|(i, x)| all[*i] = *x);
        Some(all)
    };
    // Each is taken once at most: a last digit must not take it again and again.
    for _ in free..n {
        let slope = all.view((0, 0), (n, n)) * &x + all.column(n).rows(0, n);
        let scaled = |i: usize| slope[i] / all[(i, i)].sqrt();
        let next = (free..n).filter(|i| !taken.contains(i) && slope[*i] < 0.0);
        let Some(next) = next.min_by(|a, b| scaled(*a).total_cmp(&scaled(*b))) else { break };
        taken.push(next);
        while let Some(to) = solved(&taken) {
            let negative = taken.iter().copied().filter(|i| *i >= free && to[*i] <= 0.0);
            let far = |i: usize| x[i] / (x[i] - to[i]);
            let first = negative.min_by(|a, b| far(*a).total_cmp(&far(*b)));
            let share = first.map_or(1.0, far);
            x += (to - &x) * share;
            let Some(first) = first else { break };
            x[first] = 0.0;
            taken.retain(|i| *i != first);
        }
    }
    x.rows(free, n - free).iter().copied().collect()
}

/// Stiffness and deadband [N/m, m].
type Spring = [f64; 2];

/// `rig` with these springs as one effect, the strongest first, all of it free: where there are too many, neighbours are one. None
/// without any.
fn as_one(rig: &Rig, mut springs: Vec<Spring>) -> Option<Rig> {
    springs.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let all: f64 = springs.iter().map(|[k, delta]| k * delta).sum();
    springs.retain(|[k, delta]| k * delta > WEAK * all);
    while springs.len() > 1 + MORE.len() {
        let force = |pair: &[Spring]| pair.iter().map(|[k, delta]| k * delta).sum::<f64>();
        let pairs = springs.windows(2).map(force).enumerate();
        let least = pairs.min_by(|a, b| a.1.total_cmp(&b.1))?.0;
        let [[k, delta], [other, wider]] = [springs[least], springs[least + 1]];
        springs[least] = [k + other, (k * delta + other * wider) / (k + other)];
        springs.remove(least + 1);
    }
    springs.sort_by(|a, b| (b[0] * b[1]).total_cmp(&(a[0] * a[1])));
    let [stiffness, delta] = *springs.first()?;
    let mut with = rig.clone();
    gram::with(&mut with, Kind::MaxwellSlip, &[delta], 0);
    binding::set(&mut with, &format!("{NAME}.k"), stiffness);
    with.free.push(format!("{NAME}.delta"));
    let mut spares: Vec<(String, f64)> = Vec::new();
    for ([k, delta], number) in springs[1..].iter().zip(MORE) {
        spares.extend(spring(number, [k / stiffness, *delta]));
    }
    Some(spared(&with, &spares))
}

/// `rig` with a spring more, which slips `later` than the first.
fn with(rig: &Rig, number: usize, later: f64) -> Rig {
    let delta = rig.value(&format!("{NAME}.delta")).unwrap_or(1.0);
    spared(rig, &spring(number, [HARD / later, delta * later]))
}

/// The values of a further spring: its share of the first one's stiffness and its deadband [1, m].
fn spring(number: usize, values: [f64; 2]) -> [(String, f64); 2] {
    let [share, delta] = ["share", "delta"].map(|key| format!("{NAME}.{key}_{number}"));
    [(share, values[0]), (delta, values[1])]
}

#[cfg(test)]
mod tests {
    use super::{as_one, not_negative, with};
    use crate::walk::made;
    use identify::effects::Kind;
    use nalgebra::DMatrix;

    #[test]
    fn the_least_without_negative_numbers_has_no_slope_that_helps() {
        // (x − 1)² + (x + y − 4)² + (y + z + 1)² + z²
        let rows = [
            [1.0, 0.0, 0.0, -1.0],
            [1.0, 1.0, 0.0, -4.0],
            [0.0, 1.0, 1.0, 1.0],
            [0.0, 0.0, 1.0, 0.0],
        ];
        let rows = DMatrix::from_fn(4, 4, |i, j| rows[i][j]);
        let all = rows.transpose() * &rows;
        // z would be negative; without it 2x + y = 5 and x + 2y = 3.
        let near = |found: &[f64], told: &[f64]| {
            found.iter().zip(told).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        let found = not_negative(&all, 1);
        assert!(near(&found, &[1.0 / 3.0, 0.0]) && found[1] == 0.0, "{found:?}");
        let found = not_negative(&all, 0);
        assert!(near(&found, &[7.0 / 3.0, 1.0 / 3.0, 0.0]) && found[2] == 0.0, "{found:?}");
    }

    #[test]
    fn of_many_springs_those_pull_that_are_there() {
        // Springs of 2 N/m to 0.05 m and 0.5 N/m to 0.4 m beside what the model has, on a way of 2 m.
        let springs = [[2.0, 0.05], [0.5, 0.4]];
        let mut last = [0.0_f64; 2];
        let mut z = [0.0; 2];
        let data = made::taken_in_turn(|x, _| {
            let mut force = 0.0;
            for i in 0..2 {
                z[i] = f64::clamp(z[i] + x - last[i], -springs[i][1], springs[i][1]);
                last[i] = x;
                force += springs[i][0] * z[i];
            }
            force
        });
        let walk = made::walk(&made::rig(2.0), &data, &[]);
        let found = walk.pulling(&walk.best, 2.0).unwrap();
        let whole: f64 = found.iter().map(|[k, delta]| k * delta).sum();
        assert!((whole / 0.3 - 1.0).abs() < 0.1, "{whole} N of 0.3 N: {found:?}");
        let near = |at: f64| {
            let own = found.iter().filter(|[_, delta]| (0.5..2.0).contains(&(delta / at)));
            own.map(|[k, delta]| k * delta).sum::<f64>()
        };
        assert!((near(0.05) - 0.1).abs() < 0.02 && (near(0.4) - 0.2).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn too_many_springs_are_joined_and_weak_ones_left() {
        let springs =
            vec![[1.2, 1.0], [2.0, 0.9], [4.0, 0.5], [31.0, 0.1], [50.0, 0.05], [1.0, 1e-3]];
        let rig = as_one(&made::rig(2.0), springs).unwrap();
        let value = |key: &str| rig.value(&format!("maxwell_slip.{key}")).unwrap();
        assert_eq!((value("k"), value("delta")), (31.0, 0.1));
        let others =
            [2, 3, 4].map(|i| (31.0 * value(&format!("share_{i}")), value(&format!("delta_{i}"))));
        // Those at 1.0 and 0.9 are one of 3 N; that of 1 mN is none.
        for (k, delta) in [(3.2, 3.0 / 3.2), (50.0, 0.05), (4.0, 0.5)] {
            let near = |own: &(f64, f64)| (own.0 - k).abs() < 1e-9 && (own.1 - delta).abs() < 1e-9;
            assert!(others.iter().any(near), "{k} N/m to {delta} m: {others:?}");
        }
        assert_eq!(rig.free.iter().filter(|free| free.starts_with("maxwell_slip.")).count(), 8);
        assert!(as_one(&made::rig(2.0), Vec::new()).is_none());
    }

    #[test]
    fn a_further_spring_is_free_and_slips_later_or_earlier_than_the_first() {
        let mut rig = made::rig(2.0);
        rig.effects.push(identify::Effect {
            name: "maxwell_slip".to_owned(),
            values: Kind::MaxwellSlip
                .about()
                .keys
                .iter()
                .map(|k| (k.name.to_owned(), k.usual.unwrap_or(0.5)))
                .collect(),
        });
        let with = with(&rig, 2, 3.0);
        assert_eq!(with.value("maxwell_slip.delta_2"), Some(1.5));
        // It breaks at 0.3 of the first one's force.
        assert_eq!(with.value("maxwell_slip.share_2"), Some(super::HARD / 3.0));
        let free = ["maxwell_slip.share_2", "maxwell_slip.delta_2"].map(str::to_owned);
        assert!(
            free.iter().all(|name| with.free.contains(name))
                && rig.free.len() + 2 == with.free.len()
        );
    }
}
