//! The page for people.

use super::{
    Run, Told,
    answer::identified,
    picture,
    shown::{acts, axis_unit, between, counted, physics, shows, sounds, telling, with_error},
    verdict,
};
use crate::{
    fit::{
        page::{curve, histories, loops, named, part, words},
        shown::sure,
    },
    recorded::safe,
};
use discover::{Gap, Moved, Of, Residual};
use experiment::four_digits;
use identify::fit::{Data, Trace};
use report::{FitFigure, FitPage, FitPanel, FitPart, FitRole};

/// What the page shows beside the answer.
pub(super) struct Pictures {
    /// The residual force of the rig as given, of the final model without what was found, and of the final model.
    pub(super) residuals: [Option<Residual>; 3],
    /// Every channel, measured, with the rig as given and with the final model.
    pub(super) traces: Vec<Trace>,
}

/// The whole page.
pub(super) fn page(told: &Told, data: &Data, pictures: &Pictures) -> String {
    let mut parts = vec![found(told), gap(told), residual(told, pictures)];
    parts.extend(places(told, pictures));
    parts.extend(ranking(told));
    parts.extend(over_the_data(told, data, pictures));
    parts.extend(confirmed(told));
    parts.extend(left(told));
    parts.extend(limits(told));
    parts.push(parameters(told));
    let opening = sentence(&verdict(told));
    report::fit_page(&FitPage { title: safe(&told.rig.title), opening, parts })
}

/// A sentence of what is said: with a capital and a full stop.
fn sentence(said: &str) -> String {
    let mut letters = said.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}.", letters.as_str())
}

/// What was named, its values, and what would tell it from others.
fn found(told: &Told) -> FitPart {
    let found = &told.found;
    let rows = found.effects.iter().flat_map(|effect| {
        effect.values.iter().map(|v| {
            vec![
                effect.name.to_owned(),
                named(&v.name, v.unit),
                with_error(v.value, v.standard_error),
                format!("{} %", four_digits(100.0 * effect.shrink)),
            ]
        })
    });
    let mut list = Vec::new();
    for effect in &found.effects {
        list.push(format!("{}: {}", effect.name, physics(effect.name)));
        if effect.set.len() > 1 {
            list.push(format!("This record cannot tell apart: {}.", effect.set.join(", ")));
            if !effect.separated_by.is_empty() {
                list.push(format!("They would be separated by {}", effect.separated_by));
            }
        }
    }
    let check = &told.check;
    let gravest = check.gravest.as_ref().map_or(String::new(), |finding| {
        let gap = if finding.channel.is_empty() { "" } else { ": " };
        format!(" The gravest: {}{gap}{}.", finding.channel, finding.text)
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let head = ["effect", "value", "found ± s.e.", "of the excess"];
    let doctor = format!(
        "The record's doctor has {} and {}.{}",
        counted(check.problems, "problem"),
        counted(check.notes, "note"),
        safe(&gravest)
    );
    FitPart {
        title: "What was found".to_owned(),
        text: [
            Some(doctor),
            told.found.hold.map(|hold| sentence(&format!("the input {}", between(hold)))),
        ]
        .into_iter()
        .flatten()
        .collect(),
        head: if rows.is_empty() { Vec::new() } else { words(&head) },
        rows,
        list,
        ..part()
    }
}

/// The gap of every channel, and the ladder.
fn gap(told: &Told) -> FitPart {
    let row = |g: &Gap| {
        let mut row = vec![named(&g.channel, g.unit)];
        row.extend([g.before, g.refit, g.after, g.floor].map(four_digits));
        row
    };
    FitPart {
        title: "The gap".to_owned(),
        text: words(&[
            "Root mean square of measured less simulated on the blocks that were not fitted; what the noise of the \
             input may move is weighed down.",
        ]),
        head: words(&["channel", "given", "refitted", "with the effects", "floor"]),
        rows: told.found.gap.iter().map(row).collect(),
        drawings: vec![picture::ladder(told)],
        ..part()
    }
}

/// The residual force over time.
fn residual(told: &Told, pictures: &Pictures) -> FitPart {
    let what = if axis_unit(told, "drive") == "N" { "force" } else { "torque" };
    let names = ["as given", "without what was found", "with it"];
    let panels = pictures.residuals.iter().zip(names).filter_map(|(residual, name)| {
        let r = residual.as_ref()?;
        let floor = r.time.iter().zip(&r.floor).map(|(t, f)| (*t, 2.0 * f));
        Some(FitPanel {
            title: name.to_owned(),
            x: "t [s]".to_owned(),
            y: format!("residual {what} [{}]", axis_unit(told, "drive")),
            curves: vec![curve("residual", &r.time, &r.force, FitRole::Measured)],
            local_noise: floor.collect(),
            ..FitPanel::default()
        })
    });
    let panels: Vec<FitPanel> = panels.collect();
    let figures = if panels.is_empty() {
        Vec::new()
    } else {
        vec![FitFigure {
            title: format!("Residual {what} over time"),
            caption: format!(
                "The {what} that the model lacks, {}. The grey lines stand two standard deviations of what noise alone \
                 makes on either side.",
                if imposed(told) {
                    "as what was measured more than simulated"
                } else {
                    "by a motion that is nudged towards the measured one; positive pushes forth"
                }
            ),
            panels,
            over_time: true,
        }]
    };
    let text = if figures.is_empty() {
        words(&["The model has no motion on this record."])
    } else if told.model.two_masses() {
        // The observer is driven by one measured displacement.
        words(&[
            "Motor and load count as one mass here: what their joint does is still in the last picture.",
        ])
    } else {
        Vec::new()
    };
    FitPart { title: format!("Residual {what}"), text, figures, ..part() }
}

/// Whether the motion is imposed and the force measured.
fn imposed(told: &Told) -> bool {
    told.rig.kind == "prescribed"
}

/// Where the residual acts.
fn places(told: &Told, pictures: &Pictures) -> Option<FitPart> {
    let heat = picture::heat(told, &pictures.residuals)?;
    let shares = &told.found.shares;
    let list = shares.iter().filter(|s| s.share.is_finite());
    let list = list.map(|s| format!("{}: {:.0} %", s.part, 100.0 * s.share));
    let list: Vec<String> = list.collect();
    let text = if list.is_empty() {
        Vec::new()
    } else {
        words(&["Of the excess over the floor, refitted, each share to about 10 %:"])
    };
    Some(FitPart { title: "Where".to_owned(), text, list, drawings: vec![heat], ..part() })
}

/// The candidates of every round.
fn ranking(told: &Told) -> Option<FitPart> {
    let drawings = picture::rankings(told);
    if drawings.is_empty() {
        return None;
    }
    Some(FitPart { title: "Candidates".to_owned(), drawings, ..part() })
}

/// The record and both models.
fn over_the_data(told: &Told, data: &Data, pictures: &Pictures) -> Option<FitPart> {
    if pictures.traces.is_empty() {
        return None;
    }
    let caption = "Measured, with the model as given (before), and with the final one (after).";
    let mut figures: Vec<FitFigure> =
        loops(&told.rig, data, &pictures.traces).into_iter().collect();
    figures.push(histories(&told.rig, &pictures.traces, false));
    for figure in &mut figures {
        caption.clone_into(&mut figure.caption);
    }
    Some(FitPart { title: "Hysteresis before and after".to_owned(), figures, ..part() })
}

/// Both models in one run, on the record and on the one held out.
fn confirmed(told: &Told) -> Option<FitPart> {
    let whose = |run: &Run| if run.held { "held out: " } else { "" };
    let rows = told.runs.iter().flat_map(|run| {
        run.gap.iter().map(move |g| {
            let mut row = vec![format!("{}{}", whose(run), named(&g.channel, g.unit))];
            row.extend([g.before, g.after, g.floor].map(four_digits));
            row
        })
    });
    let list = told.runs.iter().filter_map(|run| {
        let [before, after] = run.command?.map(four_digits);
        Some(format!("{}the command is off by {before} % before and {after} % after", whose(run)))
    });
    let way = if told.rig.controller.is_some() { "with the controller" } else { "open loop" };
    (!told.runs.is_empty()).then(|| FitPart {
        title: "Confirmation".to_owned(),
        text: vec![format!("In one run, {way}, with no help from the record.")],
        head: words(&["channel", "before", "after", "floor"]),
        rows: rows.collect(),
        list: list.collect(),
        ..part()
    })
}

/// The map of what is left.
fn left(told: &Told) -> Option<FitPart> {
    let map = told.found.map.as_ref()?;
    let (unit, force) = (axis_unit(told, map.axis), axis_unit(told, "drive"));
    let (of, what) = match map.of {
        Of::Force => ("A force", "what is left"),
        Of::Friction => ("Friction", "friction more than the model's"),
    };
    let panel = FitPanel {
        x: format!("{} [{unit}]", map.axis),
        y: format!("{what} [{force}]"),
        curves: vec![curve("map", &map.at, &map.force, FitRole::After)],
        ..FitPanel::default()
    };
    Some(FitPart {
        title: "What is left".to_owned(),
        text: [Some(acts(told, map)), told.found.tone.map(sounds)]
            .into_iter()
            .flatten()
            .map(|text| sentence(&text))
            .collect(),
        figures: shows(map)
            .then(|| FitFigure {
                title: format!("What is left over the {}", map.axis),
                caption: format!("{of} without a name, fitted piece by piece."),
                panels: vec![panel],
                over_time: true,
            })
            .into_iter()
            .collect(),
        ..part()
    })
}

/// What this record would have shown.
fn limits(told: &Told) -> Option<FitPart> {
    let rows = telling(told).into_iter().map(|l| {
        let by = l.hidden_by.clone().unwrap_or_else(|| "–".to_owned());
        vec![l.name.to_owned(), four_digits(l.amount), l.unit.to_owned(), by]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    (!rows.is_empty()).then(|| FitPart {
        title: "What would have been visible".to_owned(),
        text: words(&[
            "The smallest amount of each effect that this record would have shown at five standard errors, and the \
             parameter that takes up most of it.",
        ]),
        head: words(&["effect", "from", "unit", "hidden by"]),
        rows,
        ..part()
    })
}

fn parameters(told: &Told) -> FitPart {
    let row = |p: &Moved| {
        let (value, error) = (p.found.value, p.found.standard_error);
        let note = match (p.moved, identified(p)) {
            (true, _) => "moved",
            (_, false) => "not told by this record",
            _ => "",
        };
        vec![
            named(&p.found.name, p.found.unit),
            four_digits(p.given),
            format!("{} ± {}", sure(value, error), four_digits(error)),
            note.to_owned(),
        ]
    };
    FitPart {
        title: "Parameters".to_owned(),
        head: words(&["parameter", "given", "found ± s.e.", ""]),
        rows: told.found.parameters.iter().map(row).collect(),
        ..part()
    }
}
