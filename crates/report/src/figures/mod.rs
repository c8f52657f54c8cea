//! The kinds of figures: one file each, one line in [`FIGURES`].

mod collapse;
mod convergence;
mod curves;
mod ladder;
mod orders;
mod ranking;
mod tolerance;
mod work_precision;

use crate::ReportError;
use crate::fit_drawing::FitLadder;
use crate::plot::{Chart, Fault, Panel, align};
use record::{FigureRow, Summary};

/// One kind of figure.
#[derive(Debug, Clone, Copy)]
pub struct FigureKind {
    /// The name in a figure's row.
    pub name: &'static str,
    /// How to read it, said under every caption; empty if it needs no saying.
    pub reads: &'static str,
    /// Whether it is about how the solvers work and not about the model: it stands folded in its chapter.
    pub of_solvers: bool,
    /// Draws the figure of that row from the tables.
    pub draw: fn(&FigureRow, &Summary) -> Result<Drawing, ReportError>,
}

/// Every kind; a loop and a history are curves under the names their studies use.
pub const FIGURES: &[FigureKind] = &[
    FigureKind {
        name: "collapse",
        reads: "A line breaks where its solver failed; letters in the margin lane are the failed runs.",
        of_solvers: false,
        draw: collapse::draw,
    },
    FigureKind {
        name: "convergence",
        reads: "The number behind a name is the observed order, and the triangles show slopes to compare with. \
                Letters in the margin lane are failed runs.",
        of_solvers: true,
        draw: convergence::draw,
    },
    FigureKind { name: "curves", reads: "", of_solvers: false, draw: curves::draw },
    FigureKind {
        name: "history",
        reads: "A letter in the margin lane stands where a run failed and its line ends.",
        of_solvers: true,
        draw: curves::draw,
    },
    FigureKind {
        name: "ladder",
        reads: "Root mean square of the residuals of all channels on blocks that were not fitted, in units of what noise \
                alone leaves; the line stands at the floor.",
        of_solvers: false,
        draw: ladder::draw,
    },
    FigureKind { name: "loop", reads: "", of_solvers: false, draw: curves::draw },
    FigureKind {
        name: "orders",
        reads: "A mark left of the tick falls short of the declared order; the longer the bar, the more of it the corners cost.",
        of_solvers: true,
        draw: orders::draw,
    },
    FigureKind {
        name: "ranking",
        reads: "What each candidate, refitted in full, takes away of the excess over the floor on blocks that were not \
                fitted, with its 95 % interval over the blocks and Student's t; what makes it worse by more than a quarter stands \
                at the edge. Bold is what was named, or cannot be told from it.",
        of_solvers: false,
        draw: ranking::draw,
    },
    FigureKind {
        name: "tolerance",
        reads: "The number behind a name is the slope of the error against the tolerance: 1 is proportional. \
                Letters in the margin lane are failed runs.",
        of_solvers: true,
        draw: tolerance::draw,
    },
    FigureKind {
        name: "work_precision",
        reads: "Bold are our own methods that are given the task and find the corners themselves: a star is an exact \
                one, at the updates it makes and at its round-off; an error below 10⁻¹³ stands at 10⁻¹³. \
                Grey lines repeat the other panel of the row. \
                Letters in the margin lane are failed runs, at the work they had spent, or at the edge if that lies beyond it.",
        of_solvers: true,
        draw: work_precision::draw,
    },
];

/// A drawn figure: its panels, and what is drawn in them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// The panels, in reading order.
    pub panels: Vec<Panel>,
    /// How many of them stand side by side where there is room.
    pub columns: usize,
    /// What is drawn: the rows of the figure's CSV.
    pub data: Vec<Datum>,
    /// The header of the horizontal values, with unit.
    pub x: String,
    /// The header of the vertical values, with unit.
    pub y: String,
}

/// One drawn value.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Datum {
    /// The panel.
    pub panel: String,
    /// The line it belongs to.
    pub series: String,
    /// Horizontal.
    pub x: Option<f64>,
    /// Vertical; none where there is nothing to measure.
    pub y: Option<f64>,
    /// How the case failed; else empty.
    pub note: String,
}

/// Draws the figure of this row, by its kind, and says what kind it is.
pub(crate) fn draw(
    figure: &FigureRow,
    summary: &Summary,
) -> Result<(Drawing, &'static FigureKind), ReportError> {
    let kind = FIGURES.iter().find(|kind| kind.name == figure.kind);
    let kind = kind.ok_or_else(|| ReportError::UnknownKind {
        experiment: summary.name.clone(),
        figure: figure.figure.clone(),
        kind: figure.kind.clone(),
        known: FIGURES.iter().map(|kind| kind.name).collect::<Vec<_>>().join(", "),
    })?;
    Ok(((kind.draw)(figure, summary)?, kind))
}

/// The error for what plotters says.
fn fault(figure: &FigureRow) -> impl Fn(Fault) -> ReportError {
    |why| ReportError::Drawing { figure: figure.figure.clone(), why }
}

/// The error for a row or table that lacks something.
fn incomplete(figure: &FigureRow, found: &str, expected: &str) -> ReportError {
    ReportError::Incomplete {
        figure: figure.figure.clone(),
        kind: figure.kind.clone(),
        found: found.to_owned(),
        expected: expected.to_owned(),
    }
}

/// A figure of charts, so many side by side, with the values they show.
fn of_charts(
    figure: &FigureRow,
    mut charts: Vec<Chart>,
    columns: usize,
) -> Result<Drawing, ReportError> {
    if charts.is_empty() {
        return Err(incomplete(figure, "no case that it could show", "one or more"));
    }
    align(&mut charts, columns);
    let panels = small(figure, &mut charts)?;
    let same = |label: fn(&Chart) -> &str, otherwise: &str| {
        let first = label(&charts[0]);
        if charts.iter().all(|chart| label(chart) == first) { first } else { otherwise }.to_owned()
    };
    let x = same(|chart| &chart.x.label, "x");
    let y = same(|chart| &chart.y.label, "y");
    Ok(Drawing { panels, columns, data: charts.iter().flat_map(values).collect(), x, y })
}

/// A figure of ladders below one another, with the values of their rungs.
fn of_ladders(ladders: &[FitLadder]) -> Result<Drawing, Fault> {
    let panels = FitLadder::stack(ladders)?;
    let datum = |ladder: &FitLadder| {
        let title = ladder.title.clone();
        let rungs = ladder.rungs.iter().map(move |rung| Datum {
            panel: title.clone(),
            series: rung.name.clone(),
            x: Some(rung.value).filter(|value| value.is_finite()),
            y: None,
            note: String::new(),
        });
        rungs.collect::<Vec<_>>()
    };
    let x = ladders.first().map_or(String::new(), |ladder| ladder.axis.clone());
    Ok(Drawing {
        panels,
        columns: 1,
        data: ladders.iter().flat_map(datum).collect(),
        x,
        y: String::new(),
    })
}

/// The most that the panels of one figure may take [bytes]; with its style and title a file stays below 150 kB.
const MOST: usize = 140_000;

/// The panels, their lines thinned until they are small enough: a long history can turn a thousand times.
fn small(figure: &FigureRow, charts: &mut [Chart]) -> Result<Vec<Panel>, ReportError> {
    for coarse in 0..=5 {
        for chart in charts.iter_mut() {
            chart.coarse = coarse;
        }
        let drawn = charts.iter().map(Chart::draw).collect::<Result<Vec<_>, _>>();
        let panels = drawn.map_err(fault(figure))?;
        if panels.iter().map(|panel| panel.body.len()).sum::<usize>() <= MOST {
            return Ok(panels);
        }
    }
    let expected = format!("at most {} kB, in fewer panels or series", MOST / 1000);
    Err(incomplete(figure, "more lines than a picture can hold", &expected))
}

fn values(chart: &Chart) -> Vec<Datum> {
    let datum = |series: &str, x: f64, y: Option<f64>, note: &str| Datum {
        panel: chart.title.clone(),
        series: series.to_owned(),
        x: Some(x),
        y,
        note: note.to_owned(),
    };
    let lines = chart.lines.iter().flat_map(|line| {
        let drawn = line.points.iter().filter(|point| point.1.is_finite());
        drawn.map(|point| datum(&line.name, point.0, Some(point.1), ""))
    });
    let lane = chart
        .lane
        .iter()
        .flat_map(|row| row.marks.iter().map(|(x, status)| datum(&row.name, *x, None, status)));
    lines.chain(lane).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_listed_once_and_in_order() {
        assert!(FIGURES.windows(2).all(|pair| pair[0].name < pair[1].name));
    }
}
