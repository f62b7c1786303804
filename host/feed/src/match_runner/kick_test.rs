//! `kick_test`: the test of a kicker in a simulated match: the other team stands, and the ball comes back to
//! the middle after every kick, as a person beside a real field would put it there.

use arena::game::{Game, Watcher};
use geometry::Point;
use hil_sim::small_size::Ball;
use host::robot_test::{TestOrder, TestRefused, TestState};
use host::run::test_text;
use rules::state::RefereeCommand;
use rules::{Colour, Phase};

use super::test_of;

/// The team that tests, and how many of its kicks the ball was put back for.
#[derive(Debug, Default)]
pub(super) struct KickTests {
    running: Option<(Colour, usize)>,
}

impl KickTests {
    /// Begins or ends a test; what was done, in words.
    pub(super) fn order(
        &mut self,
        game: &mut Game<'_>,
        team: Colour,
        (robot, kicks): (Option<u8>, u8),
        watcher: &mut dyn Watcher,
    ) -> Result<String, TestRefused> {
        let order = test_of(robot, kicks);
        game.test(team, order, watcher)?;
        let theirs = if order == TestOrder::End { TestOrder::End } else { TestOrder::Stand };
        game.test(team.other(), theirs, watcher)?;
        self.running = (order != TestOrder::End).then_some((team, 0));
        if self.running.is_some() {
            begin_at_the_middle(game);
        }
        Ok(format!("{}: {}", team.label(), test_text(order)))
    }

    /// Puts the ball back after a kick, and lets the game run unless it is halted.
    pub(super) fn tend(&mut self, game: &mut Game<'_>) {
        let Some((team, back)) = &mut self.running else { return };
        let Some(report) = game.host(*team).kick_test() else { return };
        if report.state == TestState::Done || game.referee().phase() == Phase::Halt {
            return;
        }
        let lies_away = report.state == TestState::OutOfReach;
        if report.kicks.len() > *back || game.referee().phase() != Phase::Run || lies_away {
            *back = report.kicks.len();
            begin_at_the_middle(game);
        }
    }
}

fn begin_at_the_middle(game: &mut Game<'_>) {
    if game.referee().phase() != Phase::Run {
        game.command(RefereeCommand::ForceStart);
    }
    game.put_ball(Ball::at(Point::new(0.0, 0.0)));
}
