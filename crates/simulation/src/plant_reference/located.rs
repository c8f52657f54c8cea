//! A driven plant by our own stiff method, every reversal located.

use crate::{DrivenPlant, Motion, Path};
use integrate::{
    Dynamics, Failure, Integration, Limits, Node, Outcome, Settings, System, Work, radau,
};

/// Largest number of states our stiff method is compiled for: ten Maxwell-slip elements on a plant.
const MOST: usize = 12;

/// Evaluations a motion may take: ten times those of Figures 13 and 14 at the tolerance of the references.
const LIMITS: Limits = Limits { evaluations: 20_000_000 };

/// A driven plant solved by Radau IIA, with every reversal of v at the end of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// The motion; every node where v changes sign has v = 0.
    pub path: Path,
    /// What it took.
    pub work: Work,
    /// How it ended.
    pub outcome: Outcome,
}

/// Solves `motion` from `y0` with the relative tolerance `rtol`; the absolute ones are `rtol` times the
/// natural sizes, [`Dynamics::scale`].
pub fn solve_located(motion: &DrivenPlant, y0: &[f64], rtol: f64) -> Located {
    match y0.len() {
        2 => run::<2>(motion, y0, rtol),
        3 => run::<3>(motion, y0, rtol),
        4 => run::<4>(motion, y0, rtol),
        5 => run::<5>(motion, y0, rtol),
        6 => run::<6>(motion, y0, rtol),
        7 => run::<7>(motion, y0, rtol),
        8 => run::<8>(motion, y0, rtol),
        9 => run::<9>(motion, y0, rtol),
        10 => run::<10>(motion, y0, rtol),
        11 => run::<11>(motion, y0, rtol),
        MOST => run::<MOST>(motion, y0, rtol),
        n => refused(n, format!("expected 2 to {MOST} states, found {n}")),
    }
}

fn refused(n: usize, words: String) -> Located {
    let outcome = Outcome::Failed { at: 0.0, why: Failure::Stopped(words) };
    Located { path: Path::new(n), work: Work::default(), outcome }
}

fn run<const N: usize>(motion: &DrivenPlant, y0: &[f64], rtol: f64) -> Located {
    let scale = motion.scale();
    let (Ok(mut y), Ok(scale)) = (<[f64; N]>::try_from(y0), <[f64; N]>::try_from(scale)) else {
        return refused(y0.len(), format!("expected {} states", motion.dimension()));
    };
    let atol = scale.map(|scale| rtol * scale);
    let settings = Settings { rtol, atol, dead_band: atol[1], limits: LIMITS };
    let (start, end) = motion.span();
    let times = [&[start], motion.corners(), &[end]].concat();
    let mut located = Located {
        path: Path::new(N),
        work: Work { rejected: Some(0), ..Work::default() },
        outcome: Outcome::Solved,
    };
    for piece in times.windows(2) {
        let path = &mut located.path;
        let from = y;
        let mut observe = |node: &Node<N>| {
            path.push(node.t, &node.y, &node.y_dot);
            y = node.y;
        };
        let span = (piece[0], piece[1]);
        let Integration { work, outcome, .. } =
            radau(&mut Contact { motion }, span, from, &settings, &mut observe);
        located.work += &work;
        if outcome != Outcome::Solved {
            located.outcome = outcome;
            break;
        }
    }
    located
}

/// The plant as our stiff method takes it: its event is the reversal of v.
struct Contact<'a> {
    motion: &'a DrivenPlant,
}

impl<const N: usize> System<N> for Contact<'_> {
    fn derivative(&mut self, t: f64, y: &[f64; N]) -> [f64; N] {
        let mut y_dot = [0.0; N];
        self.motion.derivative(t, y, None, &mut y_dot);
        y_dot
    }

    /// At v = 0 that of the side the motion goes to.
    fn jacobian(&mut self, t: f64, y: &[f64; N]) -> [[f64; N]; N] {
        let mut y = *y;
        if y[1] == 0.0 {
            let y_dot = self.derivative(t, &y);
            y[1] = f64::MIN_POSITIVE * duhem::sgn(y_dot[1]);
        }
        let mut jacobian = [[0.0; N]; N];
        self.motion.jacobian(t, &y, None, jacobian.as_flattened_mut());
        jacobian
    }

    fn event(&self, _t: f64, y: &[f64; N]) -> f64 {
        y[1]
    }

    fn land(&self, y: &mut [f64; N]) {
        y[1] = 0.0;
    }
}
