//! `hand`: changes to a running match: ball and robots, the referee's commands, robots' computers, the radio.
//! A match without them is the same to the bit; one with them cannot be repeated from its seed.

use geometry::{Field, Point, Pose, Vector};
use hil_sim::small_size::Ball;
use hil_sim::small_size::referee::{Card, Restart};
use hil_sim::{Backend, LinkLoss};
use host::Input;
use host::config::{ConfigError, ParameterChange, TeamConfig};
use host::robot_test::{TestOrder, TestRefused};
use protocol::{Duration, RobotId, Who};
use rules::Colour;
use rules::state::RefereeCommand;

use super::{Game, GameConfig, GameError, Watcher};
use crate::Snapshot;

impl<'a> Game<'a> {
    /// The configuration with which the match started.
    pub fn config(&self) -> &GameConfig {
        &self.config
    }

    /// Moves the ball there; while paused it is put there.
    pub fn move_ball(&mut self, to: Point<Field>, stands: bool) {
        if stands {
            self.world.put_ball(Ball::at(to));
            self.world.make_room_for_ball();
        } else {
            self.world.drag_ball(to);
        }
    }

    /// The ball leaves with this velocity, m/s, sliding, as kicked.
    pub fn kick_ball(&mut self, velocity: Vector<Field>) {
        let ball = Ball { velocity, ..self.world.ball };
        self.world.put_ball(ball);
    }

    /// Puts the ball there at once, standing or rolling; robots at its place are moved aside.
    pub fn put_ball(&mut self, ball: Ball) {
        self.world.put_ball(ball);
        self.world.make_room_for_ball();
    }

    /// Moves a robot there; while paused it is put there. No effect where no such robot plays.
    pub fn move_robot(&mut self, who: Who, to: Point<Field>, stands: bool) {
        let Some(robot) = self.world.robot(who).filter(|robot| robot.present) else { return };
        let pose = Pose { position: to, heading: robot.pose.heading };
        if stands {
            self.world.put(who, pose);
        } else {
            self.world.drag_robot(who, to, None);
        }
    }

    /// Puts a robot there, standing.
    pub fn put_robot(&mut self, who: Who, pose: Pose<Field>) {
        self.world.put(who, pose);
    }

    /// Returns ball and robots to a moment that was kept.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        snapshot.restore(&mut self.world);
    }

    /// Orders the referee to send a command; false where that is not possible now.
    pub fn command(&mut self, command: RefereeCommand) -> bool {
        self.referee.command_by_hand(command)
    }

    /// Stops the game and orders a restart, with the ball at the valid place nearest to `place` where there
    /// is a choice. False where that is not possible now.
    pub fn restart(&mut self, next: Restart, place: Point<Field>) -> bool {
        self.referee.restart_by_hand(next, place)
    }

    /// Ends a HALT or STOP that was ordered manually.
    pub fn go_on(&mut self) {
        self.referee.go_on_by_hand();
    }

    /// Gives a team a card.
    pub fn card(&mut self, team: Colour, card: Card) {
        self.referee.card_by_hand(team, card);
    }

    /// Changes a team's keeper; false while the rules do not permit it.
    pub fn change_keeper(&mut self, team: Colour, keeper: RobotId) -> bool {
        self.referee.set_keeper(team, keeper)
    }

    /// Requests a timeout of this length for a team at the next stop; false where it has none left.
    pub fn request_timeout(&mut self, team: Colour, length: Duration) -> bool {
        self.referee.request_timeout(team, length)
    }

    /// Changes a parameter of a team's host, as its operator does; refused changes change nothing.
    pub fn change(
        &mut self,
        team: Colour,
        change: &ParameterChange,
        watcher: &mut dyn Watcher,
    ) -> Result<(), ConfigError> {
        let (tick, now) = (self.tick, self.now());
        let team = &mut self.teams[team as usize];
        TeamConfig::of(team.host.settings())?.changed(change)?;
        team.feed(tick, now, Input::Parameter(change.to_json().as_bytes()), watcher);
        Ok(())
    }

    /// Begins or ends a test of a team's kicker, as its operator does; a refused one changes nothing.
    pub fn test(
        &mut self,
        team: Colour,
        order: TestOrder,
        watcher: &mut dyn Watcher,
    ) -> Result<(), TestRefused> {
        let (tick, now) = (self.tick, self.now());
        let order = TestOrder::from_json(order.to_json().as_bytes())?;
        let team = &mut self.teams[team as usize];
        if team.host.settings().external && matches!(order, TestOrder::Kick { .. }) {
            return Err(TestRefused::External);
        }
        team.feed(tick, now, Input::Test(order.to_json().as_bytes()), watcher);
        Ok(())
    }

    /// Each team's radio loses this share of packets from now on.
    pub fn lose(&mut self, share: f32) {
        for team in &mut self.teams {
            team.lose(share);
        }
    }

    /// Gives these links of a team's radio a loss of their own from now on, and no others.
    pub fn lose_links(&mut self, team: Colour, links: Vec<LinkLoss>) {
        self.teams[team as usize].lose_links(links);
    }

    /// Whether vision's packets are lost before both hosts from now on.
    pub fn blind(&mut self, blind: bool) {
        self.blind = blind;
    }

    /// Switches a robot's computer off, or boots one in its place with a clock at zero. False where no such
    /// robot plays.
    pub fn power(&mut self, who: Who, on: bool, backend: &mut dyn Backend<'a>) -> Result<bool, GameError> {
        let tick = self.tick;
        self.teams[who.colour as usize].power(&self.config, who, on, tick, backend)
    }
}
