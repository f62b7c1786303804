//! `common`: teams of robots with their base stations in the modelled air, with a match's traffic. Times in
//! µs.
#![allow(dead_code, reason = "the table and each test use a part")]

pub(crate) mod channels;

use std::collections::{BTreeMap, HashMap};

use embedded_hal::spi::SpiDevice;
use nrf24::{Base, Channel, Rate, Robot, Station};
use nrf24_model::{Air, AirCounts, Chip, ChipEnable, Faults, Pause, Spi};
use protocol::frame::{Audience, Frame, Sender, Sessions, TeamKey};
use protocol::serial::{Lines, line};
use protocol::station::{self, StationMessage};
use protocol::{Instant, RobotId, TeamId};

/// What is simulated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) teams: u8,
    /// All teams on one channel, or each on its own.
    pub(crate) same_channel: bool,
    pub(crate) rate: Rate,
    /// Period of snapshots and commands, µs.
    pub(crate) period: u64,
    pub(crate) faults: Faults,
    pub(crate) seed: u64,
    /// µs.
    pub(crate) duration: u64,
    /// What goes wrong with a chip, at [`UPSET_AT`].
    pub(crate) upset: Option<Upset>,
}

/// What goes wrong with one chip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Upset {
    /// The base station's, or that of robot 3.
    pub(crate) at_base: bool,
    pub(crate) kind: UpsetKind,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum UpsetKind {
    /// These bits of each byte of a register turn.
    Bits { register: u8, mask: u8 },
    /// Its supply is away for so long, µs; 0 is a reset.
    Supply { away: u64 },
}

/// Time of the upset, µs: all robots are found, and the registers were just read back.
pub(crate) const UPSET_AT: u64 = 702_000;

impl Plan {
    /// One team at 100 Hz for ten seconds.
    pub(crate) fn one_team(rate: Rate, faults: Faults) -> Self {
        Self {
            teams: 1,
            same_channel: false,
            rate,
            period: 10_000,
            faults,
            seed: 1,
            duration: 10_000_000,
            upset: None,
        }
    }
}

pub(crate) const ROBOTS: u8 = 6;
/// Two parts of a snapshot of 12 robots: 115 bytes each (SPEC.md: World, six robots, a ball, six tags).
const PART: usize = 115;
/// A command "pass" (SPEC.md).
const COMMAND: usize = 33;
const WELCOME: usize = 29;
/// A beacon within a cycle, and telemetry (protocol/README.md).
const BEACON: usize = 60;
const TELEMETRY: usize = 59;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Kind {
    Part,
    Command,
    Welcome,
    Beacon,
    Telemetry,
    Relayed,
}

/// What came of one kind of frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) expected: u64,
    /// Latency of each frame at each receiver, µs.
    pub(crate) latency: Vec<u64>,
}

impl Tally {
    pub(crate) fn share(&self) -> f64 {
        self.latency.len() as f64 / (self.expected as f64).max(1.0)
    }

    /// The latency that this share of the frames that came keeps to, ms.
    pub(crate) fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.latency.clone();
        sorted.sort_unstable();
        let at = ((sorted.len() as f64 * share).ceil() as usize).clamp(1, sorted.len().max(1)) - 1;
        sorted.get(at).map_or(f64::NAN, |us| *us as f64 / 1e3)
    }
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) tallies: BTreeMap<Kind, Tally>,
    /// Frames believed that were never sent so.
    pub(crate) altered: u64,
    /// Frames believed twice by one receiver.
    pub(crate) twice: u64,
    /// Complete frames that failed their tag, or their counter.
    pub(crate) refused: u64,
    /// Complete frames that a radio handed out twice, whatever the receiver made of them.
    pub(crate) handed_twice: u64,
    /// Longest time in which a robot believed nothing of its host, µs.
    pub(crate) longest_silence: u64,
    /// Longest time without a frame believed, µs, up to the end of the run: of a robot from the host, of the
    /// host from a robot.
    pub(crate) longest_gap: [u64; 2],
    /// Starts of the base station's chip and the robots' after the first.
    pub(crate) restarts: u32,
    pub(crate) air: AirCounts,
    pub(crate) late: u32,
}

type ChipStation = Station<Spi, ChipEnable, Pause>;
type ChipRobot = Robot<Spi, ChipEnable, Pause>;

struct Node<T> {
    end: T,
    chip: Chip,
    busy_until: u64,
    served: u64,
}

impl<T> Node<T> {
    /// Whether the processor serves its chip now.
    fn is_due(&self, now: u64, has_news: bool) -> bool {
        now >= self.busy_until && (has_news || self.chip.wants_attention() || now >= self.served + 200)
    }

    fn served(&mut self, now: u64) {
        self.served = now;
        self.busy_until = now + self.chip.take_spent() / 1_000 + 5;
    }
}

/// Checks frames as a receiver does: tag, then epoch and counter of their sender.
#[derive(Default)]
struct Believer {
    sessions: Sessions,
    handed: HashMap<Vec<u8>, u32>,
    believed: HashMap<Vec<u8>, u32>,
    heard_host: u64,
    /// Times of frames of the host that were believed.
    host_times: Vec<u64>,
}

struct Team {
    id: TeamId,
    station: Node<ChipStation>,
    robots: Vec<Node<ChipRobot>>,
    at_robots: Vec<Believer>,
    at_host: Believer,
    host_line: Lines,
    counters: [u32; 18],
    /// Frames to pass on, and when.
    relay: Vec<(u64, Vec<u8>)>,
    /// Frames sent, with kind and time.
    sent: HashMap<Vec<u8>, (Kind, u64)>,
    news: Vec<bool>,
    station_news: bool,
    /// Messages of the base station itself.
    answers: Vec<StationMessage>,
    /// Time of the last frame believed, of each robot from the host and of the host from each robot, µs.
    heard: [[u64; ROBOTS as usize]; 2],
}

const KEY: TeamKey = TeamKey([7, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);
const STEP: u64 = 10;
/// Not the default: that of some team's key.
pub(crate) const ADDRESS: u16 = 0x9c35;

impl Team {
    fn new(air: &Air, number: u8, plan: &Plan) -> Self {
        let id = TeamId(number + 1);
        let megahertz = if plan.same_channel { 76 } else { 76 + 4 * number };
        let channel = Channel { team: id, megahertz, rate: plan.rate, address: ADDRESS };
        let chip = air.chip();
        let base = Base::start(Instant(0), channel, chip.spi(), chip.chip_enable(), chip.pause()).unwrap();
        chip.take_spent();
        // Two hosts do not start in the same microsecond.
        let offset = u64::from(number) * 3_700;
        let station = Node { end: Station::new(base), chip, busy_until: offset, served: 0 };
        let robots = (0..ROBOTS).map(|robot| {
            let chip = air.chip();
            let robot = RobotId::new(robot).unwrap();
            let (spi, enable, pause) = (chip.spi(), chip.chip_enable(), chip.pause());
            let end = Robot::start(Instant(0), channel, robot, spi, enable, pause).unwrap();
            chip.take_spent();
            Node { end, chip, busy_until: 0, served: 0 }
        });
        Self {
            id,
            station,
            robots: robots.collect(),
            at_robots: (0..ROBOTS).map(|_| Believer::default()).collect(),
            at_host: Believer::default(),
            host_line: Lines::new(),
            counters: [0; 18],
            relay: Vec::new(),
            sent: HashMap::new(),
            news: vec![false; usize::from(ROBOTS)],
            station_news: false,
            answers: Vec::new(),
            heard: [[WARM_UP; ROBOTS as usize]; 2],
        }
    }

    /// Upsets a chip, once it is time.
    fn upset(&self, upset: Upset, now: u64) {
        let chip = if upset.at_base { &self.station.chip } else { &self.robots[3].chip };
        match upset.kind {
            UpsetKind::Bits { register, mask } if now == UPSET_AT => {
                let len = if matches!(register, 0x0a | 0x0b | 0x10) { 5 } else { 1 };
                let mut bytes = vec![register; 1 + len];
                chip.spi().transfer_in_place(&mut bytes).unwrap();
                bytes.iter_mut().skip(1).for_each(|byte| *byte ^= mask);
                bytes[0] = 0x20 | register;
                chip.spi().write(&bytes).unwrap();
            }
            UpsetKind::Supply { away } if now == UPSET_AT || now == UPSET_AT + away => {
                chip.power(now == UPSET_AT + away);
            }
            _ => {}
        }
    }

    /// A frame of this length from that sender, its payload beginning with `head`.
    fn frame(&mut self, sender: u8, head: &[u8], len: usize) -> Vec<u8> {
        let several = sender == 17;
        let counter =
            if sender >= 16 { &mut self.counters[16] } else { &mut self.counters[usize::from(sender)] };
        *counter += 1;
        let counter = *counter;
        let audience = several.then_some(Audience((1 << ROBOTS) - 1));
        let overhead = if several { 13 + 3 * usize::from(ROBOTS) } else { 19 };
        let mut payload = head.to_vec();
        payload.extend((payload.len()..len - overhead).map(|at| (at as u32 * 37 + counter) as u8));
        let sender = Sender::new(sender.min(16)).unwrap();
        let frame = Frame { team: self.id, sender, audience, epoch: 5, counter, payload: &payload };
        let keys = KEY.of_team();
        let to = RobotId::new(head.get(1).copied().unwrap_or(0) & 15).unwrap();
        let sealed = match sender {
            Sender::Host if several => frame.emit_to_audience(&keys),
            Sender::Host => frame.emit(keys.of(to)),
            Sender::Robot(_) => frame.emit(&KEY.of_robot(to).team),
        };
        sealed.expect("fits").to_vec()
    }
}

/// Runs the plan.
pub(crate) fn run(plan: &Plan) -> Outcome {
    let air = Air::new(plan.faults, plan.seed);
    let mut teams: Vec<Team> = (0..plan.teams).map(|number| Team::new(&air, number, plan)).collect();
    let mut outcome = Outcome::default();
    let mut now = 0;
    // The first half second finds the robots; afterwards everything counts.
    while now < plan.duration {
        air.advance(now * 1_000);
        let counted = now > WARM_UP && now + COOL_DOWN < plan.duration;
        for (number, team) in teams.iter_mut().enumerate() {
            if let Some(upset) = plan.upset {
                team.upset(upset, now);
            }
            traffic(plan, team, now, number as u64 * 3_700, counted, &mut outcome);
            serve(team, now, &mut outcome);
        }
        now += STEP;
    }
    for team in &mut teams {
        for (way, robot) in (0..2).flat_map(|way| (0..usize::from(ROBOTS)).map(move |robot| (way, robot))) {
            hear(&mut team.heard[way], robot, now, &mut outcome.longest_gap[way]);
        }
        let robots = team.robots.iter().map(|robot| robot.end.counts().restarts);
        outcome.restarts += team.station.end.counts().restarts + robots.sum::<u32>();
    }
    outcome.air = air.counts();
    outcome.late = teams.iter().map(|team| team.station.end.counts().late).sum();
    outcome
}

pub(crate) const WARM_UP: u64 = 500_000;
/// What is sent last may still be under way.
const COOL_DOWN: u64 = 200_000;

fn note(outcome: &mut Outcome, team: &mut Team, frame: &[u8], kind: Kind, now: u64, receivers: u64) {
    outcome.tallies.entry(kind).or_default().expected += receivers;
    team.sent.insert(covered(frame).to_vec(), (kind, now));
}

fn traffic(plan: &Plan, team: &mut Team, now: u64, offset: u64, counted: bool, outcome: &mut Outcome) {
    // Before its first round the robots of a team already send, at phases that wrap around zero.
    let at = now.wrapping_sub(offset);
    let robots = u64::from(ROBOTS);
    let mut down = Vec::new();
    if at % plan.period < STEP && now >= offset {
        for part in 0..2 {
            let frame = team.frame(17, &[0, part], PART);
            down.push((frame, Kind::Part, robots));
        }
        for robot in 0..ROBOTS {
            let frame = team.frame(16, &[1, robot], COMMAND);
            down.push((frame, Kind::Command, 1));
        }
    }
    if at % 100_000 < STEP && now >= offset {
        for robot in 0..ROBOTS {
            let frame = team.frame(16, &[2, robot], WELCOME);
            down.push((frame, Kind::Welcome, 1));
        }
    }
    let due: Vec<_> = team.relay.extract_if(.., |(due, _)| *due <= now).map(|(_, frame)| frame).collect();
    for frame in due {
        down.push((frame, Kind::Relayed, robots - 1));
    }
    for (frame, kind, receivers) in down {
        if counted {
            note(outcome, team, &frame, kind, now, receivers);
        } else {
            team.sent.insert(covered(&frame).to_vec(), (kind, u64::MAX));
        }
        team.station.end.push(Instant(now), &line(&frame));
        team.station_news = true;
    }
    for robot in 0..ROBOTS {
        // As robots on wheels do: one after another, in every fifth step of 10 ms (SPEC.md: TeamMessage).
        let turn = at.wrapping_add(u64::from(robot) * 10_130) % 50_000;
        let mut up = Vec::new();
        if turn < STEP && now > 0 {
            up.push((team.frame(robot, &[0, robot], BEACON), Kind::Beacon));
        }
        if at.wrapping_add(5_000 + u64::from(robot) * 17_000) % 100_000 < STEP {
            up.push((team.frame(robot, &[1, robot], TELEMETRY), Kind::Telemetry));
        }
        for (frame, kind) in up {
            if counted {
                note(outcome, team, &frame, kind, now, 1);
            } else {
                team.sent.insert(covered(&frame).to_vec(), (kind, u64::MAX));
            }
            let _ = team.robots[usize::from(robot)].end.send(Instant(now), &frame).expect("a frame");
            team.news[usize::from(robot)] = true;
        }
    }
}

fn serve(team: &mut Team, now: u64, outcome: &mut Outcome) {
    if team.station.is_due(now, team.station_news) {
        // A fault is a chip without its supply.
        let line = team.station.end.poll(Instant(now)).unwrap_or_default();
        team.station.served(now);
        team.station_news = line.is_some();
        let frames: Vec<_> = line.iter().flatten().filter_map(|byte| team.host_line.push(*byte)).collect();
        for frame in frames {
            if let Some(message) = station::read(&frame) {
                team.answers.push(message);
                continue;
            }
            let key = |sender: RobotId| KEY.of_robot(sender).team;
            if believe(&mut team.at_host, &frame, team.id, key, RobotId::ZERO, outcome) {
                settle(&team.sent, &frame, now, outcome);
                hear(&mut team.heard[1], usize::from(frame[2]), now, &mut outcome.longest_gap[1]);
                if team.sent.get(covered(&frame)).is_some_and(|(kind, _)| *kind == Kind::Beacon) {
                    team.relay.push((now + 500, frame.to_vec()));
                }
            }
        }
    }
    for (number, node) in team.robots.iter_mut().enumerate() {
        if !node.is_due(now, team.news[number]) {
            continue;
        }
        let frame = node.end.poll(Instant(now)).unwrap_or_default();
        node.served(now);
        team.news[number] = frame.is_some();
        let Some(frame) = frame else { continue };
        let own = RobotId::new(number as u8).unwrap();
        let is_host = frame.get(2).is_some_and(|sender| *sender >= 16);
        // Its own beacon, passed on: a robot does not listen to itself.
        if frame.get(2) == Some(&own.number()) {
            continue;
        }
        let key = |_| if is_host { KEY.of_robot(own).host } else { KEY.of_robot(own).team };
        let believer = &mut team.at_robots[number];
        if believe(believer, &frame, team.id, key, own, outcome) {
            if is_host {
                if now > WARM_UP {
                    outcome.longest_silence =
                        outcome.longest_silence.max(now - believer.heard_host.max(WARM_UP));
                }
                believer.heard_host = now;
                believer.host_times.push(now);
                hear(&mut team.heard[0], number, now, &mut outcome.longest_gap[0]);
            }
            settle(&team.sent, &frame, now, outcome);
        }
    }
}

/// A frame was believed, or the run is over.
fn hear(heard: &mut [u64], robot: usize, now: u64, longest: &mut u64) {
    let since = std::mem::replace(&mut heard[robot], now.max(WARM_UP));
    *longest = (*longest).max(now.saturating_sub(since));
}

/// What a receiver's tag proves: in a frame to several, the tags of the others are not its own business.
fn covered(frame: &[u8]) -> &[u8] {
    let tags = if frame.get(2) == Some(&17) { 3 * usize::from(ROBOTS) } else { 8 };
    &frame[..frame.len().saturating_sub(tags)]
}

fn believe(
    believer: &mut Believer,
    bytes: &[u8],
    team: TeamId,
    key: impl Fn(RobotId) -> protocol::frame::Key,
    own: RobotId,
    outcome: &mut Outcome,
) -> bool {
    let handed = believer.handed.entry(bytes.to_vec()).or_default();
    *handed += 1;
    outcome.handed_twice += u64::from(*handed > 1);
    let Ok(frame) = Frame::parse(bytes, team) else {
        outcome.refused += 1;
        return false;
    };
    let sender = frame.sender.robot().unwrap_or(RobotId::ZERO);
    if believer.sessions.check(&frame).is_err() || !frame.is_genuine(bytes, &key(sender), own) {
        outcome.refused += 1;
        return false;
    }
    believer.sessions.accept(&frame);
    let times = believer.believed.entry(bytes.to_vec()).or_default();
    *times += 1;
    outcome.twice += u64::from(*times > 1);
    true
}

fn settle(sent: &HashMap<Vec<u8>, (Kind, u64)>, frame: &[u8], now: u64, outcome: &mut Outcome) {
    match sent.get(covered(frame)) {
        None => outcome.altered += 1,
        Some((_, u64::MAX)) => {}
        Some((kind, since)) => {
            outcome.tallies.entry(*kind).or_default().latency.push(now.saturating_sub(*since));
        }
    }
}

/// What one team asks of the air by arithmetic, ns in a second: its snapshots and commands at `hertz`, 20
/// beacons a robot up and on again, 10 welcomes and 10 reports of telemetry.
pub(crate) fn demand(rate: Rate, hertz: u64) -> u64 {
    use nrf24::airtime::{broadcast, exchange};
    let robots = u64::from(ROBOTS);
    let down = 2 * broadcast(rate, PART as u64) + robots * exchange(rate, COMMAND as u64 - 1, 0);
    let welcomes = 10 * robots * exchange(rate, WELCOME as u64 - 1, 0);
    let relayed = 20 * robots * broadcast(rate, BEACON as u64);
    // Their bytes in acknowledgements that are on the air anyway: version and team less, two headers more.
    let up = robots * (20 * BEACON as u64 + 10 * TELEMETRY as u64) * 8 * rate.bit_time();
    hertz * down + welcomes + relayed + up
}
