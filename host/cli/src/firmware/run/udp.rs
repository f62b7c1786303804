//! `udp`: robots of a team as firmware images with UDP for a radio: an emulator for each, an access point
//! between them and their host, and their bodies in a simulator.
//!
//! Each image has QEMU's own network (`-nic user`): it is 10.0.2.15 and this machine is 10.0.2.2, so that no
//! right and no interface of the system is needed. Robots speak first, and answers find their way back.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use firmware_build::{Install, MACHINE, Program, ensure_qemu};
use protocol::journal;
use protocol::network_page::{NetworkPage, page};
use protocol::provision::Provision;
use protocol::slot::{JOURNAL_LEN, NETWORK_ADDRESS};
use rules::Colour;
use ssl::net::addresses;
use virtual_robot::{AccessPoint, Bodies};

use super::super::failure::FirmwareError;
use super::{CHECK_EVERY, Emulator, RunArgs, build, check, in_option, qemu_arguments};
use crate::Failure;
use crate::destination::{self, FileKind};
use crate::output::note;
use crate::stop::stopped_by_hand;

/// This machine, as an image sees it (QEMU's documentation of `-netdev user`).
const PC_ADDRESS: Ipv4Addr = Ipv4Addr::new(10, 0, 2, 2);
/// An image, as it is seen by itself.
const ROBOT_ADDRESS: Ipv4Addr = Ipv4Addr::new(10, 0, 2, 15);
/// Port of an image's radio; that of its body is the next.
const RADIO_PORT: u16 = 10_400;
/// A port to which nobody listens: `discard` (RFC 863).
const DISCARD_PORT: u16 = 9;

/// Runs them until they are ended.
pub(super) fn run(address: SocketAddr, args: &RunArgs) -> Result<(), Failure> {
    let robots: Vec<(&Path, Provision)> =
        args.page.iter().map(|file| Ok((file.as_path(), check(file)?))).collect::<Result<_, Failure>>()?;
    let team = one_team(&robots).map_err(FirmwareError::Team)?;
    let simulator = args.simulator.as_deref().map(|text| simulator(text, team)).transpose()?;
    let qemu = ensure_qemu(Install::ForUser)?;
    let image = build(Program::Udp)?;
    let stopped = stopped_by_hand();
    let socket = |what: String| move |error| FirmwareError::Socket(what, error);
    let point = AccessPoint::open(address).map_err(socket(format!("robots' radio at {address}")))?;
    let ids: Vec<_> = robots.iter().map(|(_, who)| who.robot).collect();
    let bodies = simulator
        .map(|simulator| Bodies::open(&ids, simulator).map_err(socket("robots' bodies".to_owned())))
        .transpose()?;
    note!("radio  {} robots behind udp://{}", robots.len(), point.for_host());
    if let Some(simulator) = simulator {
        note!("bodies  in the simulator at {simulator}");
    }
    let mut team = Team(Vec::new());
    for (file, who) in &robots {
        let body = bodies.iter().flat_map(Bodies::addresses).find(|(id, _)| *id == who.robot);
        let network = NetworkPage {
            own: ROBOT_ADDRESS,
            prefix: 24,
            gateway: PC_ADDRESS,
            port: RADIO_PORT,
            radio: SocketAddrV4::new(PC_ADDRESS, point.for_robots().port()),
            body: SocketAddrV4::new(PC_ADDRESS, body.map_or(DISCARD_PORT, |(_, address)| address.port())),
        };
        let journal = args.journal.as_deref().map(|directory| prepare(directory, who)).transpose()?;
        let mut arguments = qemu_arguments(&image, Some(file), "null");
        arguments.extend(network_arguments(&network, who, journal.as_deref()));
        let emulator = Emulator::start(&qemu, &arguments, &format!("robot {}: ", who.robot))?;
        team.0.push((who.robot.number(), emulator));
    }
    let end = args.duration.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
    while !stopped.load(Ordering::Relaxed) && end.is_none_or(|end| Instant::now() < end) {
        team.look()?;
        thread::sleep(CHECK_EVERY);
    }
    let counts = point.counts();
    note!("radio  {} frames of the host, {} of robots passed on", counts.from_host, counts.from_robots);
    Ok(())
}

/// The emulators, each with its robot's number.
struct Team(Vec<(u8, Emulator)>);

impl Team {
    /// An error as soon as one has ended.
    fn look(&mut self) -> Result<(), Failure> {
        for (robot, emulator) in &mut self.0 {
            if let Some(status) = emulator.0.try_wait()? {
                let what = format!("the emulator of robot {robot} ended ({status}); its output is above");
                return Err(FirmwareError::Team(what).into());
            }
        }
        Ok(())
    }
}

/// The colour of all robots, each once.
fn one_team(robots: &[(&Path, Provision)]) -> Result<Option<Colour>, String> {
    let Some(((_, first), others)) = robots.split_first() else {
        return Err(
            "--udp runs a robot for each --page; give at least one (`onetwo firmware provision`)".into()
        );
    };
    if let Some((file, other)) = others.iter().find(|(_, other)| other.team != first.team) {
        return Err(format!(
            "{} is of team {}, the first page of team {}: a base station serves one team",
            file.display(),
            other.team.0,
            first.team.0
        ));
    }
    for (n, (file, who)) in robots.iter().enumerate() {
        if robots.iter().take(n).any(|(_, before)| before.robot == who.robot) {
            return Err(format!("{} is robot {} again; give each robot one page", file.display(), who.robot));
        }
    }
    let known = [Colour::Blue, Colour::Yellow].into_iter();
    Ok(known.into_iter().find(|colour| protocol::TeamId::of(*colour) == first.team))
}

/// The simulator's port for a team.
fn simulator(text: &str, team: Option<Colour>) -> Result<SocketAddr, Failure> {
    let port = match team {
        Some(Colour::Yellow) => addresses::ROBOTS_YELLOW_PORT,
        Some(Colour::Blue) | None => addresses::ROBOTS_BLUE_PORT,
    };
    ssl::net::resolve_destination(text, Some(port))
        .map_err(|error| FirmwareError::Team(format!("unknown host in --simulator {text}: {error}")).into())
}

/// An empty journal for a robot: the memory of its board, as a file.
fn prepare(directory: &Path, who: &Provision) -> Result<PathBuf, Failure> {
    let path = directory.join(format!("robot{}.journal", who.robot));
    destination::make_directory(directory)?;
    let mut empty = vec![0; JOURNAL_LEN];
    empty[..journal::MAGIC.len()].copy_from_slice(&journal::MAGIC);
    destination::write(&path, FileKind::Bytes, &empty)?;
    Ok(path)
}

/// QEMU's arguments for a robot's network, and for a memory that is a file.
fn network_arguments(network: &NetworkPage, who: &Provision, journal: Option<&Path>) -> Vec<String> {
    // As the image names its controller itself; two robots' networks do not meet.
    let mut arguments =
        vec!["-nic".to_owned(), format!("user,mac=02:00:00:00:00:{:02x}", who.robot.number() + 1)];
    let words = page(network).into_iter().collect::<Vec<_>>();
    for (n, word) in words.chunks_exact(8).enumerate() {
        let data = word.iter().rev().fold(0_u64, |value, byte| value << 8 | u64::from(*byte));
        let address = NETWORK_ADDRESS + 8 * n;
        arguments.push("-device".to_owned());
        arguments.push(format!("loader,addr={address:#x},data={data:#x},data-len=8"));
    }
    if let Some(file) = journal {
        let path = in_option(file);
        arguments.extend([
            "-object".to_owned(),
            format!("memory-backend-file,id=journal,size={JOURNAL_LEN},mem-path={path},share=on"),
            // The last one counts.
            "-machine".to_owned(),
            format!("{MACHINE},memory-backend=journal"),
        ]);
    }
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::frame::TeamKey;
    use protocol::{RobotId, TeamId};
    use rules::League;

    fn who(robot: u8, team: u8) -> Provision {
        let robot = RobotId::new(robot).unwrap();
        Provision {
            robot,
            team: TeamId(team),
            league: League::DivisionB,
            keys: TeamKey::ZERO.of_robot(robot),
        }
    }

    #[test]
    fn robots_of_one_team_play_and_two_teams_a_robot_twice_and_none_are_refused() {
        let path = Path::new("x.page");
        let of = |robots: &[(u8, u8)]| {
            one_team(&robots.iter().map(|(robot, team)| (path, who(*robot, *team))).collect::<Vec<_>>())
        };
        let (yellow, blue) = (TeamId::of(Colour::Yellow).0, TeamId::of(Colour::Blue).0);
        assert_eq!(of(&[(0, yellow), (1, yellow)]), Ok(Some(Colour::Yellow)));
        assert_eq!(of(&[(0, blue)]), Ok(Some(Colour::Blue)));
        assert_eq!(of(&[(0, 77)]), Ok(None));
        assert!(of(&[]).unwrap_err().contains("--page"));
        assert!(of(&[(0, yellow), (1, blue)]).unwrap_err().contains("one team"));
        assert!(of(&[(3, blue), (3, blue)]).unwrap_err().contains("robot 3 again"));
    }

    #[test]
    fn the_network_s_page_is_loaded_as_its_bytes_stand() {
        let network = NetworkPage {
            own: ROBOT_ADDRESS,
            prefix: 24,
            gateway: PC_ADDRESS,
            port: RADIO_PORT,
            radio: SocketAddrV4::new(PC_ADDRESS, 5),
            body: SocketAddrV4::new(PC_ADDRESS, DISCARD_PORT),
        };
        let arguments = network_arguments(&network, &who(3, 1), Some(Path::new("a,b")));
        // "1-2N", 10.0.2.15 as a number of eight bytes, little endian.
        assert!(arguments.contains(&"loader,addr=0x2fd000,data=0xf02000a4e322d31,data-len=8".to_owned()));
        assert_eq!(arguments.iter().filter(|argument| argument.starts_with("loader,")).count(), 4);
        assert!(arguments.iter().any(|argument| argument.contains("mac=02:00:00:00:00:04")));
        assert!(arguments.iter().any(|argument| argument.contains("mem-path=a,,b,share=on")));
    }
}
