//! `by_pass`: value of a pass for the planner, by section 3.1, with the pass location's own functions
//! ([`super::super::pass`]).

use geometry::{Attack, Point, Vector};

use super::super::pass::conditions::not_intercepted;
use super::super::pass::intercept::{BallPath, PassOpponent, SAFE};
use super::super::pass::kicks::FlatKick;
use super::super::pass::reach::Mover;
use super::super::pass::{Kicks, PassScene};
use super::super::view::{View, ViewRobot};
use super::attack::{PassOrigin, PassValue, Worth};

/// P(receive) · P(goal) of the pass location.
#[derive(Clone, Copy, Debug)]
pub struct ByPassLocation<'k> {
    kicks: &'k Kicks,
}

impl<'k> ByPassLocation<'k> {
    /// With the kicks, and so the constants, of a league and a field surface.
    pub fn new(kicks: &'k Kicks) -> Self {
        Self { kicks }
    }

    /// 1 − P(c2) of one opponent alone.
    fn intercepts(
        self,
        opponent: &ViewRobot,
        from: Point<Attack>,
        to: Point<Attack>,
        kick: &FlatKick,
    ) -> f32 {
        let c = self.kicks.constants();
        let path = to - from;
        let path = BallPath {
            from,
            along: path.unit().unwrap_or(Vector::new(1.0, 0.0)),
            length: path.norm(),
            body: rules::limits::ROBOT_RADIUS + rules::limits::BALL_RADIUS,
            reaction: c.reaction,
            covered: 0.0,
        };
        let mover = Mover::new(opponent.position, opponent.velocity, &c.opponent);
        let found = path.flat(kick, &[PassOpponent { id: opponent.id, mover, head_start: 0.0 }]);
        1.0 - not_intercepted(found.map_or(SAFE, |found| found.margin), false, c)
    }
}

impl PassValue for ByPassLocation<'_> {
    fn worths(
        &self,
        view: &View,
        origin: PassOrigin,
        receiver: &ViewRobot,
        places: &mut dyn Iterator<Item = Point<Attack>>,
        take: &mut dyn FnMut(Point<Attack>, Worth),
    ) {
        let scene = PassScene::of(view, self.kicks, origin.from, Some(origin.kicker), receiver).at_kick();
        for at in places {
            let rating = scene.rate(at);
            let (receive, goal) = (rating.receive(), rating.goal());
            take(at, Worth { receive, goal, kick: rating.kick.order(), aim: rating.shot.aim });
        }
    }

    fn meets_pass(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32 {
        self.intercepts(opponent, from, to, &self.kicks.flat(from.distance(to)))
    }

    fn meets_shot(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32 {
        self.intercepts(opponent, from, to, &self.kicks.shot())
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::super::attack::Least;
    use super::super::grid::Cell;
    use super::super::{CoerceSettings, Planner, tactics::Models};
    use super::*;
    use rules::League;

    fn kicks(league: League) -> Kicks {
        Kicks::of(league)
    }

    #[test]
    fn a_robot_on_the_path_intercepts_the_ball_and_one_far_off_does_not() {
        let kicks = kicks(League::DivisionB);
        let value = ByPassLocation::new(&kicks);
        let scene = view((0.0, 0.0), &[], &[(1.5, 0.02), (1.5, 2.9)]);
        let (from, to) = (Point::new(0.0, 0.0), Point::new(3.0, 0.0));
        assert!(value.meets_pass(&scene.theirs[0], from, to) > 0.95);
        assert!(value.meets_pass(&scene.theirs[1], from, to) < 0.05);
        // A shot is faster: there is less time to reach its path.
        let beside = ViewRobot { position: Point::new(1.5, 0.8), ..scene.theirs[0] };
        assert!(value.meets_shot(&beside, from, to) < value.meets_pass(&beside, from, to));
    }

    #[test]
    fn a_place_is_worth_what_the_pass_location_says() {
        let kicks = kicks(League::DivisionB);
        let scene = view((0.5, 1.8), &[(-4.4, 0.0), (0.4, 1.9), (1.5, -0.8)], &[(4.3, 0.1), (2.0, 0.0)]);
        let from = Point::new(0.5, 1.8);
        let direct = PassScene::of(&scene, &kicks, from, Some(scene.ours[1].id), &scene.ours[2]);
        let mut places = Cell::all().map(|cell| cell.middle(&scene.field));
        let mut count = 0;
        let origin = PassOrigin { from, kicker: scene.ours[1].id };
        let mut compare = |at, worth: Worth| {
            let rating = direct.rate(at);
            assert_eq!((worth.receive, worth.goal), (rating.receive(), rating.goal()));
            count += 1;
        };
        ByPassLocation::new(&kicks).worths(&scene, origin, &scene.ours[2], &mut places, &mut compare);
        assert_eq!(count, 24);
    }

    #[test]
    fn against_markers_coercing_makes_the_attack_likelier() {
        // In the second paper's world and in division B: three of four teammates are marked.
        for (league, ball, scale) in
            [(League::Ssl2013, (0.25, -1.5), 1.0), (League::DivisionB, (0.4, -2.2), 1.5)]
        {
            let kicks = kicks(league);
            let value = ByPassLocation::new(&kicks);
            let at = |x: f32, y: f32| (x * scale, y * scale);
            let ours = [
                at(-2.8, 0.0),
                (ball.0 - 0.1, ball.1),
                at(0.75, 0.15),
                at(1.6, 0.5),
                at(0.9, 1.15),
                at(-0.7, 0.6),
            ];
            let theirs =
                [at(2.82, -0.1), at(2.2, -0.42), at(1.04, 0.12), at(1.86, 0.38), at(1.17, 1.0), at(0.0, 1.9)];
            let mut scene = view(ball, &ours, &theirs);
            scene.field = league.field();
            // The values are compared here, at any size.
            let settings = CoerceSettings { least: Least::default(), ..CoerceSettings::of(league) };
            let mut planner = Planner::new(settings, Models::default());
            let kicker = scene.ours[1].id;
            planner.observe(&scene, kicker);
            let plan = planner.plan(&scene, &value, kicker, 1).unwrap();
            assert_eq!(plan.coerce.coercers.len(), 3, "{league:?}");
            // An opponent on the path is drawn off it.
            for coercer in &plan.coerce.coercers {
                assert!(coercer.interference < 0.1, "{league:?} {coercer:?}");
            }
            // Followers where they are expected give the attack a higher value than at their present places.
            let receiver = *scene.our(plan.optimistic.receiver).unwrap();
            let worth = |theirs: &dyn Fn(&mut ViewRobot)| {
                let mut then = scene.clone();
                then.ours.retain(|robot| robot.id == kicker || robot.id == receiver.id);
                then.theirs.iter_mut().for_each(theirs);
                let mut found = 0.0;
                let mut place = [plan.optimistic.at].into_iter();
                let from = Point::new(ball.0, ball.1);
                value.worths(&then, PassOrigin { from, kicker }, &receiver, &mut place, &mut |_, worth| {
                    found = worth.value();
                });
                found
            };
            let now = worth(&|_| {});
            let then = worth(&|robot| {
                if let Some(coercer) = plan.coerce.coercers.iter().find(|coercer| coercer.marker == robot.id)
                {
                    robot.position = coercer.expected;
                }
            });
            assert!(
                then >= now && then > 0.8 * plan.optimistic.worth.value(),
                "{league:?} {now} {then} {plan:?}"
            );
        }
    }
}
