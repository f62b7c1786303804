//! `parsers`: values of flags, read from the command line. An error says what was expected; clap names the
//! flag.

use std::net::{IpAddr, SocketAddr};

use arena::Profile;
use casebase::GoalEnd;
use firmware_build::{Board, ImageBody, Program, boards};
use hil_sim::small_size::network::RefereeKind;
use host::config::Calibration;
use host::strategy::Team;
use protocol::{RobotId, TeamId};
use rules::{Colour, League};
use ssl::net::{addresses, resolve, resolve_destination, split_address};
use study::store::Shard;

pub(crate) fn league(name: &str) -> Result<League, String> {
    [League::Ssl2013, League::DivisionB, League::DivisionA]
        .into_iter()
        .find(|league| league.name() == name)
        .ok_or_else(|| "expected ssl-2013, division-b or division-a".to_owned())
}

pub(crate) fn colour(label: &str) -> Result<Colour, String> {
    [Colour::Blue, Colour::Yellow]
        .into_iter()
        .find(|colour| colour.label() == label)
        .ok_or_else(|| "expected blue or yellow".to_owned())
}

/// The goal that a team defends, by its name in case files.
pub(crate) fn goal(label: &str) -> Result<GoalEnd, String> {
    GoalEnd::from_label(label).ok_or_else(|| "expected yellow (the goal at -x) or cyan (at +x)".to_owned())
}

/// A team of a simulated match by its name.
pub(crate) fn team(label: &str) -> Result<Team, String> {
    Team::from_label(label).ok_or_else(|| format!("take {}", Team::ALL.map(Team::label).join(", ")))
}

/// Length of a simulated match, s.
pub(crate) fn match_seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "expected seconds, such as 600".to_owned())?;
    if (0.0..=36_000.0).contains(&seconds) { Ok(seconds) } else { Err("0 to 36000 seconds".to_owned()) }
}

/// Length of a match that firmware is measured in under QEMU, simulated s.
pub(crate) fn measured_seconds(text: &str) -> Result<f64, String> {
    let range = 0.1..=3600.0;
    text.parse()
        .ok()
        .filter(|value| range.contains(value))
        .ok_or_else(|| "expected 0.1 to 3600 seconds".to_owned())
}

/// Time on the clock after which a verb ends, s.
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    within(text, 0.0..1e7).ok_or_else(|| "expected seconds, such as 60".to_owned())
}

/// A moment of a recording, s since its start.
pub(crate) fn moment_in_seconds(text: &str) -> Result<f64, String> {
    within(text, 0.0..1e9).ok_or_else(|| "expected seconds from the begin, such as 12.5".to_owned())
}

fn within(text: &str, range: std::ops::Range<f64>) -> Option<f64> {
    text.parse().ok().filter(|value| range.contains(value))
}

/// Simulated seconds a second of a match with the page.
pub(crate) fn match_speed(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|x| (0.05..=20.0).contains(x))
        .ok_or_else(|| "expected 0.05 to 20, such as 2".to_owned())
}

/// Simulated seconds a second of a field for others; 0 stands still.
pub(crate) fn field_speed(text: &str) -> Result<f32, String> {
    let most = hil_sim::small_size::server::SPEED_MAX;
    text.parse()
        .ok()
        .filter(|x| (0.0..=most).contains(x))
        .ok_or_else(|| format!("expected 0 (stands still) to {most}"))
}

pub(crate) fn cameras(text: &str) -> Result<u32, String> {
    text.parse().ok().filter(|n| [1, 2, 4].contains(n)).ok_or_else(|| "expected 1, 2 or 4".to_owned())
}

/// A source of referee messages by its word or address.
pub(crate) fn referee(text: &str) -> Result<RefereeKind, String> {
    match text {
        "internal" => Ok(RefereeKind::Internal),
        "none" => Ok(RefereeKind::None),
        address => resolve(address, None).map(RefereeKind::Received).map_err(|error| {
            format!("expected internal, none or an address such as 224.5.23.1:10003: {error}")
        }),
    }
}

/// A game controller's port for automatic referees: `HOST` or `HOST:PORT`, with the league's port where none
/// is given.
pub(crate) fn controller(text: &str) -> Result<String, String> {
    let league_port = addresses::AUTOREF_PORT;
    let (host, port) = split_address(text, Some(league_port)).ok_or_else(|| {
        format!("expected the game controller's HOST or HOST:PORT, such as 127.0.0.1:{league_port}")
    })?;
    Ok(if host.contains(':') { format!("[{host}]:{port}") } else { format!("{host}:{port}") })
}

/// An address to listen on: `HOST:PORT`, of a machine by name or address.
pub(crate) fn address(text: &str) -> Result<SocketAddr, String> {
    resolve(text, None)
}

/// An address to send to, as [`address`].
pub(crate) fn destination(text: &str) -> Result<SocketAddr, String> {
    resolve_destination(text, None)
}

/// A game controller's port for teams: `HOST[:PORT]`.
pub(crate) fn team_port(text: &str) -> Result<SocketAddr, String> {
    resolve_destination(text, Some(addresses::TEAM_PORT))
}

/// A game controller's port for remote controls: `HOST[:PORT]`.
pub(crate) fn remote_port(text: &str) -> Result<SocketAddr, String> {
    resolve_destination(text, Some(addresses::REMOTE_PORT))
}

/// A machine without a port.
pub(crate) fn machine(text: &str) -> Result<IpAddr, String> {
    let (host, _) = split_address(text, Some(0))
        .filter(|(_, port)| *port == 0)
        .ok_or("expected a machine's name or address")?;
    resolve(if host.contains(':') { text } else { host }, Some(0)).map(|address| address.ip())
}

pub(crate) fn robot_id(text: &str) -> Result<RobotId, String> {
    let number: u8 = text.parse().map_err(|_| "expected a number from 0 to 15".to_owned())?;
    RobotId::try_from(number).map_err(|error| error.to_string())
}

pub(crate) fn radio_team(text: &str) -> Result<TeamId, String> {
    let teams = [Colour::Yellow, Colour::Blue].map(TeamId::of);
    let team = text.parse().ok().map(TeamId).filter(|team| teams.contains(team));
    team.ok_or_else(|| "expected 1 (yellow) or 2 (blue)".to_owned())
}

/// The number of a robot whose first start is checked.
pub(crate) fn robot_number(text: &str) -> Result<RobotId, String> {
    let wrong = || "expected a robot's number, 0 to 15".to_owned();
    text.parse().ok().and_then(RobotId::new).ok_or_else(wrong)
}

/// Robots' numbers, each once, rising.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RobotIds(pub(crate) Vec<RobotId>);

/// Numbers and ranges of robots.
pub(crate) fn robot_ids(text: &str) -> Result<RobotIds, String> {
    let wrong = || "expected numbers from 0 to 15, such as 0-5 or 1,4,7".to_owned();
    let mut ids = Vec::new();
    for part in text.split(',') {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let (first, last): (u8, u8) =
            (first.trim().parse().map_err(|_| wrong())?, last.trim().parse().map_err(|_| wrong())?);
        for number in first..=last {
            ids.push(RobotId::new(number).ok_or_else(wrong)?);
        }
    }
    ids.sort_unstable();
    ids.dedup();
    if ids.is_empty() { Err(wrong()) } else { Ok(RobotIds(ids)) }
}

/// Kick gain of a robot: measured / ordered ball speed.
pub(crate) fn kick(text: &str) -> Result<Calibration, String> {
    let parts =
        text.split_once('=').and_then(|(robot, kick)| Some((robot.parse().ok()?, kick.parse().ok()?)));
    let (robot, kick) = parts.ok_or_else(|| "expected ROBOT=FACTOR, such as 3=1.06".to_owned())?;
    Ok(Calibration { robot, kick, latency_ms: None })
}

/// A shard of an evaluation, `i/n`.
pub(crate) fn shard(label: &str) -> Result<Shard, String> {
    Shard::from_label(label).ok_or_else(|| "take i/n with i from 1 to n, such as 2/3".to_owned())
}

/// Start positions of a trial.
pub(crate) fn scenario(label: &str) -> Result<hil_sim::Scenario, String> {
    hil_sim::Scenario::from_label(label).ok_or_else(|| "take 1, 2, 3, 4 or random".to_owned())
}

/// Opponents of a trial.
pub(crate) fn opponents(label: &str) -> Result<hil_sim::Configuration, String> {
    hil_sim::Configuration::from_label(label).ok_or_else(|| "take dg or 2d".to_owned())
}

/// The world of a trial.
pub(crate) fn profile(label: &str) -> Result<Profile, String> {
    Profile::from_label(label).ok_or_else(|| "take simulated or robots".to_owned())
}

pub(crate) fn approach(label: &str) -> Result<brain::Approach, String> {
    arena::approach_from_label(label).ok_or_else(|| {
        let known: Vec<_> = arena::APPROACHES.map(arena::approach_label).into();
        format!("take {}", known.join(" or "))
    })
}

/// A share from 0 to 1.
pub(crate) fn share(label: &str) -> Result<f32, String> {
    label
        .parse()
        .ok()
        .filter(|x| (0.0..=1.0).contains(x))
        .ok_or_else(|| "take a share from 0 to 1".to_owned())
}

/// The firmware image of that name: `legged` and `omni`, which the simulator steps tick by tick, `free`,
/// which runs by its own clock, `udp`, which does so on a network, each real board by its directory's name,
/// and its other programs by theirs.
pub(crate) fn image(name: &str) -> Result<Program, String> {
    match name {
        "legged" => Ok(Program::Robot(ImageBody::Legged)),
        "omni" => Ok(Program::Robot(ImageBody::Omni)),
        "free" => Ok(Program::Free),
        "udp" => Ok(Program::Udp),
        _ => Program::of_board(name).or_else(|| further_program(name)).ok_or_else(|| {
            let real = boards().iter().filter(|board| board.firmware.is_some());
            let real: Vec<_> = real.map(|board| board.name.as_str()).collect();
            format!("expected legged, omni, free, udp, or a board: {}", real.join(", "))
        }),
    }
}

/// Another program of a real board, by its binary's name.
fn further_program(name: &str) -> Option<Program> {
    Program::images()
        .into_iter()
        .find(|program| matches!(program, Program::More(_, _)) && program.name() == name)
}

/// A board of a real robot.
pub(crate) fn real_board(name: &str) -> Result<&'static Board, String> {
    let mut real = boards().iter().filter(|board| board.firmware.is_some());
    real.clone().find(|board| board.name == name).ok_or_else(|| {
        let first = real.next().map_or("", |board| &board.name);
        let names = real.fold(first.to_owned(), |names, board| names + ", " + &board.name);
        format!("no such board; there are: {names}")
    })
}

pub(crate) fn flash_address(text: &str) -> Result<u32, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(&digits.replace('_', ""), 16),
        None => text.parse(),
    };
    parsed.map_err(|_| "expected an address such as 0x081e0000".to_owned())
}

/// A setting of retrieval and its value.
pub(super) fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) => Ok((name.trim().to_owned(), value.trim().to_owned())),
        None => Err("expected NAME=VALUE, such as thr_c=1200".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_assignment_is_split_at_its_first_equals_sign() {
        assert_eq!(assignment("a = b=c"), Ok(("a".to_owned(), "b=c".to_owned())));
        assert!(assignment("thr_c").is_err());
    }

    #[test]
    fn robots_are_named_by_ranges_and_lists() {
        let numbers =
            |text| robot_ids(text).map(|RobotIds(ids)| ids.iter().map(|id| id.number()).collect::<Vec<_>>());
        assert_eq!(numbers("0-2"), Ok(vec![0, 1, 2]));
        assert_eq!(numbers("7,1, 1"), Ok(vec![1, 7]));
        assert!(numbers("0-16").is_err() && numbers("").is_err() && numbers("5-2").is_err());
    }

    #[test]
    fn a_calibration_is_a_robot_and_a_factor() {
        assert_eq!(kick("3=1.06"), Ok(Calibration { robot: 3, kick: 1.06, latency_ms: None }));
        assert!(kick("3").is_err());
    }

    #[test]
    fn the_referee_is_internal_absent_or_external() {
        assert_eq!(referee("internal"), Ok(RefereeKind::Internal));
        assert_eq!(referee("none"), Ok(RefereeKind::None));
        assert_eq!(referee("224.5.23.1:10003"), Ok(RefereeKind::Received(addresses::REFEREE.into())));
        assert!(referee("224.5.23.1").is_err_and(|error| error.contains("10003")));
    }

    #[test]
    fn a_controller_without_a_port_has_the_leagues() {
        assert_eq!(controller("127.0.0.1").as_deref(), Ok("127.0.0.1:10007"));
        assert_eq!(controller("gc.local:1234").as_deref(), Ok("gc.local:1234"));
        assert_eq!(controller("::1").as_deref(), Ok("[::1]:10007"));
        assert!(controller("").is_err() && controller("host:").is_err() && controller(":10007").is_err());
    }

    #[test]
    fn only_what_can_be_simulated_is_taken() {
        assert!(field_speed("0").is_ok() && field_speed("-1").is_err() && field_speed("NaN").is_err());
        for text in ["NaN", "0", "-1", "inf", "1e9", "soon"] {
            assert!(measured_seconds(text).is_err(), "{text}");
        }
        assert_eq!(measured_seconds("5"), Ok(5.0));
        assert!(radio_team("1").is_ok() && radio_team("2").is_ok());
        for text in ["0", "3", "255", "256", "-1", "blue"] {
            assert!(radio_team(text).is_err(), "{text}");
        }
        assert!(cameras("4").is_ok() && cameras("3").is_err());
    }
}
