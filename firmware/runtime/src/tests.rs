//! Tests: tasks drive a brain exactly as a plain loop over the same brain does (docs/architecture.md §7.2).

use std::boxed::Box;
use std::cell::RefCell;
use std::format;
use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use brain::{BrainConfig, Station};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use geometry::{Angle, Point, Pose, Twist, Vector};
use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, BallSight, Health, OmniKick, SensorFrame};
use protocol::{Duration, Instant, RobotId, TeamId};

use crate::controller::Controller;
use crate::mailboxes::{Arrival, Mailboxes, OUTBOX_LEN};
use crate::ports::{BodyPort, RadioReceiver, RadioSender, Senses};
use crate::tasks;
use crate::testing::{World, clock};

#[test]
fn deadlines_run_at_their_own_times_before_the_packet_that_came_later() {
    let diary = Diary::default();
    let mut robot = Robot::new(Clerk::new(&diary, &[7_000, 3_000, 40_000, 40_001]));
    robot.tick(40_000, &[packet(&[9])], &sensor_frame(0.0));
    let expected =
        ["3000 timeout", "7000 timeout", "40000 timeout", "40000 packet 9", "40000 sensors", "40001 timeout"];
    robot.world.advance(50_000);
    assert_eq!(*diary.borrow(), expected);
}

#[test]
fn a_deadline_that_is_due_when_it_is_set_runs_as_soon_as_the_clock_moves() {
    let diary = Diary::default();
    let mut robot = Robot::new(Clerk::new(&diary, &[]));
    robot.tick(10, &[packet(&[1, 0]), packet(&[2])], &sensor_frame(0.0));
    assert_eq!(*diary.borrow(), ["10 packet 1", "10 packet 2", "10 sensors"]);
    robot.tick(20, &[packet(&[3])], &sensor_frame(0.0));
    assert_eq!(diary.borrow()[3..], ["10 timeout", "20 packet 3", "20 sensors"]);
}

#[test]
fn a_deadline_that_was_missed_runs_before_what_waits_in_the_inbox() {
    let diary = Diary::default();
    let boxes: &'static Mailboxes = Box::leak(Box::default());
    let mut world = World::new();
    let slow = Clerk { packet_takes: 4, ..Clerk::new(&diary, &[]) };
    world.spawn(tasks::think(Box::leak(Box::new(slow)), boxes));
    for bytes in [&[1, 5][..], &[2], &[3]] {
        boxes.inbox.try_send(Arrival::Packet(packet(bytes))).unwrap();
    }
    world.settle();
    assert_eq!(*diary.borrow(), ["0 packet 1", "4 packet 2", "5 timeout", "8 packet 3"]);
}

#[test]
fn the_tasks_drive_a_mind_as_a_plain_loop_does() {
    let (by_tasks, by_hand) = (Diary::default(), Diary::default());
    let mut robot = Robot::new(Clerk::new(&by_tasks, &[1]));
    let mut twin = Plain::new(Clerk::new(&by_hand, &[1]));
    let mut random = Random(7);
    let mut now = 0;
    for _ in 0..2_000 {
        now += u64::from(random.below(50));
        let packets: Vec<_> = (0..random.below(4))
            .map(|_| packet(&[random.below(200) as u8, random.below(60) as u8][..=random.below(2) as usize]))
            .collect();
        let sight = sensor_frame(now as f32);
        robot.tick(now, &packets, &sight);
        twin.tick(now, &packets, &sight);
    }
    assert!(by_hand.borrow().len() > 4_000, "the script says too little");
    assert_eq!(by_tasks.borrow().len(), by_hand.borrow().len());
    assert!(by_tasks.borrow().iter().eq(by_hand.borrow().iter()));
    assert!(*robot.sent.borrow() == twin.sent && *robot.done.borrow() == twin.done);
}

#[test]
fn a_station_says_and_does_the_same_through_the_tasks() {
    let config = |id| BrainConfig::new(RobotId::new(id).unwrap(), TeamId(1));
    let base = case_library::four_legged();
    let station = |id| Station::new(Instant(0), &config(id), base);
    // The robot under test, its twin driven by a plain loop, and a teammate whose packets both receive.
    let mut robot = Robot::new(station(1));
    let mut twin = Plain::new(station(1));
    let mut teammate = Plain::new(station(2));
    let mut random = Random(3);
    for tick in 1..=500_u64 {
        let now = tick * 40_000;
        let sight = sensor_frame(random.below(1_000) as f32 * 0.001);
        let reported = teammate.sent.len();
        teammate.tick(now, &[], &sight);
        let received: Vec<_> =
            teammate.sent[reported..].iter().filter(|_| random.below(5) > 0).cloned().collect();
        robot.tick(now, &received, &sight);
        twin.tick(now, &received, &sight);
        assert_eq!(robot.sent.borrow()[..], twin.sent[..], "tick {tick}");
        assert_eq!(robot.done.borrow()[..], twin.done[..], "tick {tick}");
    }
    assert!(
        twin.sent.len() >= 500 && twin.done.len() >= 490,
        "a robot that hardly speaks or moves proves nothing"
    );
}

#[test]
fn packets_beyond_the_outbox_are_dropped_and_counted() {
    let diary = Diary::default();
    let boxes: &'static Mailboxes = Box::leak(Box::default());
    let mut clerk = Clerk::new(&diary, &[]);
    // No sender task runs: the radio is stuck.
    for n in 0..OUTBOX_LEN as u8 + 3 {
        clerk.handle_packet(Instant(0), &[n]);
    }
    let mut world = World::new();
    world.spawn(tasks::think(Box::leak(Box::new(clerk)), boxes));
    boxes.inbox.try_send(Arrival::Sensors(sensor_frame(0.0))).unwrap();
    world.settle();
    assert_eq!(boxes.unsent(), 3);
    assert_eq!(boxes.outbox.try_receive().unwrap()[..], [0, 1], "what was said first is kept");
}

#[test]
fn a_body_that_is_late_does_the_latest_order_only() {
    let boxes: &'static Mailboxes = Box::leak(Box::default());
    let done: &'static RefCell<_> = Box::leak(Box::default());
    let mut world = World::new();
    world.spawn(tasks::body(Actuators(done), boxes));
    for speed in [1.0, 2.0, 3.0] {
        boxes.orders.signal(order(speed));
    }
    world.settle();
    assert_eq!(*done.borrow(), [order(3.0)]);
}

/// A robot as a board starts it: all five tasks around a brain.
struct Robot {
    world: World,
    air: &'static Mail<Packet>,
    sights: &'static Mail<SensorFrame>,
    sent: &'static RefCell<Vec<Packet>>,
    done: &'static RefCell<Vec<ActuatorFrame>>,
}

impl Robot {
    fn new(controller: impl Controller + 'static) -> Self {
        let boxes: &'static Mailboxes = Box::leak(Box::default());
        let mut robot = Self {
            world: World::new(),
            air: Box::leak(Box::new(Channel::new())),
            sights: Box::leak(Box::new(Channel::new())),
            sent: Box::leak(Box::default()),
            done: Box::leak(Box::default()),
        };
        robot.world.spawn(tasks::body(Actuators(robot.done), boxes));
        robot.world.spawn(tasks::sensors(Sensors(robot.sights), boxes));
        robot.world.spawn(tasks::radio_receive(MailReceiver(robot.air), boxes));
        robot.world.spawn(tasks::radio_send(PacketLog(robot.sent), boxes));
        robot.world.spawn(tasks::think(Box::leak(Box::new(controller)), boxes));
        robot.world.settle();
        robot
    }

    fn tick(&mut self, now: u64, packets: &[Packet], sight: &SensorFrame) {
        self.world.advance(now);
        for packet in packets {
            self.air.try_send(packet.clone()).unwrap();
            self.world.settle();
        }
        self.sights.try_send(sight.clone()).unwrap();
        self.world.settle();
    }
}

/// The same brain, driven by hand.
struct Plain<M> {
    controller: M,
    sent: Vec<Packet>,
    done: Vec<ActuatorFrame>,
}

impl<M: Controller> Plain<M> {
    fn new(controller: M) -> Self {
        Self { controller, sent: vec![], done: vec![] }
    }

    fn tick(&mut self, now: u64, packets: &[Packet], sight: &SensorFrame) {
        let now = Instant(now);
        self.deadlines(now);
        for packet in packets {
            self.controller.handle_packet(now, packet);
            self.drain(now);
        }
        self.controller.handle_sensors(now, sight);
        self.drain(now);
    }

    fn deadlines(&mut self, now: Instant) {
        while let Some(due) = self.controller.poll_timeout().filter(|due| *due <= now) {
            self.controller.handle_timeout(due);
            self.drain(due);
        }
    }

    fn drain(&mut self, now: Instant) {
        while let Some(packet) = self.controller.poll_packet(now) {
            self.sent.push(packet);
        }
        self.done.extend(self.controller.poll_actuators(now));
    }
}

/// Calls of a test brain, with their times.
type Diary = Rc<RefCell<Vec<String>>>;

/// A test brain that records its inputs, answers every packet, and sets a deadline where a packet wants one.
struct Clerk {
    diary: Diary,
    deadlines: Vec<u64>,
    /// Time by which the clock advances while it handles a packet.
    packet_takes: u64,
    answers: Vec<Packet>,
    order: Option<ActuatorFrame>,
}

impl Clerk {
    fn new(diary: &Diary, deadlines: &[u64]) -> Self {
        Self {
            diary: diary.clone(),
            deadlines: deadlines.to_vec(),
            packet_takes: 0,
            answers: vec![],
            order: None,
        }
    }
}

impl Controller for Clerk {
    fn handle_packet(&mut self, now: Instant, packet: &[u8]) {
        self.diary.borrow_mut().push(format!("{} packet {}", now.0, packet[0]));
        self.answers.push(self::packet(&[packet[0], 1]));
        self.deadlines.extend(packet.get(1).map(|after| now.0 + u64::from(*after)));
        clock().now += self.packet_takes;
    }

    fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        self.diary.borrow_mut().push(format!("{} sensors", now.0));
        self.order = Some(order(sensors.pose.map_or(0.0, |pose| pose.position.x())));
    }

    fn handle_timeout(&mut self, now: Instant) {
        self.diary.borrow_mut().push(format!("{} timeout", now.0));
        self.deadlines.retain(|due| *due > now.0);
        self.answers.push(packet(&[now.0 as u8, 2]));
    }

    fn poll_packet(&mut self, _now: Instant) -> Option<Packet> {
        (!self.answers.is_empty()).then(|| self.answers.remove(0))
    }

    fn poll_actuators(&mut self, _now: Instant) -> Option<ActuatorFrame> {
        self.order.take()
    }

    fn poll_timeout(&self) -> Option<Instant> {
        self.deadlines.iter().min().copied().map(Instant)
    }
}

type Mail<T> = Channel<CriticalSectionRawMutex, T, 1>;
struct MailReceiver(&'static Mail<Packet>);
struct Sensors(&'static Mail<SensorFrame>);
struct PacketLog(&'static RefCell<Vec<Packet>>);
struct Actuators(&'static RefCell<Vec<ActuatorFrame>>);

impl RadioReceiver for MailReceiver {
    async fn receive(&mut self) -> Packet {
        self.0.receive().await
    }
}
impl Senses for Sensors {
    async fn sense(&mut self) -> SensorFrame {
        self.0.receive().await
    }
}
impl RadioSender for PacketLog {
    async fn send(&mut self, packet: Packet) {
        self.0.borrow_mut().push(packet);
    }
}
impl BodyPort for Actuators {
    async fn act(&mut self, orders: ActuatorFrame) {
        self.0.borrow_mut().push(orders);
    }
}

fn packet(bytes: &[u8]) -> Packet {
    Packet::from_slice(bytes).unwrap()
}

fn order(speed: f32) -> ActuatorFrame {
    ActuatorFrame::Omni { wheels: [speed; 4], dribbler: 0.0, kick: OmniKick::None }
}

/// A robot and the ball somewhere left of the centre, moved by `x`.
fn sensor_frame(x: f32) -> SensorFrame {
    let ball = BallSight { position: Point::new(x - 1.0, 0.2), sigma: 0.01, age: Duration(0) };
    SensorFrame {
        pose: Some(Pose { position: Point::new(x, 0.1), heading: Angle::new(0.3) }),
        ball: Some(ball),
        opponents: heapless::Vec::new(),
        ball_contact: false,
        busy: false,
        odometry: Twist { linear: Vector::new(0.0, 0.0), angular: 0.0 },
        health: Health::default(),
        camera: None,
    }
}

/// A small random generator of integers, for scripts.
struct Random(u64);
impl Random {
    fn below(&mut self, n: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as u32 % n
    }
}

#[test]
fn a_reporting_station_tells_its_host_once_a_second_what_it_runs() {
    use protocol::frame::TeamKey;
    use protocol::host::HostMessage;
    use protocol::host_link::{HostLink, Opened};
    use protocol::parts::PartsReport;
    use protocol::version::VersionReport;

    let (id, team) = (RobotId::new(3).unwrap(), TeamId(1));
    let config = BrainConfig::hosted(id, team, rules::League::DivisionB);
    let mut station = Station::new(Instant(0), &config, case_library::division_b());
    let report = VersionReport { image: 7, case_base: 8, ..crate::reporting::IMAGE };
    let (boxes, parts) = (Mailboxes::new(), (PartsReport::new(), Instant(0)));
    let mut robot =
        crate::reporting::Reporting { station: &mut station, report, last: Instant(0), boxes: &boxes, parts };
    let mut host = HostLink::new(team, TeamKey::ZERO, 70);
    let mut reported = Vec::new();
    for step in 1..=350_u64 {
        let now = Instant(step * 10_000);
        Controller::handle_sensors(&mut robot, now, &sensor_frame(0.1));
        while let Some(packet) = robot.poll_packet(now) {
            if let Ok(Opened::Version(from, report)) = host.open(now, &packet) {
                reported.push((from, report, step / 100));
            }
        }
        if let Some(welcome) = host.welcome(id) {
            robot.handle_packet(now, &host.seal(now, &HostMessage::Welcome(welcome)));
        }
    }
    assert_eq!(reported, [1, 2, 3].map(|second| (id, report, second)), "nothing before it was welcomed");
    assert_eq!(report.version, protocol::version::parts_of(env!("CARGO_PKG_VERSION")));
    assert_ne!(report.robot, 0);
}
