//! Many parameter sets of one problem at once.

use crate::{Delivered, NotHere, Own, Solves, Task, adaptive::ADAPTIVE, exact::EXACT};
use integrate::{Failure, Limits, Outcome};

/// What is asked of every run of an ensemble.
#[derive(Debug, Clone, Copy)]
pub struct Ensemble<'a> {
    /// Relative tolerance, as [`Solves::deliver`] takes it.
    pub rtol: f64,
    /// Where to stop each run.
    pub limits: Limits,
    /// The times at which the states are wanted, rising within the span of every task [s].
    pub grid: &'a [f64],
    /// On how many threads.
    pub threads: usize,
}

/// The first exact method that holds for a task, or else the first adaptive one of ours.
pub fn best(task: &Task) -> Result<(&'static Own, Box<dyn Solves>), NotHere> {
    let mut last = NotHere {
        method: "none of ours",
        found: task.model.name.to_owned(),
        expected: "a task for one of them",
    };
    for own in EXACT.iter().chain(ADAPTIVE) {
        match (own.build)(task) {
            Ok(ready) => return Ok((own, ready)),
            Err(why) => last = why,
        }
    }
    Err(last)
}

impl Ensemble<'_> {
    /// Solves every task by the best of our methods and tells of each, in order: why none holds, or how its
    /// run went and what `look` makes of the states, n for each time of the grid.
    ///
    /// A run says of itself how it ended, and what it says is looked at: one that ends with a state that is
    /// not a number has not been solved.
    ///
    /// # Errors
    /// In words, if the threads cannot be started.
    pub fn run<R: Send>(
        &self,
        tasks: &[Task],
        look: impl Fn(usize, &[f64]) -> R + Sync + Send,
    ) -> Result<Vec<Result<(Delivered, R), NotHere>>, String> {
        integrate::ensemble(self.threads, tasks.len(), Vec::new, |states: &mut Vec<f64>, i| {
            let task = &tasks[i];
            let (_, ready) = best(task)?;
            states.resize(task.y0.len() * self.grid.len(), f64::NAN);
            let mut delivered = ready.deliver(self.rtol, &self.limits, self.grid, states);
            let first_lost = states.iter().position(|y| !y.is_finite());
            if let (Outcome::Solved, Some(place)) = (&delivered.outcome, first_lost) {
                let at = self.grid[place / task.y0.len()];
                delivered.outcome = Outcome::Failed { at, why: Failure::NotFinite };
            }
            Ok((delivered, look(i, states)))
        })
    }
}
