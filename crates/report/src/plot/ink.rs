//! What things are drawn with. A colour of ours is not a colour but the name of a class:
//! what it looks like, on white and on dark, is said once, in [`CSS`].

use plotters::style::RGBColor;

/// How the classes look; in the page once, and in every figure's own file.
pub(crate) const CSS: &str = include_str!("figure.css");

/// The mark at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Shape {
    Circle,
    Square,
    Triangle,
    Down,
    Diamond,
    Star,
}

/// How one series looks wherever it is drawn: colour, dash and mark together tell it from every other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Look {
    /// 1 to 4; 5 for the methods of our own that are given the task.
    pub(crate) colour: u8,
    /// 0 to 5, 0 being a solid line.
    pub(crate) dash: u8,
    /// The mark.
    pub(crate) shape: Shape,
    /// Whether the mark is hollow.
    pub(crate) hollow: bool,
}

const fn look(colour: u8, dash: u8, shape: Shape, hollow: bool) -> Look {
    Look { colour, dash, shape, hollow }
}

/// The colour of what is given the task.
const OURS: u8 = 5;

/// The solvers by name: solid is our own (implicit ones hollow), long dashes `ode_solvers`, short ones `diffsol`.
/// Behind them, in a colour of their own, what is given the task: a star is exact.
const SOLVERS: &[(&str, Look)] = &[
    ("explicit-euler", look(1, 0, Shape::Circle, false)),
    ("heun", look(2, 0, Shape::Square, false)),
    ("rk4", look(3, 0, Shape::Triangle, false)),
    ("implicit-euler", look(1, 0, Shape::Diamond, true)),
    ("implicit-midpoint", look(2, 0, Shape::Circle, true)),
    ("trapezoidal", look(4, 0, Shape::Square, true)),
    ("ode_solvers-rk4", look(3, 1, Shape::Down, true)),
    ("dopri5", look(1, 1, Shape::Square, false)),
    ("dop853", look(2, 1, Shape::Triangle, false)),
    ("dop853-autonomous", look(4, 1, Shape::Diamond, false)),
    ("bdf", look(1, 2, Shape::Triangle, true)),
    ("tr_bdf2", look(2, 2, Shape::Diamond, true)),
    ("esdirk34", look(3, 2, Shape::Circle, true)),
    ("tsit45", look(4, 2, Shape::Down, false)),
    ("exact-dahl", look(OURS, 0, Shape::Star, false)),
    ("exact-lugre", look(OURS, 1, Shape::Star, false)),
    ("exact-maxwell-slip", look(OURS, 2, Shape::Star, false)),
    ("exact-semilinear", look(OURS, 0, Shape::Star, true)),
    ("exact-slip-plant", look(OURS, 3, Shape::Star, false)),
    ("dahl-series", look(OURS, 0, Shape::Diamond, false)),
    ("lugre-linear", look(OURS, 0, Shape::Down, false)),
    ("radau-located", look(OURS, 0, Shape::Triangle, true)),
];

const SHAPES: [Shape; 5] =
    [Shape::Circle, Shape::Square, Shape::Triangle, Shape::Down, Shape::Diamond];

impl Look {
    /// The look of a solver: of the list, or, for one not in it, always the same by its name.
    pub(crate) fn of_solver(name: &str) -> Self {
        if let Some((_, look)) = SOLVERS.iter().find(|(known, _)| *known == name) {
            return *look;
        }
        let hash = name.bytes().fold(17_usize, |h, b| (h * 31 + usize::from(b)) % 9973);
        Self::nth(hash)
    }

    /// The look of the `n`-th of some curves.
    pub(crate) fn nth(n: usize) -> Self {
        let small = |value: usize| u8::try_from(value).unwrap_or(0);
        look(small(n % 4) + 1, small(n % 6), SHAPES[n % 5], n / 5 % 2 == 1)
    }

    /// A solid line of this colour with a filled circle.
    pub(crate) const fn filled(colour: u8) -> Self {
        look(colour, 0, Shape::Circle, false)
    }

    /// A solid line of this colour with a hollow diamond, which a filled circle does not hide.
    pub(crate) const fn hollow(colour: u8) -> Self {
        look(colour, 0, Shape::Diamond, true)
    }

    /// Whether the list of solvers has this name.
    pub(crate) fn is_solver(name: &str) -> bool {
        SOLVERS.iter().any(|(known, _)| *known == name)
    }
}

/// Where a solver stands among others: the list's order, then the alphabet.
pub(crate) fn rank(solver: &str) -> (usize, &str) {
    (SOLVERS.iter().position(|(known, _)| *known == solver).unwrap_or(SOLVERS.len()), solver)
}

/// What a line, an area or a text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ink {
    /// A shaded stripe.
    Band,
    /// A grid line.
    Grid,
    /// An axis and its ticks.
    Axis,
    /// A reference: a slope, a limit.
    Guide,
    /// A line of another panel.
    Ghost,
    /// A letter in the lane.
    Letter(Look),
    /// A tick that is looked for.
    Tick,
    /// From a label to its line's end.
    Leader,
    /// Plain text.
    Text,
    /// Text that steps back.
    Muted,
    /// A panel's title.
    Title,
    /// A series' line.
    Line(Look),
    /// The inside of a filled mark.
    Fill(Look),
    /// A hollow mark.
    Hollow(Look),
    /// Text in a series' colour.
    Label(Look),
    /// A cell of a map, 0 for the best to 3.
    Shade(u8),
    /// A cell of a map of what has a sign: 0 for the most negative to 6, 3 for none.
    Signed(u8),
}

impl Ink {
    /// The class, as the colour plotters carries for us.
    pub(crate) fn colour(self) -> RGBColor {
        let (role, colour, dash) = match self {
            Self::Band => (1, 0, 0),
            Self::Grid => (2, 0, 0),
            Self::Axis => (3, 0, 0),
            Self::Guide => (4, 0, 0),
            Self::Leader => (5, 0, 0),
            Self::Text => (6, 0, 0),
            Self::Muted => (7, 0, 0),
            Self::Title => (8, 0, 0),
            Self::Line(look) => (9, look.colour, look.dash),
            Self::Fill(look) => (10, look.colour, 0),
            Self::Hollow(look) => (11, look.colour, 0),
            Self::Tick => (0, 0, 0),
            Self::Ghost => (13, 0, 0),
            Self::Letter(look) => (14, look.colour, 0),
            Self::Label(look) => (12, look.colour, 0),
            Self::Shade(shade) => (15 + shade.min(3), 0, 0),
            Self::Signed(shade) => (19 + shade.min(6), 0, 0),
        };
        RGBColor(role, colour, dash)
    }
}

/// The classes a colour of [`Ink::colour`] stands for.
pub(crate) fn classes((role, colour, dash): (u8, u8, u8)) -> String {
    const ROLES: [&str; 26] = [
        "mk", "bn", "gr", "ax", "gu", "ld", "tx", "mu", "ti", "l", "f", "o", "t", "gh", "t lt",
        "h0", "h1", "h2", "h3", "v0", "v1", "v2", "v3", "v4", "v5", "v6",
    ];
    let role = ROLES.get(usize::from(role)).copied().unwrap_or("tx");
    match (colour, dash) {
        (0, _) => role.to_owned(),
        (_, 0) => format!("{role} c{colour}"),
        _ => format!("{role} c{colour} d{dash}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_two_solvers_look_alike_even_without_colour() {
        let seen: BTreeSet<_> = SOLVERS.iter().map(|(_, l)| (l.dash, l.shape, l.hollow)).collect();
        assert_eq!(seen.len(), SOLVERS.len());
        assert_eq!(Look::of_solver("a new one"), Look::of_solver("a new one"));
    }

    #[test]
    fn twelve_curves_have_twelve_looks() {
        let seen: BTreeSet<_> = (0..12).map(|n| (Look::nth(n).colour, Look::nth(n).dash)).collect();
        assert_eq!(seen.len(), 12);
    }
}
