//! A record of a drive as it stands in its file: named columns of numbers.
//!
//! Every reader here holds against any file whatever: it ends in a [`Sheet`] or in a [`SheetError`], and in
//! less than 500 MB, because it looks at what a file claims before it believes it.

mod csv;
mod dialect;
mod error;
mod matlab;
mod pages;
mod parquet;
mod thrift;
mod write;

pub use csv::read_csv;
pub use error::SheetError;
pub use matlab::read_matlab;
pub use parquet::read_parquet;
pub use write::{write_sheet_csv, write_sheet_parquet};

use error::shown;
use std::collections::BTreeMap;
use std::{fs::File, io::Read, path::Path};

/// How many columns a record may have.
pub const COLUMNS: usize = 4096;
/// How many rows a record may have.
pub const ROWS: usize = 20_000_000;
/// How many cells a record may have, all columns together: 256 MB of numbers.
pub const CELLS: usize = 32_000_000;

/// The columns of a record.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    /// The columns, in the file's order, all with as many rows.
    pub columns: Vec<SheetColumn>,
    /// What the file holds beside them, and why it was not read.
    pub skipped: Vec<Skipped>,
    rows: usize,
    /// Where rows stand in a file of lines: each entry is a row and its line, from which both count on together.
    lines: Vec<(usize, u64)>,
}

/// A column of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetColumn {
    /// The header as the file has it, or `column N` where that is blank.
    pub name: String,
    /// What stands below it.
    pub cells: Cells,
    /// How many cells are empty; their values are NaN.
    pub blanks: usize,
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Numbers in the file's units, one a row; NaN where a cell is empty or says `NaN`.
    Numbers(Vec<f64>),
    /// Something that is no number.
    Text {
        /// The line of the first such cell, counted from 1.
        line: u64,
        /// What stands there, cut.
        found: String,
    },
}

/// Something in the file that is no column of real numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skipped {
    /// Its name.
    pub name: String,
    /// What it is, as in "text" or "a 3×4×2 array".
    pub what: String,
}

impl Sheet {
    /// How many rows every column has.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The numbers of a column, in the file's units.
    ///
    /// An error if no column or several have this name, or if it holds anything that is no number.
    pub fn column(&self, name: &str) -> Result<&[f64], SheetError> {
        let named: Vec<usize> =
            (0..self.columns.len()).filter(|i| self.columns[*i].name == name).collect();
        let [at] = named[..] else {
            return Err(self.not_one(name, &named));
        };
        match &self.columns[at].cells {
            Cells::Numbers(numbers) => Ok(numbers),
            Cells::Text { line, found } => {
                Err(SheetError::Text { name: name.to_owned(), line: *line, found: found.clone() })
            }
        }
    }

    /// Why a name is not the name of one column.
    fn not_one(&self, name: &str, named: &[usize]) -> SheetError {
        let name = name.to_owned();
        if !named.is_empty() {
            return SheetError::Ambiguous { name, at: named.iter().map(|i| i + 1).collect() };
        }
        if let Some(skipped) = self.skipped.iter().find(|s| s.name == name) {
            return SheetError::Skipped { name, what: skipped.what.clone() };
        }
        SheetError::Unknown { name, known: self.columns.iter().map(|c| c.name.clone()).collect() }
    }

    /// The line of the file on which a row (counted from 0) begins, counted from 1; none in a file without lines.
    pub fn line(&self, row: usize) -> Option<u64> {
        let before = self.lines.partition_point(|(first, _)| *first <= row);
        let (first, line) = self.lines[..before].last()?;
        (row < self.rows).then(|| line + (row - first) as u64)
    }

    /// A sheet of columns that need not agree in length: those stay whose length most numbers of the file stand
    /// under, so that neither constants nor a single long table take the record's place.
    pub(crate) fn of_most(
        columns: Vec<SheetColumn>,
        mut skipped: Vec<Skipped>,
    ) -> Result<Self, SheetError> {
        let length = |column: &SheetColumn| match &column.cells {
            Cells::Numbers(numbers) => numbers.len(),
            Cells::Text { .. } => 0,
        };
        let mut cells = BTreeMap::new();
        for rows in columns.iter().map(length) {
            *cells.entry(rows).or_insert(0) += rows;
        }
        let rows = cells.into_iter().max_by_key(|(_, cells)| *cells).map_or(0, |(rows, _)| rows);
        if rows == 0 {
            let held = skipped.iter().take(8).map(|s| format!("`{}`, {}", shown(&s.name), s.what));
            let held = held.collect::<Vec<_>>().join("; ");
            let found =
                if held.is_empty() { "no column".to_owned() } else { format!("only {held}") };
            return Err(SheetError::content("the file", found, "columns of numbers"));
        }
        let (kept, short) = columns.into_iter().partition(|column| length(column) == rows);
        skipped.extend(Vec::into_iter(short).map(|column| Skipped {
            what: format!("of {} rows where the record has {rows}", length(&column)),
            name: column.name,
        }));
        Ok(Self { columns: kept, skipped, rows, lines: Vec::new() })
    }
}

/// Reads a record from a CSV, Parquet or MATLAB 5 file; what the file is, its content says.
///
/// Nothing but an ordinary file is opened: a pipe would wait for ever, a device never end.
pub fn read_sheet(path: &Path) -> Result<Sheet, SheetError> {
    let disk = |what| move |reason| SheetError::Disk { what, reason };
    let about = std::fs::metadata(path).map_err(disk("cannot look at it"))?;
    if !about.is_file() {
        let found = kind(about.file_type());
        return Err(SheetError::content(
            "the path",
            found,
            "an ordinary file; copy the data to one",
        ));
    }
    let mut file = File::open(path).map_err(disk("cannot open"))?;
    let mut head = Vec::new();
    file.by_ref().take(128).read_to_end(&mut head).map_err(disk("cannot read"))?;
    if head.starts_with(b"PAR1") {
        return read_parquet(file);
    }
    let whole = head.as_slice().chain(file);
    if matlab::is_matlab(&head) { read_matlab(whole) } else { read_csv(whole) }
}

/// What a path leads to, if it is no ordinary file.
fn kind(kind: std::fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_dir() {
        "a folder"
    } else if kind.is_fifo() {
        "a pipe (FIFO)"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}
