//! `log`: tests: the log reader survives cuts, damage, versions and unknown types, and reads back what is
//! written.

#[path = "support/recordings.rs"]
mod recordings;

use std::io::{Cursor, Write};

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use recordings::{ERFORCE, GRSIM, GRSIM_INDEXED, GRSIM_NOISY};
use ssl::log::{
    LogEnd, LogError, LogReader, LogWriter, MessageKind, PAYLOAD_MAX, Packet, PacketError, Record, Summary,
};

#[test]
fn we_write_the_same_bytes_as_the_leagues_recorder() {
    let theirs = std::fs::read(recordings::path(GRSIM_INDEXED)).expect("the recording");
    let mut writer = LogWriter::indexed(Vec::new()).expect("a header");
    write_all(&mut writer, &recordings::records(GRSIM));
    assert!(writer.finish().expect("an index") == theirs, "the files differ");
}

#[test]
fn a_gzipped_file_reads_back_as_it_was_written() {
    let records = recordings::records(ERFORCE);
    let mut zipped = GzEncoder::new(Vec::new(), Compression::fast());
    let mut writer = LogWriter::new(&mut zipped).expect("a header");
    write_all(&mut writer, &records);
    writer.finish().expect("an end");
    let zipped = zipped.finish().expect("an end");
    let mut reader = LogReader::new(MultiGzDecoder::new(&zipped[..])).expect("a header");
    assert!(reader.by_ref().eq(records), "other messages came back");
    assert!(matches!(reader.end(), Some(LogEnd::Whole)));
}

#[test]
fn a_file_cut_at_any_byte_gives_all_whole_messages_and_says_where_it_was_cut() {
    let records = &recordings::records(GRSIM_NOISY)[..40];
    let (file, begins) = file_of(records);
    for cut in 0..=file.len() {
        check_cut(&file[..cut], records, &begins);
    }
}

#[test]
fn a_long_file_cut_beside_any_message_and_anywhere_gives_all_whole_messages() {
    let records = recordings::records(GRSIM_NOISY);
    let (file, begins) = file_of(&records);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    // Beside and within each message, in a file of that message and its neighbours: earlier content has no
    // effect.
    for window in records.windows(3) {
        let (file, begins) = file_of(window);
        let beside = begins[1..].iter().flat_map(|begin| [begin - 1, *begin, begin + 1]);
        for cut in beside.chain([random.next_u64() as usize % file.len()]) {
            check_cut(&file[..cut.min(file.len())], window, &begins);
        }
    }
    for _ in 0..60 {
        check_cut(&file[..random.next_u64() as usize % file.len()], &records, &begins);
    }
}

#[test]
fn a_gzipped_file_cut_anywhere_gives_the_messages_before_the_cut() {
    let zipped = std::fs::read(recordings::path(GRSIM)).expect("the recording");
    let records = recordings::records(GRSIM);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut given = 0;
    for _ in 0..60 {
        let cut = random.next_u64() as usize % zipped.len();
        let Ok(mut reader) = LogReader::new(MultiGzDecoder::new(&zipped[..cut])) else {
            assert!(cut < 1000, "nothing of {cut} bytes");
            continue;
        };
        let found: Vec<_> = reader.by_ref().collect();
        assert!(found == records[..found.len()], "cut at {cut}");
        assert!(matches!(reader.end(), Some(LogEnd::Cut { .. })), "cut at {cut}: {:?}", reader.end());
        // deflate holds back 32 kB of what it unpacks at most; a message has at most 1.5 kB.
        let bytes: usize = found.iter().map(|record| record.payload.len() + 16).sum();
        assert!(
            bytes as f64 > 1_587_762.0 * cut as f64 / zipped.len() as f64 - 150_000.0,
            "cut at {cut}: {bytes}"
        );
        given += found.len();
    }
    assert!(given > 60 * 7903 / 4, "only {given}");
}

#[test]
fn a_gzipped_file_with_a_wrong_byte_gives_what_is_before_it_and_says_so() {
    let mut zipped = std::fs::read(recordings::path(GRSIM)).expect("the recording");
    let checksum = zipped.len() - 6;
    zipped[checksum] ^= 1;
    let mut reader = LogReader::new(MultiGzDecoder::new(&zipped[..])).expect("a header");
    assert_eq!(reader.by_ref().count(), 7903);
    let Some(LogEnd::Read { at: 1_587_762, error }) = reader.end() else { panic!("{:?}", reader.end()) };
    assert!(error.to_string().contains("checksum"), "{error}");
}

#[test]
fn an_impossible_size_ends_the_file_and_takes_no_memory() {
    for size in [-1, i32::MIN, i32::MAX, PAYLOAD_MAX as i32 + 1] {
        let (mut file, begins) = file_of(&recordings::records(GRSIM)[..3]);
        file[begins[2] + 12..begins[2] + 16].copy_from_slice(&size.to_be_bytes());
        let mut reader = LogReader::new(&file[..]).expect("a header");
        assert_eq!(reader.by_ref().count(), 2);
        let Some(LogEnd::Size { at, size: reported }) = reader.end() else { panic!("{:?}", reader.end()) };
        assert_eq!((*at, *reported), (begins[2] as u64, size));
    }
    // The largest possible size: the file has fewer bytes.
    let (mut file, begins) = file_of(&recordings::records(GRSIM)[..3]);
    file[begins[2] + 12..begins[2] + 16].copy_from_slice(&(PAYLOAD_MAX as i32).to_be_bytes());
    let mut reader = LogReader::new(&file[..]).expect("a header");
    assert_eq!(reader.by_ref().count(), 2);
    assert!(matches!(reader.end(), Some(LogEnd::Cut { .. })));
}

#[test]
fn a_blank_message_of_any_size_is_passed_over_and_counted() {
    let record = recordings::records(GRSIM)[0].clone();
    let mut writer = LogWriter::new(Vec::new()).expect("a header");
    writer.write(1, MessageKind::Blank, &[0; 100]).expect("written");
    write_all(&mut writer, std::slice::from_ref(&record));
    let mut file = writer.finish().expect("an end");
    file.extend(0i64.to_be_bytes());
    file.extend(0i32.to_be_bytes());
    file.extend(i32::MAX.to_be_bytes()); // two gigabytes that are not there
    let mut reader = LogReader::new(&file[..]).expect("a header");
    assert_eq!(reader.by_ref().collect::<Vec<_>>(), [record]);
    assert_eq!(reader.counts().blank, 1);
    assert!(matches!(reader.end(), Some(LogEnd::Cut { bytes: 16, .. })), "{:?}", reader.end());
}

#[test]
fn other_versions_and_other_files_are_refused_by_name() {
    let refused = |bytes: &[u8]| LogReader::new(bytes).map(|_| ()).expect_err("refused");
    let versioned = |version: i32| [&b"SSL_LOG_FILE"[..], &version.to_be_bytes()].concat();
    assert!(LogReader::new(&versioned(1)[..]).is_ok());
    assert!(matches!(refused(&versioned(2)), LogError::Version(2)));
    assert!(refused(&versioned(2)).to_string().contains("version 2; only version 1"));
    // Version 0 was written by Qt: its string has a length and 16-bit letters.
    let letters = "SSL_LOG_FILE".encode_utf16().flat_map(u16::to_be_bytes);
    let qt: Vec<u8> = 24u32.to_be_bytes().into_iter().chain(letters).chain([0; 4]).collect();
    for bytes in [versioned(0), qt] {
        assert!(matches!(refused(&bytes), LogError::LegacyQt));
        assert!(refused(&bytes).to_string().contains("version 0"));
    }
    assert!(matches!(refused(b"SSL_LOG"), LogError::Short { bytes: 7 }));
    assert!(matches!(refused(b""), LogError::Short { bytes: 0 }));
    let error = refused(b"{\"detection\": null}").to_string();
    assert!(error.contains("begins with `{\\\"detection"), "{error}");
    let missing = ssl::log::open(&recordings::path("none.log")).map(|_| ()).expect_err("no file");
    assert!(missing.to_string().contains("none.log"), "{missing}");
}

#[test]
fn an_unknown_type_and_a_broken_message_are_counted_and_the_rest_read() {
    let records = recordings::records(GRSIM);
    let mut writer = LogWriter::new(Vec::new()).expect("a header");
    writer.write(5, MessageKind::Other(77), b"who knows").expect("written");
    writer.write(6, MessageKind::Refbox2013, &[0xff; 9]).expect("written");
    writer.write(7, MessageKind::Unknown, b"no message").expect("written");
    write_all(&mut writer, &records[..10]);
    let file = writer.finish().expect("an end");
    let mut reader = LogReader::new(&file[..]).expect("a header");
    let summary = Summary::of(&mut reader);
    assert_eq!(summary.counts.messages, 13);
    assert_eq!(summary.undecodable(), 3);
    assert_eq!(summary.kinds[&MessageKind::Other(77)].undecodable, 1);
    assert_eq!(summary.kinds[&MessageKind::Refbox2013].undecodable, 1);
    assert_eq!(summary.kinds[&MessageKind::Unknown].undecodable, 1);
    assert_eq!(summary.first_undecodable, Some((0, PacketError::KindNotKnown(77))));
    assert_eq!(summary.span_ns.expect("a span").0, 5);
}

#[test]
fn a_message_of_type_unknown_is_found_by_parsing() {
    for name in [GRSIM_NOISY, ERFORCE] {
        for (number, record) in recordings::records(name).into_iter().enumerate() {
            let found = Packet::decode(MessageKind::Unknown, &record.payload);
            let found = found.unwrap_or_else(|error| panic!("{name}, message {number}: {error}"));
            assert_eq!(found.map(|packet| packet.kind()), Some(record.kind), "{name}, message {number}");
        }
    }
}

#[test]
fn a_message_no_datagram_can_hold_is_not_written() {
    let mut writer = LogWriter::new(Vec::new()).expect("a header");
    writer.write(0, MessageKind::Vision2014, &vec![0; PAYLOAD_MAX]).expect("the largest");
    let error = writer.write(0, MessageKind::Vision2014, &vec![0; PAYLOAD_MAX + 1]).expect_err("too large");
    assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput);
    let file = writer.finish().expect("an end");
    assert_eq!(LogReader::new(Cursor::new(file)).expect("a header").count(), 1);
}

#[test]
fn steps_back_in_time_are_counted_and_nothing_else_changes() {
    let mut writer = LogWriter::new(Vec::new()).expect("a header");
    for time in [100, 50, 60, 20, 20] {
        writer.write(time, MessageKind::Tracker2020, &[]).expect("written");
    }
    let file = writer.finish().expect("an end");
    let mut reader = LogReader::new(&file[..]).expect("a header");
    let times: Vec<_> = reader.by_ref().map(|record| record.timestamp_ns).collect();
    assert_eq!(times, [100, 50, 60, 20, 20]);
    assert_eq!((reader.counts().back_steps, reader.counts().largest_back_step_ns), (2, 50));
}

fn write_all<W: Write>(writer: &mut LogWriter<W>, records: &[Record]) {
    for record in records {
        writer.write(record.timestamp_ns, record.kind, &record.payload).expect("written");
    }
}

/// The file of these messages, made here by hand, and the start of each; last, where it ends.
fn file_of(records: &[Record]) -> (Vec<u8>, Vec<usize>) {
    let mut file = b"SSL_LOG_FILE\0\0\0\x01".to_vec();
    let mut begins = vec![file.len()];
    for record in records {
        file.extend(record.timestamp_ns.to_be_bytes());
        file.extend(record.kind.number().to_be_bytes());
        file.extend((record.payload.len() as i32).to_be_bytes());
        file.extend(&record.payload);
        begins.push(file.len());
    }
    (file, begins)
}

fn check_cut(file: &[u8], records: &[Record], begins: &[usize]) {
    let cut = file.len();
    let reader = LogReader::new(file);
    if cut < begins[0] {
        assert!(matches!(reader, Err(LogError::Short { bytes }) if bytes == cut), "cut at {cut}");
        return;
    }
    let mut reader = reader.unwrap_or_else(|error| panic!("cut at {cut}: {error}"));
    let whole = begins[1..].partition_point(|end| *end <= cut);
    assert!(reader.by_ref().eq(records[..whole].iter().cloned()), "cut at {cut}");
    let fits = match reader.end() {
        Some(LogEnd::Whole) => cut == begins[whole],
        Some(LogEnd::Cut { at, bytes }) => {
            *at == begins[whole] as u64 && *at + bytes == cut as u64 && cut > begins[whole]
        }
        _ => false,
    };
    assert!(fits, "cut at {cut}: {:?}", reader.end());
}
