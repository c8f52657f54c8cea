//! Tables read back as written; records are whole, or known to be damaged.

use record::{
    CaseRecord, CaseRow, ClaimRow, FitRow, Found, History, Key, RecordError, Store, Summary, Table,
    write_whole,
};
use std::{fs, path::Path};

fn case() -> CaseRow {
    CaseRow {
        study: "fig01".to_owned(),
        point: "gamma=0.25".to_owned(),
        solver: "rk4".to_owned(),
        value: 0.1 + 0.2,
        error_max: Some(1.0 / 3.0 * 1e-7),
        error_l2: Some(f64::MIN_POSITIVE),
        error_final: None,
        evaluations: u64::MAX,
        rejected: None,
        any_status: true,
        ..CaseRow::default()
    }
}

#[test]
fn a_table_reads_back_to_the_last_bit() {
    let rows = vec![case(), CaseRow { rejected: Some(3), reached: 1.0, ..case() }];
    let csv = CaseRow::to_csv(&rows);
    assert_eq!(CaseRow::from_csv(&csv, Path::new("cases.csv")).unwrap(), rows);
}

#[test]
fn text_of_any_kind_survives_a_table() {
    for text in [
        "",
        "a,b",
        "\"quoted\"",
        "two\nlines",
        "γ ≥ 1 — “so”",
        " spaces ",
        "'",
        "1e5",
        "null",
        "\\",
    ] {
        let rows =
            vec![ClaimRow { why: text.to_owned(), ..ClaimRow::default() }, ClaimRow::default()];
        let csv = ClaimRow::to_csv(&rows);
        assert_eq!(ClaimRow::from_csv(&csv, Path::new("claims.csv")).unwrap(), rows, "{text:?}");
    }
}

#[test]
fn an_empty_table_is_its_header() {
    let csv = ClaimRow::to_csv(&[]);
    assert_eq!(String::from_utf8(csv.clone()).unwrap().lines().count(), 1);
    assert_eq!(ClaimRow::from_csv(&csv, Path::new("claims.csv")).unwrap(), []);
}

#[test]
fn a_table_that_is_none_is_refused_with_its_file() {
    let right = String::from_utf8(CaseRow::to_csv(&[case()])).unwrap();
    for (wrong, word) in [
        (String::new(), "header"),
        (right.replacen("solver", "slover", 1), "header"),
        (right.replace("true", "perhaps"), "cases.csv"),
        (right.replace("0.30000000000000004", "x"), "cases.csv"),
        (right.replace("0.30000000000000004", ""), "value"),
    ] {
        let error = CaseRow::from_csv(wrong.as_bytes(), Path::new("cases.csv")).unwrap_err();
        assert!(matches!(error, RecordError::Table { .. }));
        let message = error.to_string();
        assert!(message.contains("cases.csv") && message.contains(word), "{message}");
    }
}

#[test]
fn a_summary_reads_back_from_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("mine");
    let fit = FitRow { fit: "rig".to_owned(), ..FitRow::default() };
    let cases = vec![case()];
    let summary = Summary { name: "mine".to_owned(), cases, fits: vec![fit], ..Summary::default() };
    for (file, bytes) in summary.files() {
        assert!(write_whole(&folder.join(file), &bytes).unwrap(), "{file} was there");
        assert!(!write_whole(&folder.join(file), &bytes).unwrap(), "{file} was written twice");
    }
    assert_eq!(Summary::read(&folder).unwrap(), summary);
    let (there, files) = (fs::read_dir(&folder).unwrap().count(), summary.files());
    assert_eq!(there, files.len(), "something is left over");
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    assert!(names.contains(&"fits.csv") && !names.contains(&"models.csv"), "{names:?}");
}

#[test]
fn what_a_killed_writer_left_is_removed_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in [".a.csv.x7.part", ".a.csv.x8.part", ".b.csv.x7.part", ".a.csv.txt", "a.csv.part"] {
        fs::write(at(name), "half").unwrap();
    }
    let live = fs::File::open(at(".a.csv.x8.part")).unwrap();
    live.lock().unwrap();
    write_whole(&at("a.csv"), b"whole").unwrap();
    let mut left: Vec<String> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    left.sort();
    assert_eq!(left, [".a.csv.txt", ".a.csv.x8.part", ".b.csv.x7.part", "a.csv", "a.csv.part"]);
}

fn record() -> CaseRecord {
    let history =
        History { t: vec![0.1], step: vec![1e-300], value: vec![-0.0], error: vec![1.0 / 3.0] };
    CaseRecord { row: case(), history: Some(history) }
}

#[test]
fn a_record_reads_back_and_any_changed_byte_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::new(folder.path().to_path_buf());
    let key = Key::of(&["a case"]);
    assert_eq!(store.read::<CaseRecord>(&key).unwrap(), Found::Nothing);
    store.write(&key, &record()).unwrap();
    assert_eq!(store.read(&key).unwrap(), Found::Record(Box::new(record())));
    let path = folder.path().join(&key.as_str()[..2]).join(format!("{}.json", key.as_str()));
    let whole = fs::read(&path).unwrap();
    for at in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        fs::write(&path, &bytes).unwrap();
        assert!(matches!(store.read::<CaseRecord>(&key).unwrap(), Found::Damaged(_)), "byte {at}");
        fs::write(&path, &whole[..at]).unwrap();
        assert!(
            matches!(store.read::<CaseRecord>(&key).unwrap(), Found::Damaged(_)),
            "cut at {at}"
        );
    }
}

#[test]
fn keys_differ_where_their_parts_do() {
    let keys = [&["ab", "c"][..], &["a", "bc"], &["abc"], &["ab", "c", ""], &["c", "ab"]];
    let keys: std::collections::BTreeSet<_> = keys.into_iter().map(Key::of).collect();
    assert_eq!(keys.len(), 5);
}

#[test]
fn what_cannot_be_written_is_an_error_with_its_path() {
    let error = write_whole(Path::new("/dev/null/x/y.csv"), b"").unwrap_err();
    assert!(
        matches!(error, RecordError::Disk { .. }) && error.to_string().contains("/dev/null/x"),
        "{error}"
    );
}
