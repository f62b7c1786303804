//! `uart`: tests: a serial line that drops, delays, duplicates and corrupts bytes never makes a robot
//! dangerous, and the robot plays again when the line is good. The host's radio and a robot's station with
//! COBS between them, over an adversary of single bytes (docs/architecture.md §6.1).

use std::collections::VecDeque;

use brain::{BrainConfig, Station};
use geometry::{GoalEnd, Pose, Twist};
use hil_sim::Stream;
use host::radio::{Radio, RadioSettings, RadioSituation};
use host::world::{BallModels, Robot, World};
use match_tests::bad_line::{BadLine, Trouble};
use match_tests::swarm::guard::Guard;
use match_tests::swarm::honest::Sayings;
use protocol::frame::TeamKey;
use protocol::host::{Directive, HostCommand, RuleRole};
use protocol::quantized::{WirePoint, WirePose};
use protocol::robot_io::{ActuatorFrame, Health, OmniKick, SensorFrame};
use protocol::serial::{Lines, line};
use protocol::{Instant, RobotId, TeamId, Who};
use rules::{Colour, League, Phase};

const KEY: TeamKey = TeamKey([0x3c; 16]);
const TEAM: TeamId = TeamId(1);
/// A tick, ms.
const TICK: u32 = 10;

/// One direction of the line: bytes with the tick in which they are due.
struct Uart {
    line: BadLine,
    delay: Stream,
    bytes: VecDeque<(u32, u8)>,
    /// Maximum delay of a byte, ticks; none overtakes another.
    late: u32,
}

impl Uart {
    fn new(seed: u64, name: &str) -> Self {
        let delay = Stream::new(seed, &format!("{name}, delay"));
        Self { line: BadLine::new(seed, name), delay, bytes: VecDeque::new(), late: 0 }
    }

    fn send(&mut self, tick: u32, packet: &[u8]) {
        for byte in line(packet) {
            let due = tick + self.delay.whole(0, self.late);
            let due = self.bytes.back().map_or(due, |(last, _)| due.max(*last));
            self.bytes.extend(self.line.carry(byte).map(|byte| (due, byte)));
        }
    }

    fn receive(&mut self, tick: u32, lines: &mut Lines) -> Vec<protocol::link::Packet> {
        let due = self.bytes.iter().take_while(|(due, _)| *due <= tick).count();
        self.bytes.drain(..due).filter_map(|(_, byte)| lines.push(byte)).collect()
    }
}

/// Results of a run.
#[derive(Debug, Default)]
struct Reported {
    frames: u32,
    believed: u32,
    dropped: u32,
    drove: u32,
    braked: u32,
}

/// Ten seconds: good, bad from the second to the sixth, good.
fn run(seed: u64, bad: Trouble, late: u32) -> Reported {
    let id = RobotId::new(3).unwrap();
    let config = BrainConfig { epoch: 7, ..BrainConfig::hosted(id, TEAM, League::DivisionB) };
    let mut station = Station::with_keys(Instant(0), &config, case_library::division_b(), KEY.of_robot(id));
    let mut radio = Radio::new(RadioSettings { key: KEY, ..RadioSettings::new(TEAM, 70) });
    let (mut down, mut up) = (Uart::new(seed, "uart down"), Uart::new(seed, "uart up"));
    let (mut robots_lines, mut hosts_lines) = (Lines::new(), Lines::new());
    let (mut guard, mut sayings) = (Guard::new(id, 7, 0), Sayings::default());
    let mut reported = Reported::default();
    let mut kicks = Vec::new();
    for tick in 0..1_000 {
        let (ms, now) = (tick * TICK, Instant(u64::from(tick * TICK) * 1000));
        let trouble = (2_000..6_000).contains(&ms);
        for uart in [&mut down, &mut up] {
            (uart.line.trouble, uart.late) = if trouble { (bad, late) } else { (Trouble::default(), 0) };
        }
        for packet in up.receive(tick, &mut hosts_lines) {
            // Corrupted packets are refused.
            let _ = radio.handle_packet(now, &packet);
        }
        let to = HostCommand {
            to: id,
            defending: GoalEnd::Negative,
            phase: Phase::Run,
            rule_role: RuleRole::Player,
            // Never reached: it drives on.
            directive: Directive::GoTo { pose: WirePose { at: WirePoint { x: 3_000, y: 0 }, heading: 0 } },
        };
        let situation = RadioSituation { us: Colour::Blue, phase: Phase::Run, placement: None };
        radio.offer(now, &field(now, id), situation, &[to]);
        while let Some((_, packet)) = radio.poll_packet() {
            sayings.add(&packet);
            down.send(tick, &packet);
        }
        for packet in down.receive(tick, &mut robots_lines) {
            reported.frames += 1;
            if let Some(believed) = guard.honest.receive(&packet, &sayings) {
                reported.believed += 1;
                guard.receive(ms, &believed);
            }
            station.handle_packet(now, &packet);
        }
        let health = Health { battery: Some(16.0), tipped: false, kicker_ready: true };
        let sensors = SensorFrame {
            pose: None,
            ball: None,
            opponents: heapless::Vec::new(),
            ball_contact: false,
            busy: false,
            odometry: Twist::default(),
            health,
            camera: None,
        };
        station.handle_sensors(now, &sensors);
        while let Some(packet) = station.poll_packet(now) {
            sayings.add(&packet);
            up.send(tick, &packet);
        }
        let Some(order) = station.poll_actuators(now) else { continue };
        let judged = guard.judge(ms, &sensors, &order);
        assert_eq!(judged, Ok(()), "seed {seed}, {ms} ms");
        let (kick, wheels) = match order {
            ActuatorFrame::Omni { kick, wheels, .. } => (kick, wheels),
            ActuatorFrame::Released => (OmniKick::Discharge, [0.0; 4]),
            ActuatorFrame::Legged { .. } => panic!("no wheels: {order:?}"),
        };
        kicks.push((ms, kick));
        if trouble {
            reported.braked += u32::from(kick == OmniKick::Discharge);
            reported.drove += u32::from(wheels.iter().any(|rim| rim.abs() > 0.1));
        }
    }
    // After receiving for half a second it is armed, as it was before the trouble.
    let armed = |from: u32, to: u32| {
        kicks.iter().filter(|(ms, _)| (from..to).contains(ms)).all(|(_, kick)| *kick != OmniKick::Discharge)
    };
    assert!(armed(1_000, 2_000) && armed(7_000, 10_000), "seed {seed}");
    reported.dropped = robots_lines.dropped() + hosts_lines.dropped();
    reported
}

/// It stands in the middle; no other robot is there.
fn field(now: Instant, id: RobotId) -> World {
    let mut world = World::empty(now, BallModels::default());
    world.put(Robot {
        who: Who { colour: Colour::Blue, id },
        pose: Pose::default(),
        velocity: geometry::Vector::default(),
        angular: 0.0,
        confidence: 1.0,
        seen: now,
    });
    world
}

#[test]
fn a_line_that_drops_doubles_and_corrupts_a_byte_in_a_hundred_slows_a_robot_and_never_makes_it_dangerous() {
    for seed in 0..8 {
        // Each fault alone, then all together.
        let good = Trouble::default();
        for bad in [
            Trouble { dropped: 10.0, ..good },
            Trouble { changed: 10.0, ..good },
            Trouble { doubled: 10.0, ..good },
            Trouble::of_each(4.0),
        ] {
            let reported = run(seed, bad, 2);
            assert!(reported.believed < reported.frames && reported.dropped > 0, "{reported:?}");
            assert!(reported.drove > 0, "{reported:?}");
        }
    }
}

#[test]
fn a_line_so_bad_that_hardly_a_frame_survives_makes_it_brake() {
    for seed in 0..8 {
        let reported = run(seed, Trouble::of_each(60.0), 5);
        assert!(reported.braked > 300 && reported.drove < 100, "{reported:?}");
    }
}

#[test]
fn bytes_that_come_late_but_whole_are_no_trouble_up_to_three_ticks() {
    for seed in 0..8 {
        let reported = run(seed, Trouble::default(), 3);
        assert_eq!((reported.braked, reported.dropped), (0, 0), "{reported:?}");
    }
}
