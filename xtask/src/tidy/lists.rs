//! One new file, one line: every file of a family stands in its list.

use super::{entries, read};
use crate::exit::Failure;
use std::path::Path;

/// A family: its folder, the file with the list, the list's name, files that are no members.
struct Family {
    folder: &'static str,
    file: &'static str,
    list: &'static str,
    helpers: &'static [&'static str],
}

const FAMILIES: [Family; 6] = [
    Family { folder: "crates/duhem/src/models", file: "mod.rs", list: "MODELS", helpers: &[] },
    Family {
        folder: "crates/duhem/src/closed_form",
        file: "mod.rs",
        list: "REFERENCES",
        // Loops and not trajectories: nothing to judge a run by.
        helpers: &["masing", "second_way", "semilinear"],
    },
    Family {
        folder: "crates/integrate/src/solvers",
        file: "mod.rs",
        list: "SOLVERS",
        helpers: &[],
    },
    Family {
        folder: "crates/simulation/src/exact",
        file: "mod.rs",
        list: "EXACT",
        // How a motion is followed along the grid.
        helpers: &["imposed"],
    },
    Family {
        folder: "crates/simulation/src/adaptive",
        file: "mod.rs",
        list: "ADAPTIVE",
        helpers: &[],
    },
    Family { folder: "crates/report/src/figures", file: "mod.rs", list: "FIGURES", helpers: &[] },
];

pub(super) fn complete(root: &Path) -> Result<Vec<String>, Failure> {
    let mut breaches = Vec::new();
    for Family { folder, file, list, helpers } in FAMILIES {
        let path = root.join(folder);
        if !path.is_dir() {
            breaches.push(format!("{folder}: is missing"));
            continue;
        }
        let text = read(&path.join(file))?;
        let members = text
            .split_once(&format!("pub const {list}"))
            .and_then(|(_, rest)| rest.split_once("];"))
            .map_or("", |(members, _)| members);
        for name in entries(&path)? {
            let stem = name.trim_end_matches(".rs");
            let member = format!("{}::", plain(stem));
            if name == file || helpers.contains(&stem) || plain(members).contains(&member) {
                continue;
            }
            breaches.push(format!("{folder}/{name}: is not in {list} ({folder}/{file})"));
        }
    }
    Ok(breaches)
}

/// Without case and underscores: `maxwell_slip` stands in its list as a module or as `MaxwellSlip`.
fn plain(text: &str) -> String {
    text.to_lowercase().replace('_', "")
}
