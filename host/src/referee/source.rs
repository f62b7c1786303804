//! `source`: the packets of one referee in the order in which they count, the game by these packets, and the
//! restraint that its packets out of order impose. Times: µs, the host's clock for arrivals, the referee's
//! for stamps.
//!
//! A packet is *in order* when its stamp is within [`WINDOW`] of where the referee's clock should be, not
//! before the newest stamp, and its counter either belongs to the same command or has risen. Only packets in
//! order change the game.
//!
//! HALT and STOP out of order also restrain, for [`HOLD`] from their arrival, without changing the stored
//! game. That is safe in both directions: a genuine HALT whose stamp seems old is repeated every 25 ms and
//! keeps the robots halted, while a late copy of an old STOP delays a newer command once, by 0.3 s. Copies
//! from a second network are recognised by stamp, command and counter for [`COPY_WITHIN`] and restrain
//! nothing.
//!
//! A clock or a counter that steps is followed when its packets agree with each other for [`CONFIRM`] and
//! none came in order meanwhile: two programs with the same identity never reach that, and only HALT and STOP
//! of both are obeyed.

use std::collections::VecDeque;

use geometry::{Field, Point};
use protocol::{Duration, Instant};
use rules::Limits;
use rules::state::{GameState, RefereeCommand};
use ssl::referee::{Command as Wire, Referee};

use super::identity::SourceKey;
use super::stamps::{StampClock, WINDOW};
use super::verdict::{Doubt, Taken};
use super::{Game, SILENCE, description};

/// Time for which HALT or STOP out of order restrains: 12 periods of the controller, and twice `COPY_WITHIN`,
/// so that a referee whose stamps stay the same restrains without a gap.
pub const HOLD: Duration = WINDOW;
/// A clock or counter that stepped is followed after this: 8 packets of the controller, and within [`WINDOW`]
/// of the step.
pub const CONFIRM: Duration = Duration::millis(200);
/// Packets that are not in order are reported for this time after the last one, and count as one period.
const DISORDER_REPORTED_FOR: Duration = SILENCE;
/// The same packet once more within this time is a copy.
const COPY_WITHIN: Duration = Duration::millis(150);
/// Number of packets kept to recognise copies: [`COPY_WITHIN`] at ten times the controller's rate.
const PACKETS_KEPT: usize = 64;
/// The old commands with which the controller announces a goal, once each.
const GOALS: [i32; 2] = [Wire::GoalYellow as i32, Wire::GoalBlue as i32];
/// A command without a time, as the controller's first HALT, counts as new, µs.
const NO_TIME: u64 = 0;

/// Strictness of a command. Ordered: the more restrictive one is greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Strictness {
    /// Robots may play the ball.
    Play,
    /// STOP or a timeout: slow and away from the ball.
    Stop,
    /// Robots must not move.
    Halt,
}

impl Strictness {
    pub(super) const fn of(command: RefereeCommand) -> Self {
        match command {
            RefereeCommand::Halt => Self::Halt,
            RefereeCommand::Stop | RefereeCommand::Timeout(_) => Self::Stop,
            _ => Self::Play,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Source {
    pub(super) key: SourceKey,
    /// When its newest packet came, copies aside.
    pub(super) received: Instant,
    pub(super) state: GameState,
    pub(super) game: Game,
    /// Newest command in order.
    pub(super) command: RefereeCommand,
    /// Why its last packet was out of order; none once a clock or counter that stepped is followed.
    doubted: Option<Doubted>,
    /// Step of its clock, µs, and when that was followed.
    pub(super) stepped: Option<(i64, Instant)>,
    newest: Stamped,
    clock: StampClock,
    candidate: Option<Candidate>,
    /// Until when STOP and HALT out of order restrain.
    stop_until: Instant,
    halt_until: Instant,
    recent: VecDeque<(Stamped, Instant)>,
}

/// The fields that order a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamped {
    stamp: u64,
    command: i32,
    counter: u32,
}

impl Stamped {
    const fn of(packet: &Referee) -> Self {
        let Referee { packet_timestamp: stamp, command, command_counter: counter, .. } = *packet;
        Self { stamp, command, counter }
    }

    const fn same_command(self, other: Self) -> bool {
        self.command == other.command && self.counter == other.counter
    }

    /// Commands given since `before`; none where the counter contradicts: it fell, or is unchanged though the
    /// command changed. A GOAL of the league's controller has the counter of the command that it repeats
    /// after it.
    fn steps(self, before: Self) -> Option<u32> {
        // A counter of 2³² commands may wrap; a step back of half of that is a restart.
        let steps = self.counter.wrapping_sub(before.counter);
        let after_goal = steps == 0 && GOALS.contains(&before.command);
        (self.same_command(before) || after_goal || (1..=u32::MAX / 2).contains(&steps)).then_some(steps)
    }
}

/// Packets that were not in order.
#[derive(Clone, Copy, Debug)]
struct Doubted {
    /// Why the last one was not.
    doubt: Doubt,
    /// When the first and the last packet of this period came.
    first: Instant,
    last: Instant,
}

/// A clock or counter that a source may have stepped to.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    clock: StampClock,
    newest: Stamped,
    since: Instant,
}

/// Result of a packet of one source.
#[derive(Debug)]
pub(super) enum Outcome {
    /// A packet in order, which was taken.
    Taken(Taken),
    /// Out of order; `restrains`: it is HALT or STOP, and obeyed.
    Doubted { doubt: Doubt, restrains: bool },
    /// A packet that was received before.
    Copy,
}

impl Source {
    /// Creates a source by its first packet, which is in order.
    pub(super) fn new(
        key: SourceKey,
        packet: &Referee,
        now: Instant,
        ball: Option<Point<Field>>,
    ) -> (Self, Taken) {
        let newest = Stamped::of(packet);
        let mut source = Self {
            key,
            received: now,
            state: GameState::new(),
            game: Game::default(),
            command: RefereeCommand::Halt,
            doubted: None,
            stepped: None,
            newest,
            clock: StampClock::new(newest.stamp, now),
            candidate: None,
            stop_until: Instant(0),
            halt_until: Instant(0),
            recent: VecDeque::with_capacity(PACKETS_KEPT),
        };
        let mut taken = Taken::default();
        source.remember(newest, now);
        source.follow_command(packet, now, ball, &mut taken);
        source.game.read(packet);
        (source, taken)
    }

    /// A packet of this source that came at `now`.
    pub(super) fn receive(&mut self, packet: &Referee, now: Instant, ball: Option<Point<Field>>) -> Outcome {
        let came = Stamped::of(packet);
        if self.recent.iter().any(|(known, at)| *known == came && now.since(*at).0 < COPY_WITHIN.0) {
            return Outcome::Copy;
        }
        self.remember(came, now);
        self.received = self.received.max(now);
        let mut taken = Taken::default();
        if let Some(doubt) = self.doubt(came, now) {
            if !self.confirmed(came, doubt, now) {
                let goes_on =
                    self.doubted.filter(|before| now.since(before.last).0 < DISORDER_REPORTED_FOR.0);
                self.doubted =
                    Some(Doubted { doubt, first: goes_on.map_or(now, |before| before.first), last: now });
                return Outcome::Doubted { doubt, restrains: self.restrain(packet, now) };
            }
            taken.counter_restarted = came.steps(self.newest).is_none();
            self.step(came, now, &mut taken);
        } else {
            self.candidate = None;
            self.clock.follow(came.stamp, now);
            taken.missed = came.steps(self.newest).unwrap_or(0).saturating_sub(1);
        }
        if !came.same_command(self.newest) {
            self.follow_command(packet, now, ball, &mut taken);
        }
        self.newest = came;
        self.game.read(packet);
        Outcome::Taken(taken)
    }

    /// Strictness of this source now: its newest command in order, and those out of order.
    pub(super) fn strictness(&self, now: Instant) -> Strictness {
        self.restraint(now).max(Strictness::of(self.command))
    }

    /// Strictness that its packets out of order impose.
    pub(super) fn restraint(&self, now: Instant) -> Strictness {
        match () {
            () if now < self.halt_until => Strictness::Halt,
            () if now < self.stop_until => Strictness::Stop,
            () => Strictness::Play,
        }
    }

    /// Why packets of it were not in order lately, if that is worth an operator's attention: not for packets
    /// that were overtaken, as is normal with two networks, nor for a counter that is contradicted for less
    /// than [`CONFIRM`], as by the league's controller when it resets a match.
    pub(super) fn reportable_doubt(&self, now: Instant) -> Option<Doubt> {
        let Doubted { doubt, first, last } =
            self.doubted.filter(|one| now.since(one.last).0 < DISORDER_REPORTED_FOR.0)?;
        match doubt {
            Doubt::Old(_) => None,
            Doubt::Counter if last.since(first).0 <= CONFIRM.0 => None,
            other => Some(other),
        }
    }

    /// The time is `now`, and the ball is here.
    pub(super) fn tick(
        &mut self,
        now: Instant,
        ball: Option<Point<Field>>,
        limits: &Limits,
    ) -> rules::state::Ticked {
        self.state.tick(now.0, ball, limits)
    }

    /// Why a packet is not in order; `None` if it is.
    fn doubt(&self, came: Stamped, now: Instant) -> Option<Doubt> {
        let ahead = self.clock.ahead(came.stamp, now);
        let by = Duration(ahead.unsigned_abs());
        if by.0 > WINDOW.0 {
            return Some(if ahead > 0 { Doubt::Ahead(by) } else { Doubt::Behind(by) });
        }
        if came.stamp < self.newest.stamp {
            return Some(Doubt::Old(Duration(self.newest.stamp - came.stamp)));
        }
        came.steps(self.newest).is_none().then_some(Doubt::Counter)
    }

    /// Whether this packet confirms that clock or counter have stepped.
    fn confirmed(&mut self, came: Stamped, doubt: Doubt, now: Instant) -> bool {
        if matches!(doubt, Doubt::Old(_)) {
            // It was overtaken by another packet: nothing has stepped.
            return false;
        }
        if let Some(candidate) = &mut self.candidate
            && candidate.clock.fits(came.stamp, now)
        {
            if came.stamp < candidate.newest.stamp {
                return false;
            }
            if came.steps(candidate.newest).is_some() {
                candidate.clock.follow(came.stamp, now);
                candidate.newest = came;
                return now.since(candidate.since).0 >= CONFIRM.0;
            }
        }
        self.candidate =
            Some(Candidate { clock: StampClock::new(came.stamp, now), newest: came, since: now });
        false
    }

    /// Follows the candidate's clock and counter.
    fn step(&mut self, came: Stamped, now: Instant, taken: &mut Taken) {
        let Some(candidate) = self.candidate.take() else { return };
        if !self.clock.fits(came.stamp, now) {
            let by = candidate.clock.ahead_of(&self.clock);
            taken.clock_stepped = Some(by);
            self.stepped = Some((by, now));
        }
        self.clock = candidate.clock;
        self.doubted = None;
    }

    /// HALT and STOP are obeyed whether their stamp fits or not. True: the packet was one of them.
    fn restrain(&mut self, packet: &Referee, now: Instant) -> bool {
        let until = now + HOLD;
        match Strictness::of(description::command_of(packet.command).unwrap_or(RefereeCommand::Halt)) {
            Strictness::Halt => self.halt_until = self.halt_until.max(until),
            Strictness::Stop => self.stop_until = self.stop_until.max(until),
            Strictness::Play => return false,
        }
        true
    }

    fn follow_command(
        &mut self,
        packet: &Referee,
        now: Instant,
        ball: Option<Point<Field>>,
        taken: &mut Taken,
    ) {
        let command = description::command_of(packet.command).unwrap_or_else(|| {
            taken.unknown = Some(packet.command);
            RefereeCommand::Halt
        });
        let age = match packet.command_timestamp {
            NO_TIME => 0,
            given => packet.packet_timestamp.saturating_sub(given),
        };
        self.command = command;
        let received = self.state.receive(command, now.0.saturating_sub(age), ball);
        taken.command = Some((command, received));
    }

    /// Whether it is the same referee by another network: with its identifier and its packets.
    pub(super) fn is_same_referee(&self, other: &Self) -> bool {
        let mut own = self.recent.iter().map(|(stamped, _)| stamped);
        self.key.identifier == other.key.identifier
            && own.any(|stamped| other.recent.iter().any(|(known, _)| known == stamped))
    }

    fn remember(&mut self, came: Stamped, now: Instant) {
        if self.recent.len() == PACKETS_KEPT {
            self.recent.pop_front();
        }
        self.recent.push_back((came, now));
    }
}
