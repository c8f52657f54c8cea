//! Records as MATLAB 5 files: what `save -v6` and `save -v7` write, read as a stream.
//!
//! A file is 128 bytes of header and then elements: a tag of type and size, and so many bytes.
//! A variable is an element of type miMATRIX, or one that holds it compressed.

use super::error::shown;
use super::{CELLS, COLUMNS, Cells, ROWS, Sheet, SheetColumn, SheetError, Skipped};
use flate2::read::ZlibDecoder;
use std::io::{self, Read};

/// The types of elements by the names the format gives them.
const MI_INT8: u32 = 1;
const MI_INT32: u32 = 5;
const MI_UINT32: u32 = 6;
const MI_MATRIX: u32 = 14;
const MI_COMPRESSED: u32 = 15;
/// How long a variable's name may be [bytes]; MATLAB's own are at most 63.
const NAME: u32 = 1024;
/// How many dimensions an array may declare.
const DIMENSIONS: u32 = 32;
/// How many things that are no columns a file may hold.
const SKIPPED: usize = 4096;

/// True if a file that begins so is a MATLAB 5 file.
pub(crate) fn is_matlab(head: &[u8]) -> bool {
    head.starts_with(b"MATLAB 5.0 MAT-file")
}

/// Reads the arrays of real numbers of a MATLAB 5 file.
///
/// An N×1 or 1×N array is a column, an N×M array is M columns `name[1]`, `name[2]` and on.
/// What is anything else, or of another length than most numbers, is named in [`Sheet::skipped`].
pub fn read_matlab(mut input: impl Read) -> Result<Sheet, SheetError> {
    let mut header = [0; 128];
    input.read_exact(&mut header).map_err(|e| broken("the header", &e))?;
    let big = match &header[126..] {
        b"IM" => false,
        b"MI" => true,
        other => {
            let found = format!("`{}` at offset 126", shown(&String::from_utf8_lossy(other)));
            return Err(SheetError::content("the header", found, "`IM` or `MI`, the byte order"));
        }
    };
    let mut found = Variables::default();
    loop {
        let place = format!("variable {}", found.met + 1);
        let Some((kind, size)) = top(&mut input, big).map_err(|e| broken(&place, &e))? else {
            break;
        };
        let mut element = input.by_ref().take(u64::from(size));
        match kind {
            MI_COMPRESSED => {
                let mut inner = Source { input: ZlibDecoder::new(&mut element), big };
                let (kind, _) = inner.tag().map_err(|e| broken(&place, &e))?;
                if kind == MI_MATRIX {
                    found.read(&mut inner)?;
                }
            }
            MI_MATRIX => found.read(&mut Source { input: &mut element, big })?,
            _ => {}
        }
        // What was not of interest.
        io::copy(&mut element, &mut io::sink()).map_err(|e| broken(&place, &e))?;
        if element.limit() > 0 {
            return Err(ended(&place));
        }
    }
    Sheet::of_most(found.columns, found.skipped)
}

/// The next element's type and size, or none at the end of the file.
fn top(input: &mut impl Read, big: bool) -> io::Result<Option<(u32, u32)>> {
    let mut tag = [0; 8];
    if input.read(&mut tag[..1])? == 0 {
        return Ok(None);
    }
    input.read_exact(&mut tag[1..])?;
    let [a, b, c, d, e, f, g, h] = tag;
    Ok(Some((u32_of([a, b, c, d], big), u32_of([e, f, g, h], big))))
}

fn u32_of(bytes: [u8; 4], big: bool) -> u32 {
    if big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
}

fn ended(place: &str) -> SheetError {
    SheetError::content(place, "the end of the file", "the bytes its size declares")
}

/// Bytes that cannot be had: the file ends, or what is compressed is not.
fn broken(place: &str, error: &io::Error) -> SheetError {
    if error.kind() == io::ErrorKind::UnexpectedEof {
        return ended(place);
    }
    SheetError::content(place, format!("bytes that cannot be read ({error})"), "MATLAB 5 data")
}

/// What was found so far.
#[derive(Default)]
struct Variables {
    columns: Vec<SheetColumn>,
    skipped: Vec<Skipped>,
    cells: usize,
    met: usize,
}

impl Variables {
    /// Reads one variable: its columns, or why it has none.
    fn read<R: Read>(&mut self, source: &mut Source<R>) -> Result<(), SheetError> {
        self.met += 1;
        let place = format!("variable {}", self.met);
        let about = About::read(source, &place)?;
        let place = format!("variable `{}`", shown(&about.name));
        if let Some(what) = about.no_columns() {
            if self.skipped.len() == SKIPPED {
                let found = format!("more than {SKIPPED} variables that are no columns");
                return Err(SheetError::cap(place, found, SKIPPED.to_string()));
            }
            self.skipped.push(Skipped { name: about.name, what });
            return Ok(());
        }
        let (rows, columns) = about.shape();
        let cells = rows.saturating_mul(columns);
        if rows > ROWS
            || self.columns.len().saturating_add(columns) > COLUMNS
            || self.cells.saturating_add(cells) > CELLS
        {
            let found = format!("{rows} rows of {columns} columns after {} cells", self.cells);
            let cap = format!("{ROWS} rows, {COLUMNS} columns and {CELLS} cells");
            return Err(SheetError::cap(place, found, cap));
        }
        self.cells += cells;
        let data = source.data(&place, cells)?;
        for column in 1..=columns {
            let mut numbers = Vec::new();
            source.numbers(data, rows, &mut numbers).map_err(|e| broken(&place, &e))?;
            let name = &about.name;
            let name = if columns == 1 { name.clone() } else { format!("{name}[{column}]") };
            self.columns.push(SheetColumn { name, cells: Cells::Numbers(numbers), blanks: 0 });
        }
        Ok(())
    }
}

/// What stands before a variable's numbers.
struct About {
    name: String,
    class: u8,
    complex: bool,
    dimensions: Vec<usize>,
}

impl About {
    fn read<R: Read>(source: &mut Source<R>, place: &str) -> Result<Self, SheetError> {
        let flags = source.bytes(place, "array flags", MI_UINT32, 8)?;
        let dimensions = source.bytes(place, "dimensions", MI_INT32, 4 * DIMENSIONS)?;
        let name = source.bytes(place, "name", MI_INT8, NAME)?;
        let word = |bytes: &[u8]| bytes.first_chunk().map_or(0, |bytes| u32_of(*bytes, source.big));
        let flags = word(&flags);
        let sizes = dimensions.chunks(4).map(|bytes| word(bytes) as usize).collect::<Vec<_>>();
        Ok(Self {
            name: String::from_utf8_lossy(&name).into_owned(),
            class: (flags & 0xFF) as u8,
            complex: flags & 0x0800 != 0,
            dimensions: sizes,
        })
    }

    /// What it is, if it is no array of real numbers with at least one row and one column.
    fn no_columns(&self) -> Option<String> {
        let what = match self.class {
            // What MATLAB keeps beside its objects: a long array of bytes.
            _ if self.name.is_empty() => "without a name",
            1 => "a cell array",
            2 => "a structure",
            3 | 17 => "an object",
            4 => "text",
            5 => "a sparse array",
            6..=15 if self.complex => "a complex array",
            6..=15 if self.dimensions.contains(&0) => "an empty array",
            6..=15 if self.dimensions.len() == 2 => return None,
            6..=15 => "an array of other than two dimensions",
            16 => "a function",
            other => return Some(format!("of the unknown class {other}")),
        };
        Some(what.to_owned())
    }

    /// Rows and columns; a single row is a column.
    fn shape(&self) -> (usize, usize) {
        match self.dimensions[..] {
            [1, n] => (n, 1),
            [n, m] => (n, m),
            _ => (0, 0),
        }
    }
}

/// How the numbers of an array are stored, whatever its class is.
#[derive(Clone, Copy)]
struct Stored {
    width: usize,
    value: fn([u8; 8]) -> f64,
}

impl Stored {
    /// By the type of an element; the value is made from its bytes, the least first.
    #[expect(clippy::cast_lossless, reason = "one line for every type of number")]
    fn of(kind: u32) -> Option<Self> {
        macro_rules! stored {
            ($($kind:literal = $number:ty),*) => {
                match kind {
                    $($kind => Some(Self {
                        width: size_of::<$number>(),
                        value: |bytes| {
                            let mut own = [0; size_of::<$number>()];
                            own.copy_from_slice(&bytes[..size_of::<$number>()]);
                            <$number>::from_le_bytes(own) as f64
                        },
                    }),)*
                    _ => None,
                }
            };
        }
        stored!(
            1 = i8,
            2 = u8,
            3 = i16,
            4 = u16,
            5 = i32,
            6 = u32,
            7 = f32,
            9 = f64,
            12 = i64,
            13 = u64
        )
    }
}

/// Bytes in a byte order.
struct Source<R> {
    input: R,
    big: bool,
}

impl<R: Read> Source<R> {
    fn word(&mut self) -> io::Result<u32> {
        let mut bytes = [0; 4];
        self.input.read_exact(&mut bytes)?;
        Ok(u32_of(bytes, self.big))
    }

    /// Type and size of an element, the size of a small one in the upper half of its first word.
    fn tag(&mut self) -> io::Result<(u32, u32)> {
        let first = self.word()?;
        if first >> 16 == 0 { Ok((first, self.word()?)) } else { Ok((first & 0xFFFF, first >> 16)) }
    }

    /// Like [`Self::tag`], and how many bytes its content fills up to the next element.
    fn padded(&mut self) -> io::Result<(u32, u32, u64)> {
        let first = self.word()?;
        if first >> 16 != 0 {
            return Ok((first & 0xFFFF, first >> 16, 4));
        }
        let size = self.word()?;
        Ok((first, size, u64::from(size).next_multiple_of(8)))
    }

    /// The content of a short element of this type and at most this size.
    fn bytes(
        &mut self,
        place: &str,
        what: &str,
        kind: u32,
        most: u32,
    ) -> Result<Vec<u8>, SheetError> {
        let (found, size, padded) = self.padded().map_err(|e| broken(place, &e))?;
        if found != kind || size > most || u64::from(size) > padded {
            let found = format!("an element of type {found} and {size} bytes for its {what}");
            let expected = format!("type {kind} and at most {most} bytes");
            return Err(SheetError::content(place, found, expected));
        }
        let mut bytes = Vec::new();
        self.input.by_ref().take(padded).read_to_end(&mut bytes).map_err(|e| broken(place, &e))?;
        if bytes.len() as u64 != padded {
            return Err(ended(place));
        }
        bytes.truncate(size as usize);
        Ok(bytes)
    }

    /// How the numbers that follow are stored, of which there have to be so many.
    fn data(&mut self, place: &str, cells: usize) -> Result<Stored, SheetError> {
        let (kind, size) = self.tag().map_err(|e| broken(place, &e))?;
        match Stored::of(kind) {
            Some(stored) if stored.width as u64 * cells as u64 == u64::from(size) => Ok(stored),
            _ => {
                let found = format!("data of type {kind} and {size} bytes");
                Err(SheetError::content(place, found, format!("{cells} numbers")))
            }
        }
    }

    /// The next `n` numbers; memory is taken as they arrive.
    fn numbers(&mut self, stored: Stored, n: usize, numbers: &mut Vec<f64>) -> io::Result<()> {
        let mut block = [0; 1 << 13];
        while numbers.len() < n {
            let due = ((n - numbers.len()) * stored.width).min(block.len());
            self.input.read_exact(&mut block[..due])?;
            for bytes in block[..due].chunks_exact(stored.width) {
                let mut own = [0; 8];
                own[..stored.width].copy_from_slice(bytes);
                if self.big {
                    own[..stored.width].reverse();
                }
                numbers.push((stored.value)(own));
            }
        }
        Ok(())
    }
}
