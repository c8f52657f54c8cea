//! Records as lines of text, under caps of line and cell.

use super::dialect::{Dialect, begin};
use super::error::shown;
use super::{CELLS, COLUMNS, Cells, ROWS, Sheet, SheetColumn, SheetError};
use ::csv::{ByteRecord, Reader, ReaderBuilder, Terminator};
use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

/// How long a line may be, or several held together by quotes [bytes].
pub(crate) const LINE: u64 = 1 << 20;
/// How long a cell may be [bytes].
const CELL: usize = 4 << 10;
/// How often the lines of a file may break their count: at blank lines and at cells of several lines.
const BREAKS: usize = 1_000_000;

/// Reads a record from comma-, semicolon- or tab-separated text with a header.
///
/// Decimal commas are read where the separator is none; a cell that is empty or says `NaN` is NaN.
/// Errors: no header, no rows, rows of another length than the header, and more than the caps allow.
pub fn read_csv(mut input: impl Read) -> Result<Sheet, SheetError> {
    let (head, dialect) = begin(&mut input)?;
    let since = Rc::new(Cell::new(0));
    let lines = Lines {
        input: io::Cursor::new(head).chain(input),
        since: since.clone(),
        dialect,
        last: b'\n',
        over: false,
    };
    let reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(dialect.separator)
        .terminator(Terminator::Any(b'\n'))
        .buffer_capacity(1 << 16)
        .from_reader(lines);
    let mut records = Records { reader, since, record: ByteRecord::new(), line: 1 };
    if !records.advance()? {
        return Err(SheetError::content("the file", "nothing", "a header and rows of numbers"));
    }
    let columns = header(&records)?;
    rows(&mut records, columns, dialect)
}

/// The input with every line ended by `\n`, which counts what it hands out.
struct Lines<R> {
    input: R,
    /// Bytes handed out since the last record ended.
    since: Rc<Cell<u64>>,
    dialect: Dialect,
    last: u8,
    over: bool,
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.over || buffer.is_empty() {
            return Ok(0);
        }
        if self.since.get() > LINE {
            return Err(io::Error::other("a line above the cap"));
        }
        let mut n = self.input.read(buffer)?;
        if n == 0 {
            self.over = true;
            if self.last != b'\n' {
                buffer[0] = b'\n';
                n = 1;
            }
        }
        if self.dialect.lone_return {
            buffer[..n].iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
        }
        self.since.set(self.since.get() + n as u64);
        self.last = buffer[..n].last().copied().unwrap_or(self.last);
        Ok(n)
    }
}

/// The records of the text one after the other, and where the present one begins.
struct Records<R> {
    reader: Reader<Lines<R>>,
    since: Rc<Cell<u64>>,
    record: ByteRecord,
    line: u64,
}

impl<R: Read> Records<R> {
    /// Goes to the next record that is no blank line; false if there is none.
    fn advance(&mut self) -> Result<bool, SheetError> {
        loop {
            let start = self.reader.position().line();
            let more = self.reader.read_byte_record(&mut self.record).map_err(|e| {
                if self.since.get() > LINE {
                    let found = "a line, or a quoted cell that does not end, above 1 MiB";
                    return SheetError::cap(format!("line {start}"), found, "1 MiB a line");
                }
                SheetError::Disk { what: "cannot read", reason: e.into() }
            })?;
            self.since.set(0);
            if !more {
                return Ok(false);
            }
            // A record ends with its line, so it began as many lines before as it holds line ends.
            let held = self.record.as_slice().split(|byte| *byte == b'\n').skip(1).count() as u64;
            self.line = self.reader.position().line().saturating_sub(1 + held);
            if self.record.len() > 1
                || self.record.as_slice().iter().any(|b| !b.is_ascii_whitespace())
            {
                return Ok(true);
            }
        }
    }

    fn place(&self) -> String {
        format!("line {}", self.line)
    }
}

/// The columns the header names, without rows.
fn header<R: Read>(records: &Records<R>) -> Result<Vec<SheetColumn>, SheetError> {
    let record = &records.record;
    if record.len() > COLUMNS {
        let found = format!("{} columns", record.len());
        return Err(SheetError::cap(records.place(), found, format!("{COLUMNS} columns")));
    }
    let names: Vec<String> = record
        .iter()
        .map(|cell| String::from_utf8_lossy(cell).trim_matches([' ', '\t', '\r']).to_owned())
        .collect();
    if let Some(long) = names.iter().position(|name| name.len() > CELL) {
        return Err(above(&records.place(), long));
    }
    let mut filled = names.iter().filter(|name| !name.is_empty()).peekable();
    if let Some(first) = filled.peek().map(|name| shown(name))
        && filled.all(|name| name.replace(',', ".").parse::<f64>().is_ok())
    {
        let found = format!("numbers, the first `{first}`,");
        return Err(SheetError::content(records.place(), found, "a header that names the columns"));
    }
    let named = |(i, name): (usize, String)| SheetColumn {
        name: if name.is_empty() { format!("column {}", i + 1) } else { name },
        cells: Cells::Numbers(Vec::new()),
        blanks: 0,
    };
    Ok(names.into_iter().enumerate().map(named).collect())
}

/// All rows below the header.
fn rows<R: Read>(
    records: &mut Records<R>,
    mut columns: Vec<SheetColumn>,
    dialect: Dialect,
) -> Result<Sheet, SheetError> {
    let most = ROWS.min(CELLS / columns.len());
    let mut numbers = Numbers { comma: dialect.separator != b',', mark: None };
    let mut lines: Vec<(usize, u64)> = Vec::new();
    let mut count = 0;
    let mut due = 0;
    while records.advance()? {
        if count == most {
            let found = format!("more than {most} rows of {} columns", columns.len());
            let cap = format!("{ROWS} rows and {CELLS} cells");
            return Err(SheetError::cap(records.place(), found, cap));
        }
        if records.line != due {
            if lines.len() == BREAKS {
                let found = format!("more than {BREAKS} blank lines or cells of several lines");
                return Err(SheetError::cap(records.place(), found, BREAKS.to_string()));
            }
            lines.push((count, records.line));
        }
        due = records.line + 1;
        row(records, &mut columns, &mut numbers)?;
        count += 1;
    }
    if count == 0 {
        let found = format!("a header of {} columns and no rows", columns.len());
        return Err(SheetError::content("the file", found, "rows of numbers below the header"));
    }
    Ok(Sheet { columns, skipped: Vec::new(), rows: count, lines })
}

/// Adds the present record to the columns.
fn row<R: Read>(
    records: &Records<R>,
    columns: &mut [SheetColumn],
    numbers: &mut Numbers,
) -> Result<(), SheetError> {
    let record = &records.record;
    if record.len() != columns.len() {
        let found = format!("{} cells", record.len());
        let expected = format!("{}, as in the header", columns.len());
        return Err(SheetError::content(records.place(), found, expected));
    }
    for (i, (cell, column)) in record.iter().zip(columns).enumerate() {
        if cell.len() > CELL {
            return Err(above(&records.place(), i));
        }
        let Cells::Numbers(values) = &mut column.cells else { continue };
        let cell = cell.trim_ascii();
        if cell.is_empty() {
            column.blanks += 1;
            values.push(f64::NAN);
        } else if let Some(value) = numbers.parse(cell) {
            values.push(value);
        } else {
            let found = String::from_utf8_lossy(cell);
            let found = found.chars().take(SheetError::SHOWN + 1).collect();
            column.cells = Cells::Text { line: records.line, found };
        }
    }
    Ok(())
}

/// A cell above its cap.
fn above(place: &str, column: usize) -> SheetError {
    let place = format!("{place}, column {}", column + 1);
    SheetError::cap(place, format!("a cell above {CELL} bytes"), format!("{CELL} bytes a cell"))
}

/// How numbers are written in this file.
struct Numbers {
    /// A comma may be the decimal mark.
    comma: bool,
    /// The decimal mark met first; a file that uses both writes thousands apart, and would be misread.
    mark: Option<u8>,
}

impl Numbers {
    fn parse(&mut self, cell: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(cell).ok()?;
        let Some(at) = cell.iter().position(|byte| matches!(byte, b'.' | b',')) else {
            return text.parse().ok();
        };
        let mark = cell[at];
        if self.mark.is_some_and(|first| first != mark) || mark == b',' && !self.comma {
            return None;
        }
        let value = if mark == b',' {
            text.replacen(',', ".", 1).parse().ok()?
        } else {
            text.parse().ok()?
        };
        self.mark = Some(mark);
        Some(value)
    }
}
