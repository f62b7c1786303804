//! `host`: the host's messages to its robots and their telemetry (docs/architecture.md §3.3, §6.1).
//! Millimetres, milliradians, field frame.
//!
//! The snapshot of the field goes to all robots present in parts ([`WorldPart`]), the directive goes to each
//! robot by itself ([`HostCommand`]). Both carry the phase of the game, so that a HALT never waits for a
//! packet that was lost. All places hold at the moment of arrival: the host's tracking has carried them
//! forward by the radio's latency, so no clocks need to agree. Everything is repeated with every snapshot;
//! nothing is sent once. Robots answer with their [`Telemetry`]. Before a robot believes a host it must have
//! had its
//! [`Welcome`]: a recording of an earlier boot epoch cannot command it.

mod read;

use geometry::GoalEnd;
pub use rules::RuleRole;
use rules::{Phase, Side};
use serde::{Deserialize, Serialize};

use crate::frame::{AUDIENCE_LEN, FRAME_LEN_MAX, HEADER_LEN, Refusal, SHORT_TAG_LEN};
use crate::ids::CASE_ROBOTS_MAX;
use crate::quantized::{WirePoint, WirePose};
use crate::{CaseId, RobotId};

/// Most robots in one part of the world; with more than six addressees fewer fit ([`WorldPart::robots_max`]).
pub const PART_ROBOTS_MAX: usize = 6;
/// Most robots in a snapshot; 11 + 11 play.
pub const WORLD_ROBOTS_MAX: usize = 24;
/// Parts that they need when 16 robots are addressed.
pub const PARTS_MAX: usize = 8;
/// The longest [`HostCommand`] in postcard bytes; with the frame's overhead it stays within 40 B
/// (docs/architecture.md §6.1).
pub const COMMAND_LEN_MAX: usize = 40 - crate::frame::OVERHEAD;

/// A message of the host.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum HostMessage {
    /// Part of the snapshot, to all robots.
    World(WorldPart),
    /// Directive, to one robot.
    Command(HostCommand),
    /// Welcome, to one robot: the host's answer to receiving it for the first time; repeated occasionally.
    Welcome(Welcome),
    /// Limits of the drive, to one robot, while they differ from its own; repeated occasionally.
    Limits(DriveLimits),
}

impl HostMessage {
    /// Returns whether the numbers in it are valid: the index of a part is less than the number of parts,
    /// which is [`PARTS_MAX`] at most; limits are at least [`DriveLimits::SPEED_MIN`] and
    /// [`DriveLimits::ACCELERATION_MIN`].
    pub fn is_sound(&self) -> bool {
        match self {
            Self::World(part) => part.part < part.parts && usize::from(part.parts) <= PARTS_MAX,
            Self::Command(_) | Self::Welcome(_) => true,
            Self::Limits(limits) => {
                limits.speed >= DriveLimits::SPEED_MIN && limits.acceleration >= DriveLimits::ACCELERATION_MIN
            }
        }
    }

    /// Returns whether this payload is a command, a welcome or limits to that robot.
    pub(crate) fn is_to_one(payload: &[u8], me: RobotId) -> bool {
        matches!(payload, [1..=3, to, ..] if *to == me.number())
    }

    /// Returns whether the payload is a part of a snapshot.
    pub(crate) fn is_to_all(payload: &[u8]) -> bool {
        matches!(payload, [0, ..])
    }
}

/// Proof that this host is live: it has received the robot in its present boot epoch. Also the offset of its
/// clock to the robot's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Welcome {
    /// Number of the robot addressed.
    pub to: RobotId,
    /// The epoch of that robot's frames.
    #[serde(with = "postcard::fixint::le")]
    pub boot_epoch: u32,
    /// The host's clock when the robot's newest telemetry came, less the clock in it; ticks of 64 µs,
    /// wrapping ([`crate::host_clock`]).
    #[serde(with = "postcard::fixint::le")]
    pub offset: u32,
}

/// Limits of a robot's drive. Its own limits hold where they are stricter, so that no message makes a robot
/// faster than it is built for; braking is not limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DriveLimits {
    /// Number of the robot addressed.
    pub to: RobotId,
    /// Greatest speed, mm/s; [`DriveLimits::NONE`]: its own.
    #[serde(with = "postcard::fixint::le")]
    pub speed: u16,
    /// Greatest acceleration, mm/s²; [`DriveLimits::NONE`]: its own.
    #[serde(with = "postcard::fixint::le")]
    pub acceleration: u16,
}

impl DriveLimits {
    /// No limit but the robot's own.
    pub const NONE: u16 = u16::MAX;
    /// Least speed limit, mm/s: a slower robot would not reach a ball, and planning divides by it.
    pub const SPEED_MIN: u16 = 300;
    /// Least acceleration limit, mm/s², likewise.
    pub const ACCELERATION_MIN: u16 = 500;
}

/// A part of the snapshot of the field.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorldPart {
    /// Number of the snapshot; parts of one snapshot carry one number, the next snapshot the next (wrapping).
    pub snapshot: u8,
    /// Index of the part, from 0.
    pub part: u8,
    /// Number of parts of the snapshot.
    pub parts: u8,
    /// The phase of the game, from our side.
    pub phase: Phase<Side>,
    /// Target of a ball placement, while one is running.
    pub placement: Option<WirePoint>,
    /// The ball; the same in every part.
    pub ball: Option<WireBall>,
    /// Robots of both teams.
    pub robots: heapless::Vec<WireRobot, PART_ROBOTS_MAX>,
}

impl WorldPart {
    /// Number of robots that fit into a part for `addressees` addressees: six up to six of them, three for
    /// all sixteen.
    pub const fn robots_max(addressees: usize, placement: bool) -> usize {
        let tags = AUDIENCE_LEN + SHORT_TAG_LEN * addressees;
        // Variant, snapshot, part, parts, the longer phase, two options, the ball, a length; then four bytes
        // of placement.
        let head = 1 + 3 + 2 + 1 + 11 + 1 + if placement { 4 } else { 0 };
        let fit = FRAME_LEN_MAX.saturating_sub(HEADER_LEN + tags + head) / WIRE_ROBOT_LEN;
        if fit < PART_ROBOTS_MAX { fit } else { PART_ROBOTS_MAX }
    }
}

/// Bytes of a robot in a part: identity, x, y, heading, two velocities.
pub(crate) const WIRE_ROBOT_LEN: usize = 11;

/// The ball on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WireBall {
    /// Position on the ground, mm, field frame.
    pub at: WirePoint,
    /// Height, mm; 0 on the ground.
    #[serde(with = "postcard::fixint::le")]
    pub height: u16,
    /// Velocity along +x, mm/s.
    #[serde(with = "postcard::fixint::le")]
    pub vx: i16,
    /// Velocity along +y, mm/s.
    #[serde(with = "postcard::fixint::le")]
    pub vy: i16,
}

/// A robot on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WireRobot {
    /// Team and number of the robot.
    pub who: WireWho,
    /// Position, mm, and heading, mrad.
    pub pose: WirePose,
    /// Velocity along +x, mm/s.
    #[serde(with = "postcard::fixint::le")]
    pub vx: i16,
    /// Velocity along +y, mm/s.
    #[serde(with = "postcard::fixint::le")]
    pub vy: i16,
}

/// A robot's team and number in one byte: bit 7 set for theirs, the number below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct WireWho {
    /// Team, from our side.
    pub side: Side,
    /// Number in the team.
    pub id: RobotId,
}

impl From<WireWho> for u8 {
    fn from(who: WireWho) -> Self {
        let side = if who.side == Side::Theirs { 0x80 } else { 0 };
        side | who.id.number()
    }
}

impl TryFrom<u8> for WireWho {
    type Error = crate::ids::NoSuchRobot;
    fn try_from(byte: u8) -> Result<Self, Self::Error> {
        let side = if byte & 0x80 == 0 { Side::Ours } else { Side::Theirs };
        Ok(Self { side, id: RobotId::try_from(byte & 0x7f)? })
    }
}

/// Command to one robot.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HostCommand {
    /// Number of the robot addressed.
    pub to: RobotId,
    /// The goal we defend: teams change ends at half-time.
    pub defending: GoalEnd,
    /// The phase of the game, from our side.
    pub phase: Phase<Side>,
    /// Role of the robot under the rules.
    pub rule_role: RuleRole,
    /// Order for the robot.
    pub directive: Directive,
}

/// The directive of the host's strategy. The robot's skills carry it out, within the limits of phase, role
/// and governor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Directive {
    /// Brake, then stand without a target.
    Stand,
    /// Be at this place with this heading, around all obstacles; away from the ball too unless the kicker of
    /// a restart.
    GoTo {
        /// Target pose, mm and mrad, field frame.
        pose: WirePose,
    },
    /// Get the ball to the dribbler, then face this point.
    GetBall {
        /// Point to face with it; `None`: the attacked goal.
        face: Option<WirePoint>,
    },
    /// Kick the ball at a point; a shot at the goal and a clearance too.
    Kick {
        /// Target of the ball, mm, field frame.
        at: WirePoint,
        /// Kick of the pass.
        kick: KickOrder,
    },
    /// Pass to a teammate, who will have the ball at `at`; waits, facing it, until ordered to be `ready`.
    Pass {
        /// The interception point, mm, field frame.
        at: WirePoint,
        /// Robot that receives the pass.
        receiver: RobotId,
        /// Kick of the pass.
        kick: KickOrder,
        /// True once the ball may leave.
        ready: bool,
    },
    /// Receive a passed ball at this place.
    Receive {
        /// The interception point, mm, field frame.
        at: WirePoint,
        /// Point to redirect the ball to at first touch; `None`: take it.
        then: Option<WirePoint>,
    },
    /// Carry the ball there, at most a metre (rules: the dribbling limit).
    Dribble {
        /// Target pose with the ball, mm and mrad.
        pose: WirePose,
    },
    /// Stand on this stretch where the ball would cross it; stop a ball that comes.
    Block {
        /// One end of the stretch.
        from: WirePoint,
        /// Other end of the stretch.
        to: WirePoint,
    },
    /// Bring the ball to this place and leave it there, stationary.
    PlaceBall {
        /// The designated position, mm, field frame.
        at: WirePoint,
    },
    /// Choose a case with the teammates under this directive, and play it.
    Gameplay {
        /// The host's proposal of a case.
        hint: Option<Hint>,
    },
}

/// Kind of kick with its ball speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum KickOrder {
    /// Along the ground; speed in cm/s.
    Flat(u16),
    /// Through the air; speed in cm/s.
    Chip(u16),
}

/// A case proposed by the host.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hint {
    /// Id of the stored case.
    pub case: CaseId,
    /// Case robot i is played by entry i.
    pub robots: heapless::Vec<RobotId, CASE_ROBOTS_MAX>,
    /// Place at which its first pass shall be received, if not at the adapted position; robots leave it
    /// aside.
    pub pass_point: Option<WirePoint>,
}

/// A robot's report about itself to the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Telemetry {
    /// Condition bits, see [`Condition`].
    pub condition: Condition,
    /// Battery, cV (1/100 V); 0 where it is not measured.
    #[serde(with = "postcard::fixint::le")]
    pub battery: u16,
    /// Number of parts of the host's snapshots received in this boot epoch, wrapping.
    #[serde(with = "postcard::fixint::le")]
    pub received: u16,
    /// Number of parts never received, by the snapshots' numbers, wrapping.
    #[serde(with = "postcard::fixint::le")]
    pub lost: u16,
    /// Frames refused in this boot epoch, by [`Refusal::kind`], saturating; echoes of the robot's own frames
    /// are not counted.
    #[serde(with = "counts")]
    pub refused: [u16; Refusal::KINDS],
    /// The newest snapshot of which a part was received; meaningless before the first.
    pub snapshot: u8,
    /// Time since the last frame of the host, 0.1 ms, saturating.
    #[serde(with = "postcard::fixint::le")]
    pub silence: u16,
    /// The epoch of the host that this robot follows; 0 before it was welcomed.
    #[serde(with = "postcard::fixint::le")]
    pub host: u32,
    /// The robot's clock, ticks of 64 µs, wrapping: comes back in [`Welcome::offset`].
    #[serde(with = "postcard::fixint::le")]
    pub clock: u32,
}

/// Condition of a robot, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Condition(#[serde(with = "postcard::fixint::le")] pub u16);

impl Condition {
    /// The ball is at the dribbler.
    pub const BALL_CONTACT: Self = Self(1);
    /// The kicker is charged.
    pub const KICKER_READY: Self = Self(1 << 1);
    /// The robot has tipped over.
    pub const TIPPED: Self = Self(1 << 2);
    /// The battery is too low to play.
    pub const BATTERY_LOW: Self = Self(1 << 3);
    /// The governor has limited the brain's orders.
    pub const GOVERNED: Self = Self(1 << 4);
    /// The host has been silent for too long: the robot brakes.
    pub const LINK_LOST: Self = Self(1 << 5);
    /// In the last second more packets came than it had time to open; the host's come first.
    pub const FLOODED: Self = Self(1 << 6);

    /// Union of both sets.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Every bit of `other` is set.
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

mod counts {
    //! Encodes counters as two fixed bytes each.
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::frame::Refusal;

    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    struct Fixed(#[serde(with = "postcard::fixint::le")] u16);

    pub(super) fn serialize<S: Serializer>(counts: &[u16; Refusal::KINDS], s: S) -> Result<S::Ok, S::Error> {
        counts.map(Fixed).serialize(s)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<[u16; Refusal::KINDS], D::Error> {
        <[Fixed; Refusal::KINDS]>::deserialize(d).map(|counts| counts.map(|Fixed(count)| count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn len<T: Serialize>(value: &T) -> usize {
        postcard::to_slice(value, &mut [0; 256]).unwrap().len()
    }

    #[test]
    fn the_longest_command_fits_into_40_bytes_of_air() {
        let far = WirePoint { x: i16::MIN, y: i16::MAX };
        let id = RobotId::new(15).unwrap();
        let pose = WirePose { at: far, heading: i16::MIN };
        let kick = KickOrder::Chip(u16::MAX);
        let robots: heapless::Vec<_, CASE_ROBOTS_MAX> = [id; CASE_ROBOTS_MAX].into_iter().collect();
        let directives = [
            Directive::GoTo { pose },
            Directive::Pass { at: far, receiver: id, kick, ready: true },
            Directive::Receive { at: far, then: Some(far) },
            Directive::Block { from: far, to: far },
            Directive::Gameplay {
                hint: Some(Hint { case: CaseId(u16::MAX), robots, pass_point: Some(far) }),
            },
        ];
        for directive in directives {
            let phase = Phase::BallPlacement(Side::Theirs);
            let command = HostMessage::Command(HostCommand {
                to: id,
                defending: GoalEnd::Positive,
                phase,
                rule_role: RuleRole::Kicker,
                directive,
            });
            assert!(len(&command) <= COMMAND_LEN_MAX, "{} bytes: {command:?}", len(&command));
        }
    }

    #[test]
    fn a_full_part_of_the_world_fits_into_120_bytes_of_air_for_any_audience() {
        let robot = WireRobot {
            who: WireWho { side: Side::Theirs, id: RobotId::new(15).unwrap() },
            pose: WirePose { at: WirePoint { x: -1, y: -1 }, heading: -1 },
            vx: -1,
            vy: -1,
        };
        for addressees in 0..=RobotId::COUNT {
            for placement in [None, Some(WirePoint { x: -1, y: -1 })] {
                let robots_max = WorldPart::robots_max(addressees, placement.is_some());
                let part = WorldPart {
                    snapshot: 255,
                    part: 255,
                    parts: 255,
                    phase: Phase::BallPlacement(Side::Theirs),
                    placement,
                    ball: Some(WireBall { at: WirePoint { x: -1, y: -1 }, height: 9999, vx: -1, vy: -1 }),
                    robots: core::iter::repeat_n(robot, robots_max).collect(),
                };
                let bytes =
                    HEADER_LEN + AUDIENCE_LEN + len(&HostMessage::World(part)) + SHORT_TAG_LEN * addressees;
                assert!(bytes <= FRAME_LEN_MAX, "{bytes} B to {addressees}");
                assert!(bytes + WIRE_ROBOT_LEN > FRAME_LEN_MAX || robots_max == PART_ROBOTS_MAX);
                assert!(PARTS_MAX * robots_max >= WORLD_ROBOTS_MAX, "{addressees}");
            }
        }
        let robots_max = |n| (WorldPart::robots_max(n, false), WorldPart::robots_max(n, true));
        assert_eq!((robots_max(6), robots_max(11), robots_max(16)), ((6, 6), (5, 4), (3, 3)));
    }

    #[test]
    fn limits_that_would_stop_a_robot_are_not_sound() {
        let limits = |speed, acceleration| {
            HostMessage::Limits(DriveLimits { to: RobotId::ZERO, speed, acceleration }).is_sound()
        };
        assert!(limits(300, 500) && limits(DriveLimits::NONE, DriveLimits::NONE));
        assert!(!limits(299, 500) && !limits(300, 499) && !limits(0, DriveLimits::NONE));
    }

    #[test]
    fn a_byte_that_names_no_robot_is_refused() {
        assert!(WireWho::try_from(0x90).is_err());
        let who = WireWho::try_from(0x83).unwrap();
        assert_eq!((who.side, who.id.number(), u8::from(who)), (Side::Theirs, 3, 0x83));
    }
}
