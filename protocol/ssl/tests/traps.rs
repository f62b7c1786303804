//! `traps`: tests of the league's surprises on the wire. Each trap of the README as a fact of a recording,
//! read by our own structs: code that relies on the opposite fails here.

#[path = "support/recordings.rs"]
mod recordings;

use std::collections::{BTreeMap, BTreeSet};
use std::net::{Ipv4Addr, SocketAddrV4, UdpSocket};
use std::time::Duration;

use recordings::{ERFORCE, GRSIM, GRSIM_NOISY};
use ssl::Message;
use ssl::net::{Interfaces, Receiver, Sender};
use ssl::referee::Command;
use ssl::simulation::RobotControlResponse;
use ssl::vision::{DetectionFrame, DetectionRobot, GeometryCameraCalibration, GeometryData};

#[test]
fn trap_01_grsim_counts_from_its_own_start_and_erforce_in_unix_time() {
    for (name, unix) in [(GRSIM, false), (GRSIM_NOISY, false), (ERFORCE, true)] {
        for (received_ns, frame) in frames(name) {
            let age_s = received_ns as f64 / 1e9 - frame.t_capture;
            // ER-Force: 35 ms of delay, and half a second for a loaded machine.
            assert_eq!((0.0..0.5).contains(&age_s), unix, "{name}: {age_s} s");
            assert_eq!(frame.t_capture < 100.0, !unix, "{name}");
            assert!((0.0..0.05).contains(&(frame.t_sent - frame.t_capture)), "{name}: the two on one clock");
        }
    }
}

#[test]
fn trap_02_grsim_sends_four_frames_a_tick_each_counted_by_its_own_camera() {
    let frames = frames(GRSIM);
    let mut counts = BTreeMap::new();
    for tick in frames.chunks(4) {
        let cameras: Vec<_> = tick.iter().map(|(_, frame)| frame.camera_id).collect();
        assert_eq!(cameras, [0, 1, 2, 3]);
        assert!(tick.iter().all(|(_, frame)| frame.t_capture == tick[0].1.t_capture));
        for (_, frame) in tick {
            let before = counts.insert(frame.camera_id, frame.frame_number);
            assert!(before.is_none_or(|before| before + 1 == frame.frame_number));
        }
    }
    // The number counts a camera's frames, not ticks: four packets have the same one.
    assert_eq!(counts.values().collect::<BTreeSet<_>>().len(), 1);
    assert_eq!(frames.len(), 5076);
}

#[test]
fn trap_02_robots_where_cameras_overlap_come_twice() {
    let mut twice = 0;
    let mut apart = 0.0_f32;
    for tick in frames(GRSIM_NOISY).chunks(4) {
        let mut seen: BTreeMap<(bool, u32), Vec<DetectionRobot>> = BTreeMap::new();
        for (_, frame) in tick {
            for (yellow, robots) in [(true, &frame.robots_yellow), (false, &frame.robots_blue)] {
                for robot in robots {
                    seen.entry((yellow, robot.robot_id())).or_default().push(*robot);
                }
            }
        }
        for places in seen.values().filter(|places| places.len() > 1) {
            twice += 1;
            let distance = (places[0].x - places[1].x).hypot(places[0].y - places[1].y);
            apart = apart.max(distance);
        }
    }
    assert!(twice > 1000, "{twice}");
    // Two cameras' noise apart, not two robots': mm.
    assert!((1.0..200.0).contains(&apart), "{apart}");
}

#[test]
fn trap_02_grsim_sends_one_calibration_a_packet_and_erforce_all_of_them() {
    for (name, packets, cameras) in [(GRSIM, 168, vec![0, 1, 2, 3]), (ERFORCE, 1483, vec![0])] {
        let geometries = geometries(name);
        assert_eq!(geometries.len(), packets, "{name}");
        assert!(geometries.iter().all(|geometry| geometry.calib.len() == 1), "{name}");
        let merged: BTreeMap<_, &GeometryCameraCalibration> =
            geometries.iter().flat_map(|geometry| &geometry.calib).map(|one| (one.camera_id, one)).collect();
        assert_eq!(merged.into_keys().collect::<Vec<_>>(), cameras, "{name}");
    }
    // grSim: once in 120 packets, and then in all four.
    let vision = recordings::vision(GRSIM);
    let with_geometry: Vec<_> =
        (0..vision.len()).filter(|number| vision[*number].1.geometry.is_some()).collect();
    assert_eq!(with_geometry[..6], [36, 37, 38, 39, 156, 157]);
    assert!(vision.iter().all(|(_, packet)| packet.detection.is_some()), "never geometry alone");
}

#[test]
fn trap_03_a_designated_position_comes_with_commands_that_place_no_ball() {
    let packets = recordings::referee(GRSIM_NOISY);
    let designated: BTreeSet<_> = packets
        .iter()
        .filter(|(_, packet)| packet.designated_position.is_some())
        .map(|(_, packet)| packet.command())
        .collect();
    let beside = [Command::Halt, Command::Stop, Command::NormalStart, Command::PrepareKickoffYellow];
    assert!(beside.iter().all(|command| designated.contains(command)), "{designated:?}");
    // In mm, where all other values of the referee are in m.
    let place = packets.iter().find(|(_, packet)| packet.command() == Command::BallPlacementBlue);
    let place = place.and_then(|(_, packet)| packet.designated_position).expect("a placement");
    assert_eq!((place.x, place.y), (1200.0, 2800.0));
}

#[test]
fn trap_04_the_same_command_comes_again_with_a_new_count() {
    let packets = recordings::referee(GRSIM_NOISY);
    let mut again = BTreeSet::new();
    for pair in packets.windows(2) {
        let [(_, before), (_, now)] = pair else { unreachable!("windows of two") };
        if now.command_counter != before.command_counter {
            assert_eq!(now.command_counter, before.command_counter + 1);
            if now.command == before.command {
                again.insert(now.command());
            }
        }
    }
    let expected = [Command::Halt, Command::NormalStart, Command::BallPlacementBlue];
    assert_eq!(again, expected.into_iter().collect());
}

#[test]
fn trap_05_the_referee_may_be_silent_for_longer_than_a_second() {
    let packets = recordings::referee(GRSIM_NOISY);
    let mut gaps: Vec<_> = packets.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    gaps.sort_unstable();
    let median_ms = gaps[gaps.len() / 2] as f64 / 1e6;
    let longest_ms = gaps[gaps.len() - 1] as f64 / 1e6;
    assert!((24.0..28.0).contains(&median_ms), "{median_ms}");
    assert!((1500.0..1600.0).contains(&longest_ms), "{longest_ms}");
}

#[test]
fn trap_06_a_recorders_times_step_back() {
    let mut reader = recordings::open(GRSIM_NOISY);
    assert_eq!(reader.by_ref().count(), 21_536);
    let counts = reader.counts();
    assert_eq!(counts.back_steps, 6);
    assert!((1..1_000_000).contains(&counts.largest_back_step_ns), "{}", counts.largest_back_step_ns);
}

#[test]
fn trap_07_unicast_to_shared_listeners_reaches_one_of_them_and_multicast_all() {
    let group = SocketAddrV4::new(Ipv4Addr::new(224, 5, 23, 2), free_port());
    let mut listeners: Vec<_> =
        (0..3).map(|_| Receiver::join(group, &Interfaces::loopback()).expect("joins")).collect();
    let straight = Sender::unicast((Ipv4Addr::LOCALHOST, group.port()).into()).expect("a sender");
    let to_all = Sender::multicast(group, Some("127.0.0.1")).expect("a sender");
    straight.send(b"straight").expect("sent");
    to_all.send(b"to all").expect("sent");
    let mut received = Vec::new();
    for listener in &mut listeners {
        // On one machine's loopback the order holds: a receiver that has the second has had the first, or
        // never gets it.
        loop {
            let datagram = listener.receive(Duration::from_secs(5)).expect("no error").expect("the group's");
            received.push(datagram.bytes.to_vec());
            if datagram.bytes == b"to all" {
                break;
            }
        }
    }
    assert_eq!(received.iter().filter(|bytes| *bytes == b"straight").count(), 1);
    assert_eq!(received.iter().filter(|bytes| *bytes == b"to all").count(), 3);
}

#[test]
fn trap_08_neither_simulator_reports_the_defence_area_but_its_lines() {
    for (name, lines) in [(GRSIM, 18), (ERFORCE, 12)] {
        for geometry in geometries(name) {
            let field = &geometry.field;
            assert_eq!((field.penalty_area_depth, field.penalty_area_width), (None, None), "{name}");
            assert_eq!(
                (field.center_circle_radius, field.line_thickness, field.ball_radius),
                (None, None, None)
            );
            assert_eq!((field.goal_height, field.max_robot_radius), (None, None), "{name}");
            assert_eq!((field.field_length, field.field_width), (9000, 6000), "{name}");
            assert_eq!(field.field_lines.len(), lines, "{name}");
            for (stretch, end) in [("LeftPenaltyStretch", -1.0), ("RightPenaltyStretch", 1.0)] {
                let line = field.field_lines.iter().find(|line| line.name == stretch).expect("the line");
                assert_eq!((line.p1.y - line.p2.y).abs(), 2000.0, "{name}: width");
                // grSim draws its lines on the inner side, by half their width.
                let depth = 4500.0 - line.p1.x * end;
                assert!(depth == 1000.0 || depth == 1005.0, "{name}: {depth}");
            }
        }
    }
    // The two do not agree which side of an area is its left: lines are to be read by where they are.
    let y_of = |name| {
        let field = &geometries(name)[0].field;
        field.field_lines.iter().find(|line| line.name == "LeftFieldLeftPenaltyStretch").expect("it").p1.y
    };
    assert_eq!((y_of(GRSIM), y_of(ERFORCE)), (1000.0, -1000.0));
}

#[test]
fn trap_08_camera_rotation_pixels_and_confidence_are_dummies() {
    for name in [GRSIM, ERFORCE] {
        for geometry in geometries(name) {
            let camera = &geometry.calib[0];
            assert_eq!([camera.q0, camera.q1, camera.q2, camera.q3], [0.7; 4], "{name}");
            let norm: f32 = [camera.q0, camera.q1, camera.q2, camera.q3].iter().map(|q| q * q).sum();
            assert!(norm > 1.9, "{name}: not normalised");
            assert!(camera.derived_camera_world_tz.is_some_and(|z| z > 3000.0), "{name}: use this");
        }
        for (_, frame) in frames(name) {
            for robot in frame.robots_yellow.iter().chain(&frame.robots_blue) {
                assert_eq!((robot.confidence, robot.height), (1.0, None), "{name}");
                let pixel = (robot.pixel_x, robot.pixel_y);
                assert!(pixel == (robot.x, robot.y) || pixel == (0.0, 0.0), "{name}: {pixel:?}");
            }
            for ball in &frame.balls {
                assert!((0.9..=1.0).contains(&ball.confidence) && ball.z.is_none(), "{name}");
                assert_eq!(ball.area.is_some(), name == ERFORCE, "{name}");
            }
        }
        assert!(recordings::vision(name).iter().all(|(_, packet)| packet.source.is_none()), "{name}");
    }
}

#[test]
fn trap_08_balls_roll_differently_in_each_simulator() {
    let model = |name| {
        let models = geometries(name)[0].models.expect("models");
        let straight = models.straight_two_phase.expect("on the ground");
        let chip = models.chip_fixed_loss.expect("in the air");
        (
            [straight.acc_slide, straight.acc_roll, straight.k_switch],
            [chip.damping_xy_first_hop, chip.damping_xy_other_hops, chip.damping_z],
        )
    };
    assert_eq!(model(GRSIM), ([-14.0, -0.7, 0.7], [0.6, 0.96, 0.42]));
    assert_eq!(model(ERFORCE), ([-3.9, -0.35, 0.69], [0.715, 1.0, 0.566]));
}

#[test]
fn trap_09_feedback_names_absent_robots_misses_present_ones_and_names_some_twice() {
    // ER-Force's simulator, ideal: five robots a team were seen on the field, six answer, always.
    let clean = responses("robot_control_responses_divB_clean.hex.log");
    assert_eq!(clean.len(), 6449);
    let robots = clean.iter().filter(|(port, _)| *port != 10300);
    for (port, response) in robots {
        let ids: Vec<_> = response.feedback.iter().map(|robot| robot.id).collect();
        assert_eq!(ids, [0, 1, 2, 3, 4, 5], "port {port}");
    }
    // Realistic: each is missing in one of ten, and a late answer is added to the next.
    let realistic = responses("robot_control_responses_erforce_realistic.hex.log");
    assert_eq!(realistic.len(), 5801);
    let feedback: Vec<_> =
        realistic.iter().filter(|(port, _)| *port != 10300).map(|(_, one)| &one.feedback).collect();
    let single = feedback.iter().filter(|robots| robots.len() <= 6);
    let named: usize = single.clone().map(|robots| robots.len()).sum();
    let share = named as f64 / (6 * single.count()) as f64;
    assert!((0.85..0.95).contains(&share), "{share}");
    assert!(feedback.iter().any(|robots| robots.len() > 6), "no answer holds a robot twice");
}

#[test]
fn trap_11_a_ball_outside_no_ball_and_two_balls_are_normal() {
    let counted = |name| {
        let mut counts = BTreeMap::new();
        for (_, frame) in frames(name) {
            *counts.entry(frame.balls.len()).or_insert(0) += 1;
        }
        counts
    };
    assert_eq!(counted(ERFORCE), BTreeMap::from([(0, 364), (1, 1108), (2, 11)]));
    assert_eq!(counted(GRSIM_NOISY), BTreeMap::from([(0, 7277), (1, 6151)]));
    // Behind the goal line (4.5 m) by more than the goal is deep (0.18 m).
    let balls = frames(GRSIM_NOISY).into_iter().flat_map(|(_, frame)| frame.balls);
    let outside = balls.filter(|ball| ball.x.abs() > 4680.0).count();
    assert_eq!(outside, 75);
}

/// Camera frames with the recorder's times, ns.
fn frames(name: &str) -> Vec<(i64, DetectionFrame)> {
    let vision = recordings::vision(name).into_iter();
    vision.filter_map(|(received_ns, packet)| Some((received_ns, packet.detection?))).collect()
}

fn geometries(name: &str) -> Vec<GeometryData> {
    recordings::vision(name).into_iter().filter_map(|(_, packet)| packet.geometry).collect()
}

/// Answers of a simulator with the port they came from.
fn responses(name: &str) -> Vec<(u16, RobotControlResponse)> {
    let text = std::fs::read_to_string(recordings::path("packets").join(name)).expect("the recording");
    let line = |line: &str| {
        let [_, port, hex] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}: three columns") };
        let digits: Vec<_> = hex.bytes().map(|digit| (digit as char).to_digit(16).expect("hex")).collect();
        let bytes: Vec<_> = digits.chunks(2).map(|pair| (pair[0] << 4 | pair[1]) as u8).collect();
        (port.parse().expect("a port"), RobotControlResponse::decode(&bytes[..]).expect("decodes"))
    };
    text.lines().map(line).collect()
}

/// An unused port, not reserved against other programs.
fn free_port() -> u16 {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).expect("a free port");
    socket.local_addr().expect("bound").port()
}
