//! Everything that is printed goes through here.

use std::{
    io::{ErrorKind, Write, stdout},
    sync::atomic::{AtomicBool, Ordering},
};

/// Set when a result could not be written; the program then ends as for a full disk.
static LOST: AtomicBool = AtomicBool::new(false);

/// A line of results, on standard output. A reader that went away (`| head`) is no error.
pub(crate) fn line(text: &str) {
    let mut out = stdout().lock();
    if let Err(e) = writeln!(out, "{text}").and_then(|()| out.flush())
        && e.kind() != ErrorKind::BrokenPipe
        && !LOST.swap(true, Ordering::Relaxed)
    {
        error(&format!("cannot write to standard output: {e}"));
    }
}

/// Whether a result could not be written.
pub(crate) fn lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

/// A line about the run, on standard error.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// An error, on standard error.
pub(crate) fn error(text: &str) {
    note(&format!("error: {text}"));
}
