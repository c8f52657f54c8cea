//! Rows of a fixed type, as a polars frame and as CSV.

use crate::RecordError;
use polars::prelude::{
    Column, CsvReadOptions, CsvWriter, DataFrame, DataType, Field, PlSmallStr, Schema, SerReader,
    SerWriter,
};
use std::{fs, io::Cursor, path::Path, sync::Arc};

/// A type that can stand in a column.
pub trait Cell: Sized {
    /// The column's type in a frame and when its CSV is read.
    const TYPE: DataType;
    /// The column of these values.
    fn column(name: &str, values: Vec<Self>) -> Column;
    /// The values of that column, or `None` if the column has another type or a hole where none may be.
    fn values(column: &Column) -> Option<Vec<Self>>;
}

macro_rules! cell {
    ($rust:ty, $type:expr, $own:ident, $default:expr) => {
        impl Cell for Option<$rust> {
            const TYPE: DataType = $type;
            fn column(name: &str, values: Vec<Self>) -> Column {
                Column::new(PlSmallStr::from_str(name), values)
            }
            fn values(column: &Column) -> Option<Vec<Self>> {
                Some(column.$own().ok()?.iter().map(|v| v.map(Into::into)).collect())
            }
        }
        impl Cell for $rust {
            const TYPE: DataType = $type;
            fn column(name: &str, values: Vec<Self>) -> Column {
                Column::new(PlSmallStr::from_str(name), values)
            }
            fn values(column: &Column) -> Option<Vec<Self>> {
                let default: Option<$rust> = $default;
                let values: Vec<Option<$rust>> = Cell::values(column)?;
                values.into_iter().map(|v| v.or_else(|| default.clone())).collect()
            }
        }
    };
}

cell!(f64, DataType::Float64, f64, None);
cell!(u64, DataType::UInt64, u64, None);
cell!(bool, DataType::Boolean, bool, None);
// An empty text and a missing one are the same thing in CSV.
cell!(String, DataType::String, str, Some(String::new()));

/// Rows that make a table: a frame in memory, a CSV file on disk.
pub trait Table: Sized {
    /// The headers, with units in brackets, in order, each with its type.
    fn columns() -> Vec<(&'static str, DataType)>;
    /// The rows as a frame.
    fn frame(rows: &[Self]) -> DataFrame;
    /// The frame's rows, or the header of the column that does not fit.
    fn rows(frame: &DataFrame) -> Result<Vec<Self>, &'static str>;

    /// The rows as CSV: shortest digits that read back to the same number, `\n` at line ends.
    fn to_csv(rows: &[Self]) -> Vec<u8> {
        let mut bytes = Vec::new();
        // Writing a frame of plain columns to memory has no way to fail.
        let written = CsvWriter::new(&mut bytes).finish(&mut Self::frame(rows));
        debug_assert!(written.is_ok(), "{written:?}");
        bytes
    }

    /// The rows of a CSV file.
    fn read(path: &Path) -> Result<Vec<Self>, RecordError> {
        let bytes = fs::read(path).map_err(|source| RecordError::Disk {
            path: path.to_path_buf(),
            what: "cannot read",
            source,
        })?;
        Self::from_csv(&bytes, path)
    }

    /// The rows of these bytes; `path` is for the message.
    fn from_csv(bytes: &[u8], path: &Path) -> Result<Vec<Self>, RecordError> {
        let table = |found: String, expected: String| RecordError::Table {
            path: path.to_path_buf(),
            found,
            expected,
        };
        let columns = Self::columns();
        let header = String::from_utf8_lossy(bytes.split(|b| *b == b'\n').next().unwrap_or(b""))
            .trim_end()
            .to_owned();
        let expected = columns.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(",");
        if header != expected {
            return Err(table(format!("the header is `{header}`"), format!("`{expected}`")));
        }
        let schema: Schema =
            columns.into_iter().map(|(name, kind)| Field::new(name.into(), kind)).collect();
        let frame = CsvReadOptions::default()
            .with_has_header(true)
            .with_schema(Some(Arc::new(schema)))
            .with_n_threads(Some(1))
            .into_reader_with_file_handle(Cursor::new(bytes))
            .finish()
            .map_err(|e| table(e.to_string(), "a table as `reproduce` writes it".to_owned()))?;
        Self::rows(&frame).map_err(|column| {
            table(format!("column `{column}` has a hole or a wrong type"), "a value".to_owned())
        })
    }
}

/// Declares a row type and its table in one place: field, type, header with unit.
macro_rules! table {
    ($(#[$meta:meta])* pub struct $name:ident { $($(#[$doc:meta])* $field:ident: $type:ty = $header:literal,)* }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
        pub struct $name { $($(#[$doc])* pub $field: $type,)* }

        impl $crate::Table for $name {
            fn columns() -> Vec<(&'static str, polars::prelude::DataType)> {
                vec![$(($header, <$type as $crate::Cell>::TYPE),)*]
            }
            fn frame(rows: &[Self]) -> polars::prelude::DataFrame {
                let columns = vec![$(<$type as $crate::Cell>::column(
                    $header, rows.iter().map(|row| row.$field.clone()).collect())),*];
                // Columns made from the same rows have the same length.
                polars::prelude::DataFrame::new(rows.len(), columns).unwrap_or_default()
            }
            fn rows(frame: &polars::prelude::DataFrame) -> Result<Vec<Self>, &'static str> {
                $(let mut $field = frame.column($header).ok()
                    .and_then(<$type as $crate::Cell>::values).ok_or($header)?.into_iter();)*
                let mut rows = Vec::with_capacity(frame.height());
                for _ in 0..frame.height() {
                    rows.push(Self { $($field: $field.next().ok_or($header)?,)* });
                }
                Ok(rows)
            }
        }
    };
}
pub(crate) use table;
