//! `kick`: detection of kicks: the robot, the speed, flat or chipped. m, m/s; times on vision's clock, µs.
//!
//! A kick is a turn that made the ball faster, or that a robot's front made of it; any other turn is a
//! bounce. After a kick the flight is estimated (see [`super::flight`]); once found, it is kept until the
//! ball touches the ground, then the known bounces follow until the ball rolls.

use geometry::{Body, Field, Point, Vector};
use motion::ball::chip::ChipPath;

use super::flight::{Flight, Launch, MOMENT_SIGMA_SHARP_S, MOMENT_SIGMA_VAGUE_S};
use super::track::{Glimpse, Turn};
use super::{Around, Balls};
use crate::tracking::filter::Plane;
use crate::tracking::robots::{Moved, micros, seconds};
use crate::tracking::seen::Captured;
use crate::world::BallModels;
use protocol::Who;

/// A robot whose centre is this near the ball may have touched it, m.
const TOUCHES_WITHIN_M: f32 = rules::contact::TOUCHES_WITHIN;
/// A robot this near can have turned the ball, m: hull, ball, and 7 cm that the robot moved since.
const TURNS_WITHIN_M: f32 = 0.18;
/// A contact ends this long after its last detection, s.
const CONTACT_KEPT_S: f32 = 0.1;
/// A contact is kept for this long, s, for chips that are detected late, within this distance, m.
const CHIP_CONTACT_KEPT_S: f32 = 0.25;
const CHIP_CONTACT_WITHIN_M: f32 = 0.4;
/// Slower balls are not kicked but rolled, m/s.
const KICK_SPEED_MIN_M_S: f32 = 0.5;
/// A kick makes the ball faster by this, m/s.
const KICK_GAIN_MIN_M_S: f32 = 0.3;
/// A kick is also a change of velocity at a robot's front by this, m/s.
const KICK_TURN_MIN_M_S: f32 = 0.8;
/// Where the old path and the new one are farther apart than this, the ball was placed there by hand or by a
/// script, m.
const PLACED_GAP_MIN_M: f32 = 0.3;
/// A kicked ball has stopped below this speed, m/s.
const STOPPED_SPEED_M_S: f32 = 0.05;
/// A flat kick's speed is computed from the distance covered in this time after it, s: two frames, until
/// robots may intercept it.
const REFINE_FROM_S: f32 = 0.03;
const REFINE_TO_S: f32 = 0.15;
/// Each step doubles the digits; the start is within a third.
const NEWTON_STEPS: usize = 3;
/// Uncertainty of a fitted flight's velocity, m/s, a landing's place, m, and the speed after a bounce, m/s.
const FLIGHT_SIGMA_M_S: f32 = 0.2;
const LANDING_SIGMA_M: f32 = 0.05;
const BOUNCE_SIGMA_M_S: f32 = 0.7;

/// State of the ball's height.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Air {
    /// On the ground as far as is known.
    #[default]
    Down,
    /// Just kicked: a flight would be detected soon.
    Watched(Launch),
    /// A ball in its first hop, estimated from these detections.
    Flying(Launch, Flight),
    /// Bouncing after its first touch.
    Hopping(Flight),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Kicked {
    pub(super) by: Option<Who>,
    pub(super) from: Point<Field>,
    pub(super) velocity: Vector<Field>,
    pub(super) climb: f32,
    pub(super) at: Captured,
}

/// The robot that has or had the ball at its front.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) who: Who,
    /// The ball's place in the robot's frame.
    pub(super) place: Point<Body>,
    /// Last detection of it there.
    pub(super) until: Captured,
    /// The ball's velocity before.
    before: Vector<Field>,
}

impl Balls {
    /// The ball has changed its direction: a kick, or a bounce.
    pub(super) fn turned(&mut self, turn: &Turn, around: Around<'_>) {
        let near = around.robots.nearest(turn.from, turn.at).filter(|(_, _, off)| *off <= TURNS_WITHIN_M);
        if let Air::Watched(launch) = &mut self.air
            && near.is_none()
        {
            // No robot was there to turn it: a ball in the air appears to turn.
            for glimpse in turn.sightings {
                launch.add(glimpse.apparent, glimpse.at, around.scene.camera(glimpse.camera));
            }
            return;
        }
        let hopped = matches!(self.air, Air::Hopping(_));
        self.air = Air::Down;
        self.kicked = None;
        if turn.gap > PLACED_GAP_MIN_M {
            return;
        }
        let (before, after) = (turn.before.norm(), turn.after.norm());
        if near.is_none() && self.showed_late(turn, around) {
            return;
        }
        let in_front = near.is_some_and(|(_, robot, _)| is_in_front(&robot, turn.from));
        let redirected = in_front && (turn.after - turn.before).norm() >= KICK_TURN_MIN_M_S;
        let by = near.map(|(who, _, _)| who);
        // Where no robot stands only a robot that no camera recognises can kick, and only a ball at
        // standstill is certainly kicked.
        let can_be_kicked = by.is_some() || (before < KICK_GAIN_MIN_M_S && !hopped);
        let faster = after >= before + KICK_GAIN_MIN_M_S && can_be_kicked;
        let kicked = after >= KICK_SPEED_MIN_M_S && (faster || redirected);
        if kicked {
            self.kick(by, turn.from, turn.after, turn.at, &around.scene.models);
        } else {
            self.counts.bounces += 1;
            self.set_rolls_below(around.scene.models.ground.switch * after);
        }
        // A chip towards the camera appears to move slowly at first, so every ball that leaves a robot's
        // front is watched.
        if kicked || in_front {
            let mut launch = Launch::new(turn.at, turn.from, by, MOMENT_SIGMA_SHARP_S);
            for glimpse in turn.sightings {
                launch.add(glimpse.apparent, glimpse.at, around.scene.camera(glimpse.camera));
            }
            self.air = Air::Watched(launch);
        }
    }

    /// A chip towards the camera may hardly appear to move while it rises: when the turn is detected at last,
    /// it was by the robot that had the ball just before.
    fn showed_late(&mut self, turn: &Turn, around: Around<'_>) -> bool {
        let Some(contact) =
            self.contact.filter(|contact| turn.at - contact.until <= micros(CHIP_CONTACT_KEPT_S))
        else {
            return false;
        };
        let Some(robot) = around.robots.robot(contact.who, contact.until) else { return false };
        let from = robot.pose.to_field(contact.place);
        if from.distance(turn.from) > CHIP_CONTACT_WITHIN_M
            || turn.after.norm() < turn.before.norm() + KICK_GAIN_MIN_M_S
        {
            return false;
        }
        self.kick(Some(contact.who), from, turn.after, contact.until, &around.scene.models);
        let mut launch = Launch::new(contact.until, from, Some(contact.who), MOMENT_SIGMA_VAGUE_S);
        for glimpse in turn.sightings {
            launch.add(glimpse.apparent, glimpse.at, around.scene.camera(glimpse.camera));
        }
        self.air = Air::Watched(launch);
        true
    }

    fn kick(
        &mut self,
        by: Option<Who>,
        from: Point<Field>,
        velocity: Vector<Field>,
        at: Captured,
        models: &BallModels,
    ) {
        self.counts.kicks += 1;
        self.kicked = Some(Kicked { by, from, velocity, climb: 0.0, at });
        self.contact = None;
        self.set_rolls_below(models.ground.switch * velocity.norm());
    }

    fn set_rolls_below(&mut self, speed: f32) {
        if let Some(track) = self.chosen.and_then(|index| self.tracks[index].as_mut()) {
            track.rolls_below = speed;
        }
    }

    fn put(&mut self, at: Captured, plane: Plane) {
        if let Some(track) = self.chosen.and_then(|index| self.tracks[index].as_mut()) {
            track.put(at, plane);
            // A ball that comes down from the air rolls.
            track.rolls_below = f32::INFINITY;
        }
    }

    /// Checks whether a watched kick flies.
    pub(super) fn watch(&mut self, glimpse: &Glimpse, around: Around<'_>) {
        let Air::Watched(launch) = &mut self.air else { return };
        launch.add(glimpse.apparent, glimpse.at, around.scene.camera(glimpse.camera));
        if !launch.is_ripe() {
            return;
        }
        let launch = *launch;
        if let Some(flight) = launch.flight(around.sigma, around.scene.models.ground.slide, false) {
            self.air = Air::Flying(launch, flight);
            self.counts.chips += 1;
            self.fly(&flight, glimpse.at, around.sigma);
        } else if launch.is_full() {
            self.air = Air::Down;
        }
    }

    /// Refines a flight with a detection of the flying ball.
    pub(super) fn see_flying(&mut self, glimpse: &Glimpse, around: Around<'_>) {
        let Air::Flying(launch, flight) = &mut self.air else { return };
        if !launch.is_full() {
            launch.add(glimpse.apparent, glimpse.at, around.scene.camera(glimpse.camera));
            let slide = around.scene.models.ground.slide;
            *flight = launch.flight(around.sigma, slide, true).unwrap_or(*flight);
        }
        let flight = *flight;
        self.fly(&flight, glimpse.at, around.sigma);
    }

    fn fly(&mut self, flight: &Flight, at: Captured, sigma: f32) {
        let Flight { at: launched, from, velocity, climb } = *flight;
        if let Air::Flying(launch, _) = &self.air {
            self.counts.kicks += u64::from(self.kicked.is_none());
            self.kicked = Some(Kicked { at: launched, from, velocity, climb, by: launch.by });
        }
        self.put(at, Plane::sent_off(flight.position(at), velocity, sigma, FLIGHT_SIGMA_M_S));
    }

    /// Switches to the next kind of motion of a chip when its time has come.
    pub(super) fn land(&mut self, now: Captured, models: &BallModels) {
        if let Air::Flying(_, flight) = self.air
            && now >= flight.lands()
        {
            self.air = Air::Hopping(flight);
            let velocity = flight.velocity * models.chip.first;
            let landing = flight.position(flight.lands());
            self.put(flight.lands(), Plane::sent_off(landing, velocity, LANDING_SIGMA_M, BOUNCE_SIGMA_M_S));
        }
        if let Air::Hopping(flight) = self.air
            && seconds(now - flight.at) >= hops(&flight, models).roll_time()
        {
            self.air = Air::Down;
        }
    }

    /// Height and climb of the ball, m and m/s.
    pub(super) fn height(&self, at: Captured, models: &BallModels) -> (f32, f32) {
        match &self.air {
            Air::Down | Air::Watched(_) => (0.0, 0.0),
            Air::Flying(_, flight) if at < flight.lands() => flight.height(at),
            Air::Flying(_, flight) | Air::Hopping(flight) => {
                let state = hops(flight, models).at(seconds(at - flight.at));
                if state.height > 0.0 { (state.height, state.rise) } else { (0.0, 0.0) }
            }
        }
    }

    /// Detects which robot's front the ball is at, and a ball pushed off without a sharp turn.
    pub(super) fn touch(&mut self, now: Captured, around: Around<'_>) {
        let Some(track) = self.chosen_track() else { return };
        let (position, velocity) = (track.plane.position, track.plane.velocity);
        if let Some((who, robot, off)) = around.robots.nearest(position, now)
            && off <= TOUCHES_WITHIN_M
            && is_in_front(&robot, position)
        {
            let same =
                self.contact.filter(|last| last.who == who && now - last.until <= micros(CONTACT_KEPT_S));
            let before = same.map_or(velocity, |contact| contact.before);
            self.contact = Some(Contact { who, place: robot.pose.to_body(position), until: now, before });
            if self.kicked.is_some_and(|kicked| now - kicked.at > micros(CHIP_CONTACT_KEPT_S)) {
                // Once another robot has the ball, the kick is over.
                self.kicked = None;
                self.air = Air::Down;
            }
            // A ball that a robot pushes turns and accelerates without flying.
            if matches!(&self.air, Air::Watched(launch) if now - launch.at > micros(CONTACT_KEPT_S)) {
                self.air = Air::Down;
            }
            return;
        }
        let Some(contact) = self.contact else { return };
        let Some(robot) = around.robots.robot(contact.who, now) else { return };
        let relative = (velocity - robot.velocity).norm();
        let changed = (velocity - contact.before).norm() >= KICK_TURN_MIN_M_S;
        let away = robot.pose.position.distance(position) > TURNS_WITHIN_M;
        if now - contact.until > micros(CHIP_CONTACT_KEPT_S) {
            self.contact = None;
        } else if now - contact.until <= micros(CONTACT_KEPT_S)
            && away
            && changed
            && relative >= KICK_SPEED_MIN_M_S
            && velocity.norm() >= KICK_SPEED_MIN_M_S
        {
            let from = robot.pose.to_field(contact.place);
            self.kick(Some(contact.who), from, velocity, contact.until, &around.scene.models);
        }
    }

    /// Refines a kick's speed by the distance the ball has covered.
    pub(super) fn refine(&mut self, models: &BallModels) {
        let Some(track) = self.chosen_track() else { return };
        let (Some(kicked), speed) = (self.kicked, track.plane.velocity.norm()) else { return };
        let time = seconds(track.at - kicked.at);
        if speed < STOPPED_SPEED_M_S {
            self.kicked = None;
        } else if kicked.climb == 0.0 && (REFINE_FROM_S..REFINE_TO_S).contains(&time) {
            let travelled = track.plane.position - kicked.from;
            let along = travelled.unit().unwrap_or_default();
            let velocity = along * launch_speed(travelled.norm(), time, models);
            self.kicked = Some(Kicked { velocity, ..kicked });
            self.set_rolls_below(models.ground.switch * velocity.norm());
        }
    }
}

/// Speed of a flat kick that covered this distance in that time: d = v t − a t² / 2 while it slides, from the
/// switch on as configured.
fn launch_speed(travelled: f32, time: f32, models: &BallModels) -> f32 {
    let sliding = travelled / time + 0.5 * models.ground.slide * time;
    let slides_for = sliding * (1.0 - models.ground.switch) / models.ground.slide;
    if time <= slides_for {
        return sliding;
    }
    // Slid for t_s = v (1 − c) / a, then rolled with c v: d = v² (1 − c²) / (2 a) + c v (t − t_s), solved for
    // v by two steps of Newton's starting from the speed of a ball without losses.
    let (c, a) = (models.ground.switch, models.ground.slide);
    let mut speed = travelled / time;
    for _ in 0..NEWTON_STEPS {
        let slid = speed * (1.0 - c) / a;
        let off = speed * speed * (1.0 - c * c) / (2.0 * a) + c * speed * (time - slid) - travelled;
        let slope = speed * (1.0 - c * c) / a + c * time - 2.0 * c * slid;
        speed -= off / slope.max(c * time * 0.1);
    }
    speed
}

/// A chip's whole path.
fn hops(flight: &Flight, models: &BallModels) -> ChipPath<Field> {
    models.chip.chipped(flight.from, flight.velocity, flight.climb, &models.ground)
}

fn is_in_front(robot: &Moved, ball: Point<Field>) -> bool {
    let ball = robot.pose.to_body(ball);
    ball.x() > 0.0 && ball.y().abs() <= ball.x()
}
