//! `playable`: places where a field player may play the ball while play runs: within the field, and where it
//! can reach the ball without being in a defence area that the rules forbid it.

use casebase::{FieldMm, GoalEnd, PointMm};
use geometry::{Field, Point};
use rules::keep_out::{Situation, Touch, may_touch_ball};
use rules::legality::ball_is_out;
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};
use rules::{FieldSpec, League, Phase, RuleRole};

/// The places of a league.
#[derive(Clone, Copy, Debug)]
pub(super) struct Playable {
    field: FieldMm,
    /// The field of a league that has the rules of defence areas; none of the four-legged league, whose
    /// attackers may be in the opponents'.
    spec: Option<FieldSpec>,
}

/// Places of a robot around the ball that are tried.
const PLACES_AROUND_BALL: usize = 64;

impl Playable {
    /// On this field, by the rules of the league of that name.
    pub(super) fn new(league: &str, field: FieldMm) -> Self {
        let leagues = [League::Ssl2013, League::DivisionB, League::DivisionA];
        let league = leagues.into_iter().find(|known| known.name() == league);
        let m = |mm: i32| mm as f32 * 1e-3;
        let spec = league.map(|league| FieldSpec {
            length: m(field.length),
            width: m(field.width),
            goal_width: m(field.goal_width),
            penalty_depth: m(field.penalty_depth),
            penalty_width: m(field.penalty_width),
            ..league.field()
        });
        Self { field, spec }
    }

    /// True if a field player of the team that defends `own` may play a ball there.
    pub(super) fn allows(&self, ball: PointMm, own: GoalEnd) -> bool {
        let Some(field) = &self.spec else { return self.field.contains(ball) };
        let at: Point<Field> = Point::new(ball.x as f32 * 1e-3, ball.y as f32 * 1e-3);
        let situation = Situation {
            field,
            own,
            phase: Phase::Run,
            rule_role: RuleRole::Player,
            ball: Some(at),
            placement: None,
            ball_in_play: true,
        };
        let reach = ROBOT_RADIUS + BALL_RADIUS;
        let mut around = (0..PLACES_AROUND_BALL).map(|i| {
            let (sin, cos) = (std::f32::consts::TAU * i as f32 / PLACES_AROUND_BALL as f32).sin_cos();
            Point::new(at.x() + reach * cos, at.y() + reach * sin)
        });
        let on_field = |robot: Point<Field>| robot.x().abs() <= 0.5 * field.length;
        !ball_is_out(field, at)
            && around.any(|robot| on_field(robot) && may_touch_ball(&situation, robot) == Touch::Allowed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIELD: FieldMm = FieldMm {
        length: 9000,
        width: 6000,
        margin: 300,
        goal_width: 1000,
        penalty_depth: 1000,
        penalty_width: 2000,
    };

    #[test]
    fn balls_out_in_goals_and_in_defence_areas_are_no_field_players() {
        let places = Playable::new("division-b", FIELD);
        // Attack frame: the own area at −x, the opponents' at +x.
        let table = [
            ([0, 0], true),
            ([4490, 2990], true),
            ([4400, 1200], true),
            // Beyond the lines, and in either goal.
            ([4530, 2500], false),
            ([0, -3030], false),
            ([4550, 0], false),
            ([-4550, 0], false),
            // In the opponents' area no part of a robot may be while it touches the ball.
            ([4000, 0], false),
            ([3550, 0], false),
            ([3450, 0], true),
            ([3600, 1100], true),
            // In the own a robot may be in part.
            ([-4000, 0], false),
            ([-3600, 0], true),
            ([-3720, 0], false),
        ];
        for ([x, y], expected) in table {
            assert_eq!(places.allows(PointMm::new(x, y), GoalEnd::Negative), expected, "{x}, {y}");
            assert_eq!(places.allows(PointMm::new(-x, -y), GoalEnd::Positive), expected, "{x}, {y} turned");
        }
    }

    #[test]
    fn four_legged_attackers_may_be_in_the_opponents_area() {
        let places = Playable::new("four-legged", FieldMm { length: 5400, width: 3600, ..FIELD });
        assert!(places.allows(PointMm::new(2600, 0), GoalEnd::Negative));
        assert!(!places.allows(PointMm::new(2800, 0), GoalEnd::Negative));
    }
}
