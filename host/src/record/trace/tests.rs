//! Tests: traces that are whole, cut, damaged or no traces are read as what they are.

use super::*;

fn written() -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), r#"{"seed":7}"#).unwrap();
    writer.write(Instant(10), 0, RecordKind::Vision, &[b"abc"]).unwrap();
    writer.write(Instant(20), 1, RecordKind::Timeout, &[]).unwrap();
    writer.write(Instant(30), 1, RecordKind::Sent, &[&[255], b"frame"]).unwrap();
    writer.finish().unwrap()
}

#[test]
fn what_is_written_is_read_again() {
    let bytes = written();
    let mut reader = Reader::new(&bytes[..]).unwrap();
    assert_eq!(reader.header(), r#"{"seed":7}"#);
    let records: Vec<_> = reader.by_ref().collect();
    assert_eq!(records.len(), 3);
    assert_eq!(
        records[2],
        Record {
            at: Instant(30),
            host: 1,
            kind: RecordKind::Sent,
            from: SenderAddress::INTERNAL,
            bytes: b"\xffframe".to_vec()
        }
    );
    assert_eq!(reader.end(), Some(&TraceEnd::Whole));
}

#[test]
fn a_file_cut_at_any_byte_gives_the_whole_records_before_the_cut() {
    let bytes = written();
    for cut in 0..bytes.len() {
        match Reader::new(&bytes[..cut]) {
            Err(TraceError::NotATrace) => assert!(cut < 12, "{cut}"),
            Err(TraceError::Header) => assert!(cut < 30, "{cut}"),
            Err(other) => panic!("{cut}: {other}"),
            Ok(mut reader) => {
                let got = reader.by_ref().count();
                let whole =
                    [30 + 17, 30 + 17 + 14, 30 + 17 + 14 + 20].iter().filter(|end| **end <= cut).count();
                assert_eq!(got, whole, "{cut}");
                let last = [Instant(10), Instant(20), Instant(30)].into_iter().take(whole).next_back();
                let expected = TraceEnd::Cut { at: [30, 47, 61, 81][whole], last };
                assert_eq!(reader.end(), Some(&expected), "{cut}");
            }
        }
    }
}

/// A recording as it is on disk, and its lengths after each record was flushed.
fn zipped() -> (Vec<u8>, Vec<usize>) {
    let zip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    let mut writer = Writer::new(zip, r#"{"seed":7}"#).unwrap();
    let mut flushed = Vec::new();
    for number in 0..20_u8 {
        writer.write(Instant(u64::from(number)), 0, RecordKind::Vision, &[&[number; 90]]).unwrap();
        writer.flush().unwrap();
        flushed.push(writer.out.get_ref().len());
    }
    (writer.finish().unwrap().finish().unwrap(), flushed)
}

#[test]
fn a_gzipped_trace_cut_at_any_byte_is_cut_even_between_two_records() {
    let (bytes, flushed) = zipped();
    for cut in 0..bytes.len() {
        let zip = flate2::bufread::MultiGzDecoder::new(&bytes[..cut]);
        let Ok(mut reader) = Reader::new(zip) else { continue };
        let got = reader.by_ref().count();
        let whole = flushed.iter().filter(|at| **at <= cut).count();
        assert!(got >= whole, "{cut}: {got} of {whole} records that were flushed");
        let last = got.checked_sub(1).map(|last| Instant(last as u64));
        // After each record and its checksum; at the end comes one more.
        let Some(&TraceEnd::Cut { at, .. }) = reader.end() else { panic!("{cut}: {:?}", reader.end()) };
        let records = 30 + 122 * got as u64;
        assert!((records - 18..=records + 18).contains(&at), "{cut}: {at}");
        assert_eq!(reader.end(), Some(&TraceEnd::Cut { at, last }), "{cut}");
    }
    let mut reader = Reader::new(flate2::bufread::MultiGzDecoder::new(&bytes[..])).unwrap();
    assert_eq!((reader.by_ref().count(), reader.end()), (20, Some(&TraceEnd::Whole)));
}

#[test]
fn a_gzipped_trace_with_a_damaged_byte_is_never_whole() {
    let (bytes, _) = zipped();
    // Byte 4 to 9 are gzip's time, flags and system: no part of the trace.
    for at in 10..bytes.len() {
        let mut bytes = bytes.clone();
        bytes[at] ^= 0x55;
        let zip = flate2::bufread::MultiGzDecoder::new(&bytes[..]);
        let Ok(mut reader) = Reader::new(zip) else { continue };
        let _ = reader.by_ref().count();
        assert!(!reader.end().unwrap().is_whole(), "{at}");
    }
}

#[test]
fn a_damaged_byte_of_an_uncompressed_trace_is_found_wherever_it_is() {
    let bytes = written();
    for at in 0..bytes.len() {
        for bit in 0..8 {
            let mut bytes = bytes.clone();
            bytes[at] ^= 1 << bit;
            let Ok(mut reader) = Reader::new(&bytes[..]) else { continue };
            // An older version has no checksums: its number is not sealed by anything.
            if reader.version < CHECKSUM_SINCE_VERSION {
                continue;
            }
            let _ = reader.by_ref().count();
            assert!(!reader.end().unwrap().is_whole(), "byte {at}, bit {bit}");
        }
    }
}

#[test]
fn exchanged_doubled_and_missing_records_are_found() {
    let bytes = written();
    let parts = [&bytes[..30], &bytes[30..47], &bytes[47..61], &bytes[61..81], &bytes[81..]];
    for order in
        [&[0, 2, 1, 3, 4][..], &[0, 1, 3, 4], &[0, 1, 1, 2, 3, 4], &[0, 1, 2, 3, 4, 4], &[0, 1, 2, 3]]
    {
        let changed: Vec<u8> = order.iter().flat_map(|part| parts[*part].to_vec()).collect();
        let mut reader = Reader::new(&changed[..]).unwrap();
        let _ = reader.by_ref().count();
        assert!(!reader.end().unwrap().is_whole(), "{order:?}");
    }
}

#[test]
fn a_trace_of_version_2_is_read_without_checksums() {
    let bytes = written();
    let mut old = bytes[..81].to_vec();
    old[12] = 2;
    let mut reader = Reader::new(&old[..]).unwrap();
    assert_eq!((reader.by_ref().count(), reader.end()), (3, Some(&TraceEnd::Whole)));
}

#[test]
fn another_version_and_another_kind_are_named() {
    let mut bytes = written();
    bytes[12] = 9;
    assert!(matches!(Reader::new(&bytes[..]), Err(TraceError::Version(9))));
    let mut bytes = written();
    bytes[30 + 9] = 77;
    let mut reader = Reader::new(&bytes[..]).unwrap();
    assert_eq!(reader.by_ref().count(), 0);
    assert!(matches!(reader.end(), Some(TraceEnd::Broken { at: 30, what }) if what.contains("77")));
}

#[test]
fn a_referees_packet_keeps_its_sender_and_one_of_version_1_has_none() {
    let from = SenderAddress::new(([10, 0, 0, 7], 41_234).into());
    let mut writer = Writer::new(Vec::new(), "{}").unwrap();
    writer.write(Instant(1), 0, RecordKind::Referee, &[&from.to_bytes(), b"packet"]).unwrap();
    let mut bytes = writer.finish().unwrap();
    let record = Reader::new(&bytes[..]).unwrap().next().unwrap();
    assert_eq!((record.from, &record.bytes[..]), (from, &b"packet"[..]));
    bytes[12] = 1;
    let record = Reader::new(&bytes[..]).unwrap().next().unwrap();
    assert_eq!((record.from, record.bytes.len()), (SenderAddress::INTERNAL, SenderAddress::LEN + 6));
    // A record too short for a sender is damage, not a panic.
    let mut writer = Writer::new(Vec::new(), "{}").unwrap();
    writer.write(Instant(1), 0, RecordKind::Referee, &[b"short"]).unwrap();
    let bytes = writer.finish().unwrap();
    let mut reader = Reader::new(&bytes[..]).unwrap();
    assert_eq!(reader.next(), None);
    assert!(matches!(reader.end(), Some(TraceEnd::Broken { what, .. }) if what.contains("no sender")));
}

#[test]
fn a_trace_that_lost_records_ends_there() {
    let mut writer = Writer::new(Vec::new(), "{}").unwrap();
    writer.write(Instant(1), 0, RecordKind::Timeout, &[]).unwrap();
    writer.write(Instant(2), 0, RecordKind::Lost, &[]).unwrap();
    let bytes = writer.finish().unwrap();
    let mut reader = Reader::new(&bytes[..]).unwrap();
    assert_eq!((reader.by_ref().count(), reader.end()), (1, Some(&TraceEnd::Lost { at: Instant(2) })));
}

#[test]
fn a_length_out_of_nowhere_allocates_nothing() {
    let mut bytes = written();
    bytes[30 + 10..30 + 14].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut reader = Reader::new(&bytes[..]).unwrap();
    assert_eq!(reader.by_ref().count(), 0);
    assert!(matches!(reader.end(), Some(TraceEnd::Broken { .. })));
}
