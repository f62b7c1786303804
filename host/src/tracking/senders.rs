//! `senders`: one sender for each camera. Two programs that send vision of the same cameras (a simulator that
//! was forgotten, another team's, two SSL-Vision) must not be mixed: robots would jump between two fields.
//! Sans-IO; times on the host's clock.
//!
//! Senders are ranked by age. A sender that sends a camera that a higher one sends is refused with all its
//! cameras; one that sends the same datagrams is the same vision by another network, and is followed too. The
//! ranks change where evidence says so: the followed sender has fallen silent, or our robots, as the radio
//! and their orders show them, are on the other one's field.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::net::SocketAddr;

use geometry::{Field, Point};
use protocol::{Duration, Instant, RobotId};
use rules::Colour;
use ssl::Message as _;
use ssl::vision::{FrameHead, WrapperPacket};

use super::seen::CAMERAS_MAX;
use crate::world::World;

/// Senders that are kept; more at once are refused.
const SENDERS_MAX: usize = 8;
/// A sender that has been silent for this time is replaced by one that shows the same field, ...
const SILENT_AFTER: Duration = Duration::millis(500);
/// ... and after this time by any other.
const GONE_AFTER: Duration = Duration::millis(2_000);
/// A sender shows the same field where robots are this near to where they were, m: half a second of driving.
const SAME_FIELD_WITHIN_M: f32 = 0.8;
/// Datagrams remembered of a camera, to know copies: 0.1 s.
const DATAGRAMS_KEPT: usize = 8;
/// A sender whose datagrams are another's is a copy for this time.
const COPY_LASTS: Duration = Duration::millis(1_000);
/// Robots' motion is compared over this time.
const COMPARED_OVER: Duration = Duration::millis(1_000);
/// In that time a robot that is ordered elsewhere moves farther than the first, m; one that stands stays
/// within the second.
const MOVES_FROM_M: f32 = 0.2;
const STANDS_WITHIN_M: f32 = 0.05;
/// A sender that shows this number more of the robots that are received is the right one.
const SHOWS_MORE: usize = 2;

/// What becomes of a datagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Admission {
    /// It is used.
    Used,
    /// It is another sender's: not used.
    Refused,
}

/// Two senders of the same camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SecondVision {
    /// The camera that both send.
    pub camera: u32,
    /// The sender that is followed.
    pub followed: SocketAddr,
    /// The sender that is refused.
    pub other: SocketAddr,
}

#[derive(Clone, Debug)]
struct CameraSent {
    newest: Instant,
    datagrams: heapless::Deque<u64, DATAGRAMS_KEPT>,
}

#[derive(Clone, Debug)]
struct Sender {
    address: SocketAddr,
    cameras: [Option<CameraSent>; CAMERAS_MAX],
    newest: Instant,
    /// When a datagram of it was another sender's too.
    copied: Option<Instant>,
    /// Whether it shows the robots where they were.
    fits: bool,
    /// Our robots: place at the start of the comparison, and now.
    robots: [Option<[Point<Field>; 2]>; RobotId::COUNT],
}

impl Sender {
    fn new(address: SocketAddr, now: Instant) -> Self {
        Self {
            address,
            cameras: Default::default(),
            newest: now,
            copied: None,
            fits: true,
            robots: [None; RobotId::COUNT],
        }
    }

    fn sends(&self, camera: usize, since: Instant) -> bool {
        self.cameras[camera].as_ref().is_some_and(|sent| sent.newest >= since)
    }

    fn is_copy(&self, now: Instant) -> bool {
        self.copied.is_some_and(|at| now.since(at) < COPY_LASTS)
    }

    /// Number of `robots` whose way fulfils `holds`, m.
    fn count(&self, robots: &OurRobots, holds: impl Fn(f32) -> bool) -> usize {
        let ways = self.robots.iter().zip(robots).filter(|(_, counts)| **counts);
        ways.filter(|(places, _)| places.is_some_and(|[from, to]| holds(from.distance(to)))).count()
    }

    /// Where it shows our robots, and whether they are where they were.
    fn look(&mut self, packet: &[u8], us: Colour, world: &World) {
        let Some(frame) = WrapperPacket::decode(packet).ok().and_then(|packet| packet.detection) else {
            return;
        };
        let ours = if us == Colour::Yellow { &frame.robots_yellow } else { &frame.robots_blue };
        let (mut near, mut far) = (0, 0);
        for seen in ours {
            let id = seen.robot_id.and_then(|id| RobotId::new(u8::try_from(id).ok()?));
            let Some(id) = id else { continue };
            let place = Point::new(seen.x * 0.001, seen.y * 0.001);
            let places = self.robots[id.index()].get_or_insert([place; 2]);
            places[1] = place;
            if let Some(known) = world.ours(us).find(|robot| robot.who.id == id) {
                let same = known.pose.position.distance(place) <= SAME_FIELD_WITHIN_M;
                *if same { &mut near } else { &mut far } += 1;
            }
        }
        if near + far > 0 {
            self.fits = near >= far;
        }
    }
}

/// Robots of ours, by number.
pub type OurRobots = [bool; RobotId::COUNT];

/// The robots that ought to be on the right vision.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExpectedRobots {
    /// Robots of ours that are received by radio.
    pub heard: OurRobots,
    /// Those of them that are ordered to another place.
    pub ordered: OurRobots,
}

/// All senders of vision, the followed ones first.
#[derive(Clone, Debug)]
pub struct VisionSenders {
    us: Colour,
    senders: Vec<Sender>,
    /// Start of the comparison, and the robots that were to move all the time.
    compared: Instant,
    ordered: Option<OurRobots>,
    second: Option<(SecondVision, Instant)>,
}

impl VisionSenders {
    /// No sender yet; `us`: our colour.
    pub fn new(us: Colour) -> Self {
        Self { us, senders: Vec::new(), compared: Instant(0), ordered: None, second: None }
    }

    /// Judges a datagram of vision's port; `world`: the field as it is known.
    pub fn receive(&mut self, now: Instant, from: SocketAddr, packet: &[u8], world: &World) -> Admission {
        self.senders.retain(|sender| now.since(sender.newest) < GONE_AFTER);
        let own = self.senders.iter().position(|sender| sender.address == from);
        let Some(head) = FrameHead::of(packet).filter(|head| (head.camera_id as usize) < CAMERAS_MAX) else {
            // Geometry of a program that sends no frames counts.
            return own.map_or(Admission::Used, |own| self.verdict(now, own));
        };
        let own = match own {
            Some(own) => own,
            None if self.senders.len() == SENDERS_MAX => return Admission::Refused,
            None => {
                self.senders.push(Sender::new(from, now));
                self.senders.len() - 1
            }
        };
        let camera = head.camera_id as usize;
        let mut hasher = DefaultHasher::new();
        packet.hash(&mut hasher);
        self.note(now, own, camera, hasher.finish());
        if self.senders.len() > 1 {
            self.senders[own].look(packet, self.us, world);
        }
        let own = self.promote(now, own, camera);
        self.verdict(now, own)
    }

    fn note(&mut self, now: Instant, own: usize, camera: usize, datagram: u64) {
        let mut copied = false;
        for (index, sender) in self.senders.iter_mut().enumerate() {
            let sent = sender.cameras[camera].as_ref();
            if index != own && sent.is_some_and(|sent| sent.datagrams.iter().any(|d| *d == datagram)) {
                (sender.copied, copied) = (Some(now), true);
            }
        }
        let sender = &mut self.senders[own];
        sender.newest = now;
        if copied {
            sender.copied = Some(now);
        }
        let sent = sender.cameras[camera]
            .get_or_insert_with(|| CameraSent { newest: now, datagrams: heapless::Deque::new() });
        sent.newest = now;
        if sent.datagrams.is_full() {
            sent.datagrams.pop_front();
        }
        // There is room, so this cannot fail.
        let _ = sent.datagrams.push_back(datagram);
    }

    /// Ranks a sender before one that has fallen silent; returns its new rank.
    fn promote(&mut self, now: Instant, own: usize, camera: usize) -> usize {
        let silent = if self.senders[own].fits { SILENT_AFTER } else { GONE_AFTER };
        let above = &self.senders[..own];
        let replaced = above
            .iter()
            .position(|other| other.cameras[camera].is_some() && now.since(other.newest) >= silent);
        let Some(rank) = replaced else { return own };
        self.senders[rank..=own].rotate_right(1);
        rank
    }

    fn verdict(&mut self, now: Instant, own: usize) -> Admission {
        let since = Instant(now.0.saturating_sub(GONE_AFTER.0));
        let mut refused = vec![false; self.senders.len()];
        for index in 0..=own {
            let sender = &self.senders[index];
            for rank in 0..index {
                let other = &self.senders[rank];
                let both = (0..CAMERAS_MAX)
                    .find(|camera| sender.sends(*camera, since) && other.sends(*camera, since));
                let Some(camera) =
                    both.filter(|_| !(refused[rank] || sender.is_copy(now) && other.is_copy(now)))
                else {
                    continue;
                };
                refused[index] = true;
                if index == own {
                    let (followed, other) = (other.address, sender.address);
                    self.second = Some((SecondVision { camera: camera as u32, followed, other }, now));
                }
                break;
            }
        }
        if refused[own] { Admission::Refused } else { Admission::Used }
    }

    /// Compares the senders with what radio and orders say; called at least every 0.2 s.
    pub fn look(&mut self, now: Instant, expected: ExpectedRobots) {
        let Some((second, _)) = self.second.filter(|(_, at)| now.since(*at) < SILENT_AFTER) else {
            self.restart_comparison(now);
            return;
        };
        let mut ordered = self.ordered.unwrap_or(expected.ordered);
        ordered.iter_mut().zip(expected.ordered).for_each(|(all, now)| *all &= now);
        self.ordered = Some(ordered);
        if now.since(self.compared) < COMPARED_OVER {
            return;
        }
        let ranks = [second.followed, second.other]
            .map(|address| self.senders.iter().position(|sender| sender.address == address));
        if let [Some(first), Some(other)] = ranks {
            let [followed, challenger] = [first, other].map(|rank| &self.senders[rank]);
            let [still, moved] =
                [followed, challenger].map(|sender| sender.count(&ordered, |way| way >= MOVES_FROM_M));
            let stands = followed.count(&ordered, |way| way <= STANDS_WITHIN_M) > 0;
            let [shown, more] = [followed, challenger].map(|sender| sender.count(&expected.heard, |_| true));
            if (stands && still == 0 && moved > 0) || more >= shown + SHOWS_MORE {
                self.senders[first..=other].rotate_right(1);
            }
        }
        self.restart_comparison(now);
    }

    fn restart_comparison(&mut self, now: Instant) {
        (self.compared, self.ordered) = (now, None);
        for sender in &mut self.senders {
            sender.robots = [None; RobotId::COUNT];
        }
    }

    /// The second vision that is sent now, if there is one.
    pub fn second(&self, now: Instant) -> Option<SecondVision> {
        self.second.filter(|(_, at)| now.since(*at) < SILENT_AFTER).map(|(second, _)| second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ssl::vision::{DetectionFrame, DetectionRobot};

    fn address(port: u16) -> SocketAddr {
        ([127, 0, 0, 1], port).into()
    }

    fn frame(number: u32, camera_id: u32, robots: &[(u32, f32)]) -> Vec<u8> {
        let robots_blue = robots.iter().map(|(id, x)| DetectionRobot {
            robot_id: Some(*id),
            x: x * 1000.0,
            ..DetectionRobot::default()
        });
        let detection = DetectionFrame {
            frame_number: number,
            t_capture: f64::from(number) / 60.0,
            camera_id,
            robots_blue: robots_blue.collect(),
            ..DetectionFrame::default()
        };
        WrapperPacket { detection: Some(detection), ..WrapperPacket::default() }.encode_to_vec()
    }

    struct Bench {
        senders: VisionSenders,
        world: World,
    }

    impl Bench {
        fn new() -> Self {
            Self { senders: VisionSenders::new(Colour::Blue), world: World::default() }
        }

        fn send(&mut self, number: u32, port: u16, camera: u32, robots: &[(u32, f32)]) -> bool {
            let now = Instant(u64::from(number) * 16_667);
            let packet = frame(number, camera, robots);
            self.senders.receive(now, address(port), &packet, &self.world) == Admission::Used
        }

        fn look(&mut self, number: u32, ordered: &[u8]) {
            let mut set = OurRobots::default();
            for id in ordered {
                set[usize::from(*id)] = true;
            }
            let now = Instant(u64::from(number) * 16_667);
            self.senders.look(now, ExpectedRobots { heard: set, ordered: set });
        }
    }

    #[test]
    fn a_second_sender_of_a_camera_is_refused_whole_and_told_with_its_address() {
        let mut bench = Bench::new();
        for n in 0..60 {
            assert!(bench.send(n, 1, 0, &[(0, 0.0)]) && bench.send(n, 1, 1, &[]));
            assert!(!bench.send(n, 2, 1, &[(0, 2.0)]));
            // Camera 3 is sent by none but the second vision.
            assert!(!bench.send(n, 2, 3, &[]));
        }
        let second = bench.senders.second(Instant(1_000_000)).unwrap();
        assert_eq!((second.camera, second.followed, second.other), (1, address(1), address(2)));
    }

    #[test]
    fn cameras_of_several_computers_are_one_vision() {
        let mut bench = Bench::new();
        for n in 0..300 {
            for camera in 0..4 {
                assert!(bench.send(n, 10 + camera as u16, camera, &[(camera, 0.0)]));
            }
        }
        assert_eq!(bench.senders.second(Instant(5_000_000)), None);
    }

    #[test]
    fn one_vision_on_two_networks_is_one_vision() {
        let mut bench = Bench::new();
        for n in 0..120 {
            for port in [1, 2] {
                let used = bench.send(n, port, 0, &[(0, 0.0)]);
                assert!(used, "{n} by {port}");
            }
        }
        assert_eq!(bench.senders.second(Instant(2_000_000)), None);
    }

    #[test]
    fn a_vision_that_starts_again_is_followed_after_half_a_second() {
        let mut bench = Bench::new();
        (0..60).for_each(|n| assert!(bench.send(n, 1, 0, &[(0, 0.0)])));
        let followed = (60..200).find(|n| bench.send(*n, 2, 0, &[(0, 0.1)])).unwrap();
        assert!((85..95).contains(&followed), "{followed}");
    }

    #[test]
    fn the_field_on_which_our_robots_do_as_ordered_is_followed() {
        let mut bench = Bench::new();
        let mut changed = None;
        for n in 0..300 {
            bench.send(n, 1, 0, &[(0, 0.0), (1, 1.0)]);
            let used = bench.send(n, 2, 0, &[(0, 0.5 + n as f32 * 0.01), (1, 1.0)]);
            changed = changed.or(used.then_some(n));
            if n % 6 == 0 {
                bench.look(n, &[0]);
            }
        }
        assert!(changed.is_some_and(|n| n < 150), "{changed:?}");
        // Robots that stand because they are to stand are no evidence.
        let mut bench = Bench::new();
        for n in 0..300 {
            bench.send(n, 1, 0, &[(0, 0.0)]);
            assert!(!bench.send(n, 2, 0, &[(0, 0.5 + n as f32 * 0.01)]), "{n}");
            if n % 6 == 0 {
                bench.look(n, &[]);
            }
        }
    }
}
