//! Writes a report to look at: `look FOLDER` the made-up ones, `look FOLDER reports/NAME …` of real tables.

#[path = "../tests/fixture/mod.rs"]
mod fixture;

use record::{Summary, write_whole};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let folder = words.next().ok_or("expected a folder to write to")?;
    let mut summaries =
        words.map(|name| Summary::read(Path::new(&name))).collect::<Result<Vec<_>, _>>()?;
    if summaries.is_empty() {
        summaries = fixture::five();
    }
    for output in report::render(&summaries)? {
        write_whole(&Path::new(&folder).join(&output.path), &output.bytes)?;
    }
    Ok(())
}
