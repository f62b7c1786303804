//! `kick_test`: one robot for itself in a simulated match, whose kicker is tested or that is driven by hand:
//! the other team stands, and the ball comes back to the middle after every kick and when it has left the
//! field, as a person beside a real field would put it there.

use std::time::Instant;

use arena::game::{Game, Watcher};
use geometry::Point;
use hil_sim::small_size::Ball;
use host::robot_test::{HAND_EXPIRY, TestOrder, TestRefused, TestState};
use host::run::test_text;
use rules::state::RefereeCommand;
use rules::{Colour, Phase};

/// The team that tests, and how many of its kicks the ball was put back for.
#[derive(Debug, Default)]
pub(super) struct KickTests {
    running: Option<(Colour, usize)>,
    hand: Option<HeldDrive>,
}

/// The newest order of a hand, when it came by the clock of people, and when the host had it, s of the match.
#[derive(Debug)]
struct HeldDrive {
    order: TestOrder,
    came: Instant,
    given_s: f64,
}

impl KickTests {
    /// Begins, goes on with or ends a test; what was done, in words, where something else was done before.
    pub(super) fn order(
        &mut self,
        game: &mut Game<'_>,
        team: Colour,
        order: TestOrder,
        watcher: &mut dyn Watcher,
    ) -> Result<Option<String>, TestRefused> {
        let drives = matches!(order, TestOrder::Drive { .. });
        let driven = game.host(team).driven();
        game.test(team, order, watcher)?;
        self.hand = drives.then(|| HeldDrive { order, came: Instant::now(), given_s: game.time() });
        if driven.is_some() && driven == game.host(team).driven() {
            return Ok(None);
        }
        let theirs = if order == TestOrder::End { TestOrder::End } else { TestOrder::Stand };
        game.test(team.other(), theirs, watcher)?;
        self.running = (order != TestOrder::End).then_some((team, 0));
        // A hand begins where the ball lies, and never ends a HALT.
        if self.running.is_some() && !drives {
            begin_at_the_middle(game);
        }
        Ok(Some(format!("{}: {}", team.label(), test_text(order))))
    }

    /// Gives a hand's order again while it is fresh by the clock of people: a match may run faster than that.
    pub(super) fn hold(&mut self, game: &mut Game<'_>, watcher: &mut dyn Watcher) {
        let (Some((team, _)), Some(hand)) = (self.running, &mut self.hand) else { return };
        let expiry_s = HAND_EXPIRY.as_secs_f32();
        if hand.came.elapsed().as_secs_f32() < expiry_s
            && game.time() - hand.given_s > f64::from(expiry_s) * 0.5
        {
            hand.given_s = game.time();
            // It was accepted before.
            let _ = game.test(team, hand.order, watcher);
        }
    }

    /// Puts the ball back after a kick, and lets the game run unless it is halted.
    pub(super) fn tend(&mut self, game: &mut Game<'_>) {
        let Some((team, back)) = &mut self.running else { return };
        let phase = game.referee().phase();
        if phase == Phase::Halt {
            return;
        }
        let stopped = phase != Phase::Run;
        let again = match game.host(*team).kick_test() {
            None => stopped,
            Some(report) if report.state == TestState::Done => false,
            Some(report) => {
                let kicked = report.kicks.len() > std::mem::replace(back, report.kicks.len());
                kicked || stopped || report.state == TestState::OutOfReach
            }
        };
        if again {
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
