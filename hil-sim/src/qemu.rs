//! `qemu`: a brain that runs as the firmware image in a QEMU process of its own, one frame a tick
//! (docs/architecture.md §7.2).
//!
//! The simulator holds one end of a pair of datagram sockets, the emulator has the other as its standard
//! input and connects it to the board's Ethernet controller: no ports, no files. The firmware image's clock
//! is in the ticks, so a slow machine changes nothing; `-icount` makes the emulator count instructions, which
//! each answer reports. Unix only.

use std::ffi::OsString;
use std::io::{ErrorKind, Read, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixDatagram;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use std::{env, fs};

use brain::BrainConfig;
use protocol::link::Packet;
use protocol::lockstep::{ETHERTYPE, FromRobot, MESSAGE_LEN_MAX, TickIn, TickOut, ToRobot};
use protocol::slot;

use crate::mcu::{Backend, Mcu, McuError, Reply};

/// Robots' computers as processes, all with one firmware image.
#[derive(Debug)]
pub struct QemuBackend {
    program: PathBuf,
    image: PathBuf,
    library: Option<LibraryFile>,
    patience: Patience,
}

impl QemuBackend {
    /// With the firmware image at this path and the case base that is built into it.
    pub fn new(image: impl Into<PathBuf>) -> Self {
        Self { program: PROGRAM.into(), image: image.into(), library: None, patience: Patience::default() }
    }

    /// With this case table in every robot's flash, instead of the one built in.
    pub fn with_library(mut self, table: &[u8]) -> Result<Self, McuError> {
        self.library = Some(LibraryFile::write(table)?);
        Ok(self)
    }

    /// Checks that the needed programs and files are on this machine.
    fn check(&self) -> Result<(), McuError> {
        if !self.image.is_file() {
            let what = format!("the firmware image {}", self.image.display());
            return Err(McuError::Missing { what, hint: "build it with `onetwo firmware build`".into() });
        }
        if find(&self.program).is_none() {
            let hint = "install QEMU 7.2 or newer, for example `apt-get install qemu-system-arm` or `brew install qemu`";
            return Err(McuError::Missing { what: self.program.display().to_string(), hint: hint.into() });
        }
        Ok(())
    }

    fn command(&self) -> Command {
        let mut command = emulator_command(&self.program);
        command.args(MACHINE_ARGS).arg("-kernel").arg(&self.image);
        if let Some(library) = &self.library {
            command.arg("-device").arg(library.loader());
        }
        command
    }
}

impl<'a> Backend<'a> for QemuBackend {
    fn name(&self) -> &'static str {
        "qemu"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        self.check()?;
        let (socket, theirs) = UnixDatagram::pair().map_err(McuError::Io)?;
        let mut robot = Qemu::start(self.command(), socket, theirs, self.patience)?;
        robot.set_up(config)?;
        Ok(Box::new(robot))
    }
}

/// One robot's computer. The process is killed when this value is dropped.
struct Qemu {
    child: Child,
    socket: UnixDatagram,
    /// Number of the tick posted last.
    seq: u32,
    patience: Patience,
    frame: Box<[u8; FRAME_LEN_MAX]>,
}

impl Qemu {
    /// Starts a process that has `theirs` as its standard input.
    fn start(
        mut command: Command,
        socket: UnixDatagram,
        theirs: UnixDatagram,
        patience: Patience,
    ) -> Result<Self, McuError> {
        socket.set_read_timeout(Some(POLL_INTERVAL)).map_err(McuError::Io)?;
        command.stdin(OwnedFd::from(theirs)).stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().map_err(McuError::Start)?;
        Ok(Self { child, socket, seq: 0, patience, frame: Box::new([0; FRAME_LEN_MAX]) })
    }

    fn set_up(&mut self, config: &BrainConfig) -> Result<(), McuError> {
        let mut buffer = [0; MESSAGE_LEN_MAX];
        let config = postcard::to_slice(config, &mut buffer).map_err(unwritable)?;
        let patience = self.patience.boot;
        match self.receive("its start", patience)? {
            FromRobot::Hello => {}
            other => return Err(unexpected("a hello", &other)),
        }
        self.send(&ToRobot::Setup { config })?;
        match self.receive("its set-up", patience)? {
            FromRobot::Ready => Ok(()),
            FromRobot::Unusable => Err(McuError::Unusable),
            other => Err(unexpected("ready", &other)),
        }
    }

    fn send(&mut self, message: &ToRobot<'_>) -> Result<(), McuError> {
        let (header, rest) = self.frame.split_at_mut(HEADER.len());
        let (length, payload) = rest.split_at_mut(LENGTH_LEN);
        let written = postcard::to_slice(message, &mut payload[..MESSAGE_LEN_MAX]).map_err(unwritable)?.len();
        header.copy_from_slice(&HEADER);
        length.copy_from_slice(&(written as u16).to_le_bytes());
        let frame_len = (HEADER.len() + LENGTH_LEN + written).max(FRAME_LEN_MIN);
        match self.socket.send(&self.frame[..frame_len]) {
            Ok(_) => Ok(()),
            Err(error) => Err(self.ended().unwrap_or(McuError::Io(error))),
        }
    }

    /// The next message from the board; `asked` names the request it answers.
    fn receive(&mut self, asked: &'static str, patience: Duration) -> Result<FromRobot<'_>, McuError> {
        let started = Instant::now();
        let len = loop {
            match self.socket.recv(&mut self.frame[..]) {
                Ok(len) => break len,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(self.ended().unwrap_or(McuError::Io(error))),
            }
            // The socket pair stays silent when the other end is closed, so check the process itself.
            if let Some(end) = self.ended() {
                return Err(end);
            }
            if started.elapsed() >= patience {
                return Err(McuError::Silent { asked, waited_ms: started.elapsed().as_millis() as u64 });
            }
        };
        message_in(&self.frame[..len])
            .ok_or_else(|| McuError::Malformed { what: format!("a frame of {len} bytes") })
    }

    /// Status and output of the process, if it has ended.
    fn ended(&mut self) -> Option<McuError> {
        let status = self.child.try_wait().ok()??;
        let mut reported = String::new();
        for pipe in
            [self.child.stderr.take().map(boxed), self.child.stdout.take().map(boxed)].into_iter().flatten()
        {
            // An unreadable pipe counts as empty; the exit status is reported anyway.
            let _ = pipe.take(TEXT_LEN_MAX).read_to_string(&mut reported);
        }
        let hint = if reported.contains("dgram") { " (QEMU 7.2 or newer is needed)" } else { "" };
        Some(McuError::Ended { how: format!("{status}; {}{hint}", reported.trim()) })
    }
}

impl Mcu for Qemu {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        self.seq = tick.seq;
        self.send(&ToRobot::Tick(tick.clone()))
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        let (seq, patience) = (self.seq, self.patience.tick);
        match self.receive("a tick", patience)? {
            FromRobot::Tick(answer) if answer.seq == seq => owned(&answer),
            other => Err(unexpected("the answer to the tick", &other)),
        }
    }
}

impl Drop for Qemu {
    fn drop(&mut self) {
        // It may have ended by itself; either way nothing remains to be done.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The board's message, if the frame contains one.
fn message_in(frame: &[u8]) -> Option<FromRobot<'_>> {
    let rest = frame.get(ADDRESSES_LEN..)?.strip_prefix(&ETHERTYPE.to_be_bytes())?;
    let (length, payload) = rest.split_first_chunk()?;
    let message = payload.get(..usize::from(u16::from_le_bytes(*length)))?;
    match postcard::take_from_bytes(message) {
        Ok((message, [])) => Some(message),
        _ => None,
    }
}

fn owned(answer: &TickOut<'_>) -> Result<Reply, McuError> {
    let too_long = |_| McuError::Malformed { what: "a packet longer than any frame of the air".into() };
    let packets = answer.air.iter().map(|packet| Packet::from_slice(packet).map_err(too_long));
    Ok(Reply {
        actuators: answer.actuators,
        packets: packets.collect::<Result<_, _>>()?,
        instructions: answer.instructions,
        stack: answer.stack,
    })
}

fn unexpected(wanted: &str, got: &FromRobot<'_>) -> McuError {
    McuError::Malformed { what: format!("{wanted} was due, not {got:?}") }
}

#[allow(clippy::needless_pass_by_value, reason = "`map_err` hands it over")]
fn unwritable(error: postcard::Error) -> McuError {
    McuError::Malformed { what: format!("the question does not fit a frame: {error}") }
}

fn boxed(pipe: impl Read + 'static) -> Box<dyn Read> {
    Box::new(pipe)
}

/// A program's file: the path itself, or the first match in PATH.
/// A command for an emulator that is killed with this process, however that ends: on Linux the kernel does
/// that. It takes the thread that started a process for its parent, so an emulator must not outlive the
/// thread that started it.
pub fn emulator_command(program: &Path) -> Command {
    if find(Path::new("setpriv")).is_none() {
        return Command::new(program);
    }
    let mut guarded = Command::new("setpriv");
    guarded.args(["--pdeathsig", "KILL"]).arg(program);
    guarded
}

fn find(program: &Path) -> Option<PathBuf> {
    if program.components().count() > 1 {
        return program.is_file().then(|| program.to_path_buf());
    }
    let path = env::var_os("PATH")?;
    env::split_paths(&path).map(|directory| directory.join(program)).find(|file| file.is_file())
}

/// Content of the library slot of the board's flash: a temporary file of its own for each back end, deleted
/// with it.
#[derive(Debug)]
struct LibraryFile(PathBuf);

impl LibraryFile {
    fn write(table: &[u8]) -> Result<Self, McuError> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let header = slot::header(table.len()).ok_or_else(|| McuError::Missing {
            what: format!("room for a case table of {} bytes", table.len()),
            hint: format!("the slot in the robot's flash takes {} bytes", slot::LEN - slot::HEADER_LEN),
        })?;
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("onetwo-library-{}-{number}.bin", std::process::id());
        let file = Self(env::temp_dir().join(name));
        let mut writer = fs::File::create_new(&file.0).map_err(McuError::Io)?;
        writer.write_all(&header).and_then(|()| writer.write_all(table)).map_err(McuError::Io)?;
        Ok(file)
    }

    /// The argument of QEMU's loader device for that file; commas of a path are doubled.
    fn loader(&self) -> OsString {
        let path = self.0.to_string_lossy().replace(',', ",,");
        format!("loader,file={path},addr={:#x},force-raw=on", slot::ADDRESS).into()
    }
}

impl Drop for LibraryFile {
    fn drop(&mut self) {
        // A temporary file that stays is no error.
        let _ = fs::remove_file(&self.0);
    }
}

/// Timeouts of a robot's computer.
#[derive(Clone, Copy, Debug)]
struct Patience {
    boot: Duration,
    tick: Duration,
}

impl Default for Patience {
    /// A start takes 50 ms and a tick less than 1 ms; a busy machine may be 100 times slower.
    fn default() -> Self {
        Self { boot: Duration::from_secs(30), tick: Duration::from_secs(10) }
    }
}

/// Interval at which the process is checked while no message comes.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
const PROGRAM: &str = "qemu-system-arm";
/// Machine, instruction count (64 ns of virtual time each), exit on panic, and the network on descriptor 0.
const MACHINE_ARGS: [&str; 16] = [
    "-machine",
    "mps2-an386",
    "-display",
    "none",
    "-monitor",
    "none",
    "-serial",
    "none",
    "-icount",
    "shift=6,align=off",
    "-semihosting-config",
    "enable=on,target=native",
    "-netdev",
    "dgram,id=air,local.type=fd,local.str=0",
    "-net",
    "nic,netdev=air",
];
/// Maximum length of the output kept of an ended emulator, bytes.
const TEXT_LEN_MAX: u64 = 4_096;

/// Destination (broadcast), source (a locally administered address), type.
const HEADER: [u8; 14] = {
    let [high, low] = ETHERTYPE.to_be_bytes();
    [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02, 0, 0, 0, 0, 0x02, high, low]
};
const ADDRESSES_LEN: usize = 12;
const LENGTH_LEN: usize = 2;
/// Ethernet's minimum frame length, bytes, without the checksum.
const FRAME_LEN_MIN: usize = 60;
const FRAME_LEN_MAX: usize = HEADER.len() + LENGTH_LEN + MESSAGE_LEN_MAX;

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Point, Pose, Twist, Vector};
    use protocol::robot_io::{ActuatorFrame, OmniKick, SensorFrame};
    use protocol::{RobotId, TeamId};

    /// A process that does nothing, and the board's end of its socket.
    fn quiet(program: &str, arguments: &[&str]) -> (Qemu, UnixDatagram) {
        waiting(Duration::from_millis(120), program, arguments)
    }

    /// A process that is waited for so long, and the board's end of its socket.
    fn waiting(patience: Duration, program: &str, arguments: &[&str]) -> (Qemu, UnixDatagram) {
        let (ours, theirs) = UnixDatagram::pair().unwrap();
        let board = theirs.try_clone().unwrap();
        let mut command = Command::new(program);
        command.args(arguments);
        let patience = Patience { boot: patience, tick: patience };
        (Qemu::start(command, ours, theirs, patience).unwrap(), board)
    }

    fn send_message(board: &UnixDatagram, message: &FromRobot<'_>) {
        let mut payload = [0; 1_400];
        let payload = postcard::to_slice(message, &mut payload).unwrap();
        let mut frame = vec![0xff; 12];
        frame.extend([0x88, 0xb5, payload.len() as u8, (payload.len() >> 8) as u8]);
        frame.extend(&*payload);
        // Padding bytes of a controller are not part of the message.
        frame.resize(frame.len().max(60), 0xee);
        board.send(&frame).unwrap();
    }

    fn receive_message(board: &UnixDatagram) -> Vec<u8> {
        let mut frame = [0; 1_514];
        let len = board.recv(&mut frame).unwrap();
        assert!(len >= 60 && frame[12..14] == [0x88, 0xb5]);
        let payload = usize::from(frame[14]) + 256 * usize::from(frame[15]);
        frame[16..16 + payload].to_vec()
    }

    fn config() -> BrainConfig {
        BrainConfig::new(RobotId::new(2).unwrap(), TeamId(1))
    }

    fn sensors() -> SensorFrame {
        SensorFrame {
            pose: Some(Pose::from_mm_deg(100.0, -200.0, 30.0)),
            ball: None,
            opponents: [Point::new(1.0, 0.0)].into_iter().collect(),
            ball_contact: false,
            busy: false,
            odometry: Twist { linear: Vector::new(0.0, 0.0), angular: 0.0 },
            health: protocol::robot_io::Health::default(),
            camera: None,
        }
    }

    fn tick(seq: u32) -> TickIn<'static> {
        let air = [&b"one"[..], b"two"].into_iter().collect();
        TickIn { seq, now: protocol::Instant(40_000), air, sensors: sensors() }
    }

    #[test]
    fn set_up_and_ticks_are_exchanged_with_the_board() {
        let (mut robot, board) = quiet("sleep", &["30"]);
        send_message(&board, &FromRobot::Hello);
        send_message(&board, &FromRobot::Ready);
        robot.set_up(&config()).unwrap();
        let received = receive_message(&board);
        let ToRobot::Setup { config: bytes } = postcard::from_bytes(&received).unwrap() else { panic!() };
        assert_eq!(postcard::from_bytes::<BrainConfig>(bytes).unwrap(), config());

        robot.post(&tick(7)).unwrap();
        assert_eq!(
            postcard::from_bytes::<ToRobot<'_>>(&receive_message(&board)).unwrap(),
            ToRobot::Tick(tick(7))
        );
        let order = ActuatorFrame::Omni { wheels: [0.5; 4], dribbler: 0.0, kick: OmniKick::None };
        let air = [&b"three"[..]].into_iter().collect();
        let answer = TickOut { seq: 7, actuators: Some(order), air, instructions: 4_711, stack: 815 };
        send_message(&board, &FromRobot::Tick(answer));
        let reply = robot.collect().unwrap();
        assert_eq!((reply.actuators, reply.instructions, reply.stack), (Some(order), 4_711, 815));
        assert_eq!((reply.packets.len(), &reply.packets[0][..]), (1, &b"three"[..]));
    }

    #[test]
    fn an_answer_to_another_tick_and_a_broken_frame_are_malformed() {
        let (mut robot, board) = quiet("sleep", &["30"]);
        robot.post(&tick(7)).unwrap();
        send_message(
            &board,
            &FromRobot::Tick(TickOut {
                seq: 6,
                actuators: None,
                air: heapless::Vec::new(),
                instructions: 0,
                stack: 0,
            }),
        );
        assert!(matches!(robot.collect(), Err(McuError::Malformed { .. })));
        for len in [0, 1, 13, 15, 16, 60] {
            board.send(&vec![0x88; len]).unwrap();
            assert!(matches!(robot.collect(), Err(McuError::Malformed { .. })), "{len} bytes");
        }
    }

    #[test]
    fn a_refused_set_up_is_an_error() {
        let (mut robot, board) = quiet("sleep", &["30"]);
        send_message(&board, &FromRobot::Hello);
        send_message(&board, &FromRobot::Unusable);
        assert!(matches!(robot.set_up(&config()), Err(McuError::Unusable)));
    }

    #[test]
    fn the_error_of_an_ended_emulator_has_its_status_and_output() {
        let patience = Duration::from_mins(1);
        let (mut robot, _board) = waiting(patience, "sh", &["-c", "echo no such machine >&2; exit 3"]);
        let error = robot.set_up(&config()).unwrap_err().to_string();
        assert!(error.contains("exit status: 3; no such machine"), "{error}");
    }

    #[test]
    fn a_silent_emulator_times_out() {
        let (mut robot, _board) = quiet("sleep", &["30"]);
        let error = robot.set_up(&config()).unwrap_err();
        let McuError::Silent { asked: "its start", waited_ms: 120.. } = error else { panic!("{error}") };
    }

    #[test]
    fn a_missing_image_or_emulator_is_named_with_the_command_that_gets_it() {
        let error = |backend: &mut QemuBackend| backend.boot(&config()).err().unwrap().to_string();
        let mut backend = QemuBackend::new("no/such/image");
        let text = error(&mut backend);
        assert!(
            text.contains("no/such/image is missing") && text.contains("onetwo firmware build"),
            "{text}"
        );
        // Any file is accepted as a firmware image until its content is read.
        backend.image = env::current_exe().unwrap();
        backend.program = "no-such-emulator".into();
        let text = error(&mut backend);
        assert!(
            text.contains("no-such-emulator is missing: install QEMU") && text.contains("apt-get"),
            "{text}"
        );
    }

    #[test]
    fn a_library_file_has_its_header_and_is_deleted_with_the_back_end() {
        let backend = QemuBackend::new("image").with_library(&[5; 300]).unwrap();
        let file = backend.library.as_ref().unwrap().0.clone();
        let bytes = fs::read(&file).unwrap();
        assert_eq!((&bytes[..8], bytes.len()), (&b"1-2T\x2c\x01\0\0"[..], 308));
        let arguments = format!("{:?}", backend.command());
        assert!(arguments.contains("addr=0x300000"), "{arguments}");
        drop(backend);
        assert!(!file.exists());
        let error = QemuBackend::new("image").with_library(&vec![0; slot::LEN]).unwrap_err().to_string();
        assert!(error.contains("room for a case table of 1048576 bytes"), "{error}");
    }
}
