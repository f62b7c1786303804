//! `story`: text log of a match. A line for each event of the referee, and for each restart. Seconds, field
//! frame, m.

use hil_sim::small_size::referee::{RefereeEvent, What};
use rules::{Colour, Phase};

use super::{Game, Watcher};

/// Writes the log of a match while it is played.
#[derive(Clone, Debug, Default)]
pub struct MatchLog {
    events: usize,
    phase: Option<Phase<Colour>>,
    score: [u32; 2],
    lines: Vec<String>,
}

impl MatchLog {
    /// The lines since the last call.
    pub fn take_lines(&mut self) -> Vec<String> {
        std::mem::take(&mut self.lines)
    }

    fn add(&mut self, time: f64, event: &str) {
        self.lines.push(format!("{time:7.2} s  {event}"));
    }
}

impl Watcher for MatchLog {
    fn tick(&mut self, game: &Game<'_>) {
        let referee = game.referee();
        for event in referee.events().iter().skip(self.events) {
            self.add(game.time(), &sentence(event));
        }
        self.events = referee.events().len();
        let phase = referee.phase();
        if self.phase != Some(phase) {
            self.phase = Some(phase);
            if let Some(description) = announcement(phase) {
                self.add(game.time(), &description);
            }
        }
        let score = [Colour::Blue, Colour::Yellow].map(|team| referee.accounts().of(team).score);
        if score != self.score {
            self.score = score;
            self.add(game.time(), &format!("blue {} : {} yellow", score[0], score[1]));
        }
    }
}

/// An event as text: robot, event, place.
pub fn sentence(event: &RefereeEvent) -> String {
    let who = match (event.by, event.robot) {
        (Some(team), Some(robot)) => format!("{} {robot}: ", team.label()),
        (Some(team), None) => format!("{}: ", team.label()),
        (None, _) => String::new(),
    };
    let what = match &event.what {
        What::Blocked { reason } => format!("the match is blocked, {reason},"),
        what => what.kind().label().replace('_', " "),
    };
    let (x, y) = (event.place.x(), event.place.y());
    format!("{who}{what} at ({x:.2}, {y:.2})")
}

fn announcement(phase: Phase<Colour>) -> Option<String> {
    let of = |what: &str, team: Colour| Some(format!("{what} for {}", team.label()));
    match phase {
        Phase::Kickoff(team) => of("kick-off", team),
        Phase::Penalty(team) => of("penalty", team),
        Phase::FreeKick(team) => of("free kick", team),
        Phase::Timeout(team) => of("time-out", team),
        Phase::BallPlacement(team) => of("ball placement", team),
        Phase::Halt => Some("halt".to_owned()),
        Phase::Stop | Phase::Run | Phase::PrepareKickoff(_) | Phase::PreparePenalty(_) => None,
    }
}
