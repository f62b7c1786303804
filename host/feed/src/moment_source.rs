//! `moment_source`: the moment that the page plays on from: of a recording, or of the match that runs.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use arena::Snapshot;
use arena::game::{Game, GameConfig, GameStart, LEAD_IN_TICKS};
use hil_sim::small_size::referee::remote::RemoteMatch;
use protocol::Instant;
use rules::{Colour, League};
use ssl::Message;
use ssl::referee::Referee;

use crate::recording::start_from;

/// Where the page finds the moment.
#[derive(Clone, Debug)]
pub enum MomentSource {
    /// A league log file or a trace, of this league.
    Recording(PathBuf, League),
    /// The match that runs.
    Match(RecentMoments),
}

/// What just happened in the match that runs: each tick of the last half second, and the referee.
#[derive(Clone, Debug, Default)]
pub struct RecentMoments(Arc<Mutex<Recent>>);

#[derive(Debug, Default)]
struct Recent {
    frames: VecDeque<Snapshot>,
    referee: Option<RemoteMatch>,
    config: Option<GameConfig>,
    blue_on_positive: bool,
}

impl RecentMoments {
    fn recent(&self) -> MutexGuard<'_, Recent> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A match starts.
    pub fn begin(&self, config: &GameConfig) {
        let referee = RemoteMatch::new(config.league).ok();
        *self.recent() = Recent { referee, config: Some(config.clone()), ..Recent::default() };
    }

    /// A tick of it was played.
    pub fn tick(&self, game: &Game<'_>) {
        let mut recent = self.recent();
        if recent.frames.len() > LEAD_IN_TICKS as usize {
            recent.frames.pop_front();
        }
        recent.frames.push_back(Snapshot::of(game.world(), game.config().league));
        recent.blue_on_positive = game.referee().own_end(Colour::Blue) == geometry::GoalEnd::Positive;
        let ball = game.world().ball.position;
        if let Some(referee) = &mut recent.referee {
            referee.tick(game.now(), ball);
        }
    }

    /// Its referee sent this.
    pub fn referee(&self, now: Instant, bytes: &[u8]) {
        let mut recent = self.recent();
        let ball = recent.frames.back().map_or([0.0; 2], |frame| frame.ball.at);
        if let (Some(referee), Ok(packet)) = (&mut recent.referee, Referee::decode(bytes)) {
            referee.receive(packet, now, geometry::Point::new(ball[0], ball[1]));
        }
    }
}

impl MomentSource {
    /// A match of `seconds` from the moment on: at `at_s` of a recording, between two teams of ours; now in a
    /// match that runs, between its teams. Or why there is none.
    pub(crate) fn config(&self, at_s: f64, seconds: f64) -> Result<GameConfig, String> {
        match self {
            Self::Recording(file, league) => {
                let start =
                    start_from(file, *league, at_s, (None, 0.0)).map_err(|error| error.to_string())?;
                Ok(GameConfig::new(*league, 1, seconds).starting_from(start.into()))
            }
            Self::Match(moments) => {
                let recent = moments.recent();
                let referee = recent.referee.clone().filter(|_| recent.frames.len() > LEAD_IN_TICKS as usize);
                let (Some(referee), Some(config)) = (referee, &recent.config) else {
                    return Err("the match has just begun: half a second of it is needed".to_owned());
                };
                let (frames, blue_on_positive) =
                    (recent.frames.iter().cloned().collect(), recent.blue_on_positive);
                let start = GameStart { frames, referee, blue_on_positive, led: None };
                let mut config = config.clone();
                config.duration_s = seconds;
                config.referee.clock = GameConfig::new(config.league, 1, seconds).referee.clock;
                Ok(config.starting_from(start.into()))
            }
        }
    }
}
