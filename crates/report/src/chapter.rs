//! One experiment on its way to the pages: its tables, its folder, its drawn figures.

use crate::claims::Part;
use crate::figures::{Drawing, FigureKind, draw};
use crate::number;
use crate::plot::file;
use crate::{Output, ReportError, escape};
use record::{ClaimRow, FigureRow, StudyRow, Summary};

/// An experiment with its figures drawn.
#[derive(Debug)]
pub(crate) struct Chapter<'a> {
    /// The tables.
    pub(crate) summary: &'a Summary,
    /// The folder in `reports/`, and the element in the page.
    pub(crate) folder: String,
    /// The figures, in the table's order.
    pub(crate) figures: Vec<Figure<'a>>,
}

/// A drawn figure.
#[derive(Debug)]
pub(crate) struct Figure<'a> {
    /// Its row.
    pub(crate) row: &'a FigureRow,
    /// Its file, without extension.
    pub(crate) name: String,
    /// Its element in the page.
    pub(crate) id: String,
    /// Its kind.
    pub(crate) kind: &'static FigureKind,
    /// What is drawn.
    pub(crate) drawing: Drawing,
}

impl Figure<'_> {
    /// Whether it stands folded at the end of its chapter.
    fn stands_aside(&self) -> bool {
        self.row.aside || self.kind.of_solvers
    }
}

/// A study's title, or its name without one.
pub(crate) fn heading(study: &StudyRow) -> &str {
    if study.title.is_empty() { &study.study } else { &study.title }
}

/// What is told of a study: its model, its input, and what its errors are measured against.
pub(crate) fn told(study: &StudyRow) -> Vec<(&'static str, String)> {
    let error = study.reference_error.map_or_else(String::new, |error| {
        format!(", itself exact to {} in relative terms", number::error(Some(error)))
    });
    let reference = match study.reference.as_str() {
        "" => String::new(),
        name if study.response.is_empty() => format!("reference “{name}”{error}"),
        name => format!("reference “{name}”{error}; errors of the {}", study.response),
    };
    let mut told = vec![
        ("Model", number::greek(&study.model)),
        ("Input", study.input.clone()),
        ("Errors against", reference),
    ];
    told.retain(|(_, text)| !text.is_empty());
    told
}

impl<'a> Chapter<'a> {
    /// The heading of the study of this name.
    pub(crate) fn heading_of(&self, name: &'a str) -> &'a str {
        self.summary.studies.iter().find(|s| s.study == name).map_or(name, heading)
    }

    /// Draws the experiment's figures.
    pub(crate) fn new(summary: &'a Summary) -> Result<Self, ReportError> {
        let folder = escape::slug(&summary.name);
        let mut figures: Vec<Figure> = Vec::new();
        for row in &summary.figures {
            let mut name = escape::slug(&row.figure);
            // The tables stand in the same folder, and `orders` is a good name for a figure too.
            let table = format!("{name}.csv");
            if Summary::FILES.iter().any(|file| file.eq_ignore_ascii_case(&table)) {
                name.push_str("-figure");
            }
            if figures.iter().any(|other| other.name.eq_ignore_ascii_case(&name)) {
                return Err(ReportError::SameName { path: format!("{folder}/{name}.svg") });
            }
            let id = format!("{folder}--{name}");
            let (drawing, kind) = draw(row, summary)?;
            figures.push(Figure { row, name, id, kind, drawing });
        }
        Ok(Self { summary, folder, figures })
    }

    /// The experiment's title, or its name if it has none.
    pub(crate) fn title(&self) -> &str {
        Some(self.summary.about("title")).filter(|t| !t.is_empty()).unwrap_or(&self.summary.name)
    }

    /// The figure a claim points to.
    pub(crate) fn shown(&self, claim: &ClaimRow) -> Option<&Figure<'a>> {
        self.figures.iter().find(|figure| figure.row.figure == claim.figure)
    }

    /// The figures of the model of one study, of a fit or of a search; those of no study belong to the empty name.
    pub(crate) fn figures_of(&self, study: &str) -> Vec<&Figure<'a>> {
        let known = |name: &str| {
            self.summary.studies.iter().any(|row| row.study == name)
                || self.summary.fits.iter().any(|row| row.fit == name)
                || self.summary.discoveries.iter().any(|row| row.discovery == name)
        };
        let own = |figure: &&Figure| {
            let own = figure.row.study.as_str();
            own == study || (study.is_empty() && !known(own))
        };
        self.figures.iter().filter(|figure| !figure.stands_aside()).filter(own).collect()
    }

    /// What stands folded at the end: the figures put aside, then those of how the solvers did.
    pub(crate) fn more_figures(&self) -> Vec<&Figure<'a>> {
        let mut more: Vec<_> = self.figures.iter().filter(|figure| figure.stands_aside()).collect();
        more.sort_by_key(|figure| figure.kind.of_solvers);
        more
    }

    /// The claims of one part of the front.
    pub(crate) fn claims_of(&self, part: Part) -> Vec<&'a ClaimRow> {
        self.summary.claims.iter().filter(|claim| Part::of(claim) == part).collect()
    }

    /// The first number in the place of the paper, which chapters are ordered by; without one they come last.
    pub(crate) fn place(&self) -> u64 {
        let paper = self.summary.about("paper");
        let digits = paper.split(|c: char| !c.is_ascii_digit()).find(|part| !part.is_empty());
        digits.and_then(|number| number.parse().ok()).unwrap_or(u64::MAX)
    }

    /// The figures' own files: pictures and the values in them.
    pub(crate) fn files(&self) -> impl Iterator<Item = Output> {
        self.figures.iter().flat_map(|figure| {
            let path = |ending: &str| format!("{}/{}.{ending}", self.folder, figure.name);
            let drawing = &figure.drawing;
            let (title, description) = (&figure.row.title, &figure.row.description);
            let svg = file(&drawing.panels, drawing.columns, title, description);
            [
                Output { path: path("svg"), bytes: svg.into_bytes() },
                Output { path: path("csv"), bytes: csv(drawing).into_bytes() },
            ]
        })
    }
}

/// The values in a figure, with the axes' labels as headers.
pub(crate) fn csv(drawing: &Drawing) -> String {
    let header = ["panel", "series", &drawing.x, &drawing.y, "failure"];
    let line = |fields: [&str; 5]| fields.map(escape::csv).join(",") + "\n";
    let value = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:?}"));
    let rows = drawing.data.iter().map(|datum| {
        let (x, y) = (value(datum.x), value(datum.y));
        line([&datum.panel, &datum.series, &x, &y, &datum.note])
    });
    std::iter::once(line(header)).chain(rows).collect()
}

/// What is reproduced: said on the front, for a reader who comes from nowhere.
pub(crate) const PAPER: &str = "A reproduction of “Duhem Modeling of Friction-Induced Hysteresis” \
     (IEEE Control Systems Magazine 28(5), 2008, doi 10.1109/MCS.2008.927331), its claims measured against \
     exact answers, and the ODE solvers that have to cope with them compared.";

/// A text's first sentence, and the others.
pub(crate) fn split_first(text: &str) -> (String, String) {
    let mut all = escape::sentences(text).into_iter();
    (all.next().unwrap_or_default(), all.collect::<Vec<_>>().join(" "))
}
