//! `uart`: tests: a serial line that drops, delays, duplicates and corrupts bytes never makes a robot
//! dangerous, and the robot plays again when the line is good. The host's radio and a robot's station with
//! COBS between them, over an adversary of single bytes (docs/architecture.md §6.1).

use std::collections::VecDeque;

use brain::{BrainConfig, Station};
use geometry::Pose;
use hil_sim::Stream;
use host::radio::{Radio, RadioSettings};
use match_tests::bad_line::{BadLine, Trouble};
use match_tests::led_robot::{RUNNING, blind_sensors, drive_on, standing};
use match_tests::swarm::guard::Guard;
use match_tests::swarm::honest::SentPackets;
use protocol::frame::TeamKey;
use protocol::robot_io::{ActuatorFrame, OmniKick};
use protocol::serial::{Lines, line};
use protocol::{Instant, RobotId, TeamId};
use rules::League;

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

#[derive(Debug, Default)]
struct Counts {
    frames: u32,
    believed: u32,
    dropped: u32,
    drove: u32,
    braked: u32,
}

/// Ten seconds: good, bad from the second to the sixth, good.
fn run(seed: u64, bad: Trouble, late: u32) -> Counts {
    let id = RobotId::new(3).unwrap();
    let config = BrainConfig { epoch: 7, ..BrainConfig::hosted(id, TEAM, League::DivisionB) };
    let mut station = Station::with_keys(Instant(0), &config, case_library::division_b(), KEY.of_robot(id));
    let mut radio = Radio::new(RadioSettings { key: KEY, ..RadioSettings::new(TEAM, 70) });
    let (mut down, mut up) = (Uart::new(seed, "uart down"), Uart::new(seed, "uart up"));
    let (mut robots_lines, mut hosts_lines) = (Lines::new(), Lines::new());
    let (mut guard, mut sent_packets) = (Guard::new(id, 7, 0), SentPackets::default());
    let mut counts = Counts::default();
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
        radio.offer(now, &standing(now, [(id, Pose::default())]), RUNNING, &[drive_on(id)]);
        while let Some((_, packet)) = radio.poll_packet() {
            sent_packets.add(&packet);
            down.send(tick, &packet);
        }
        for packet in down.receive(tick, &mut robots_lines) {
            counts.frames += 1;
            if let Some(believed) = guard.honest.receive(&packet, &sent_packets) {
                counts.believed += 1;
                guard.receive(ms, &believed);
            }
            station.handle_packet(now, &packet);
        }
        let sensors = blind_sensors();
        station.handle_sensors(now, &sensors);
        while let Some(packet) = station.poll_packet(now) {
            sent_packets.add(&packet);
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
            counts.braked += u32::from(kick == OmniKick::Discharge);
            counts.drove += u32::from(wheels.iter().any(|rim| rim.abs() > 0.1));
        }
    }
    // After receiving for half a second it is armed, as it was before the trouble.
    let armed = |from: u32, to: u32| {
        kicks.iter().filter(|(ms, _)| (from..to).contains(ms)).all(|(_, kick)| *kick != OmniKick::Discharge)
    };
    assert!(armed(1_000, 2_000) && armed(7_000, 10_000), "seed {seed}");
    counts.dropped = robots_lines.dropped() + hosts_lines.dropped();
    counts
}

#[test]
fn a_serial_line_with_1_percent_faulty_bytes_is_never_dangerous() {
    for seed in 0..8 {
        // Each fault alone, then all together.
        let good = Trouble::default();
        for bad in [
            Trouble { dropped: 10.0, ..good },
            Trouble { changed: 10.0, ..good },
            Trouble { doubled: 10.0, ..good },
            Trouble::of_each(4.0),
        ] {
            let counts = run(seed, bad, 2);
            assert!(counts.believed < counts.frames && counts.dropped > 0, "{counts:?}");
            assert!(counts.drove > 0, "{counts:?}");
        }
    }
}

#[test]
fn a_serial_line_that_loses_most_frames_makes_the_robot_brake() {
    for seed in 0..8 {
        let counts = run(seed, Trouble::of_each(60.0), 5);
        assert!(counts.braked > 300 && counts.drove < 100, "{counts:?}");
    }
}

#[test]
fn bytes_up_to_three_ticks_late_cause_no_braking() {
    for seed in 0..8 {
        let counts = run(seed, Trouble::default(), 3);
        assert_eq!((counts.braked, counts.dropped), (0, 0), "{counts:?}");
    }
}
