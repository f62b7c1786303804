//! `request`: requests of a viewer, and their refusals.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A team, by its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PageTeam {
    /// The team with blue centre dots.
    Blue,
    /// The team with yellow centre dots.
    Yellow,
}

/// A request; the driver may refuse it. Field frame, m, rad.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "ask", rename_all = "lowercase", deny_unknown_fields)]
pub enum UserRequest {
    /// Halt our robots until the program ends: the only request that a real field accepts.
    Halt {},
    /// Pause, or go on.
    Pause {
        /// True: pause; false: go on.
        on: bool,
    },
    /// Go on by this number of ticks, then pause again.
    Step {
        /// Number of ticks, 1 to 100.
        ticks: u32,
    },
    /// Simulated seconds a second.
    Speed {
        /// Factor of real time, 0.05 to 20.
        factor: f32,
    },
    /// Go to this moment of a recording that is sent to the network.
    Seek {
        /// Seconds since its start.
        t: f64,
    },
    /// Restart the match from its kick-off.
    Restart {
        /// Random seed; `None`: as before.
        seed: Option<u64>,
    },
    /// Put ball and robots as a case's author drew them, and let the game go on from there.
    Situation {
        /// One of the names that the page received.
        name: String,
    },
    /// Keep this moment of the simulated field.
    Keep {},
    /// Return ball and robots to a moment that was kept.
    Return {
        /// Number of the moment, from 0 on.
        number: usize,
    },
    /// Keep a moment from a file, as `GET /api/snapshots` lists it.
    Load {
        /// The moment, as the page's file has it.
        snapshot: serde_json::Value,
    },
    /// Put the ball there, or move it while the match runs.
    Ball {
        /// Target place, m, field frame.
        at: [f32; 2],
    },
    /// Put a robot there, or move it while the match runs.
    Robot {
        /// Team of that robot.
        team: PageTeam,
        /// The robot's number in its team.
        id: u8,
        /// Target place, m, field frame.
        at: [f32; 2],
    },
    /// Switch a robot's computer off, or boot it.
    Power {
        /// Team of that robot.
        team: PageTeam,
        /// The robot's number in its team.
        id: u8,
        /// True: boot; false: switch off.
        on: bool,
    },
    /// The radio loses this share of packets.
    Loss {
        /// Share of packets lost, 0 to 1.
        share: f32,
    },
    /// Change a parameter of a team while it plays.
    Parameter {
        /// Team whose parameter it is; on a real field ours.
        team: PageTeam,
        /// The parameter's key, as in `team.toml`.
        key: String,
        /// The robot that it is for, where each robot has its own.
        #[serde(default)]
        robot: Option<u8>,
        /// The value; none: what holds where it is left out.
        value: Option<serde_json::Value>,
    },
    /// Write the parameters that were changed into the team's file.
    Save {},
    /// Test a robot's kicker: it kicks again and again, and the gain is fitted.
    Kicks {
        /// Team of the robot; on a real field ours.
        team: PageTeam,
        /// The robot that kicks; none: the test ends.
        robot: Option<u8>,
        /// Kicks to measure, 5 to 15.
        #[serde(default)]
        kicks: u8,
    },
    /// Drive a robot by hand. The order ends 100 ms after it came, and the robot stands.
    Drive {
        /// Team of the robot; on a real field ours.
        team: PageTeam,
        /// The robot that is driven; none: the drive ends, and the coach gives orders again.
        robot: Option<u8>,
        /// Speeds of the body ahead and to the left, m/s, and of its turn, rad/s, counter-clockwise.
        #[serde(default)]
        velocity: [f32; 3],
        /// It takes a ball before it, and carries it.
        #[serde(default)]
        dribbler: bool,
        /// It kicks a ball at its dribbler straight ahead, with this speed of the ball, m/s.
        #[serde(default)]
        kick: Option<f32>,
    },
    /// Our team's remote control asks the game controller for something.
    Remote {
        /// Name of the request, as `onetwo remote` takes it.
        request: String,
        /// The keeper, for the request of that name.
        #[serde(default)]
        robot: Option<u8>,
    },
    /// The referee's command, by its name in the league: `HALT`, `FORCE_START`, `DIRECT_FREE_BLUE`.
    Referee {
        /// Name of the command.
        command: String,
    },
}

/// Requests that a driver accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Powers {
    /// Nothing: a recording is replayed.
    None,
    /// Pause, speed and moment of a recording that is sent to the network.
    Replay,
    /// HALT: a real field.
    Halt,
    /// HALT, parameters, tests of kickers and drives by hand: a real field, where the operator has allowed
    /// it.
    Tune,
    /// Everything: the match is simulated.
    Simulation,
}

/// Reason for which a request is refused.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Refused {
    /// The message cannot be parsed.
    #[error("no request: {0}")]
    Malformed(String),
    /// The request is not accepted by a match of these powers.
    #[error("{}", .0.refusal())]
    NotHere(Powers),
    /// A number is out of its range.
    #[error("{0}")]
    Range(&'static str),
}

impl Powers {
    const fn refusal(self) -> &'static str {
        match self {
            Self::Halt => {
                "a real field takes nothing but HALT from the page; with --live-parameters parameters, kick tests and drives by hand too"
            }
            Self::Tune => {
                "a real field takes nothing but HALT, parameters, kick tests and drives by hand from the page"
            }
            Self::None => "a recording cannot be changed",
            Self::Simulation => "a match that runs has no other moment to go to",
            Self::Replay => "a recording that is sent takes pause, speed and seek alone",
        }
    }
}

impl UserRequest {
    /// Parses a viewer's message, within what may be requested here.
    pub fn read(text: &str, powers: Powers) -> Result<Self, Refused> {
        let request: Self =
            serde_json::from_str(text).map_err(|error| Refused::Malformed(error.to_string()))?;
        let allowed = match powers {
            Powers::Simulation => !matches!(request, Self::Seek { .. }),
            Powers::Halt => matches!(request, Self::Halt {}),
            Powers::Tune => {
                matches!(
                    request,
                    Self::Halt {}
                        | Self::Parameter { .. }
                        | Self::Save {}
                        | Self::Kicks { .. }
                        | Self::Drive { .. }
                        | Self::Remote { .. }
                )
            }
            Powers::Replay => {
                matches!(request, Self::Pause { .. } | Self::Speed { .. } | Self::Seek { .. })
            }
            Powers::None => false,
        };
        if !allowed {
            return Err(Refused::NotHere(powers));
        }
        request.in_range()
    }

    fn in_range(self) -> Result<Self, Refused> {
        let wrong = match &self {
            Self::Step { ticks } => (!(1..=100).contains(ticks)).then_some("ticks: 1 to 100"),
            Self::Speed { factor } => {
                (!(SPEED_MIN..=SPEED_MAX).contains(factor)).then_some("speed: 0.05 to 20")
            }
            Self::Seek { t } => (!(0.0..=SEEK_MAX_S).contains(t)).then_some("a moment: 0 to 86400 s"),
            Self::Situation { name } => (name.len() > NAME_MAX).then_some("a situation: at most 200 bytes"),
            Self::Remote { request, .. } => {
                (request.len() > NAME_MAX).then_some("a request: at most 200 bytes")
            }
            Self::Parameter { key, .. } => (key.len() > NAME_MAX).then_some("a key: at most 200 bytes"),
            Self::Loss { share } => (!(0.0..=1.0).contains(share)).then_some("loss: 0 to 1"),
            Self::Ball { at } | Self::Robot { at, .. } => {
                let far = at.iter().any(|x| !(-FARTHEST..=FARTHEST).contains(x));
                far.then_some("a place: within 20 m of the middle")
            }
            Self::Drive { velocity, kick, .. } => {
                let odd = velocity.iter().chain(kick).any(|x| !x.is_finite());
                odd.then_some("a drive: numbers")
            }
            _ => None,
        };
        let id = match &self {
            Self::Robot { id, .. }
            | Self::Power { id, .. }
            | Self::Parameter { robot: Some(id), .. }
            | Self::Kicks { robot: Some(id), .. }
            | Self::Drive { robot: Some(id), .. }
                if *id > 15 =>
            {
                Some("robots: 0 to 15")
            }
            _ => None,
        };
        wrong.or(id).map_or(Ok(self), |range| Err(Refused::Range(range)))
    }
}

/// Least speed; 0 is a pause.
const SPEED_MIN: f32 = 0.05;
/// A full match of two teams reaches at most this speed on one core.
const SPEED_MAX: f32 = 20.0;
/// Latest moment of a recording, s: a day.
const SEEK_MAX_S: f64 = 86_400.0;
/// Longest name of a case, bytes.
const NAME_MAX: usize = 200;
/// Largest coordinate of a place, m: no field is larger.
const FARTHEST: f32 = 20.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_real_field_takes_halt_and_nothing_else() {
        assert_eq!(UserRequest::read(r#"{"ask":"halt"}"#, Powers::Halt), Ok(UserRequest::Halt {}));
        for other in [
            r#"{"ask":"pause","on":true}"#,
            r#"{"ask":"referee","command":"FORCE_START"}"#,
            r#"{"ask":"ball","at":[0,0]}"#,
            r#"{"ask":"situation","name":"center/pass-around"}"#,
            r#"{"ask":"power","team":"blue","id":1,"on":false}"#,
            r#"{"ask":"parameter","team":"blue","key":"ball.roll","value":0.4}"#,
            r#"{"ask":"save"}"#,
            r#"{"ask":"kicks","team":"blue","robot":1,"kicks":10}"#,
            r#"{"ask":"drive","team":"blue","robot":1,"velocity":[0.5,0,0]}"#,
        ] {
            assert_eq!(
                UserRequest::read(other, Powers::Halt),
                Err(Refused::NotHere(Powers::Halt)),
                "{other}"
            );
            assert!(UserRequest::read(other, Powers::Simulation).is_ok(), "{other}");
            assert!(UserRequest::read(other, Powers::None).is_err(), "{other}");
        }
    }

    #[test]
    fn a_real_field_takes_parameters_only_where_the_operator_allows_it_and_then_no_more() {
        let set = r#"{"ask":"parameter","team":"blue","key":"calibration.kick","robot":3,"value":1.06}"#;
        let kicks = r#"{"ask":"kicks","team":"blue","robot":null}"#;
        let drive = r#"{"ask":"drive","team":"blue","robot":3,"velocity":[1,0,-2],"dribbler":true,"kick":4}"#;
        for text in [set, kicks, drive, r#"{"ask":"save"}"#, r#"{"ask":"halt"}"#] {
            assert!(UserRequest::read(text, Powers::Tune).is_ok(), "{text}");
        }
        for other in [r#"{"ask":"pause","on":true}"#, r#"{"ask":"ball","at":[0,0]}"#] {
            assert_eq!(UserRequest::read(other, Powers::Tune), Err(Refused::NotHere(Powers::Tune)));
        }
        let far = set.replace(":3,", ":16,");
        assert!(matches!(UserRequest::read(&far, Powers::Tune), Err(Refused::Range(_))));
    }

    #[test]
    fn a_recording_that_is_sent_takes_pause_speed_and_seek_and_no_more() {
        let pause = r#"{"ask":"pause","on":true}"#;
        for text in [pause, r#"{"ask":"speed","factor":0.1}"#, r#"{"ask":"seek","t":12.5}"#] {
            assert!(UserRequest::read(text, Powers::Replay).is_ok(), "{text}");
        }
        let halt = UserRequest::read(r#"{"ask":"halt"}"#, Powers::Replay);
        assert_eq!(halt, Err(Refused::NotHere(Powers::Replay)));
        assert!(UserRequest::read(pause, Powers::None).is_err());
        assert!(UserRequest::read(r#"{"ask":"seek","t":0}"#, Powers::Simulation).is_err());
    }

    fn powers(request: &str) -> Powers {
        if request.contains("seek") { Powers::Replay } else { Powers::Simulation }
    }

    #[test]
    fn values_out_of_range_and_unknown_requests_are_refused() {
        for wrong in [
            r#"{"ask":"speed","factor":0}"#,
            r#"{"ask":"seek","t":-1}"#,
            r#"{"ask":"seek","t":1e9}"#,
            r#"{"ask":"step","ticks":0}"#,
            r#"{"ask":"loss","share":1.5}"#,
            r#"{"ask":"ball","at":[1e9,0]}"#,
            r#"{"ask":"robot","team":"blue","id":16,"at":[0,0]}"#,
            r#"{"ask":"drive","team":"blue","robot":16,"velocity":[0,0,0]}"#,
            r#"{"ask":"drive","team":"blue","robot":1,"velocity":[1e99,0,0]}"#,
            &format!(r#"{{"ask":"situation","name":"{}"}}"#, "a".repeat(201)),
        ] {
            assert!(matches!(UserRequest::read(wrong, powers(wrong)), Err(Refused::Range(_))), "{wrong}");
        }
        for wrong in
            ["", "[]", r#"{"ask":"fly"}"#, r#"{"ask":"halt","now":1}"#, r#"{"ask":"ball","at":[null,0]}"#]
        {
            assert!(
                matches!(UserRequest::read(wrong, Powers::Simulation), Err(Refused::Malformed(_))),
                "{wrong}"
            );
        }
    }
}
