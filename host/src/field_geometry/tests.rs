//! Tests: geometry of the league's own programs, and refusal of invalid values.

use std::path::PathBuf;

use rules::{AreaForm, League};
use ssl::log::Packet;
use ssl::vision::{
    FieldCircularArc, FieldLineSegment, GeometryCameraCalibration, GeometryFieldSize, Vector2f,
};

use super::camera::CameraSource;
use super::*;

fn recorded(name: &str) -> Vec<GeometryData> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../protocol/ssl/tests/data").join(name);
    let records = ssl::log::open(&path).unwrap();
    let packets = records.filter_map(|record| match record.decode() {
        Ok(Some(Packet::Vision(packet))) => packet.geometry,
        _ => None,
    });
    packets.collect()
}

fn near(a: f32, b: f32) {
    assert!((a - b).abs() < 1e-6, "{a} is not {b}");
}

/// The sizes that both simulators send.
fn plain(length: i32, width: i32) -> GeometryFieldSize {
    GeometryFieldSize {
        field_length: length,
        field_width: width,
        goal_width: 700,
        goal_depth: 180,
        boundary_width: 300,
        ..GeometryFieldSize::default()
    }
}

fn line(name: &str, p1: (f32, f32), p2: (f32, f32)) -> FieldLineSegment {
    let point = |(x, y)| Vector2f { x, y };
    FieldLineSegment { name: name.into(), p1: point(p1), p2: point(p2), thickness: 10.0, r#type: None }
}

fn received(field: GeometryFieldSize) -> Result<VisionGeometry, GeometryFault> {
    let mut geometry = VisionGeometry::default();
    geometry.receive(&GeometryData { field, calib: vec![], models: None })?;
    Ok(geometry)
}

#[test]
fn trap_02_calibrations_of_one_camera_a_packet_become_four_cameras() {
    for (name, cameras) in [("grsim_divB_22s.log.gz", 4), ("erforce_divB_realistic_22s.log.gz", 1)] {
        let packets = recorded(name);
        assert!(packets.iter().all(|data| data.calib.len() == 1), "{name} shows the trap");
        let mut geometry = VisionGeometry::default();
        let mut changes = 0;
        for data in &packets {
            let announced = geometry.receive(data).unwrap();
            changes += announced.cameras;
            assert_eq!((announced.cameras_refused, announced.models_refused), (0, 0));
        }
        assert_eq!((geometry.cameras().len(), changes), (cameras, cameras), "{name}");
    }
    let mut geometry = VisionGeometry::default();
    for data in recorded("grsim_divB_22s.log.gz") {
        geometry.receive(&data).unwrap();
    }
    let places: Vec<_> = geometry.cameras().values().map(|camera| camera.position).collect();
    // grSim hangs them over the quarters, 4 m high.
    for (x, y) in [(2.25, 1.5), (-2.25, 1.5), (2.25, -1.5), (-2.25, -1.5)] {
        assert!(places.contains(&[x, y, 4.0]), "({x}, {y}) of {places:?}");
    }
}

#[test]
fn trap_08_the_defence_area_comes_from_the_lines_in_any_order() {
    let announced = League::DivisionB.field();
    for (name, lines, circle) in
        [("grsim_divB_22s.log.gz", 18, 0.495), ("erforce_divB_realistic_22s.log.gz", 12, 0.5)]
    {
        let data = &recorded(name)[0];
        assert_eq!((data.field.field_lines.len(), data.field.penalty_area_depth), (lines, None));
        let mut orders = vec![data.clone(); 3];
        orders[1].field.field_lines.reverse();
        orders[2].field.field_lines.rotate_left(7);
        for data in orders {
            let mut geometry = VisionGeometry::default();
            assert!(geometry.receive(&data).unwrap().field);
            let field = geometry.field().unwrap();
            assert_eq!(geometry.area_source(), Some(AreaSource::Lines));
            for (got, expected) in [
                (field.length, announced.length),
                (field.width, announced.width),
                (field.margin, 0.3),
                (field.goal_line_margin, 0.3),
                (field.goal_width, announced.goal_width),
                (field.goal_depth, announced.goal_depth),
                (field.penalty_depth, announced.penalty_depth),
                (field.penalty_width, announced.penalty_width),
                (field.penalty_mark, announced.penalty_mark),
                (field.center_radius, circle),
                (field.line_width, 0.01),
            ] {
                near(got, expected);
            }
            assert_eq!(field.penalty_form, AreaForm::Box);
            assert!(!geometry.receive(&data).unwrap().field, "the same again is no news");
        }
    }
}

#[test]
fn trap_08_ball_models_are_the_ones_on_the_wire() {
    let model = |name: &str| {
        let mut geometry = VisionGeometry::default();
        geometry.receive(&recorded(name)[0]).unwrap();
        let (ground, chip) = (geometry.ground().unwrap(), geometry.chip().unwrap());
        [ground.slide, ground.roll, ground.switch, chip.first, chip.other, chip.rise]
    };
    assert_eq!(model("grsim_divB_22s.log.gz"), [14.0, 0.7, 0.7, 0.6, 0.96, 0.42]);
    assert_eq!(model("erforce_divB_realistic_22s.log.gz"), [3.9, 0.35, 0.69, 0.715, 1.0, 0.566]);
}

#[test]
fn finding_21_invented_cameras_take_no_place_of_genuine_ones() {
    let data = recorded("grsim_divB_22s.log.gz")[0].clone();
    let real = data.calib[0];
    let mut geometry = VisionGeometry::default();
    let camera = |camera_id| GeometryCameraCalibration { camera_id, ..real };
    let invented =
        GeometryData { calib: (16..2_000).chain([u32::MAX]).map(camera).collect(), ..data.clone() };
    let changes = geometry.receive(&invented).unwrap();
    assert_eq!((changes.cameras, changes.cameras_refused, geometry.cameras().len()), (0, 1_985, 0));
    let genuine = GeometryData { calib: (0..16).map(camera).collect(), ..data };
    assert_eq!(geometry.receive(&genuine).unwrap().cameras, 16);
}

#[test]
fn trap_08_a_cameras_dummy_rotation_is_not_believed() {
    let dummy = recorded("grsim_divB_22s.log.gz")[0].calib[0];
    assert_eq!([dummy.q0, dummy.q1, dummy.q2, dummy.q3], [0.7; 4]);
    let mut geometry = VisionGeometry::default();
    let mut data = recorded("grsim_divB_22s.log.gz")[0].clone();
    data.calib[0].derived_camera_world_tx = None;
    let changes = geometry.receive(&data).unwrap();
    assert_eq!((changes.cameras, changes.cameras_refused), (0, 1));
    // A valid rotation: half a turn about x looks straight down (quaternion (1, 0, 0, 0)): p ↦ (x, −y, −z).
    let real = GeometryCameraCalibration {
        q0: 1.0,
        q1: 0.0,
        q2: 0.0,
        q3: 0.0,
        tx: -1500.0,
        ty: 800.0,
        tz: 4200.0,
        derived_camera_world_tx: None,
        ..dummy
    };
    data.calib = vec![real];
    geometry.receive(&data).unwrap();
    let camera = geometry.cameras()[&real.camera_id];
    assert_eq!(camera, Camera { position: [1.5, 0.8, 4.2], source: CameraSource::Calibration });
    // A quarter turn about z on top: q = (√½, √½, 0, 0) takes (x, y, z) to (y, x, −z).
    let half = core::f32::consts::FRAC_1_SQRT_2;
    data.calib = vec![GeometryCameraCalibration { q0: half, q1: half, ..real }];
    geometry.receive(&data).unwrap();
    let position = geometry.cameras()[&real.camera_id].position;
    for (got, expected) in position.into_iter().zip([-0.8, 1.5, 4.2]) {
        near(got, expected);
    }
}

#[test]
fn numbers_of_the_area_come_before_lines_and_lines_before_the_division() {
    let lines = vec![
        line("LeftPenaltyStretch", (-3200.0, -900.0), (-3200.0, 900.0)),
        line("RightFieldLeftPenaltyStretch", (4000.0, 900.0), (3200.0, 900.0)),
    ];
    let mut size = GeometryFieldSize { field_lines: lines, ..plain(8000, 5000) };
    let area = |size: &GeometryFieldSize| {
        let geometry = received(size.clone()).unwrap();
        let field = geometry.field().unwrap();
        (field.penalty_depth, field.penalty_width, geometry.area_source().unwrap())
    };
    assert_eq!(area(&size), (0.8, 1.8, AreaSource::Lines));
    (size.penalty_area_depth, size.penalty_area_width) = (Some(1100), Some(2100));
    assert_eq!(area(&size), (1.1, 2.1, AreaSource::Announced));
    // 0 means "not set".
    (size.penalty_area_depth, size.penalty_area_width) = (Some(0), Some(0));
    assert_eq!(area(&size), (0.8, 1.8, AreaSource::Lines));
    // Without the side: the front's distance from the goal line.
    size.field_lines.truncate(1);
    assert_eq!(area(&size), (0.8, 1.8, AreaSource::Lines));
    // Named by type only.
    size.field_lines[0].name.clear();
    size.field_lines[0].r#type = Some(8);
    assert_eq!(area(&size), (0.8, 1.8, AreaSource::Lines));
}

#[test]
fn a_field_without_any_word_of_the_area_has_its_divisions() {
    let area = |length, width| {
        let geometry = received(plain(length, width)).unwrap();
        let field = *geometry.field().unwrap();
        (field.penalty_depth, field.penalty_width, field.penalty_mark, geometry.area_source().unwrap())
    };
    assert_eq!(area(9000, 6000), (1.0, 2.0, 6.0, AreaSource::Division(League::DivisionB)));
    assert_eq!(area(12000, 9000), (1.8, 3.6, 8.0, AreaSource::Division(League::DivisionA)));
    // The rules allow a tenth more or less.
    assert_eq!(area(13200, 9900).3, AreaSource::Division(League::DivisionA));
    // Half a field of division B has half its area.
    let (depth, width, mark, source) = area(4500, 3000);
    assert_eq!(source, AreaSource::Division(League::DivisionB));
    near(depth, 0.5);
    near(width, 1.0);
    near(mark, 3.0);
}

#[test]
fn an_old_round_area_is_read_from_its_arcs() {
    let arc = FieldCircularArc {
        name: "LeftFieldLeftPenaltyArc".into(),
        center: Vector2f { x: -3000.0, y: -175.0 },
        radius: 800.0,
        a1: 0.0,
        a2: 1.57,
        thickness: 10.0,
        r#type: None,
    };
    let field_lines = vec![line("LeftPenaltyStretch", (-2200.0, -175.0), (-2200.0, 175.0))];
    let size = GeometryFieldSize { field_lines, field_arcs: vec![arc], ..plain(6000, 4000) };
    let geometry = received(size).unwrap();
    let (field, paper) = (geometry.field().unwrap(), League::Ssl2013.field());
    assert_eq!(field.penalty_form, AreaForm::QuarterCircles);
    near(field.penalty_depth, paper.penalty_depth);
    near(field.penalty_width, paper.penalty_width);
}

#[test]
fn a_message_of_the_newest_format_gives_every_size_of_the_field() {
    let size = GeometryFieldSize {
        goal_width: 1800,
        penalty_area_depth: Some(1800),
        penalty_area_width: Some(3600),
        center_circle_radius: Some(500),
        line_thickness: Some(10),
        goal_center_to_penalty_mark: Some(8000),
        goal_height: Some(160),
        ball_radius: Some(21.5),
        max_robot_radius: Some(90.0),
        boundary_width_goal_line: Some(600),
        ..plain(12000, 9000)
    };
    let geometry = received(size).unwrap();
    assert_eq!(geometry.field(), Some(&League::DivisionA.field()));
    assert_eq!(
        (geometry.ball_radius(), geometry.robot_radius()),
        (limits::BALL_RADIUS, limits::ROBOT_RADIUS)
    );
}

#[test]
fn nonsense_is_refused_by_name_and_what_was_known_stands() {
    let mut geometry = received(plain(9000, 6000)).unwrap();
    let before = geometry.clone();
    let nonsense = |change: fn(&mut GeometryFieldSize)| {
        let mut size = plain(9000, 6000);
        change(&mut size);
        size
    };
    for (field, name) in [
        (nonsense(|size| size.field_length = 0), "length"),
        (nonsense(|size| size.field_width = i32::MIN), "width"),
        (nonsense(|size| size.goal_width = 7000), "goal_width"),
        (nonsense(|size| size.boundary_width = -1), "margin"),
        (nonsense(|size| size.line_thickness = Some(i32::MAX)), "line_width"),
    ] {
        let fault = geometry.receive(&GeometryData { field, calib: vec![], models: None }).unwrap_err();
        let GeometryFault::Field(announced) = fault;
        assert_eq!(announced.field, name);
        assert!(fault.to_string().contains(name), "{fault}");
        assert_eq!(geometry, before);
    }
    // Lines at places that are no numbers.
    let mut size = plain(9000, 6000);
    size.field_lines = vec![line("LeftPenaltyStretch", (f32::NAN, f32::NAN), (0.0, f32::INFINITY))];
    assert!(matches!(received(size), Ok(geometry) if geometry.area_source() != Some(AreaSource::Lines)));
}
