//! The figures of an experiment, checked.

use super::{Known, Study, panel};
use crate::{
    error::{Complaint, one_of},
    spec::{FigureSpec, PanelSpec, Spec},
};
use identify::{Recording, Rig};

/// What a panel may show: the vertical quantity, then the horizontal one. Of a plant, `drive` is the force
/// (or torque) that its input makes.
pub(crate) const SHOWS: [&str; 10] = [
    "force-displacement",
    "force-velocity",
    "force-time",
    "displacement-time",
    "velocity-time",
    "displacement-drive",
    "drive-time",
    "steady-force",
    "rest-swings",
    "step-time",
];

/// What a panel may show of a fit: besides what a plant does its input as it was recorded, its load cells, and
/// the speed of its motor.
pub(crate) const SHOWS_OF_FITS: [&str; 7] = [
    "displacement-time",
    "velocity-time",
    "motor-speed-time",
    "input-time",
    "drive-time",
    "displacement-drive",
    "loads-time",
];

/// What a panel may show of a search besides: the force that the model lacks, and its floor.
pub(crate) const RESIDUAL: &str = "residual-time";

/// And the loop in the blocks of the search, each from its own start: in one run a wrong model may drift away.
pub(crate) const BY_BLOCKS: &str = "displacement-drive-by-blocks";

/// The figures, their studies, values and panels looked up.
pub(super) fn check(
    spec: &Spec,
    all: Known<'_>,
    kinds: &[&str],
) -> Result<Vec<FigureSpec>, Complaint> {
    let studies = all.studies;
    let study = |name: &String, key: String| {
        let known = studies.iter().map(|s| s.name.as_str());
        studies
            .iter()
            .find(|s| s.name == *name)
            .ok_or_else(|| Complaint::new(key, format!("`{name}`"), one_of(name, known)))
    };
    for (i, figure) in spec.figure.iter().enumerate() {
        let key = |k: &str| format!("figure[{i}].{k}");
        for id in crate::judge::placeholders(&figure.caption) {
            super::judged::known(spec, id).map_err(|c| c.under(&key("caption")))?;
        }
        if !kinds.contains(&figure.kind.as_str()) {
            let expected = one_of(&figure.kind, kinds.iter().copied());
            return Err(Complaint::new(key("kind"), format!("`{}`", figure.kind), expected));
        }
        if let Some(recorded) = figure.study.as_ref().and_then(|name| Recorded::find(name, all)) {
            for (p, panel) in figure.panel.iter().enumerate() {
                of_record(panel, &recorded)
                    .map_err(|c| c.under(&format!("figure[{i}].panel[{p}]")))?;
            }
            continue;
        }
        if let Some(name) = &figure.study {
            study(name, key("study"))?
                .selected(&figure.select)
                .map_err(|c| c.under(&key("select")))?;
        }
        if let (Some(value), Some(name)) = (figure.value, &figure.study) {
            let study = study(name, key("study"))?;
            if !study.steps.iter().chain(&study.rtol).any(|v| *v == value) {
                let expected = format!("a step or a tolerance of study `{name}`");
                return Err(Complaint::new(key("value"), format!("{value:e}"), expected));
            }
        }
        super::methods::named(&figure.solvers).map_err(|c| c.under(&format!("figure[{i}]")))?;
        for (p, panel) in figure.panel.iter().enumerate() {
            let key = |k: &str| format!("figure[{i}].panel[{p}].{k}");
            if let Some(name) = &panel.study {
                study(name, key("study"))?;
            } else if figure.study.is_none() {
                return Err(Complaint::new(key("study"), "none", "a study, here or in the figure"));
            }
            if !SHOWS.contains(&panel.show.as_str()) {
                let expected = one_of(&panel.show, SHOWS);
                return Err(Complaint::new(key("show"), format!("`{}`", panel.show), expected));
            }
            let under = |c: Complaint| c.under(&format!("figure[{i}].panel[{p}]"));
            panel::check(panel, figure, studies).map_err(under)?;
            shown(panel, figure, studies).map_err(under)?;
        }
    }
    Ok(spec.figure.clone())
}

/// A record with the rig of a fit or a search.
struct Recorded<'a> {
    recording: &'a Recording,
    rig: &'a Rig,
    /// The name of what was found.
    found: &'static str,
}

impl<'a> Recorded<'a> {
    fn find(name: &str, all: Known<'a>) -> Option<Self> {
        let fit = all.fits.iter().find(|f| f.name == name);
        let fit = fit.map(|f| Self { recording: &f.recording, rig: &f.rig, found: "fitted" });
        let search = || all.discoveries.iter().find(|d| d.name == name).map(|d| &d.source);
        fit.or_else(|| {
            search().map(|s| Self { recording: &s.recording, rig: &s.rig, found: "found" })
        })
    }
}

/// What a fit or a search can show: its own record and simulations, and nothing of a study.
fn of_record(panel: &PanelSpec, of: &Recorded<'_>) -> Result<(), Complaint> {
    let searched = of.found == "found";
    let more = if searched { &[RESIDUAL, BY_BLOCKS][..] } else { &[] };
    if !SHOWS_OF_FITS.iter().chain(more).any(|known| *known == panel.show) {
        let expected = one_of(&panel.show, SHOWS_OF_FITS.iter().chain(more).copied());
        return Err(Complaint::new("show", format!("`{}`", panel.show), expected));
    }
    let has = |channel: &str| of.recording.channels.contains_key(channel);
    let there = match panel.show.as_str() {
        "loads-time" => has("force_1") && has("force_2"),
        "velocity-time" => has("velocity"),
        "motor-speed-time" => has("velocity") && of.rig.value("gear_ratio").is_some(),
        _ => true,
    };
    if !there {
        let found = format!("`{}` of a record without it", panel.show);
        return Err(Complaint::new("show", found, "a channel of the record"));
    }
    let known = ["record", "given", of.found];
    if let Some((i, of)) = panel.of.iter().enumerate().find(|(_, of)| !known.contains(&of.as_str()))
    {
        return Err(Complaint::new(format!("of[{i}]"), format!("`{of}`"), one_of(of, known)));
    }
    let foreign = [
        ("study", panel.study.is_some()),
        ("also", !panel.also.is_empty()),
        ("runs", !panel.runs.is_empty()),
        ("from", !panel.from.is_empty()),
    ];
    match foreign.iter().find(|(_, given)| *given) {
        Some((key, _)) => {
            Err(Complaint::new(*key, "a value", "none in a panel of a fit or a search"))
        }
        None => between(panel, true),
    }
}

/// Whether a panel's stretch of time, if it has one, is one.
fn between(panel: &PanelSpec, timed: bool) -> Result<(), Complaint> {
    match panel.between {
        Some([from, to]) if !(timed && from < to) => {
            let expected = "a time and a later one [s], in a panel of a plant or a fit";
            Err(Complaint::new("between", format!("[{from}, {to}]"), expected))
        }
        _ => Ok(()),
    }
}

/// Whether what a panel shows is there to be shown: of a plant its histories, else forces.
fn shown(panel: &PanelSpec, figure: &FigureSpec, studies: &[Study]) -> Result<(), Complaint> {
    let name = panel.study.as_ref().or(figure.study.as_ref());
    let plant = studies.iter().any(|s| Some(&s.name) == name && s.plant.is_some());
    let bare = ["step-time", "steady-force"].contains(&panel.show.as_str());
    let imposed = panel.show.starts_with("force-") && panel.show != "force-time";
    if !plant && !imposed && !bare {
        let found = format!("`{}` of an imposed motion", panel.show);
        let expected = "`force-displacement` or `force-velocity`, or a study with a plant";
        return Err(Complaint::new("show", found, expected));
    }
    if !plant && !bare && !["settled", "from-start"].contains(&panel.from.as_str()) {
        let expected = one_of(&panel.from, ["settled", "from-start"]);
        return Err(Complaint::new("from", format!("`{}`", panel.from), expected));
    }
    for (key, given) in [("also", !panel.also.is_empty()), ("runs", !panel.runs.is_empty())] {
        if plant && given {
            return Err(Complaint::new(key, "a list", "none in a panel of a plant"));
        }
    }
    if panel.centred || !panel.of.is_empty() {
        return Err(Complaint::new("of", "a value", "none but in a panel of a fit"));
    }
    between(panel, plant)
}
