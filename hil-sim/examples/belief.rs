//! `belief`: errors of a walking robot's belief in the robots' world, by level of noise: the table of
//! `docs/belief.md`.
//!
//! `cargo run --release -p onetwo-hil-sim --example belief` prints it as Markdown. A robot walks around a
//! ball that rests and is kicked at times, for two minutes of 30 seeds; errors are taken in every step from
//! the third second on. "Last look" is what the brain did without estimators: the newest sight as it is, put
//! on the field by the same pose, with an alpha–beta velocity.

use brain::belief::REST_SPEED;
use brain::belief::camera::Perception;
use geometry::{Angle, Body, Field, Point, Pose, Twist, Vector};
use hil_sim::four_legged::sensors::Senses;
use hil_sim::four_legged::world::{LeggedWorld, Side, Walker};
use hil_sim::{Noise, Parameters, Stream};
use protocol::Instant;
use protocol::robot_io::{ActuatorFrame, LeggedPrimitive};

const DT: f32 = 0.04;
const SEEDS: u64 = 30;
const STEPS: u32 = 3_000;
const WARM_UP: u32 = 75;

fn main() {
    println!("LeggedWorld {}, {SEEDS} seeds of {} s.\n", hil_sim::world_hash(), STEPS as f32 * DT);
    println!(
        "| noise | pose (m) | heading (°) | NEES of the pose (3) | ball, own frame (m) | last look (m) | ball, field (m) | \
         velocity (m/s) | last look (m/s) | stop position, median (m) | last look (m) | at rest within 1.2 m believed so (%) | \
         last look (%) |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for level in [0.5, 1.0, 2.0] {
        let mut errors = Errors::default();
        for seed in 0..SEEDS {
            play(level, seed, &mut errors);
        }
        errors.print(level);
    }
}

#[derive(Default)]
struct Errors {
    pose: Mean,
    heading: Mean,
    nees: Mean,
    body: Mean,
    body_last: Mean,
    field: Mean,
    velocity: Mean,
    velocity_last: Mean,
    stop: Vec<f32>,
    stop_last: Vec<f32>,
    rest: Mean,
    rest_last: Mean,
}

#[derive(Default)]
struct Mean {
    sum: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f32) {
        self.sum += f64::from(value);
        self.count += 1;
    }

    fn get(&self) -> f64 {
        self.sum / f64::from(self.count.max(1))
    }

    fn root(&self) -> f64 {
        self.get().sqrt()
    }
}

fn median(values: &mut [f32]) -> f32 {
    values.sort_by(f32::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}

impl Errors {
    fn print(mut self, level: f32) {
        println!(
            "| {level} × | {:.3} | {:.1} | {:.2} | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} | {:.1} | {:.1} |",
            self.pose.root(),
            self.heading.root().to_degrees(),
            self.nees.get(),
            self.body.root(),
            self.body_last.root(),
            self.field.root(),
            self.velocity.root(),
            self.velocity_last.root(),
            median(&mut self.stop),
            median(&mut self.stop_last),
            100.0 * self.rest.get(),
            100.0 * self.rest_last.get(),
        );
    }
}

/// The world's noise, its standard deviations times `level`.
fn noise(level: f32) -> Noise {
    let noise = Parameters::four_legged().noise;
    Noise {
        pixel_deg: noise.pixel_deg * level,
        range_floor: noise.range_floor * level,
        joint_deg: noise.joint_deg * level,
        sway_deg: noise.sway_deg * level,
        odometry_scale: noise.odometry_scale * level,
        odometry_slip: noise.odometry_slip * level,
        placing: noise.placing * level,
        placing_deg: noise.placing_deg * level,
        ..noise
    }
}

/// The newest sight: in the body's frame, on the field, with its velocity there, and its step.
type Look = (Point<Body>, Point<Field>, Vector<Field>, u32);

/// What a brain without estimators believes.
#[derive(Default)]
struct LastLook {
    at: Option<Look>,
}

impl LastLook {
    fn see(&mut self, step: u32, seen: Point<Body>, pose: Pose<Field>) {
        let at = pose.to_field(seen);
        let (place, velocity) = match self.at {
            Some((_, place, velocity, before)) if step > before => {
                let dt = (step - before) as f32 * DT;
                let predicted = place + velocity * dt;
                let miss = at - predicted;
                (predicted + miss * 0.5, velocity + miss * (0.2 / dt))
            }
            _ => (at, Vector::default()),
        };
        self.at = Some((seen, place, velocity, step));
    }
}

fn play(level: f32, seed: u64, errors: &mut Errors) {
    let parameters = Parameters::four_legged();
    let mut chance = Stream::new(seed, "script");
    let at = Point::new(chance.between(-1.5, 1.0), chance.between(-1.0, 1.0));
    let walker = Walker::at(Side::Attackers, Pose { position: at, heading: Angle::ZERO });
    let mut world = LeggedWorld::new(parameters, seed, Point::new(at.x() + 0.8, at.y()), vec![walker]);
    let mut senses = Senses::new(noise(level), seed, 0, DT);
    let (mut perception, mut last) = (Perception::default(), LastLook::default());
    let deceleration = parameters.ball.deceleration;
    let mut events = Vec::new();
    let mut target = Vector::<Field>::default();
    for step in 0..STEPS {
        let now = Instant(u64::from(step) * 40_000);
        let sensors = senses.look(&world, 0, [], DT);
        let Some(camera) = sensors.camera.clone() else { return };
        perception.update(now, &sensors, &camera, deceleration);
        let pose = perception.pose.pose();
        if let Some(sight) = camera.ball {
            let seen = Vector::<Body>::polar(sight.range(), sight.bearing());
            last.see(step, Point::new(seen.x(), seen.y()), pose);
        }
        if step >= WARM_UP {
            measure(&world, &perception, &last, step, deceleration, errors);
        }
        // Around the ball, facing it, to another place every three seconds; a kick every seven.
        if step.is_multiple_of(75) {
            target = Vector::polar(chance.between(0.4, 1.4), Angle::new(chance.between(-3.1, 3.1)));
        }
        if step % 175 == 174 {
            let to = Point::new(chance.between(-1.5, 1.5), chance.between(-1.0, 1.0));
            world.ball.send(deceleration, (to - world.ball.position).clamped(1.5));
        }
        let true_pose = world.walkers[0].pose;
        let path = true_pose.vector_to_body(world.ball.position + target - true_pose.position);
        let turn = true_pose.turn_to(world.ball.position).radians();
        let walk = Twist { linear: path.clamped(0.3), angular: 2.0 * turn };
        world.command(0, &ActuatorFrame::Legged { walk, primitive: LeggedPrimitive::None });
        (0..4).for_each(|_| world.step());
        world.take_events(&mut events);
        events.clear();
    }
}

fn measure(
    world: &LeggedWorld,
    perception: &Perception,
    last: &LastLook,
    step: u32,
    deceleration: f32,
    errors: &mut Errors,
) {
    let (truth, pose) = (world.walkers[0].pose, perception.pose.pose());
    let off = pose.position - truth.position;
    let turned = (pose.heading - truth.heading).radians();
    errors.pose.add(off.dot(off));
    errors.heading.add(turned * turned);
    errors.nees.add(nees(perception.pose.covariance(), [off.x(), off.y(), turned]));
    let ball = world.ball;
    let resting = ball.velocity == Vector::default();
    let near = truth.position.distance(ball.position) < 1.2;
    if let Some(believed) = &perception.ball {
        let body = believed.place() - truth.to_body(ball.position);
        errors.body.add(body.dot(body));
        let place = pose.to_field(believed.place());
        let field = place - ball.position;
        errors.field.add(field.dot(field));
        let velocity = pose.vector_to_field(believed.velocity());
        let miss = velocity - ball.velocity;
        errors.velocity.add(miss.dot(miss));
        errors.stop.push(stop(place, velocity, deceleration).distance(ball.rest(deceleration)));
        if resting && near {
            errors.rest.add(if velocity.norm() < REST_SPEED { 1.0 } else { 0.0 });
        }
    }
    // As the brain did: a sight counts for 0.4 s.
    if let Some((seen, place, velocity, at)) = last.at
        && step - at <= 10
    {
        let body = seen - truth.to_body(ball.position);
        errors.body_last.add(body.dot(body));
        let miss = velocity - ball.velocity;
        errors.velocity_last.add(miss.dot(miss));
        errors.stop_last.push(stop(place, velocity, deceleration).distance(ball.rest(deceleration)));
        if resting && near {
            errors.rest_last.add(if velocity.norm() < REST_SPEED { 1.0 } else { 0.0 });
        }
    }
}

fn stop(place: Point<Field>, velocity: Vector<Field>, deceleration: f32) -> Point<Field> {
    place + velocity * (velocity.norm() / (2.0 * deceleration))
}

/// Normalised squared error of x, y and heading.
fn nees(p: &[[f32; 4]; 4], e: [f32; 3]) -> f32 {
    let minor = |i: usize, j: usize| {
        let (r, c) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
        let p = |a: usize, b: usize| f64::from(p[a][b]);
        p(r[0], c[0]) * p(r[1], c[1]) - p(r[0], c[1]) * p(r[1], c[0])
    };
    let determinant: f64 = (0..3).map(|j| f64::from(p[0][j]) * minor(0, j)).sum();
    let e = e.map(f64::from);
    ((0..3).map(|i| (0..3).map(|j| e[i] * minor(i, j) * e[j]).sum::<f64>()).sum::<f64>() / determinant) as f32
}
