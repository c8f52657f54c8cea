//! How a CSV file is written: what parts its cells, and what it is if it is no CSV at all.

use super::{COLUMNS, SheetError, csv::LINE};
use std::io::Read;

/// How a file of lines is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dialect {
    /// What parts the cells.
    pub(crate) separator: u8,
    /// Lines end in a carriage return alone, as on old Macintoshes.
    pub(crate) lone_return: bool,
}

/// The first megabyte of the input, without a byte-order mark, and how it is written.
pub(crate) fn begin(mut input: impl Read) -> Result<(Vec<u8>, Dialect), SheetError> {
    let mut head = Vec::new();
    input
        .by_ref()
        .take(LINE)
        .read_to_end(&mut head)
        .map_err(|reason| SheetError::Disk { what: "cannot read", reason })?;
    if head.starts_with(b"\xEF\xBB\xBF") {
        head.drain(..3);
    }
    if let Some(found) = no_text(&head) {
        return Err(SheetError::content("the file", found, "CSV, Parquet or MATLAB 5"));
    }
    let lone_return = head.contains(&b'\r') && !head.contains(&b'\n');
    let mut columns = 1;
    for separator in SEPARATORS {
        columns = columns.max(header_columns(&head, separator, lone_return));
    }
    if columns > COLUMNS {
        let found = format!("at least {columns} columns");
        return Err(SheetError::cap("line 1", found, format!("{COLUMNS} columns")));
    }
    let separator = separator(&head, lone_return);
    Ok((head, Dialect { separator, lone_return }))
}

/// What may part cells, the likeliest first.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// What the file is, if it is clearly no text we read.
fn no_text(head: &[u8]) -> Option<String> {
    let known: [(&[u8], &str); 6] = [
        (b"\x89HDF", "an HDF5 file (a MATLAB file saved with `-v7.3`?): save it with `-v7`"),
        (b"PK\x03\x04", "a zip archive (a spreadsheet?): save the table as CSV"),
        (b"\x1F\x8B", "a gzip archive: unpack it first"),
        (b"\xFF\xFE", "UTF-16 text: save it as UTF-8"),
        (b"\xFE\xFF", "UTF-16 text: save it as UTF-8"),
        (b"MATLAB 7.3 MAT-file", "a MATLAB file saved with `-v7.3`: save it with `-v7`"),
    ];
    if let Some((_, what)) = known.iter().find(|(magic, _)| head.starts_with(magic)) {
        return Some((*what).to_owned());
    }
    if head.iter().all(u8::is_ascii_whitespace) {
        return Some("nothing".to_owned());
    }
    let at = head.iter().position(|byte| *byte == 0)?;
    Some(format!("binary data (byte 0x00 at offset {at})"))
}

/// How many cells the first line has, quoted separators not counted.
fn header_columns(head: &[u8], separator: u8, lone_return: bool) -> usize {
    let end = if lone_return { b'\r' } else { b'\n' };
    let mut quoted = false;
    let mut columns = 1;
    for byte in head.iter().skip_while(|byte| byte.is_ascii_whitespace() && **byte != separator) {
        match *byte {
            b'"' => quoted = !quoted,
            byte if byte == end && !quoted => break,
            byte if byte == separator && !quoted => columns += 1,
            _ => {}
        }
    }
    columns
}

/// The separator under which most of the first lines have as many cells as the header, and more than one.
fn separator(head: &[u8], lone_return: bool) -> u8 {
    let end = if lone_return { b'\r' } else { b'\n' };
    let score = |separator: u8| {
        let mut records = ::csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(separator)
            .terminator(::csv::Terminator::Any(end))
            .from_reader(head)
            .into_byte_records()
            .map_while(Result::ok)
            .map(|record| record.len());
        let header = records.next().unwrap_or(0);
        let agreeing = records.take(20).filter(|cells| *cells == header).count();
        (header > 1, agreeing, header)
    };
    // Of equal ones the last is taken.
    SEPARATORS.into_iter().rev().max_by_key(|separator| score(*separator)).unwrap_or(b',')
}
