//! All tables of one experiment: what is committed, and what the report is rendered from.

use crate::{
    AboutRow, CaseRow, ClaimRow, CurveRow, FigureRow, MeasureRow, OrderRow, PanelRow, RecordError,
    StudyRow, Table,
};
use std::path::Path;

macro_rules! summary {
    ($($(#[$doc:meta])* $field:ident: $row:ty = $file:literal,)*) => {
        /// All tables of one experiment.
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct Summary {
            /// The experiment's name.
            pub name: String,
            $($(#[$doc])* pub $field: Vec<$row>,)*
        }

        impl Summary {
            /// The tables' file names.
            pub const FILES: &'static [&'static str] = &[$($file,)*];

            /// The files of the summary: name and content.
            pub fn files(&self) -> Vec<(&'static str, Vec<u8>)> {
                vec![$(($file, <$row>::to_csv(&self.$field)),)*]
            }

            /// Reads the tables from a folder `…/NAME`.
            pub fn read(folder: &Path) -> Result<Self, RecordError> {
                let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
                Ok(Self { name, $($field: <$row>::read(&folder.join($file))?,)* })
            }
        }
    };
}

summary! {
    /// What there is to say of the whole.
    about: AboutRow = "about.csv",
    /// The studies.
    studies: StudyRow = "studies.csv",
    /// Every case.
    cases: CaseRow = "cases.csv",
    /// The observed orders.
    orders: OrderRow = "orders.csv",
    /// The measured quantities.
    measures: MeasureRow = "measures.csv",
    /// The claims with their verdicts.
    claims: ClaimRow = "claims.csv",
    /// The figures to draw.
    figures: FigureRow = "figures.csv",
    /// The axes of figures of curves.
    panels: PanelRow = "panels.csv",
    /// The curves themselves.
    curves: CurveRow = "curves.csv",
}

impl Summary {
    /// The value told under `key`, or the empty text.
    pub fn about(&self, key: &str) -> &str {
        self.about.iter().find(|row| row.key == key).map_or("", |row| &row.value)
    }
}
