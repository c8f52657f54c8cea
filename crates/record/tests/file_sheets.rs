//! Records as Parquet and MATLAB files, and what a path may lead to.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use record::{
    Sheet, read_csv, read_matlab, read_parquet, read_sheet, write_sheet_csv, write_sheet_parquet,
};
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::Command;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}

/// Numbers equal to the last bit, NaN to NaN.
fn same(sheet: &Sheet, name: &str, expected: &[f64]) {
    let found = sheet.column(name).unwrap_or_else(|e| panic!("{name}: {e}"));
    let bits = |x: &[f64]| {
        x.iter().map(|x| if x.is_nan() { None } else { Some(x.to_bits()) }).collect::<Vec<_>>()
    };
    assert_eq!(bits(found), bits(expected), "{name}: {found:?} instead of {expected:?}");
}

/// i · 0.01 [s] as the program that made the files computed them.
fn times() -> Vec<f64> {
    (0..5).map(|i| f64::from(i) * 0.01).collect()
}

const NAN: f64 = f64::NAN;

#[test]
fn a_matlab_file_gives_the_numbers_of_every_class_packed_or_not() {
    for name in ["mat/plain.mat", "mat/compressed.mat"] {
        let sheet = read_sheet(&file(name)).unwrap();
        assert_eq!((sheet.rows(), sheet.columns.len(), sheet.line(0)), (5, 6, None));
        same(&sheet, "t", &times());
        same(&sheet, "i16", &[-3.0, -2.0, -1.0, 0.0, 7.0]);
        same(&sheet, "u8", &[0.0, 1.0, 255.0, 3.0, 4.0]);
        same(&sheet, "f32", &[0.5, 1.5, -2.25, NAN, f64::INFINITY]);
        same(&sheet, "m[1]", &[0.0, 2.0, 4.0, 6.0, 8.0]);
        same(&sheet, "m[2]", &[1.0, 3.0, 5.0, 7.0, 9.0]);
    }
}

#[test]
fn what_is_no_column_in_a_matlab_file_is_named_with_what_it_is() {
    let sheet = read_sheet(&file("mat/other.mat")).unwrap();
    same(&sheet, "t", &times());
    same(&sheet, "b", &[1.0, 0.0, 1.0, 1.0, 0.0]);
    for (name, what) in [
        ("text", "text"),
        ("s", "a structure"),
        ("c", "a cell array"),
        ("z", "a complex array"),
        ("sp", "a sparse array"),
        ("e", "an empty array"),
        ("cube", "of other than two dimensions"),
        ("fs", "of 1 rows where the record has 5"),
    ] {
        let text = sheet.column(name).unwrap_err().to_string();
        assert!(text.contains(&format!("`{name}` was not read")) && text.contains(what), "{text}");
    }
    assert_eq!(sheet.skipped.len(), 8);
}

/// A MATLAB 5 file in the byte order of a machine that writes the highest byte first, with one variable.
fn big_endian(class: u8, kind: u32, data: &[u8], rows: u32) -> Vec<u8> {
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.extend(b"\x01\x00MI");
    bytes.extend(variable(b"F", class, (kind, data), rows));
    bytes
}

/// A variable as such a file holds it.
fn variable(name: &[u8], class: u8, (kind, data): (u32, &[u8]), rows: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut body = Vec::new();
    for word in [6, 8, u32::from(class), 0, 5, 8, rows, 1] {
        body.extend(u32::to_be_bytes(word));
    }
    // A name of up to four letters stands in its tag.
    body.extend([0, u8::try_from(name.len()).unwrap(), 0, 1]);
    body.extend(name);
    body.resize(body.len().next_multiple_of(8), 0);
    body.extend(kind.to_be_bytes());
    body.extend(u32::try_from(data.len()).unwrap().to_be_bytes());
    body.extend(data);
    body.resize(body.len().next_multiple_of(8), 0);
    bytes.extend(14_u32.to_be_bytes());
    bytes.extend(u32::try_from(body.len()).unwrap().to_be_bytes());
    bytes.extend(body);
    bytes
}

#[test]
fn a_matlab_file_of_the_other_byte_order_is_read_in_every_type_of_number() {
    macro_rules! check {
        ($($kind:literal = $number:ty),*) => { $(
            let values: [$number; 3] = [1 as $number, 100 as $number, <$number>::MAX];
            let data: Vec<u8> = values.iter().flat_map(|x| x.to_be_bytes()).collect();
            let sheet = read_matlab(&big_endian(6, $kind, &data, 3)[..]).unwrap();
            same(&sheet, "F", &values.map(|x| x as f64));
        )* };
    }
    #[expect(clippy::cast_lossless, reason = "one line for every type of number")]
    {
        check!(
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
        );
    }
}

#[test]
fn constants_a_long_table_and_what_has_no_name_do_not_take_the_records_place() {
    let ten = [0; 10];
    let mut bytes = big_endian(9, 2, &ten, 10);
    bytes.extend(variable(b"t", 9, (2, &ten), 10));
    for name in [b"a", b"b", b"c", b"d", b"e"] {
        bytes.extend(variable(name, 9, (2, &[7]), 1));
    }
    bytes.extend(variable(b"cal", 9, (2, &[1; 15]), 15));
    bytes.extend(variable(b"", 9, (2, &[1; 5000]), 5000));
    let sheet = read_matlab(&bytes[..]).unwrap();
    assert_eq!((sheet.rows(), sheet.columns.len(), sheet.skipped.len()), (10, 2, 7));
    let text = sheet.column("cal").unwrap_err().to_string();
    assert!(text.contains("15 rows where the record has 10"), "{text}");
}

#[test]
fn a_matlab_file_that_lies_or_ends_is_refused_with_its_variable() {
    let good = big_endian(6, 9, &1.5_f64.to_be_bytes(), 1);
    same(&read_matlab(&good[..]).unwrap(), "F", &[1.5]);
    for (bytes, word) in [
        (good[..good.len() - 3].to_vec(), "`F`: found the end of the file"),
        (good[..130].to_vec(), "variable 1: found the end of the file"),
        (good[..128].to_vec(), "found no column"),
        (good[..100].to_vec(), "the header"),
        (big_endian(6, 9, &1.5_f64.to_be_bytes(), 2), "`F`: found data of type 9 and 8 bytes"),
        (big_endian(6, 9, &[], u32::MAX), "there may be at most"),
        (big_endian(4, 9, &1.5_f64.to_be_bytes(), 1), "only `F`, text"),
        (big_endian(99, 9, &1.5_f64.to_be_bytes(), 1), "unknown class 99"),
    ] {
        let text = read_matlab(&bytes[..]).unwrap_err().to_string();
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn a_parquet_file_of_other_programs_gives_its_numbers_and_names_the_rest() {
    for name in ["parquet/snappy.parquet", "parquet/gzip_v2.parquet"] {
        let sheet = read_sheet(&file(name)).unwrap();
        assert_eq!(sheet.rows(), 5, "{name}");
        same(&sheet, "t", &times());
        same(&sheet, "f", &[1.5, NAN, NAN, 2.5, 1.5]);
        same(&sheet, "n", &[1.0, 2.0, 2.0, NAN, -5.0]);
        same(&sheet, "u", &[1.0, 2.0, 3.0, 4.0, 1_099_511_627_776.0]);
        same(&sheet, "f32", &[0.5, 0.25, 1.0, 2.0, 3.0]);
        same(&sheet, "i8", &[-1.0, 2.0, 3.0, 4.0, 5.0]);
        same(&sheet, "flag", &[1.0, 0.0, NAN, 1.0, 1.0]);
        let blanks = |name| sheet.columns.iter().find(|c| c.name == name).unwrap().blanks;
        assert_eq!((blanks("f"), blanks("n"), blanks("t")), (1, 1, 0), "{name}");
        for (name, what) in [("name", "text"), ("when", "dates or times"), ("list", "nested")] {
            let text = sheet.column(name).unwrap_err().to_string();
            assert!(text.contains(what), "{text}");
        }
    }
}

#[test]
fn parquet_without_dictionaries_is_read_plain_and_split_and_other_encodings_are_named() {
    let plain = read_sheet(&file("parquet/plain.parquet")).unwrap();
    let split = read_sheet(&file("parquet/zstd_split.parquet")).unwrap();
    for sheet in [&plain, &split] {
        same(sheet, "t", &times());
        same(sheet, "f", &[1.5, NAN, NAN, 2.5, 1.5]);
    }
    same(&plain, "n", &[1.0, 2.0, 2.0, NAN, -5.0]);
    let text = split.column("n").unwrap_err().to_string();
    assert!(text.contains("DELTA_BINARY_PACKED"), "{text}");
}

#[test]
fn a_parquet_file_cut_anywhere_is_refused() {
    let whole = fs::read(file("parquet/snappy.parquet")).unwrap();
    for at in 0..whole.len() {
        read_parquet(Cursor::new(&whole[..at])).unwrap_err();
    }
    let lying = [&whole[..whole.len() - 8], &[0xFF; 4], b"PAR1"].concat();
    let text = read_parquet(Cursor::new(lying)).unwrap_err().to_string();
    assert!(text.contains("a Parquet footer of 4294967295 bytes"), "{text}");
}

#[test]
fn what_is_written_reads_back_to_the_last_bit() {
    let folder = tempfile::tempdir().unwrap();
    let t: Vec<f64> = (0..1000).map(|i| f64::from(i) / 3.0).collect();
    let mut f: Vec<f64> = t.iter().map(|t| (t * 1e3).sin() * 1e-300).collect();
    f[..4].copy_from_slice(&[NAN, f64::INFINITY, -0.0, 1e308]);
    let columns: [(&str, &[f64]); 2] = [("time_s", &t), ("F, \"left\" [N]", &f)];
    for (name, write) in [
        ("a.csv", write_sheet_csv as fn(&Path, &[(&str, &[f64])]) -> _),
        ("a.parquet", write_sheet_parquet),
    ] {
        let path = folder.path().join(name);
        assert!(write(&path, &columns).unwrap(), "{name} was there");
        assert!(!write(&path, &columns).unwrap(), "{name} was written twice");
        let sheet = read_sheet(&path).unwrap();
        same(&sheet, columns[0].0, &t);
        same(&sheet, columns[1].0, &f);
        let text = write(&path, &[("a", &t), ("b", &f[1..])]).unwrap_err().to_string();
        assert!(text.contains(name) && text.contains("equal length"), "{text}");
        write(&path, &[("a", &t), ("a", &t)]).unwrap_err();
    }
}

#[test]
fn the_content_says_what_a_file_is_and_its_ending_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    fs::copy(file("parquet/plain.parquet"), &path).unwrap();
    same(&read_sheet(&path).unwrap(), "t", &times());
    fs::copy(file("mat/plain.mat"), &path).unwrap();
    same(&read_sheet(&path).unwrap(), "t", &times());
    let path = folder.path().join("a.parquet");
    fs::write(&path, "t\n1\n").unwrap();
    same(&read_sheet(&path).unwrap(), "t", &[1.0]);
    assert_eq!(fs::read(&path).unwrap(), b"t\n1\n", "the input was changed");
}

#[test]
fn a_pipe_a_folder_and_a_device_are_refused_without_waiting() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = folder.path().join("fifo.csv");
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let socket = folder.path().join("socket.csv");
    let _held = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    for (path, word) in [
        (fifo.as_path(), "a pipe (FIFO)"),
        (socket.as_path(), "a socket"),
        (folder.path(), "a folder"),
        (Path::new("/dev/zero"), "a device"),
        (&folder.path().join("none.csv"), "cannot look at it"),
    ] {
        let text = read_sheet(path).unwrap_err().to_string();
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn why_the_system_refused_is_told_and_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let error = read_sheet(&folder.path().join("none.csv")).unwrap_err();
    let system = fs::metadata(folder.path().join("none.csv")).unwrap_err().to_string();
    assert!(error.to_string().contains(&system), "{error}");
    assert!(std::error::Error::source(&error).is_none(), "a chain of errors tells it again");
}

#[test]
fn a_mat_file_read_as_text_is_refused_as_binary() {
    let text = read_csv(&fs::read(file("mat/plain.mat")).unwrap()[..]).unwrap_err().to_string();
    assert!(text.contains("binary data"), "{text}");
}
