//! Records as Parquet files: the footer says what there is and is checked before any page is touched.

use super::error::shown;
use super::pages::{Chunk, Physical, Refusal, decode};
use super::thrift::Value;
use super::{CELLS, COLUMNS, Cells, ROWS, Sheet, SheetColumn, SheetError, Skipped};
use std::cell::Cell;
use std::io::{Read, Seek, SeekFrom};

/// How long the footer may be [bytes].
const FOOTER: u64 = 4 << 20;
/// How many values the footer may hold: 25 for each column of each group of rows.
const VALUES: usize = 500_000;
/// How large a column's part of one group of rows may be, as it lies in the file [bytes].
const CHUNK: usize = 64 << 20;
/// How many bytes may be read from the file's pages, and as many unpacked: pages may be told of twice, and a
/// small page may unpack to a large one.
const BUDGET: usize = 2 << 30;

/// Reads the columns of numbers of a Parquet file; missing values are NaN.
///
/// Text, time stamps, nested columns and the like are named in [`Sheet::skipped`].
/// Errors: a file that is damaged or above the caps, one without numbers or rows.
pub fn read_parquet(mut input: impl Read + Seek) -> Result<Sheet, SheetError> {
    let footer = footer(&mut input)?;
    let (about, _) =
        Value::read(&footer, VALUES).ok_or_else(|| damaged("a footer", "its tables"))?;
    let groups = about.list(4).ok_or_else(|| damaged("no row groups", "at least one"))?;
    let (leaves, mut skipped) = schema(about.list(2).unwrap_or_default())?;
    let rows = check_rows(&about, groups, leaves.len())?;
    let mut columns = Vec::new();
    let (packed, unpacked) = (Cell::new(BUDGET), Cell::new(BUDGET));
    let budget = Budget { packed: &packed, unpacked: &unpacked };
    for leaf in leaves {
        let name = leaf.name.clone();
        match column(&mut input, groups, &leaf, budget) {
            Ok((numbers, blanks)) => {
                columns.push(SheetColumn { name, cells: Cells::Numbers(numbers), blanks });
            }
            Err(Fault::Refused { refusal: Refusal::Foreign(what), .. }) => {
                skipped.push(Skipped { name, what: format!("a column {what}") });
            }
            Err(Fault::Refused { group, refusal: Refusal::Damaged(what) }) => {
                let place = format!("column `{}`, row group {group}", shown(&name));
                return Err(SheetError::content(place, what, "what the file's footer declares"));
            }
            Err(Fault::Disk(reason)) => return Err(disk(reason)),
        }
    }
    if rows == 0 {
        let found = format!("{} columns and no rows", columns.len());
        return Err(SheetError::content("the file", found, "rows of numbers"));
    }
    Sheet::of_most(columns, skipped)
}

fn disk(reason: std::io::Error) -> SheetError {
    SheetError::Disk { what: "cannot read", reason }
}

fn damaged(found: &str, expected: &str) -> SheetError {
    SheetError::content("the Parquet footer", found, expected)
}

/// The footer's bytes: its length stands eight bytes before the end of the file.
fn footer(input: &mut (impl Read + Seek)) -> Result<Vec<u8>, SheetError> {
    let end = input.seek(SeekFrom::End(0)).map_err(disk)?;
    let mut tail = [0; 8];
    if end < 12 {
        return Err(SheetError::content(
            "the file",
            format!("{end} bytes"),
            "a whole Parquet file",
        ));
    }
    input.seek(SeekFrom::Start(end - 8)).map_err(disk)?;
    input.read_exact(&mut tail).map_err(disk)?;
    let [a, b, c, d, magic @ ..] = tail;
    if &magic != b"PAR1" {
        let found = format!("`{}` at the end", shown(&String::from_utf8_lossy(&magic)));
        return Err(SheetError::content("the file", found, "`PAR1`; is the file whole?"));
    }
    let size = u64::from(u32::from_le_bytes([a, b, c, d]));
    if size > FOOTER {
        let found = format!("a Parquet footer of {size} bytes");
        return Err(SheetError::cap("the file", found, format!("{FOOTER} bytes")));
    }
    let start =
        (end - 8).checked_sub(size).ok_or_else(|| damaged("more bytes than the file", "less"))?;
    input.seek(SeekFrom::Start(start)).map_err(disk)?;
    let mut bytes = Vec::new();
    input.take(size).read_to_end(&mut bytes).map_err(disk)?;
    Ok(bytes)
}

/// A column of numbers.
struct Leaf {
    name: String,
    /// Its place among all columns of the file, parts of nested ones counted.
    place: usize,
    physical: Physical,
    optional: bool,
}

/// The columns of numbers, what is none, and how many columns there are with the parts of nested ones.
fn schema(elements: &[Value<'_>]) -> Result<(Vec<Leaf>, Vec<Skipped>), SheetError> {
    if elements.len() > COLUMNS {
        let found = format!("{} columns", elements.len() - 1);
        return Err(SheetError::cap("the Parquet footer", found, format!("{COLUMNS} columns")));
    }
    let (mut leaves, mut skipped) = (Vec::new(), Vec::new());
    let (mut at, mut place) = (1, 0);
    while let Some(element) = elements.get(at) {
        let name = String::from_utf8_lossy(element.bytes(4).unwrap_or_default()).into_owned();
        let first = place;
        // All that belongs to this column: itself, or a tree.
        let mut due = 1;
        while due > 0 {
            let part =
                elements.get(at).ok_or_else(|| damaged("a column without its parts", "all"))?;
            let children = part.size(5).unwrap_or(0).min(elements.len());
            place += usize::from(children == 0);
            due = due - 1 + children;
            at += 1;
        }
        match physical(element) {
            Ok(physical) => {
                let optional = element.int(3) == Some(1);
                leaves.push(Leaf { name, place: first, physical, optional });
            }
            Err(what) => skipped.push(Skipped { name, what: what.to_owned() }),
        }
    }
    Ok((leaves, skipped))
}

/// How a column's numbers are stored, or what it holds instead.
fn physical(element: &Value<'_>) -> Result<Physical, &'static str> {
    if element.size(5).is_some_and(|children| children > 0) {
        return Err("a nested column");
    }
    if element.int(3) == Some(2) {
        return Err("a column of lists");
    }
    let logical = |id| element.field(10).and_then(|l| l.field(id));
    let converted = element.int(6);
    if logical(5).is_some() || converted == Some(5) {
        return Err("a column of decimals; write them as numbers");
    }
    if [6, 7, 8].iter().any(|id| logical(*id).is_some()) || matches!(converted, Some(6..=10)) {
        return Err("a column of dates or times; write them as seconds, a number");
    }
    let unsigned = matches!(converted, Some(11..=14))
        || logical(10).is_some_and(|l| l.field(2) == Some(&Value::Bool(false)));
    match (element.int(1), unsigned) {
        (Some(0), _) => Ok(Physical::Bool),
        (Some(1), false) => Ok(Physical::I32),
        (Some(1), true) => Ok(Physical::U32),
        (Some(2), false) => Ok(Physical::I64),
        (Some(2), true) => Ok(Physical::U64),
        (Some(4), _) => Ok(Physical::F32),
        (Some(5), _) => Ok(Physical::F64),
        (Some(6 | 7), _) => Err("text or bytes"),
        _ => Err("of a type that is not read"),
    }
}

/// How many rows the groups have together, if the caps allow them.
fn check_rows(
    about: &Value<'_>,
    groups: &[Value<'_>],
    columns: usize,
) -> Result<usize, SheetError> {
    let rows = groups.iter().try_fold(0_usize, |sum, group| sum.checked_add(group.size(3)?));
    let rows = rows.ok_or_else(|| damaged("a row group without a count of rows", "one"))?;
    if about.size(3) != Some(rows) {
        let expected = format!("{rows}, as the row groups have together");
        return Err(damaged(&format!("{:?} rows", about.int(3).unwrap_or(-1)), &expected));
    }
    if rows > ROWS || rows.saturating_mul(columns) > CELLS {
        let found = format!("{rows} rows of {columns} columns");
        let cap = format!("{ROWS} rows and {CELLS} cells");
        return Err(SheetError::cap("the Parquet footer", found, cap));
    }
    Ok(rows)
}

/// How many bytes there may still be in this file's pages.
#[derive(Clone, Copy)]
struct Budget<'a> {
    packed: &'a Cell<usize>,
    unpacked: &'a Cell<usize>,
}

/// Why a column could not be read.
enum Fault {
    Disk(std::io::Error),
    Refused { group: usize, refusal: Refusal },
}

/// The numbers of a column, and how many are missing.
fn column(
    input: &mut (impl Read + Seek),
    groups: &[Value<'_>],
    leaf: &Leaf,
    budget: Budget<'_>,
) -> Result<(Vec<f64>, usize), Fault> {
    let mut numbers = Vec::new();
    let mut missing = 0;
    for (i, group) in groups.iter().enumerate() {
        let refused = |refusal| Fault::Refused { group: i + 1, refusal };
        let wrong = |what: String| refused(Refusal::Damaged(what));
        let about = group.list(1).and_then(|columns| columns.get(leaf.place)?.field(3));
        let about = about.ok_or_else(|| wrong("no description of it".to_owned()))?;
        // A dictionary lies before the pages that use it.
        let offset = about.int(9).map(|data| match about.int(11) {
            Some(dictionary) if dictionary > 0 => data.min(dictionary),
            _ => data,
        });
        let offset = offset.and_then(|offset| u64::try_from(offset).ok());
        let offset = offset.ok_or_else(|| wrong("no offset".to_owned()))?;
        let size = about.size(7).ok_or_else(|| wrong("no size".to_owned()))?;
        let left = budget.packed.get().checked_sub(size);
        let left = left.ok_or_else(|| wrong("pages above the cap of 2 GiB".to_owned()))?;
        budget.packed.set(left);
        if size > CHUNK {
            return Err(wrong(format!("{size} bytes in one row group, above the cap of {CHUNK}")));
        }
        input.seek(SeekFrom::Start(offset)).map_err(Fault::Disk)?;
        let mut bytes = Vec::new();
        input.take(size as u64).read_to_end(&mut bytes).map_err(Fault::Disk)?;
        let chunk = Chunk {
            bytes: &bytes,
            codec: about.int(4).unwrap_or(-1),
            physical: leaf.physical,
            optional: leaf.optional,
            rows: group.size(3).unwrap_or(0),
            budget: budget.unpacked,
        };
        missing += decode(&chunk, &mut numbers).map_err(refused)?;
    }
    Ok((numbers, missing))
}
