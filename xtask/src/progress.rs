//! How far a run is, with the time left, on a terminal only.

use experiment::Progress;
use std::{
    io::{IsTerminal, Write, stderr},
    sync::Mutex,
    time::{Duration, Instant},
};

/// A line on the terminal that is written again as cases finish.
#[derive(Debug)]
pub(crate) struct Line {
    name: String,
    state: Option<Mutex<State>>,
}

#[derive(Debug)]
struct State {
    start: Instant,
    drawn: Option<Instant>,
}

#[expect(
    clippy::disallowed_methods,
    reason = "the progress line is the one place that tells the time"
)]
fn now() -> Instant {
    Instant::now()
}

impl Line {
    /// A line for this experiment; silent where standard error is no terminal.
    pub(crate) fn new(name: &str) -> Self {
        let state = stderr().is_terminal().then(|| Mutex::new(State { start: now(), drawn: None }));
        Self { name: name.to_owned(), state }
    }

    /// Draws, at most ten times a second.
    pub(crate) fn tell(&self, progress: Progress) {
        let Some(state) = &self.state else { return };
        let Ok(mut state) = state.lock() else { return };
        let now = now();
        if state.drawn.is_some_and(|last| now - last < Duration::from_millis(100)) {
            return;
        }
        state.drawn = Some(now);
        let Progress { done, reused, total } = progress;
        let ran = done - reused;
        // Reused cases cost nothing and would make the rest look cheap.
        let left = if ran > 0 {
            let each = (now - state.start).as_secs_f64() / ran as f64;
            format!("{:.0} s left", each * (total - done) as f64)
        } else {
            "…".to_owned()
        };
        let _ = write!(
            stderr().lock(),
            "\r\x1b[K{}: {done}/{total} cases, {reused} reused, {left}",
            self.name
        );
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        if self.state.is_some() {
            let _ = write!(stderr().lock(), "\r\x1b[K");
        }
    }
}
