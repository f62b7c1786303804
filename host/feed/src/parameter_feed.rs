//! `parameter_feed`: the teams' parameters for the page: the list with values and ranges, and what is
//! learned beside it.

use std::time::{Duration, Instant};

use host::Host;
use host::config::parameters::ParameterValue;
use host::config::{ParameterChange, TeamConfig};
use host::learned::Learned;
use host::robot_test::{KickReport, TestOrder, TestState};
use page::{Page, PageTeam, UserRequest, milli};
use protocol::RobotId;
use serde::Serialize;

use super::team as page_team;

/// The page gets the list this often: what is learned changes slowly.
const EVERY: Duration = Duration::from_secs(1);

/// Passes lists to the page.
#[derive(Default)]
pub struct ParameterFeed {
    sent: Option<Instant>,
}

#[derive(Serialize)]
struct TeamParameters {
    team: PageTeam,
    list: Vec<ParameterValue>,
    /// Learned gains of robots' kickers, by robot.
    kicks: Vec<LearnedValue>,
    /// Learned deceleration of the rolling ball, m/s².
    roll: Option<LearnedValue>,
    /// The test of a kicker, while there is one.
    test: Option<KickTest>,
    /// The file that changes can be saved to.
    file: Option<String>,
    /// A whole `team.toml` of these values, where there is no file.
    toml: Option<String>,
}

/// The test of a kicker as the page gets it.
#[derive(Serialize)]
struct KickTest {
    robot: u8,
    wanted: u8,
    /// Speed ordered and speed of the ball of each kick, m/s.
    kicks: Vec<[f32; 2]>,
    gain: Option<LearnedValue>,
    state: TestState,
}

impl KickTest {
    fn of(report: KickReport) -> Self {
        let KickReport { robot, wanted, kicks, gain, state } = report;
        let kicks = kicks.into_iter().map(|kick| kick.map(milli)).collect();
        let gain = gain.map(|known| LearnedValue {
            robot: None,
            value: milli(known.value),
            error: known.error(),
            samples: known.samples,
        });
        Self { robot: robot.number(), wanted, kicks, gain, state }
    }
}

#[derive(Serialize)]
struct LearnedValue {
    #[serde(skip_serializing_if = "Option::is_none")]
    robot: Option<u8>,
    value: f32,
    /// Standard error, in the value's unit.
    error: f32,
    samples: usize,
}

impl ParameterFeed {
    /// The next list is sent at once: a value has changed.
    pub fn hasten(&mut self) {
        self.sent = None;
    }

    /// Sends the lists of these hosts if they are due. `file`: the configuration and the name of the file
    /// that the only host was started with.
    pub fn look(&mut self, hosts: &[&Host], file: Option<(&TeamConfig, Option<&str>)>, page: &Page) {
        if self.sent.is_some_and(|sent| sent.elapsed() < EVERY) {
            return;
        }
        self.sent = Some(Instant::now());
        let teams: Vec<_> = hosts.iter().filter_map(|host| team(host, file)).collect();
        // Words and finite numbers: JSON can represent all of it.
        page.set_parameters(serde_json::to_string(&teams).unwrap_or_default());
    }
}

fn team(host: &Host, file: Option<(&TeamConfig, Option<&str>)>) -> Option<TeamParameters> {
    let config = match file {
        Some((config, _)) => config.clone().with_live(host.settings()),
        None => TeamConfig::of(host.settings()).ok()?,
    };
    let learned: &Learned = host.learned();
    let kick = |robot: RobotId| {
        let known = learned.kick(robot)?;
        let (value, error, samples) = (known.value, known.error(), known.samples);
        Some(LearnedValue { robot: Some(robot.number()), value, error, samples })
    };
    let roll = learned.friction().map(|known| LearnedValue {
        robot: None,
        value: known.value,
        error: known.error(),
        samples: known.samples,
    });
    Some(TeamParameters {
        team: page_team(host.settings().us),
        list: config.parameters(),
        kicks: RobotId::all().filter_map(kick).collect(),
        roll,
        test: host.kick_test().map(KickTest::of),
        file: file.and_then(|(_, name)| name.map(str::to_owned)),
        toml: file.is_none().then(|| config.to_toml()),
    })
}

/// The change that a viewer asks for; an error says what its value must be.
pub fn change_of(
    key: &str,
    robot: Option<u8>,
    value: Option<&serde_json::Value>,
) -> Result<ParameterChange, String> {
    let value = value.filter(|value| !value.is_null()).map(|value| {
        toml::Value::try_from(value).map_err(|_| format!("{key}: expected a number, a word, true or false"))
    });
    Ok(ParameterChange { key: key.to_owned(), robot, value: value.transpose()? })
}

/// The team and the order of a viewer who asks for a test or a drive; none: another request.
pub fn test_of(request: &UserRequest) -> Option<(PageTeam, TestOrder)> {
    Some(match *request {
        UserRequest::Kicks { team, robot, kicks } => {
            (team, robot.map_or(TestOrder::End, |robot| TestOrder::Kick { robot, kicks }))
        }
        UserRequest::Drive { team, robot, velocity, dribbler, kick } => {
            let drive = |robot| TestOrder::Drive { robot, velocity, dribbler, kick };
            (team, robot.map_or(TestOrder::End, drive))
        }
        _ => return None,
    })
}
