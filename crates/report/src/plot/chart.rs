//! A panel with two axes, lines with their names at their ends, and a lane for what failed.

use super::axis::Axis;
use super::canvas::{Canvas, Fault, Side, UNITS, sketch, units};
use super::ink::{Ink, Look};
use super::labels::{self, spread};
use super::lane::{self, LaneRow, ROW};
use super::{Panel, thin};
use plotters::coord::CoordTranslate;
use plotters::coord::cartesian::Cartesian2d;

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    /// Its name.
    pub(crate) name: String,
    /// What is written behind the name; may be empty.
    pub(crate) note: String,
    /// How it looks.
    pub(crate) look: Look,
    /// Its points.
    pub(crate) points: Vec<(f64, f64)>,
    /// Whether each point has a mark.
    pub(crate) marks: bool,
}

/// A reference to hold the lines against.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Guide {
    /// Triangles of these falling slopes, lower left.
    Slopes(Vec<u64>),
    /// The line on which both axes have the same value, with its name.
    Equal(&'static str),
}

/// A panel to be drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Chart {
    /// Its title; may be empty.
    pub(crate) title: String,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// The vertical axis.
    pub(crate) y: Axis,
    /// The lines, in the order they are drawn.
    pub(crate) lines: Vec<Line>,
    /// The failures.
    pub(crate) lane: Vec<LaneRow>,
    /// References.
    pub(crate) guides: Vec<Guide>,
    /// The whole width and the height between the axes' ends [px].
    pub(crate) size: (f64, f64),
    /// Lines of other panels to compare with, without names.
    pub(crate) ghosts: Vec<Vec<(f64, f64)>>,
    /// Room for names right of the plot [px] and lines below it, as [`align`] shares them.
    pub(crate) margin: (f64, usize),
    /// Room for the ticks' labels left of the plot [px], where panels share it; else their own width.
    pub(crate) left: f64,
    /// Whether its lines go without names: what is alone needs none.
    pub(crate) unnamed: bool,
    /// How often the thinning of its lines is doubled.
    pub(crate) coarse: u8,
}

/// The height of a line of labels [px].
const LABEL: f64 = 14.5;
/// The widest name [px]; a longer one is cut.
pub(super) const NAME: f64 = 180.0;
/// Left of the key of failures [px].
const INDENT: f64 = 48.0;
/// Right of a plot without names: half of a tick's label [px].
const EDGE: f64 = 18.0;
/// The piece of line before a label [px].
pub(super) const SAMPLE: f64 = 18.0;

/// Gives the panels of a figure the same margins, and those side by side the same foot:
/// they are aligned at their lower ends.
pub(crate) fn align(charts: &mut [Chart], columns: usize) {
    let named = |chart: &&Chart| !chart.unnamed;
    let any = charts.iter().any(|chart| !chart.unnamed);
    let names = charts.iter().filter(named).flat_map(|chart| {
        let lane = chart.lane.iter().map(|row| labels::width(&row.name));
        chart.lines.iter().map(|line| labels::width(&line.label())).chain(lane)
    });
    let room = names.fold(0.0, f64::max).min(NAME) + 16.0 + SAMPLE;
    let room = if any { room } else { EDGE };
    // Panels that stand below one another share their left edge too, as histories over one time do.
    let ticks = charts.iter().map(Chart::room_for_ticks).fold(0.0, f64::max);
    let left = if columns == 1 { ticks } else { 0.0 };
    let tall = charts.iter().map(|c| (c.lines.len() + 1) as f64 * LABEL).fold(0.0, f64::max);
    for row in charts.chunks_mut(columns.max(1)) {
        let key = |chart: &Chart| lane::key(&chart.lane, chart.size.0 - INDENT).len();
        let lines = row.iter().map(key).max().unwrap_or(0);
        for chart in row {
            chart.margin = (room, lines);
            // Beside others a plot without names is as wide as theirs; below them its edge stays at theirs.
            if chart.unnamed && columns > 1 {
                chart.size.0 -= room - EDGE;
                chart.margin.0 = EDGE;
            }
            chart.left = left;
            chart.size.1 = chart.size.1.max(tall);
        }
    }
}

impl Line {
    fn label(&self) -> String {
        if self.note.is_empty() {
            self.name.clone()
        } else {
            format!("{} {}", self.name, self.note)
        }
    }
}

/// The end of a line, the line unless it is a guide, and what is written there.
type Label<'a> = ((f64, f64), Option<&'a Line>, String);

/// Names right of the plot, each with a piece of its line, none over another.
fn draw_labels(canvas: &Canvas, frame: &Frame, labels: &[Label]) -> Result<(), Fault> {
    let wished: Vec<f64> = labels.iter().map(|(end, _, _)| end.1).collect();
    let heights = spread(&wished, LABEL, frame.top + 5.0, frame.bottom - 5.0);
    for (((x, y), line, text), height) in labels.iter().zip(heights) {
        let (start, sample) = ((x + 5.0).min(frame.right), frame.right + 10.0);
        canvas.line(&[(start, *y), (sample - 2.0, height)], Ink::Leader)?;
        let piece = [(sample, height), (sample + SAMPLE, height)];
        canvas.line(&piece, line.map_or(Ink::Guide, |line| Ink::Line(line.look)))?;
        // A mark that is nowhere on the line would be looked for.
        if let Some(line) = line.filter(|line| line.marks || labels.len() > 1) {
            canvas.mark((sample + SAMPLE / 2.0, height), line.look)?;
        }
        let ink = line.map_or(Ink::Muted, |line| Ink::Label(line.look));
        let at = (sample + SAMPLE + 5.0, height);
        canvas.text(&labels::fit(text, NAME), at, Side::Right, ink)?;
    }
    Ok(())
}

/// A few places along a long line to mark, at other places for each line.
fn sparse(places: &[(f64, f64)], n: usize) -> Vec<(f64, f64)> {
    const MARKS: f64 = 4.0;
    let step = |pair: &[(f64, f64)]| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
    let length: f64 = places.windows(2).map(step).sum();
    let mut next = length / MARKS * (0.12 + 0.37 * n as f64).fract();
    let (mut way, mut marks) = (0.0, Vec::new());
    for pair in places.windows(2) {
        way += step(pair);
        if way > next {
            marks.push(pair[1]);
            next += length / MARKS;
        }
    }
    marks
}

/// The least room between two labels of an axis [px].
const APART: f64 = 6.0;

/// Where things stand in a panel [px].
struct Frame {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    lane: f64,
    coordinates: Cartesian2d<Axis, Axis>,
}

impl Frame {
    fn new(chart: &Chart) -> Self {
        let left = chart.left.max(chart.room_for_ticks());
        let right = chart.size.0 - chart.margin.0;
        let lane = if chart.title.is_empty() { 24.0 } else { 44.0 };
        let top =
            lane + if chart.lane.is_empty() { 0.0 } else { ROW * chart.lane.len() as f64 + 5.0 };
        let bottom = top + chart.size.1;
        let pixels = (units(left)..units(right), units(bottom)..units(top));
        let coordinates = Cartesian2d::new(chart.x.clone(), chart.y.clone(), pixels);
        Self { left, right, top, bottom, lane, coordinates }
    }

    fn place(&self, point: (f64, f64)) -> (f64, f64) {
        let (x, y) = self.coordinates.translate(&point);
        (f64::from(x) / UNITS, f64::from(y) / UNITS)
    }

    fn holds(&self, (x, y): (f64, f64)) -> bool {
        let (x_in, y_in) = (self.left - 0.5..=self.right + 0.5, self.top - 0.5..=self.bottom + 0.5);
        x_in.contains(&x) && y_in.contains(&y)
    }
}

impl Chart {
    /// The room the labels of the vertical axis take [px].
    fn room_for_ticks(&self) -> f64 {
        let ticks = self.y.ticks(6);
        ticks.iter().map(|(_, text)| labels::width(text)).fold(38.0, f64::max).min(80.0) + 10.0
    }

    /// The visible pieces of a line.
    fn pieces(&self, frame: &Frame, places: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
        let (low, high) = ((frame.left, frame.top), (frame.right, frame.bottom));
        thin::visible(places, (low, high), f64::from(1_u32 << self.coarse.min(16)))
    }

    /// Draws the panel.
    pub(crate) fn draw(&self) -> Result<Panel, Fault> {
        let frame = Frame::new(self);
        let key = lane::key(&self.lane, self.size.0 - INDENT);
        let height = frame.bottom + 42.0 + 17.0 * self.margin.1 as f64;
        let body = sketch((self.size.0, height), |canvas| {
            self.draw_axes(canvas, &frame)?;
            self.draw_guides(canvas, &frame)?;
            let along = |x| frame.place((x, self.y.from)).0;
            lane::draw(canvas, &self.lane, (frame.left, frame.lane, frame.right), along)?;
            self.draw_lines(canvas, &frame)?;
            for (i, line) in key.iter().enumerate() {
                let y = frame.bottom + 50.0 + 17.0 * i as f64;
                canvas.text(
                    &labels::fit(line, self.size.0 - INDENT),
                    (INDENT, y),
                    Side::Right,
                    Ink::Muted,
                )?;
            }
            Ok(())
        })?;
        let (title, description) = (self.title.clone(), self.description());
        Ok(Panel { title, description, width: self.size.0, height, body })
    }

    fn draw_axes(&self, canvas: &Canvas, frame: &Frame) -> Result<(), Fault> {
        let (left, right, top, bottom) = (frame.left, frame.right, frame.top, frame.bottom);
        if !self.title.is_empty() {
            let title = labels::fit(&self.title, self.size.0);
            canvas.text(&title, (0.0, 11.0), Side::Right, Ink::Title)?;
        }
        let above = frame.lane - 13.0;
        canvas.text(
            &labels::fit(&self.y.label, self.size.0),
            (0.0, above),
            Side::Right,
            Ink::Muted,
        )?;
        canvas.text(
            &labels::fit(&self.x.label, right),
            (right, bottom + 33.0),
            Side::Left,
            Ink::Muted,
        )?;
        for (value, text) in self.y.ticks(6) {
            let y = frame.place((self.x.from, value)).1;
            canvas.line(&[(left, y), (right, y)], Ink::Grid)?;
            canvas.text(&text, (left - 7.0, y), Side::Left, Ink::Text)?;
        }
        for value in self.y.minor() {
            let y = frame.place((self.x.from, value)).1;
            canvas.line(&[(left - 3.0, y), (left, y)], Ink::Axis)?;
        }
        let mut free = f64::NEG_INFINITY;
        for (value, text) in self.ticks_that_fit(frame) {
            let x = frame.place((value, self.y.from)).0;
            canvas.line(&[(x, top), (x, bottom)], Ink::Grid)?;
            canvas.line(&[(x, bottom), (x, bottom + 4.0)], Ink::Axis)?;
            let half = labels::width(&text) / 2.0;
            if x - half > free {
                canvas.text(&text, (x, bottom + 14.0), Side::Middle, Ink::Text)?;
                free = x + half + APART;
            }
        }
        canvas.line(&[(left, top), (left, bottom), (right, bottom)], Ink::Axis)
    }

    /// The ticks of the horizontal axis from left to right, so many that their labels stand apart.
    fn ticks_that_fit(&self, frame: &Frame) -> Vec<(f64, String)> {
        let sorted = |most| {
            let mut ticks = self.x.ticks(most);
            ticks.sort_by(|a, b| self.x.share(a.0).total_cmp(&self.x.share(b.0)));
            ticks
        };
        let apart = |ticks: &[(f64, String)]| {
            ticks.windows(2).all(|pair| {
                let at = |tick: &(f64, String)| frame.place((tick.0, self.y.from)).0;
                let room = 0.5 * (labels::width(&pair[0].1) + labels::width(&pair[1].1)) + APART;
                at(&pair[1]) - at(&pair[0]) >= room
            })
        };
        let fitting = (2..=6).rev().map(sorted).find(|ticks| ticks.len() > 1 && apart(ticks));
        fitting.unwrap_or_else(|| sorted(6))
    }

    fn draw_guides(&self, canvas: &Canvas, frame: &Frame) -> Result<(), Fault> {
        for guide in &self.guides {
            match guide {
                Guide::Slopes(slopes) => self.draw_slopes(canvas, frame, slopes)?,
                Guide::Equal(_) => {
                    for piece in self.equal(frame) {
                        canvas.line(&piece, Ink::Guide)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The line on which both axes have the same value.
    fn equal(&self, frame: &Frame) -> Vec<Vec<(f64, f64)>> {
        let line = [self.x.from, self.x.to].map(|end| frame.place((end, end)));
        self.pieces(frame, &line)
    }

    /// One triangle beside the other, each falling by its slope over a factor of two.
    fn draw_slopes(&self, canvas: &Canvas, frame: &Frame, slopes: &[u64]) -> Result<(), Fault> {
        let run = frame.place((self.x.from * 2.0, self.y.to)).0 - frame.left;
        let fall = frame.place((self.x.from, self.y.to * 0.5)).1 - frame.top;
        let mut left = frame.left + 8.0;
        for slope in slopes {
            let (right, bottom) = (left + run, frame.bottom - 7.0);
            let top = bottom - fall * *slope as f64;
            if right + 12.0 > frame.right || top < frame.top {
                break;
            }
            let corners = [(left, top), (right, bottom), (left, bottom), (left, top)];
            canvas.line(&corners, Ink::Guide)?;
            let at = (left + run * 0.5 + 3.0, f64::midpoint(top, bottom) - 8.0);
            canvas.text(&slope.to_string(), at, Side::Right, Ink::Muted)?;
            left = right + 8.0;
        }
        Ok(())
    }

    fn draw_lines(&self, canvas: &Canvas, frame: &Frame) -> Result<(), Fault> {
        let mut ends = Vec::new();
        for ghost in self.ghosts.iter().flat_map(|line| line.split(|p| !p.1.is_finite())) {
            let places: Vec<_> = ghost.iter().map(|p| frame.place(*p)).collect();
            for piece in self.pieces(frame, &places) {
                canvas.line(&piece, Ink::Ghost)?;
            }
        }
        for (n, line) in self.lines.iter().enumerate() {
            let mut places = Vec::new();
            // A value that is not there breaks the line.
            for run in line.points.split(|p| !p.0.is_finite() || !p.1.is_finite()) {
                let run: Vec<_> = run.iter().map(|p| frame.place(*p)).collect();
                for piece in self.pieces(frame, &run) {
                    canvas.line(&piece, Ink::Line(line.look))?;
                }
                places.extend(run);
            }
            let marks = match (line.marks, self.lines.len()) {
                (true, _) => places.clone(),
                (false, 0..=1) => Vec::new(),
                (false, _) => sparse(&places, n),
            };
            for place in marks.into_iter().filter(|place| frame.holds(*place)) {
                canvas.mark(place, line.look)?;
            }
            // The name stands beside the rightmost point, at most at the plot's edge.
            let end = places.iter().copied().reduce(|a, b| if b.0 >= a.0 { b } else { a });
            let end = end.map(|(x, y)| (x.min(frame.right), y.clamp(frame.top, frame.bottom)));
            ends.extend(end.map(|end| (end, Some(line), line.label())));
        }
        if self.unnamed {
            return Ok(());
        }
        let mut labels: Vec<Label> = ends;
        for guide in &self.guides {
            let Guide::Equal(name) = guide else { continue };
            let end = self.equal(frame).last().and_then(|piece| piece.last().copied());
            labels.extend(end.map(|end| (end, None, (*name).to_owned())));
        }
        draw_labels(canvas, frame, &labels)
    }

    /// The panel in words.
    fn description(&self) -> String {
        let lines: Vec<String> = self.lines.iter().map(Line::label).collect();
        let failed: Vec<String> = self
            .lane
            .iter()
            .map(|row| format!("{} ({} of its cases)", row.name, row.marks.len()))
            .collect();
        let mut text = format!("{} against {}.", self.y.label, self.x.label);
        if !lines.is_empty() {
            put!(text, " Lines from top to bottom of the list: {}.", lines.join(", "));
        }
        if !failed.is_empty() {
            put!(text, " Failed: {}.", failed.join(", "));
        }
        text
    }
}
