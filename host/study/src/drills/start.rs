//! `start`: starts of drills, drawn around recorded situations: a moment, mirrored or not, every place moved
//! a little, and the drill's own robots and ball put where it needs them. m, m/s, rad; ours defend −x.

use std::f32::consts::{FRAC_PI_2, PI};

use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use hil_sim::Stream;
use hil_sim::small_size::Ball;
use rules::restart::nearest_free_kick_spot;
use rules::{FieldSpec, League, RobotSpec};

use super::DrillKind;
use super::situations::{Situation, SituationFrame};

/// The end that ours defend.
pub(super) const OUR_END: GoalEnd = GoalEnd::Negative;
/// From a robot's centre to the centre of a ball at its dribbler, m: front and ball of the nominal robot.
pub(super) const BALL_AHEAD_M: f32 = RobotSpec::OURS.hull.ball_at();

/// How play begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Opening {
    /// The ball is in play.
    OpenPlay,
    /// Our free kick, from where the ball lies.
    OurFreeKick,
    /// Their free kick.
    TheirFreeKick,
}

#[derive(Clone, Debug)]
pub(super) struct DrillStart {
    pub(super) league: League,
    /// Ours, by number; the keeper is 0.
    pub(super) ours: Vec<Pose<Field>>,
    pub(super) theirs: Vec<Pose<Field>>,
    pub(super) ball: Ball,
    pub(super) opening: Opening,
    /// Number of the opponent that acts first: carrier, marker, kicker of the cross.
    pub(super) lead: usize,
    /// Number of the opponent that shoots the cross, and where it does.
    pub(super) shooter: Option<(usize, Point<Field>)>,
    /// Times for which a carrier goes to one side before it turns back, in turn, s.
    pub(super) legs_s: [f32; LEGS],
}

/// Moments of which a drill can be drawn: for each situation its frames. Situations of the kind that the
/// drill imitates, or of any kind where there is none.
pub(super) fn moments(drill: DrillKind, situations: &[Situation]) -> Vec<(usize, Vec<usize>)> {
    let of = |wanted: &dyn Fn(&Situation) -> bool| -> Vec<(usize, Vec<usize>)> {
        let all = situations.iter().enumerate().filter(|(_, situation)| wanted(situation));
        let with_frames = all.map(|(number, situation)| {
            let frames = situation.frames.iter().enumerate();
            let suited = frames.filter(|(_, frame)| suits(drill, situation.league, frame));
            (number, suited.map(|(frame, _)| frame).collect::<Vec<_>>())
        });
        with_frames.filter(|(_, frames)| !frames.is_empty()).collect()
    };
    let meant = of(&|situation| imitates(drill, situation));
    if meant.is_empty() { of(&|_| true) } else { meant }
}

fn imitates(drill: DrillKind, situation: &Situation) -> bool {
    match drill {
        DrillKind::Marker => situation.kind == "own free kick" && situation.note == "own half",
        DrillKind::Carrier => situation.note == "F9",
        DrillKind::Cross => situation.note == "F10",
        DrillKind::Rebound | DrillKind::GoalLine => situation.note == "F5",
        DrillKind::Shielder => situation.kind == "goal against",
        DrillKind::Contested => true,
    }
}

fn suits(drill: DrillKind, league: League, frame: &SituationFrame) -> bool {
    let field = league.field();
    let from_area = field.distance_to_area(OUR_END, frame.ball);
    let at_ball = nearest(&frame.theirs, frame.ball).map_or(f32::INFINITY, |(_, distance)| distance);
    match drill {
        DrillKind::Carrier => (0.1..CARRIER_FROM_AREA_MAX_M).contains(&from_area) && at_ball < AT_BALL_M,
        DrillKind::Shielder => from_area > 0.3 && frame.ball.x() < -0.3 && at_ball < AT_BALL_M,
        DrillKind::Marker => frame.ball.x() < 0.0 && from_area > 0.0 && frame.time_s.abs() < 0.5,
        DrillKind::Cross => (-6.0..-0.5).contains(&frame.time_s),
        DrillKind::Rebound | DrillKind::GoalLine => frame.ball.x() < 0.0,
        DrillKind::Contested => {
            let ends = [GoalEnd::Negative, GoalEnd::Positive];
            let off_areas = ends.map(|end| field.distance_to_area(end, frame.ball));
            off_areas.iter().all(|off| *off > CONTESTED_OFF_M)
        }
    }
}

/// The start of try `number`; `None` where no moment suits the drill.
pub(super) fn draw(
    drill: DrillKind,
    situations: &[Situation],
    moments: &[(usize, Vec<usize>)],
    chance: &mut Stream,
) -> Option<DrillStart> {
    let (situation, frames) = one_of(chance, moments)?;
    let situation = situations.get(*situation)?;
    let frame = situation.frames.get(*one_of(chance, frames)?)?;
    let mirror = if chance.chance(0.5) { -1.0 } else { 1.0 };
    let mut moved = |pose: &Pose<Field>| Pose {
        position: Point::new(
            pose.position.x() + chance.between(-MOVED_MAX_M, MOVED_MAX_M),
            mirror * pose.position.y() + chance.between(-MOVED_MAX_M, MOVED_MAX_M),
        ),
        heading: Angle::new(mirror * pose.heading.radians()),
    };
    let ours: Vec<_> = frame.ours.iter().map(&mut moved).collect();
    let theirs: Vec<_> = frame.theirs.iter().map(&mut moved).collect();
    let ball = Point::new(frame.ball.x(), mirror * frame.ball.y());
    let lead = nearest(&theirs, ball)?.0;
    let mut start = DrillStart {
        league: situation.league,
        ours,
        theirs,
        ball: Ball::at(ball),
        opening: Opening::OpenPlay,
        lead,
        shooter: None,
        legs_s: [0.0; LEGS],
    };
    let field = situation.league.field();
    match drill {
        DrillKind::Carrier | DrillKind::Shielder => start.give_ball_to_lead(&field, chance),
        DrillKind::Marker => start.mark_free_kick(&field, chance),
        DrillKind::Cross => start.prepare_cross(&field, chance)?,
        DrillKind::Rebound => start.put_before_keeper(&field, chance),
        DrillKind::GoalLine => start.put_at_goal_line(&field, chance),
        DrillKind::Contested => start.contest(&field, chance)?,
    }
    start.make_legal(&field);
    start.legs_s = [(); LEGS].map(|()| chance.between(LEG_MIN_S, LEG_MAX_S));
    Some(start)
}

impl DrillStart {
    /// The lead has the ball at its dribbler, turned roughly to our goal.
    fn give_ball_to_lead(&mut self, field: &FieldSpec, chance: &mut Stream) {
        let lead = &mut self.theirs[self.lead];
        let goal = field.goal_center(OUR_END);
        let off = [chance.between(-0.25, 0.25), chance.between(-0.25, 0.25)];
        let wanted = lead.position + Vector::new(off[0], off[1]);
        // Ball and hull outside our area.
        lead.position = off_area(field, wanted, BALL_AHEAD_M + 0.1);
        lead.heading = lead.position.direction_to(goal) + Angle::new(chance.between(-0.5, 0.5));
        self.ball = Ball::at(lead.position + Vector::polar(BALL_AHEAD_M, lead.heading));
    }

    /// Our free kick, and the marker near the ball as the rules permit.
    fn mark_free_kick(&mut self, field: &FieldSpec, chance: &mut Stream) {
        let spot = self
            .league
            .limits()
            .map_or(self.ball.position, |limits| nearest_free_kick_spot(field, &limits, self.ball.position));
        self.ball = Ball::at(spot);
        let lead = &mut self.theirs[self.lead];
        let towards = spot.direction_to(lead.position) + Angle::new(chance.between(-0.4, 0.4));
        let distance = chance.between(MARKER_OFF_MIN_M, MARKER_OFF_MAX_M);
        lead.position = spot + Vector::polar(distance, towards);
        lead.heading = towards + Angle::HALF_TURN;
        self.opening = Opening::OurFreeKick;
    }

    /// Their free kick from the touch line, and one of theirs near where it shall shoot.
    fn prepare_cross(&mut self, field: &FieldSpec, chance: &mut Stream) -> Option<()> {
        let side = if chance.chance(0.5) { 1.0 } else { -1.0 };
        let line = field.goal_line(OUR_END);
        let wanted = Point::new(
            line + chance.between(CROSS_FROM_CORNER_M - 0.3, CROSS_FROM_CORNER_M + 0.3),
            side * (0.5 * field.width - 0.2),
        );
        let limits = self.league.limits()?;
        let spot = nearest_free_kick_spot(field, &limits, wanted);
        let at = Point::new(line + SHOT_FROM_LINE_M, side * chance.between(-0.4, 0.6));
        self.ball = Ball::at(spot);
        self.lead = nearest(&self.theirs, spot)?.0;
        let goal_side = spot.direction_to(at);
        let kicker = Pose {
            position: spot + Vector::polar(KICKER_BACK_M, goal_side + Angle::HALF_TURN),
            heading: goal_side,
        };
        let lead = self.lead;
        self.theirs[lead] = kicker;
        let others = self.theirs.iter().enumerate().filter(|(number, _)| *number != lead);
        let (shooter, distance) = others
            .map(|(number, pose)| (number, pose.position.distance(at)))
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        if distance > RUN_MAX_M {
            let from =
                at + Vector::polar(chance.between(0.5, RUN_MAX_M), Angle::new(chance.between(-1.2, 1.2)));
            self.theirs[shooter].position = from;
        }
        self.shooter = Some((shooter, at));
        self.opening = Opening::TheirFreeKick;
        Some(())
    }

    /// A slow ball in front of our keeper, an opponent a metre from it.
    fn put_before_keeper(&mut self, field: &FieldSpec, chance: &mut Stream) {
        let keeper = self.place_keeper(field, chance);
        let direction = Angle::new(chance.between(-1.2, 1.2));
        let ball = keeper + Vector::polar(chance.between(KEEPER_BALL_MIN_M, KEEPER_BALL_MAX_M), direction);
        let velocity: Vector<Field> =
            Vector::polar(chance.between(0.0, REBOUND_SPEED_MAX_M_S), Angle::new(chance.between(-PI, PI)));
        // Not into the goal: what would be one is the keeper's save, not its clearance.
        let velocity = Vector::new(velocity.x().abs() * 0.5, velocity.y());
        self.ball = Ball::rolling(ball, velocity);
        self.oppose(field, ball, chance.between(0.9, 1.1), chance);
    }

    /// A ball at our goal line: between the posts, beside a post, or inside the area's edge.
    fn put_at_goal_line(&mut self, field: &FieldSpec, chance: &mut Stream) {
        self.place_keeper(field, chance);
        let side = if chance.chance(0.5) { 1.0 } else { -1.0 };
        let half_goal = 0.5 * field.goal_width;
        let y = match chance.whole(0, 2) {
            0 => chance.between(0.0, half_goal - 0.05),
            1 => chance.between(half_goal + 0.03, half_goal + 0.15),
            _ => 0.5 * field.penalty_width - chance.between(0.03, 0.1),
        };
        let ball = Point::new(field.goal_line(OUR_END) + chance.between(0.0, 0.05), side * y);
        self.ball = Ball::at(ball);
        self.oppose(field, ball, chance.between(0.9, 1.3), chance);
    }

    /// Our keeper before its goal; returns its place.
    fn place_keeper(&mut self, field: &FieldSpec, chance: &mut Stream) -> Point<Field> {
        let line = field.goal_line(OUR_END);
        let half = 0.5 * field.goal_width;
        let at = Point::new(line + chance.between(0.12, 0.4), chance.between(-half, half));
        let heading = Angle::new(chance.between(-0.6, 0.6));
        self.ours[0] = Pose { position: at, heading };
        at
    }

    /// The nearest opponent stands this far from the ball, away from our goal line and outside our area.
    fn oppose(&mut self, field: &FieldSpec, ball: Point<Field>, distance: f32, chance: &mut Stream) {
        let Some((lead, _)) = nearest(&self.theirs, ball) else { return };
        let direction = Angle::new(chance.between(-0.8, 0.8));
        let at = off_area(field, ball + Vector::polar(distance, direction), AREA_OFF_M);
        self.theirs[lead] = Pose { position: at, heading: at.direction_to(ball) };
        self.lead = lead;
    }

    /// A ball at rest between one of ours and one of theirs; the two mates next to it are marked.
    fn contest(&mut self, field: &FieldSpec, chance: &mut Stream) -> Option<()> {
        let ball = self.ball.position;
        let mut mates: Vec<usize> = (1..self.ours.len()).collect();
        mates.sort_by(|a, b| {
            self.ours[*a].position.distance(ball).total_cmp(&self.ours[*b].position.distance(ball))
        });
        let [player, marked @ ..] = mates.as_slice() else { return None };
        let from = Angle::new(chance.between(-PI, PI));
        self.ours[*player] = facing(ball, from, PLAYER_OFF_M, chance);
        // Bodies at the ball leave each other room.
        let beside = Angle::new(chance.between(CONTESTED_APART_RAD, 2.0 * PI - CONTESTED_APART_RAD));
        let lead = self.lead;
        self.theirs[lead] =
            facing(ball, from + beside, chance.between(OPPONENT_OFF_MIN_M, OPPONENT_OFF_MAX_M), chance);
        let markers: Vec<usize> = (0..self.theirs.len()).filter(|number| *number != lead).collect();
        for (mate, marker) in marked.iter().take(MARKED_MATES).zip(markers) {
            let mate = self.ours[*mate].position;
            let at = mate + (ball - mate).unit()? * MARKER_OFF_MATE_M;
            self.theirs[marker] = Pose { position: off_area(field, at, AREA_OFF_M), heading: from };
        }
        Some(())
    }

    /// Robots outside areas that are closed to them, on the field, off the ball and off each other.
    fn make_legal(&mut self, field: &FieldSpec) {
        let (lead, shooter) = (self.lead, self.shooter.map(|(shooter, _)| shooter));
        let ball = self.ball.position;
        let off_ball = if self.opening == Opening::OpenPlay { BODIES_APART_M } else { RESTART_OFF_M };
        for _ in 0..PUSHES {
            for pose in self.ours.iter_mut().skip(1) {
                pose.position = off_area(field, pushed_off(pose.position, ball, off_ball), AREA_OFF_M);
            }
            for (number, pose) in self.theirs.iter_mut().enumerate() {
                if number != lead {
                    pose.position = off_area(field, pushed_off(pose.position, ball, off_ball), AREA_OFF_M);
                }
                if number != lead && Some(number) != shooter {
                    pose.position = field.clamp(pose.position, 0.1);
                }
            }
            self.push_apart(lead, shooter);
        }
    }

    fn push_apart(&mut self, lead: usize, shooter: Option<usize>) {
        let all: Vec<(usize, usize, Point<Field>)> = [&self.ours, &self.theirs]
            .into_iter()
            .enumerate()
            .flat_map(|(team, poses)| {
                poses.iter().enumerate().map(move |(number, pose)| (team, number, pose.position))
            })
            .collect();
        for (team, number, at) in &all {
            let fixed = if *team == 0 { *number == 0 } else { *number == lead || Some(*number) == shooter };
            if fixed {
                continue;
            }
            let mut moved = *at;
            for (other_team, other, place) in &all {
                if (team, number) != (other_team, other) {
                    moved = pushed_off(moved, *place, BODIES_APART_M);
                }
            }
            let poses = if *team == 0 { &mut self.ours } else { &mut self.theirs };
            poses[*number].position = moved;
        }
    }
}

/// A pose at that direction and distance from the ball, turned roughly to it.
fn facing(ball: Point<Field>, direction: Angle, distance: f32, chance: &mut Stream) -> Pose<Field> {
    let off = Angle::new(chance.between(-FACES_OFF_MAX_RAD, FACES_OFF_MAX_RAD));
    Pose { position: ball + Vector::polar(distance, direction), heading: direction + Angle::HALF_TURN + off }
}

/// The pose nearest to a place, by number, with its distance.
pub(super) fn nearest(poses: &[Pose<Field>], place: Point<Field>) -> Option<(usize, f32)> {
    let distances = poses.iter().map(|pose| pose.position.distance(place)).enumerate();
    distances.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn one_of<'s, T>(chance: &mut Stream, of: &'s [T]) -> Option<&'s T> {
    let last = u32::try_from(of.len().checked_sub(1)?).ok()?;
    of.get(chance.whole(0, last) as usize)
}

fn pushed_off(at: Point<Field>, from: Point<Field>, distance: f32) -> Point<Field> {
    let away = at - from;
    if away.norm() >= distance {
        return at;
    }
    from + away.unit().unwrap_or(Vector::new(1.0, 0.0)) * distance
}

/// The place, or the nearest one at least `off` outside our area.
pub(super) fn off_area(field: &FieldSpec, at: Point<Field>, off: f32) -> Point<Field> {
    let mut at = at;
    let goal = field.goal_center(OUR_END);
    let out = (at - goal).unit().unwrap_or(Vector::polar(1.0, Angle::ZERO));
    // Along the ray from the goal, never along its line: that would end behind it.
    let out =
        if out.x() < 0.2 { Vector::polar(1.0, Angle::new(FRAC_PI_2 * 0.8 * at.y().signum())) } else { out };
    for _ in 0..200 {
        if field.distance_to_area(OUR_END, at) >= off {
            break;
        }
        at += out * 0.02;
    }
    at
}

/// Every place is moved by at most this in each direction, m.
const MOVED_MAX_M: f32 = 0.08;
/// An opponent this near the ball has it, or had it a moment ago, m.
const AT_BALL_M: f32 = 0.3;
/// A carrier begins at most this far from our area, m.
const CARRIER_FROM_AREA_MAX_M: f32 = 1.6;
/// The champions' carriers turned back after these times, s: 9 of 11 turns of the recorded goals.
const LEG_MIN_S: f32 = 0.2;
const LEG_MAX_S: f32 = 0.7;
/// Legs that a carrier goes at most: longer than it has the ball.
pub(super) const LEGS: usize = 12;
/// Distance of the marker from the ball, m: as the champions' stood.
const MARKER_OFF_MIN_M: f32 = 0.6;
const MARKER_OFF_MAX_M: f32 = 0.8;
/// Distance of their free kick from the corner, m.
const CROSS_FROM_CORNER_M: f32 = 2.5;
/// Distance of the first-touch shot from our goal line, m.
const SHOT_FROM_LINE_M: f32 = 2.4;
/// Distance of their kicker's centre behind the ball, m.
const KICKER_BACK_M: f32 = 0.25;
/// The shooter runs at most this far, m: while the ball is on its way.
const RUN_MAX_M: f32 = 1.2;
/// Distance of a rebound from our keeper's centre, m.
const KEEPER_BALL_MIN_M: f32 = 0.16;
const KEEPER_BALL_MAX_M: f32 = 0.3;
/// Speed of a rebound, m/s.
const REBOUND_SPEED_MAX_M_S: f32 = 0.6;
/// A contested ball lies this far from both areas, m: keepers take no part.
const CONTESTED_OFF_M: f32 = 0.5;
/// Distances of the centres of our robot and of the opponent from a contested ball, m.
const PLAYER_OFF_M: f32 = 0.3;
const OPPONENT_OFF_MIN_M: f32 = 0.3;
const OPPONENT_OFF_MAX_M: f32 = 1.0;
/// Least angle at a contested ball between the two, rad: their centres are 0.3 m apart.
const CONTESTED_APART_RAD: f32 = 1.05;
/// They look past it by at most this angle, rad.
const FACES_OFF_MAX_RAD: f32 = 0.8;
/// Number of our robots that are marked, and distance of a marker, m, on the ball's side.
const MARKED_MATES: usize = 2;
const MARKER_OFF_MATE_M: f32 = 0.4;
/// Distance of a robot's centre from our area, m.
const AREA_OFF_M: f32 = 0.12;
/// Distance between two centres, m: two bodies and a gap.
const BODIES_APART_M: f32 = 0.2;
/// Distance from the ball of a free kick, m: the rules' 0.5, a body, noise of the cameras.
const RESTART_OFF_M: f32 = 0.6;
/// Rounds of pushing robots off each other.
const PUSHES: usize = 4;
