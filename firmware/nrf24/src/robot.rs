//! `robot`: a robot's radio. It listens all the time, and what it has to say leaves in the chip's
//! acknowledgements. A base station that fell silent is searched for. Times in µs.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use protocol::link::Packet;
use protocol::station::{CHANNEL_MAX, CHANNEL_MIN};
use protocol::{Duration, Instant, RobotId};
use rf24::StatusFlags;
use rf24::radio::prelude::{EsbAutoAck, EsbFifo, EsbStatus};

use crate::chip::{CHECK_EVERY, Channel, Fault, Lines, Rate};
use crate::fragment::{Assembler, Cutter, Fragments, Joined, NotSent};

/// Counts of frames that a robot's radio dropped, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RobotCounts {
    /// Own frames for which there was no room, or that waited longer than `WAIT_MAX`.
    pub unsent: u32,
    /// Starts of the chip after the first: its supply dipped, or a register was upset.
    pub restarts: u32,
    /// Frames to this robot alone.
    pub own: Joined,
    /// Frames to every robot.
    pub everyone: Joined,
}

/// Radio of a robot on the chip nRF24L01+.
#[allow(missing_debug_implementations, reason = "the chip's driver has none")]
pub struct Robot<S, C, D> {
    lines: Lines<S, C, D>,
    channel: Channel,
    number: RobotId,
    cutter: Cutter,
    own: Assembler,
    everyone: Assembler,
    /// Own frames, oldest first, with when they came.
    waiting: heapless::Deque<(Instant, Fragments), WAITING_MAX>,
    /// Fragments of the first that the chip has already.
    given: usize,
    /// Time of the last packet to this robot.
    asked: Instant,
    checked: Instant,
    /// Time of the last packet of the base station, and where it came.
    heard: (Instant, Channel),
    /// Place in the search for a base station, and when it went there.
    search: (u16, Instant),
    /// False while the chip is not set up to the end: its supply dipped in the middle of it.
    is_ready: bool,
    counts: RobotCounts,
}

impl<S: SpiDevice, C: OutputPin, D: DelayNs> Robot<S, C, D> {
    /// Sets the chip up, on its bus with its line CE and a timer for pauses, and listens. Its arguments are
    /// those of [`Base::start`](crate::Base::start) and the robot.
    pub fn start(
        now: Instant,
        channel: Channel,
        robot: RobotId,
        spi: S,
        chip_enable: C,
        pause: D,
    ) -> Result<Self, Fault> {
        let mut radio = Self {
            lines: Lines::new(spi, chip_enable, pause),
            channel,
            number: robot,
            cutter: Cutter::new(channel.team),
            own: Assembler::new(channel.team, ASSEMBLY_TIME_MAX),
            everyone: Assembler::new(channel.team, ASSEMBLY_TIME_MAX),
            waiting: heapless::Deque::new(),
            given: 0,
            asked: now,
            checked: now,
            heard: (now, channel),
            search: (0, now),
            is_ready: false,
            counts: RobotCounts::default(),
        };
        radio.set_up()?;
        Ok(radio)
    }

    fn set_up(&mut self) -> Result<(), Fault> {
        self.is_ready = false;
        self.lines.start(self.channel)?;
        self.lines.open(1, self.channel.robot(self.number))?;
        self.lines.open(2, self.channel.everyone())?;
        self.lines.listen()?;
        self.is_ready = true;
        Ok(())
    }

    /// Takes a frame to send to the base station; it leaves with the next acknowledgements. `Ok(false)` where
    /// four frames wait already.
    pub fn send(&mut self, now: Instant, frame: &[u8]) -> Result<bool, NotSent> {
        if self.waiting.is_full() {
            self.counts.unsent = self.counts.unsent.saturating_add(1);
            return Ok(false);
        }
        let fragments = self.cutter.cut(frame)?;
        Ok(self.waiting.push_back((now, fragments)).is_ok())
    }

    /// Serves the chip; returns a frame that came. Call until `None` when the line IRQ is low, after
    /// [`Robot::send`], and every [`SERVE_EVERY`] at least.
    pub fn poll(&mut self, now: Instant) -> Result<Option<Packet>, Fault> {
        if now.since(self.checked) >= CHECK_EVERY {
            self.checked = now;
            if !self.is_ready || !self.lines.is_set()? {
                self.counts.restarts = self.counts.restarts.saturating_add(1);
                self.given = 0;
                self.set_up()?;
            }
        }
        while let Some((pipe, payload)) = self.lines.receive()? {
            let assembler = if pipe == 1 { &mut self.own } else { &mut self.everyone };
            if pipe == 1 {
                self.asked = now;
            }
            self.heard = (now, self.channel);
            if let Some(frame) = assembler.push(now, &payload) {
                return Ok(Some(frame));
            }
        }
        if now.since(self.heard.0) >= LOST_AFTER && now.since(self.search.1) >= DWELL_TIME {
            self.search(now)?;
        }
        self.answer(now)?;
        Ok(None)
    }

    /// The channel on which it listens.
    pub fn channel(&self) -> Channel {
        self.channel
    }

    /// Listens at the next place where the base station may be: in one of [`HOME_EVERY`] turns where it was
    /// heard last, in the others on all channels at both rates, one after another.
    fn search(&mut self, now: Instant) -> Result<(), Fault> {
        let turn = self.search.0.wrapping_add(1);
        self.search = (turn, now);
        let elsewhere = turn.wrapping_sub(turn / HOME_EVERY + 1);
        let place = elsewhere % (2 * CHANNELS);
        let (megahertz, rate) = if turn.is_multiple_of(HOME_EVERY) {
            (self.heard.1.megahertz, self.heard.1.rate)
        } else {
            let rate = if place < CHANNELS { Rate::Mbps2 } else { Rate::Mbps1 };
            (CHANNEL_MIN + (place % CHANNELS) as u8, rate)
        };
        self.channel = Channel { megahertz, rate, ..self.channel };
        self.given = 0;
        self.lines.listen_on(megahertz, rate)
    }

    /// Counts since the start.
    pub fn counts(&self) -> RobotCounts {
        RobotCounts { own: self.own.joined(), everyone: self.everyone.joined(), ..self.counts }
    }

    /// Gives the chip what it answers with next.
    fn answer(&mut self, now: Instant) -> Result<(), Fault> {
        self.lines.radio.clear_status_flags(StatusFlags::default().with_tx_ds(true))?;
        if now.since(self.asked) > WAIT_MAX {
            // No base station asks: what waits would be out of date when one does, in the chip too.
            self.asked = now;
            self.lines.radio.flush_tx()?;
            self.drop_first_if(self.given > 0);
        }
        while let Some((since, fragments)) = self.waiting.front() {
            if self.given == 0 && now.since(*since) > WAIT_MAX {
                self.drop_first_if(true);
                continue;
            }
            let Some(fragment) = fragments.get(self.given) else {
                self.waiting.pop_front();
                self.given = 0;
                continue;
            };
            if !self.lines.radio.write_ack_payload(1, fragment)? {
                break;
            }
            self.given += 1;
        }
        Ok(())
    }

    fn drop_first_if(&mut self, is_old: bool) {
        if is_old && self.waiting.pop_front().is_some() {
            self.given = 0;
            self.counts.unsent = self.counts.unsent.saturating_add(1);
        }
    }
}

/// Interval at which a radio is served while its line IRQ stays high.
pub const SERVE_EVERY: Duration = Duration::millis(1);
/// Longest wait of a beacon or telemetry: two of a robot's telemetry periods, after which a newer one is
/// there.
const WAIT_MAX: Duration = Duration::millis(100);
/// Silence of the base station after which a robot searches for it: four times the longest that a reset of a
/// chip or a loss of 30 % costs, and above the 320 ms in which a base station asks for every number.
const LOST_AFTER: Duration = Duration::millis(400);
/// Time at one place of the search: a base station with a host sends a snapshot every 17 ms at least.
const DWELL_TIME: Duration = Duration::millis(20);
/// Turns of the search of which one is where the base station was heard last.
const HOME_EVERY: u16 = 4;
/// Channels of the search.
const CHANNELS: u16 = (CHANNEL_MAX - CHANNEL_MIN + 1) as u16;
/// Own frames that wait: a beacon, telemetry, a handshake and a part of a decision.
const WAITING_MAX: usize = 4;
/// Longest time from a frame's first fragment to its last: four with every repeat take 6 ms; and the base
/// station sends 32 frames in no less than 30 ms.
const ASSEMBLY_TIME_MAX: Duration = Duration::millis(8);
