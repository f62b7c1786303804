//! `small_size_cost`: instruction count of a simulated second of an eleven-against-eleven match by a fixed
//! script, with the parts of the simulator named by the first argument.
//!
//! `cargo run --release -p onetwo-hil-sim --example small_size_cost -- physics|cameras|packets|restless S`
//! plays division A and prints counts of the result; `cargo xtask bench simulator` counts its instructions.

use std::process::ExitCode;

use geometry::{Pose, Twist, Vector};
use hil_sim::TraceHash;
use hil_sim::small_size::camera::Cameras;
use hil_sim::small_size::compatibility::Profile;
use hil_sim::small_size::{Ball, Drive, KickCommand, Order, Parameters, PhysicsEvent, World};
use protocol::{RobotId, Who};
use rules::{Colour, League};
use ssl::Message;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [part, seconds] = &arguments[..] else { return usage() };
    let (Ok(seconds), Some(part)) = (seconds.parse::<u32>(), PARTS.iter().position(|name| name == part))
    else {
        return usage();
    };
    let league = League::DivisionA;
    let Some(parameters) = Parameters::of(league) else { return usage() };
    let mut world = World::new(league, parameters, 1);
    line_up(&mut world);
    let mut cameras = Cameras::of(Profile::Ours, 0.0, &world, 1);
    let (mut trace, mut events) = (TraceHash::default(), Vec::new());
    let (mut packets, mut bytes, mut kicks, mut crashes) = (0, 0, 0, 0);
    let mut datagram = Vec::new();
    for step in 0..seconds * 1000 {
        if step % 10 == 0 {
            trace.small_size_tick(step / 10, &world);
            script(&mut world, step, part == RESTLESS);
        }
        world.step();
        world.take_events(&mut events);
        for event in events.drain(..) {
            kicks += u32::from(matches!(event, PhysicsEvent::Kicked { .. }));
            crashes += u32::from(matches!(event, PhysicsEvent::Crash { .. }));
        }
        if part == 0 {
            continue;
        }
        cameras.watch(&world);
        while let Some(packet) = cameras.poll(world.now()) {
            packets += 1;
            if part >= PACKETS {
                datagram.clear();
                // A `Vec` grows on demand: encoding into it cannot fail.
                let _ = packet.encode(&mut datagram);
                bytes += datagram.len();
            }
        }
    }
    println!(
        "{seconds} s: {kicks} kicks, {crashes} crashes, {packets} packets, {bytes} bytes, trace {}",
        trace.digits()
    );
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!("usage: small_size_cost physics|cameras|packets|restless SECONDS");
    ExitCode::from(2)
}

fn line_up(world: &mut World) {
    for (id, n) in RobotId::all().zip(0..11_u8) {
        let (x, y) = (1_500.0 + 450.0 * f32::from(n % 4), 900.0 * f32::from(n / 4) - 900.0);
        world.put(Who::blue(id), Pose::from_mm_deg(-x, y, 0.0));
        world.put(Who::yellow(id), Pose::from_mm_deg(x, -y, 180.0));
    }
}

/// One robot of each team drives to the ball and kicks it ahead, the others drive in squares, so that every
/// robot moves. A ball that left the field is put back in the middle. With `restless`, all robots change
/// speed and heading all the time and fight for the ball.
fn script(world: &mut World, step: u32, restless: bool) {
    let ball = world.ball.position;
    if ball.x().abs() > 6.0 || ball.y().abs() > 4.5 {
        world.put_ball(Ball::default());
    }
    for colour in [Colour::Yellow, Colour::Blue] {
        let (ahead, heading) = if colour == Colour::Blue { (1.0, 0.0) } else { (-1.0, geometry::math::PI) };
        for (id, n) in RobotId::all().zip(0..11_u32) {
            let who = Who { colour, id };
            // The two robots alternate, so that neither blocks the other for long.
            let turn_to_play = (step / 2_000).is_multiple_of(2) == (colour == Colour::Blue);
            let order = if n == 0 && (turn_to_play || restless) {
                let Some(robot) = world.robot(who) else { continue };
                let behind = ball + Vector::new(-0.08 * ahead, 0.0);
                let to = robot.pose.vector_to_body((behind - robot.pose.position) * 4.0).clamped(2.5);
                let turn = (geometry::Angle::new(heading) - robot.pose.heading).radians();
                let drive = Drive::Local(Twist { linear: to, angular: turn * 5.0 });
                Order {
                    drive,
                    kick: Some(KickCommand { speed: 3.0, angle: 0.0 }),
                    dribbler: 1.0,
                    discharge: false,
                }
            } else {
                // Every two seconds another side of the square, each robot turning on two of them.
                let side = (step / 2_000 % 4) as usize;
                let (x, y) = [(SPEED, 0.0), (0.0, SPEED), (-SPEED, 0.0), (0.0, -SPEED)][side];
                let Some(robot) = world.robot(who) else { continue };
                let share = if restless { (step % 500) as f32 * 0.004 } else { 1.0 };
                let linear = robot.pose.vector_to_body(Vector::new(x, y)) * share;
                let angular = [1.0, share - 1.0, -1.0, 1.0 - share][(side + n as usize) % 4];
                Order { drive: Drive::Local(Twist { linear, angular }), ..Order::default() }
            };
            world.order(who, order);
        }
    }
}

/// Speed of the robots that drive in squares, m/s.
const SPEED: f32 = 0.6;
/// What is measured: each entry includes all entries before it; the last is the whole with another script.
const PARTS: [&str; 4] = ["physics", "cameras", "packets", "restless"];
const PACKETS: usize = 2;
const RESTLESS: usize = 3;
