//! All tables of one experiment: what is committed, and what the report is rendered from.

use crate::{
    AboutRow, CaseRow, ClaimRow, CurveRow, DiscoveryRow, EffectRow, FigureRow, FitRow, GapRow,
    MeasureRow, MisfitRow, ModelRow, OrderRow, PanelRow, ParameterRow, RankedRow, RecordError,
    ShareRow, StudyRow, Table,
};
use std::path::Path;

macro_rules! summary {
    ($($(#[$doc:meta])* $field:ident: $row:ty = $file:literal,)*
     ; $($(#[$more_doc:meta])* $more:ident: $more_row:ty = $more_file:literal,)*) => {
        /// All tables of one experiment.
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct Summary {
            /// The experiment's name.
            pub name: String,
            $($(#[$doc])* pub $field: Vec<$row>,)*
            $($(#[$more_doc])* pub $more: Vec<$more_row>,)*
        }

        impl Summary {
            /// The tables' file names.
            pub const FILES: &'static [&'static str] = &[$($file,)* $($more_file,)*];

            /// The files of the summary: name and content. What only some experiments have is left out where
            /// there is none of it.
            pub fn files(&self) -> Vec<(&'static str, Vec<u8>)> {
                let mut files = vec![$(($file, <$row>::to_csv(&self.$field)),)*];
                $(if !self.$more.is_empty() {
                    files.push(($more_file, <$more_row>::to_csv(&self.$more)));
                })*
                files
            }

            /// Reads the tables from a folder `…/NAME`.
            pub fn read(folder: &Path) -> Result<Self, RecordError> {
                let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
                Ok(Self {
                    name,
                    $($field: <$row>::read(&folder.join($file))?,)*
                    $($more: if_there::<$more_row>(&folder.join($more_file))?,)*
                })
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
    ;
    /// The fits to records.
    fits: FitRow = "fits.csv",
    /// The parameters of fits and searches.
    parameters: ParameterRow = "parameters.csv",
    /// The friction models against one another.
    models: ModelRow = "models.csv",
    /// The misfit of every channel.
    misfits: MisfitRow = "misfits.csv",
    /// The searches for what a model lacks.
    discoveries: DiscoveryRow = "discoveries.csv",
    /// The effects that were named.
    effects: EffectRow = "effects.csv",
    /// The gap of every channel.
    gaps: GapRow = "gaps.csv",
    /// The candidates.
    ranking: RankedRow = "ranking.csv",
    /// Where the excess is.
    shares: ShareRow = "shares.csv",
}

/// The rows of a table that only some experiments have; none where there is no file.
fn if_there<T: Table>(path: &Path) -> Result<Vec<T>, RecordError> {
    if path.is_file() { T::read(path) } else { Ok(Vec::new()) }
}

impl Summary {
    /// The value told under `key`, or the empty text.
    pub fn about(&self, key: &str) -> &str {
        self.about.iter().find(|row| row.key == key).map_or("", |row| &row.value)
    }
}
