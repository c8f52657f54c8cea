//! What a fit has to say, as text for a screen and as JSON for a machine.

use super::{FORMAT, Held, gaps};
use experiment::four_digits;
use identify::{
    Rig,
    fit::{Estimate, Fit, Misfit, Simulated, Way, search::End},
    rig::Kind,
};
use serde_json::{Value, json};

/// The unit of a channel of `rig`.
pub(super) fn unit(rig: &Rig, channel: &str) -> &'static str {
    let turns = Kind::of(rig.kind).is_some_and(Kind::turns);
    match channel {
        "angle" => "rad",
        "velocity" => {
            if turns {
                "rad/s"
            } else {
                "m/s"
            }
        }
        "position" | "displacement" => "m",
        "input" | "voltage" if rig.channels.contains_key("voltage") => "V",
        "input" if rig.channels.contains_key("current") => "A",
        _ => "N",
    }
}

/// How the record was simulated, in words.
pub(super) fn way(way: Way, windows: usize) -> String {
    match way {
        Way::Imposed => "the force under the measured displacement".to_owned(),
        Way::OneRun => "one run, open loop".to_owned(),
        Way::Windows => format!("{windows} windows, open loop"),
        Way::ClosedLoop => "one run, with its controller".to_owned(),
    }
}

/// How the search ended, in words.
pub(super) fn ended(end: End) -> &'static str {
    match end {
        End::Converged => "converged",
        End::Stalled => "stopped short of a minimum",
        End::OutOfPatience => "stopped after as many simulations as allowed",
        End::NoMotion => "found nothing it could simulate",
    }
}

/// The answer for a machine.
pub(super) fn as_json(rig: &Rig, fit: &Fit, held: Option<&Held>) -> Value {
    let parameters = fit.parameters.iter().map(|p| {
        json!({ "name": p.name, "given": p.given, "found": p.found, "standard_error": p.standard_error,
                "unit": rig.unit(&p.name), "moved": p.moved, "identified": p.identified,
                "interval": p.interval, "asymptotic": p.asymptotic, "bootstrap": p.bootstrap,
                "at_bound": p.at_bound })
    });
    let models = fit.models.iter().map(|m| {
        json!({ "name": m.name, "held_out_error": m.held_out_error, "trained_error": m.trained_error,
                "free": m.free })
    });
    let mut value = json!({
        "format": FORMAT,
        "method": "simulation",
        "way": way(fit.way, fit.windows),
        "status": ended(fit.end),
        "converged": fit.end == End::Converged,
        "simulations": { "plain": fit.simulations[0], "with_derivatives": fit.simulations[1] },
        "parameters": parameters.collect::<Vec<_>>(),
        "correlation": fit.correlation,
        "gap": gaps(rig, &fit.gap),
        "residuals": { "variance": fit.variance, "neighbours": fit.neighbours },
        "step_error": fit.step_error,
        "models": models.collect::<Vec<_>>(),
    });
    if let Some([before, after]) = held {
        value["holdout"] = json!(gaps(rig, &paired(before, after)));
    }
    value
}

/// The misfit of a record not fitted, before and after.
pub(super) fn paired(before: &Simulated, after: &Simulated) -> Vec<Misfit> {
    let pairs = before.gap.iter().zip(&after.gap);
    pairs.map(|(before, after)| Misfit { before: before.before, ..after.clone() }).collect()
}

/// The answer for a screen.
pub(super) fn lines(rig: &Rig, fit: &Fit, held: Option<&Held>) -> Vec<String> {
    let mut lines = vec![format!(
        "{}: {} friction, {}; {} after {} simulations and {} with derivatives",
        rig.title,
        rig.friction.name,
        way(fit.way, fit.windows),
        ended(fit.end),
        fit.simulations[0],
        fit.simulations[1]
    )];
    lines.push(String::new());
    lines.push(format!(
        "{:14} {:>11} {:>11} {:>10}  {:26} {}",
        "parameter", "given", "found", "± s.e.", "95 % interval", "unit"
    ));
    lines.extend(fit.parameters.iter().map(|p| row(rig, p)));
    lines.extend(untold(rig, fit));
    lines.extend(correlated(fit));
    lines.push(String::new());
    lines.extend(table("gap", rig, &fit.gap));
    if let Some([before, after]) = held {
        lines.extend(table("held-out record", rig, &paired(before, after)));
    }
    lines.push(format!(
        "residuals: {} of the noise's variance, correlation of neighbours {}; steps add {} standard errors",
        four_digits(fit.variance),
        four_digits(fit.neighbours),
        four_digits(fit.step_error)
    ));
    if !fit.models.is_empty() {
        lines.push(String::new());
        lines.push(format!(
            "{:22} {:>5} {:>12} {:>12}",
            "friction model", "free", "trained", "held out"
        ));
        lines.extend(fit.models.iter().map(|m| {
            let errors = [m.trained_error, m.held_out_error].map(four_digits);
            format!("{:22} {:>5} {:>12} {:>12}", m.name, m.free, errors[0], errors[1])
        }));
        lines.push(
            "(root mean square on blocks fitted and on those between, of each channel's noise)"
                .to_owned(),
        );
    }
    lines
}

/// A value with as many digits as its error makes sense of: to two digits of the error.
pub(crate) fn sure(value: f64, error: f64) -> String {
    let ratio = value.abs() / error;
    if !(error > 0.0 && error.is_finite() && ratio.is_finite() && ratio > 100.0) {
        return four_digits(value);
    }
    let digits = (exponent(ratio) + 1).clamp(0, 15);
    let short = (1e-3..1e6).contains(&value.abs());
    let [digits, decimals] =
        [digits, digits - exponent(value)].map(|n| usize::try_from(n).unwrap_or(0));
    if short { format!("{value:.decimals$}") } else { format!("{value:.digits$e}") }
}

/// The decimal exponent of a number.
fn exponent(value: f64) -> i32 {
    format!("{value:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0)
}

fn row(rig: &Rig, p: &Estimate) -> String {
    let side =
        |x: Option<f64>, none: &str| x.map_or(none.to_owned(), |x| sure(x, p.standard_error));
    let interval =
        format!("{} … {}", side(p.interval[0], "no bound"), side(p.interval[1], "no bound"));
    let [given, error] = [p.given, p.standard_error].map(four_digits);
    let found = sure(p.found, p.standard_error);
    format!(
        "{:14} {given:>11} {found:>11} {error:>10}  {interval:26} {}",
        p.name,
        rig.unit(&p.name)
    )
}

/// What the record cannot tell, parameter by parameter.
pub(super) fn untold(rig: &Rig, fit: &Fit) -> Vec<String> {
    if fit.end == End::Converged {
        return fit.parameters.iter().filter_map(|p| open(rig, p)).collect();
    }
    vec![
        "no interval is given, for this is no minimum: try more starts (--starts 8), or values nearer to what you \
         expect in the rig file"
            .to_owned(),
    ]
}

/// What the record cannot tell of a parameter.
fn open(rig: &Rig, p: &Estimate) -> Option<String> {
    if p.identified {
        return None;
    }
    let unit = rig.unit(&p.name);
    let which = match p.interval {
        [None, None] => "any value".to_owned(),
        [Some(low), None] => format!("any value above {} {unit}", four_digits(low)),
        [None, Some(high)] => format!("any value below {} {unit}", four_digits(high)),
        [Some(_), Some(_)] => return None,
    };
    Some(format!("{} is not identified by this record: {which} fits equally well", p.name))
}

/// The pairs of parameters that this record hardly tells apart.
pub(super) fn correlated(fit: &Fit) -> Vec<String> {
    let mut all = Vec::new();
    for (i, a) in fit.parameters.iter().enumerate() {
        for (j, b) in fit.parameters.iter().enumerate().skip(i + 1) {
            let r = fit.correlation[i][j];
            if r.abs() > 0.95 && a.identified && b.identified {
                all.push(format!(
                    "{} and {} trade against each other, correlation {r:.3}",
                    a.name, b.name
                ));
            }
        }
    }
    all
}

fn table(title: &str, rig: &Rig, gap: &[Misfit]) -> Vec<String> {
    let head = format!(
        "{title:18} {:>11} {:>11} {:>11} {:>10}  unit",
        "before", "after", "noise", "% after"
    );
    let rows = gap.iter().map(|g| {
        let [before, after, noise] = [g.before, g.after, g.noise].map(four_digits);
        let relative = four_digits(100.0 * g.after / g.size);
        format!(
            "  {:16} {before:>11} {after:>11} {noise:>11} {relative:>10}  {}",
            g.channel,
            unit(rig, &g.channel)
        )
    });
    std::iter::once(head).chain(rows).collect()
}

/// A simulated run beside its record, for a screen.
pub(super) fn beside(rig: &Rig, run: &Simulated) -> Vec<String> {
    let mut lines = vec![format!("{}: {}", rig.title, way(run.way, run.windows))];
    let head = format!("{:18} {:>11} {:>11} {:>10}  unit", "channel", "misfit", "noise", "%");
    lines.push(head);
    lines.extend(run.gap.iter().map(|g| {
        let [misfit, noise] = [g.after, g.noise].map(four_digits);
        let relative = four_digits(100.0 * g.after / g.size);
        format!(
            "{:18} {misfit:>11} {noise:>11} {relative:>10}  {}",
            g.channel,
            unit(rig, &g.channel)
        )
    }));
    lines
}
