//! `guess`: type detection of `Unknown` payloads: the message whose required fields it has, and no others.
//!
//! A protobuf decoder alone accepts nearly any bytes as any message: unknown fields are skipped and missing
//! ones read as zero. So the wire is examined: numbers and wire types of the outermost fields, and where
//! vision's two generations and the tracker differ, one or two levels deeper.

use prost::Message;

use super::MessageKind;
use crate::wire::{BYTES, FIXED64, Field, Fields, VARINT, Value};
use crate::{referee, tracker, vision};

/// The kind of a payload: vision, vision of 2014, referee or tracker; `None` if it is none of them.
///
/// A packet of detections alone was the same in 2014 as it is today, and counts as today's.
pub fn guess(payload: &[u8]) -> Option<MessageKind> {
    let fields = fields(payload)?;
    // Controllers of other years have further fields; no other message has the required ones.
    let known = |field: &&Field<'_>| REFEREE.iter().any(|(number, _)| *number == field.number);
    let of_referee: Vec<_> = fields.iter().filter(known).copied().collect();
    if is(&of_referee, &REFEREE, &REFEREE_REQUIRED) && referee::Referee::decode(payload).is_ok() {
        return Some(MessageKind::Refbox2013);
    }
    if is(&fields, &WRAPPER, &[]) && !fields.is_empty() && fields.iter().all(vision_part) {
        if vision::WrapperPacket::decode(payload).is_ok() {
            return Some(MessageKind::Vision2014);
        }
        if vision::legacy::WrapperPacket::decode(payload).is_ok() {
            return Some(MessageKind::Vision2010);
        }
    }
    let tracker = is(&fields, &TRACKER, &[1]) && tracker::TrackerWrapperPacket::decode(payload).is_ok();
    tracker.then_some(MessageKind::Tracker2020)
}

/// Field numbers and wire types a message may have; numbers it must have.
type Known = [(u32, u8)];

const REFEREE: [(u32, u8); 18] = [
    (1, VARINT),
    (2, VARINT),
    (3, VARINT),
    (4, VARINT),
    (5, VARINT),
    (6, VARINT),
    (7, BYTES),
    (8, BYTES),
    (9, BYTES),
    (10, VARINT),
    (12, VARINT),
    (15, VARINT),
    (16, BYTES),
    (17, BYTES),
    (18, BYTES),
    (19, VARINT),
    (20, BYTES),
    // Until 2022: the last game event.
    (11, BYTES),
];
const REFEREE_REQUIRED: [u32; 7] = [1, 2, 4, 5, 6, 7, 8];
const WRAPPER: [(u32, u8); 3] = [(1, BYTES), (2, BYTES), (3, VARINT)];
const TRACKER: [(u32, u8); 3] = [(1, BYTES), (2, BYTES), (3, BYTES)];
const DETECTION: [(u32, u8); 8] =
    [(1, VARINT), (2, FIXED64), (3, FIXED64), (4, VARINT), (5, BYTES), (6, BYTES), (7, BYTES), (8, FIXED64)];
const DETECTION_REQUIRED: [u32; 4] = [1, 2, 3, 4];
const GEOMETRY: [(u32, u8); 3] = [(1, BYTES), (2, BYTES), (3, BYTES)];

fn is(fields: &[Field<'_>], known: &Known, required: &[u32]) -> bool {
    fields.iter().all(|field| known.contains(&(field.number, field.value.wire_type())))
        && required.iter().all(|number| fields.iter().any(|field| field.number == *number))
}

/// Returns whether a field of the wrapper is one of vision's.
fn vision_part(field: &Field<'_>) -> bool {
    match (field.number, field.value) {
        (1, Value::Bytes(frame)) => {
            fields(frame).is_some_and(|frame| is(&frame, &DETECTION, &DETECTION_REQUIRED))
        }
        (2, Value::Bytes(geometry)) => {
            fields(geometry).is_some_and(|geometry| is(&geometry, &GEOMETRY, &[1]))
        }
        _ => true,
    }
}

/// The fields of a message, or `None` where the bytes are not one.
fn fields(bytes: &[u8]) -> Option<Vec<Field<'_>>> {
    Fields::of(bytes).collect::<Result<_, _>>().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracker::TrackerWrapperPacket;
    use crate::vision::legacy;
    use crate::vision::{DetectionFrame, FieldLineSegment, GeometryData, GeometryFieldSize};

    #[test]
    fn each_message_kind_is_recognised_by_its_bytes() {
        let detection =
            vision::WrapperPacket { detection: Some(DetectionFrame::default()), ..Default::default() };
        assert_eq!(guess(&detection.encode_to_vec()), Some(MessageKind::Vision2014));
        let lines = vec![FieldLineSegment::default()];
        let field = GeometryFieldSize { field_length: 9000, field_lines: lines, ..Default::default() };
        let geometry = GeometryData { field, ..Default::default() };
        let geometry = vision::WrapperPacket { geometry: Some(geometry), ..Default::default() };
        assert_eq!(guess(&geometry.encode_to_vec()), Some(MessageKind::Vision2014));
        let old = legacy::GeometryFieldSize { field_length: 6050, defense_radius: 800, ..Default::default() };
        let old = legacy::GeometryData { field: old, calib: vec![] };
        let old = legacy::WrapperPacket { detection: None, geometry: Some(old) };
        assert_eq!(guess(&old.encode_to_vec()), Some(MessageKind::Vision2010));
        let referee = referee::Referee::default();
        assert_eq!(guess(&referee.encode_to_vec()), Some(MessageKind::Refbox2013));
        // Game events as controllers of 2019 sent them (field 13), and a field that is not known yet.
        let odd = [referee.encode_to_vec(), vec![0x6a, 0, 0x98, 0x06, 5]].concat();
        assert_eq!(guess(&odd), Some(MessageKind::Refbox2013));
        let tracker = TrackerWrapperPacket { uuid: "57afc6f8".into(), ..Default::default() };
        assert_eq!(guess(&tracker.encode_to_vec()), Some(MessageKind::Tracker2020));
    }

    #[test]
    fn other_bytes_are_no_message() {
        assert_eq!(guess(b""), None);
        assert_eq!(guess(b"SSL_LOG_FILE"), None);
        assert_eq!(guess(&[0xff; 40]), None);
        // A referee without its teams.
        assert_eq!(guess(&[8, 1, 16, 1, 32, 1, 40, 1, 48, 1]), None);
        // A detection frame without its camera is invalid: field 4 is required.
        let mut frame = DetectionFrame { frame_number: 7, ..Default::default() }.encode_to_vec();
        frame.truncate(frame.len() - 2);
        let mut packet = vec![0x0a, frame.len() as u8];
        packet.extend(frame);
        assert_ne!(guess(&packet), Some(MessageKind::Vision2014));
    }
}
