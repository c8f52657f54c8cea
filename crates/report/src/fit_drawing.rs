//! What a page shows beside curves: values of named things, one below the other, and maps.

use crate::Panel;
use crate::escape::html;
use crate::number;
use crate::plot::{Axis, Canvas, Fault, Ink, Look, Side, fit, inline, sketch, text_width};

/// How the cells of a map look: in no figure's own file, so that these stay as they are.
pub(crate) const CSS: &str = include_str!("fit_drawing.css");

/// A drawing of the page of a fit.
#[derive(Debug, Clone, PartialEq)]
pub enum FitDrawing {
    /// Values one below the other.
    Ladder(FitLadder),
    /// Maps below one another.
    Heat(FitHeat),
}

/// Values of named things on one axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitLadder {
    /// What is seen.
    pub title: String,
    /// How to read it.
    pub caption: String,
    /// What is on the axis, with unit.
    pub axis: String,
    /// Whether the axis is logarithmic.
    pub log: bool,
    /// The rungs from the top.
    pub rungs: Vec<FitRung>,
    /// A value to hold the others against.
    pub against: Option<f64>,
}

/// A value with its name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitRung {
    /// Its name.
    pub name: String,
    /// The value.
    pub value: f64,
    /// From where to where its whisker goes.
    pub whisker: Option<[f64; 2]>,
    /// Whether it is what all is about.
    pub chosen: bool,
    /// What is written behind it; may be empty.
    pub note: String,
}

/// Maps of a quantity over two others.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitHeat {
    /// What is seen.
    pub title: String,
    /// How to read it.
    pub caption: String,
    /// The horizontal axis, with unit, and where it begins and ends.
    pub x: (String, [f64; 2]),
    /// The vertical axis, with unit, and where it begins and ends.
    pub y: (String, [f64; 2]),
    /// How many columns a map has.
    pub columns: usize,
    /// The maps: each a name, and its cells row by row from the lower left.
    pub maps: Vec<(String, Vec<FitCell>)>,
}

/// A cell of a map.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitCell {
    /// What is written in it; empty where there is nothing.
    pub text: String,
    /// Its shade from −3 to 3; none where there is nothing.
    pub shade: Option<i8>,
}

/// The width of a ladder [px].
const WIDTH: f64 = 700.0;
/// The height of a rung [px].
const RUNG: f64 = 26.0;
/// The height of a heading over a ladder [px].
const HEADING: f64 = 24.0;
/// The widest name of a rung, and the widest note [px].
const NAME: f64 = 190.0;
const NOTE: f64 = 120.0;
/// A cell of a map [px].
const CELL: (f64, f64) = (40.0, 22.0);

pub(crate) fn write_drawing(out: &mut String, drawing: &FitDrawing, id: &str) {
    let (title, caption, panels) = match drawing {
        FitDrawing::Ladder(ladder) => (&ladder.title, &ladder.caption, vec![ladder.panel()]),
        FitDrawing::Heat(heat) => {
            (&heat.title, &heat.caption, heat.maps.iter().map(|map| heat.panel(map)).collect())
        }
    };
    put!(
        out,
        "<figure class=\"wide\" aria-labelledby=\"{id}\"><div class=\"panels\" role=\"region\" \
         tabindex=\"0\" aria-label=\"{}\">\n",
        html(title)
    );
    for (n, panel) in panels.iter().enumerate() {
        match panel {
            Ok(panel) => out.push_str(&inline(panel, &format!("{id}-{n}"), title)),
            Err(why) => put!(out, "<p>not drawn: {}</p>\n", html(why)),
        }
    }
    put!(
        out,
        "</div>\n<figcaption><b id=\"{id}\">{}</b> {}</figcaption></figure>\n",
        html(title),
        html(caption)
    );
}

impl FitLadder {
    fn panel(&self) -> Result<Panel, Fault> {
        self.drawn(("", &self.axis()), self.room())
    }

    /// Ladders below one another, each under its title, on one axis.
    pub(crate) fn stack(ladders: &[Self]) -> Result<Vec<Panel>, Fault> {
        let rungs = ladders.iter().flat_map(|ladder| ladder.rungs.iter().cloned()).collect();
        let all = Self { rungs, ..ladders.first().cloned().unwrap_or_default() };
        let axis = all.axis();
        ladders.iter().map(|ladder| ladder.drawn((&ladder.title, &axis), all.room())).collect()
    }

    /// Where the axis begins and ends: names stand before it, notes behind it [px].
    fn room(&self) -> [f64; 2] {
        let widest = |texts: &mut dyn Iterator<Item = &String>, most: f64| {
            texts.map(|text| text_width(text)).fold(0.0, f64::max).min(most)
        };
        // A bold name is wider than a plain one.
        let left = 1.12 * widest(&mut self.rungs.iter().map(|r| &r.name), NAME) + 12.0;
        [left, WIDTH - widest(&mut self.rungs.iter().map(|r| &r.note), NOTE) - 14.0]
    }

    fn drawn(
        &self,
        (heading, axis): (&str, &Axis),
        [left, right]: [f64; 2],
    ) -> Result<Panel, Fault> {
        let top = if heading.is_empty() { 0.0 } else { HEADING };
        let bottom = top + 8.0 + RUNG * self.rungs.len() as f64;
        let size = (WIDTH, bottom + 44.0);
        let body = sketch(size, |canvas| {
            if !heading.is_empty() {
                canvas.text(&fit(heading, WIDTH), (0.0, 11.0), Side::Right, Ink::Title)?;
            }
            self.draw(canvas, axis, [left, right, top, bottom])
        })?;
        let told = |r: &FitRung| format!("{}: {}", r.name, number::short(r.value));
        let rungs = self.rungs.iter().map(told).collect::<Vec<_>>().join("; ");
        let description = if heading.is_empty() { rungs } else { format!("{heading}: {rungs}") };
        let title = heading.to_owned();
        Ok(Panel { title, description, width: size.0, height: size.1, body })
    }

    fn axis(&self) -> Axis {
        let whiskers = self.rungs.iter().filter_map(|r| r.whisker).flatten();
        let values = self.rungs.iter().map(|r| r.value).chain(whiskers).chain(self.against);
        if self.log { Axis::decades(&self.axis, values) } else { Axis::linear(&self.axis, values) }
            .checked()
    }

    fn draw(
        &self,
        canvas: &Canvas,
        axis: &Axis,
        [left, right, top, bottom]: [f64; 4],
    ) -> Result<(), Fault> {
        let along = |value: f64| left + axis.share(value).clamp(0.0, 1.0) * (right - left);
        let mut free = f64::NEG_INFINITY;
        for (value, text) in axis.ticks(6) {
            let (x, half) = (along(value), text_width(&text) / 2.0);
            canvas.line(&[(x, top + 4.0), (x, bottom)], Ink::Grid)?;
            if x - half > free {
                canvas.text(&text, (x, bottom + 12.0), Side::Middle, Ink::Text)?;
                free = x + half + 6.0;
            }
        }
        if let Some(value) = self.against {
            canvas.line(&[(along(value), top + 4.0), (along(value), bottom)], Ink::Guide)?;
        }
        canvas.line(&[(left, top + 4.0), (left, bottom), (right, bottom)], Ink::Axis)?;
        let label = fit(&axis.label, WIDTH - 8.0);
        canvas.text(&label, (right, bottom + 32.0), Side::Left, Ink::Muted)?;
        for (n, rung) in self.rungs.iter().enumerate() {
            let y = top + 8.0 + RUNG * (n as f64 + 0.5);
            let name = fit(&rung.name, NAME);
            let ink = if rung.chosen { Ink::Title } else { Ink::Text };
            canvas.text(&name, (left - 8.0, y), Side::Left, ink)?;
            canvas.text(&fit(&rung.note, NOTE), (right + 10.0, y), Side::Right, Ink::Muted)?;
            if !rung.value.is_finite() {
                continue;
            }
            let look = if rung.chosen { Look::filled(1) } else { Look::hollow(3) };
            let ends = rung.whisker.filter(|ends| ends.iter().all(|end| end.is_finite()));
            let from = if self.log { left } else { along(0.0) };
            let [a, b] = ends.map_or([from, along(rung.value)], |ends| ends.map(along));
            canvas.line(&[(a, y), (b, y)], Ink::Line(look))?;
            if ends.is_some() {
                for x in [a, b] {
                    canvas.line(&[(x, y - 4.0), (x, y + 4.0)], Ink::Line(look))?;
                }
            }
            canvas.mark((along(rung.value), y), look)?;
        }
        Ok(())
    }
}

impl FitHeat {
    fn panel(&self, (name, cells): &(String, Vec<FitCell>)) -> Result<Panel, Fault> {
        let columns = self.columns.max(1);
        let rows = cells.len().div_ceil(columns);
        let vertical = Axis { from: self.y.1[0], to: self.y.1[1], ..Axis::default() }.checked();
        let widest = vertical.ticks(5).iter().map(|(_, t)| text_width(t)).fold(30.0, f64::max);
        let (left, top) = (widest + 12.0, if name.is_empty() { 24.0 } else { 44.0 });
        let right = left + CELL.0 * columns as f64;
        let bottom = top + CELL.1 * rows as f64;
        let size = (right + 18.0, bottom + 44.0);
        let body = sketch(size, |canvas| {
            if !name.is_empty() {
                canvas.text(&fit(name, size.0), (0.0, 11.0), Side::Right, Ink::Title)?;
            }
            let label = fit(&self.y.0, size.0);
            canvas.text(&label, (0.0, top - 13.0), Side::Right, Ink::Muted)?;
            for (n, cell) in cells.iter().enumerate() {
                let (x, y) = (
                    left + CELL.0 * (n % columns) as f64,
                    bottom - CELL.1 * (n / columns + 1) as f64,
                );
                let Some(shade) = cell.shade else { continue };
                let shade = u8::try_from(shade.clamp(-3, 3) + 3).unwrap_or(3);
                let corner = (x + CELL.0 - 0.5, y + CELL.1 - 0.5);
                canvas.block((x + 0.5, y + 0.5), corner, Ink::Signed(shade))?;
                let middle = (x + CELL.0 / 2.0, y + CELL.1 / 2.0);
                canvas.text(&fit(&cell.text, CELL.0), middle, Side::Middle, Ink::Text)?;
            }
            self.draw_axes(canvas, &vertical, [left, right, top, bottom])
        })?;
        let description = format!("{name}: {} over {} and {}", self.title, self.x.0, self.y.0);
        Ok(Panel { title: name.clone(), description, width: size.0, height: size.1, body })
    }

    fn draw_axes(
        &self,
        canvas: &Canvas,
        vertical: &Axis,
        [left, right, top, bottom]: [f64; 4],
    ) -> Result<(), Fault> {
        let across = Axis { from: self.x.1[0], to: self.x.1[1], ..Axis::default() }.checked();
        canvas.line(&[(left, top), (left, bottom), (right, bottom)], Ink::Axis)?;
        for (value, text) in across.ticks(6) {
            let x = left + across.share(value) * (right - left);
            canvas.line(&[(x, bottom), (x, bottom + 4.0)], Ink::Axis)?;
            canvas.text(&text, (x, bottom + 14.0), Side::Middle, Ink::Text)?;
        }
        for (value, text) in vertical.ticks(5) {
            let y = bottom - vertical.share(value) * (bottom - top);
            canvas.line(&[(left - 4.0, y), (left, y)], Ink::Axis)?;
            canvas.text(&text, (left - 7.0, y), Side::Left, Ink::Text)?;
        }
        canvas.text(&fit(&self.x.0, right), (right, bottom + 33.0), Side::Left, Ink::Muted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_of_a_drawing_becomes_markup_and_no_number_that_is_none_is_drawn() {
        let rung = |name: &str, value| FitRung {
            name: name.to_owned(),
            value,
            whisker: Some([f64::NAN, value]),
            chosen: true,
            note: "<b>".to_owned(),
        };
        let ladder = FitLadder {
            title: "<script>".to_owned(),
            rungs: vec![rung("<i>", f64::NAN), rung("b", 2.0), rung("c", f64::INFINITY)],
            against: Some(f64::NAN),
            ..FitLadder::default()
        };
        let cells = vec![FitCell { text: "<u>".to_owned(), shade: Some(9) }, FitCell::default()];
        let heat = FitHeat {
            title: "</figure>".to_owned(),
            columns: 2,
            x: ("<x>".to_owned(), [0.0, 0.0]),
            y: ("y".to_owned(), [f64::NAN, 1.0]),
            maps: vec![("<m>".to_owned(), cells)],
            ..FitHeat::default()
        };
        for log in [false, true] {
            let mut out = String::new();
            let ladder = FitLadder { log, ..ladder.clone() };
            write_drawing(&mut out, &FitDrawing::Ladder(ladder), "a");
            write_drawing(&mut out, &FitDrawing::Heat(heat.clone()), "b");
            for bad in ["<script", "<i>", "<b>", "<u>", "<m>", "<x>", "NaN", "inf"] {
                assert!(!out.contains(bad), "{bad:?} in {out}");
            }
            assert!(out.contains("&lt;m&gt;") && out.contains("class=\"v6\""), "{out}");
        }
    }
}
