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

const FAMILIES: [Family; 4] = [
    Family {
        folder: "crates/duhem/src/models",
        file: "mod.rs",
        list: "MODELS",
        helpers: HELPERS[0],
    },
    Family {
        folder: "crates/duhem/src/closed_form",
        file: "mod.rs",
        list: "REFERENCES",
        helpers: HELPERS[1],
    },
    Family {
        folder: "crates/integrate/src/solvers",
        file: "mod.rs",
        list: "SOLVERS",
        helpers: &[],
    },
    Family {
        folder: "crates/report/src/figures",
        file: "mod.rs",
        list: "FIGURES",
        helpers: HELPERS[2],
    },
];

/// Files in a family's folder that members share.
const HELPERS: [&[&str]; 3] = [&[], &[], &[]];

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
            if name == file || helpers.contains(&stem) || members.contains(&format!("{stem}::")) {
                continue;
            }
            breaches.push(format!("{folder}/{name}: is not in {list} ({folder}/{file})"));
        }
    }
    Ok(breaches)
}
