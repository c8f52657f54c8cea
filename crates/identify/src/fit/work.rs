//! How much has been simulated.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

/// A step that carries so many derivatives takes about as long as one that looks for its velocity.
const DERIVATIVES: usize = 6;

/// A count of the integrator's steps. Its clones count together, so that a search over many problems can be ended by what it
/// has simulated, which is the same on every machine, and not by the time that it took.
#[derive(Debug, Clone, Default)]
pub struct Work(Arc<AtomicU64>);

impl Work {
    /// Counts so many steps more.
    pub(super) fn add(&self, steps: usize) {
        self.0.fetch_add(steps as u64, Ordering::Relaxed);
    }

    /// Counts so many steps that carry so many derivatives each.
    pub(super) fn add_with(&self, steps: usize, derivatives: usize) {
        self.add(steps * derivatives / DERIVATIVES);
    }

    /// So many steps of the integrator, or what took as long.
    pub fn steps(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::Work;

    #[test]
    fn clones_count_together() {
        let work = Work::default();
        work.clone().add(3);
        work.add_with(5, 12);
        assert_eq!(work.steps(), 13);
    }
}
