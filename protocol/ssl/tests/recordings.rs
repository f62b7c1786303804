//! `recordings`: tests: our messages agree with what the league's own programs sent. Every packet of the
//! recordings decodes, and single packets agree field by field with what an independent decoder read in them.

#[path = "support/debug_tree.rs"]
mod debug_tree;
#[path = "support/recordings.rs"]
mod recordings;

use std::collections::BTreeMap;

use recordings::{ERFORCE, GRSIM, GRSIM_INDEXED, GRSIM_NOISY};
use ssl::Message;
use ssl::log::{MessageKind, Summary};
use ssl::referee::Referee;
use ssl::tracker::TrackerWrapperPacket;
use ssl::vision::WrapperPacket;

#[test]
fn single_packets_agree_field_by_field_with_an_independent_decoder() {
    let directory = recordings::path("packets");
    let mut compared = 0;
    for entry in std::fs::read_dir(directory).expect("packets") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "bin") {
            continue;
        }
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let bytes = std::fs::read(&path).expect("a packet");
        let json = std::fs::read_to_string(path.with_extension("json")).expect("its JSON");
        let json = serde_json::from_str(&json).expect("JSON");
        let (debug_tree, again) = match name.split('_').next() {
            Some("referee") => both::<Referee>(&bytes),
            Some("tracker") => both::<TrackerWrapperPacket>(&bytes),
            Some("vision" | "erforce") => both::<WrapperPacket>(&bytes),
            _ => panic!("{name}: which message is it?"),
        };
        debug_tree::agree(&debug_tree, &json).unwrap_or_else(|error| panic!("{name}: {error}"));
        // Nothing is lost: no field is left out. (Go writes a oneof behind the other fields, so the order may
        // differ.)
        assert_eq!(sorted(&again), sorted(&bytes), "{name}");
        compared += 1;
    }
    assert_eq!(compared, 21);
}

#[test]
fn every_packet_of_every_recording_decodes_and_encodes_without_loss() {
    for name in [GRSIM, GRSIM_INDEXED, GRSIM_NOISY, ERFORCE] {
        for (number, record) in recordings::open(name).enumerate() {
            let again = match record.kind {
                MessageKind::Refbox2013 => both::<Referee>(&record.payload).1,
                MessageKind::Tracker2020 => both::<TrackerWrapperPacket>(&record.payload).1,
                MessageKind::Vision2014 => both::<WrapperPacket>(&record.payload).1,
                other => panic!("{name}, message {number}: {other}"),
            };
            assert_eq!(sorted(&again), sorted(&record.payload), "{name}, message {number}");
        }
    }
}

#[test]
fn the_summary_counts_what_another_program_counted() {
    // Counted by a Python program that reads the format alone: referee, vision, tracker, back steps, span in
    // ns.
    let counted = [
        (GRSIM, [858, 5076, 1969], 1, 23_217_376_926),
        (GRSIM_INDEXED, [858, 5076, 1969], 1, 23_217_376_926),
        (GRSIM_NOISY, [2389, 13428, 5719], 6, 65_664_267_699),
        (ERFORCE, [890, 1483, 2043], 0, 23_359_910_444),
    ];
    for (name, kinds, back_steps, span) in counted {
        let summary = Summary::of(&mut recordings::open(name));
        let expected = [MessageKind::Refbox2013, MessageKind::Vision2014, MessageKind::Tracker2020];
        let expected: BTreeMap<_, _> = expected.into_iter().zip(kinds).collect();
        let counts: BTreeMap<_, _> =
            summary.kinds.iter().map(|(kind, found)| (*kind, found.messages)).collect();
        assert_eq!(counts, expected, "{name}");
        assert_eq!(summary.undecodable(), 0, "{name}: {:?}", summary.first_undecodable);
        assert_eq!(summary.counts.messages, kinds.iter().sum::<u64>(), "{name}");
        assert_eq!(summary.counts.back_steps, back_steps, "{name}");
        assert_eq!(summary.counts.index, u64::from(name == GRSIM_INDEXED), "{name}");
        let (first, last) = summary.span_ns.expect("messages");
        assert_eq!(last - first, span, "{name}");
        assert_eq!(summary.damage, "", "{name}");
        assert_eq!(summary.cameras.len(), if name == ERFORCE { 1 } else { 4 }, "{name}");
    }
}

fn both<M: Message + Default + std::fmt::Debug>(bytes: &[u8]) -> (String, Vec<u8>) {
    let message = M::decode(bytes).expect("decodes");
    (format!("{message:?}"), message.encode_to_vec())
}

/// The same bytes independent of the order of fields.
fn sorted(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes.sort_unstable();
    bytes
}
