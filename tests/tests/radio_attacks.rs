//! A robot on wheels under a host whose radio is delayed, lossy, withheld, recorded or forged: it moves only
//! on commands of its host that are at most 200 ms old. The host's radio and a robot's station in virtual
//! time, ticks of 10 ms (docs/architecture.md §6.2).

use std::collections::VecDeque;

use brain::{BrainConfig, Station};
use geometry::{Pose, Twist, Vector};
use hil_sim::Stream;
use host::radio::{Radio, RadioSettings, RadioSituation, RadioWarning, Relay};
use match_tests::led_robot::{RUNNING, blind_sensors, drive_on, standing};
use protocol::frame::{Frame, Key, Refusal, RobotKeys, Sender, TeamKey};
use protocol::host::{HostCommand, HostMessage};
use protocol::link::{Link, Packet};
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use protocol::team::{Handshake, TeamMessage};
use protocol::{Duration, Instant, RobotId, TeamId};
use rules::{League, Phase, Side};

const KEY: TeamKey = TeamKey([0x3c; 16]);
const TEAM: TeamId = TeamId(1);
const TICK_MS: u64 = 10;
/// Packets that the radio carries in a tick at most: 1,250 a second (protocol/SPEC.md).
const FULL_RATE: usize = 13;

fn id() -> RobotId {
    RobotId::new(3).unwrap()
}

fn ms(n: u64) -> Instant {
    Instant(n * 1000)
}

fn radio(epoch: u32) -> Radio {
    Radio::new(RadioSettings { key: KEY, relay: Relay::ToEach, ..RadioSettings::new(TEAM, epoch) })
}

/// One direction of the radio link: packets with the time at which they are due.
struct Route {
    chance: Stream,
    packets: VecDeque<(u64, Packet)>,
    latency_ms: (u32, u32),
    loss: f32,
}

impl Route {
    fn new(name: &str, latency_ms: (u32, u32), loss: f32) -> Self {
        Self { chance: Stream::new(7, name), packets: VecDeque::new(), latency_ms, loss }
    }

    fn send(&mut self, now: u64, packet: Packet) {
        if self.chance.chance(self.loss) {
            return;
        }
        let late = u64::from(self.chance.whole(self.latency_ms.0, self.latency_ms.1));
        let due = self.packets.back().map_or(now + late, |(last, _)| (now + late).max(*last));
        self.packets.push_back((due, packet));
    }

    fn receive(&mut self, now: u64) -> Vec<Packet> {
        let due = self.packets.iter().take_while(|(due, _)| *due <= now).count();
        self.packets.drain(..due).map(|(_, packet)| packet).collect()
    }
}

/// A robot whose wheels reach ordered speeds at once, and its clock.
struct Body {
    station: Station<'static>,
    speed: f32,
    /// Its clock: starts that long after the host's, and runs faster by this rate in parts per million.
    behind_ms: u64,
    drift_ppm: f64,
}

impl Body {
    fn new(epoch: u32) -> Self {
        Self::with(epoch, 4_321, 0.0)
    }

    fn with(epoch: u32, behind_ms: u64, drift_ppm: f64) -> Self {
        let config = BrainConfig { epoch, ..BrainConfig::hosted(id(), TEAM, League::DivisionB) };
        let keys = KEY.of_robot(id());
        let station = Station::with_keys(Instant(0), &config, case_library::division_b(), keys);
        Self { station, speed: 0.0, behind_ms, drift_ppm }
    }

    fn clock(&self, now: u64) -> Instant {
        let own = (now + 10_000 - self.behind_ms) as f64 * 1e3;
        Instant((own * (1.0 + self.drift_ppm * 1e-6)) as u64)
    }

    fn step(&mut self, now: u64, received: &[Packet]) -> Vec<Packet> {
        let clock = self.clock(now);
        for packet in received {
            self.station.handle_packet(clock, packet);
        }
        let odometry = Twist { linear: Vector::new(self.speed, 0.0), angular: 0.0 };
        let sensors = SensorFrame { odometry, ..blind_sensors() };
        self.station.handle_sensors(clock, &sensors);
        let output = std::iter::from_fn(|| self.station.poll_packet(clock)).collect();
        self.speed = match self.station.poll_actuators(clock) {
            Some(ActuatorFrame::Omni { wheels, .. }) => {
                motion::omni::Omni::default().twist(wheels).linear.norm()
            }
            Some(ActuatorFrame::Released) | None => 0.0,
            Some(order) => panic!("no wheels: {order:?}"),
        };
        output
    }

    fn refused(&self, refusal: Refusal) -> u32 {
        self.station.link().refused()[refusal.kind()]
    }
}

/// A command to drive to a position that is never reached.
fn offer(radio: &mut Radio, now: u64) -> Vec<Packet> {
    offer_in(radio, now, Phase::Run)
}

/// As [`offer`], in a phase of the game.
fn offer_in(radio: &mut Radio, now: u64, phase: Phase<Side>) -> Vec<Packet> {
    let world = standing(ms(now), [(id(), Pose::default())]);
    let command = HostCommand { phase, ..drive_on(id()) };
    radio.offer(ms(now), &world, RadioSituation { phase, ..RUNNING }, &[command]);
    std::iter::from_fn(|| radio.poll_packet()).map(|(_, packet)| packet).collect()
}

/// A radio, a robot and the radio channel between them.
struct Match {
    radio: Radio,
    body: Body,
    down: Route,
    up: Route,
    now: u64,
}

impl Match {
    fn new(body: Body, latency_ms: (u32, u32), loss: f32) -> Self {
        let route = |name| Route::new(name, latency_ms, loss);
        Self { radio: radio(70), body, down: route("down"), up: route("up"), now: 0 }
    }

    /// 10 ms in which the host sends, or not.
    fn step(&mut self, host_lives: bool) {
        self.now += TICK_MS;
        if host_lives {
            for packet in self.up.receive(self.now) {
                let _ = self.radio.handle_packet(ms(self.now), &packet);
            }
            for packet in offer(&mut self.radio, self.now) {
                self.down.send(self.now, packet);
            }
        }
        let received = self.down.receive(self.now);
        for packet in self.body.step(self.now, &received) {
            self.up.send(self.now, packet);
        }
    }

    fn drive(&mut self) {
        (0..200).for_each(|_| self.step(true));
        assert!(self.body.speed > 0.5, "it drives: {} m/s", self.body.speed);
    }
}

#[test]
fn withheld_frames_of_a_dead_host_neither_start_nor_keep_a_robot() {
    let mut game = Match::new(Body::new(5), (3, 3), 0.0);
    game.drive();
    // The radio is jammed: 500 snapshots and their commands are withheld from the robot; then the host is
    // silent for ever.
    let mut withheld = Vec::new();
    for _ in 0..500 {
        game.now += TICK_MS;
        let output = game.body.step(game.now, &[]);
        for packet in output {
            let _ = game.radio.handle_packet(ms(game.now), &packet);
        }
        withheld.push(offer(&mut game.radio, game.now));
    }
    assert_eq!(game.body.speed, 0.0, "silence stopped it");
    assert!(withheld.iter().all(|packets| packets.len() >= 2));
    // Delivered one after the other over 15 s.
    let before = game.body.refused(Refusal::Stale);
    for packets in withheld {
        for part in 0..3 {
            game.now += TICK_MS;
            game.body.step(game.now, if part == 0 { &packets } else { &[] });
            assert_eq!(game.body.speed, 0.0, "{} ms", game.now);
        }
    }
    assert!(game.body.refused(Refusal::Stale) >= before + 1_000);
}

#[test]
fn ever_later_frames_stop_a_robot_at_an_age_of_200_ms() {
    // The attacker delivers in slow motion: every frame arrives, without a gap, but each a little later than
    // the last.
    for stretch in [2, 3, 5] {
        let mut game = Match::new(Body::new(5), (3, 3), 0.0);
        game.drive();
        let (start, driving) = (game.now, game.body.speed);
        let frames: Vec<_> = (1..=200)
            .map(|n| {
                let sent = start + n * TICK_MS;
                (sent, offer(&mut game.radio, sent))
            })
            .collect();
        let mut oldest = 0;
        for (n, (sent, packets)) in (1..).zip(&frames) {
            for wait in 0..stretch {
                game.now += TICK_MS;
                game.body.step(game.now, if wait + 1 == stretch { packets } else { &[] });
            }
            assert_eq!(game.now, start + n * stretch * TICK_MS);
            let age = game.now - sent;
            oldest = oldest.max(age);
            // From 200 ms on it brakes at 5 m/s²; one step may pass before.
            let braked = (age.saturating_sub(200 + 2 * TICK_MS)) as f32 * 1e-3 / (stretch as f32 - 1.0)
                * stretch as f32;
            let most = (driving - 5.0 * braked).max(0.0);
            assert!(
                game.body.speed <= most + 1e-3 || age < 200,
                "{} m/s at an age of {age} ms",
                game.body.speed
            );
        }
        assert!(oldest > 1_000 && game.body.speed == 0.0, "stretched by {stretch}");
    }
}

#[test]
fn a_dead_host_stops_its_robot_100_ms_after_the_last_frame() {
    let mut game = Match::new(Body::new(5), (3, 3), 0.0);
    game.drive();
    let (died, driving) = (game.now, game.body.speed);
    let mut braked = None;
    for _ in 0..200 {
        game.step(false);
        if game.body.speed < driving - 0.05 && braked.is_none() {
            braked = Some(game.now - died);
        }
    }
    assert!(braked.is_some_and(|after| (40..=120).contains(&after)), "{braked:?} ms");
    assert_eq!(game.body.speed, 0.0);
}

#[test]
fn latency_of_60_ms_loss_of_30_percent_and_clock_drift_stop_no_robot() {
    for (drift_ppm, latency) in [(0.0, (60, 60)), (200.0, (60, 60)), (-200.0, (60, 60)), (100.0, (3, 60))] {
        let mut game = Match::new(Body::with(5, 9_000, drift_ppm), latency, 0.3);
        (0..300).for_each(|_| game.step(true));
        let (mut stood, mut steps) = (0, 0);
        // Ten minutes: the clocks drift apart by 120 ms.
        for _ in 0..60_000 {
            game.step(true);
            steps += 1;
            stood += u32::from(game.body.speed == 0.0);
        }
        let share = f64::from(stood) / f64::from(steps);
        println!(
            "drift {drift_ppm} ppm, {latency:?} ms, 30 % lost: stands in {:.2} % of the steps",
            100.0 * share
        );
        assert!(share < 0.02, "drift {drift_ppm} ppm: stands in {share} of the steps");
        let stale = game.body.refused(Refusal::Stale);
        assert_eq!(stale, 0, "drift {drift_ppm} ppm");
        // And the age is still bounded: frames 300 ms late are refused.
        game.now += TICK_MS;
        let late = offer(&mut game.radio, game.now);
        assert!(late.len() >= 2);
        for _ in 0..30 {
            game.now += TICK_MS;
            game.body.step(game.now, &[]);
        }
        game.body.step(game.now, &late);
        assert!(game.body.refused(Refusal::Stale) > 0);
    }
}

#[test]
fn the_robot_that_refuses_an_earlier_host_epoch_is_named_within_2_s() {
    let mut game = Match::new(Body::new(5), (3, 3), 0.0);
    game.drive();
    // The second computer's clock is behind.
    game.radio = radio(69);
    let start = game.now;
    let mut reported = None;
    for _ in 0..300 {
        game.step(true);
        reported = reported
            .or_else(|| game.radio.warnings(ms(game.now)).next().map(|warning| (game.now - start, warning)));
    }
    let (after, warning) = reported.expect("a warning within 3 s");
    assert_eq!(warning, RadioWarning::LaterHost(id(), 70));
    assert!(after <= 2_000, "{after} ms");
    assert_eq!((game.radio.present(ms(game.now)).count(), game.body.speed), (0, 0.0));
    // Its epoch is one more than the last: the robot follows it, and the fault is over.
    game.radio = radio(71);
    (0..300).for_each(|_| game.step(true));
    assert_eq!(game.radio.warnings(ms(game.now)).collect::<Vec<_>>(), []);
    assert!(game.body.speed > 0.5);
}

#[test]
fn a_robot_with_a_foreign_key_is_named_within_2_s() {
    let mut game = Match::new(Body::new(5), (3, 3), 0.0);
    game.radio = Radio::new(RadioSettings { key: TeamKey([9; 16]), ..RadioSettings::new(TEAM, 70) });
    (0..200).for_each(|_| game.step(true));
    let warnings: Vec<_> = game.radio.warnings(ms(game.now)).collect();
    assert_eq!(warnings, [RadioWarning::WrongKey(id())]);
    assert_eq!(game.body.speed, 0.0);
}

#[test]
fn a_stolen_robots_keys_control_no_other_robot() {
    let mut game = Match::new(Body::new(5), (3, 3), 0.0);
    game.drive();
    let genuine = offer(&mut game.radio, game.now + TICK_MS);
    let stolen: Vec<RobotKeys> =
        RobotId::all().filter(|other| *other != id()).map(|n| KEY.of_robot(n)).collect();
    // The host stops; the attacker sends its recordings with newer counters under every key that the stolen
    // robot has, as fast as the radio carries them.
    let mut forged = 0;
    let driving = game.body.speed;
    for n in 0..300_u32 {
        for packet in &genuine {
            let frame = Frame::parse(packet, TEAM).unwrap();
            let keys: Vec<_> = stolen.iter().flat_map(|keys| [&keys.host, &keys.team]).collect();
            for keys in keys.chunks(FULL_RATE) {
                game.now += TICK_MS;
                let counter = (game.now * 1_000 / 64) as u32 + n % 7;
                let emit = |key: &&Key| Frame { counter, audience: None, ..frame }.emit(key).unwrap();
                let packets: Vec<_> = keys.iter().map(emit).collect();
                forged += packets.len();
                game.body.step(game.now, &packets);
            }
        }
    }
    assert!(driving > 0.5 && game.body.speed == 0.0, "{} m/s", game.body.speed);
    assert!(forged > 10_000 && game.body.refused(Refusal::Tag) > 5_000);
    // Those for which a step has no time are counted too.
    let unopened = game.body.station.brain().unopened();
    assert_eq!((unopened + game.body.refused(Refusal::Tag)) as usize, forged / genuine.len());
}

#[test]
fn halt_is_obeyed_in_time_under_a_flood_at_the_radios_full_rate() {
    // Commands to others and genuine beacons delay HALT by no step. Forgeries in the host's name come before
    // each of its frames: the robot stops as it does without a host (docs/firmware.md).
    type Flood = fn(u64) -> Vec<Packet>;
    let floods: [(&str, Flood, u64, u64); 3] = [
        ("elsewhere", commands_to_others, 20, 620),
        ("teammates", teammates_handshakes, 20, 620),
        ("forged", forged_commands, 120, 700),
    ];
    for (name, flood, brakes_within, stands_within) in floods {
        let mut game = Match::new(Body::new(5), (3, 3), 0.0);
        game.drive();
        let (start, driving) = (game.now, game.body.speed);
        let (mut brakes, mut stands) = (None, None);
        for _ in 0..100 {
            game.now += TICK_MS;
            let mut packets = flood(game.now);
            packets.extend(game.down.receive(game.now));
            game.body.step(game.now, &packets);
            for packet in offer_in(&mut game.radio, game.now, Phase::Halt) {
                game.down.send(game.now, packet);
            }
            let after = game.now - start;
            if game.body.speed < driving - 0.02 {
                brakes = brakes.or(Some(after));
            }
            stands = if game.body.speed == 0.0 { stands.or(Some(after)) } else { None };
        }
        println!("{name}: at {driving} m/s, brakes after {brakes:?} ms, stands after {stands:?} ms");
        assert!(brakes.is_some_and(|after| after <= brakes_within), "{name}: {brakes:?} ms");
        assert!(stands.is_some_and(|after| after <= stands_within), "{name}: {stands:?} ms");
    }
}

/// Commands of the host to a robot that is not this one, as many as a step's time on the air carries.
fn commands_to_others(now: u64) -> Vec<Packet> {
    let other = RobotId::new(9).unwrap();
    commands(now, other, &KEY.of_robot(other))
}

/// Commands to this robot that a stolen robot has forged.
fn forged_commands(now: u64) -> Vec<Packet> {
    commands(now, id(), &KEY.of_robot(RobotId::new(9).unwrap()))
}

fn commands(now: u64, to: RobotId, keys: &RobotKeys) -> Vec<Packet> {
    let mut payload = [0; 64];
    let payload = postcard::to_slice(&HostMessage::Command(drive_on(to)), &mut payload).unwrap();
    let frame = |n| {
        let counter = (now * 1_000 / 64) as u32 + n;
        let frame = Frame { team: TEAM, sender: Sender::Host, audience: None, epoch: 70, counter, payload };
        frame.emit(&keys.host).unwrap()
    };
    (0..FULL_RATE as u32).map(frame).collect()
}

fn teammates_handshakes(now: u64) -> Vec<Packet> {
    let others = RobotId::all().filter(|other| *other != id()).take(FULL_RATE);
    let handshake = TeamMessage::Handshake(Handshake { teammates: heapless::Vec::new() });
    let seal = |other: RobotId| Link::new(TEAM, other, KEY.of_robot(other), now as u32).seal(&handshake);
    others.map(seal).collect()
}

#[test]
fn a_rebooted_robot_is_commanded_again_and_its_old_frames_refused() {
    let mut game = Match::new(Body::new(5), (3, 3), 0.0);
    game.drive();
    let mut recorded = Vec::new();
    for _ in 0..50 {
        game.now += TICK_MS;
        recorded.extend(game.body.step(game.now, &[]));
    }
    // It boots; its recordings are replayed to a host that has started since.
    game.body = Body::with(6, 9_999, 50.0);
    game.radio = radio(71);
    for packet in &recorded {
        assert!(game.radio.handle_packet(ms(game.now), packet).is_err());
    }
    assert_eq!(game.radio.present(ms(game.now)).count(), 0);
    (0..200).for_each(|_| game.step(true));
    assert!(game.body.speed > 0.5);
    assert!(game.radio.present(ms(game.now) + Duration::millis(5)).eq([id()]));
}

#[test]
fn a_step_leaves_the_third_snapshot_of_three_and_obeys_every_command() {
    let mut game = Match::new(Body::new(5), (3, 3), 0.0);
    game.drive();
    let opened =
        |game: &Match| (game.body.station.link().snapshots().received, game.body.station.brain().unopened());
    let before = opened(&game);
    let mut packets = Vec::new();
    for _ in 0..3 {
        game.now += TICK_MS;
        packets.extend(offer(&mut game.radio, game.now));
    }
    game.body.step(game.now, &packets);
    assert_eq!(opened(&game), (before.0 + 2, before.1 + 1));
    // The next step plans, the one after it opens snapshots again.
    for _ in 0..2 {
        game.now += TICK_MS;
        let next = offer(&mut game.radio, game.now);
        game.body.step(game.now, &next);
    }
    assert_eq!(opened(&game), (before.0 + 3, before.1 + 2));
}
