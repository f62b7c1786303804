//! `log_seek`: tests: a moment of a match is found, always the same one, with an index, without one, with a
//! broken one, and in a gzipped file.

#[path = "support/recordings.rs"]
mod recordings;

use std::fs::File;
use std::path::{Path, PathBuf};

use recordings::{GRSIM, GRSIM_INDEXED};
use ssl::log::{Index, LogWriter, MessageKind, Place, Record, open_at};

#[test]
fn every_method_finds_the_first_message_of_that_time_or_later() {
    let records = recordings::records(GRSIM);
    let scratch = Scratch::new("ways");
    let indexed = recordings::path(GRSIM_INDEXED);
    let plain = scratch.file("plain.log", &without_index(&std::fs::read(&indexed).expect("the recording")));
    let zipped = recordings::path(GRSIM);
    let back = records.windows(2).position(|pair| pair[1].timestamp_ns < pair[0].timestamp_ns);
    let back = back.expect("a step back in the recording");
    let places =
        (0..records.len()).step_by(500).chain([1, back - 1, back, back + 1, back + 2, records.len() - 1]);
    let around = places.flat_map(|place| [-1, 0, 1].map(|offset| records[place].timestamp_ns + offset));
    for time in around.chain([i64::MIN, 0, i64::MAX]) {
        let first = records.iter().position(|record| record.timestamp_ns >= time).unwrap_or(records.len());
        check(&indexed, time, Place::Index, &records[first..]);
        check(&plain, time, Place::Headers(None), &records[first..]);
    }
    // Unzipping takes longer: fewer of them.
    for place in [0, 2000, back, back + 1, records.len() - 1] {
        let time = records[place].timestamp_ns;
        let first = records.iter().position(|record| record.timestamp_ns >= time).expect("this one");
        check(&zipped, time, Place::Unzipped, &records[first..]);
    }
}

#[test]
fn the_index_of_the_leagues_recorder_names_every_message() {
    let mut file = File::open(recordings::path(GRSIM_INDEXED)).expect("the recording");
    let Index::Whole(offsets) = Index::read(&mut file).expect("readable") else { panic!("no index") };
    // As another program read them.
    assert_eq!((offsets.len(), offsets[0], offsets[1], offsets[2]), (7903, 16, 140, 378));
    assert_eq!(offsets.last(), Some(&1_587_637));
}

#[test]
fn our_files_have_an_index_and_gzipped_ones_have_none() {
    let records = &recordings::records(GRSIM)[..50];
    let scratch = Scratch::new("written");
    for (name, place) in [("m.log", Place::Index), ("m.log.gz", Place::Unzipped)] {
        let path = scratch.directory.join(name);
        let mut writer = LogWriter::create(&path).expect("a file");
        for record in records {
            writer.write(record.timestamp_ns, record.kind, &record.payload).expect("written");
        }
        writer.close().expect("closed");
        check(&path, records[20].timestamp_ns, place, &records[20..]);
    }
}

#[test]
fn a_broken_index_gives_its_reason_and_the_headers_are_read_instead() {
    let records = recordings::records(GRSIM);
    let scratch = Scratch::new("broken");
    let file = std::fs::read(recordings::path(GRSIM_INDEXED)).expect("the recording");
    let length = file.len();
    let index = without_index(&file).len();
    let wrong: [(&str, usize, &[u8]); 5] = [
        ("outside the file", length - 15, &i64::MAX.to_be_bytes()),
        ("within the file's header", length - 15, &(length as u64 - 3).to_be_bytes()),
        ("no index message", length - 15, &64_000u64.to_be_bytes()),
        ("do not rise", index + 16 + 8 * 100, &7u64.to_be_bytes()),
        ("no index message", index + 11, &[4]),
    ];
    for (reason, at, bytes) in wrong {
        let mut file = file.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        let path = scratch.file("broken.log", &file);
        let (mut reader, place) = open_at(&path, records[3000].timestamp_ns).expect("opens");
        let Place::Headers(Some(why)) = place else { panic!("{reason}: {place:?}") };
        assert!(why.contains(reason), "{why}, not {reason}");
        assert_eq!(reader.next().as_ref(), Some(&records[3000]), "{reason}");
    }
}

#[test]
fn an_index_of_another_file_is_found_out() {
    let records = recordings::records(GRSIM);
    let scratch = Scratch::new("other");
    // All offsets shifted by three bytes: they rise, and are wrong.
    let mut file = std::fs::read(recordings::path(GRSIM_INDEXED)).expect("the recording");
    let index = without_index(&file).len();
    for bytes in file[index + 16..].as_chunks_mut::<8>().0.iter_mut().take(7903) {
        *bytes = (u64::from_be_bytes(*bytes) + 3).to_be_bytes();
    }
    let path = scratch.file("other.log", &file);
    let (mut reader, place) = open_at(&path, records[3000].timestamp_ns).expect("opens");
    assert_eq!(place, Place::Headers(Some("its offsets lead to no messages")));
    assert_eq!(reader.next().as_ref(), Some(&records[3000]));
}

#[test]
fn an_empty_match_has_an_index_too() {
    let scratch = Scratch::new("empty");
    let path = scratch.directory.join("empty.log");
    LogWriter::create(&path).expect("a file").close().expect("closed");
    let mut file = File::open(&path).expect("the file");
    assert_eq!(Index::read(&mut file).expect("readable"), Index::Whole(vec![]));
    let (mut reader, _) = open_at(&path, 0).expect("opens");
    assert_eq!(reader.next(), None);
    assert!(reader.end().is_some_and(ssl::log::LogEnd::is_whole));
    let mut writer = LogWriter::create(&path).expect("a file");
    writer.write(9, MessageKind::Tracker2020, &[]).expect("written");
    writer.close().expect("closed");
    let (mut reader, place) = open_at(&path, 10).expect("opens");
    assert_eq!((reader.next(), place), (None, Place::Index));
    assert!(reader.end().is_some_and(ssl::log::LogEnd::is_whole), "{:?}", reader.end());
}

fn check(path: &Path, time: i64, place: Place, expected: &[Record]) {
    let (reader, found) = open_at(path, time).expect("opens");
    let what = format!("{} at {time}", path.display());
    assert_eq!(found, place, "{what}");
    let few: Vec<_> = reader.take(5).collect();
    assert_eq!(few, expected[..expected.len().min(5)], "{what}");
}

fn without_index(file: &[u8]) -> Vec<u8> {
    let back =
        file[file.len() - 15..].first_chunk().map(|bytes| u64::from_be_bytes(*bytes)).expect("8 bytes");
    file[..file.len() - back as usize].to_vec()
}

/// A directory of one test's own, removed when it ends.
struct Scratch {
    directory: PathBuf,
}

impl Scratch {
    fn new(name: &str) -> Self {
        let directory = std::env::temp_dir().join(format!("ssl-log-seek-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&directory).expect("a directory");
        Self { directory }
    }

    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.directory.join(name);
        std::fs::write(&path, bytes).expect("written");
        path
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // A directory that is left over is harmless.
        let _ = std::fs::remove_dir_all(&self.directory);
    }
}
