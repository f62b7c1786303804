//! `qemu_udp`: tests: six robots as firmware images with UDP for a radio play a match under `onetwo control
//! --robots udp://`, in real time, and each decides as a native brain with the same inputs does.
//!
//! The built program four times: simulator, the images (`firmware run --udp`), their host, and the opponents'
//! host with six native robots. Each image writes down what its brain took in and gave out; afterwards a
//! native brain gets the same at the same times, and every packet and every order is compared bit by bit. How
//! well the match is played depends on the machine, equality does not: an emulator that gets too little of
//! the processor loses ticks of its clock, so that the length is counted in the robots' own steps.
//!
//! `ONETWO_MATCH_SECONDS=60 cargo test --release -p onetwo --test qemu_udp -- --nocapture`
//! plays longer. Needs QEMU and a compiler for the target.

mod running;
mod verb;

use std::fs;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use brain::BrainConfig;
use firmware_build::inspect::{Budget, Image, Sizes};
use firmware_build::{Program, build_program, workspace_root};
use protocol::frame::TeamKey;
use protocol::journal::{Entry, Record, records};
use protocol::robot_io::ActuatorFrame;
use protocol::{RobotId, TeamId};
use rules::{Colour, League};
use running::{PATIENCE, Running, free, socket};
use verb::{directory, done};
use virtual_robot::replay;

/// Length of the match by the slowest robot's clock, s, where the environment names none: kick-off and the
/// first duels.
const SECONDS: f64 = 10.0;
/// A machine is given up on which the robots' clocks are slower than the sun's by this factor.
const SLOWEST: f64 = 10.0;
/// The image's limits, B: those of a real robot's board; the network stack takes what drivers take there.
const SIZE: Budget = Budget { flash: 196_608, ram: 49_152 };
const ROBOTS: u8 = 6;
const KEY: TeamKey = TeamKey([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);

#[test]
fn six_images_on_udp_play_a_match_and_decide_as_native_brains_do() {
    let image = build_program(&workspace_root(), Program::Udp).unwrap_or_else(|error| panic!("{error}"));
    keeps_to_its_size(&image);
    let seconds = std::env::var("ONETWO_MATCH_SECONDS").ok().and_then(|text| text.parse().ok());
    let seconds: f64 = seconds.unwrap_or(SECONDS);
    let directory = directory("match");
    play(&directory, seconds);
    for robot in (0..ROBOTS).filter_map(RobotId::new) {
        let journal = fs::read(directory.join(format!("robot{robot}.journal"))).expect("a journal");
        let config = BrainConfig::hosted(robot, TeamId::of(Colour::Blue), League::DivisionB);
        let replayed = replay(&journal, &config, case_library::division_b(), &KEY.of_robot(robot))
            .unwrap_or_else(|error| panic!("robot {robot}: {error}"));
        let drove = driving(&journal);
        println!(
            "robot {robot}: {:.1} s by its clock, {} packets and {} steps in, {} packets and {} orders out, \
             {drove} of them drive; hash {:016x}, equal",
            replayed.last.0 as f64 / 1e6,
            replayed.packets,
            replayed.steps,
            replayed.sent,
            replayed.orders,
            replayed.hash
        );
        assert_eq!(replayed.epochs, 1, "it restarted");
        assert!(replayed.steps >= steps_of(seconds), "{replayed:?}");
        // An order for every step; a command, two parts of a snapshot and beacons come about as often.
        assert!(replayed.orders + 2 > replayed.steps && replayed.packets > replayed.steps, "{replayed:?}");
        // Beacons and telemetry, some thirty a second.
        assert!(10 * replayed.sent > replayed.steps, "{replayed:?}");
    }
}

fn keeps_to_its_size(image: &Path) {
    let bytes = fs::read(image).expect("the image that was just built");
    let sizes = Sizes::of(&Image::parse(&bytes).expect("an image"));
    println!("{}: {} B flash, {} B RAM", image.display(), sizes.flash, sizes.ram);
    SIZE.check(&sizes).unwrap_or_else(|over| panic!("{over}"));
}

/// Steps that a robot on wheels makes in this time.
fn steps_of(seconds: f64) -> u64 {
    (seconds * 1e6) as u64 / protocol::robot_io::WHEELED_STEP.0
}

/// Steps that a journal holds so far; the robot writes on while it is read.
fn steps_so_far(journal: &Path) -> u64 {
    let bytes = fs::read(journal).expect("a journal");
    let is_step = |record: &Record<'_>| matches!(record.entry, Entry::Sensors(_));
    let read = records(&bytes).into_iter().flatten().map_while(Result::ok);
    read.filter(is_step).count() as u64
}

/// Orders in which some wheel turns.
fn driving(journal: &[u8]) -> usize {
    let read = records(journal).into_iter().flatten().map_while(Result::ok);
    let orders = read.filter_map(|record| match record.entry {
        Entry::Ordered(ActuatorFrame::Omni { wheels, .. }) => Some(wheels),
        _ => None,
    });
    orders.filter(|wheels| wheels.iter().any(|rim| rim.abs() > 0.05)).count()
}

/// Half a second of driving, so far.
fn moves(journal: &[u8]) -> bool {
    driving(journal) as u64 > steps_of(0.5)
}

/// Plays for some seconds, until the robots have moved; the blue robots' journals are in that directory
/// afterwards.
fn play(directory: &Path, seconds: f64) {
    let (key_file, key) = (directory.join("team.key"), KEY.0.map(|byte| format!("{byte:02x}")).concat());
    fs::write(&key_file, key).expect("a file");
    let key_file = key_file.display().to_string();
    let pages: Vec<String> = (0..ROBOTS).map(|robot| provisioned(directory, robot, &key_file)).collect();
    // A simulator speaks to one address; a multicast group is not there on every machine.
    let (vision, referee) = (Copied::new(), Copied::new());
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--headless"];
    let to = ["--vision", &vision.address, "--referee-to", &referee.address];
    let mut simulator = Running::start(&[&simulate[..], &to].concat());
    let control_port = simulator.control_port();
    let (bodies, robots) = (format!("127.0.0.1:{}", control_port + 1), free());
    let journal = directory.display().to_string();
    let mut run = vec!["firmware", "run", "--udp", &robots, "--simulator", &bodies, "--journal", &journal];
    run.extend(pages.iter().flat_map(|page| ["--page", page]));
    let mut images = Running::start(&run);
    for _ in 0..ROBOTS {
        images.wait_for("robot: ready");
    }
    let control = |copy: usize, more: &[&str]| {
        let team = ["control", "--headless", "--tracker", "127.0.0.1:9"];
        let from = ["--vision", &vision.copies[copy], "--referee", &referee.copies[copy]];
        Running::start(&[&team[..], &from, more].concat())
    };
    let theirs = format!("sim://127.0.0.1:{control_port}");
    let mut yellow = control(1, &["--colour", "yellow", "--robots", &theirs]);
    yellow.wait_for("robots are received");
    let ours = format!("udp://{robots}");
    let mut blue = control(0, &["--colour", "blue", "--robots", &ours, "--key-file", &key_file]);
    blue.wait_for("robots are received: 0 1 2 3 4 5");
    let until = Instant::now() + PATIENCE + Duration::from_secs_f64(SLOWEST * seconds);
    let slowest = || {
        let journals = (0..ROBOTS).map(|robot| directory.join(format!("robot{robot}.journal")));
        journals.map(|journal| steps_so_far(&journal)).min().unwrap_or(0)
    };
    let moving = || {
        let journals = (0..ROBOTS).map(|robot| directory.join(format!("robot{robot}.journal")));
        journals.filter(|journal| moves(&fs::read(journal).expect("a journal"))).count()
    };
    // Robots move on commands of their host alone. Until the kick-off all but perhaps one take their places;
    // how soon the first command comes depends on the machine.
    while slowest() < steps_of(seconds) || moving() + 1 < usize::from(ROBOTS) {
        assert!(Instant::now() < until, "{} of {} steps, {} move", slowest(), steps_of(seconds), moving());
        thread::sleep(Duration::from_secs(1));
        let ended = images.process.try_wait().expect("our own child");
        assert_eq!(ended, None, "the images ended: {:#?}", images.received);
    }
}

fn provisioned(directory: &Path, robot: u8, key_file: &str) -> String {
    let page = directory.join(format!("robot{robot}.page")).display().to_string();
    let (number, team) = (robot.to_string(), TeamId::of(Colour::Blue).0.to_string());
    let who = ["firmware", "provision", "--robot", &number, "--team", &team];
    done(&[&who[..], &["--key-file", key_file, "--out", &page]].concat());
    page
}

/// An address whose datagrams go to two others.
struct Copied {
    address: String,
    copies: [String; 2],
}

impl Copied {
    fn new() -> Self {
        let inward = socket();
        let address = inward.local_addr().expect("an address").to_string();
        let copies = [free(), free()];
        let (outward, to) = (UdpSocket::bind("127.0.0.1:0").expect("a port"), copies.clone());
        // Ends with the test's process, or when nothing came for long.
        thread::spawn(move || {
            let mut bytes = vec![0; 65_536];
            while let Ok((len, _)) = inward.recv_from(&mut bytes) {
                for address in &to {
                    // A team that does not listen yet.
                    let _ = outward.send_to(&bytes[..len], address);
                }
            }
        });
        Self { address, copies }
    }
}
