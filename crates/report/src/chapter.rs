//! One experiment on its way to the pages: its tables, its folder, its drawn figures.

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

    /// The figures of one study, those of the model first, then those of the solvers;
    /// those of no study belong to the empty name.
    pub(crate) fn figures_of(&self, study: &str) -> [Vec<&Figure<'a>>; 2] {
        let known = |name: &str| self.summary.studies.iter().any(|row| row.study == name);
        let own = self.figures.iter().filter(|figure| {
            let own = figure.row.study.as_str();
            own == study || (study.is_empty() && !known(own))
        });
        let (solvers, model) = own.partition(|figure| figure.kind.of_solvers);
        [model, solvers]
    }

    /// The claims of it that hold.
    pub(crate) fn held_claims(&self) -> Vec<&'a ClaimRow> {
        self.summary.claims.iter().filter(|claim| settled(claim)).collect()
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

/// Whether a claim holds as it stands: what depends on something that is not printed does not.
fn settled(claim: &ClaimRow) -> bool {
    claim.holds == Some(true) && claim.verdict != "under-specified"
}

/// The claims that do not hold, then those that cannot be decided or not in full, each with its chapter.
pub(crate) fn open_claims<'a, 'b>(
    chapters: &'b [Chapter<'a>],
) -> Vec<(&'b Chapter<'a>, &'a ClaimRow)> {
    let of =
        |chapter: &'b Chapter<'a>| chapter.summary.claims.iter().map(move |claim| (chapter, claim));
    let mut all: Vec<_> = chapters.iter().flat_map(of).filter(|(_, c)| !settled(c)).collect();
    all.sort_by_key(|(_, claim)| match claim.holds {
        Some(false) => 0,
        None => 1,
        Some(true) => 2,
    });
    all
}

/// Whether the claims that hold are so few that a front can show a line of each.
pub(crate) fn few_held(chapters: &[Chapter]) -> bool {
    chapters.iter().map(|chapter| chapter.held_claims().len()).sum::<usize>() <= 30
}

/// The heading of what [`open_claims`] gives.
pub(crate) const OPEN: &str = "What does not hold, or cannot be decided in full";

/// A text's first sentence, and the others.
pub(crate) fn split_first(text: &str) -> (String, String) {
    let mut all = escape::sentences(text).into_iter();
    (all.next().unwrap_or_default(), all.collect::<Vec<_>>().join(" "))
}

/// A number with its unit and the printed one before it, as the line of a claim that holds ends; often nothing.
pub(crate) fn in_short(claim: &ClaimRow) -> String {
    match (claim.printed, claim.ours) {
        (Some(_), Some(_)) => {
            let printed = number::printed(claim.printed, claim.digits, &claim.unit);
            format!("printed {printed}, ours {}", ours(claim))
        }
        _ => String::new(),
    }
}

/// What the front says first: how many claims hold, and the verdicts.
pub(crate) fn count_of_claims(claims: &[&ClaimRow]) -> String {
    let total = claims.len();
    if total == 0 {
        return "No claim of the paper is tested here.".to_owned();
    }
    let held = |holds| claims.iter().filter(|claim| claim.holds == holds).count();
    let kinds = ["reproduced", "contradicted", "under-specified", "qualitative"];
    let verdicts: Vec<String> = kinds
        .iter()
        .map(|kind| (claims.iter().filter(|claim| claim.verdict == *kind).count(), kind))
        .filter(|(n, _)| *n > 0)
        .map(|(n, kind)| format!("{n} {kind}"))
        .collect();
    let (yes, no, open) = (held(Some(true)), held(Some(false)), held(None));
    let plural =
        |n: usize, one: &str, more: &str| format!("{n} {}", if n == 1 { one } else { more });
    let mut parts = vec![plural(yes, "holds", "hold"), plural(no, "does not", "do not")];
    if open > 0 {
        parts.push(format!("{open} cannot be decided"));
    }
    let last = parts.pop().unwrap_or_default();
    let tested = plural(total, "claim", "claims");
    let verdicts =
        if verdicts.is_empty() { String::new() } else { format!(": {}", verdicts.join(", ")) };
    format!("Of {tested} of the paper, {} and {last}{verdicts}.", parts.join(", "))
}

/// A verdict's sign, told apart without colour.
pub(crate) fn sign(verdict: &str) -> &'static str {
    match verdict {
        "reproduced" => "✓",
        "contradicted" => "✗",
        "under-specified" => "?",
        "qualitative" => "≈",
        _ => "·",
    }
}

/// Whether the claim holds, where the verdict alone does not say it.
pub(crate) fn holds(claim: &ClaimRow) -> &'static str {
    match (claim.verdict.as_str(), claim.holds) {
        ("reproduced", Some(true)) | ("contradicted", Some(false)) => "",
        (_, Some(true)) => "holds",
        (_, Some(false)) => "does not hold",
        (_, None) => "cannot be decided",
    }
}

/// Our number against a printed one, with its error.
pub(crate) fn ours(claim: &ClaimRow) -> String {
    match (claim.printed, claim.ours) {
        (Some(_), Some(value)) => number::with_error(value, claim.error, &claim.unit),
        _ => number::NONE.to_owned(),
    }
}

/// How a claim was decided; a number that answers no printed one is the evidence for it.
pub(crate) fn decided(claim: &ClaimRow) -> Option<String> {
    let number = claim.ours.filter(|_| claim.printed.is_none());
    let number = number.map(|value| number::with_error(value, claim.error, &claim.unit));
    let parts = [Some(claim.how.clone()), number].into_iter().flatten();
    let parts: Vec<String> = parts.filter(|part| !part.is_empty()).collect();
    (!parts.is_empty()).then(|| format!("Decided by: {}", parts.join("; found: ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_counts_what_holds_and_what_does_not() {
        let claim = |verdict: &str, holds| ClaimRow {
            verdict: verdict.to_owned(),
            holds,
            ..ClaimRow::default()
        };
        let claims = [
            claim("reproduced", Some(true)),
            claim("contradicted", Some(false)),
            claim("qualitative", Some(true)),
            claim("under-specified", None),
        ];
        assert_eq!(
            count_of_claims(&claims.iter().collect::<Vec<_>>()),
            "Of 4 claims of the paper, 2 hold, 1 does not and 1 cannot be decided: \
             1 reproduced, 1 contradicted, 1 under-specified, 1 qualitative."
        );
        assert_eq!(count_of_claims(&[]), "No claim of the paper is tested here.");
    }
}
