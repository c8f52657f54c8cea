//! Which of the six answers is given.

use super::{
    answer::{MORE, NEARLY_ALL, NOISY},
    exchange::kind_of,
    given::off_by,
    named::MOST,
};
use crate::{
    decide::shrink,
    verdict::{Found, Moved, Verdict},
};

/// What is left of more than that is a part of what was missing, and the rest is not in the library, if so much of the
/// excess is gone, and so much of the logarithm of the mean squared residual; else the name only resembles what is
/// missing. Wrong names took away up to 0.965 of the excess.
const EXPLAINED: f64 = 0.97;
const NAMED: f64 = 0.5;

/// The same of a joint: no other thing looked like one so far, and its own minimum may not be found.
const JOINED: f64 = 0.9;

/// A hundred times above the noise of the sensors no model of a real drive comes down to it, and what takes away half
/// of the excess is a part of what is missing.
const NO_NOISE: f64 = 1e4;

/// A parameter of another friction is off by more than this, in its logarithm: that of a model put together by rule of thumb
/// may be a fifth off and still be the same friction's.
const ANOTHER: f64 = 0.3;

/// Whether effects are names only together with a friction that is another one: with two of its parameters far off as well,
/// or with one beside several effects. All seven such answers to 400 records were wrong. Springs that slip take over
/// the friction's level and stiffness by right.
fn rebuilds(effects: &[Found], parameters: &[Moved]) -> bool {
    let friction = |name: &str| {
        ["f_c", "f_s", "v_s"].contains(&name)
            || ["sigma", "k[", "delta["].iter().any(|of| name.starts_with(of))
    };
    let far = |p: &Moved| off_by(p.found.value, p.given) > ANOTHER;
    let another = |p: &&Moved| p.moved && friction(&p.found.name) && far(p);
    let moved = parameters.iter().filter(another).count();
    let slips = |effect: &Found| ["maxwell_slip", "presliding"].contains(&effect.name);
    // Of several effects one wrong parameter is enough.
    moved > usize::from(effects.len() < 2) && !effects.iter().any(slips)
}

/// The answer to a record of which the given, the refitted and the last model leave so much [1], and the last two so much
/// but for a few blocks [1]; whether a few blocks in a row are far off, and whether what is left hangs together.
pub(super) fn verdict(
    effects: &[Found],
    parameters: &[Moved],
    ([before, refit, last], mostly): ([f64; 3], [f64; 2]),
    (struck, hangs): (bool, bool),
) -> Verdict {
    // A few blocks that went astray say little.
    let more = |mostly: f64| mostly > MORE;
    if effects.is_empty() {
        if struck || more(mostly[0]) {
            return Verdict::NotInLibrary;
        }
        let wrong = parameters.iter().any(|p| p.moved) && before > refit * 1.05;
        return if wrong { Verdict::Parameter } else { Verdict::NothingMissing };
    }
    // What takes away a part of something else is not its name.
    let named = (refit / last).ln() / refit.ln();
    let real = refit > NO_NOISE && effects.iter().any(|effect| effect.shrink > MOST);
    if rebuilds(effects, parameters) && !real {
        return Verdict::NotInLibrary;
    }
    // Noise that is not white leaves more than the floor, the same whatever moves; what takes away all but a hundredth of
    // the excess is no part of something else.
    let noisy = mostly[1] < NOISY && shrink(refit, last) > NEARLY_ALL;
    if !more(mostly[1]) && !hangs || noisy && !struck {
        return Verdict::Effect;
    }
    // Two right names come down to the floor, but for a joint, whose own minimum may not be found: what leaves more than
    // several is a series of what is not in the library.
    let joint = |effect: &Found| kind_of(effect.name).is_some_and(|kind| !kind.tried().is_empty());
    let joined = effects.iter().any(joint);
    let series = effects.len() > 1 && !joined;
    let explained = if joined { JOINED } else { EXPLAINED };
    let part = shrink(refit, last) > explained && named > NAMED && !series;
    if part || real { Verdict::Partial } else { Verdict::NotInLibrary }
}

#[cfg(test)]
mod tests {
    use super::{Found, Moved, Verdict, verdict};
    use crate::{verdict::Value, walk::made};

    #[test]
    fn what_leaves_plenty_is_something_though_no_map_shows_where() {
        let of =
            |level: f64| verdict(&[], &[], ([90.0, level, level], [level, level]), (false, false));
        assert_eq!(of(1.3), Verdict::NotInLibrary);
        assert_eq!(of(1.1), Verdict::NothingMissing);
    }

    #[test]
    fn what_a_name_leaves_of_a_small_excess_shows_that_it_only_resembles_it() {
        let hanging = |refit: f64, last: f64, hangs: bool| {
            let levels = [900.0, refit, last];
            let found = [made::found("friction_drift")];
            verdict(&found, &[], (levels, [refit, last]), (false, hangs))
        };
        let of = |refit: f64, last: f64| hanging(refit, last, false);
        // Two wrong names, of a soft gear and of a sensor that creeps, and three right ones.
        for (refit, last) in [(6.07, 1.33), (4.21, 1.24)] {
            assert_eq!(of(refit, last), Verdict::NotInLibrary, "{last} of {refit}");
        }
        for (refit, last) in [(379.0, 1.12), (8.43, 0.88), (4.46, 1.04)] {
            assert_eq!(of(refit, last), Verdict::Effect, "{last} of {refit}");
        }
        // Noise that is not white leaves a little of a lot.
        assert_eq!(of(94.0, 1.45), Verdict::Effect);
        assert_eq!(of(94.0, 1.7), Verdict::Partial);
        // What hangs together is no noise, however little it is: a name that leaves it explains no more than a part.
        assert_eq!(hanging(3.67, 1.17, true), Verdict::NotInLibrary);
        assert_eq!(hanging(40.0, 1.17, true), Verdict::Effect, "but for a hundredth");
        assert_eq!(hanging(7.0, 1.17, true), Verdict::Partial);
        // Much is left of much more.
        assert_eq!(of(9000.0, 5.0), Verdict::Partial);
    }
    #[test]
    fn several_names_that_leave_something_are_a_series() {
        let of = |names: &[&'static str]| {
            let found: Vec<Found> = names.iter().map(|name| made::found(name)).collect();
            verdict(&found, &[], ([900.0, 9000.0, 5.0], [9000.0, 5.0]), (false, false))
        };
        assert_eq!(of(&["cogging"]), Verdict::Partial);
        assert_eq!(of(&["cogging", "maxwell_slip"]), Verdict::NotInLibrary);
        assert_eq!(of(&["backlash", "input_delay"]), Verdict::Partial, "a joint's own minimum");
        let part = |name: &'static str| {
            let levels = ([900.0, 9.8, 1.5], [9.8, 1.5]);
            verdict(&[made::found(name)], &[], levels, (false, false))
        };
        assert_eq!(part("backlash"), Verdict::Partial);
        assert_eq!(part("cogging"), Verdict::NotInLibrary);
    }

    #[test]
    fn a_name_that_asks_for_another_friction_is_none() {
        let by = |times: f64, names: &[&'static str], moved: &[&str]| {
            let found: Vec<Found> = names.iter().map(|name| made::found(name)).collect();
            let one = |name: &&str| {
                let (name, unit) = ((*name).to_owned(), "");
                let found = Value { name, value: times, standard_error: 0.01, unit };
                Moved { given: 1.0, found, moved: true }
            };
            let moved: Vec<Moved> = moved.iter().map(one).collect();
            verdict(&found, &moved, ([90.0, 9.0, 1.0], [9.0, 1.0]), (false, false))
        };
        let of = |names: &[&'static str], moved: &[&str]| by(2.0, names, moved);
        let none = Verdict::NotInLibrary;
        assert_eq!(of(&["position_friction"], &["f_c", "sigma_2"]), none);
        // A friction that is known to a fifth is the same one.
        assert_eq!(by(1.2, &["position_friction"], &["f_c", "sigma_2"]), Verdict::Effect);
        assert_eq!(by(0.7, &["position_friction"], &["f_c", "sigma_2"]), none);
        assert_eq!(of(&["position_friction"], &["f_c", "mass"]), Verdict::Effect);
        assert_eq!(of(&["maxwell_slip"], &["f_c", "sigma"]), Verdict::Effect, "it takes over");
        assert_eq!(of(&["maxwell_slip", "stribeck"], &["sigma"]), Verdict::Effect);
        assert_eq!(of(&["gravity_unbalance", "cogging"], &["k[1]"]), none);
        assert_eq!(of(&["gravity_unbalance", "cogging"], &["k_1", "f_10"]), Verdict::Effect);
    }
}
