//! `activity`: what the time of a trial is spent on. Every tick counts for one activity, by the true state.
//!
//! A **duel** is time in which a robot of each team stands within reach of the ball and it does not get away:
//! it is held, or slower than a grab can catch. Its share of a trial's time is the *duel share*.

use hil_sim::TICK_US;
use hil_sim::four_legged::world::{LeggedWorld, Side};

use crate::report::{ActivityReport, in_seconds};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Activity {
    Pause,
    Duel,
    Held,
    Theirs,
    Rolls,
    AtBall,
    Walk,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct ActivityCount {
    ticks: [u32; 7],
}

impl ActivityCount {
    /// Counts a tick that ended in this state; `paused` while all robots have to stand.
    pub(crate) fn tick(&mut self, world: &LeggedWorld, paused: bool) {
        let activity = if paused { Activity::Pause } else { Activity::of(world) };
        self.ticks[activity as usize] += 1;
    }

    /// The seconds of each activity.
    pub(crate) fn report(&self) -> ActivityReport {
        let seconds =
            |activity: Activity| in_seconds(self.ticks[activity as usize] as f32 * (TICK_US as f32 * 1e-6));
        ActivityReport {
            pause: seconds(Activity::Pause),
            duel: seconds(Activity::Duel),
            held: seconds(Activity::Held),
            theirs: seconds(Activity::Theirs),
            rolls: seconds(Activity::Rolls),
            at_ball: seconds(Activity::AtBall),
            walk: seconds(Activity::Walk),
        }
    }
}

impl Activity {
    fn of(world: &LeggedWorld) -> Self {
        let ball = &world.ball;
        let reach = |side| {
            let own = world.walkers.iter().filter(|walker| walker.side == side);
            own.map(|walker| walker.pose.position).any(|at| at.distance(ball.position) < REACH)
        };
        let holder = world.holder().and_then(|robot| world.walkers.get(robot)).map(|walker| walker.side);
        let speed = ball.velocity.norm();
        let gets_away = holder.is_none() && speed > GRAB_SPEED;
        match holder {
            _ if !gets_away && reach(Side::Attackers) && reach(Side::Opponents) => Self::Duel,
            Some(Side::Attackers) => Self::Held,
            Some(Side::Opponents) => Self::Theirs,
            None if speed > REST_SPEED => Self::Rolls,
            None if reach(Side::Attackers) => Self::AtBall,
            None => Self::Walk,
        }
    }
}

/// A robot whose centre is this near the ball's is within reach of it, m: a grab's 0.17 m, and what it walks
/// during another's grab (0.5 s at 0.3 m/s).
const REACH: f32 = 0.35;
/// A faster ball bounces off closing legs and gets away, m/s: the league's `grab.speed_limit`.
const GRAB_SPEED: f32 = 0.6;
/// A slower ball rests, m/s: it stops within 4 mm.
const REST_SPEED: f32 = 0.05;

#[cfg(test)]
mod tests {
    use geometry::{Point, Pose, Vector};
    use hil_sim::Parameters;
    use hil_sim::four_legged::world::Walker;

    use super::*;

    fn world(attacker: f32, opponent: f32, speed: f32) -> LeggedWorld {
        let at = |side, x: f32| Walker::at(side, Pose::from_mm_deg(x * 1000.0, 0.0, 0.0));
        let walkers = vec![at(Side::Attackers, attacker), at(Side::Opponents, opponent)];
        let mut world = LeggedWorld::new(Parameters::four_legged(), 1, Point::default(), walkers);
        world.ball.velocity = Vector::new(0.0, speed);
        world
    }

    #[test]
    fn both_within_reach_is_a_duel_unless_the_ball_gets_away() {
        assert_eq!(Activity::of(&world(-0.2, 0.3, 0.0)), Activity::Duel);
        assert_eq!(Activity::of(&world(-0.2, 0.3, 0.5)), Activity::Duel);
        assert_eq!(Activity::of(&world(-0.2, 0.3, 0.9)), Activity::Rolls);
        assert_eq!(Activity::of(&world(-0.2, 0.4, 0.0)), Activity::AtBall);
        assert_eq!(Activity::of(&world(-0.4, 0.3, 0.0)), Activity::Walk);
    }

    #[test]
    fn seconds_of_all_activities_are_the_time_that_was_counted() {
        let mut count = ActivityCount::default();
        for tick in 0..50 {
            count.tick(&world(-0.2, 0.3, if tick % 2 == 0 { 0.0 } else { 0.9 }), tick < 10);
        }
        let report = count.report();
        assert_eq!((report.pause, report.duel, report.rolls), (0.4, 0.8, 0.8));
    }
}
