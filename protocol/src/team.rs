//! `team`: messages between robots: their whole state, repeatedly (docs/architecture.md §5.1; paper §4.1).
//!
//! Teammates need one message, the [`Beacon`]: pose, ball, availability, the running cycle as this robot
//! knows it, and the robot's own progress. Nothing is sent once: a lost packet only delays. What a robot
//! knows of the cycle is a value that only grows ([`CycleState::is_newer_than`]), so that packets may be
//! lost, doubled and reordered, and any robot may pass on the coordinator's announcements. [`Telemetry`] and
//! [`DecisionPart`] are for the host; teammates ignore them. A [`Handshake`] is how teammates come to trust
//! each other after a boot ([`crate::peer`]).

use geometry::{Field, Vector, math};
use serde::{Deserialize, Serialize};

use crate::decision::DecisionPart;
use crate::host::Telemetry;
pub use crate::ids::CASE_ROBOTS_MAX;
use crate::quantized::{WirePoint, WirePose};
use crate::{CaseId, CycleId, Duration, RobotId, parts, version};

/// A robot is present for this long after its last beacon (docs/architecture.md §5.1): eight beacons of 20
/// Hz, so that a lost one is no absence. Robots and host hold to it.
pub const PRESENCE_LEASE: Duration = Duration::millis(400);

/// The longest [`TeamMessage`] in postcard bytes; with the frame's overhead it stays within 64 B
/// (docs/architecture.md §6.1).
pub const TEAM_MESSAGE_LEN_MAX: usize = 64 - crate::frame::OVERHEAD;

/// First byte of a robot's payload that is no [`TeamMessage`]: a report of its first start (`bring_up`).
pub const BRING_UP: u8 = 5;
/// Likewise: of its kicker, or a host's order to it (`pulses`).
pub const PULSES: u8 = 9;
/// Likewise: a piece of its log (`robot_log`).
pub const LOG: u8 = 10;

/// A message of a robot. Odd numbers are for the host; 5 and 7 to 10 are no variants: they are [`BRING_UP`],
/// [`version::KIND`], [`parts::KIND`], [`PULSES`] and [`LOG`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TeamMessage {
    /// Whole state of the sender, to all.
    Beacon(Beacon),
    /// State of the sender's body and link, to the host.
    Telemetry(Telemetry),
    /// Handshake to teammates that do not know yet that the sender is live.
    Handshake(Handshake),
    /// Part of the problem that the sender decided on, to the host.
    Decision(DecisionPart),
}

impl TeamMessage {
    /// Returns whether a payload is meant for the host alone, by its first byte: the variant's number, or
    /// [`BRING_UP`], [`version::KIND`], [`parts::KIND`], [`PULSES`] or [`LOG`]: one comparison.
    pub(crate) const fn is_for_host(payload: &[u8]) -> bool {
        matches!(*payload, [1 | 3 | BRING_UP | version::KIND | parts::KIND | PULSES | LOG, ..])
    }
}

/// Handshake: teammates' boot epochs that the sender has received. A robot that finds its present epoch named
/// knows that this is no recording.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Handshake {
    /// Teammates and their boot epochs.
    pub teammates: heapless::Vec<KnownEpoch, KNOWN_EPOCHS_MAX>,
}

/// Teammates in one handshake: as many as its frame holds.
pub const KNOWN_EPOCHS_MAX: usize = 7;

/// A teammate named in a handshake.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KnownEpoch {
    /// Number of the teammate.
    pub who: RobotId,
    /// The epoch of its frames.
    #[serde(with = "postcard::fixint::le")]
    pub boot_epoch: u32,
    /// State of the handshake between the two.
    pub bond: Bond,
}

/// State of the handshake between two teammates, as one of them knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Bond {
    /// The sender has received the other, and does not trust it yet.
    Received,
    /// The sender trusts the other.
    Believed,
    /// Known, and known to be trusted: no answer is needed.
    Mutual,
}

/// A robot's whole state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Beacon {
    /// Pose of the robot.
    pub pose: WirePose,
    /// Position of the ball, if it is detected.
    pub ball: Option<BallReport>,
    /// Abilities of the robot.
    pub status: Status,
    /// Hash of the table of its case base; robots with another base execute only what they can verify.
    #[serde(with = "postcard::fixint::le")]
    pub case_base: u32,
    /// The newest cycle it knows.
    pub cycle: Option<CycleState>,
    /// Progress of the sender in that cycle.
    pub progress: Progress,
    /// Role of the sender while it plays no case.
    pub role: Role,
}

/// Ball as detected by the sender.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BallReport {
    /// Position of the ball.
    pub at: WirePoint,
    /// Distance from the sender's centre, mm: compared by the elector.
    #[serde(with = "postcard::fixint::le")]
    pub distance: u16,
    /// Certainty of the position, and motion of the ball.
    pub quality: BallQuality,
}

/// Uncertainty, age and velocity of a reported ball, a byte each: standard deviation of a coordinate in cm,
/// age of the detection in 20 ms, velocity along x and y in 5 cm/s, signed. All saturate. All zero: exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct BallQuality(#[serde(with = "postcard::fixint::le")] u32);

impl BallQuality {
    /// Quantises a standard deviation in m, an age, and a velocity in m/s.
    pub fn new(sigma: f32, age: Duration, velocity: Vector<Field>) -> Self {
        let sigma = math::round_to_i32(sigma * 100.0).clamp(0, 255) as u8;
        let age = (age.0 / BALL_AGE_STEP.0).min(255) as u8;
        let speed = |v: f32| math::round_to_i32(v * (1.0 / BALL_SPEED_STEP)).clamp(-127, 127) as i8 as u8;
        Self(u32::from_le_bytes([sigma, age, speed(velocity.x()), speed(velocity.y())]))
    }

    /// Standard deviation of a coordinate, cm.
    pub const fn sigma_cm(self) -> u8 {
        self.0 as u8
    }

    /// Standard deviation of a coordinate, m.
    pub fn sigma(self) -> f32 {
        f32::from(self.sigma_cm()) * 0.01
    }

    /// Age of the detection when it was sent.
    pub const fn age(self) -> Duration {
        Duration((self.0 >> 8 & 0xff) as u64 * BALL_AGE_STEP.0)
    }

    /// Velocity of the ball, m/s.
    pub fn velocity(self) -> Vector<Field> {
        let [_, _, x, y] = self.0.to_le_bytes().map(|byte| f32::from(byte as i8) * BALL_SPEED_STEP);
        Vector::new(x, y)
    }
}

/// Resolution of a reported ball's age.
const BALL_AGE_STEP: Duration = Duration::millis(20);
/// Resolution of a reported ball's velocity, m/s.
const BALL_SPEED_STEP: f32 = 0.05;

/// Abilities of a robot, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Status(pub u8);

impl Status {
    /// Present for election and retrieval: started up, on the field, under `Gameplay`.
    pub const AVAILABLE: Self = Self(1);
    /// Able to retrieve cases (paper §4.1: one of the k).
    pub const RETRIEVER: Self = Self(2);
    /// The robot holds the ball: no other robot shall take it.
    pub const HOLDS_BALL: Self = Self(4);

    /// Union of both sets.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Every bit of `other` is set.
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Adds the rule that chose the last shot of the sender's case (bits 3 to 5).
    #[must_use]
    pub const fn with_shot(self, rule: ShotRule) -> Self {
        Self(self.0 & !(7 << SHOT_SHIFT) | (rule as u8) << SHOT_SHIFT)
    }

    /// The rule that chose the last shot of the sender's case; `None` of a number without a meaning.
    pub fn shot(self) -> Option<ShotRule> {
        ShotRule::ALL.get(usize::from(self.0 >> SHOT_SHIFT & 7)).copied()
    }
}

/// First bit of the rule of a shot in a [`Status`].
const SHOT_SHIFT: u8 = 3;

geometry::labels! {
    /// Rule by which the holder of a case's ball shoots at goal or does not; its place is the number on the
    /// air.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum ShotRule {
        /// No shot was due yet.
        #[default]
        NoShot = "no-shot",
        /// The leg that retrieval checked is kicked.
        Leg = "leg",
        /// Another shot is likelier a goal than the leg.
        Likelier = "likelier-shot",
        /// The ball is carried to, or kept at, where a gap will open: worth more than a shot now.
        Gap = "waited-for-gap",
        /// The ball is pushed on towards the goal: worth more than a shot from afar.
        PushOn = "pushed-on",
        /// The time for the shot was up.
        OutOfTime = "out-of-time",
        /// An opponent comes for the ball before the case's action is done: shot instead of it.
        Pressed = "pressed",
    }
}

/// A retrieve–reuse cycle as one robot knows it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct CycleState {
    /// Id of the cycle.
    pub id: CycleId,
    /// The retriever nearest the ball, named by the proposer.
    pub coordinator: RobotId,
    /// State of the cycle. The order of variants is the order of knowledge: later ones replace earlier ones.
    pub decision: Decision,
}

impl CycleState {
    /// Returns whether this is more than `known`: a later cycle, or more of the same one. A total order, so
    /// that robots that receive the same messages in any order end up knowing the same.
    pub fn is_newer_than(&self, known: Option<&Self>) -> bool {
        known.is_none_or(|known| self > known)
    }

    /// The running gameplay, if there is one.
    pub fn play(&self) -> Option<&Play> {
        match &self.decision {
            Decision::Play(play) => Some(play),
            _ => None,
        }
    }
}

/// Decision of the coordinator in its cycle.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Decision {
    /// The coordinator has not announced its decision yet.
    Undecided,
    /// No case fits: default behaviour.
    NoCase,
    /// This case, by these robots.
    Play(Play),
    /// The cycle is over.
    Closed(Closure),
}

/// A retrieved case and the robots that play it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Play {
    /// Id of the stored case.
    #[serde(with = "case_id")]
    pub case: CaseId,
    /// The ball the coordinator used: adapted positions are relative to it.
    pub ball: WirePoint,
    /// Case robot i is played by entry i (paper §3.2: the correspondence).
    pub robots: heapless::Vec<RobotId, CASE_ROBOTS_MAX>,
}

impl Play {
    /// The part `robot` plays, if it is involved.
    pub fn part_of(&self, robot: RobotId) -> Option<usize> {
        self.robots.iter().position(|&r| r == robot)
    }
}

/// End of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Closure {
    /// Every robot involved reported the end of its actions.
    Finished,
    /// No case was found, and the waiting time before the next try is over.
    NoCase,
    /// A robot involved stopped it.
    Aborted {
        /// Robot that stopped it.
        by: RobotId,
        /// Reason of the abort.
        reason: AbortReason,
    },
}

geometry::labels! {
    /// Reason why a cycle was stopped (paper §4.2; docs/architecture.md §5.3).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    pub enum AbortReason {
        /// Before the first touch: the ball left the case's scope.
        BallOutOfScope = "ball-out-of-scope",
        /// Before the first touch: an opponent stands in the ball's path.
        PathBlocked = "path-blocked",
        /// A robot involved, or the coordinator, is gone, has restarted, or has lost its host.
        RobotLost = "robot-lost",
        /// The holder lost the ball, or an action failed.
        ActionFailed = "action-failed",
        /// After the first touch: an opponent is on the ball.
        OpponentOnBall = "opponent-on-ball",
        /// After the first touch: the ball stopped where no robot of the case expects it.
        BallAtRest = "ball-at-rest",
        /// The cycle took longer than 1.5 × the expected duration + 2 s.
        Timeout = "timeout",
        /// The coordinator stayed silent about its decision.
        NoDecision = "no-decision",
        /// A robot carries another case base and cannot verify the case.
        UnknownCase = "unknown-case",
        /// The host gave the robot that stopped it another order.
        Reassigned = "reassigned",
        /// The referee stopped the game.
        GameStopped = "game-stopped",
    }
}

/// Progress of a robot in its cycle (paper §4.2, Fig. 10).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Progress {
    /// No case is being played.
    #[default]
    Idle,
    /// Walking to its adapted position.
    Adapt {
        /// True once the robot has arrived.
        arrived: bool,
    },
    /// At its actions, one after another.
    Execute {
        /// Number of actions done. A pass is done ("PassDone") when this has passed its place in the list.
        done: u8,
    },
    /// Waiting for the end of the cycle.
    WaitEnd {
        /// True once an involved robot has finished its actions.
        finished: bool,
    },
}

/// Role of a robot while it plays no case (paper §5: possessor and backers-up).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Role {
    /// Plays a case, or stands still.
    #[default]
    None,
    /// Gets the ball, and attacks with it.
    Attacker,
    /// Backs the attacker up.
    Supporter,
}

mod case_id {
    //! A case id as two fixed bytes.
    use serde::{Deserializer, Serializer};

    use crate::CaseId;

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
    pub(super) fn serialize<S: Serializer>(id: &CaseId, s: S) -> Result<S::Ok, S::Error> {
        postcard::fixint::le::serialize(&id.0, s)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<CaseId, D::Error> {
        postcard::fixint::le::deserialize(d).map(CaseId)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    #[test]
    fn a_status_carries_the_rule_of_a_shot_beside_its_bits() {
        let bits = Status::AVAILABLE.with(Status::HOLDS_BALL);
        for number in 0..7 {
            let carried = Status(bits.0 | number << 3);
            let rule = carried.shot().unwrap();
            assert_eq!((rule as u8, bits.with_shot(ShotRule::Pressed).with_shot(rule)), (number, carried));
            assert!(carried.has(bits) && !carried.has(Status::RETRIEVER));
        }
        assert_eq!(Status(7 << 3).shot(), None);
    }

    /// The longest beacon there can be.
    pub(crate) fn longest() -> TeamMessage {
        TeamMessage::Beacon(Beacon {
            pose: WirePose { at: WirePoint { x: -32768, y: 32767 }, heading: -3142 },
            ball: Some(BallReport {
                at: WirePoint { x: -32768, y: 32767 },
                distance: 65535,
                quality: BallQuality(u32::MAX),
            }),
            status: Status(0xff),
            case_base: 0xffff_ffff,
            cycle: Some(CycleState {
                id: CycleId { counter: u32::MAX, proposer: robot(15) },
                coordinator: robot(15),
                decision: Decision::Play(Play {
                    case: CaseId(65535),
                    ball: WirePoint { x: -32768, y: 32767 },
                    robots: [12, 13, 14, 15].map(robot).into_iter().collect(),
                }),
            }),
            progress: Progress::Execute { done: 255 },
            role: Role::Supporter,
        })
    }

    #[test]
    fn a_balls_quality_survives_the_wire_and_saturates() {
        let quality = BallQuality::new(0.12, Duration::millis(140), Vector::new(-0.75, 1.2));
        assert_eq!((quality.sigma_cm(), quality.age()), (12, Duration::millis(140)));
        assert!((quality.velocity() - Vector::new(-0.75, 1.2)).norm() < 1e-5);
        let most = BallQuality::new(9.0, Duration::millis(60_000), Vector::new(-99.0, f32::NAN));
        assert_eq!((most.sigma_cm(), most.age()), (255, Duration::millis(5_100)));
        assert!((most.velocity() - Vector::new(-6.35, 0.0)).norm() < 1e-5);
        assert_eq!(BallQuality::new(0.0, Duration(0), Vector::default()), BallQuality::default());
    }

    #[test]
    fn the_longest_beacon_fits_its_budget() {
        let mut out = [0; 128];
        let n = postcard::to_slice(&longest(), &mut out).unwrap().len();
        assert!(n <= TEAM_MESSAGE_LEN_MAX, "{n} bytes");
        assert_eq!(postcard::from_bytes::<TeamMessage>(&out[..n]), Ok(longest()));
    }

    #[test]
    fn the_longest_telemetry_fits_its_budget() {
        let telemetry = Telemetry {
            condition: crate::host::Condition(u16::MAX),
            battery: u16::MAX,
            received: u16::MAX,
            lost: u16::MAX,
            refused: [u16::MAX; crate::frame::Refusal::KINDS],
            snapshot: u8::MAX,
            silence: u16::MAX,
            host: u32::MAX,
            clock: u32::MAX,
        };
        let mut out = [0; 128];
        let n = postcard::to_slice(&TeamMessage::Telemetry(telemetry), &mut out).unwrap().len();
        assert!(n <= TEAM_MESSAGE_LEN_MAX, "{n} bytes");
    }

    #[test]
    fn the_longest_handshake_fits_its_budget() {
        let teammate = KnownEpoch { who: robot(15), boot_epoch: u32::MAX, bond: Bond::Mutual };
        let teammates = [teammate; KNOWN_EPOCHS_MAX].into_iter().collect();
        let mut out = [0; 128];
        let n = postcard::to_slice(&TeamMessage::Handshake(Handshake { teammates }), &mut out).unwrap().len();
        assert!(n <= TEAM_MESSAGE_LEN_MAX, "{n} bytes");
    }

    #[test]
    fn knowledge_of_a_cycle_only_grows() {
        let id = |counter| CycleId { counter, proposer: robot(1) };
        let state = |counter, decision| CycleState { id: id(counter), coordinator: robot(2), decision };
        let play = Decision::Play(Play {
            case: CaseId(3),
            ball: WirePoint::default(),
            robots: heapless::Vec::new(),
        });
        let ladder = [
            state(4, Decision::Closed(Closure::Finished)),
            state(5, Decision::Undecided),
            state(5, Decision::NoCase),
            state(5, play),
            state(5, Decision::Closed(Closure::Finished)),
            state(6, Decision::Undecided),
        ];
        for pair in ladder.windows(2) {
            assert!(pair[1].is_newer_than(Some(&pair[0])), "{pair:?}");
            assert!(!pair[0].is_newer_than(Some(&pair[1])));
            assert!(!pair[0].is_newer_than(Some(&pair[0])));
        }
    }
}
