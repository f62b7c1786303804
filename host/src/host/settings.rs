//! `settings`: what a host starts with: its team, league, robots and radio, and the tactics and case base
//! that it plays by. m/s, m/s².

use casebase::CaseBase;
use geometry::GoalEnd;
use protocol::frame::TeamKey;
use protocol::version::VersionReport;
use protocol::{RobotId, TeamId};
use rules::{Colour, League};

use crate::config::DriveSettings;
use crate::practice::Practice;
use crate::radio::RadioSettings;
use crate::referee::{OnSilence, SourcePin};
use crate::strategy::cases_of;
use crate::strategy::{Tactics, Team};

/// Settings that a host starts with; some change while it runs
/// ([`Input::Parameter`](crate::Input::Parameter)).
#[derive(Clone, Debug)]
pub struct HostSettings {
    /// The colour our robots play with.
    pub us: Colour,
    /// The league: its field until vision sends another, and its limits.
    pub league: League,
    /// Our keeper, until the referee names one.
    pub keeper: RobotId,
    /// The goal we defend, until the referee reports it.
    pub defending: GoalEnd,
    /// Ball speed over speed ordered, by robot.
    pub kick: [f32; RobotId::COUNT],
    /// Deceleration of a rolling ball, m/s²; none: from vision, or the league's default.
    pub roll: Option<f32>,
    /// Uses the learned gains and deceleration; the host learns in either case.
    pub learns: bool,
    /// The only referee that is obeyed; none: every one, the strictest first.
    pub referee: Option<SourcePin>,
    /// Behaviour of our robots when the referee falls silent.
    pub referee_silence: OnSilence,
    /// Team that decides open play: ours or an opponent team.
    pub team: Team,
    /// Settings of the radio.
    pub radio: RadioSettings,
    /// Tactics of the second paper that it plays.
    pub tactics: Tactics,
    /// Limits of its robots' motion.
    pub limits: DriveSettings,
    /// The part of the field that is practised on.
    pub practice: Practice,
    /// Whether a strategy in another program gives orders ([`crate::external`]).
    pub external: bool,
    /// The case base of its robots, to retrieve from and to look up reported cases; none: the league's own.
    pub cases: Option<CaseBase<'static>>,
    /// What its robots should run; `None`: anything. Only displayed.
    pub expected: Option<VersionReport>,
}

impl HostSettings {
    /// A team on a league's own field with robots that execute orders without deviation; `epoch` must rise
    /// with every start.
    pub fn new(us: Colour, league: League, epoch: u32) -> Self {
        Self {
            us,
            league,
            keeper: RobotId::ZERO,
            defending: if us == Colour::Yellow { GoalEnd::Negative } else { GoalEnd::Positive },
            kick: [1.0; RobotId::COUNT],
            roll: None,
            learns: false,
            referee: None,
            referee_silence: OnSilence::default(),
            team: Team::Ours,
            radio: RadioSettings { key: TeamKey::ZERO, ..RadioSettings::new(TeamId::of(us), epoch) },
            tactics: Tactics::default(),
            limits: DriveSettings::default(),
            practice: Practice::default(),
            external: false,
            cases: None,
            expected: None,
        }
    }

    /// The case base of its robots.
    pub fn case_base(&self) -> CaseBase<'static> {
        self.cases.unwrap_or_else(|| cases_of(self.league))
    }
}
