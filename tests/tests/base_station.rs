//! `base_station`: tests: the host's radio on a serial line, a base station, modelled nRF24L01+ chips in
//! lossy air, and six brains behind them: with a loss of 0 to 30 % robots obey their host, the host hears all
//! of them, and none does what a robot must not (`firmware/nrf24`, docs/architecture.md §6).
//!
//! What each robot may believe is judged by a second implementation of the rules: a forged or repeated
//! frame is not among it.

use brain::{BrainConfig, Station};
use geometry::{Field, Point, Pose};
use host::radio::{Radio, RadioSettings};
use match_tests::led_robot::{RUNNING, blind_sensors, drive_on, standing};
use match_tests::swarm::guard::Guard;
use match_tests::swarm::honest::SentPackets;
use nrf24::{Base, Channel, Rate, Robot, Station as BaseStation};
use nrf24_model::{Air, Chip, ChipEnable, Faults, Pause, Spi};
use protocol::frame::TeamKey;
use protocol::robot_io::{ActuatorFrame, OmniKick};
use protocol::serial::{Lines, line};
use protocol::{Instant, RobotId, TeamId};
use rules::League;

const KEY: TeamKey = TeamKey([0x3c; 16]);
const TEAM: TeamId = TeamId(1);
const ROBOTS: u8 = 6;
const CHANNEL: Channel =
    Channel { team: TEAM, megahertz: 6, rate: Rate::Mbps2, address: protocol::station::ADDRESS_DEFAULT };
/// Simulated time and the smallest step of it, µs.
const DURATION: u64 = 5_000_000;
const STEP: u64 = 20;
/// Until then robots are found, greeted, and hear half a second of their host, µs: not counted.
const START: u64 = 2_000_000;
/// A step of brains, and the period of snapshots, µs.
const TICK: u64 = 10_000;
/// A processor serves its chip this often where the chip says nothing, µs.
const SERVE: u64 = 200;

/// A chip whose processor needs time for it.
struct Served<T> {
    end: T,
    chip: Chip,
    busy_until: u64,
    last: u64,
    has_news: bool,
}

impl<T> Served<T> {
    fn new(end: T, chip: Chip) -> Self {
        chip.take_spent();
        Self { end, chip, busy_until: 0, last: 0, has_news: false }
    }

    fn is_due(&mut self, now: u64) -> bool {
        let wants = self.has_news || self.chip.wants_attention() || now >= self.last + SERVE;
        let due = now >= self.busy_until && wants;
        if due {
            (self.last, self.has_news) = (now, false);
        }
        due
    }

    fn done(&mut self, now: u64, has_news: bool) {
        self.busy_until = now + self.chip.take_spent() / 1_000;
        self.has_news = has_news;
    }
}

struct Player {
    id: RobotId,
    brain: Station<'static>,
    radio: Served<Robot<Spi, ChipEnable, Pause>>,
    guard: Guard,
    frames: u32,
    believed: u32,
    obeyed: u32,
}

impl Player {
    fn new(air: &Air, number: u8) -> Self {
        let id = RobotId::new(number).expect("an id");
        let config = BrainConfig { epoch: 7, ..BrainConfig::hosted(id, TEAM, League::DivisionB) };
        let brain = Station::with_keys(Instant(0), &config, case_library::division_b(), KEY.of_robot(id));
        let chip = air.chip();
        let robot = Robot::start(Instant(0), CHANNEL, id, chip.spi(), chip.chip_enable(), chip.pause());
        let robot = robot.expect("the model");
        let radio = Served::new(robot, chip);
        Self { id, brain, radio, guard: Guard::new(id, 7, 0), frames: 0, believed: 0, obeyed: 0 }
    }

    fn serve(&mut self, now: u64, sent_packets: &SentPackets) {
        if !self.radio.is_due(now) {
            return;
        }
        let frame = self.radio.end.poll(Instant(now)).expect("the model answers");
        self.radio.done(now, frame.is_some());
        let Some(frame) = frame else { return };
        self.frames += 1;
        if let Some(believed) = self.guard.honest.receive(&frame, sent_packets) {
            self.believed += 1;
            self.guard.receive((now / 1_000) as u32, &believed);
        }
        self.brain.handle_packet(Instant(now), &frame);
    }

    fn step(&mut self, now: u64, sent_packets: &mut SentPackets) {
        let sensors = blind_sensors();
        self.brain.handle_sensors(Instant(now), &sensors);
        while let Some(packet) = self.brain.poll_packet(Instant(now)) {
            sent_packets.add(&packet);
            let _room = self.radio.end.send(Instant(now), &packet).expect("a frame of this team");
            self.radio.has_news = true;
        }
        let Some(order) = self.brain.poll_actuators(Instant(now)) else { return };
        let judged = self.guard.judge((now / 1_000) as u32, &sensors, &order);
        assert_eq!(judged, Ok(()), "robot {}, {now} µs", self.id);
        // A robot without a fresh command brakes and discharges its kicker (docs/architecture.md §6.2).
        let obeys = matches!(order, ActuatorFrame::Omni { kick, .. } if kick != OmniKick::Discharge);
        self.obeyed += u32::from(obeys && now >= START);
    }
}

/// What came of a run: shares of steps since [`START`] in which each robot obeyed, and robots that the host
/// heard at its end.
struct Outcome {
    obeyed: Vec<f64>,
    present: usize,
    frames: u32,
    believed: u32,
}

fn run(loss: f32, seed: u64) -> Outcome {
    let air = Air::new(Faults { loss, ..Faults::default() }, seed);
    let mut players: Vec<_> = (0..ROBOTS).map(|number| Player::new(&air, number)).collect();
    let chip = air.chip();
    let base = Base::start(Instant(0), CHANNEL, chip.spi(), chip.chip_enable(), chip.pause());
    let mut station = Served::new(BaseStation::new(base.expect("the model")), chip);
    let mut radio = Radio::new(RadioSettings { key: KEY, ..RadioSettings::new(TEAM, 70) });
    let (mut host_lines, mut sent_packets) = (Lines::new(), SentPackets::default());
    for now in (0..DURATION).step_by(STEP as usize) {
        air.advance(now * 1_000);
        let at = Instant(now);
        if now % TICK == 0 {
            let world = standing(at, players.iter().map(|player| (player.id, place(player.id))));
            let commands: Vec<_> = players.iter().map(|player| drive_on(player.id)).collect();
            radio.offer(at, &world, RUNNING, &commands);
            for player in &mut players {
                player.step(now, &mut sent_packets);
            }
        }
        radio.handle_timeout(at);
        while let Some((_, packet)) = radio.poll_packet() {
            sent_packets.add(&packet);
            station.end.push(at, &line(&packet));
            station.has_news = true;
        }
        if station.is_due(now) {
            let line = station.end.poll(at).expect("the model answers");
            station.done(now, line.is_some());
            for packet in line.iter().flatten().filter_map(|byte| host_lines.push(*byte)) {
                // What it refuses it counts; a robot that does not know the host yet is refused.
                let _ = radio.handle_packet(at, &packet);
            }
        }
        for player in &mut players {
            player.serve(now, &sent_packets);
        }
    }
    assert_eq!(station.end.refused(), 0, "the host's line is whole");
    let steps = ((DURATION - START) / TICK) as f64;
    Outcome {
        obeyed: players.iter().map(|player| f64::from(player.obeyed) / steps).collect(),
        present: radio.present(Instant(DURATION)).count(),
        frames: players.iter().map(|player| player.frames).sum(),
        believed: players.iter().map(|player| player.believed).sum(),
    }
}

/// In a row, 1 m apart.
fn place(id: RobotId) -> Pose<Field> {
    Pose { position: Point::new(-2.0, f32::from(id.number()) - 2.5), ..Pose::default() }
}

#[test]
fn six_brains_behind_lossy_nrf24_radios_obey_and_are_received() {
    for (loss, seed) in [(0.0, 1), (0.1, 2), (0.2, 3), (0.3, 4)] {
        let Outcome { obeyed, present, frames, believed } = run(loss, seed);
        println!(
            "loss {loss}: obeyed {obeyed:.2?} of the steps, {present} heard, {believed} of {frames} believed"
        );
        assert_eq!(present, usize::from(ROBOTS), "loss {loss}, seed {seed}");
        // A robot brakes after 100 ms without a command. Of ten commands each is lost with 0.3³ at the most,
        // sent three times: practically never all of them.
        assert!(obeyed.iter().all(|share| *share > 0.95), "loss {loss}, seed {seed}: {obeyed:?}");
    }
}
