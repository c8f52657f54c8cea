//! Records of drives and rig files, as they are read from disk and shown.

use crate::exit::{Exit, Failure};
use identify::Rig;
use record::Sheet;
use std::{fs::File, io::Read, path::Path};

/// The longest rig file that is looked at [bytes]; the parser refuses it from 1 MiB on.
const LONGEST: u64 = 1 << 21;

/// The rig that a rig file declares.
pub(crate) fn read_rig(path: &Path) -> Result<Rig, Failure> {
    let bad = |error: anyhow::Error| {
        let error = error.context(safe(&path.display().to_string()));
        Failure { exit: Exit::Input, error }
    };
    // A pipe would wait for ever.
    if std::fs::metadata(path).map_err(|e| bad(e.into()))?.is_file() {
        let mut bytes = Vec::new();
        let read = File::open(path).and_then(|file| file.take(LONGEST).read_to_end(&mut bytes));
        read.map_err(|e| bad(e.into()))?;
        let text = String::from_utf8(bytes).map_err(|_| {
            bad(anyhow::anyhow!("found bytes that are no UTF-8: expected a rig file"))
        })?;
        Rig::parse(&text).map_err(|e| bad(e.into()))
    } else {
        Err(bad(anyhow::anyhow!("found no ordinary file: expected a rig file")))
    }
}

/// The columns of a record.
pub(crate) fn read_record(path: &Path) -> Result<Sheet, Failure> {
    record::read_sheet(path).map_err(|e| {
        let error = anyhow::Error::new(e).context(safe(&path.display().to_string()));
        Failure { exit: Exit::Input, error }
    })
}

/// Text of a file as a terminal may show it: what controls it, or turns the direction of writing, is escaped.
pub(crate) fn safe(text: &str) -> String {
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let shown = |c: char| {
        if c.is_control() || turns(c) { c.escape_unicode().to_string() } else { c.to_string() }
    };
    text.chars().map(shown).collect()
}
