//! What is given and not free, but may be a little off.

use super::{Board, Fitted};
use identify::{Rig, fit::binding};
use nalgebra::DVector;

/// How much a nominal value may be off that is not free, in its logarithm.
pub(super) const LOOSE: f64 = 0.02;

/// So many times as far it is no little.
const STRAYED: f64 = 5.0;

/// Of two springs' pulls, which are off each by itself, so many times as far is none.
const DRAWN: f64 = 3.5;

/// A mass is told against what drives it: where both are off as far as nominal values are, it is so by twice that, and where
/// it is by more and nothing else is missing, more moves.
const HEAVIER: f64 = 2.6;

/// The mass of a plant of which one value says what drives it, or none; that of a pendulum hangs on three.
const MASSES: [(&str, &str); 3] =
    [("drum", "inertia"), ("axis", "inertia"), ("mass-spring", "mass")];

/// What a model that lacks nothing leaves [1].
const NOTHING: f64 = 1.1;

/// The constant force on the side of the friction.
pub(crate) const OFFSET: &str = "offset";

/// What a unit of the input gives, plant by plant.
pub(super) const DRIVES: &[&str] = &["motor_constant", "gain", "torque_constant", "resistance"];

/// The forces of a drum's springs at rest, where they are seen.
const PULLS: [&str; 2] = ["f_10", "f_20"];

/// Pulls that are given as the same differ if they do by so many standard errors.
const DIFFER: f64 = 10.0;

/// Whether load cells show the springs' forces.
fn has_cells(rig: &Rig) -> bool {
    rig.channels.contains_key("force_1")
}

/// The torque of a drum's two prestressed springs, if both pulled the same way and nothing shows it [N·m]; none where the rig
/// file gives both as one number, which says that they pull alike.
pub(super) fn prestress(rig: &Rig) -> f64 {
    let value = |key: &str| rig.value(key).unwrap_or(0.0);
    let pulls = PULLS.map(value);
    if rig.kind != "drum" || is_free(rig, PULLS[0]) || has_cells(rig) || pulls[0] == pulls[1] {
        return 0.0;
    }
    pulls[0].hypot(pulls[1]) * value("radius")
}

/// The parameters of a plant that are not free but may be a little off. One scale of forces stays as it is.
pub(crate) fn loose(rig: &Rig) -> Vec<(String, f64)> {
    let keys: &[&str] = match rig.kind {
        // Without load cells the springs' torque hangs on r²k alone.
        "drum" if has_cells(rig) => &["inertia", "radius", "k_1", "k_2"],
        "drum" => &["inertia", "k_1", "k_2"],
        "mass-spring" => &["mass", "stiffness"],
        "axis" => &["inertia"],
        // What a motor's back-EMF brakes with cannot be told from viscous friction, and stands for it.
        "pendulum" if !is_free(rig, "sigma_2") => &["inertia", "mass", "torque_constant"],
        "pendulum" => &["inertia", "mass"],
        _ => &[],
    };
    // Where what a drive gives is free as well, what is given of the plant is the scale.
    let driven = DRIVES.iter().any(|key| is_free(rig, key));
    let keys = if driven { &[] } else { keys };
    let pulls = if rig.kind == "drum" && has_cells(rig) { &PULLS[..] } else { &[] };
    let fixed = keys.iter().chain(pulls).filter(|key| !is_free(rig, key));
    let some =
        fixed.filter_map(|key| Some(((*key).to_owned(), rig.value(key).filter(|v| *v > 0.0)?)));
    let mut all: Vec<(String, f64)> = some.collect();
    // Springs that are drawn a little otherwise than said push to one side.
    if prestress(rig) > 0.0 && !is_free(rig, OFFSET) {
        all.push((OFFSET.to_owned(), rig.value(OFFSET).unwrap_or(0.0)));
    }
    all
}

/// What is [`loose`], and what is free as well, where it is told and has a sign; f_S is told by its distance from f_C,
/// which may be small.
pub(crate) fn tied(rig: &Rig) -> Vec<(String, f64)> {
    let given = |name: &String| Some((name.clone(), rig.value(name).filter(|v| *v > 0.0)?));
    let told = |name: &&String| !name.contains('.') && *name != OFFSET && *name != "f_s";
    let free = rig.free.iter().filter(told);
    loose(rig).into_iter().chain(free.filter_map(given)).collect()
}

/// Whether a parameter of `rig` is free.
fn is_free(rig: &Rig, key: &str) -> bool {
    rig.free.iter().any(|free| free == key)
}

/// `rig` with what is `loose` free as well.
pub(crate) fn loosened(rig: &Rig, loose: &[(String, f64)]) -> Rig {
    let more = loose.iter().map(|(name, _)| name.clone());
    Rig { free: rig.free.iter().cloned().chain(more).collect(), ..rig.clone() }
}

/// Whether a value is further from the one `given` than what is a little off.
pub(crate) fn strays(value: f64, given: f64) -> bool {
    strays_by(value, given, STRAYED)
}

/// The same where so many times a little is far.
fn strays_by(value: f64, given: f64, far: f64) -> bool {
    value <= 0.0 || (value / given).ln().abs() > far * LOOSE
}

/// Whether a value of `rig` that was held near the one `given` is far from it.
fn away(rig: &Rig, name: &str, given: f64) -> bool {
    let value = rig.value(name).unwrap_or(given);
    match name {
        OFFSET => (value - given).abs() > DRAWN * LOOSE * prestress(rig),
        pull if PULLS.contains(&pull) => strays_by(value, given, DRAWN),
        _ => strays(value, given),
    }
}

/// Whether two springs' pulls went further apart from those given than two that are off each by itself, though neither alone
/// need be far off.
fn apart(rig: &Rig, loose: &[(String, f64)]) -> bool {
    let went = PULLS.map(|pull| {
        let given = loose.iter().find(|(name, _)| name == pull).map(|(_, given)| *given);
        Some((rig.value(pull)? / given?).ln())
    });
    let [Some(one), Some(other)] = went else { return false };
    (one - other).abs() > 2.0_f64.sqrt() * DRAWN * LOOSE
}

/// Which of those that were held near the values given went far from them in `rig`. Of two springs' pulls one is enough: that
/// these differ is one effect, and their mean may still be a little off.
fn far(rig: &Rig, loose: &[(String, f64)]) -> Vec<String> {
    let away = |(name, given): &&(String, f64)| away(rig, name, *given);
    let all: Vec<String> = loose.iter().filter(away).map(|(name, _)| name.clone()).collect();
    let pulls = all.iter().filter(|name| PULLS.contains(&name.as_str())).count();
    if pulls == 2 || pulls == 0 && apart(rig, loose) { one_pull(all) } else { all }
}

/// `all` with the second spring's pull for both.
fn one_pull(mut all: Vec<String>) -> Vec<String> {
    all.retain(|name| !PULLS.contains(&name.as_str()));
    all.push(PULLS[1].to_owned());
    all
}

impl Board<'_> {
    /// The parameters that were held near their given values and went far from them all the same.
    pub(crate) fn strayed(&self, fitted: &Fitted) -> Vec<String> {
        let all = far(&fitted.rig, &self.loose);
        let given = |name: &str| self.loose.iter().find(|(own, _)| own == name).map(|own| own.1);
        let [one, other] = PULLS.map(given);
        let same = one.is_some() && one == other;
        let differ = || self.told_apart(fitted).is_some_and(|(t, _)| t > DIFFER);
        if same && differ() { one_pull(all) } else { all }
    }

    /// The same of the nominal model alone: where it lacks nothing with a mass that is off by more than nominal values are, that
    /// is what the model lacks.
    pub(crate) fn strayed_alone(&self, refit: &Fitted) -> Vec<String> {
        let mut all = self.strayed(refit);
        let off = |name: &str, given: f64| {
            let value = refit.rig.value(name).unwrap_or(given);
            MASSES.contains(&(refit.rig.kind, name)) && strays_by(value, given, HEAVIER)
        };
        if all.is_empty() && self.trained_level(refit) < NOTHING {
            let heavier = self.loose.iter().filter(|(name, given)| off(name, *given));
            all.extend(heavier.map(|(name, _)| name.clone()));
        }
        all
    }

    /// The model `held`, in which something is not free that was loose in `refit`: with what is free as in that one if it lacked
    /// nothing, for then it is as it should be.
    pub(crate) fn all_but(&self, refit: &Fitted, held: &Rig) -> Rig {
        let mut rig = held.clone();
        if self.trained_level(refit) < NOTHING {
            for name in held.free.iter().filter(|name| !self.holds(name)) {
                let value = refit.rig.value(name).unwrap_or(f64::NAN);
                binding::set(&mut rig, name, value);
            }
        }
        rig
    }

    /// The one pull of two that is still loose where the other was held because they differ, if it differs from that one all the
    /// same and the load cells leave nothing with it: then it is the one that is not as it was given.
    pub(crate) fn lone_pull(&self, refit: &Fitted) -> Option<String> {
        let mut loose = self.loose.iter().filter(|(name, _)| PULLS.contains(&name.as_str()));
        let (Some((name, given)), None) = (loose.next(), loose.next()) else { return None };
        let same = PULLS.iter().all(|pull| *pull == name || refit.rig.value(pull) == Some(*given));
        let differs =
            || self.told_apart(refit).is_some_and(|(t, left)| t > DIFFER && left < NOTHING);
        (same && differs()).then(|| name.clone())
    }

    /// By how many standard errors the load cells tell two springs' pulls apart, one of which may not be free, and what they leave
    /// in the mean square [1]; none where that is not told. Two values that are a little off are so each by itself, but a rig
    /// file in which they are the same says that they are.
    fn told_apart(&self, fitted: &Fitted) -> Option<(f64, f64)> {
        let problem = self.problem(&fitted.rig, |_| true).ok()?;
        let (left, slopes) = problem.cells(&fitted.x);
        let place = |name: &str| problem.free.iter().position(|free| free.name == name);
        let names = PULLS.into_iter().chain(["k_1", "k_2"]);
        let places: Vec<usize> = names.filter_map(place).collect();
        let by = |i: usize| {
            let free = &problem.free[i];
            let side = match PULLS.iter().position(|pull| *pull == free.name) {
                Some(0) => 1.0,
                Some(_) => -1.0,
                None => 0.0,
            };
            side * free.slope(problem.value(i, &fitted.x))
        };
        let by = DVector::from_iterator(places.len(), places.iter().map(|i| by(*i)));
        let slopes = slopes.select_columns(&places);
        let inverse = (slopes.transpose() * &slopes).try_inverse()?;
        let variance = by.dot(&(inverse * &by));
        let pull = |name: &str| {
            place(name).map_or(fitted.rig.value(name), |i| Some(problem.value(i, &fitted.x)))
        };
        let square = left.iter().map(|r| r * r).sum::<f64>() / left.len() as f64;
        let apart = (pull(PULLS[0])? - pull(PULLS[1])?).abs();
        (variance > 0.0).then(|| (apart / (variance * square.max(1.0)).sqrt(), square))
    }
}

#[cfg(test)]
mod tests {
    use super::{away, loose, tied};
    use crate::{board::Board, walk::made};
    use identify::{
        Hold, Rig,
        effects::Kind,
        fit::{Data, Seen, binding},
    };
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn names(plant: &str, channels: &str, free: &str) -> Vec<String> {
        let text = format!(
            "title = \"t\"\n[plant]\n{plant}[friction]\nname = \"coulomb\"\nf_c = 1.0\n\
             [fit]\nfree = [{free}]\n[channels]\ntime = \"t\"\n{channels}"
        );
        loose(&Rig::parse(&text).unwrap()).into_iter().map(|(name, _)| name).collect()
    }

    #[test]
    fn one_scale_of_forces_stays_as_it_is() {
        let axis = "kind = \"axis\"\ninertia = 1.0\ngain = 2.0\n";
        let channels = "voltage = \"u\"\nposition = \"q\"\n";
        assert_eq!(names(axis, channels, "\"f_c\""), ["inertia"]);
        assert!(names(axis, channels, "\"f_c\", \"gain\"").is_empty(), "the inertia is the scale");
        let pendulum = "kind = \"pendulum\"\ninertia = 1.0\nmass = 1.0\nlength = 0.1\ntorque_constant = 0.1\nresistance = 1.0\n";
        let channels = "voltage = \"u\"\nangle = \"q\"\n";
        // The back-EMF stands for viscous friction where none is free.
        assert_eq!(names(pendulum, channels, "\"mass\""), ["inertia", "torque_constant"]);
        assert_eq!(names(pendulum, channels, "\"mass\", \"sigma_2\""), ["inertia"]);
    }

    #[test]
    fn what_is_free_and_has_a_sign_is_tied_as_well() {
        let text = "title = \"t\"\n[plant]\nkind = \"axis\"\ninertia = 1.0\ngain = 2.0\n[friction]\nname = \"lugre\"\n\
             f_c = 1.0\nf_s = 1.5\nv_s = 0.1\nsigma_0 = 100.0\nsigma_1 = 1.0\nsigma_2 = 0.0\n\
             [fit]\nfree = [\"f_c\", \"f_s\", \"sigma_2\"]\n[channels]\ntime = \"t\"\nvoltage = \"u\"\n\
             position = \"q\"\n";
        let tied = tied(&Rig::parse(text).unwrap());
        assert_eq!(tied, [("inertia".to_owned(), 1.0), ("f_c".to_owned(), 1.0)]);
    }

    #[test]
    fn springs_that_are_drawn_a_little_otherwise_than_told_push_no_further() {
        // Two springs of 12 N and 16 N at 0.05 m, each off by a fiftieth: 0.02 N·m.
        let rig = |offset: f64| {
            let text = format!(
                "title = \"t\"\n[plant]\nkind = \"drum\"\ninertia = 1e-3\nradius = 0.05\nk_1 = 1.0\nk_2 = 1.0\n\
                 f_10 = 12.0\nf_20 = 16.0\nmotor_constant = 10.0\ngear_ratio = 50.0\noffset = {offset:?}\n\
                 [friction]\nname = \"coulomb\"\nf_c = 1.0\n[channels]\ntime = \"t\"\ncurrent = \"i\"\nangle = \"q\"\n"
            );
            Rig::parse(&text).unwrap()
        };
        assert!(!away(&rig(0.06), "offset", 0.0) && away(&rig(0.08), "offset", 0.0));
        assert!(!away(&rig(0.06), "inertia", 1.08e-3) && away(&rig(0.06), "inertia", 1.2e-3));
    }

    #[test]
    fn what_load_cells_show_is_a_little_off_as_well() {
        let drum = |pulls: [f64; 2], cells: &str, free: &str| {
            let [f_10, f_20] = pulls;
            let text = format!(
                "title = \"t\"\n[plant]\nkind = \"drum\"\ninertia = 1e-3\nradius = 0.05\nk_1 = 1.0\nk_2 = 1.0\n\
                 f_10 = {f_10:?}\nf_20 = {f_20:?}\nmotor_constant = 10.0\ngear_ratio = 50.0\n\
                 [friction]\nname = \"coulomb\"\nf_c = 1.0\n[fit]\nfree = [{free}]\n[channels]\ntime = \"t\"\n\
                 current = \"i\"\nangle = \"q\"\n{cells}"
            );
            Rig::parse(&text).unwrap()
        };
        let cells = "force_1 = \"a\"\nforce_2 = \"b\"\n";
        let names = |cells: &str, free: &str| -> Vec<String> {
            loose(&drum([12.0, 12.5], cells, free)).into_iter().map(|(name, _)| name).collect()
        };
        let known = ["f_c", "motor_constant", "f_10"].map(|name| format!("\"{name}\"")).join(", ");
        assert_eq!(names(cells, &known), ["f_20"], "whatever the scale of the drive");
        assert_eq!(names("", "\"f_c\""), ["inertia", "k_1", "k_2", "offset"]);
        let alike = loose(&drum([12.0, 12.0], "", "\"f_c\""));
        assert!(alike.iter().all(|(name, _)| name != "offset"), "said to pull alike");
        assert_eq!(
            names(cells, "\"f_c\""),
            ["inertia", "radius", "k_1", "k_2", "f_10", "f_20"],
            "what the springs push is seen"
        );
        // Where both went far the first stays loose, for their mean.
        let loose = loose(&drum([12.0, 12.0], cells, ""));
        assert_eq!(super::far(&drum([13.0, 11.0], cells, ""), &loose), ["f_20"]);
        assert_eq!(super::far(&drum([13.0, 12.0], cells, ""), &loose), ["f_10"]);
        // Neither alone is far off, but that they differ so much is no chance.
        assert_eq!(super::far(&drum([12.7, 11.3], cells, ""), &loose), ["f_20"]);
        assert!(super::far(&drum([12.5, 11.5], cells, ""), &loose).is_empty());
        assert!(super::far(&drum([12.7, 12.7], cells, ""), &loose).is_empty(), "their mean");
        // Up to a fifteenth, each by itself.
        let far = |f_20: f64| away(&drum([12.0, f_20], cells, ""), "f_20", 12.0);
        assert!(!far(12.8) && !far(11.2) && far(13.0) && far(11.0));
    }

    #[test]
    fn a_mass_that_is_off_by_more_than_a_little_is_what_is_missing() {
        let data = made::data();
        let rig = |mass: f64| made::with(&made::rig(mass), Kind::CurrentBias, &[made::BIAS]);
        let strays = |given: f64, found: f64| {
            let board = Board::of(&rig(given), &data, 1, vec![("mass".to_owned(), given)]);
            let board = board.unwrap();
            let refit = board.judged(&rig(found), None).unwrap();
            assert!(board.strayed(&refit).is_empty(), "no tenth");
            let held = Rig { free: vec!["sigma_2".to_owned()], ..rig(given) };
            let mut other = refit.clone();
            binding::set(&mut other.rig, "sigma_2", 0.6);
            (board.strayed_alone(&refit).len(), board.all_but(&other, &held))
        };
        let (many, start) = strays(1.88, 2.0);
        assert_eq!((many, start.value("mass"), start.value("sigma_2")), (1, Some(1.88), Some(0.6)));
        assert_eq!(strays(1.94, 2.0).0, 0, "as far off as nominal values are");
        let (many, start) = strays(2.0, 2.12);
        assert_eq!((many, start.value("sigma_2")), (0, Some(0.5)), "where more is left");
    }

    #[test]
    fn pulls_that_are_given_as_the_same_and_are_not_differ() {
        let rig = |pulls: [f64; 2]| {
            let text = format!(
                "title = \"t\"\n[plant]\nkind = \"drum\"\ninertia = 1e-3\nradius = 0.05\nk_1 = 150.0\nk_2 = 160.0\n\
                 f_10 = {:?}\nf_20 = {:?}\nmotor_constant = 10.0\ngear_ratio = 50.0\n[friction]\nname = \"coulomb\"\n\
                 f_c = 1.0\n[fit]\nfree = [\"f_c\"]\n[channels]\ntime = \"t\"\ncurrent = \"i\"\nangle = \"q\"\n\
                 force_1 = \"a\"\nforce_2 = \"b\"\n",
                pulls[0], pulls[1]
            );
            Rig::parse(&text).unwrap()
        };
        let time: Vec<f64> = (0..4000).map(|i| 0.005 * f64::from(i)).collect();
        let angle: Vec<f64> = time.iter().map(|t| 0.1 * t.sin()).collect();
        let cell = |pull: f64, k: f64, seed: u64| {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
            let shown = angle.iter().map(|a| pull + k * 0.05 * a + 0.05 * noise());
            Seen::new("force", shown.collect(), 0.05)
        };
        let loads = [cell(12.02, 150.0, 1), cell(11.98, -160.0, 2)];
        let seen = Seen::new("angle", angle.clone(), 1e-4);
        let driven = Data::driven(time.clone(), vec![0.0; 4000], Hold::Linear, seen);
        let data = Data { loads: Some(loads), ..driven };
        let with = |given: [f64; 2], found: [f64; 2], held: &str| {
            let given = rig(given);
            let mut loose = loose(&given);
            loose.retain(|(name, _)| name != held);
            let board = Board::of(&super::loosened(&given, &loose), &data, 1, loose.clone());
            let board = board.unwrap();
            let refit = board.judged(&super::loosened(&rig(found), &loose), None).unwrap();
            (board.strayed(&refit), board.lone_pull(&refit))
        };
        let strays = |given: [f64; 2], found: [f64; 2]| with(given, found, "").0;
        // Of 4000 samples with a noise of 0.05 N the difference is known to about 1 mN.
        assert_eq!(strays([12.0, 12.0], [12.02, 11.98]), ["f_20"]);
        assert!(strays([12.0, 12.0], [12.003, 11.998]).is_empty(), "within what noise does");
        assert!(strays([12.0, 12.1], [12.02, 11.98]).is_empty(), "each is off by itself");
        // With the second one held where it is right, the first differs from it, and that is all.
        let lone = |given: f64, found: f64| with([given; 2], [found, given], "f_20").1;
        assert_eq!(lone(11.98, 12.02).as_deref(), Some("f_10"));
        assert_eq!(lone(11.98, 11.982), None, "within what noise does");
        assert_eq!(lone(11.5, 12.02), None, "the one that is held is wrong as well");
        assert_eq!(with([11.98; 2], [12.02, 11.98], "").1, None, "both are loose");
    }
}
