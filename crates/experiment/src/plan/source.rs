//! A record and the rig it was made on, read and checked.

use crate::error::Complaint;
use identify::{Recording, Rig, fit::Data};
use record::{read_sheet, sha256};
use std::{fs, path::Path};

/// The largest rig file, truth file or record that is read [bytes].
const LARGEST: u64 = 1 << 30;

/// A record with its rig.
#[derive(Debug)]
pub struct Source {
    /// The record's file, without its folder.
    pub file: String,
    /// The rig with its nominal parameters.
    pub rig: Rig,
    /// The record's channels.
    pub recording: Recording,
    /// The record as a fit needs it.
    pub data: Data,
    /// The hash of record and rig file.
    pub(crate) content: String,
}

impl Source {
    /// Reads both, named as seen from `folder`.
    pub(super) fn read(record: &str, rig_file: &str, folder: &Path) -> Result<Self, Complaint> {
        let rig_text = text(folder, rig_file).map_err(|c| c.under("rig"))?;
        let rig = Rig::parse(&rig_text)
            .map_err(|e| Complaint::new("rig", format!("`{rig_file}`: {e}"), "a rig file"))?;
        let wrong = |found: String| {
            Complaint::new("record", format!("`{record}`: {found}"), "a record of this rig")
        };
        let path = folder.join(record);
        let bytes = bytes(folder, record).map_err(|c| c.under("record"))?;
        let sheet = read_sheet(&path).map_err(|e| wrong(e.to_string()))?;
        let columns = |name: &str| sheet.column(name).map_err(|e| e.to_string());
        let recording = Recording::new(&rig, &columns).map_err(|e| wrong(e.to_string()))?;
        Ok(Self {
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            data: Data::of(&rig, &recording),
            content: format!("{} {}", sha256(&bytes), sha256(rig_text.as_bytes())),
            rig,
            recording,
        })
    }
}

/// A truth file, read by those who judge; `of` makes of its text what they need.
pub(super) fn truth<T>(
    name: Option<&String>,
    folder: &Path,
    of: impl FnOnce(&str) -> Result<T, String>,
) -> Result<Option<T>, Complaint> {
    let Some(name) = name else { return Ok(None) };
    let text = text(folder, name).map_err(|c| c.under("truth"))?;
    let wrong = |found: String| {
        Complaint::new("truth", format!("`{name}`: {found}"), "a truth file of `record`")
    };
    of(&text).map(Some).map_err(wrong)
}

fn bytes(folder: &Path, name: &str) -> Result<Vec<u8>, Complaint> {
    let wrong =
        |found: String| Complaint::new("", found, "a file, as seen from the experiment's folder");
    let path = folder.join(name);
    let about = fs::metadata(&path).map_err(|e| wrong(format!("`{name}`: {e}")))?;
    if !about.is_file() || about.len() > LARGEST {
        return Err(wrong(format!("`{name}`, no ordinary file or above {LARGEST} bytes")));
    }
    fs::read(&path).map_err(|e| wrong(format!("`{name}`: {e}")))
}

fn text(folder: &Path, name: &str) -> Result<String, Complaint> {
    String::from_utf8(bytes(folder, name)?)
        .map_err(|_| Complaint::new("", format!("`{name}`, which is no text"), "a TOML file"))
}
