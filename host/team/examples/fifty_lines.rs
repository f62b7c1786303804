//! A team in fifty lines: the robot at the ball shoots where the goal is open and passes to the best receiver
//! where it is not; the others do what onetwo's coach orders. Build and play it:
//!
//! ```text
//! cargo build --release -p onetwo-team --example fifty_lines
//! onetwo play --blue-strategy target/release/examples/fifty_lines
//! ```

use team::{Planner, Strategy, StrategyAnswer, StrategyShape, StrategyTask, StrategyView};

#[derive(Default)]
pub(crate) struct FiftyLines {
    planner: Planner,
    at_ball: Option<u8>,
}

impl Strategy for FiftyLines {
    fn answer(&mut self, view: &StrategyView) -> StrategyAnswer {
        let mut answer = StrategyAnswer::default();
        // Restarts and stoppages are the coach's.
        let (true, Some(ball)) = (view.phase.name == "run", view.ball) else { return answer };
        self.at_ball = self.planner.nearest_to_ball(view, self.at_ball);
        let Some(robot) = self.at_ball else { return answer };
        // A ball in our own area is the keeper's.
        if ball.at[0] < view.field.area_depth - view.field.length / 2.0 {
            return answer;
        }
        let shot = self.planner.shot(view, ball.at);
        let pass = self.planner.passes(view, robot).first().copied();
        if let Some(pass) = pass.filter(|pass| pass.receive * pass.goal > shot.goal && shot.goal < 0.2) {
            answer.order(robot, pass.task());
            answer.order(pass.receiver, StrategyTask::Receive { at: pass.at, then: Some(pass.shot_at) });
            answer.draw.push(StrategyShape::Line { from: ball.at, to: pass.at, arrow: true });
        } else {
            answer.order(robot, StrategyTask::Kick { at: shot.at, speed: 6.0 });
            answer.draw.push(StrategyShape::Line { from: ball.at, to: shot.at, arrow: true });
        }
        answer.values.insert("P(goal) by a shot".to_owned(), shot.goal);
        answer
    }
}

fn main() -> std::io::Result<()> {
    team::serve(&mut FiftyLines::default())
}
