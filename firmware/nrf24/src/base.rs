//! `base`: the base station's radio. It sends the host's frames, to one robot with acknowledgement and
//! repeats, to all without, and asks robots that were not spoken to for what they have to say. Times in µs.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use protocol::frame::HEADER_LEN;
use protocol::link::Packet;
use protocol::station::{PacketCounts, StationMessage};
use protocol::{Duration, Instant, RobotId, TeamId};
use rf24::StatusFlags;
use rf24::radio::prelude::{EsbFifo, EsbRadio, EsbStatus};

use crate::chip::{CHECK_EVERY, Channel, Fault, Lines};
use crate::fragment::{Assembler, Cutter, Fragments, Joined, NotSent, Payload, question};
use crate::scan::Scan;

/// Counts of frames that a base station's radio sent and dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BaseCounts {
    /// Frames of the host given to the air to their last fragment.
    pub sent: u32,
    /// Frames to one robot that it did not acknowledge in every repeat; they may have come all the same.
    pub unacknowledged: u32,
    /// Frames that waited longer than they hold, or found no room.
    pub late: u32,
    /// Questions to robots that had none of the host's frames in time.
    pub questions: u32,
    /// Starts of the chip after the first: its supply dipped, a register was upset, or it stood still.
    pub restarts: u32,
    /// Frames of robots that were joined.
    pub robots: Joined,
}

/// Receiver of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    Everyone,
    One(RobotId),
}

/// State of the exchange with one robot.
#[derive(Clone, Debug)]
struct Peer {
    cutter: Cutter,
    assembler: Assembler,
    asked: Option<Instant>,
    received_at: Option<Instant>,
    /// True if the last acknowledgement carried something: there may be more.
    has_more: bool,
    packets: PacketCounts,
}

/// Robots of a team that were not heard yet.
fn peers(team: TeamId) -> [Peer; RobotId::COUNT] {
    core::array::from_fn(|_| Peer {
        cutter: Cutter::new(team),
        assembler: Assembler::new(team, ASSEMBLY_TIME_MAX),
        asked: None,
        received_at: None,
        has_more: false,
        packets: PacketCounts::default(),
    })
}

impl Peer {
    fn is_here(&self, now: Instant) -> bool {
        self.received_at.is_some_and(|received_at| now.since(received_at) <= PRESENCE_LEASE)
    }

    /// Returns whether the robot is here and has more to send, or was not asked for a while.
    fn is_due(&self, now: Instant) -> bool {
        self.is_here(now) && (self.has_more || self.asked.is_none_or(|asked| now.since(asked) >= ASK_EVERY))
    }
}

/// Payloads of one frame that are not with the chip yet.
#[derive(Clone, Debug)]
struct Sending {
    target: Target,
    fragments: Fragments,
    given: usize,
    is_question: bool,
}

/// A base station's radio.
#[allow(missing_debug_implementations, reason = "the chip's driver has none")]
pub struct Base<S, C, D> {
    lines: Lines<S, C, D>,
    channel: Channel,
    cutter: Cutter,
    peers: [Peer; RobotId::COUNT],
    waiting: heapless::Deque<(Instant, Target, Packet), WAITING_MAX>,
    sending: Option<Sending>,
    /// The chip has payloads of this target, since then.
    busy: Option<(Target, Instant)>,
    /// True while the packet in the chip is a question.
    is_asking: bool,
    /// Repeats that the chip is set to.
    repeats: u8,
    /// The number that is looked for next, and when the last was.
    search: (u8, Instant),
    checked: Instant,
    /// False while the chip is not set up to the end: its supply dipped in the middle of it.
    is_ready: bool,
    /// The channel that it left for the present one, and when, until a robot answers here.
    left: Option<(Channel, Instant)>,
    /// The channel that it came back from as no robot followed.
    failed: Option<Channel>,
    scan: Option<Scan>,
    /// Time of the host's last frame.
    commanded: Option<Instant>,
    counts: BaseCounts,
}

impl<S: SpiDevice, C: OutputPin, D: DelayNs> Base<S, C, D> {
    /// Sets the chip up.
    pub fn start(now: Instant, channel: Channel, spi: S, chip_enable: C, pause: D) -> Result<Self, Fault> {
        let mut radio = Self {
            lines: Lines::new(spi, chip_enable, pause),
            channel,
            cutter: Cutter::new(channel.team),
            peers: peers(channel.team),
            waiting: heapless::Deque::new(),
            sending: None,
            busy: None,
            is_asking: false,
            repeats: 0,
            search: (0, now),
            checked: now,
            is_ready: true,
            left: None,
            failed: None,
            scan: None,
            commanded: None,
            counts: BaseCounts::default(),
        };
        radio.lines.start(channel)?;
        Ok(radio)
    }

    /// Takes a frame of the host. One to a single robot goes to it with acknowledgement, all others to
    /// everyone: parts of snapshots, and frames of robots that the host passes on.
    pub fn send(&mut self, now: Instant, frame: &[u8]) -> Result<(), NotSent> {
        let packet = Packet::from_slice(frame).map_err(|_| NotSent::Length(frame.len()))?;
        self.commanded = Some(now);
        if self.waiting.is_full() {
            self.waiting.pop_front();
            self.counts.late = self.counts.late.saturating_add(1);
        }
        let _room = self.waiting.push_back((now, target(frame), packet));
        Ok(())
    }

    /// Goes to another channel; its robots find it there. If it had robots and none follows within
    /// ten seconds, it goes back, and stays until it gets a third channel.
    pub fn tune(&mut self, now: Instant, channel: Channel) {
        if channel == self.channel || Some(channel) == self.failed {
            return;
        }
        if channel.team != self.channel.team {
            (self.cutter, self.peers) = (Cutter::new(channel.team), peers(channel.team));
        }
        let has_robots = self.peers.iter().any(|peer| peer.is_here(now));
        self.left = has_robots.then_some((self.channel, now));
        self.failed = None;
        self.move_to(channel);
    }

    fn move_to(&mut self, channel: Channel) {
        self.channel = channel;
        self.is_ready = false;
        (self.busy, self.sending, self.repeats) = (None, None, 0);
        self.peers.iter_mut().for_each(|peer| peer.received_at = None);
    }

    /// The channel where it is.
    pub fn channel(&self) -> Channel {
        self.channel
    }

    /// Starts to measure the power on all channels; false where a host's frame came within a second:
    /// robots play, and would brake. A frame that comes meanwhile ends it.
    pub fn scan(&mut self, now: Instant, sweeps: u8) -> bool {
        if self.commanded.is_some_and(|last| now.since(last) < STANDS_AFTER) || sweeps == 0 {
            return false;
        }
        self.scan = Some(Scan::new(sweeps));
        (self.busy, self.sending) = (None, None);
        true
    }

    /// What a scan has found, once it is complete; the radio is back on its channel.
    pub fn take_spectrum(&mut self) -> Option<StationMessage> {
        let done = self.scan.take_if(|scan| scan.is_done())?;
        self.is_ready = false;
        Some(done.spectrum())
    }

    /// Serves the chip; returns a robot's frame that came. Call until `None` when the line IRQ is low, after
    /// [`Base::send`], and every [`crate::SERVE_EVERY`] at least.
    pub fn poll(&mut self, now: Instant) -> Result<Option<Packet>, Fault> {
        if let Some(scan) = &mut self.scan {
            if self.waiting.is_empty() {
                scan.serve(now, &mut self.lines)?;
                return Ok(None);
            }
            (self.scan, self.is_ready) = (None, false);
        }
        self.check(now)?;
        // Before anything arrives: a packet and the payload in its acknowledgement are one event.
        let events = self.lines.events()?;
        while let Some((_, payload)) = self.lines.receive()? {
            if let Some((Target::One(robot), _)) = self.busy
                && let Some(peer) = self.peers.get_mut(robot.index())
            {
                peer.has_more = true;
                if let Some(frame) = peer.assembler.push(now, &payload) {
                    return Ok(Some(frame));
                }
            }
        }
        match self.busy {
            Some((Target::One(robot), _)) if events.tx_ds() || events.tx_df() => {
                self.answered(now, robot, events.tx_ds())?;
            }
            _ => {}
        }
        if matches!(self.busy, Some((Target::Everyone, _)))
            && self.lines.radio.get_fifo_state(true)? == rf24::FifoState::Empty
        {
            self.busy = None;
            self.lines.radio.clear_status_flags(StatusFlags::default().with_tx_ds(true))?;
        }
        self.give(now)?;
        Ok(None)
    }

    /// Goes back where no robot followed, and sets the chip up if it is not as it was set.
    fn check(&mut self, now: Instant) -> Result<(), Fault> {
        if let Some((before, since)) = self.left.take_if(|(_, since)| now.since(*since) > RETURN_AFTER)
            && !self.peers.iter().any(|peer| peer.received_at.is_some_and(|at| at > since))
        {
            self.failed = Some(self.channel);
            self.move_to(before);
        }
        let stands = self.busy.is_some_and(|(_, since)| now.since(since) > SENDING_TIME_MAX);
        // While it sends too: under load there is always something in the chip.
        let is_due = stands || now.since(self.checked) >= CHECK_EVERY;
        if is_due && (stands || (self.is_ready && !self.lines.is_set()?)) {
            self.counts.restarts = self.counts.restarts.saturating_add(1);
            self.is_ready = false;
        }
        if is_due {
            self.checked = now;
        }
        if !self.is_ready {
            (self.busy, self.sending, self.repeats) = (None, None, 0);
            self.lines.start(self.channel)?;
            self.is_ready = true;
        }
        Ok(())
    }

    /// Packets to one robot since the start.
    pub fn packets(&self, robot: RobotId) -> PacketCounts {
        self.peers.get(robot.index()).map_or(PacketCounts::default(), |peer| peer.packets)
    }

    /// Counts since the start.
    pub fn counts(&self) -> BaseCounts {
        let robots = self.peers.iter().fold(Joined::default(), |sum, peer| {
            let own = peer.assembler.joined();
            Joined {
                frames: sum.frames.wrapping_add(own.frames),
                broken: sum.broken.saturating_add(own.broken),
                stray: sum.stray.saturating_add(own.stray),
            }
        });
        BaseCounts { robots, ..self.counts }
    }

    /// The end of a packet to one robot.
    fn answered(&mut self, now: Instant, robot: RobotId, came: bool) -> Result<(), Fault> {
        self.busy = None;
        self.lines.radio.clear_status_flags(StatusFlags::default().with_tx_ds(true).with_tx_df(true))?;
        let repeats = if self.is_asking { 0 } else { self.lines.repeats()? };
        let Some(peer) = self.peers.get_mut(robot.index()) else { return Ok(()) };
        if !self.is_asking {
            let packets = &mut peer.packets;
            packets.sent = packets.sent.wrapping_add(1);
            packets.repeats = packets.repeats.wrapping_add(u32::from(repeats));
            let end = if came { &mut packets.acknowledged } else { &mut packets.lost };
            *end = end.wrapping_add(1);
        }
        if came {
            peer.received_at = Some(now);
        } else {
            // The chip keeps the payload (PS 7.4.2). Without this fragment the robot cannot join the others.
            self.lines.radio.flush_tx()?;
            peer.has_more = false;
            // What is next for the chip may be another frame already.
            self.sending.take_if(|next| next.given > 0);
            if !self.is_asking {
                self.counts.unacknowledged = self.counts.unacknowledged.saturating_add(1);
            }
        }
        Ok(())
    }

    /// Gives the chip what it sends next, as far as it takes it.
    fn give(&mut self, now: Instant) -> Result<(), Fault> {
        loop {
            if let Some(done) = self.sending.take_if(|sending| sending.given == sending.fragments.len())
                && !done.is_question
            {
                self.counts.sent = self.counts.sent.saturating_add(1);
            }
            if self.sending.is_none() {
                self.sending = match self.next_frame(now) {
                    Some(next) => Some(next),
                    None if self.busy.is_none() => self.next_question(now),
                    None => None,
                };
            }
            let Some(sending) = &mut self.sending else { return Ok(()) };
            let is_open = self.busy.is_none()
                || (sending.target == Target::Everyone
                    && self.busy.is_some_and(|(target, _)| target == Target::Everyone));
            let Some(fragment) = sending.fragments.get(sending.given).filter(|_| is_open) else {
                return Ok(());
            };
            if self.busy.is_none() {
                let (address, repeats) = match sending.target {
                    Target::Everyone => (self.channel.everyone(), self.repeats),
                    Target::One(robot) if sending.is_question => {
                        let peer = self.peers.get(robot.index());
                        let is_here = peer.is_some_and(|peer| peer.is_here(now));
                        (self.channel.robot(robot), if is_here { REPEATS } else { 0 })
                    }
                    Target::One(robot) => (self.channel.robot(robot), REPEATS),
                };
                if repeats != self.repeats {
                    self.lines.repeat(repeats)?;
                    self.repeats = repeats;
                }
                self.lines.radio.as_tx(Some(&address))?;
            }
            let is_broadcast = sending.target == Target::Everyone;
            if !self.lines.radio.write(fragment, is_broadcast, true)? {
                return Ok(());
            }
            sending.given += 1;
            self.busy = Some((sending.target, now));
            self.is_asking = sending.is_question;
            if let Target::One(robot) = sending.target
                && let Some(peer) = self.peers.get_mut(robot.index())
            {
                peer.asked = Some(now);
                peer.has_more = false;
            }
        }
    }

    /// The host's next frame that is not too late.
    fn next_frame(&mut self, now: Instant) -> Option<Sending> {
        while let Some((since, target, packet)) = self.waiting.pop_front() {
            let cutter = match target {
                Target::Everyone => &mut self.cutter,
                Target::One(robot) => &mut self.peers.get_mut(robot.index())?.cutter,
            };
            match cutter.cut(&packet) {
                Ok(fragments) if now.since(since) <= wait_max(&packet) => {
                    return Some(Sending { target, fragments, given: 0, is_question: false });
                }
                _ => self.counts.late = self.counts.late.saturating_add(1),
            }
        }
        None
    }

    /// A robot to ask, where the host has nothing to say: one with more, one that was not spoken to, or one
    /// that may have been switched on.
    fn next_question(&mut self, now: Instant) -> Option<Sending> {
        // The robot that was asked longest ago.
        let waiting =
            RobotId::all().filter(|robot| self.peers.get(robot.index()).is_some_and(|peer| peer.is_due(now)));
        let longest = waiting.min_by_key(|robot| self.peers.get(robot.index()).map(|peer| peer.asked));
        let robot = if let Some(robot) = longest {
            robot
        } else {
            let (number, last) = self.search;
            if now.since(last) < SEARCH_EVERY {
                return None;
            }
            self.search = ((number + 1) % RobotId::COUNT as u8, now);
            let robot = RobotId::new(number)?;
            if self.peers.get(robot.index())?.is_here(now) {
                return None;
            }
            robot
        };
        self.counts.questions = self.counts.questions.wrapping_add(1);
        let mut fragments = Fragments::new();
        let _room = fragments.push(question(self.counts.questions));
        Some(Sending { target: Target::One(robot), fragments, given: 0, is_question: true })
    }
}

/// Commands and welcomes name their robot in the first byte after the variant (SPEC.md: HostMessage).
fn target(frame: &[u8]) -> Target {
    match (frame.get(SENDER_AT), frame.get(HEADER_LEN), frame.get(HEADER_LEN + 1)) {
        (Some(&HOST_SENDER), Some(&(COMMAND_VARIANT | WELCOME_VARIANT)), Some(robot)) => {
            RobotId::new(*robot).map_or(Target::Everyone, Target::One)
        }
        _ => Target::Everyone,
    }
}

/// Longest time that a frame may wait for the air.
fn wait_max(frame: &[u8]) -> Duration {
    let is_welcome =
        frame.get(SENDER_AT) == Some(&HOST_SENDER) && frame.get(HEADER_LEN) == Some(&WELCOME_VARIANT);
    if is_welcome { WELCOME_WAIT_MAX } else { WAIT_MAX }
}

/// Offset of the sender in a frame, and the host's number there; variants of the host's message.
const SENDER_AT: usize = 2;
const HOST_SENDER: u8 = 16;
const COMMAND_VARIANT: u8 = 1;
const WELCOME_VARIANT: u8 = 2;

const _: () = assert!(core::mem::size_of::<Payload>() <= 40);

/// Frames of the host that wait: those of two snapshots of four parts, twelve commands and what is passed on.
const WAITING_MAX: usize = 32;
/// Longest wait of a frame, the period of a snapshot: a newer one is behind it.
const WAIT_MAX: Duration = Duration::millis(10);
/// Longest wait of a welcome. It comes ten times a second, together with a snapshot and commands: all of them
/// take 11.5 ms of the air at 1 Mbit/s, and no newer one is behind it for 100 ms.
const WELCOME_WAIT_MAX: Duration = Duration::millis(50);
/// Repetitions of a packet without acknowledgement: at a loss of 30 % it arrives in 97 of 100 cases.
const REPEATS: u8 = 2;
/// Longest time between two questions to a robot: a beacon and telemetry are four fragments in 50 ms.
const ASK_EVERY: Duration = Duration::millis(10);
/// Silence after which a robot is searched for, and not asked.
const PRESENCE_LEASE: Duration = Duration::millis(500);
/// Period of the search for one number: every one in 0.32 s, without repeats, 3 % of the air.
const SEARCH_EVERY: Duration = Duration::millis(20);
/// Time after which a base station goes back to the channel that it left, where no robot followed: twice what
/// robots take to search all channels.
const RETURN_AFTER: Duration = Duration::millis(10_000);
/// A host that leads robots sends every 17 ms.
const STANDS_AFTER: Duration = Duration::millis(1_000);
/// Longest time from a frame's first fragment to its last: a robot answers every 10 ms, and its 32 frames
/// take half a second.
const ASSEMBLY_TIME_MAX: Duration = Duration::millis(60);
/// Time after which a chip that sends stands still: three payloads without repeats, or one with all, take 2
/// ms.
const SENDING_TIME_MAX: Duration = Duration::millis(20);
