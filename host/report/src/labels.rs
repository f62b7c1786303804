//! `labels`: labels and colours of the report. One label and one colour an approach, wherever it
//! appears.

use arena::approach_label;
use brain::Approach;
use hil_sim::{Configuration, Scenario};

pub(crate) fn approach(approach: Approach) -> &'static str {
    match approach_label(approach) {
        "cbr" => "case-based",
        label => label,
    }
}

/// Okabe and Ito's blue, vermilion and bluish green: distinguishable with colour blindness.
pub(crate) fn color(approach: Approach) -> &'static str {
    match approach_label(approach) {
        "cbr" => "#0072b2",
        "reactive" => "#d55e00",
        _ => "#009e73",
    }
}

/// Style of an approach's rows: its colour, which the page's style defines for light and dark.
pub(crate) fn css(approach: Approach) -> String {
    format!("--approach:var(--{})", approach_label(approach))
}

/// Two approaches in the order of their difference: an approach beyond the paper is compared with the
/// paper's, not the reverse.
pub(crate) fn oriented((first, second): (Approach, Approach)) -> (Approach, Approach) {
    if approach_label(second) == "hybrid" { (second, first) } else { (first, second) }
}

/// `1 · middle-back`.
pub(crate) fn scenario(scenario: Scenario) -> String {
    let (label, title) = (scenario.label(), scenario.title());
    if label == title { "random starts".to_owned() } else { format!("{label} · {}", short(title)) }
}

/// The end of a scenario's title, which distinguishes it from its neighbours.
fn short(title: &str) -> &str {
    title.rsplit(", ").next().unwrap_or(title)
}

/// The attackers' opponents.
pub(crate) const fn opponents(configuration: Configuration) -> &'static str {
    match configuration {
        Configuration::DefenderGoalie => "a defender and a goalie",
        Configuration::TwoDefenders => "two defenders",
    }
}

pub(crate) const fn table(table: u8) -> &'static str {
    match table {
        1 => "Outcomes, possession and time against a defender and a goalie",
        2 => "Backing up",
        3 => "Cases used",
        4 => "Outcomes against two defenders",
        5 => "Possession and time against two defenders, without trials that ran out of time",
        _ => "Robots: noise in perception, 5 s of standing still after every case",
    }
}

/// Method of measurement of a table, and its limitations.
pub(crate) const fn note(table: u8) -> &'static str {
    match table {
        1 => {
            "Shares of trials in percent with Wilson's 95 % intervals; to goal = goal + close. Possession: how often the defender \
              had the ball in a trial, mean and standard deviation. The paper prints no spread of times: they are not tested."
        }
        2 => {
            "How often each robot made way for the other in a trial, mean; B's share of both. The paper prints no spread, so \
              nothing is tested."
        }
        3 => {
            "Cases used in a trial, mean, by the number of robots they need. The paper prints no spread, so nothing is tested. \
              Retrievals without a case and time without one it calls not significant and does not print (§5.4)."
        }
        4 => {
            "Shares of trials in percent with Wilson's 95 % intervals; to goal = the ball is in the penalty area."
        }
        5 => {
            "How often each defender had the ball in a trial, mean and standard deviation, and seconds a trial. What is left after \
              Table 4's timeouts are different trials for each approach: compare with care."
        }
        _ => {
            "The paper's 30 trials a row were played by robots; ours are simulated with its robots' noise and pauses. Out balls by \
              the robot that touched last, counted."
        }
    }
}
