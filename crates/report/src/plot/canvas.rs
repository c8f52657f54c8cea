//! Drawing through plotters, and its SVG turned into ours: tenths of a pixel instead of whole ones,
//! classes instead of colours, real superscripts, one short element per thing drawn.

use super::ink::{Ink, Look, Shape, classes};
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, IntoFont, TextStyle};
use std::fmt::Write;

/// Units of the backend in one pixel: plotters' coordinates are whole numbers.
pub(crate) const UNITS: f64 = 10.0;
/// The size of plain text [px].
pub(crate) const TEXT: f64 = 13.0;
/// Half the size of a mark [px].
pub(crate) const MARK: f64 = 3.2;

/// What plotters says when it cannot draw.
pub(crate) type Fault = String;

/// On which side of its place a text stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// The text begins there.
    Right,
    /// The text is centred there.
    Middle,
    /// The text ends there.
    Left,
}

/// A sheet to draw on, in pixels from its upper left corner.
pub(crate) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Draws a picture of this size and gives the inside of its `<svg>`.
pub(crate) fn sketch(
    (width, height): (f64, f64),
    draw: impl FnOnce(&Canvas) -> Result<(), Fault>,
) -> Result<String, Fault> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (whole(width), whole(height)));
        let canvas = Canvas { area: area.into_drawing_area() };
        draw(&canvas)?;
        canvas.area.present().map_err(|e| e.to_string())?;
    }
    Ok(ours(&svg))
}

fn whole(pixels: f64) -> u32 {
    u32::try_from(units(pixels)).unwrap_or(0)
}

/// Pixels in the backend's units.
#[expect(clippy::cast_possible_truncation, reason = "clamped to what fits")]
pub(crate) fn units(pixels: f64) -> i32 {
    (pixels * UNITS).round().clamp(-1e7, 1e7) as i32
}

fn place((x, y): (f64, f64)) -> (i32, i32) {
    (units(x), units(y))
}

impl Canvas<'_> {
    /// A line through these places.
    pub(crate) fn line(&self, places: &[(f64, f64)], ink: Ink) -> Result<(), Fault> {
        let path: Vec<_> = places.iter().copied().map(place).collect();
        self.area.draw(&PathElement::new(path, ink.colour().filled())).map_err(|e| e.to_string())
    }

    /// A filled rectangle between two corners.
    pub(crate) fn block(&self, a: (f64, f64), b: (f64, f64), ink: Ink) -> Result<(), Fault> {
        let block = Rectangle::new([place(a), place(b)], ink.colour().filled());
        self.area.draw(&block).map_err(|e| e.to_string())
    }

    /// One line of text, its middle at the height of the place.
    pub(crate) fn text(
        &self,
        text: &str,
        at: (f64, f64),
        side: Side,
        ink: Ink,
    ) -> Result<(), Fault> {
        let h_pos = match side {
            Side::Right => HPos::Left,
            Side::Middle => HPos::Center,
            Side::Left => HPos::Right,
        };
        self.write(text, at, (h_pos, FontTransform::None), ink)
    }

    /// One line of text that begins at the place and runs upwards, its middle above it.
    pub(crate) fn text_up(&self, text: &str, at: (f64, f64), ink: Ink) -> Result<(), Fault> {
        self.write(text, at, (HPos::Left, FontTransform::Rotate270), ink)
    }

    fn write(
        &self,
        text: &str,
        at: (f64, f64),
        (h_pos, turn): (HPos, FontTransform),
        ink: Ink,
    ) -> Result<(), Fault> {
        let colour = ink.colour();
        let style = TextStyle::from(("sans-serif", TEXT).into_font().transform(turn))
            .color(&colour)
            .pos(Pos::new(h_pos, VPos::Center));
        let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        self.area.draw(&Text::new(line, place(at), style)).map_err(|e| e.to_string())
    }

    /// The mark of a series.
    pub(crate) fn mark(&self, (x, y): (f64, f64), look: Look) -> Result<(), Fault> {
        let ink = if look.hollow { Ink::Hollow(look) } else { Ink::Fill(look) };
        let corners: &[(f64, f64)] = match look.shape {
            Shape::Circle => {
                let circle = Circle::new(place((x, y)), units(MARK), ink.colour().filled());
                return self.area.draw(&circle).map_err(|e| e.to_string());
            }
            Shape::Square => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
            Shape::Triangle => &[(0.0, -1.25), (1.15, 0.85), (-1.15, 0.85)],
            Shape::Down => &[(0.0, 1.25), (1.15, -0.85), (-1.15, -0.85)],
            Shape::Diamond => &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
            Shape::Star => &[
                (0.0, -2.1),
                (0.55, -0.55),
                (2.1, 0.0),
                (0.55, 0.55),
                (0.0, 2.1),
                (-0.55, 0.55),
                (-2.1, 0.0),
                (-0.55, -0.55),
            ],
        };
        let corners: Vec<_> =
            corners.iter().map(|(dx, dy)| place((x + dx * MARK, y + dy * MARK))).collect();
        let polygon = Polygon::new(corners, ink.colour().filled());
        self.area.draw(&polygon).map_err(|e| e.to_string())
    }
}

/// plotters' SVG in our words; of its outer element only the inside.
fn ours(svg: &str) -> String {
    let mut out = String::new();
    let mut lines = svg.lines();
    while let Some(line) = lines.next() {
        let class = classes(colour(attribute(line, "stroke"), attribute(line, "fill")));
        let points = attribute(line, "points").unwrap_or("");
        // Writing to a string has no way to fail.
        let _ = match line.split([' ', '>']).next().unwrap_or("") {
            "<polyline" => writeln!(out, "<path class=\"{class}\" d=\"{}\"/>", path(points)),
            "<polygon" => writeln!(out, "<path class=\"{class}\" d=\"{}z\"/>", path(points)),
            "<circle" => {
                let [x, y, r] = ["cx", "cy", "r"].map(|name| pixels(attribute(line, name)));
                writeln!(out, "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\"/>")
            }
            "<rect" => {
                let [x, y, w, h] =
                    ["x", "y", "width", "height"].map(|name| pixels(attribute(line, name)));
                writeln!(
                    out,
                    "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>"
                )
            }
            "<text" => {
                let [x, y] = ["x", "y"].map(|name| pixels(attribute(line, name)));
                let anchor = match attribute(line, "text-anchor") {
                    Some("start") | None => String::new(),
                    Some(anchor) => format!(" text-anchor=\"{anchor}\""),
                };
                // plotters turns text about its place, in its own units.
                let up = attribute(line, "transform").is_some_and(|t| t.starts_with("rotate(270"));
                let turn =
                    if up { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
                let text = raised(lines.next().unwrap_or(""));
                writeln!(
                    out,
                    "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" dy=\".35em\"{anchor}{turn}>{text}</text>"
                )
            }
            _ => Ok(()),
        };
    }
    out
}

/// The value of an attribute; quotes inside values are escaped by the writer.
fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let start = line.find(&format!(" {name}=\""))? + name.len() + 3;
    line[start..].split('"').next()
}

/// The colour of the line, or else of the inside, as the three numbers of an ink.
fn colour(stroke: Option<&str>, fill: Option<&str>) -> (u8, u8, u8) {
    let hex = [stroke, fill].into_iter().flatten().find_map(|text| text.strip_prefix('#'));
    let part = |i: usize| {
        hex.and_then(|h| h.get(i..i + 2)).and_then(|h| u8::from_str_radix(h, 16).ok()).unwrap_or(0)
    };
    (part(0), part(2), part(4))
}

/// Units as pixels, in as few letters as it takes.
fn pixels(units: Option<&str>) -> String {
    let units: i32 = units.and_then(|text| text.parse().ok()).unwrap_or(0);
    tenths(units)
}

fn tenths(units: i32) -> String {
    let sign = if units < 0 { "-" } else { "" };
    match (units.abs() / 10, units.abs() % 10) {
        (whole, 0) => format!("{sign}{whole}"),
        (0, tenth) => format!("{sign}.{tenth}"),
        (whole, tenth) => format!("{sign}{whole}.{tenth}"),
    }
}

/// `x,y x,y …` as the data of a path: one absolute place, then steps.
fn path(points: &str) -> String {
    let mut out = String::new();
    let mut last: Option<(i32, i32)> = None;
    for pair in points.split_whitespace() {
        let Some((x, y)) = pair.split_once(',') else { continue };
        let (Ok(x), Ok(y)) = (x.parse::<i32>(), y.parse::<i32>()) else { continue };
        let (dx, dy) = last.map_or((x, y), |(a, b)| (x - a, y - b));
        let (dx, dy) = (tenths(dx), tenths(dy));
        out.push_str(match last {
            None => "M",
            Some(_) if out.contains('l') => {
                if dx.starts_with('-') {
                    ""
                } else {
                    " "
                }
            }
            Some(_) => "l",
        });
        out.push_str(&dx);
        if !dy.starts_with('-') {
            out.push(' ');
        }
        out.push_str(&dy);
        last = Some((x, y));
    }
    out
}

/// Superscript and subscript characters as raised and lowered text: fonts draw the characters unevenly.
fn raised(text: &str) -> String {
    let level = |c: char| match c {
        '⁰' | '¹' | '²' | '³' | '⁴'..='⁹' | '⁻' => -1,
        '₀'..='₉' => 1,
        _ => 0,
    };
    let plain = |c: char| match c {
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁻' => '−',
        '⁴'..='⁹' => {
            char::from_u32(u32::from(c) - u32::from('⁴') + u32::from('4')).unwrap_or(c)
        }
        '₀'..='₉' => {
            char::from_u32(u32::from(c) - u32::from('₀') + u32::from('0')).unwrap_or(c)
        }
        _ => c,
    };
    let (mut out, mut now) = (String::new(), 0);
    for c in text.chars() {
        let next = level(c);
        if next != now {
            out.push_str(if out.contains("<tspan") { "</tspan>" } else { "" });
            // A shift holds for all that follows, so the way back is a shift too.
            out.push_str(match (now, next) {
                (_, -1) => "<tspan dy=\"-.5em\" font-size=\"9.5\">",
                (_, 1) => "<tspan dy=\".25em\" font-size=\"9.5\">",
                (-1, _) => "<tspan dy=\".365em\">",
                _ => "<tspan dy=\"-.183em\">",
            });
            now = next;
        }
        out.push(plain(c));
    }
    out.push_str(if out.contains("<tspan") { "</tspan>" } else { "" });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_raised_and_the_text_comes_back_to_its_line() {
        assert_eq!(
            raised("10⁻² N"),
            "10<tspan dy=\"-.5em\" font-size=\"9.5\">−2</tspan><tspan dy=\".365em\"> N</tspan>"
        );
        assert_eq!(raised("plain"), "plain");
    }

    #[test]
    fn coordinates_are_in_tenths_of_a_pixel_and_short() {
        assert_eq!(path("105,200 107,195 100,195"), "M10.5 20l.2-.5-.7 0");
        let svg = sketch((20.0, 10.0), |c| c.line(&[(0.25, 1.0), (2.0, 1.0)], Ink::Axis));
        assert_eq!(svg.unwrap(), "<path class=\"ax\" d=\"M.3 1l1.7 0\"/>\n");
    }
}
