//! The columns of Table 1, each by probing the model itself.

use super::{Check, Checked};
use crate::plan::{Plan, Subject};
use duhem::{DuhemForm, FrictionModel, form};

/// The type of Duhem model: `static`, `semilinear` or `generalized`.
pub(super) const DUHEM_TYPE: Check = Check {
    name: "duhem-type",
    model: "",
    expects: &["static", "semilinear", "generalized"],
    takes: &[],
    many: true,
    code: "crates/experiment/src/checks/table1.rs, duhem_type",
    run: duhem_type,
};

/// Rate dependence: `rate-independent` or `rate-dependent`.
pub(super) const RATE: Check = Check {
    name: "rate",
    model: "",
    expects: &["rate-independent", "rate-dependent"],
    takes: &[],
    many: true,
    code: "crates/experiment/src/checks/table1.rs, rate",
    run: rate,
};

/// Continuity of the right-hand side in the state: `discontinuous`, `not-lipschitz` or `lipschitz`.
pub(super) const CONTINUITY: Check = Check {
    name: "continuity",
    model: "",
    expects: &["discontinuous", "not-lipschitz", "lipschitz"],
    takes: &[],
    many: true,
    code: "crates/experiment/src/checks/table1.rs, continuity",
    run: continuity,
};

/// Where the state is probed, in units of its scale: inside, and at the kinks ±1.
const PROBES: [f64; 9] = [-1.0, -0.9, -0.5, -0.1, 0.0, 0.2, 0.6, 0.95, 1.0];
/// Departures below this are rounding.
const ROUNDING: f64 = 1e-12;

/// The models at the points of the subject.
fn models(plan: &Plan, subject: &Subject) -> Result<Vec<Box<dyn FrictionModel>>, String> {
    let study = &plan.studies[subject.study];
    subject.points.iter().map(|i| study.model_at(&study.points[*i])).collect()
}

/// ẋ of a model whose states are all at `share` of their scale.
fn x_dot(model: &dyn FrictionModel, share: f64, u_dot: f64) -> Vec<f64> {
    let x: Vec<f64> = model.scale().iter().map(|scale| share * scale).collect();
    let mut x_dot = vec![0.0; x.len()];
    model.x_dot(&x, 0.0, u_dot, &mut x_dot);
    x_dot
}

fn force(model: &dyn FrictionModel, share: f64, u_dot: f64) -> f64 {
    let x: Vec<f64> = model.scale().iter().map(|scale| share * scale).collect();
    model.force(&x, &x_dot(model, share, u_dot), 0.0, u_dot)
}

/// The findings, each once.
fn distinct(names: &[&str]) -> String {
    let mut names = names.to_vec();
    names.dedup();
    names.join(", ")
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// A model is static without a state, semilinear if ẋ/u̇ is affine in the state for each direction.
fn duhem_type(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (mut names, mut bend) = (Vec::new(), 0.0_f64);
    for model in models(plan, subject)? {
        let model = model.as_ref();
        let mut here = 0.0_f64;
        for u_dot in [1.0, -1.0] {
            // An element of Maxwell-slip does not move at zero: then relative to where it does.
            let size = match largest(x_dot(model, 0.0, u_dot)) {
                0.0 => largest(PROBES.iter().flat_map(|share| x_dot(model, *share, u_dot))),
                size => size,
            };
            let size = size.max(f64::MIN_POSITIVE);
            for share in PROBES {
                let [a, b, c] = [share - 0.3, share, share + 0.3].map(|s| x_dot(model, s, u_dot));
                let second = (0..b.len()).map(|i| (a[i] - 2.0 * b[i] + c[i]) / size);
                here = here.max(largest(second));
            }
        }
        // Equation 6 is affine in x and has u̇₊ and u̇₋ for its g; LuGre's g contains r(u̇).
        let of_6 = model.form().is_some_and(DuhemForm::rate_independent);
        names.push(match (model.states(), has_product_form(model), here < ROUNDING && of_6) {
            (0, ..) => "static",
            (_, false, _) => "no Duhem model",
            (_, true, true) => "semilinear",
            (_, true, false) => "generalized",
        });
        bend = bend.max(here);
    }
    let found = distinct(&names);
    Ok(Checked {
        holds: names.iter().all(|name| *name == subject.expect),
        value: Some(bend),
        error: Some(ROUNDING),
        unit: "1",
        how: format!(
            "largest second difference of dx/du in the state, relative to its size at zero; affine below {ROUNDING:e}, \
             semilinear if g is that of (6) besides, and ẋ the product f g of its Duhem form: found {found}"
        ),
    })
}

/// Whether ẋ is the product of f(x, u) and g(u̇) that the model gives as its Duhem form.
fn has_product_form(model: &dyn FrictionModel) -> bool {
    let Some(form) = model.form() else { return false };
    PROBES.iter().all(|share| {
        [1.0, -1.0, 0.3, -20.0].iter().all(|u_dot| {
            let x: Vec<f64> = model.scale().iter().map(|scale| share * scale).collect();
            let (ours, product) =
                (x_dot(model, *share, *u_dot), form::x_dot(form, &x, 0.0, *u_dot));
            let size = largest(ours.iter().copied()).max(f64::MIN_POSITIVE);
            largest((0..ours.len()).map(|i| (ours[i] - product[i]) / size)) < ROUNDING
        })
    })
}

/// A model is rate independent if ẋ is positively homogeneous in u̇ and F does not see the scaling.
fn rate(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let mut departure = 0.0_f64;
    for model in models(plan, subject)? {
        let model = model.as_ref();
        for share in PROBES {
            for (u_dot, stretch) in [(0.03, 2.0), (-0.03, 7.0), (1.5, 0.01), (-1.5, 1000.0)] {
                let (slow, fast) =
                    (x_dot(model, share, u_dot), x_dot(model, share, stretch * u_dot));
                let size = largest(fast.iter().copied()).max(f64::MIN_POSITIVE);
                departure = departure
                    .max(largest((0..slow.len()).map(|i| (stretch * slow[i] - fast[i]) / size)));
                let (slow, fast) =
                    (force(model, share, u_dot), force(model, share, stretch * u_dot));
                departure = departure
                    .max((slow - fast).abs() / slow.abs().max(fast.abs()).max(f64::MIN_POSITIVE));
            }
        }
    }
    let found = if departure < ROUNDING { "rate-independent" } else { "rate-dependent" };
    Ok(Checked {
        holds: found == subject.expect,
        value: Some(departure),
        error: Some(ROUNDING),
        unit: "1",
        how: format!(
            "largest relative departure of ẋ(x, λu̇) from λẋ(x, u̇), and of F, over speeds and λ from 0.01 to 1000; \
             rate independent below {ROUNDING:e}: found {found}"
        ),
    })
}

/// The two distances between which the modulus of continuity is taken, in units of the scale.
const NEAR: [f64; 2] = [1e-4, 1e-8];

/// The exponent p of the modulus of continuity, max |f(x + δ) − f(x)| ~ δ^p: 0 for a jump, 1 if Lipschitz.
fn continuity(plan: &Plan, subject: &Subject) -> Result<Checked, String> {
    let (mut names, mut extreme) = (Vec::new(), 1.0_f64);
    for model in models(plan, subject)? {
        let [far, near] = NEAR.map(|delta| modulus(model.as_ref(), delta));
        let p = (far / near).log10() / (NEAR[0] / NEAR[1]).log10();
        extreme = extreme.min(p);
        names.push(match p {
            p if p < 0.01 => "discontinuous",
            p if p < 0.99 => "not-lipschitz",
            _ => "lipschitz",
        });
    }
    Ok(Checked {
        holds: names.iter().all(|name| *name == subject.expect),
        value: Some(extreme),
        error: Some(0.01),
        unit: "1",
        how: format!(
            "exponent of the modulus of continuity between distances {:e} and {:e} of the scale, on |x| up to the \
             scale; 0 is a jump, 1 is Lipschitz: found {}",
            NEAR[0],
            NEAR[1],
            distinct(&names)
        ),
    })
}

/// max |f(x + δ) − f(x)|: of dx/du in the state, or of the force in the speed for a model without a state.
fn modulus(model: &dyn FrictionModel, delta: f64) -> f64 {
    if model.states() == 0 {
        let jump =
            |at: f64| force(model, 0.0, at + delta / 2.0) - force(model, 0.0, at - delta / 2.0);
        return largest([0.0, 0.5, -0.5].map(jump));
    }
    let mut worst = 0.0_f64;
    for u_dot in [1.0, -1.0] {
        for share in PROBES {
            let (a, b) = (
                x_dot(model, share - delta / 2.0, u_dot),
                x_dot(model, share + delta / 2.0, u_dot),
            );
            worst = worst.max(largest((0..a.len()).map(|i| a[i] - b[i])));
        }
    }
    worst
}
