//! `present`: messages of earlier years in today's form. Lengths in mm.

use std::borrow::Cow;
use std::f32::consts::FRAC_PI_2;

use prost::Message as _;

use super::{MessageKind, Record, guess};
use crate::vision::{
    FieldCircularArc, FieldLineSegment, FieldShapeType, GeometryData, GeometryFieldSize, Vector2f,
    WrapperPacket, legacy,
};

impl Record {
    /// Kind and bytes as today's programs send the message: the kind of an unknown one is found by its bytes,
    /// and vision of until 2014 has its flat geometry drawn as lines and arcs. `None` for what cannot be
    /// read, and for blanks and the index.
    pub fn present(&self) -> Option<(MessageKind, Cow<'_, [u8]>)> {
        let kind = match self.kind {
            MessageKind::Unknown => guess(&self.payload)?,
            kind => kind,
        };
        match kind {
            MessageKind::Vision2010 => {
                let packet = legacy::WrapperPacket::decode(&self.payload[..]).ok()?;
                // Camera frames have not changed since.
                let Some(geometry) = packet.geometry else {
                    return Some((MessageKind::Vision2014, Cow::Borrowed(&self.payload)));
                };
                let geometry = GeometryData {
                    field: field(&geometry.field),
                    calib: geometry.calib,
                    ..GeometryData::default()
                };
                let (detection, geometry) = (packet.detection, Some(geometry));
                let packet = WrapperPacket { detection, geometry, ..WrapperPacket::default() };
                Some((MessageKind::Vision2014, Cow::Owned(packet.encode_to_vec())))
            }
            MessageKind::Vision2014 | MessageKind::Refbox2013 | MessageKind::Tracker2020 => {
                Some((kind, Cow::Borrowed(&self.payload)))
            }
            _ => None,
        }
    }
}

/// The field of flat measures, with the lines and arcs that they stand for.
fn field(flat: &legacy::GeometryFieldSize) -> GeometryFieldSize {
    use FieldShapeType as Shape;
    let (x, y) = (flat.field_length as f32 * 0.5, flat.field_width as f32 * 0.5);
    let (radius, stretch) = (flat.defense_radius as f32, flat.defense_stretch as f32 * 0.5);
    let front = x - radius;
    let lines = [
        ("TopTouchLine", Shape::TopTouchLine, (-x, y), (x, y)),
        ("BottomTouchLine", Shape::BottomTouchLine, (-x, -y), (x, -y)),
        ("LeftGoalLine", Shape::LeftGoalLine, (-x, -y), (-x, y)),
        ("RightGoalLine", Shape::RightGoalLine, (x, -y), (x, y)),
        ("HalfwayLine", Shape::HalfwayLine, (0.0, -y), (0.0, y)),
        ("LeftPenaltyStretch", Shape::LeftPenaltyStretch, (-front, -stretch), (-front, stretch)),
        ("RightPenaltyStretch", Shape::RightPenaltyStretch, (front, -stretch), (front, stretch)),
    ];
    // Centre, radius, and the quarters of a circle between which it lies.
    let arcs = [
        ("CenterCircle", (0.0, 0.0), flat.center_circle_radius as f32, [0.0, 4.0]),
        ("LeftFieldLeftPenaltyArc", (-x, stretch), radius, [0.0, 1.0]),
        ("LeftFieldRightPenaltyArc", (-x, -stretch), radius, [3.0, 4.0]),
        ("RightFieldLeftPenaltyArc", (x, -stretch), radius, [2.0, 3.0]),
        ("RightFieldRightPenaltyArc", (x, stretch), radius, [1.0, 2.0]),
    ];
    let thickness = flat.line_width as f32;
    let line = lines.map(|(name, shape, p1, p2)| FieldLineSegment {
        name: name.to_owned(),
        p1: vector(p1),
        p2: vector(p2),
        thickness,
        r#type: Some(shape as i32),
    });
    let arc = arcs.map(|(name, center, radius, quarters)| {
        let [a1, a2] = quarters.map(|quarters| quarters * FRAC_PI_2);
        FieldCircularArc {
            name: name.to_owned(),
            center: vector(center),
            radius,
            a1,
            a2,
            thickness,
            r#type: None,
        }
    });
    GeometryFieldSize {
        field_length: flat.field_length,
        field_width: flat.field_width,
        goal_width: flat.goal_width,
        goal_depth: flat.goal_depth,
        boundary_width: flat.boundary_width.saturating_add(flat.referee_width),
        field_lines: line.into(),
        field_arcs: arc.into(),
        center_circle_radius: Some(flat.center_circle_radius),
        line_thickness: Some(flat.line_width),
        goal_center_to_penalty_mark: Some(flat.penalty_spot_from_field_line_dist),
        ..GeometryFieldSize::default()
    }
}

fn vector((x, y): (f32, f32)) -> Vector2f {
    Vector2f { x, y }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Packet;
    use crate::vision::DetectionFrame;

    const FLAT: legacy::GeometryFieldSize = legacy::GeometryFieldSize {
        line_width: 10,
        field_length: 6050,
        field_width: 4050,
        boundary_width: 250,
        referee_width: 425,
        goal_width: 700,
        goal_depth: 180,
        goal_wall_width: 20,
        center_circle_radius: 500,
        defense_radius: 800,
        defense_stretch: 350,
        free_kick_from_defense_dist: 200,
        penalty_spot_from_field_line_dist: 750,
        penalty_line_from_spot_dist: 400,
    };

    fn record(kind: MessageKind, packet: &legacy::WrapperPacket) -> Record {
        Record { timestamp_ns: 0, kind, payload: packet.encode_to_vec() }
    }

    #[test]
    fn a_flat_geometry_is_drawn_as_lines_and_quarter_circles() {
        let detection = DetectionFrame { frame_number: 7, camera_id: 1, ..DetectionFrame::default() };
        let geometry = legacy::GeometryData { field: FLAT, calib: vec![] };
        let old = legacy::WrapperPacket { detection: Some(detection.clone()), geometry: Some(geometry) };
        // Of the recorder's own kind, and of one that did not name it.
        for kind in [MessageKind::Vision2010, MessageKind::Unknown] {
            let record = record(kind, &old);
            let (kind, payload) = record.present().unwrap();
            let Ok(Some(Packet::Vision(packet))) = Packet::decode(kind, &payload) else { panic!("{kind}") };
            assert_eq!(packet.detection.as_ref(), Some(&detection));
            let field = packet.geometry.unwrap().field;
            assert_eq!((field.field_length, field.field_width, field.goal_width), (6050, 4050, 700));
            let front = field.field_lines.iter().find(|line| line.name == "LeftPenaltyStretch").unwrap();
            assert_eq!((front.p1.x, front.p1.y, front.p2.y), (-2225.0, -175.0, 175.0));
            let arcs: Vec<_> = field.field_arcs.iter().filter(|arc| arc.name.contains("Penalty")).collect();
            assert!(arcs.len() == 4 && arcs.iter().all(|arc| arc.radius == 800.0));
        }
    }

    #[test]
    fn a_frame_alone_is_the_same_bytes_and_damage_is_nothing() {
        let old = legacy::WrapperPacket { detection: Some(DetectionFrame::default()), geometry: None };
        let record = record(MessageKind::Vision2010, &old);
        assert_eq!(record.present(), Some((MessageKind::Vision2014, Cow::Borrowed(&record.payload[..]))));
        let damaged = Record { payload: vec![0xff; 9], ..record.clone() };
        assert_eq!(damaged.present(), None);
        let other = Record { kind: MessageKind::Other(77), ..record };
        assert_eq!(other.present(), None);
    }

    #[test]
    fn any_flat_measures_are_drawn() {
        for mm in [i32::MIN, -1, 0, i32::MAX] {
            let flat = legacy::GeometryFieldSize {
                field_length: mm,
                boundary_width: mm,
                referee_width: mm,
                defense_radius: mm,
                ..FLAT
            };
            assert_eq!(field(&flat).field_length, mm);
        }
    }
}
