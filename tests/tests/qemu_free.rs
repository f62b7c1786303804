//! `qemu_free`: tests: a robot that runs by its own clock obeys its team's host and no other sender, stops
//! when the host is silent, and recovers from a panic and from a task that hangs (docs/architecture.md §6.2).
//!
//! The firmware image `onetwo-mps2-free` under QEMU in real time, its radio a serial line on the emulator's
//! standard streams. Timeouts are generous: awaited events must come, how soon depends on the machine. Needs
//! QEMU and a compiler for the target.

use std::fs;
use std::io::{Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command as Process, Stdio};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use firmware_build::inspect::STACK_BUDGET;
use firmware_build::{Install, MACHINE, Program, build_program, ensure_qemu, workspace_root};
use match_tests::bad_line::{BadLine, Trouble};
use protocol::frame::TeamKey;
use protocol::host::{Condition, Directive, HostCommand, HostMessage, RuleRole, Telemetry, Welcome};
use protocol::host_link::HostLink;
use protocol::link::overhear;
use protocol::serial::{Lines, line};
use protocol::slot::{PAGE_ADDRESS, TRIAL_ADDRESS};
use protocol::team::TeamMessage;
use protocol::{RobotId, TeamId};
use rules::Phase;

/// Robot 3, team 1, division B, with its keys of the team's key 01 02 … 10; keys and check were computed by
/// an independent SipHash.
const PAGE: [u8; 48] = [
    0x31, 0x2d, 0x32, 0x4b, 0x02, 0x03, 0x01, 0x02, 0x19, 0x9a, 0x5b, 0xca, 0xd2, 0xdd, 0xb8, 0x46, 0x2d,
    0xdc, 0x44, 0x2e, 0xe0, 0xfb, 0x84, 0x03, 0x51, 0xf0, 0x45, 0xa1, 0x95, 0x8e, 0xca, 0x8a, 0x2f, 0xa5,
    0xeb, 0xd1, 0xfe, 0x16, 0x94, 0x65, 0xe0, 0xa0, 0x65, 0x85, 0x83, 0xbe, 0x29, 0xcd,
];
const TEAM: TeamId = TeamId(1);
/// Timeout of an awaited event, on a machine however busy.
const PATIENCE: Duration = Duration::from_mins(1);
/// Interval at which the host sends 90 B. The emulator takes every byte of its line separately: at 5 ms on a
/// busy machine bytes wait in the pipe for longer than the 200 ms after which a robot refuses them.
const SPEAKS_EVERY: Duration = Duration::from_millis(20);

#[test]
fn a_robot_obeys_only_its_own_host_and_only_while_it_sends() {
    let mut robot = Robot::start(Some(&PAGE), 0);
    robot.wait_for_line("robot: ready");
    let mut ours = HostLink::new(TEAM, key(), 7);
    assert!(robot.until(&mut ours, false, lost), "before the host speaks");
    assert!(robot.until(&mut ours, true, |reported| !lost(reported)), "the host speaks");
    assert!(robot.until(&mut ours, false, lost), "the host falls silent");
    // Another key: its frames have no effect in a second and a half, while half a second of genuine ones
    // would.
    let mut theirs = HostLink::new(TEAM, TeamKey([9; 16]), 8);
    let began = Instant::now();
    while began.elapsed() < Duration::from_millis(1_500) {
        robot.send_welcome(&mut theirs, ours.welcome(id()));
        thread::sleep(Duration::from_millis(5));
    }
    robot.received.try_iter().for_each(drop);
    assert!(robot.until(&mut ours, false, |_| true), "it still speaks");
    assert!(robot.last.as_ref().is_some_and(lost), "a stranger's host moved it");
}

#[test]
fn on_a_corrupting_serial_line_a_robot_brakes_and_later_obeys_again() {
    let mut robot = Robot::start(Some(&PAGE), 0);
    robot.wait_for_line("ready");
    let mut link = HostLink::new(TEAM, key(), 7);
    assert!(robot.until(&mut link, true, |reported| !lost(reported)), "the line is good");
    // Of frames of some forty bytes three in four are still received intact; the others are rejected by their
    // tag.
    robot.trouble(Trouble::of_each(2.0));
    let refuses = |reported: &Telemetry| reported.refused.iter().any(|count| *count > 0);
    assert!(
        robot.until(&mut link, true, |reported| refuses(reported) && !lost(reported)),
        "it is commanded in spite of it"
    );
    // Hardly one in a thousand reaches the robot; its own frames are still received.
    robot.down.trouble = Trouble::of_each(60.0);
    assert!(robot.until(&mut link, true, lost), "a line of nonsense must not drive it");
    robot.trouble(Trouble::default());
    assert!(robot.until(&mut link, true, |reported| !lost(reported)), "the line is good again");
    assert!(!robot.output.contains("awake after a panic"), "{}", robot.output);
}

#[test]
fn a_robot_without_a_valid_key_page_sends_nothing() {
    for (page, expected) in [(None, "no page"), (Some(damaged()), "a damaged page")] {
        let mut robot = Robot::start(page.as_ref(), 0);
        robot.wait_for_line(expected);
        thread::sleep(Duration::from_millis(500));
        assert!(robot.received.try_recv().is_err(), "it speaks");
    }
}

#[test]
fn a_panic_cuts_motor_power_prints_its_place_and_reboots() {
    let mut robot = Robot::start(Some(&PAGE), 1);
    robot.wait_for_line("trial.rs");
    robot.wait_for_line("motors off, restarting");
    robot.wait_for_line("awake after a panic at");
    let mut link = HostLink::new(TEAM, key(), 7);
    let began = Instant::now();
    // A robot is accepted once it names this host's epoch: it must have received a welcome.
    while link.boot_epoch(id()).is_none_or(|boot_epoch| boot_epoch < 2) && began.elapsed() < PATIENCE {
        robot.until(&mut link, true, |_| true);
    }
    // On a machine too busy for real time the watchdog may have reset the robot since: later epochs count
    // too.
    assert!(
        link.boot_epoch(id()) >= Some(2),
        "the second life has an epoch of its own: {:?}",
        link.boot_epoch(id())
    );
}

#[test]
fn the_watchdog_reboots_a_robot_with_a_hanging_task() {
    let mut robot = Robot::start(Some(&PAGE), 2);
    robot.wait_for_line("watchdog: a task hangs; motors off");
    robot.wait_for_line("awake after the watchdog's bite");
    robot.wait_for_line("ready");
}

#[test]
fn a_robot_under_a_host_keeps_its_stack_within_the_budget() {
    let mut robot = Robot::start(Some(&PAGE), 3);
    robot.wait_for_line("ready");
    let mut link = HostLink::new(TEAM, key(), 7);
    assert!(robot.until(&mut link, false, |_| true), "it tells of its life");
    assert!(robot.until(&mut link, true, |reported| !lost(reported)), "it obeys");
    // Output before it was commanded does not count.
    robot.output.clear();
    robot.wait_for_line("stack ");
    // The end of this line, not of one before it.
    robot.output = robot.output.split_off(robot.output.find("stack ").unwrap_or_default());
    robot.wait_for_line("\n");
    let reported = robot.output.split("stack ").nth(1).and_then(|rest| rest.get(..10)?.parse().ok());
    println!("deepest stack of the robot that runs by its own clock: {} B", reported.unwrap_or(0));
    assert!(reported.is_some_and(|bytes| (1..=STACK_BUDGET).contains(&bytes)), "{reported:?}");
}

/// The firmware image in an emulator.
struct Robot {
    child: Child,
    output: String,
    console: Receiver<Vec<u8>>,
    received: Receiver<Vec<u8>>,
    lines: Lines,
    began: Instant,
    /// Time at which its host last sent.
    spoke: Instant,
    last: Option<Telemetry>,
    page: PathBuf,
    /// Faults of its line, in either direction.
    down: BadLine,
    up: BadLine,
}

impl Robot {
    fn start(page: Option<&[u8; 48]>, trial: u32) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let file = std::env::temp_dir().join(format!("onetwo-page-{}-{number}", std::process::id()));
        fs::write(&file, page.map_or(&[0xff; 48][..], |page| page)).expect("a temporary file");
        let qemu = ensure_qemu(Install::ForUser).unwrap_or_else(|error| panic!("{error}"));
        let mut child = Process::new(qemu)
            .args(["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", "stdio"])
            .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
            .arg(&*IMAGE)
            .args(["-device", &format!("loader,file={},addr={PAGE_ADDRESS:#x},force-raw=on", file.display())])
            .args(["-device", &format!("loader,addr={TRIAL_ADDRESS:#x},data={trial},data-len=4")])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the emulator that was just found");
        let received = pumped(child.stdout.take().expect("piped"));
        let console = pumped(child.stderr.take().expect("piped"));
        Self {
            child,
            output: String::new(),
            console,
            received,
            lines: Lines::new(),
            began: Instant::now(),
            spoke: Instant::now(),
            last: None,
            page: file,
            down: BadLine::new(1, "line down"),
            up: BadLine::new(1, "line up"),
        }
    }

    /// Sets the error rates of its line in both directions.
    fn trouble(&mut self, trouble: Trouble) {
        (self.down.trouble, self.up.trouble) = (trouble, trouble);
    }

    /// Waits for a text on the console.
    fn wait_for_line(&mut self, expected: &str) {
        let began = Instant::now();
        while !self.output.contains(expected) {
            if let Ok(more) = self.console.recv_timeout(Duration::from_millis(100)) {
                self.output += &String::from_utf8_lossy(&more);
            }
            assert!(began.elapsed() < PATIENCE, "`{expected}` was not said: {}", self.output);
        }
    }

    /// The host's clock.
    fn now(&self) -> protocol::Instant {
        protocol::Instant(self.began.elapsed().as_micros() as u64)
    }

    /// Sends a welcome and a command of that host.
    fn send_welcome(&mut self, link: &mut HostLink, welcome: Option<Welcome>) {
        let command = HostCommand {
            to: id(),
            defending: geometry::GoalEnd::Negative,
            phase: Phase::Run,
            rule_role: RuleRole::Player,
            directive: Directive::Stand,
        };
        let Some(welcome) = welcome else { return };
        let now = self.now();
        let messages = [HostMessage::Welcome(welcome), HostMessage::Command(command)];
        let stdin = self.child.stdin.as_mut().expect("piped");
        for message in messages {
            let bytes: Vec<u8> =
                line(&link.seal(now, &message)).iter().flat_map(|byte| self.down.carry(*byte)).collect();
            stdin.write_all(&bytes).expect("it listens");
        }
        stdin.flush().expect("it listens");
    }

    /// Runs, with the host sending or silent, until telemetry that fulfils the condition arrives.
    fn until(&mut self, link: &mut HostLink, speaking: bool, like: impl Fn(&Telemetry) -> bool) -> bool {
        let began = Instant::now();
        while began.elapsed() < PATIENCE {
            if speaking && self.spoke.elapsed() >= SPEAKS_EVERY {
                self.spoke = Instant::now();
                self.send_welcome(link, link.welcome(id()));
            }
            let Ok(bytes) = self.received.recv_timeout(Duration::from_millis(5)) else { continue };
            let carried: Vec<u8> = bytes.iter().flat_map(|byte| self.up.carry(*byte)).collect();
            let packets: Vec<_> = carried.iter().filter_map(|byte| self.lines.push(*byte)).collect();
            for packet in packets {
                // Of a robot that follows this host or not yet.
                let keys = key().of_team();
                if link.open(self.now(), &packet).is_ok()
                    && let Ok((_, TeamMessage::Telemetry(telemetry))) = overhear(&packet, TEAM, &keys)
                {
                    let liked = like(&telemetry);
                    self.last = Some(telemetry);
                    if liked {
                        return true;
                    }
                }
            }
        }
        false
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        // It may have ended by itself; either way nothing remains to be done.
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = fs::remove_file(&self.page);
    }
}

/// The output of a pipe, piece by piece.
fn pumped(mut pipe: impl Read + Send + 'static) -> Receiver<Vec<u8>> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut buffer = [0; 1024];
        while let Ok(len @ 1..) = pipe.read(&mut buffer) {
            if sender.send(buffer[..len].to_vec()).is_err() {
                break;
            }
        }
    });
    receiver
}

fn lost(reported: &Telemetry) -> bool {
    reported.condition.has(Condition::LINK_LOST)
}

fn key() -> TeamKey {
    TeamKey(std::array::from_fn(|n| n as u8 + 1))
}

fn id() -> RobotId {
    RobotId::new(3).expect("an id")
}

fn damaged() -> [u8; 48] {
    let mut page = PAGE;
    page[9] ^= 1;
    page
}

/// The firmware image, built where it is missing or old.
static IMAGE: LazyLock<PathBuf> = LazyLock::new(|| {
    build_program(&workspace_root(), Program::Free).unwrap_or_else(|error| panic!("{error}"))
});
