//! The theme: how everything that is drawn looks.

/// One drawn panel: a picture of its own.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Panel {
    /// Its title; empty if the figure has only one.
    pub title: String,
    /// What is in it, for a reader who cannot see it.
    pub description: String,
    /// Its width [px].
    pub width: u32,
    /// Its height [px].
    pub height: u32,
    /// The inside of its `<svg>`.
    pub body: String,
}
