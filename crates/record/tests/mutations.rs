//! A file damaged in any way ends in a sheet or an error, never in a crash, and is soon done with.
//!
//! `DUHEM_MUTATIONS=10000000 cargo test --workspace --test mutations csv` tries more of them.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use record::{Sheet, SheetError, read_csv, read_matlab, read_parquet};
use std::fs;
use std::io::Cursor;
use std::path::Path;

/// SplitMix64: the same mutations on every machine.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.next() % n.max(1) as u64).unwrap()
    }
}

/// One to four injuries: a bit or a byte changed, bytes of a kind that lies about sizes put in, a piece cut out,
/// doubled or moved, the end lost.
fn injure(bytes: &mut Vec<u8>, dice: &mut Dice) {
    for _ in 0..=dice.below(4) {
        let at = dice.below(bytes.len());
        let end = (at + 1 + dice.below(16)).min(bytes.len());
        match dice.below(8) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << dice.below(8),
            1 if !bytes.is_empty() => bytes[at] = u8::try_from(dice.below(256)).unwrap(),
            2 => bytes.insert(at, b"\",;\t\n\r\0\xFF.-e9"[dice.below(12)]),
            3 if !bytes.is_empty() => bytes[at] = [0, 0x7F, 0x80, 0xFF][dice.below(4)],
            4 => bytes.splice(at..at, [0xFF, 0xFF, 0xFF, 0x7F]).for_each(drop),
            5 => bytes.drain(at..end).for_each(drop),
            6 => {
                let piece = bytes[at..end].to_vec();
                let to = dice.below(bytes.len());
                bytes.splice(to..to, piece).for_each(drop);
            }
            _ => bytes.truncate(bytes.len() - dice.below(bytes.len() / 4)),
        }
    }
}

/// How many mutations to try.
fn tries() -> u64 {
    std::env::var("DUHEM_MUTATIONS").map_or(100_000, |n| n.parse().unwrap())
}

/// Reads injured copies of the seeds; both ends must occur, or the injuries are too light or too grave.
fn survive(seeds: &[Vec<u8>], read: impl Fn(&[u8]) -> Result<Sheet, SheetError>) {
    for seed in seeds {
        read(seed).unwrap();
    }
    let mut dice = Dice(seeds.len() as u64);
    let (mut sheets, mut errors) = (0_u64, 0_u64);
    for _ in 0..tries() {
        let mut bytes = seeds[dice.below(seeds.len())].clone();
        injure(&mut bytes, &mut dice);
        match read(&bytes) {
            Ok(sheet) => {
                sheets += 1;
                assert!(sheet.rows() <= 100_000, "{} rows of {} bytes", sheet.rows(), bytes.len());
            }
            Err(error) => {
                errors += 1;
                let text = error.to_string();
                assert!(text.len() < 20_000, "a message of {} bytes", text.len());
                assert!(!text.contains(|c: char| c.is_control()), "{text:?}");
            }
        }
    }
    assert!(sheets > tries() / 100 && errors > tries() / 100, "{sheets} sheets, {errors} errors");
}

/// The files of a folder of the tests, in order.
fn seeds(folder: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder);
    let mut paths: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().map(|path| fs::read(path).unwrap()).collect()
}

#[test]
fn damaged_csv_ends_in_a_sheet_or_an_error() {
    let texts = [
        "t [s],F [N]\n0,1.5\n0.1,\n0.2,NaN\n",
        "\u{FEFF}t;F;\"a;\"\"b\"\"\"\r\n0;1,5;x\r\n0,1;-1e-3;\"two\r\nlines\"\r\n\r\n0,2;1e308;\r\n",
        "t\tF\r0\t1\r1\tinf\r",
        "a,b,c,d,e,f,g,h\n1,2,3,4,5,6,7,8\n1,2,3,4,5,6,7,8\n",
    ];
    survive(&texts.map(|text| text.as_bytes().to_vec()), |bytes| read_csv(bytes));
}

#[test]
fn a_damaged_matlab_file_ends_in_a_sheet_or_an_error() {
    survive(&seeds("mat"), |bytes| read_matlab(bytes));
}

#[test]
fn a_damaged_parquet_file_ends_in_a_sheet_or_an_error() {
    survive(&seeds("parquet"), |bytes| read_parquet(Cursor::new(bytes)));
}
