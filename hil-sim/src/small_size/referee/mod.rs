//! `referee`: referee of a simulated match. Game controller and automatic referee of the Small Size League in
//! one value, without sockets (rules 2026, chapters on referee commands, offenses, game structure and
//! sanctions).
//!
//! [`InternalReferee::observe`] takes the true state of the world every 1 to 20 ms;
//! [`InternalReferee::poll_packet`] gives what the league's game controller would send,
//! [`InternalReferee::poll_order`] the manual acts at the field: place the ball, take robots off. The same
//! observations give the same match: no clock, one seeded stream for the draw.
//!
//! ```text
//! observation ─► watch (one file a question) ─► events ─► judge: fouls, cards, goals, what follows, from where
//!                                                           │
//! clock, stages ─► flow: halt, stop, placement, restarts ◄──┘ ─► commands ─► rules::GameState ─► packets
//! ```
//! The game continues under the conditions of the league's game controller ([`Reason`]) and no others: while
//! a robot or the ball is where it must not be, the match stands, and the referee reports it
//! ([`InternalReferee::blocked`]). Placement, kicks and penalties have time limits (30 s, then the other
//! team, then by hand; 5 or 10 s; 10 s). Manual acts are few and given as [`WorldOrder`]: the ball is placed
//! by hand where the rules require it, or where only the ball blocks the match, and robots are taken out in a
//! substitution area or in a halt for that purpose.

mod account;
mod blocked;
mod event;
mod field_staff;
mod flow;
mod follow;
mod judge;
mod look;
mod manual;
mod metrics;
mod observation;
mod ready;
mod reason;
pub mod remote;
mod resume;
mod scene;
mod settings;
mod spots;
mod stages;
#[cfg(test)]
mod tests;
mod watch;
mod wire;
mod wire_event;

use std::collections::VecDeque;

use geometry::{Field, GoalEnd, Point};
use protocol::Instant;
use rules::state::{CommandVerdict, GameState, RefereeCommand, Stage};
use rules::{Colour, FieldSpec, League, Limits, Phase};
use thiserror::Error;

pub use account::{Account, Accounts};
pub use blocked::Blocked;
pub use event::{Invalid, Kind, PenaltyEnd, RefereeEvent, Restart, ShotEvent, What};
pub use field_staff::WorldOrder;
pub use manual::Card;
pub use metrics::{FoulCounts, Metrics, TeamMetrics};
pub use observation::{BallSeen, CrashSeen, Observation, RobotSeen};
pub use ready::ReadyObstacle;
pub use reason::Reason;
pub use settings::{MatchClock, RefereeSettings, TeamSettings};

use crate::rng::Stream;
use field_staff::FieldStaff;
use scene::{GameView, Scene};
use watch::Watch;

/// The four-legged league has another referee, `hil_sim::Referee`, with other rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{} has no referee of the Small Size League; use ssl-2013, division-b or division-a", .0.name())]
pub struct NoRules(pub League);

/// Referees a match from true positions; sans-IO.
#[derive(Clone, Debug)]
pub struct InternalReferee {
    settings: RefereeSettings,
    field: FieldSpec,
    limits: Limits,
    state: GameState,
    stage: Stage,
    /// µs; negative when the stage ran over.
    stage_left: i64,
    /// Time at which a match in simulated time ends.
    ends_at: Option<Instant>,
    shoot_out: stages::ShootOut,
    command: RefereeCommand,
    command_counter: u32,
    command_at: Instant,
    /// Time left for placement, kick or penalty, µs.
    action_left: i64,
    /// The restart after the stop.
    next: Option<Restart>,
    /// Target position of the ball for that restart.
    placement: Option<Point<Field>>,
    /// The drawn placing team where neither is in favour.
    drawn: Option<Colour>,
    /// Events since the ball was last allowed to move.
    recent: Vec<RefereeEvent>,
    accounts: Accounts,
    blue_on_positive: bool,
    watch: Watch,
    field_staff: FieldStaff,
    metrics: Metrics,
    log: Vec<RefereeEvent>,
    chance: Stream,
    now: Instant,
    begun: bool,
    ball: BallSeen,
    ball_seen_at: Instant,
    ball_at_command: Point<Field>,
    /// Since when there is no obstacle to continuing.
    ready_since: Option<Instant>,
    waiting: blocked::Waiting,
    packets: VecDeque<ssl::referee::Referee>,
    next_packet: Instant,
    off_graph: u32,
    /// Stopped manually: nothing continues until a manual command.
    held: bool,
}

impl InternalReferee {
    /// A referee before the match. Not for the four-legged league.
    pub fn new(settings: RefereeSettings, seed: u64) -> Result<Self, NoRules> {
        let limits = settings.league.limits().ok_or(NoRules(settings.league))?;
        let accounts =
            Accounts { yellow: Account::new(&settings.yellow), blue: Account::new(&settings.blue) };
        Ok(Self {
            field: settings.league.field(),
            limits,
            state: GameState::new(),
            stage: Stage::FirstHalfPre,
            stage_left: 0,
            ends_at: None,
            shoot_out: stages::ShootOut::new(settings.first_kickoff),
            command: RefereeCommand::Halt,
            command_counter: 0,
            command_at: Instant(0),
            action_left: 0,
            next: None,
            placement: None,
            drawn: None,
            recent: Vec::new(),
            accounts,
            blue_on_positive: settings.blue_on_positive_half,
            watch: Watch::default(),
            field_staff: FieldStaff::default(),
            metrics: Metrics::default(),
            log: Vec::new(),
            chance: Stream::new(seed, "small-size-referee"),
            now: Instant(0),
            begun: false,
            ball: BallSeen::at(Point::default()),
            ball_seen_at: Instant(0),
            ball_at_command: Point::default(),
            ready_since: None,
            waiting: blocked::Waiting::default(),
            packets: VecDeque::new(),
            next_packet: Instant(0),
            off_graph: 0,
            held: false,
            settings,
        })
    }

    /// Takes the present state of the world and decides what follows from it.
    pub fn observe(&mut self, seen: &Observation<'_>) {
        if self.begun && seen.time < self.now {
            return;
        }
        let passed = if self.begun { seen.time.since(self.now).0 } else { 0 };
        self.now = seen.time;
        if let Some(ball) = seen.ball.filter(BallSeen::is_finite) {
            self.ball = ball;
            self.ball_seen_at = self.now;
        }
        if !self.begun {
            self.begun = true;
            self.ball_seen_at = self.now;
            self.begin();
        }
        let finite = |robot: &RobotSeen| robot.pose.position.is_finite() && robot.velocity.is_finite();
        let robots: Vec<RobotSeen> = seen.robots.iter().copied().filter(finite).collect();

        self.pass_time(passed);
        let (mut watch, mut events) = (std::mem::take(&mut self.watch), Vec::new());
        let view = self.view();
        let scene = Scene {
            now: self.now,
            ball: self.ball,
            fastest: seen.fastest.max(self.ball.speed()),
            robots: &robots,
            crashes: seen.crashes,
            game: &view,
        };
        watch.look(&scene, &mut events);
        let touching = robots.iter().any(|robot| robot.touches_ball);
        self.count_moment(self.ball, touching, watch.last_touch(), passed);
        self.watch = watch;
        for event in &events {
            self.judge(event);
        }
        self.keep_numbers(&robots, passed);
        self.help(&robots);
        self.go_on(&robots);
        self.state.tick(self.now.0, Some(self.ball.position), &self.limits);
        self.send_when_due();
    }

    /// The present phase of the game, by team colour.
    pub fn phase(&self) -> Phase<Colour> {
        self.state.phase()
    }

    /// The present stage of the match.
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// The league's command in force.
    pub fn command(&self) -> RefereeCommand {
        self.command
    }

    /// True once the match is over.
    pub fn is_over(&self) -> bool {
        self.stage == Stage::PostGame
    }

    /// Goals, fouls, cards and further state of each team.
    pub fn accounts(&self) -> &Accounts {
        &self.accounts
    }

    /// Target position of the ball for the next restart.
    pub fn placement(&self) -> Option<Point<Field>> {
        self.placement
    }

    /// The restart after the stop.
    pub fn next(&self) -> Option<Restart> {
        self.next
    }

    /// The end at which that team's own goal stands now.
    pub fn own_end(&self, team: Colour) -> GoalEnd {
        scene::own_end(self.blue_on_positive, team)
    }

    /// All events so far, oldest first.
    pub fn events(&self) -> &[RefereeEvent] {
        &self.log
    }

    /// Statistics for the match report.
    pub fn metrics(&self) -> &Metrics {
        &self.metrics
    }

    /// Number of commands that did not follow the league's state graph; 0 unless this referee has a bug.
    pub fn off_graph(&self) -> u32 {
        self.off_graph
    }

    /// The next packet of the game controller, if one is due: one for each command, and about 40 a second.
    pub fn poll_packet(&mut self) -> Option<ssl::referee::Referee> {
        self.packets.pop_front()
    }

    /// The next manual act at the field.
    pub fn poll_order(&mut self) -> Option<WorldOrder> {
        self.field_staff.orders.pop_front()
    }

    /// That team requests a time-out of this length at the next stop; false where it has none left.
    pub fn request_timeout(&mut self, team: Colour, length: protocol::Duration) -> bool {
        let account = self.accounts.of_mut(team);
        let granted = account.timeouts > 0 && account.timeout_left > 0 && self.stage != Stage::ShootOut;
        if granted {
            account.timeout_wanted = Some(length.0 as i64);
        }
        granted
    }

    /// That team changes its keeper; false while the ball is in play in its own half (rules: choosing keeper
    /// id).
    pub fn set_keeper(&mut self, team: Colour, keeper: protocol::RobotId) -> bool {
        let own_half = self.ball.position.x() * self.own_end(team).sign() as f32 >= 0.0;
        let allowed = !(scene::is_running(self.phase()) && own_half);
        if allowed {
            self.accounts.of_mut(team).keeper = keeper;
        }
        allowed
    }

    fn view(&self) -> GameView<'_> {
        GameView {
            phase: self.phase(),
            is_break: self.stage.is_break(),
            before_half: matches!(self.stage, Stage::SecondHalfPre | Stage::ExtraSecondHalfPre),
            since: Instant(self.state.since()),
            ball_at_command: self.ball_at_command,
            target: self.placement,
            field: &self.field,
            limits: &self.limits,
            blue_on_positive: self.blue_on_positive,
            accounts: &self.accounts,
            judge_manual_fouls: self.settings.judge_manual_fouls,
        }
    }

    /// Issues a command of the league, with its consequences for restarts and packets.
    fn give(&mut self, command: RefereeCommand) {
        let received = self.state.receive(command, self.now.0, Some(self.ball.position));
        if !matches!(received, CommandVerdict::Followed | CommandVerdict::Repeated) {
            self.off_graph += 1;
        }
        self.command = command;
        self.command_counter += 1;
        self.command_at = self.now;
        self.ball_at_command = self.ball.position;
        self.action_left = self.time_for(command);
        self.ready_since = None;
        self.wait_ends();
        self.field_staff.command_given();
        self.watch.command_given();
        let starts = matches!(
            command,
            RefereeCommand::NormalStart | RefereeCommand::ForceStart | RefereeCommand::FreeKick(_)
        );
        if starts {
            self.play_begins(command);
            self.recent.clear();
            self.placement = None;
            self.next = None;
            self.drawn = None;
        } else if command == RefereeCommand::Stop {
            self.shoot_out_goes_on();
        }
        self.next_packet = self.now;
        self.send_when_due();
    }
}

/// Seconds as microseconds, rounded towards zero.
fn micros(seconds: f32) -> i64 {
    (f64::from(seconds) * 1e6) as i64
}
