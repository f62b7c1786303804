//! What may somebody change in a match under way? Ball and robots, the referee's word, robots' computers, the air. A match that nobody
//! touches is the same to the bit; one that somebody did touch is not to be had again from its seed.

use geometry::{Field, Point, Pose, Vector};
use hil_sim::Backend;
use hil_sim::small_size::Ball;
use protocol::Who;
use rules::state::Command;

use super::{Game, GameConfig, GameError};

impl<'a> Game<'a> {
    /// What decides it.
    pub fn config(&self) -> &GameConfig {
        &self.config
    }

    /// Pulls the ball there; where the match stands still it is put.
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

    /// Pulls a robot there; where the match stands still it is put. Nothing where no such robot plays.
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

    /// The referee is told to say that; false where it makes no sense now.
    pub fn command(&mut self, command: Command) -> bool {
        self.referee.command_by_hand(command)
    }

    /// Each team's air loses this share of packets from now on.
    pub fn lose(&mut self, share: f32) {
        for team in &mut self.teams {
            team.lose(share);
        }
    }

    /// A robot's computer ends, or one boots in its place with a clock at zero. False where no such robot plays.
    pub fn power(&mut self, who: Who, on: bool, backend: &mut dyn Backend<'a>) -> Result<bool, GameError> {
        let tick = self.tick;
        self.teams[who.colour as usize].power(&self.config, who, on, tick, backend)
    }
}
