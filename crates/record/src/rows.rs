//! One type per table; the header of each column carries its unit.

use crate::table::table;

table! {
    /// What there is to say of a whole experiment: `title`, `paper`, `text`, `command`, `spec sha256`, `version …`.
    pub struct AboutRow {
        /// What is told.
        key: String = "key",
        /// The telling.
        value: String = "value",
    }
}

table! {
    /// One study: a model, swept over parameters, under one input, with a set of solvers and controls.
    pub struct StudyRow {
        /// Its name in the experiment.
        study: String = "study",
        /// Its title.
        title: String = "title",
        /// The model with its parameters, as a reader would write them.
        model: String = "model",
        /// The input, as a reader would write it.
        input: String = "input",
        /// The physics in a few sentences, with the equation.
        text: String = "text",
        /// The name of the exact answer errors are judged by; empty if none is run.
        reference: String = "reference",
        /// What errors are errors of, as `force F` or `displacement q`; empty if that is not said.
        response: String = "response",
        /// The period of the input.
        period: f64 = "period [s]",
        /// The end of the time span; it starts at 0.
        span: f64 = "span [s]",
        /// The most evaluations a case may use.
        budget: u64 = "budget",
        /// The largest rounding error of the reference, relative to its largest value.
        reference_error: Option<f64> = "reference error [1]",
    }
}

table! {
    /// One case: one cell of model × input × solver × control × corners, and how it ended.
    /// Errors are relative: the difference from the reference over the reference's largest absolute value.
    pub struct CaseRow {
        /// The study.
        study: String = "study",
        /// The point of the sweep, as in `gamma=0.25`; empty without a sweep.
        point: String = "point",
        /// The solver's name in the list.
        solver: String = "solver",
        /// `own`, `ode_solvers` or `diffsol`.
        library: String = "library",
        /// `step`, `rtol`, or `none` for an exact method.
        control: String = "control",
        /// Steps per period, or the relative tolerance; 0 without a control.
        value: f64 = "value",
        /// `restart` or `ignore`.
        corners: String = "corners",
        /// `solved`, or the failure's name.
        status: String = "status",
        /// What the solver said of its failure; empty if it solved or the name says all.
        detail: String = "detail",
        /// The last good time, as a share of the span: 1 if solved.
        reached: f64 = "reached [1]",
        /// The error at the last good time.
        error_final: Option<f64> = "final [1]",
        /// The largest error over all accepted steps.
        error_max: Option<f64> = "max [1]",
        /// The root of the mean square error over time.
        error_l2: Option<f64> = "l2 [1]",
        /// The largest error outside a neighbourhood of the kinks.
        error_away: Option<f64> = "away from kinks [1]",
        /// Matching decimal digits: -log10 of the largest error.
        digits: Option<f64> = "digits",
        /// The slope of the largest error from the next coarser control to this one, as in [`OrderRow`];
        /// none for the coarsest, at round-off, and next to a failure.
        order: Option<f64> = "order",
        /// Calls of the right-hand side; of an exact method the updates of its closed form.
        evaluations: u64 = "evaluations",
        /// Calls of the Jacobian.
        jacobians: u64 = "jacobians",
        /// Accepted steps.
        accepted: u64 = "accepted",
        /// Rejected steps, where the solver tells.
        rejected: Option<u64> = "rejected",
        /// Why its numbers cannot be expected to come out the same on another processor; empty if they can.
        irreproducible: String = "irreproducible",
        /// Whether not even its status can: it runs against its budget on the edge.
        any_status: bool = "any status",
    }
}

table! {
    /// The observed order of one solver over its controls.
    pub struct OrderRow {
        /// The study.
        study: String = "study",
        /// The point of the sweep.
        point: String = "point",
        /// The solver.
        solver: String = "solver",
        /// The library.
        library: String = "library",
        /// The order it declares; none for a variable-order method.
        declared: Option<u64> = "declared",
        /// `restart` or `ignore`.
        corners: String = "corners",
        /// What the slope is taken against: `steps` for fixed steps, `rtol` for adaptive ones.
        against: String = "against",
        /// The slope of log error (max norm): against steps the observed order, against rtol 1 if the error
        /// follows the tolerance.
        order: Option<f64> = "order",
        /// How many cases it was fitted to, above round-off.
        points: u64 = "points",
        /// How many of the controls failed.
        failed: u64 = "failed",
        /// The same as in [`CaseRow`].
        irreproducible: String = "irreproducible",
    }
}

table! {
    /// One measured quantity.
    pub struct MeasureRow {
        /// Its id, as `fig01.gamma=1.area`.
        id: String = "id",
        /// What it is, in words.
        what: String = "what",
        /// The value.
        value: f64 = "value",
        /// An honest bound of its error, in the same unit.
        error: f64 = "error",
        /// The unit; `1` for none.
        unit: String = "unit",
        /// How the value was obtained.
        method: String = "method",
        /// The second, independent way that the error is measured against.
        second: String = "second way",
        /// Where the code is: file and function.
        code: String = "code",
    }
}

table! {
    /// One sentence of the paper and what became of it.
    pub struct ClaimRow {
        /// Its id, as `dahl.energy`.
        id: String = "id",
        /// Where the paper says it.
        place: String = "place",
        /// What it says.
        says: String = "says",
        /// The printed number.
        printed: Option<f64> = "printed",
        /// How many significant digits are printed.
        digits: Option<u64> = "printed digits",
        /// Ours.
        ours: Option<f64> = "ours",
        /// A bound of our error.
        error: Option<f64> = "error",
        /// The unit of both.
        unit: String = "unit",
        /// Whether the sentence holds; none where that cannot be said.
        holds: Option<bool> = "holds",
        /// `reproduced`, `contradicted`, `under-specified` or `qualitative`.
        verdict: String = "verdict",
        /// The reason, in one or two sentences.
        why: String = "why",
        /// How it was decided: what was computed and within which tolerance.
        how: String = "how",
        /// The figure that shows it; empty if none does.
        figure: String = "figure",
        /// Where the code is: file and function.
        code: String = "code",
    }
}

table! {
    /// One figure to be drawn.
    pub struct FigureRow {
        /// Its name, and its file's.
        figure: String = "figure",
        /// The kind, as listed in the report's figures.
        kind: String = "kind",
        /// The study whose cases it shows; empty if it only shows curves.
        study: String = "study",
        /// The title.
        title: String = "title",
        /// For a reader who cannot see it.
        description: String = "description",
        /// What to see in it.
        caption: String = "caption",
        /// Points of the sweep to show, separated by `;`; empty for all.
        points: String = "points",
        /// Solvers to show, separated by `;`; empty for all that fit the kind.
        solvers: String = "solvers",
        /// The one control value to show, for kinds that need one.
        value: Option<f64> = "value",
        /// Whether it stands aside: for a reader who wants more than the paper's own figures.
        aside: bool = "aside",
    }
}

table! {
    /// One panel of a figure of curves: its axes.
    pub struct PanelRow {
        /// The figure.
        figure: String = "figure",
        /// The panel's title.
        panel: String = "panel",
        /// The label of the horizontal axis, with unit.
        x: String = "x",
        /// The label of the vertical axis, with unit.
        y: String = "y",
        /// The ends of the axes.
        x_min: f64 = "x min",
        /// See `x_min`.
        x_max: f64 = "x max",
        /// See `x_min`.
        y_min: f64 = "y min",
        /// See `x_min`.
        y_max: f64 = "y max",
        /// Whether the horizontal axis is logarithmic.
        x_log: bool = "x log",
        /// Whether the vertical axis is logarithmic.
        y_log: bool = "y log",
    }
}

table! {
    /// One point of a curve.
    pub struct CurveRow {
        /// The figure.
        figure: String = "figure",
        /// The panel.
        panel: String = "panel",
        /// The curve's name, as its label is written.
        series: String = "series",
        /// Horizontal.
        x: f64 = "x",
        /// Vertical.
        y: f64 = "y",
    }
}

table! {
    /// One fit of a rig's free parameters to a record.
    pub struct FitRow {
        /// Its name in the experiment.
        fit: String = "fit",
        /// Its title.
        title: String = "title",
        /// What is to be known of it, for the report.
        text: String = "text",
        /// The record, as the experiment names it.
        record: String = "record",
        /// How many samples it has.
        samples: u64 = "samples",
        /// The rig, as its file titles it.
        rig: String = "rig",
        /// How the record was simulated, in words.
        way: String = "way",
        /// In how many windows.
        windows: u64 = "windows",
        /// How the search ended, in words.
        end: String = "end",
        /// How many simulations of the whole record the search took.
        simulations: u64 = "simulations",
        /// The variance of the residuals in units of the noise, 1 where model and noise are right.
        variance: f64 = "variance [1]",
        /// The correlation of neighbouring residuals.
        neighbours: f64 = "correlation of neighbours [1]",
        /// The largest change of a parameter, in standard errors, when the steps are ten times more accurate.
        step_error: f64 = "error of the steps [standard errors]",
    }
}

table! {
    /// One fitted parameter.
    pub struct ParameterRow {
        /// The fit.
        fit: String = "fit",
        /// The parameter.
        parameter: String = "parameter",
        /// Its unit; `1` for none.
        unit: String = "unit",
        /// Its nominal value, as the rig file has it.
        given: f64 = "given",
        /// Its fitted value.
        found: f64 = "found",
        /// Its standard error.
        standard_error: f64 = "standard error",
        /// The lower end of its 95 % interval by profile likelihood; none where no bound was found.
        low: Option<f64> = "low",
        /// The upper end.
        high: Option<f64> = "high",
        /// Whether the record identifies it: the interval is closed on both sides.
        identified: bool = "identified",
        /// The truth of a synthetic record; none of a measured one.
        truth: Option<f64> = "truth",
    }
}

table! {
    /// One friction model, fitted to half of the blocks of a record and judged on the others.
    pub struct ModelRow {
        /// The fit.
        fit: String = "fit",
        /// The friction model.
        model: String = "model",
        /// How many parameters were free.
        free: u64 = "free",
        /// Root mean square of the residuals on the blocks it was fitted to, of the channels' noise.
        trained: f64 = "trained error [1]",
        /// The same on the blocks held out.
        held_out: f64 = "held-out error [1]",
    }
}

table! {
    /// The misfit of one channel.
    pub struct MisfitRow {
        /// The fit.
        fit: String = "fit",
        /// The channel.
        channel: String = "channel",
        /// Its unit.
        unit: String = "unit",
        /// Root mean square of the residual with the nominal parameters.
        before: f64 = "before",
        /// With the fitted ones.
        after: f64 = "after",
        /// The noise that the channel itself shows.
        noise: f64 = "noise",
    }
}
