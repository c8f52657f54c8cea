//! The compact protocol of Thrift, in which a Parquet file tells of itself, as a bounded tree.
//!
//! Why not the reader that comes with polars: one damaged file in some thousands makes it ask for 2⁶¹ bytes,
//! which ends the program and cannot be caught. Here nothing is reserved that has not been read.

/// How deep values may lie in each other.
const DEPTH: usize = 16;

/// A value, its bytes still where they were read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value<'a> {
    /// Truth.
    Bool(bool),
    /// A whole number of any width.
    Int(i64),
    /// A text or other bytes.
    Bytes(&'a [u8]),
    /// Values of one type.
    List(Vec<Value<'a>>),
    /// Fields by their numbers.
    Struct(Vec<(i64, Value<'a>)>),
    /// Something that a Parquet file's own tables never need.
    Other,
}

impl<'a> Value<'a> {
    /// The struct that these bytes begin with, of at most so many values, and how many bytes it fills.
    pub(crate) fn read(bytes: &'a [u8], most: usize) -> Option<(Self, usize)> {
        let mut input = Input { bytes, at: 0, left: most };
        let value = input.structure(DEPTH)?;
        Some((value, input.at))
    }

    /// The field of this number.
    pub(crate) fn field(&self, id: i64) -> Option<&Self> {
        let Self::Struct(fields) = self else { return None };
        fields.iter().find(|(i, _)| *i == id).map(|(_, value)| value)
    }

    /// The whole number in the field of this number.
    pub(crate) fn int(&self, id: i64) -> Option<i64> {
        if let Some(Self::Int(n)) = self.field(id) { Some(*n) } else { None }
    }

    /// The size in the field of this number: a whole number that is not negative.
    pub(crate) fn size(&self, id: i64) -> Option<usize> {
        self.int(id).and_then(|n| usize::try_from(n).ok())
    }

    /// The bytes in the field of this number.
    pub(crate) fn bytes(&self, id: i64) -> Option<&'a [u8]> {
        if let Some(Self::Bytes(bytes)) = self.field(id) { Some(bytes) } else { None }
    }

    /// The list in the field of this number.
    pub(crate) fn list(&self, id: i64) -> Option<&[Self]> {
        if let Some(Self::List(list)) = self.field(id) { Some(list) } else { None }
    }
}

struct Input<'a> {
    bytes: &'a [u8],
    at: usize,
    /// How many more values there may be.
    left: usize,
}

impl<'a> Input<'a> {
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn slice(&mut self, n: usize) -> Option<&'a [u8]> {
        let slice = self.bytes.get(self.at..self.at.checked_add(n)?)?;
        self.at += n;
        Some(slice)
    }

    fn varint(&mut self) -> Option<u64> {
        varint(self.bytes, &mut self.at)
    }

    /// A whole number whose sign is in its lowest bit.
    fn zigzag(&mut self) -> Option<i64> {
        let n = self.varint()?;
        Some((n >> 1).cast_signed() ^ -(n & 1).cast_signed())
    }

    /// A value of the protocol's type `kind` that stands in a list or a field.
    fn value(&mut self, kind: u8, depth: usize) -> Option<Value<'a>> {
        self.left = self.left.checked_sub(1)?;
        Some(match kind {
            3 => Value::Int(i64::from(self.byte()?.cast_signed())),
            4..=6 => Value::Int(self.zigzag()?),
            7 => self.slice(8).map(|_| Value::Other)?,
            8 => {
                let n = usize::try_from(self.varint()?).ok()?;
                Value::Bytes(self.slice(n)?)
            }
            9 | 10 => self.list(depth.checked_sub(1)?)?,
            12 => self.structure(depth.checked_sub(1)?)?,
            _ => return None,
        })
    }

    fn list(&mut self, depth: usize) -> Option<Value<'a>> {
        let head = self.byte()?;
        let n = if head >> 4 == 15 { self.varint()? } else { u64::from(head >> 4) };
        let kind = head & 15;
        let mut values = Vec::new();
        for _ in 0..n {
            values.push(match kind {
                1 | 2 => {
                    self.left = self.left.checked_sub(1)?;
                    Value::Bool(self.byte()? == 1)
                }
                kind => self.value(kind, depth)?,
            });
        }
        Some(Value::List(values))
    }

    fn structure(&mut self, depth: usize) -> Option<Value<'a>> {
        let mut fields = Vec::new();
        let mut id = 0_i64;
        loop {
            let head = self.byte()?;
            if head == 0 {
                return Some(Value::Struct(fields));
            }
            id =
                if head >> 4 == 0 { self.zigzag()? } else { id.checked_add(i64::from(head >> 4))? };
            fields.push((
                id,
                match head & 15 {
                    1 => Value::Bool(true),
                    2 => Value::Bool(false),
                    kind => self.value(kind, depth)?,
                },
            ));
        }
    }
}

/// A whole number in groups of seven bits, the lowest first.
pub(crate) fn varint(bytes: &[u8], at: &mut usize) -> Option<u64> {
    let mut n = 0;
    for shift in (0..64).step_by(7) {
        let byte = *bytes.get(*at)?;
        *at += 1;
        n |= u64::from(byte & 0x7F) << shift;
        if byte & 0x80 == 0 {
            return Some(n);
        }
    }
    None
}
