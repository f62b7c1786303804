//! `situation`: start of a match in a case's situation. Ball, players and opponents as the case's author drew
//! them, all other robots at free places of a kick-off. m, rad, field frame.

use arena::cases::LibraryHandle;
use arena::game::Game;
use casebase::CaseBase;
use geometry::{Angle, Field, GoalEnd, Point, Pose};
use protocol::{CaseId, RobotId, Who};
use rules::restart::kickoff_places;
use rules::state::RefereeCommand;
use rules::{Colour, FieldSpec};

/// Least distance to other robots and to the ball at which a robot without a place in the case is put, m: two
/// robots and as much free space between.
const CLEARANCE_M: f32 = 0.36;

/// Puts ball and robots as the case's author drew them, and forces a start; false where that is not possible
/// now.
pub(super) fn situate(game: &mut Game<'_>, library_handle: Option<&LibraryHandle>, name: &str) -> bool {
    let field = game.config().league.field();
    let present: Vec<Who> =
        game.world().robots().iter().filter(|robot| robot.present).map(|robot| robot.who).collect();
    let keepers = [Colour::Blue, Colour::Yellow].map(|team| game.config().referee.team(team).keeper);
    let blue_goal = game.host(Colour::Blue).game().own_goal(Colour::Blue);
    let Some((library_handle, blue_goal)) = library_handle.zip(blue_goal) else { return false };
    let sides = Sides { field: &field, blue_goal, present: &present, keepers };
    let Some(situation) = of_case(library_handle, name, &sides) else { return false };
    if !game.command(RefereeCommand::ForceStart) {
        return false;
    }
    for (who, pose) in situation.robots {
        game.put_robot(who, pose);
    }
    game.move_ball(situation.ball, true);
    true
}

/// Teams and robots of the match.
pub(super) struct Sides<'a> {
    pub(super) field: &'a FieldSpec,
    /// The goal that blue defends.
    pub(super) blue_goal: GoalEnd,
    /// All robots on the field.
    pub(super) present: &'a [Who],
    /// The keepers, blue's and yellow's.
    pub(super) keepers: [RobotId; 2],
}

impl Sides<'_> {
    fn keeper(&self, team: Colour) -> RobotId {
        self.keepers[usize::from(team == Colour::Yellow)]
    }

    fn own(&self, team: Colour) -> GoalEnd {
        if team == Colour::Blue { self.blue_goal } else { self.blue_goal.opposite() }
    }

    fn in_area(&self, goal: GoalEnd, at: Point<Field>) -> bool {
        let deep = (self.field.goal_line(goal) - at.x()).abs();
        deep < self.field.penalty_depth && at.y().abs() < self.field.penalty_width * 0.5
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Situation {
    pub(super) ball: Point<Field>,
    pub(super) robots: Vec<(Who, Pose<Field>)>,
}

/// The situation of the case of that name; `None` if there is no such case.
pub(super) fn of_case(library_handle: &LibraryHandle, name: &str, sides: &Sides<'_>) -> Option<Situation> {
    let authored = library_handle.names().iter().position(|known| known == name)?;
    place(&library_handle.base(), CaseId(u16::try_from(authored * 4).ok()?), sides)
}

fn place(base: &CaseBase<'_>, id: CaseId, sides: &Sides<'_>) -> Option<Situation> {
    let case = base.case(id)?;
    let attackers = if case.defending() == sides.blue_goal { Colour::Blue } else { Colour::Yellow };
    let ball = Point::<Field>::from(case.ball());
    let mut teammates = case.robots().map(|robot| Point::from(case.position(robot)));
    let opponents: Vec<_> = case.opponents().map(|(centre, _)| Point::from(centre)).collect();
    let mut robots: Vec<(Who, Pose<Field>)> = Vec::new();
    let put = |colour: Colour,
               places: &mut dyn Iterator<Item = Point<Field>>,
               out: &mut Vec<(Who, Pose<Field>)>| {
        let keeper = sides.keeper(colour);
        let players = sides.present.iter().filter(|who| who.colour == colour && who.id != keeper);
        out.extend(players.zip(places).map(|(who, at)| (*who, facing(at, ball))));
    };
    put(attackers, &mut teammates, &mut robots);
    // An opponent drawn in its own area is its keeper.
    let goal = sides.own(attackers.other());
    let guard = opponents.iter().copied().find(|at| sides.in_area(goal, *at));
    if let Some(at) = guard {
        let who = Who { colour: attackers.other(), id: sides.keeper(attackers.other()) };
        robots.extend(sides.present.contains(&who).then(|| (who, facing(at, ball))));
    }
    let mut others = opponents.into_iter().filter(|at| Some(*at) != guard);
    put(attackers.other(), &mut others, &mut robots);
    for who in sides.present {
        if robots.iter().any(|(placed, _)| placed == who) {
            continue;
        }
        let places = kickoff_places(sides.field, sides.own(who.colour), false);
        // The first of the places is the keeper's; if it is occupied, the keeper stands beside it.
        let beside = places[0];
        let keeps =
            [0.0, CLEARANCE_M + 0.05, -CLEARANCE_M - 0.05].map(|y| Point::new(beside.x(), beside.y() + y));
        let places = if who.id == sides.keeper(who.colour) { &keeps[..] } else { &places[1..] };
        let clear = |at: &&Point<Field>| {
            at.distance(ball) > CLEARANCE_M
                && robots.iter().all(|(_, pose)| pose.position.distance(**at) > CLEARANCE_M)
        };
        let free = places.iter().find(clear).or(places.first())?;
        robots.push((*who, facing(*free, ball)));
    }
    Some(Situation { ball, robots })
}

fn facing(at: Point<Field>, ball: Point<Field>) -> Pose<Field> {
    let heading = if at.distance(ball) > 0.0 { at.direction_to(ball) } else { Angle::ZERO };
    Pose { position: at, heading }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    fn all_robots() -> Vec<Who> {
        let ids = || (0..6).filter_map(RobotId::new);
        let of = |colour| ids().map(move |id| Who { colour, id });
        of(Colour::Blue).chain(of(Colour::Yellow)).collect()
    }

    #[test]
    fn every_case_of_division_b_is_set_up_with_no_robot_on_another() {
        let library_handle = LibraryHandle::named(League::DivisionB.name()).unwrap();
        let field = League::DivisionB.field();
        let present = all_robots();
        for blue_goal in [GoalEnd::Negative, GoalEnd::Positive] {
            let sides = Sides { field: &field, blue_goal, present: &present, keepers: [RobotId::ZERO; 2] };
            for (i, name) in library_handle.names().iter().enumerate() {
                let case = library_handle.base().case(CaseId(i as u16 * 4)).unwrap();
                let situation = of_case(&library_handle, name, &sides).unwrap();
                assert_eq!(situation.robots.len(), 12, "{name}");
                let attackers = if case.defending() == blue_goal { Colour::Blue } else { Colour::Yellow };
                for robot in case.robots() {
                    let at = Point::from(case.position(robot));
                    let there = situation.robots.iter().find(|(_, pose)| pose.position == at);
                    assert_eq!(there.map(|(who, _)| who.colour), Some(attackers), "{name}");
                }
                let places: Vec<_> = situation.robots.iter().map(|(_, pose)| pose.position).collect();
                for (n, at) in places.iter().enumerate() {
                    let others = &places[n + 1..];
                    assert!(others.iter().all(|other| at.distance(*other) > 0.17), "{name}: {places:?}");
                    assert!(field.surface().contains(*at), "{name}");
                }
            }
            assert_eq!(of_case(&library_handle, "no/such-case", &sides), None);
        }
    }
}
