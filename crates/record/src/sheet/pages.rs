//! The pages of a Parquet column: unpacked under a cap, their numbers decoded one after the other.

use super::thrift::{Value, varint};
use std::cell::Cell;
use std::io::Read;

/// How large a page may be, packed or not [bytes].
const PAGE: usize = 32 << 20;
/// How many values a page's header may hold; real ones have some twenty.
const HEADER: usize = 1000;

/// Why a column gives no numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// It is sound, but written in a way that is not read here.
    Foreign(String),
    /// It is not what its file says of it.
    Damaged(String),
}

fn damaged(what: &str) -> Refusal {
    Refusal::Damaged(what.to_owned())
}

/// How a column's numbers are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Physical {
    /// One bit.
    Bool,
    /// Four bytes.
    I32,
    /// Four bytes without a sign.
    U32,
    /// Eight bytes.
    I64,
    /// Eight bytes without a sign.
    U64,
    /// Four bytes, IEEE 754.
    F32,
    /// Eight bytes, IEEE 754.
    F64,
}

impl Physical {
    fn width(self) -> usize {
        if matches!(self, Self::I64 | Self::U64 | Self::F64) { 8 } else { 4 }
    }

    /// The number of these bytes, the lowest first and zeros behind the fourth of a short one.
    fn number(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Self::Bool | Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::I64 => i64::from_le_bytes(bytes) as f64,
            Self::U64 => u64::from_le_bytes(bytes) as f64,
            Self::F64 => f64::from_le_bytes(bytes),
        }
    }
}

/// What the file says of a column's chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chunk<'a> {
    /// Its pages.
    pub(crate) bytes: &'a [u8],
    /// The number of its compression.
    pub(crate) codec: i64,
    /// How its numbers are stored.
    pub(crate) physical: Physical,
    /// Values may be missing.
    pub(crate) optional: bool,
    /// How many values it has, missing ones too.
    pub(crate) rows: usize,
    /// How many bytes may still be unpacked from this file, all columns together.
    pub(crate) budget: &'a Cell<usize>,
}

/// Adds the chunk's numbers to a column, NaN where one is missing; the answer is how many are missing.
pub(crate) fn decode(chunk: &Chunk<'_>, numbers: &mut Vec<f64>) -> Result<usize, Refusal> {
    let end = numbers.len() + chunk.rows;
    let mut rest = chunk.bytes;
    let mut dictionary = Vec::new();
    let mut missing = 0;
    while numbers.len() < end {
        let (header, size) = Value::read(rest, HEADER).ok_or_else(|| damaged("a page header"))?;
        let packed = header.size(3).filter(|n| *n <= PAGE);
        let body = packed.and_then(|n| rest.get(size..size + n));
        let body = body.ok_or_else(|| damaged("a page's size"))?;
        rest = &rest[size + body.len()..];
        match header.int(1) {
            Some(2) if dictionary.is_empty() => {
                dictionary = read_dictionary(chunk, &header, body)?;
            }
            Some(0 | 3) => {
                let page = Page::open(chunk, &header, body)?;
                if page.rows > end - numbers.len() {
                    return Err(damaged("pages with more values than the column has"));
                }
                missing += page.decode(chunk, &dictionary, numbers)?;
            }
            Some(1) => {}
            _ => return Err(damaged("a page of an unknown type")),
        }
    }
    Ok(missing)
}

/// The values of a dictionary.
fn read_dictionary(
    chunk: &Chunk<'_>,
    header: &Value<'_>,
    body: &[u8],
) -> Result<Vec<f64>, Refusal> {
    let bytes = unpacked(chunk, chunk.codec, body, unpacked_size(header)?)?;
    let n = header.field(7).and_then(|h| h.size(1));
    let n = n.filter(|n| n.saturating_mul(chunk.physical.width()) <= bytes.len());
    let n = n.ok_or_else(|| damaged("a dictionary's size"))?;
    let mut plain = Source::Plain { bytes: &bytes };
    (0..n).map(|_| plain.next(chunk.physical).ok_or_else(|| damaged("a dictionary"))).collect()
}

/// How large a page says it is when unpacked.
fn unpacked_size(header: &Value<'_>) -> Result<usize, Refusal> {
    header.size(2).filter(|n| *n <= PAGE).ok_or_else(|| damaged("a page's unpacked size"))
}

/// The bytes of a page unpacked, which have to be as many as its header says.
fn unpacked(chunk: &Chunk<'_>, codec: i64, packed: &[u8], size: usize) -> Result<Vec<u8>, Refusal> {
    let left = chunk.budget.get().checked_sub(size);
    chunk.budget.set(left.ok_or_else(|| damaged("more bytes in its pages than the cap of 2 GiB"))?);
    let wrong = |e: &dyn std::fmt::Display| {
        Refusal::Damaged(format!("a page that cannot be unpacked ({e})"))
    };
    let mut bytes = vec![0; if codec == 0 { 0 } else { size }];
    match codec {
        0 if packed.len() == size => bytes.extend_from_slice(packed),
        1 if snap::raw::decompress_len(packed).ok() == Some(size) => {
            snap::raw::Decoder::new().decompress(packed, &mut bytes).map_err(|e| wrong(&e))?;
        }
        0 | 1 => return Err(damaged("a page of another size than its header says")),
        2 => flate2::read::GzDecoder::new(packed).read_exact(&mut bytes).map_err(|e| wrong(&e))?,
        6 => {
            let n = zstd::bulk::decompress_to_buffer(packed, &mut bytes).map_err(|e| wrong(&e))?;
            if n != size {
                return Err(damaged("a page of another size than its header says"));
            }
        }
        other => {
            let name = match other {
                3 => "LZO",
                4 => "Brotli",
                5 | 7 => "LZ4",
                _ => "an unknown method",
            };
            let what = format!("compressed by {name} (none, snappy, gzip and zstd are read)");
            return Err(Refusal::Foreign(what));
        }
    }
    Ok(bytes)
}

/// A page of data, unpacked.
struct Page {
    rows: usize,
    encoding: i64,
    /// Which values are there, as a run-length code; empty if all are.
    levels: Vec<u8>,
    values: Vec<u8>,
}

impl Page {
    fn open(chunk: &Chunk<'_>, header: &Value<'_>, body: &[u8]) -> Result<Self, Refusal> {
        let size = unpacked_size(header)?;
        let second = header.int(1) == Some(3);
        let (about, encoding) = if second { (header.field(8), 4) } else { (header.field(5), 2) };
        let about = about.ok_or_else(|| damaged("a page without its header"))?;
        let rows = about.size(1).ok_or_else(|| damaged("a page without a count"))?;
        let encoding = about.int(encoding).ok_or_else(|| damaged("a page without an encoding"))?;
        let page = |levels, values| Self { rows, encoding, levels, values };
        if second {
            let count = |id| about.size(id).filter(|n| *n <= body.len());
            let ends = count(6).and_then(|repeats| Some((repeats, repeats + count(5)?)));
            let (levels, end) = ends
                .filter(|(_, end)| *end <= body.len() && *end <= size)
                .ok_or_else(|| damaged("a page's levels"))?;
            let codec = if about.field(7) == Some(&Value::Bool(false)) { 0 } else { chunk.codec };
            let packed = &body[end..];
            // A page without values need not hold an empty compressed block.
            let empty = packed.is_empty() && size == end;
            let values =
                if empty { Vec::new() } else { unpacked(chunk, codec, packed, size - end)? };
            return Ok(page(body[levels..end].to_vec(), values));
        }
        let mut values = unpacked(chunk, chunk.codec, body, size)?;
        if !chunk.optional {
            return Ok(page(Vec::new(), values));
        }
        if about.int(3).is_some_and(|kind| kind != 3) {
            return Err(Refusal::Foreign("with levels that are no run-length code".to_owned()));
        }
        let n = values.first_chunk().map(|n| u32::from_le_bytes(*n) as usize);
        let n = n.filter(|n| *n <= values.len() - 4).ok_or_else(|| damaged("a page's levels"))?;
        let levels = values[4..4 + n].to_vec();
        values.drain(..4 + n);
        Ok(page(levels, values))
    }

    fn decode(
        &self,
        chunk: &Chunk<'_>,
        dictionary: &[f64],
        numbers: &mut Vec<f64>,
    ) -> Result<usize, Refusal> {
        let mut levels = chunk.optional.then(|| Hybrid::new(&self.levels, 1));
        let mut source = self.source(chunk.physical, dictionary)?;
        let mut missing = 0;
        for _ in 0..self.rows {
            let there = match &mut levels {
                Some(levels) => levels.next().ok_or_else(|| damaged("too few levels"))? == 1,
                None => true,
            };
            if there {
                let number = source.next(chunk.physical);
                numbers.push(number.ok_or_else(|| damaged("too few values, or none such"))?);
            } else {
                numbers.push(f64::NAN);
                missing += 1;
            }
        }
        Ok(missing)
    }

    fn source<'a>(
        &'a self,
        physical: Physical,
        dictionary: &'a [f64],
    ) -> Result<Source<'a>, Refusal> {
        let bytes = self.values.as_slice();
        Ok(match (self.encoding, physical) {
            (0, Physical::Bool) => Source::Bits { bytes, at: 0 },
            (0, _) => Source::Plain { bytes },
            (2 | 8, _) => {
                let (width, bytes) = bytes.split_first().unwrap_or((&0, &[]));
                Source::Dictionary { places: Hybrid::new(bytes, *width), dictionary }
            }
            (3, Physical::Bool) => {
                Source::Runs { bits: Hybrid::new(bytes.get(4..).unwrap_or_default(), 1) }
            }
            (9, _) => Source::Split { bytes, at: 0 },
            (other, _) => {
                let name = match other {
                    3 => "RLE",
                    5 => "DELTA_BINARY_PACKED",
                    _ => "of an unknown kind",
                };
                let what = format!("in the encoding {name} (plain, dictionary and split are read)");
                return Err(Refusal::Foreign(what));
            }
        })
    }
}

/// Where the numbers of a page come from.
enum Source<'a> {
    Plain { bytes: &'a [u8] },
    Bits { bytes: &'a [u8], at: usize },
    Runs { bits: Hybrid<'a> },
    Dictionary { places: Hybrid<'a>, dictionary: &'a [f64] },
    Split { bytes: &'a [u8], at: usize },
}

impl Source<'_> {
    fn next(&mut self, physical: Physical) -> Option<f64> {
        let width = physical.width();
        let mut own = [0; 8];
        match self {
            Self::Plain { bytes } => {
                let (first, rest) = bytes.split_at_checked(width)?;
                own[..width].copy_from_slice(first);
                *bytes = rest;
                Some(physical.number(own))
            }
            Self::Bits { bytes, at } => {
                let bit = bytes.get(*at / 8)? >> (*at % 8) & 1;
                *at += 1;
                Some(f64::from(bit))
            }
            Self::Runs { bits } => bits.next().map(f64::from),
            Self::Dictionary { places, dictionary } => {
                dictionary.get(places.next()? as usize).copied()
            }
            Self::Split { bytes, at } => {
                // The first bytes of all numbers, then their second bytes, and so on.
                let n = bytes.len() / width;
                for (k, own) in own[..width].iter_mut().enumerate() {
                    *own = *bytes.get(k * n + *at).filter(|_| *at < n)?;
                }
                *at += 1;
                Some(physical.number(own))
            }
        }
    }
}

/// Whole numbers below 2^width as runs of one value and as groups of eight packed ones, mixed.
struct Hybrid<'a> {
    bytes: &'a [u8],
    at: usize,
    width: u8,
    run: Run,
}

enum Run {
    /// So many more of this value.
    Same { left: u64, value: u32 },
    /// So many more packed values, the next at this bit.
    Packed { left: u64, bit: usize },
}

impl<'a> Hybrid<'a> {
    fn new(bytes: &'a [u8], width: u8) -> Self {
        Self { bytes, at: 0, width, run: Run::Same { left: 0, value: 0 } }
    }

    fn next(&mut self) -> Option<u32> {
        loop {
            match &mut self.run {
                Run::Same { left, value } if *left > 0 => {
                    *left -= 1;
                    return Some(*value);
                }
                Run::Packed { left, bit } if *left > 0 => {
                    let value = bits(self.bytes, *bit, self.width)?;
                    *left -= 1;
                    *bit += usize::from(self.width);
                    return Some(value);
                }
                _ => self.begin_run()?,
            }
        }
    }

    fn begin_run(&mut self) -> Option<()> {
        if self.width > 32 {
            return None;
        }
        let head = varint(self.bytes, &mut self.at)?;
        let (left, bytes) = (head >> 1, usize::from(self.width.div_ceil(8)));
        if left == 0 {
            return None;
        }
        if head & 1 == 0 {
            let value = bits(self.bytes, self.at.checked_mul(8)?, self.width)?;
            self.at += bytes;
            self.run = Run::Same { left, value };
        } else {
            let size = usize::try_from(left).ok()?.checked_mul(usize::from(self.width))?;
            self.run = Run::Packed { left: left.checked_mul(8)?, bit: self.at.checked_mul(8)? };
            self.at = self.at.checked_add(size)?;
        }
        Some(())
    }
}

/// The `width` bits from a bit on, the lowest first.
fn bits(bytes: &[u8], bit: usize, width: u8) -> Option<u32> {
    if width == 0 {
        return Some(0);
    }
    let end = bit.checked_add(usize::from(width))?.div_ceil(8);
    let mut word = 0_u64;
    for (k, byte) in bytes.get(bit / 8..end)?.iter().enumerate() {
        word |= u64::from(*byte) << (8 * k);
    }
    u32::try_from(word >> (bit % 8) & ((1 << width) - 1)).ok()
}
