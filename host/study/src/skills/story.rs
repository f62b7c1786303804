//! `story`: a try, a line for every tenth of a second: the ball, the robot near it, its order and what it
//! does.

use std::fmt::Write as _;

use geometry::GoalEnd;
use host::strategy::Flip;

use protocol::Who;

use super::drill::US;
use arena::game::Game;

/// A line, when one is due.
pub(super) fn note_events(lines: &mut Vec<String>, time: f32, game: &Game<'_>) {
    if !((time * 100.0).round() as u32).is_multiple_of(TICKS_A_LINE) {
        return;
    }
    let (world, host) = (game.world(), game.host(US));
    let ball = &world.ball;
    let led = |who: Who| host.orders().iter().any(|given| given.robot == who.id);
    let ours =
        world.robots().iter().filter(|robot| robot.present && robot.who.colour == US && led(robot.who));
    let near = ours.min_by(|a, b| {
        a.pose.position.distance(ball.position).total_cmp(&b.pose.position.distance(ball.position))
    });
    let mut line = format!(
        "{time:5.2} s  ball ({:.3}, {:.3}) {:.2} m/s",
        ball.position.x(),
        ball.position.y(),
        ball.speed()
    );
    // Writing to a String cannot fail.
    if let Some(seen) = host.world().ball {
        let _ = write!(line, ", seen {:.3} m off", seen.position.distance(ball.position));
    }
    if let Some(robot) = near {
        let at = robot.pose.to_body(ball.position);
        let order = robot.order();
        let _ = write!(
            line,
            "; {} at ({:.3}, {:.3}) {:.0}°, {:.2} m/s, ball {:.3} ahead {:.3} left{}, dribbler {:.2}{}",
            robot.who.id,
            robot.pose.position.x(),
            robot.pose.position.y(),
            robot.pose.heading.to_degrees(),
            robot.velocity.norm(),
            at.x() - robot.body.front - world.parameters().ball.radius,
            at.y(),
            if robot.ball_contact { " felt" } else { "" },
            order.dribbler,
            if order.kick.is_some() { ", kicks" } else { "" },
        );
        let seen = host.world().robots().find(|seen| seen.who == robot.who);
        if let Some(seen) = seen {
            let turned = (seen.pose.heading - robot.pose.heading).to_degrees();
            let off = seen.pose.position.distance(robot.pose.position);
            let _ = write!(line, ", seen {off:.3} m and {turned:.1}° off");
        }
        let given = host.orders().iter().find(|given| given.robot == robot.who.id);
        if let Some(given) = given {
            let _ = write!(line, "; {:?}", given.task.directive(Flip::defending(GoalEnd::Negative)));
        }
    }
    lines.push(line);
}

/// Ticks of 10 ms between two lines.
const TICKS_A_LINE: u32 = 10;
