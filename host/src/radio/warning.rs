//! `warning`: reports which robots refuse this host or are refused by it, and how to fix it. A matter is
//! reported while it persists: five frames within two seconds. Times on the host's clock.

use protocol::frame::Refusal;
use protocol::host::Telemetry;
use protocol::{Duration, Instant, RobotId, TeamId};
use thiserror::Error;

/// Time after which a count restarts.
const COUNT_WINDOW: Duration = Duration::millis(1_000);
/// A matter is over when no frame of it came for this time.
const QUIET_FOR: Duration = Duration::millis(2_000);
/// Number of frames within [`COUNT_WINDOW`] that is no accident: a line that corrupts one bit in 10⁵ breaks
/// fewer.
const FRAMES_MANY: u32 = 5;
/// After every start senders may be unauthenticated for this time, until each has received each other's epoch
/// (handshakes every 500 ms, some lost).
const HANDSHAKE_TIME: Duration = Duration::millis(3_000);

/// A cause that prevents communication between a robot and this host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RadioWarning {
    /// The robot follows a host with a later epoch, and refuses this one.
    #[error(
        "robot {0} refuses this host: a host with a later epoch ({1}) led it before; restart the robot or set \
         this computer's clock"
    )]
    LaterHost(RobotId, u32),
    /// The robot refuses frames for this reason.
    #[error("robot {0} refuses frames {1}")]
    Refuses(RobotId, RefusalReason),
    /// Frames in that robot's name have a tag that is not its key's.
    #[error(
        "frames of robot {0} have a wrong tag: it holds another team's key, or is imitated; check --key-file, or write \
         its page again (`onetwo firmware provision --robot {0}`)"
    )]
    WrongKey(RobotId),
    /// Frames of another host of our team come in, with this epoch.
    #[error(
        "frames of another host of our team (epoch {0}) come in: end one of the two hosts, or give it a key and a --colour \
         of its own"
    )]
    OtherHost(u32),
    /// Frames of another team's number come in.
    #[error(
        "frames of team {} come in: a robot of the other team, or one of ours provisioned with its number (--team)",
        .0.0
    )]
    OtherTeam(TeamId),
    /// Frames of another version of the protocol come in.
    #[error("frames of protocol version {0} come in: flash robots and host with the same release")]
    OtherVersion(u8),
}

impl RadioWarning {
    /// Radio number of the robot that it is about; `None`: of the channel.
    pub(crate) const fn robot(self) -> Option<RobotId> {
        match self {
            Self::LaterHost(robot, _) | Self::Refuses(robot, _) | Self::WrongKey(robot) => Some(robot),
            Self::OtherHost(_) | Self::OtherTeam(_) | Self::OtherVersion(_) => None,
        }
    }
}

/// Why a robot refuses frames, as its telemetry counts them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RefusalReason {
    /// Frames of another protocol version.
    #[error("of another protocol version: flash robots and host with the same release")]
    Version,
    /// Frames of another team's number.
    #[error("of another team's number: give each team its own channel")]
    Team,
    /// Frames of an earlier epoch of the host.
    #[error("of an earlier host: end the other host")]
    Epoch,
    /// Their tags are not its key's.
    #[error("with a wrong tag: another host with another key, or an attacker, sends on this channel")]
    Tag,
    /// Frames of a host or teammate that has not named its epoch.
    #[error(
        "of a sender it does not know: another host or robot of this team number, or recordings, are on this channel"
    )]
    Unauthenticated,
    /// Frames more than 200 ms old.
    #[error("that are over 200 ms old: the radio is too slow or overloaded, or frames are withheld")]
    Stale,
}

impl RefusalReason {
    const ALL: [Self; 6] =
        [Self::Version, Self::Team, Self::Epoch, Self::Tag, Self::Unauthenticated, Self::Stale];

    fn kind(self) -> usize {
        match self {
            Self::Version => Refusal::Version(0).kind(),
            Self::Team => Refusal::Team(TeamId(0)).kind(),
            Self::Epoch => Refusal::Epoch { seen: 0, current: 0 }.kind(),
            Self::Tag => Refusal::Tag.kind(),
            Self::Unauthenticated => Refusal::Unauthenticated { epoch: 0 }.kind(),
            Self::Stale => Refusal::Stale.kind(),
        }
    }
}

/// Frames of a kind, counted as they come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Rising {
    /// The first frame after a pause of [`QUIET_FOR`].
    since: Option<Instant>,
    window: Option<Instant>,
    latest: Option<Instant>,
    count: u32,
    before: u32,
}

impl Rising {
    fn add(&mut self, now: Instant, frames: u32) {
        if frames == 0 {
            return;
        }
        if self.latest.is_none_or(|latest| now.since(latest) >= QUIET_FOR) {
            self.since = Some(now);
        }
        let age = self.window.map(|start| now.since(start));
        if age.is_none_or(|age| age >= COUNT_WINDOW) {
            self.before = if age.is_some_and(|age| age < COUNT_WINDOW * 2) { self.count } else { 0 };
            (self.window, self.count) = (Some(now), 0);
        }
        self.count = self.count.saturating_add(frames);
        self.latest = Some(now);
    }

    fn goes_on(&self, now: Instant) -> bool {
        self.latest.is_some_and(|latest| now.since(latest) < QUIET_FOR)
            && self.count.max(self.before) >= FRAMES_MANY
    }

    fn goes_on_for(&self, now: Instant, duration: Duration) -> bool {
        self.goes_on(now) && self.since.is_some_and(|since| now.since(since) >= duration)
    }
}

/// Refusals by one robot, and of its frames.
#[derive(Clone, Copy, Debug, Default)]
struct OfRobot {
    last_refused: Option<[u16; Refusal::KINDS]>,
    rising: [Rising; RefusalReason::ALL.len()],
    forged: Rising,
    follows: Option<(u32, Instant)>,
}

impl OfRobot {
    /// The warnings that apply to this robot now, for a host of that epoch.
    fn warnings(&self, robot: RobotId, now: Instant, epoch: u32) -> impl Iterator<Item = RadioWarning> {
        let later = self.follows.filter(|(host, at)| *host > epoch && now.since(*at) < QUIET_FOR);
        let later = later.map(|(host, _)| RadioWarning::LaterHost(robot, host));
        let whys = RefusalReason::ALL.into_iter().zip(self.rising).filter(move |(why, rising)| {
            // That it refuses this host's epoch is reported already.
            match why {
                RefusalReason::Unauthenticated => rising.goes_on_for(now, HANDSHAKE_TIME),
                RefusalReason::Epoch => rising.goes_on(now) && later.is_none(),
                _ => rising.goes_on(now),
            }
        });
        let forged = self.forged.goes_on(now).then_some(RadioWarning::WrongKey(robot));
        later.into_iter().chain(whys.map(move |(why, _)| RadioWarning::Refuses(robot, why))).chain(forged)
    }
}

/// Counts refusals between robots and host.
#[derive(Clone, Debug, Default)]
pub(super) struct Refusals {
    robots: [OfRobot; RobotId::COUNT],
    host: (Rising, u32),
    team: (Rising, u8),
    version: (Rising, u8),
}

impl Refusals {
    /// Genuine telemetry came, of a robot that follows that host.
    pub(super) fn report(&mut self, now: Instant, robot: RobotId, telemetry: &Telemetry) {
        let known = &mut self.robots[robot.index()];
        known.follows = Some((telemetry.host, now));
        let before = known.last_refused.replace(telemetry.refused).unwrap_or(telemetry.refused);
        for (why, rising) in RefusalReason::ALL.into_iter().zip(&mut known.rising) {
            let of = |counts: &[u16; Refusal::KINDS]| counts.get(why.kind()).copied().unwrap_or(0);
            // After a boot the counts restart from 0.
            rising.add(now, u32::from(of(&telemetry.refused).saturating_sub(of(&before))));
        }
    }

    /// A packet was refused; `sender` is the robot it names.
    pub(super) fn refuse(&mut self, now: Instant, refusal: Refusal, sender: Option<RobotId>) {
        match (refusal, sender) {
            (Refusal::Tag, Some(robot)) => self.robots[robot.index()].forged.add(now, 1),
            (Refusal::Team(TeamId(team)), _) => {
                self.team.0.add(now, 1);
                self.team.1 = team;
            }
            (Refusal::Version(version), _) => {
                self.version.0.add(now, 1);
                self.version.1 = version;
            }
            _ => {}
        }
    }

    /// A frame came that names our team's host, with an epoch that is not ours. Ours come back from base
    /// stations that repeat them.
    pub(super) fn other_host(&mut self, now: Instant, epoch: u32) {
        self.host.0.add(now, 1);
        self.host.1 = epoch;
    }

    /// The warnings that apply now, for a host of that epoch.
    pub(super) fn warnings(&self, now: Instant, epoch: u32) -> impl Iterator<Item = RadioWarning> {
        let (host, team, version) = (self.host, self.team, self.version);
        let host = host.0.goes_on(now).then_some(RadioWarning::OtherHost(host.1));
        let team = team.0.goes_on(now).then_some(RadioWarning::OtherTeam(TeamId(team.1)));
        let version = version.0.goes_on(now).then_some(RadioWarning::OtherVersion(version.1));
        RobotId::all()
            .zip(&self.robots)
            .flat_map(move |(robot, known)| known.warnings(robot, now, epoch))
            .chain(host)
            .chain(team)
            .chain(version)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id() -> RobotId {
        RobotId::new(3).unwrap()
    }

    fn last_refused(refused: [u16; Refusal::KINDS], host: u32) -> Telemetry {
        Telemetry { refused, host, ..Telemetry::default() }
    }

    fn ms(n: u64) -> Instant {
        Instant(n * 1000)
    }

    #[test]
    fn a_robot_that_follows_a_later_host_is_reported_at_once_with_the_remedy() {
        let mut refusals = Refusals::default();
        refusals.report(ms(0), id(), &last_refused([0; Refusal::KINDS], 71));
        let warnings: Vec<_> = refusals.warnings(ms(10), 70).collect();
        assert_eq!(warnings, [RadioWarning::LaterHost(id(), 71)]);
        let description = warnings[0].to_string();
        assert!(
            description
                .starts_with("robot 3 refuses this host: a host with a later epoch (71) led it before;"),
            "{description}"
        );
        assert!(description.ends_with("restart the robot or set this computer's clock"), "{description}");
        assert_eq!(refusals.warnings(ms(10), 72).count(), 0, "that one is earlier: it will be taken over");
        assert_eq!(refusals.warnings(ms(2_010), 70).count(), 0, "it is silent");
    }

    #[test]
    fn counts_that_rise_are_reported_within_two_seconds_and_a_few_are_not() {
        for why in RefusalReason::ALL {
            let (mut refusals, mut counts) = (Refusals::default(), [0; Refusal::KINDS]);
            let mut reported = None;
            for n in 0..50_u64 {
                counts[why.kind()] += 1;
                refusals.report(ms(100 * n), id(), &last_refused(counts, 70));
                if refusals
                    .warnings(ms(100 * n), 70)
                    .any(|warning| warning == RadioWarning::Refuses(id(), why))
                {
                    reported = reported.or(Some(100 * n));
                }
            }
            let expected = if why == RefusalReason::Unauthenticated { 3_000..=4_500 } else { 0..=1_000 };
            assert!(reported.is_some_and(|at| expected.contains(&at)), "{why:?}: {reported:?}");
            // One in a second is a bit that flipped; a reboot resets the counts to 0.
            let mut refusals = Refusals::default();
            for n in 0..60_u64 {
                counts[why.kind()] = if n < 30 { (n / 10) as u16 } else { 0 };
                refusals.report(ms(100 * n), id(), &last_refused(counts, 70));
                assert_eq!(refusals.warnings(ms(100 * n), 70).count(), 0, "{why:?}");
            }
        }
    }

    #[test]
    fn a_robot_with_another_key_another_team_and_another_version_are_reported() {
        let mut refusals = Refusals::default();
        for n in 0..10 {
            refusals.refuse(ms(100 * n), Refusal::Tag, Some(id()));
            refusals.refuse(ms(100 * n), Refusal::Team(TeamId(2)), None);
            refusals.refuse(ms(100 * n), Refusal::Version(1), None);
        }
        let warnings: Vec<_> = refusals.warnings(ms(1_000), 70).collect();
        let expected =
            [RadioWarning::WrongKey(id()), RadioWarning::OtherTeam(TeamId(2)), RadioWarning::OtherVersion(1)];
        assert_eq!(warnings, expected);
        assert_eq!(refusals.warnings(ms(3_000), 70).count(), 0);
    }
}
