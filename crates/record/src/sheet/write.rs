//! Records written down.

use crate::{RecordError, write_whole};
use polars::prelude::{
    Column, CsvWriter, DataFrame, ParquetWriter, PlSmallStr, PolarsResult, SerWriter,
};
use std::path::Path;

/// Writes columns of equal length and different names as a CSV file, whole: shortest digits that read back to
/// the same number, NaN where a number is none.
///
/// The answer says whether the file was written; one that holds these bytes already is left untouched.
pub fn write_sheet_csv(path: &Path, columns: &[(&str, &[f64])]) -> Result<bool, RecordError> {
    let write = |frame: &mut DataFrame, bytes: &mut Vec<u8>| CsvWriter::new(bytes).finish(frame);
    write_frame(path, columns, write)
}

/// Writes columns of equal length and different names as a Parquet file, whole.
///
/// The answer says whether the file was written; one that holds these bytes already is left untouched.
pub fn write_sheet_parquet(path: &Path, columns: &[(&str, &[f64])]) -> Result<bool, RecordError> {
    let write = |frame: &mut DataFrame, bytes: &mut Vec<u8>| {
        ParquetWriter::new(bytes).finish(frame).map(|_| ())
    };
    write_frame(path, columns, write)
}

fn write_frame(
    path: &Path,
    columns: &[(&str, &[f64])],
    write: impl Fn(&mut DataFrame, &mut Vec<u8>) -> PolarsResult<()>,
) -> Result<bool, RecordError> {
    let rows = columns.first().map_or(0, |(_, numbers)| numbers.len());
    let mut bytes = Vec::new();
    let series = columns
        .iter()
        .map(|(name, numbers)| Column::new(PlSmallStr::from_str(name), *numbers))
        .collect();
    DataFrame::new(rows, series).and_then(|mut frame| write(&mut frame, &mut bytes)).map_err(
        |e| RecordError::Table {
            path: path.to_path_buf(),
            found: e.to_string(),
            expected: "columns of equal length and different names".to_owned(),
        },
    )?;
    write_whole(path, &bytes)
}
