//! Sentences about which friction model a record was made by.

use super::{Check, Checked};
use crate::{
    plan::{Plan, Subject},
    quantities::{
        OF_A_FIT,
        fit::{at, model},
    },
};

/// Whether the friction model that is expected has the least error on blocks of the record that were not
/// fitted, and on those that were.
pub(super) const BEST_MODEL: Check = Check {
    name: "best-model",
    code: "crates/experiment/src/checks/fit.rs, best_model",
    model: OF_A_FIT,
    expects: &["coulomb", "coulomb + viscous", "dahl", "lugre", "maxwell-slip"],
    takes: &[],
    many: false,
    run: best_model,
};

fn best_model(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let fit = at(plan, subject);
    let own = model(fit, &subject.expect)?;
    let others = || fit.found().map(|f| f.models.iter().filter(|m| m.model != own.model));
    let least = |errors: &mut dyn Iterator<Item = f64>| errors.min_by(f64::total_cmp);
    let held_out = least(&mut others()?.map(|m| m.held_out)).ok_or("no other model")?;
    let trained = least(&mut others()?.map(|m| m.trained)).ok_or("no other model")?;
    let (ratio, second) = (held_out / own.held_out, trained / own.trained);
    let list: Vec<String> = fit
        .found()?
        .models
        .iter()
        .map(|m| format!("{} {:.2} ({:.2})", m.model, m.held_out, m.trained))
        .collect();
    Ok(Checked {
        holds: ratio > 1.0 && second > 1.0,
        value: Some(ratio),
        error: Some((ratio - second).abs()),
        unit: "1",
        how: format!(
            "half of the blocks of the record fitted, the others held out; root mean square of the residuals in \
             units of the noise, held out (fitted): {}; the number is the next best model's held-out error over \
             that of {}, its error the difference to the same ratio on the fitted blocks; holds if both ratios \
             are above 1",
            list.join("; "),
            own.model
        ),
    })
}
