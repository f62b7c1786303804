//! `state`: read access to the host's state.

use protocol::decision::DecisionReport;
use protocol::host::{Condition, Telemetry};
use protocol::team::Beacon;
use protocol::{Duration, Instant, RobotId};
use rules::{FieldSpec, Phase};

use super::{Host, HostSettings, Known, Undecodable};
use crate::learned::Learned;
use crate::radio::{Quality, Radio};
use crate::referee::{self, Listener};
use crate::strategy::Orders;
use crate::strategy::counters::PlayCounters;
use crate::strategy::pass::{Ordered, PassVerdict};
use crate::strategy::rated::Rated;
use crate::tracking::Tracker;
use crate::world::World;

/// Age from which a robot's telemetry is ignored.
const TELEMETRY_LEASE: Duration = Duration::millis(300);
/// A sensor that touches may miss a ball at the dribbler for this long: its longest gap is 0.14 s in
/// ER-Force's simulator, and telemetry reports samples of it.
const FLICKER_MAX: Duration = Duration::millis(600);

impl Host {
    /// The field as it was at the last planning.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Counts of our passes, free kicks and roles.
    pub fn counters(&self) -> &PlayCounters {
        self.books.counters()
    }

    /// Our newest pass with its outcome.
    pub fn judged_pass(&self) -> Option<&(Ordered, PassVerdict)> {
        self.books.judged()
    }

    /// The newest orders of all robots, with their reasons.
    pub fn orders(&self) -> &Orders {
        &self.orders
    }

    /// The robot that plays the ball by the rated list, and its actions, best first.
    pub fn rated(&self) -> Option<(RobotId, &[Rated])> {
        self.coach.rated()
    }

    /// The game by the referee's packets.
    pub fn game(&self) -> &referee::Game {
        self.listener.game()
    }

    /// Read access to the referee's listener.
    pub fn listener(&self) -> &Listener {
        &self.listener
    }

    /// Read access to the tracker, also for publishing.
    pub fn tracker(&self) -> &Tracker {
        &self.tracker
    }

    /// The field: vision's, or the league's until vision has sent one.
    pub fn field(&self) -> FieldSpec {
        self.geometry.field().copied().unwrap_or_else(|| self.settings.league.field())
    }

    /// The field that vision sent, once it did.
    pub fn announced_field(&self) -> Option<&FieldSpec> {
        self.geometry.field()
    }

    /// When the newest camera frame came.
    pub fn last_camera_frame(&self) -> Option<Instant> {
        self.last_camera_frame
    }

    /// Whether robots are ordered to halt now, by the referee or by `Host::halt`.
    pub fn is_halting(&self) -> bool {
        self.halted || self.listener.game().phase == Phase::Halt
    }

    /// Read access to the radio.
    pub fn radio(&self) -> &Radio {
        &self.radio
    }

    /// The link to a robot of ours.
    pub fn quality(&self, robot: RobotId) -> Option<&Quality> {
        self.radio.quality(robot)
    }

    /// The newest telemetry of one of our robots.
    pub fn telemetry(&self, robot: RobotId) -> Option<Telemetry> {
        self.robots[robot.index()].telemetry.map(|(_, telemetry)| telemetry)
    }

    /// The newest beacon of one of our robots.
    pub fn beacon(&self, robot: RobotId) -> Option<&Beacon> {
        self.robots[robot.index()].beacon.as_ref().map(|(_, beacon)| beacon)
    }

    /// The newest decision that one of our robots made and reported whole, with the problem it decided on.
    pub fn decision(&self, robot: RobotId) -> Option<&DecisionReport> {
        self.robots[robot.index()].decision.as_ref()
    }

    /// The values learned of its robots and the field.
    pub fn learned(&self) -> &Learned {
        &self.learned
    }

    /// Datagrams that were no messages.
    pub fn undecodable(&self) -> Undecodable {
        self.undecodable
    }

    /// The settings it was created with.
    pub fn settings(&self) -> &HostSettings {
        &self.settings
    }
}

impl Known {
    /// Whether telemetry or a beacon came since this host started.
    pub(super) fn has_reported(&self) -> bool {
        self.telemetry.is_some() || self.beacon.is_some()
    }

    /// Whether the robot's sensor detects the ball, as it reported lately; unknown while the sensor may
    /// flicker.
    pub(super) fn feels(&self, now: Instant) -> Option<bool> {
        let (at, reported) = self.telemetry.as_ref()?;
        let flickers = self.felt.is_some_and(|felt| now.since(felt) < FLICKER_MAX);
        match reported.condition.has(Condition::BALL_CONTACT) {
            _ if now.since(*at) >= TELEMETRY_LEASE => None,
            true => Some(true),
            false => (!flickers).then_some(false),
        }
    }
}
