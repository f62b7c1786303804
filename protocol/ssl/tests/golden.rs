//! `golden`: golden packets: our structs have the league's numbers and types. Packets assembled from the
//! league's tables by another program (`golden/assemble.py`) decode to what it put in, and encode to the same
//! bytes.

#[path = "support/debug_tree.rs"]
mod debug_tree;
#[path = "support/messages.rs"]
mod messages;

use serde_json::Value;
use ssl::Message;
use ssl::{common, controller, event, referee, tracker, vision};

#[test]
fn every_message_decodes_as_assembled_and_encodes_to_the_same_bytes() {
    let mut messages = std::collections::BTreeSet::new();
    for (package, packets, lines) in GOLDEN {
        let mut rest = packets;
        for line in lines.lines() {
            let line: Value = serde_json::from_str(line).expect("a line of JSON");
            let name = line["message"].as_str().expect("a message's name");
            let what = format!("{package} {name}, {}", line["sample"]);
            let bytes = take_delimited(&mut rest);
            let (debug_tree, again) =
                messages::decoder(package, name)(bytes).unwrap_or_else(|error| panic!("{what}: {error}"));
            debug_tree::agree(&debug_tree, &line["fields"]).unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_eq!(again, bytes, "{what} encodes differently");
            messages.insert((package, name.to_owned()));
        }
        assert!(rest.is_empty(), "{package}: {} bytes without a line", rest.len());
    }
    let facts = FACTS.lines().filter(|line| line.starts_with("message ")).count();
    assert_eq!(messages.len(), facts, "not every message has a packet");
}

#[test]
fn every_field_of_every_message_is_set_in_some_packet() {
    let mut seen = std::collections::BTreeSet::new();
    for (package, _, lines) in GOLDEN {
        for line in lines.lines() {
            let line: Value = serde_json::from_str(line).expect("a line of JSON");
            let fields = line["fields"].as_object().expect("fields");
            let message = line["message"].as_str().expect("a message's name");
            seen.extend(fields.keys().map(|field| format!("{package} {message} {field}")));
        }
    }
    let mut message = String::new();
    let mut missing = Vec::new();
    for line in FACTS.lines() {
        let fields: Vec<_> = line.split(' ').collect();
        match fields[..] {
            ["message", package, name] => message = format!("{package} {name}"),
            ["enum", ..] => message.clear(),
            ["", "", _, field, _, ..] if !message.is_empty() => {
                let field = format!("{message} {field}");
                if !seen.contains(&field) {
                    missing.push(field);
                }
            }
            _ => {}
        }
    }
    assert!(missing.is_empty(), "{missing:?}");
    assert!(seen.len() > 490, "only {} fields", seen.len());
}

#[test]
fn every_enum_has_the_leagues_numbers_and_names() {
    for line in include_str!("golden/enums.tsv").lines() {
        let [package, name, number, value] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("{line}: four columns")
        };
        let number = number.parse().expect("a number");
        let variant = variant(package, name, number).unwrap_or_else(|| panic!("{line}: unknown here"));
        assert!(debug_tree::same_variant(value, &variant), "{line}: here {variant}");
    }
}

#[test]
fn a_number_no_enum_knows_survives_and_reads_as_the_safe_first_one() {
    let sent = referee::Referee { command: 99, ..Default::default() };
    let received = referee::Referee::decode(&sent.encode_to_vec()[..]).expect("decodes");
    assert_eq!(received.command, 99);
    assert!(referee::Command::try_from(received.command).is_err());
    assert_eq!(received.command(), referee::Command::Halt);
}

#[test]
fn a_field_no_message_knows_is_passed_over() {
    let ball = vision::DetectionBall { x: 1.5, ..Default::default() };
    let mut bytes = ball.encode_to_vec();
    bytes.extend([0xa2, 0x06, 3, 1, 2, 3]); // number 100, three bytes
    assert_eq!(vision::DetectionBall::decode(&bytes[..]), Ok(ball));
}

fn take_delimited<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let length = prost::decode_length_delimiter(&mut *rest).expect("a length");
    let (bytes, after) = rest.split_at(length);
    *rest = after;
    bytes
}

macro_rules! enums {
    ($($package:literal $name:literal => $type:ty),* $(,)?) => {
        fn variant(package: &str, name: &str, number: i32) -> Option<String> {
            match (package, name) {
                $(($package, $name) => <$type>::try_from(number).ok().map(|value| format!("{value:?}")),)*
                _ => panic!("{package} {name}: not an enum of ours"),
            }
        }
    };
}

enums! {
    "vision" "SSL_FieldShapeType" => vision::FieldShapeType,
    "vision" "SSL_Source" => vision::Source,
    "gc" "Team" => common::Team,
    "gc" "Division" => common::Division,
    "gc" "Referee.Stage" => referee::Stage,
    "gc" "Referee.Command" => referee::Command,
    "gc" "MatchType" => referee::MatchType,
    "gc" "HullColor" => referee::HullColor,
    "gc" "Type" => event::GameEventType,
    "gc" "ControllerReply.StatusCode" => controller::StatusCode,
    "gc" "ControllerReply.Verification" => controller::Verification,
    "gc" "AdvantageChoice" => controller::AdvantageChoice,
    "tracker" "TeamColor" => tracker::TeamColor,
    "tracker" "Capability" => tracker::Capability,
}

const FACTS: &str = include_str!("golden/facts.txt");

const GOLDEN: [(&str, &[u8], &str); 6] = [
    ("google", include_bytes!("golden/google.bin"), include_str!("golden/google.jsonl")),
    ("vision", include_bytes!("golden/vision.bin"), include_str!("golden/vision.jsonl")),
    ("legacy", include_bytes!("golden/legacy.bin"), include_str!("golden/legacy.jsonl")),
    ("gc", include_bytes!("golden/gc.bin"), include_str!("golden/gc.jsonl")),
    ("sim", include_bytes!("golden/sim.bin"), include_str!("golden/sim.jsonl")),
    ("tracker", include_bytes!("golden/tracker.bin"), include_str!("golden/tracker.jsonl")),
];
