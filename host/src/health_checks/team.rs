//! `team`: checks of our team by referee, vision and radio: name and colour, the keeper, the number of
//! robots, the place of a placement, and robots that only radio or only vision knows.

use foreign::printable;
use geometry::{Field, Point};
use protocol::parts::PartsReport;
use protocol::version::VersionReport;
use protocol::{Duration, Instant, RobotId};
use rules::{Colour, League, Phase};
use thiserror::Error;

use super::Lasting;
use crate::Host;

/// A robot counts as seen for this time, s.
const SEEN_WITHIN: Duration = Duration::millis(500);
/// A robot that only radio or vision knows is reported after this: it has been carried on or off by then.
const APART_AFTER: Duration = Duration::millis(1_500);

/// What does not fit between our team, the referee, vision and radio.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TeamFault {
    /// The referee has our name at the other colour.
    #[error(
        "the game controller has {} as {}, and {} as {}, which we play: correct the teams there, or start with --colour {}",
        printable(name), us.other().label(), printable(other), us.label(), us.other().label()
    )]
    OtherColour {
        /// Our name.
        name: String,
        /// Our colour.
        us: Colour,
        /// The name that the referee has at our colour.
        other: String,
    },
    /// The keeper that the referee names is not on the field.
    #[error(
        "the referee names robot {keeper} our keeper, and no camera sees it on the field; put it on, or name another \
         (--keeper, the game controller)"
    )]
    NoKeeper {
        /// Number of the keeper.
        keeper: RobotId,
    },
    /// The referee allows more robots than the league does.
    #[error(
        "the referee allows {allowed} robots, {} has {of_league}: start with --league division-a, or set the division in the \
         game controller",
        league.name()
    )]
    Division {
        /// Robots that the referee allows.
        allowed: u32,
        /// The league that was chosen, and the number that it allows.
        league: League,
        /// Robots that the league allows.
        of_league: u32,
    },
    /// A placement that no robot can do.
    #[error("{}: robots keep off the ball; {}", unplaceable(*place)[0], unplaceable(*place)[1])]
    Placement {
        /// The place, m; none: the referee has sent none.
        place: Option<Point<Field>>,
    },
    /// A command of the referee that this program does not know.
    #[error(
        "the referee sends command {number}, which this program does not know: robots halt; is the game controller newer than \
         this program?"
    )]
    Command {
        /// Number of the command.
        number: i32,
    },
    /// A robot that radio receives and no camera sees.
    #[error(
        "robot {0} is received by radio, and no camera sees it: it stands; look at its pattern and at the camera's view, or \
         switch it off"
    )]
    Unseen(RobotId),
    /// A robot that cameras see and radio does not receive.
    #[error(
        "robot {0} is seen by a camera, and radio does not receive it: it is not led; is it switched on, with our key and \
         its number?"
    )]
    Unheard(RobotId),
    /// The only robot that cameras alone know, and the radio number that alone radio receives.
    #[error(
        "cameras see robot {shell}, which radio does not receive, and radio receives number {radio}, which no camera sees, \
         perhaps the same robot: set numbers.radio of robot {shell} to {radio} (page, Parameters, or [[numbers]] in team.toml)"
    )]
    OtherNumber {
        /// Number on the shell.
        shell: RobotId,
        /// Number that it was flashed with.
        radio: RobotId,
    },
    /// A robot that runs something else than its host expects.
    #[error(
        "robot {robot} runs another {} than this host expects, {runs} in place of {expected}: flash it with `onetwo \
         firmware flash --board BOARD`, of the sources that this program was built from",
        runs.differences(expected).collect::<Vec<_>>().join(" and ")
    )]
    OtherImage {
        /// Number on the shell.
        robot: RobotId,
        /// What it runs.
        runs: VersionReport,
        /// What it should run.
        expected: VersionReport,
    },
    /// A robot that suspects parts of itself, or goes on without them.
    #[error(
        "robot {robot} reports: {parts}; it goes on without it where it can, slowly with three wheels, and stops with less: \
         take it off the field, and look at that part, its plugs, cable and driver (docs/boards.md)"
    )]
    FailedParts {
        /// Number on the shell.
        robot: RobotId,
        /// What it reports.
        parts: PartsReport,
    },
}

impl TeamFault {
    /// Identity without numbers that change.
    pub(super) fn matter(&self) -> String {
        match self {
            Self::OtherColour { .. } => "name".to_owned(),
            Self::NoKeeper { keeper } => format!("keeper {keeper}"),
            Self::Division { .. } => "division".to_owned(),
            Self::Placement { .. } => "placement".to_owned(),
            Self::Command { number } => format!("command {number}"),
            Self::Unseen(robot) => format!("unseen {robot}"),
            Self::Unheard(robot) => format!("unheard {robot}"),
            Self::OtherNumber { shell, radio } => format!("number {shell} {radio}"),
            Self::OtherImage { robot, .. } => format!("image {robot}"),
            Self::FailedParts { robot, .. } => format!("parts {robot}"),
        }
    }

    /// Whether it is repeated while it lasts.
    pub(super) const fn is_urgent(&self) -> bool {
        matches!(
            self,
            Self::OtherColour { .. } | Self::NoKeeper { .. } | Self::Placement { .. } | Self::Command { .. }
        )
    }

    /// The label that heads its line.
    pub(super) const fn heading(&self) -> &'static str {
        match self {
            Self::Unseen(_)
            | Self::Unheard(_)
            | Self::OtherNumber { .. }
            | Self::OtherImage { .. }
            | Self::FailedParts { .. } => "robots",
            _ => "referee",
        }
    }
}

/// What a placement lacks, and its remedy.
fn unplaceable(place: Option<Point<Field>>) -> [String; 2] {
    let Some(place) = place else {
        return ["a ball placement is commanded without a place", "give a place in the game controller"]
            .map(str::to_owned);
    };
    let (x, y) = (place.x(), place.y());
    [
        format!("the ball is to be placed at ({x:.2}, {y:.2}) m, which no robot reaches, beyond the walls"),
        "place it by hand, or correct the place in the game controller".to_owned(),
    ]
}

/// State of the checks.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TeamChecks {
    keeper: Lasting,
    colour: Lasting,
    placement: Lasting,
    /// Since when a robot is known by radio alone, or by vision alone.
    unseen: [Option<Instant>; RobotId::COUNT],
    unheard: [Option<Instant>; RobotId::COUNT],
}

impl TeamChecks {
    /// The faults of now; `name`: our team's, where it is known.
    pub(super) fn look(
        &mut self,
        now: Instant,
        host: &Host,
        name: Option<&str>,
        sees: bool,
    ) -> Vec<TeamFault> {
        let mut faults = Vec::new();
        faults.extend(self.other_colour(now, host, name));
        faults.extend(division(host));
        faults.extend(self.no_keeper(now, host, sees));
        faults.extend(self.placement(now, host));
        faults.extend(host.listener().unknown_command(now).map(|number| TeamFault::Command { number }));
        self.apart(now, host, sees, &mut faults);
        faults.extend(host.radio().present(now).filter_map(|robot| other_image(host, robot)));
        faults.extend(host.radio().present(now).filter_map(|robot| failed_parts(host, robot)));
        faults
    }

    fn other_colour(&mut self, now: Instant, host: &Host, name: Option<&str>) -> Option<TeamFault> {
        let (us, game) = (host.settings().us, host.game());
        let same =
            |known: &str| name.is_some_and(|name| !name.is_empty() && known.eq_ignore_ascii_case(name));
        let other = &game.team(us).name;
        let swapped = same(&game.team(us.other()).name) && !same(other);
        let fault =
            || TeamFault::OtherColour { name: name.unwrap_or_default().to_owned(), us, other: other.clone() };
        self.colour.see(now, swapped).then(fault)
    }

    fn no_keeper(&mut self, now: Instant, host: &Host, sees: bool) -> Option<TeamFault> {
        let (us, game) = (host.settings().us, host.game());
        let keeper = game.team(us).keeper;
        let plays = !matches!(game.phase, Phase::Halt | Phase::Timeout(_));
        let seen: Vec<_> =
            host.world().ours(us).filter(|robot| seen_lately(now, robot)).map(|robot| robot.who.id).collect();
        let missing = keeper.filter(|id| sees && plays && !seen.is_empty() && !seen.contains(id));
        self.keeper
            .see(now, missing.is_some())
            .then_some(missing)
            .flatten()
            .map(|keeper| TeamFault::NoKeeper { keeper })
    }

    fn placement(&mut self, now: Instant, host: &Host) -> Option<TeamFault> {
        let (game, field) = (host.game(), host.field());
        let place = game.placement;
        let beyond_m = field.margin.max(field.goal_depth);
        let possible = place.is_some_and(|place| field.clamp(place, -beyond_m) == place);
        let wrong = matches!(game.phase, Phase::BallPlacement(_)) && !possible;
        self.placement.see(now, wrong).then_some(TeamFault::Placement { place })
    }

    /// Robots that radio alone or vision alone knows.
    fn apart(&mut self, now: Instant, host: &Host, sees: bool, faults: &mut Vec<TeamFault>) {
        let us = host.settings().us;
        let mut heard = [false; RobotId::COUNT];
        host.radio().present(now).for_each(|robot| heard[robot.index()] = true);
        let mut seen = [false; RobotId::COUNT];
        let visible = host.world().ours(us).filter(|robot| seen_lately(now, robot));
        visible.for_each(|robot| seen[robot.who.id.index()] = true);
        let led = heard.contains(&true);
        let before = faults.len();
        for robot in RobotId::all() {
            let (heard, seen) = (heard[robot.index()], seen[robot.index()]);
            if lasts(now, &mut self.unseen[robot.index()], sees && heard && !seen) {
                faults.push(TeamFault::Unseen(robot));
            }
            if lasts(now, &mut self.unheard[robot.index()], led && seen && !heard) {
                faults.push(TeamFault::Unheard(robot));
            }
        }
        if let [TeamFault::Unseen(heard), TeamFault::Unheard(shell)]
        | [TeamFault::Unheard(shell), TeamFault::Unseen(heard)] = faults[before..]
        {
            faults.truncate(before);
            faults.push(TeamFault::OtherNumber { shell, radio: host.radio().numbers().radio(heard) });
        }
    }
}

/// A robot's image, where it differs from what is expected.
pub(crate) fn other_image(host: &Host, robot: RobotId) -> Option<TeamFault> {
    let (expected, runs) = (host.settings().expected?, host.quality(robot)?.version()?);
    runs.differences(&expected).next()?;
    Some(TeamFault::OtherImage { robot, runs, expected })
}

/// What a robot reports of its parts, where something speaks against one.
pub(crate) fn failed_parts(host: &Host, robot: RobotId) -> Option<TeamFault> {
    let parts = host.quality(robot)?.parts();
    (!parts.is_ok()).then_some(TeamFault::FailedParts { robot, parts })
}

/// Whether it holds, and has for [`APART_AFTER`].
fn lasts(now: Instant, since: &mut Option<Instant>, holds: bool) -> bool {
    *since = holds.then(|| since.unwrap_or(now));
    since.is_some_and(|since| now.since(since) >= APART_AFTER)
}

fn seen_lately(now: Instant, robot: &crate::world::Robot) -> bool {
    now.since(robot.seen) < SEEN_WITHIN
}

fn division(host: &Host) -> Option<TeamFault> {
    let league = host.settings().league;
    let of_league = league.limits()?.robots;
    let allowed = host.game().team(host.settings().us).robots_allowed?;
    (allowed > of_league).then_some(TeamFault::Division { allowed, league, of_league })
}
