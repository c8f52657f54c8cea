//! Finished cases on disk, each under the hash of everything that determines it.

use crate::{CaseRow, FORMAT, FitRow, MisfitRow, ModelRow, ParameterRow, RecordError, write_whole};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use sha2::{Digest, Sha256};
use std::{fmt::Write, fs, io::ErrorKind, path::PathBuf};

/// A thinned series of one case, kept where a figure needs the way and not only the errors.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct History {
    /// Times of accepted steps [s].
    pub t: Vec<f64>,
    /// The step that led there [s].
    pub step: Vec<f64>,
    /// The quantity compared, as computed.
    pub value: Vec<f64>,
    /// Its error, relative as in [`CaseRow`].
    pub error: Vec<f64>,
}

/// What is kept of a finished case.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CaseRecord {
    /// Its row in the table.
    pub row: CaseRow,
    /// Its thinned series, if the study asked for one.
    pub history: Option<History>,
}

/// What is kept of a finished fit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FitRecord {
    /// Its row in the table.
    pub row: FitRow,
    /// Its parameters, without the truth.
    pub parameters: Vec<ParameterRow>,
    /// The friction models against one another, the best first.
    pub models: Vec<ModelRow>,
    /// The misfit of every channel.
    pub misfits: Vec<MisfitRow>,
}

/// The SHA-256 of everything that determines a case, in hexadecimal.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key(String);

impl Key {
    /// The key of these parts, in this order; no two lists of parts give the same text to hash.
    pub fn of(parts: &[&str]) -> Self {
        let mut text = format!("duhem record {FORMAT}\n");
        for part in parts {
            let _ = writeln!(text, "{}\n{part}", part.len());
        }
        Self(sha256(text.as_bytes()))
    }

    /// The key as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// What the store holds under a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Found<T = CaseRecord> {
    /// A whole record.
    Record(Box<T>),
    /// Nothing.
    Nothing,
    /// A file that is not what was written: why.
    Damaged(String),
}

/// A folder of records.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
}

impl Store {
    /// A store in this folder, which need not exist yet.
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    fn path(&self, key: &Key) -> PathBuf {
        self.folder.join(&key.0[..2]).join(format!("{}.json", key.0))
    }

    /// Reads the record under `key`; a damaged one is found by its checksum.
    pub fn read<T: DeserializeOwned>(&self, key: &Key) -> Result<Found<T>, RecordError> {
        let path = self.path(key);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Found::Nothing),
            Err(source) => return Err(RecordError::Disk { path, what: "cannot read", source }),
        };
        Ok(match open(&bytes) {
            Ok(record) => Found::Record(Box::new(record)),
            Err(why) => Found::Damaged(why),
        })
    }

    /// Writes the record under `key`, whole.
    pub fn write<T: Serialize>(&self, key: &Key, record: &T) -> Result<(), RecordError> {
        let path = self.path(key);
        let body = serde_json::to_string(record).map_err(|e| RecordError::Table {
            path: path.clone(),
            found: e.to_string(),
            expected: "a record of finite numbers".to_owned(),
        })?;
        write_whole(&path, format!("{}\n{body}\n", seal(&body)).as_bytes()).map(|_| ())
    }
}

/// The first line of a record's file: format and checksum of the rest.
fn seal(body: &str) -> String {
    format!("duhem record {FORMAT} sha256 {}", sha256(body.as_bytes()))
}

fn open<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| format!("not text: {e}"))?;
    let (first, rest) = text.split_once('\n').ok_or("it ends in its first line")?;
    let body = rest.strip_suffix('\n').ok_or("its last line is not ended")?;
    if first != seal(body) {
        return Err(format!("its checksum does not fit: `{first}`"));
    }
    serde_json::from_str(body).map_err(|e| e.to_string())
}

/// The SHA-256 of these bytes, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
