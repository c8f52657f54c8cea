//! What is written down: the typed rows of every table, the tables as CSV files, and the store of case records.
//!
//! **Invariant**: knows no model, no solver and no plot.
//! A row here is text, numbers and units; what they mean is the business of those who write and read them.
//!
//! Read first: [`CaseRow`] (one cell of model × input × solver × control), [`Summary`] (all tables of one
//! experiment, what the report is rendered from), [`Store`] (finished cases on disk, under their content's key);
//! and for records of drives [`Sheet`].

mod discovered;
mod error;
mod file;
mod rows;
mod sheet;
mod store;
mod summary;
mod table;

pub use discovered::{DiscoveryRecord, DiscoveryRow, EffectRow, GapRow, RankedRow, ShareRow};
pub use error::RecordError;
pub use file::write_whole;
pub use rows::{
    AboutRow, CaseRow, ClaimRow, CurveRow, FigureRow, FitRow, MeasureRow, MisfitRow, ModelRow,
    OrderRow, PanelRow, ParameterRow, StudyRow,
};
pub use sheet::{
    CELLS, COLUMNS, Cells, ROWS, Sheet, SheetColumn, SheetError, Skipped, read_csv, read_matlab,
    read_parquet, read_sheet, write_sheet_csv, write_sheet_parquet,
};
pub use store::{CaseRecord, FitRecord, Found, History, Key, Store, sha256};
pub use summary::Summary;
pub use table::{Cell, Table};

/// The version of every file this crate writes; part of each record's key.
pub const FORMAT: u32 = 2;
