//! Records as lines of text: every way of writing them that laboratories have, and what is no record.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use record::{Cells, Sheet, SheetError, read_csv};

fn read(text: &str) -> Sheet {
    read_csv(text.as_bytes()).unwrap_or_else(|e| panic!("{text:?}: {e}"))
}

fn refusal(bytes: &[u8]) -> String {
    read_csv(bytes).unwrap_err().to_string()
}

#[test]
fn the_same_numbers_are_read_from_every_dialect() {
    let plain = "t,F [N]\n0,1.5\n0.5,-2e-3\n1,3\n";
    for text in [
        plain.to_owned(),
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        plain.trim_end().to_owned(),
        format!("\u{FEFF}{plain}"),
        plain.replace(',', ";"),
        plain.replace(',', "\t"),
        plain.replace(',', ";").replace('.', ","),
        plain.replace(',', "\t").replace('.', ","),
        plain.replace(',', ";").replace('.', ",").replace('\n', "\r\n"),
        plain.replace(',', ";").replace('.', ",").replace('\n', "\r"),
        format!("\u{FEFF}{}", plain.replace(',', ";").replace('.', ",").replace('\n', "\r\n")),
        plain.replace(',', ", "),
        "\"t\",\"F [N]\"\n\"0\",\"1.5\"\n\"0.5\",\"-2e-3\"\n\"1\",\"3\"\n".to_owned(),
        "\u{FEFF}\"t\";\"F [N]\"\r\n\"0\";\"1,5\"\r\n\"0,5\";\"-2e-3\"\r\n\"1\";\"3\"\r\n"
            .to_owned(),
        plain.replace('\n', "\n\n"),
        format!("\n\n{plain}\n\n"),
        format!("{plain}   \n"),
    ] {
        let sheet = read(&text);
        assert_eq!(sheet.rows(), 3, "{text:?}");
        assert_eq!(sheet.column("t").unwrap(), [0.0, 0.5, 1.0], "{text:?}");
        assert_eq!(sheet.column("F [N]").unwrap(), [1.5, -2e-3, 3.0], "{text:?}");
        assert_eq!(sheet.columns.len(), 2, "{text:?}");
    }
}

#[test]
fn blank_cells_are_nan_and_counted_and_words_for_no_number_are_nan() {
    let sheet = read("a,b,c\n1,,NaN\n,  ,nan\n3,3,3\n");
    assert_eq!(sheet.columns.iter().map(|c| c.blanks).collect::<Vec<_>>(), [1, 2, 0]);
    let nan = |name| sheet.column(name).unwrap().iter().filter(|x| x.is_nan()).count();
    assert_eq!((nan("a"), nan("b"), nan("c")), (1, 2, 2));
}

#[test]
fn numbers_of_every_size_are_read_as_they_are() {
    let sheet = read("x\n1e308\n-1e308\n5e-324\n1e999\nInf\n-inf\n+.5\n7.\n1E3\n");
    let expected =
        [1e308, -1e308, 5e-324, f64::INFINITY, f64::INFINITY, -f64::INFINITY, 0.5, 7.0, 1e3];
    assert_eq!(sheet.column("x").unwrap(), expected);
    let all_nan = read("t,F\n0,NaN\n1,NaN\n");
    assert!(all_nan.column("F").unwrap().iter().all(|x| x.is_nan()));
}

#[test]
fn a_row_knows_its_line_past_blank_lines_and_cells_of_several_lines() {
    for end in ["\n", "\r\n"] {
        let text =
            ["t,note", "1,a", "", "", "2,\"one", "two", "three\"", "3,b", "", "4,c"].join(end);
        for text in [text.clone(), format!("{text}{end}")] {
            let sheet = read(&text);
            let lines: Vec<_> = (0..5).map(|row| sheet.line(row)).collect();
            assert_eq!(lines, [Some(2), Some(5), Some(8), Some(10), None], "{text:?}");
        }
    }
}

#[test]
fn text_in_a_column_is_an_error_when_the_column_is_asked_for_and_not_before() {
    let sheet = read("t,note,F\n0,,1\n1,start,2\n2,stop,3\n");
    assert_eq!(sheet.column("F").unwrap(), [1.0, 2.0, 3.0]);
    assert_eq!(sheet.columns[1].cells, Cells::Text { line: 3, found: "start".to_owned() });
    let text = sheet.column("note").unwrap_err().to_string();
    assert!(text.starts_with("line 3, column `note`: found `start`"), "{text}");
}

#[test]
fn a_file_that_writes_thousands_apart_is_not_misread_by_a_factor_of_thousand() {
    for (text, found) in [
        ("t;F\n0,5;1.500\n1;2\n", "1.500"),
        ("t;F\n0.5;1,500\n1;2\n", "1,500"),
        ("t;F\n1;1.500,5\n", "1.500,5"),
        ("t,F\n1,\"1,500\"\n", "1,500"),
    ] {
        let text = read(text).column("F").unwrap_err().to_string();
        assert!(text.contains(&format!("`{found}`")), "{text}");
    }
}

#[test]
fn a_name_that_is_not_there_lists_the_names_that_are() {
    let sheet = read("time_s,force1_n\n0,1\n");
    let text = sheet.column("force_1").unwrap_err().to_string();
    assert_eq!(text, "no column `force_1`; there are `time_s`, `force1_n`");
    let many = (0..4096).map(|i| format!("c{i}")).collect::<Vec<_>>().join(",");
    let row = vec!["1"; 4096].join(",");
    let text = read(&format!("{many}\n{row}\n")).column("x").unwrap_err().to_string();
    assert!(text.len() < 400 && text.ends_with("and 4072 more"), "{text}");
}

#[test]
fn headers_that_repeat_or_are_blank_hurt_only_who_asks_for_them() {
    let sheet = read("t,F,,F\n0,1,2,3\n");
    assert_eq!(sheet.column("t").unwrap(), [0.0]);
    assert_eq!(sheet.column("column 3").unwrap(), [2.0]);
    let error = sheet.column("F").unwrap_err();
    assert!(matches!(&error, SheetError::Ambiguous { at, .. } if at == &[2, 4]), "{error}");
}

#[test]
fn a_separator_in_a_header_or_a_cell_does_not_mislead() {
    let sheet = read("t [s];F, left, filtered [N]\n0;1,5\n0,1;2,5\n");
    assert_eq!(sheet.column("F, left, filtered [N]").unwrap(), [1.5, 2.5]);
    let sheet = read("\"t;a;b\",F\n0,1.5\n");
    assert_eq!(sheet.column("F").unwrap(), [1.5]);
    assert_eq!(sheet.columns[0].name, "t;a;b");
}

#[test]
fn what_is_no_record_says_what_it_is() {
    let cases: [(&[u8], &str); 14] = [
        (b"", "found nothing"),
        (b"\n\n  \n", "found nothing"),
        (b"\xEF\xBB\xBF", "found nothing"),
        (b"t,F\n", "no rows"),
        (b"t,F", "no rows"),
        (b"0,1\n2,3\n", "line 1: found numbers, the first `0`"),
        (b"0,5;1,5\n2;3\n", "line 1: found numbers"),
        (b"t,F\n0,1\n0,1,2\n", "line 3: found 3 cells; expected 2"),
        (b"t,F\n0,1\n\n\n7\n", "line 5: found 1 cells; expected 2"),
        (b"\x7FELF\x02\x01\x01\x00\x00", "binary data (byte 0x00 at offset 7)"),
        (b"PK\x03\x04\x14\x00", "zip archive"),
        (b"\x89HDF\r\n\x1a\n", "-v7"),
        (b"MATLAB 7.3 MAT-file, Platform: GLNXA64", "-v7"),
        (b"\xFF\xFEt\x00,\x00", "UTF-16"),
    ];
    for (bytes, word) in cases {
        let text = refusal(bytes);
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn one_row_is_a_record_of_one_row() {
    assert_eq!(read("t,F\n0,1").rows(), 1);
}

#[test]
fn html_and_control_characters_in_a_header_are_kept_and_never_shown_raw() {
    let name = "<script>alert(1)</script>\u{1b}[31m\u{202e}\u{7}";
    let sheet = read(&format!("t,{name}\n0,\u{1b}[2Jx\n"));
    assert_eq!(sheet.columns[1].name, name);
    for error in [sheet.column(name).unwrap_err(), sheet.column("x").unwrap_err()] {
        let text = error.to_string();
        assert!(!text.contains(['\u{1b}', '\u{7}', '\u{202e}']), "{text:?}");
        assert!(text.contains("\\u{1b}"), "{text}");
    }
    let long = "x".repeat(4000);
    let text = read(&format!("t,{long}\n0,y\n")).column(&long).unwrap_err().to_string();
    assert!(text.chars().count() < 300, "{} characters", text.chars().count());
}

#[test]
fn bytes_that_are_no_utf8_are_kept_out_of_numbers_and_replaced_in_names() {
    let sheet = read_csv(&b"t,Kraft \xFC\n0,1\n\xFF,2\n"[..]).unwrap();
    assert_eq!(sheet.column("Kraft \u{FFFD}").unwrap(), [1.0, 2.0]);
    let text = sheet.column("t").unwrap_err().to_string();
    assert!(text.contains("line 3"), "{text}");
}

#[test]
fn a_million_columns_are_refused_with_how_many_there_may_be() {
    for separator in [",", ";", "\t"] {
        let text = vec!["a"; 1_000_000].join(separator);
        let text = refusal(text.as_bytes());
        assert!(text.contains("columns") && text.contains("4096"), "{text}");
    }
    let text = refusal(vec!["a"; 4097].join(",").as_bytes());
    assert!(text.contains("4097 columns"), "{text}");
}

#[test]
fn a_cell_above_its_cap_is_refused_with_line_and_column() {
    let long = "1".repeat(4097);
    let text = refusal(format!("t,F\n0,1\n0,{long}\n").as_bytes());
    assert!(text.starts_with("line 3, column 2: a cell above 4096 bytes"), "{text}");
    let text = refusal(format!("t,{long}\n0,1\n").as_bytes());
    assert!(text.starts_with("line 1, column 2"), "{text}");
    assert_eq!(read(&format!("t,F\n0,{}\n", &long[1..])).column("F").unwrap(), [f64::INFINITY]);
}

#[test]
fn a_line_above_its_cap_is_refused_and_so_is_a_quote_that_does_not_end() {
    let text = refusal(format!("t,F\n0,{}", "1".repeat(2 << 20)).as_bytes());
    assert!(text.starts_with("line 2: a line"), "{text}");
    let text = refusal(format!("t,F\n0,\"{}", "1,2\n".repeat(1 << 19)).as_bytes());
    assert!(text.starts_with("line 2: a line, or a quoted cell"), "{text}");
    let text = refusal("x".repeat(2 << 20).as_bytes());
    assert!(text.starts_with("line 1: a line"), "{text}");
}
