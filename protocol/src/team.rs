//! `team`: messages between robots. Their whole state, again and again (docs/architecture.md §5.1; paper
//! §4.1).
//!
//! Mates care for one message, the [`Beacon`]: pose, ball, availability, the running cycle as this robot knows it, and how
//! far the robot itself has come. Nothing is sent once: a lost packet only delays. What a robot knows of the cycle is
//! a value that only grows ([`CycleState::is_newer_than`]), so that packets may be lost, doubled and reordered, and
//! any robot may pass on what the coordinator said. [`Telemetry`] is for the host; mates leave it. A [`Greeting`] is what makes
//! mates believe each other after a boot ([`crate::acquaintance`]).

use serde::{Deserialize, Serialize};

use crate::host::Telemetry;
use crate::quantized::{WirePoint, WirePose};
use crate::{CaseId, CycleId, Duration, RobotId};

/// A robot is present for this long after its last beacon (docs/architecture.md §5.1): eight beacons of 20 Hz, so that a lost
/// one is no absence. Robots and host hold to it.
pub const PRESENCE_LEASE: Duration = Duration::millis(400);

/// Robots of a team that can take part in one case (paper §2: n ≤ 4).
pub const CASE_ROBOTS_MAX: usize = 4;
/// The longest [`TeamMessage`] in postcard bytes; with the frame's overhead it stays within 64 B
/// (docs/architecture.md §6.1).
pub const TEAM_MESSAGE_LEN_MAX: usize = 64 - crate::frame::OVERHEAD;

/// A message of a robot.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TeamMessage {
    /// To all: the sender's whole state.
    Beacon(Beacon),
    /// To the host: how the sender's body and link are.
    Telemetry(Telemetry),
    /// To mates that do not know yet that the sender lives now.
    Greeting(Greeting),
}

impl TeamMessage {
    /// Whether a payload that is one of these is meant for the host alone, as its first byte tells: the variant's number.
    pub(crate) const fn is_for_host(payload: &[u8]) -> bool {
        matches!(*payload, [1, ..])
    }
}

/// Mates' lives that the sender has heard: who is named in its present life knows that this is no recording.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Greeting {
    /// Who, in which life.
    pub mates: heapless::Vec<Greeted, GREETED_MAX>,
}

/// Mates in one greeting: as many as its frame holds.
pub const GREETED_MAX: usize = 7;

/// A mate that is greeted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Greeted {
    /// Who.
    pub who: RobotId,
    /// The epoch of its frames.
    #[serde(with = "postcard::fixint::le")]
    pub life: u32,
    /// How far the two are with each other.
    pub bond: Bond,
}

/// How far two mates are with each other, as one of them knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Bond {
    /// The greeter has heard the other, and does not believe it yet.
    Heard,
    /// It believes the other.
    Believed,
    /// And knows that the other believes it: no answer is needed.
    Mutual,
}

/// A robot's whole state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Beacon {
    /// Where the robot is.
    pub pose: WirePose,
    /// Where it sees the ball, if it does.
    pub ball: Option<BallReport>,
    /// What it is fit for.
    pub status: Status,
    /// Which case base it carries (the hash of its table); robots with another base execute only what they can verify.
    #[serde(with = "postcard::fixint::le")]
    pub case_base: u32,
    /// The newest cycle it knows.
    pub cycle: Option<CycleState>,
    /// How far it has come in that cycle.
    pub progress: Progress,
    /// What it does when no case binds it.
    pub role: Role,
}

/// Ball as seen by the sender.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BallReport {
    /// Where it lies.
    pub at: WirePoint,
    /// From the sender's centre, mm: what the elector compares.
    #[serde(with = "postcard::fixint::le")]
    pub distance: u16,
}

/// What a robot is fit for, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Status(pub u8);

impl Status {
    /// Present for election and retrieval: awake, on the field, under `Gameplay`.
    pub const AVAILABLE: Self = Self(1);
    /// Able to retrieve cases (paper §4.1: one of the k).
    pub const RETRIEVER: Self = Self(2);
    /// Holds the ball.
    pub const HOLDS_BALL: Self = Self(4);

    /// Both sets together.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Every bit of `other` is set.
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

/// A retrieve–reuse cycle as one robot knows it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct CycleState {
    /// Which cycle.
    pub id: CycleId,
    /// The retriever nearest the ball, named by the proposer.
    pub coordinator: RobotId,
    /// What became of it. The order of variants is the order of knowledge: later ones replace earlier ones.
    pub decision: Decision,
}

impl CycleState {
    /// Whether this is more than `known`: a later cycle, or more of the same one. A total order, so that robots who
    /// hear the same things in any order end up knowing the same.
    pub fn is_newer_than(&self, known: Option<&Self>) -> bool {
        known.is_none_or(|known| self > known)
    }

    /// The gameplay that runs, if one does.
    pub fn play(&self) -> Option<&Play> {
        match &self.decision {
            Decision::Play(play) => Some(play),
            _ => None,
        }
    }
}

/// What the coordinator made of its cycle.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Decision {
    /// It has not said yet.
    Undecided,
    /// No case fits: default behaviour.
    NoCase,
    /// This case, by these robots.
    Play(Play),
    /// Over.
    Closed(Closure),
}

/// A retrieved case and who plays it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Play {
    /// The stored case.
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

/// How a cycle ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Closure {
    /// Everybody involved reported the end of their actions.
    Finished,
    /// There was no case; time to try again.
    NoCase,
    /// Somebody involved stopped it.
    Aborted {
        /// Who.
        by: RobotId,
        /// Why.
        reason: AbortReason,
    },
}

/// Why a cycle was stopped (paper §4.2; docs/architecture.md §5.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum AbortReason {
    /// Before the first touch: the ball left the case's scope.
    BallOutOfScope,
    /// Before the first touch: an opponent stands in the ball's path.
    PathBlocked,
    /// A robot involved, or the coordinator, is gone or has started anew.
    RobotLost,
    /// The holder lost the ball, or an action failed.
    ActionFailed,
    /// After the first touch: an opponent is on the ball.
    OpponentOnBall,
    /// After the first touch: the ball came to rest where no one of the case expects it.
    BallAtRest,
    /// It took longer than 1.5 × the expected duration + 2 s.
    Timeout,
    /// The coordinator stayed silent about its decision.
    NoDecision,
    /// A robot carries another case base and cannot verify the case.
    UnknownCase,
}

/// How far a robot has come in its cycle (paper §4.2, Fig. 10).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Progress {
    /// Not bound by a case.
    #[default]
    Idle,
    /// On the way to its adapted position.
    Adapt {
        /// It is there.
        arrived: bool,
    },
    /// At its actions.
    Execute {
        /// Number of actions done. A pass is done ("PassDone") when this has passed its place in the list.
        done: u8,
    },
    /// Waiting for the end of the cycle.
    WaitEnd {
        /// It was involved and has finished its actions.
        finished: bool,
    },
}

/// What a robot does by itself while no case binds it (paper §5: possessor and backers-up).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Role {
    /// Bound by a case, or standing still.
    #[default]
    None,
    /// Goes for the ball.
    Attacker,
    /// Backs up.
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

    /// The longest beacon there can be.
    pub(crate) fn longest() -> TeamMessage {
        TeamMessage::Beacon(Beacon {
            pose: WirePose { at: WirePoint { x: -32768, y: 32767 }, heading: -3142 },
            ball: Some(BallReport { at: WirePoint { x: -32768, y: 32767 }, distance: 65535 }),
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
            heard: u16::MAX,
            lost: u16::MAX,
            refused: [u16::MAX; crate::frame::Refusal::KINDS],
            picture: u8::MAX,
            silence: u16::MAX,
            host: u32::MAX,
            clock: u32::MAX,
        };
        let mut out = [0; 128];
        let n = postcard::to_slice(&TeamMessage::Telemetry(telemetry), &mut out).unwrap().len();
        assert!(n <= TEAM_MESSAGE_LEN_MAX, "{n} bytes");
    }

    #[test]
    fn the_longest_greeting_fits_its_budget() {
        let mate = Greeted { who: robot(15), life: u32::MAX, bond: Bond::Mutual };
        let mates = [mate; GREETED_MAX].into_iter().collect();
        let mut out = [0; 128];
        let n = postcard::to_slice(&TeamMessage::Greeting(Greeting { mates }), &mut out).unwrap().len();
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
