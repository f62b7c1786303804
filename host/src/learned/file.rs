//! `file`: the learned values, as lines of `team.toml`. They are between two marks at the end of the file;
//! the lines before them are the team's own and are not changed.

use std::fmt::Write as _;

use protocol::RobotId;

use super::Learned;

/// The first and the last line written by the program.
const FIRST_LINE: &str = "# --- learned by `onetwo control --learned`; lines before this one are kept ---";
const LAST_LINE: &str = "# --- end of what was learned ---";

/// The file's text with the present values in place of those written before. Values not known yet keep their
/// line.
pub fn kept(text: &str, learned: &Learned) -> String {
    let (own, before, after) = parts(text);
    let mut out = own.trim_end().to_owned();
    if !out.is_empty() {
        out.push_str("\n\n");
    }
    let _ = writeln!(out, "{FIRST_LINE}");
    for robot in RobotId::all() {
        let (kick, latency) = (learned.kick(robot), learned.latency(robot));
        let old = |key: &str| of_robot(before, robot).and_then(|lines| value(lines, key));
        let kick = kick.map(|known| format!("{:.3}", known.value)).or(old("kick"));
        let latency = latency.map(|known| format!("{:.0}", known.value * 1e3)).or(old("latency_ms"));
        if kick.is_some() || latency.is_some() {
            let _ = writeln!(out, "[[calibration]]\nrobot = {robot}");
            for (key, value) in [("kick", kick), ("latency_ms", latency)] {
                if let Some(value) = value {
                    let _ = writeln!(out, "{key} = {value}");
                }
            }
        }
    }
    let old = before.split_once("[ball]").and_then(|(_, lines)| value(lines, "roll"));
    if let Some(roll) = learned.friction().map(|known| format!("{:.3}", known.value)).or(old) {
        let _ = writeln!(out, "[ball]\nroll = {roll}");
    }
    let _ = writeln!(out, "{LAST_LINE}");
    out.push_str(after);
    out
}

/// The text before the marks, between them and after them.
fn parts(text: &str) -> (&str, &str, &str) {
    let Some((own, rest)) = text.split_once(FIRST_LINE) else { return (text, "", "") };
    let (before, after) = rest.split_once(LAST_LINE).unwrap_or((rest, ""));
    (own, before, after.trim_start_matches('\n'))
}

/// The lines of a robot's table.
fn of_robot(text: &str, robot: RobotId) -> Option<&str> {
    text.split("[[calibration]]")
        .skip(1)
        .find(|lines| value(lines, "robot").is_some_and(|number| number == robot.number().to_string()))
}

fn value(lines: &str, key: &str) -> Option<String> {
    let table = lines.split("\n[").next()?;
    let pairs = table.lines().filter_map(|line| line.split_once('='));
    pairs.into_iter().find(|(known, _)| known.trim() == key).map(|(_, value)| value.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::TeamSettings;

    #[test]
    fn what_was_learned_follows_the_teams_own_lines_and_is_read_again() {
        let own = "# ours\ncolour = \"yellow\"\n\n[[calibration]]\nrobot = 1\nkick = 1.1\n";
        let written = format!(
            "{own}\n{FIRST_LINE}\n[[calibration]]\nrobot = 3\nkick = 0.74\nlatency_ms = 45\n[ball]\nroll = 0.41\n{LAST_LINE}\n"
        );
        let again = kept(&written, &Learned::default());
        assert_eq!(again, written, "nothing new is known: everything stays");
        let config = TeamSettings::from_toml(&again).unwrap().complete().unwrap();
        assert_eq!((config.kick[1], config.kick[3], config.roll), (1.1, 0.74, Some(0.41)));
        assert!(kept(own, &Learned::default()).starts_with("# ours\ncolour"));
        assert_eq!(parts("").0, "");
    }
}
