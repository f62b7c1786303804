//! `robot`: what is on a board, who the robot is, and its tasks.
//!
//! A board implements [`Board`], calls [`robot_tasks!`](crate::robot_tasks) for it and, from `main`, the
//! function `run` that the macro makes.

use embassy_time::{Duration, Ticker};
use embedded_hal::digital::OutputPin;
use protocol::frame::{RobotKeys, TeamKey};
use protocol::provision::{self, ProvisionError};
use protocol::{RobotId, TeamId};
use rules::League;
use runtime::BrainConfig;
use runtime::Mailboxes;
use runtime::ports::{Kicker, RadioReceiver, RadioSender, Watchdog, WheelsPort};

use crate::crash::CrashRecord;
use crate::imu::Gyroscope;
use crate::ledger::CounterError;
use crate::not_wired::NotWired;
use crate::radio;
use crate::sampling::{self, AnalogInputs};

/// Parts of a board; the requirements stand at each trait.
pub trait Board {
    /// Four wheels and the dribbler, mostly [`Wheels`](crate::wheels::Wheels).
    type Wheels: WheelsPort + 'static;
    /// The kicker's charger and coils.
    type Kicker: Kicker + 'static;
    /// The gyroscope and accelerometer.
    type Gyroscope: Gyroscope + 'static;
    /// Battery, capacitor and break-beam sensor.
    type Analog: AnalogInputs + 'static;
    /// Sending half of the radio.
    type Sender: RadioSender + 'static;
    /// Receiving half of the radio.
    type Receiver: RadioReceiver + 'static;
    /// The watchdog, which runs already.
    type Watchdog: Watchdog + 'static;
    /// The lamp that blinks as long as the robot runs.
    type Lamp: OutputPin + 'static;
}

/// The parts of a board, each for one task.
#[allow(missing_debug_implementations, reason = "pins have none")]
pub struct BoardParts<B: Board> {
    /// Wheels with all motors without current.
    pub wheels: B::Wheels,
    /// A kicker that discharges.
    pub kicker: B::Kicker,
    /// The gyroscope, not started yet.
    pub gyroscope: B::Gyroscope,
    /// Battery, capacitor and break-beam sensor.
    pub analog: B::Analog,
    /// Sending half of the radio.
    pub sender: B::Sender,
    /// Receiving half of the radio.
    pub receiver: B::Receiver,
    /// The watchdog; started last, because a start may take seconds.
    pub watchdog: B::Watchdog,
    /// Lamp that blinks as long as the robot runs.
    pub alive: B::Lamp,
}

/// Identity of a robot, and number of this start.
#[derive(Clone)]
#[allow(missing_debug_implementations, reason = "keys must not be printed")]
pub struct Identity {
    /// Configuration of its brain.
    pub config: BrainConfig,
    /// Keys with the host and with teammates.
    pub keys: RobotKeys,
}

impl Identity {
    /// Identity of keys of zeros, for a board that has no page yet. Only for one without a radio: with keys
    /// that are public, any sender could command it.
    pub fn unprovisioned<B: Board<Sender = NotWired, Receiver = NotWired>>() -> Self {
        let config = BrainConfig::hosted(RobotId::ZERO, TeamId(0), League::DivisionB);
        let keys = TeamKey::ZERO.of_robot(config.robot);
        Self { config, keys }
    }
}

/// The robot's identity from its provisioned page and its counter of starts; `None`, and the reason on the
/// log, where no host could command it.
pub fn identity(page: &[u8], epoch: Result<u32, CounterError>) -> Option<Identity> {
    let who = provision::read(page, false).inspect_err(|error| refuse(*error)).ok();
    let epoch = epoch.inspect_err(|error| {
        let why = match error {
            CounterError::Full => "all epochs are used",
            CounterError::Worn => "the flash keeps nothing",
        };
        defmt::error!("no epoch ({=str}): no host can command this robot", why);
    });
    let (who, epoch) = (who?, epoch.ok()?);
    defmt::info!("robot {=u8}, team {=u8}, epoch {=u32}", who.robot.number(), who.team.0, epoch);
    let config = BrainConfig { epoch, ..BrainConfig::hosted(who.robot, who.team, who.league) };
    Some(Identity { config, keys: who.keys })
}

/// Reports why this robot cannot be commanded.
fn refuse(error: ProvisionError) {
    let why = match error {
        ProvisionError::Empty => "no page",
        ProvisionError::Version(_) => "a page of another version",
        ProvisionError::Damaged => "a damaged page",
        ProvisionError::OpenKey => "a key of zeros",
    };
    defmt::error!("{=str}: no host can command this robot; run `onetwo firmware provision`", why);
}

/// Reports what ended the last boot epoch.
pub fn log_crash(record: &CrashRecord) {
    if record.panics > 0 {
        let (boots, panics) = (record.boots, record.panics);
        defmt::warn!("start {=u32}; {=u32} panics, the last at {=str}", boots, panics, record.place());
    }
    if record.bitten {
        defmt::warn!("awake after the watchdog's bite");
    }
}

/// Reports a part of a new board that is not wired yet ([`NotWired`](crate::not_wired::NotWired)).
pub fn log_not_wired(part: &str) {
    defmt::warn!("{=str}: not wired yet", part);
}

/// Blinks, and reports the board's state each second.
pub async fn report(mut alive: impl OutputPin, boxes: &Mailboxes) -> ! {
    let mut ticker = Ticker::every(BLINK_HALF_PERIOD);
    loop {
        // A lamp that cannot be switched is no reason to stop.
        let _ = alive.set_high();
        ticker.next().await;
        let _ = alive.set_low();
        ticker.next().await;
        defmt::debug!(
            "{}; line errors {=u32}, unsent {=u32}, undelivered {=u32}",
            sampling::newest(),
            radio::line_errors(),
            boxes.unsent(),
            boxes.undelivered()
        );
    }
}

/// Half of the lamp's period of a second.
const BLINK_HALF_PERIOD: Duration = Duration::from_millis(500);

/// Declares the tasks of a robot (embassy's tasks cannot be generic) and `run`, which starts them and never
/// returns. `$board` implements [`Board`](crate::robot::Board); `$executor` is the executor, taken once.
///
/// All tasks run on one executor in one thread, in the order in which they are woken: the same order as on
/// the emulated board.
#[macro_export]
macro_rules! robot_tasks {
    ($board:ty) => {
        static BOXES: $crate::runtime::Mailboxes = $crate::runtime::Mailboxes::new();
        static WIRES: $crate::runtime::hardware::Wires = $crate::runtime::hardware::Wires::new();

        /// Starts all tasks of the robot.
        fn run(
            spawner: $crate::embassy_executor::Spawner,
            who: $crate::robot::Identity,
            base: casebase::CaseBase<'static>,
            parts: $crate::robot::BoardParts<$board>,
        ) -> Result<(), $crate::embassy_executor::SpawnError> {
            spawner.spawn(control(parts.wheels)?);
            spawner.spawn(kick(parts.kicker)?);
            spawner.spawn(sample(parts.gyroscope, parts.analog)?);
            spawner.spawn(senses()?);
            spawner.spawn(radio_send(parts.sender)?);
            spawner.spawn(radio_receive(parts.receiver)?);
            spawner.spawn(brain(who, base)?);
            spawner.spawn(watchdog(parts.watchdog)?);
            spawner.spawn(report(parts.alive)?);
            Ok(())
        }

        #[embassy_executor::task]
        async fn brain(who: $crate::robot::Identity, base: casebase::CaseBase<'static>) -> ! {
            $crate::runtime::tasks::brain_with_keys(&who.config, base, who.keys, &BOXES).await
        }

        #[embassy_executor::task]
        async fn control(wheels: <$board as $crate::robot::Board>::Wheels) -> ! {
            $crate::runtime::hardware::control(wheels, &BOXES, &WIRES).await
        }

        #[embassy_executor::task]
        async fn kick(kicker: <$board as $crate::robot::Board>::Kicker) -> ! {
            $crate::runtime::hardware::kicker(kicker, &WIRES).await
        }

        #[embassy_executor::task]
        async fn sample(
            gyroscope: <$board as $crate::robot::Board>::Gyroscope,
            analog: <$board as $crate::robot::Board>::Analog,
        ) -> ! {
            $crate::sampling::run(gyroscope, analog).await
        }

        #[embassy_executor::task]
        async fn senses() -> ! {
            $crate::runtime::hardware::senses($crate::sampling::Probes, &BOXES, &WIRES).await
        }

        #[embassy_executor::task]
        async fn radio_receive(receiver: <$board as $crate::robot::Board>::Receiver) -> ! {
            $crate::runtime::hardware::radio_receive(receiver, &BOXES).await
        }

        #[embassy_executor::task]
        async fn radio_send(sender: <$board as $crate::robot::Board>::Sender) -> ! {
            $crate::runtime::tasks::radio_send(sender, &BOXES).await
        }

        #[embassy_executor::task]
        async fn watchdog(fed: <$board as $crate::robot::Board>::Watchdog) -> ! {
            $crate::runtime::hardware::watchdog(fed, &BOXES).await
        }

        #[embassy_executor::task]
        async fn report(alive: <$board as $crate::robot::Board>::Lamp) -> ! {
            $crate::robot::report(alive, &BOXES).await
        }
    };
}
