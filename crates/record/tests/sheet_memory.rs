//! Reading stays below 500 MB whatever the file is. One test alone in its process, which is what it measures.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test")]

use record::{read_csv, read_matlab, read_parquet};
use std::fs;
use std::io::{self, Cursor, Read, Write};

/// The most memory this process has had resident [MB], as the system counts it.
fn peak() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let kib: f64 = line.trim().trim_end_matches(" kB").parse().unwrap();
    kib * 1024.0 / 1e6
}

/// A header and then the same line for ever, or so many times.
fn lines(header: &str, line: &str, times: u64) -> impl Read {
    let block = line.repeat(1000);
    let mut left = times / 1000;
    let mut at = block.len();
    let body = std::iter::from_fn(move || {
        if at == block.len() {
            left = left.checked_sub(1)?;
            at = 0;
        }
        at += 1;
        Some(block.as_bytes()[at - 1])
    });
    Cursor::new(header.to_owned().into_bytes()).chain(Bytes(body))
}

struct Bytes<I>(I);

impl<I: Iterator<Item = u8>> Read for Bytes<I> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut n = 0;
        for (to, byte) in buffer.iter_mut().zip(&mut self.0) {
            *to = byte;
            n += 1;
        }
        Ok(n)
    }
}

/// A MATLAB file of one packed column of zeros.
fn packed_zeros(rows: u32) -> Vec<u8> {
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend(b"\x00\x01IM");
    let size = rows.saturating_mul(8);
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    for word in [14, size.saturating_add(48), 6, 8, 6, 0, 5, 8, rows, 1, 1 | 1 << 16, 0x46, 9, size]
    {
        packer.write_all(&u32::to_le_bytes(word)).unwrap();
    }
    io::copy(&mut io::repeat(0).take(u64::from(size)), &mut packer).unwrap();
    let packed = packer.finish().unwrap();
    file.extend(15_u32.to_le_bytes());
    file.extend(u32::try_from(packed.len()).unwrap().to_le_bytes());
    file.extend(packed);
    file
}

/// A whole number as Thrift's compact protocol writes it.
fn varint(mut n: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while n >= 0x80 {
        bytes.push(u8::try_from(n & 0x7F).unwrap() | 0x80);
        n >>= 7;
    }
    bytes.push(u8::try_from(n).unwrap());
    bytes
}

/// A field of Thrift's compact protocol that holds a whole number, so many field numbers after the one before.
fn int(step: u8, n: u64) -> Vec<u8> {
    [vec![step << 4 | 6], varint(2 * n)].concat()
}

/// A Parquet file of one column of missing values, all of them in one run of a few bytes.
fn run_of_missing(rows: u64) -> Vec<u8> {
    let mut levels = varint(2 * rows);
    levels.push(0);
    let size = levels.len() as u64 + 4;
    let about =
        [vec![2 << 4 | 0xC], int(1, rows), int(1, 0), int(1, 3), int(1, 3), vec![0]].concat();
    let header = [int(1, 0), int(1, size), int(1, size), about, vec![0]].concat();
    let page =
        [header, u32::try_from(levels.len()).unwrap().to_le_bytes().to_vec(), levels].concat();
    let root = [vec![4 << 4 | 8, 1, b'r'], int(1, 1), vec![0]].concat();
    let leaf = [int(1, 5), int(2, 1), vec![1 << 4 | 8, 1, b'F', 0]].concat();
    let chunk = [int(1, 5), int(3, 0), int(1, rows), int(2, page.len() as u64), int(2, 4), vec![0]];
    let chunk = [vec![3 << 4 | 0xC], chunk.concat(), vec![0]].concat();
    let group = [vec![1 << 4 | 0x9, 1 << 4 | 0xC], chunk, int(2, rows), vec![0]].concat();
    let schema = [vec![1 << 4 | 0x9, 2 << 4 | 0xC], root, leaf].concat();
    let footer =
        [int(1, 1), schema, int(1, rows), vec![1 << 4 | 0x9, 1 << 4 | 0xC], group, vec![0]]
            .concat();
    let size = u32::try_from(footer.len()).unwrap().to_le_bytes();
    [b"PAR1".to_vec(), page, footer, size.to_vec(), b"PAR1".to_vec()].concat()
}

#[test]
fn no_file_takes_more_than_500_megabytes() {
    let within = |what: &str, cap: f64| {
        let peak = peak();
        assert!(peak < cap, "{what}: {peak:.0} MB resident");
    };
    let text = read_csv(Cursor::new("t,F\n0,").chain(io::repeat(b'1').take(1 << 30))).unwrap_err();
    assert!(text.to_string().contains("line 2: a line"), "{text}");
    read_csv(io::repeat(b'x')).unwrap_err();
    read_csv(io::repeat(b',')).unwrap_err();
    within("a line without end", 50.0);

    let million = lines("a,b,c,d,e,f,g,h\n", "0.1,1.25,-3.5,4e-3,5.123456,6,7.75,8.5\n", 1_000_000);
    let sheet = read_csv(million).unwrap();
    assert_eq!(sheet.rows(), 1_000_000);
    drop(sheet);
    within("a million rows of eight columns", 150.0);

    let text = read_csv(lines("t,F\n", "0.125,1\n", u64::MAX)).unwrap_err();
    assert!(text.to_string().contains("16000002: more than 16000000 rows of 2 columns"), "{text}");
    within("rows of two columns without end", 400.0);
    let text = read_csv(lines("t\n", "7\n\n", u64::MAX)).unwrap_err();
    assert!(text.to_string().contains("blank lines"), "{text}");

    let sheet = read_matlab(&packed_zeros(15_000_000)[..]).unwrap();
    assert_eq!(sheet.column("F").unwrap().len(), 15_000_000);
    drop(sheet);
    let text = read_matlab(&packed_zeros(40_000_000)[..]).unwrap_err();
    assert!(text.to_string().contains("there may be at most"), "{text}");
    within("packed zeros", 400.0);

    let sheet = read_parquet(Cursor::new(run_of_missing(20_000_000))).unwrap();
    assert_eq!((sheet.rows(), sheet.columns[0].blanks), (20_000_000, 20_000_000));
    drop(sheet);
    let text = read_parquet(Cursor::new(run_of_missing(20_000_001))).unwrap_err();
    assert!(text.to_string().contains("there may be at most 20000000 rows"), "{text}");
    within("a run of missing values", 400.0);
}
