//! `robot`: tasks of the robot's board: the start, then one task for each continuous activity.
//!
//! All tasks run on one executor in one thread, in the order in which they are woken: the same order as on
//! the emulated board. The brain's longest step, 40,000 instructions, takes a fifth of a millisecond here; a
//! control step may be late by this time.

use board_stm32::analog::Analog;
use board_stm32::encoders::Encoders;
use board_stm32::fault::{self, CrashContext};
use board_stm32::imu::Imu;
use board_stm32::kicker::Kicker;
use board_stm32::radio::{self, UartReceiver, UartSender};
use board_stm32::sampling::{self, Probes};
use board_stm32::watchdog::BoardWatchdog;
use board_stm32::wheels::{Drivers, WheelDrivers};
use board_stm32::{flash, off};
use case_library::division_b;
use casebase::CaseBase;
use embassy_executor::{Executor, SpawnError, Spawner};
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_time::{Duration, Ticker};
use protocol::frame::RobotKeys;
use protocol::provision::{self, ProvisionError};
use runtime::hardware::{self, Wires};
use runtime::{BrainConfig, Mailboxes, tasks};
use static_cell::StaticCell;

#[cortex_m_rt::entry]
fn main() -> ! {
    let parts = board_stm32::start();
    // First of all, the levels of the motors' wires before they are driven.
    let drivers = Drivers::new(parts.motors);
    let kicker = Kicker::new(parts.kicker);
    let mut alarm = Output::new(parts.lamps.alarm, Level::Low, Speed::Low);
    let alive = Output::new(parts.lamps.alive, Level::Low, Speed::Low);
    log_crash(&fault::crash_context());
    let who = provision::read(flash::page(), false).inspect_err(|error| refuse(*error)).ok();
    let epoch = flash::begin(parts.keeper.flash)
        .inspect_err(|error| defmt::error!("no epoch ({}): no host can command this robot", error))
        .ok();
    let radio = radio::open(parts.radio);
    let (Some(who), Some(epoch), Some((sender, receiver))) = (who, epoch, radio) else {
        alarm.set_high();
        off::everything();
        loop {
            cortex_m::asm::wfi();
        }
    };
    let config = BrainConfig { epoch, ..BrainConfig::hosted(who.robot, who.team, who.league) };
    defmt::info!("robot {=u8}, team {=u8}, epoch {=u32}", who.robot.number(), who.team.0, epoch);
    let wheels = WheelDrivers::new(drivers, Encoders::new(parts.encoders));
    let (imu, analog) = (Imu::new(parts.imu), Analog::new(parts.analog));
    // The last step that may take long is over.
    let watchdog = BoardWatchdog::start(parts.keeper.watchdog);
    static EXECUTOR: StaticCell<Executor> = StaticCell::new();
    EXECUTOR.init(Executor::new()).run(|spawner| {
        let brain = (config, division_b(), who.keys);
        start(spawner, brain, wheels, kicker, imu, analog, sender, receiver, watchdog, alive)
            .expect("every task is started once");
    })
}

static BOXES: Mailboxes = Mailboxes::new();
static WIRES: Wires = Wires::new();

#[allow(clippy::too_many_arguments, reason = "what is on the board, each for one task")]
fn start(
    spawner: Spawner,
    (config, base, keys): (BrainConfig, CaseBase<'static>, RobotKeys),
    wheels: WheelDrivers,
    kicker: Kicker,
    imu: Imu,
    analog: Analog,
    sender: UartSender,
    receiver: UartReceiver,
    fed: BoardWatchdog,
    alive: Output<'static>,
) -> Result<(), SpawnError> {
    spawner.spawn(control(wheels)?);
    spawner.spawn(kick(kicker)?);
    spawner.spawn(sample(imu, analog)?);
    spawner.spawn(senses()?);
    spawner.spawn(radio_send(sender)?);
    spawner.spawn(radio_receive(receiver)?);
    spawner.spawn(brain(config, base, keys)?);
    spawner.spawn(watchdog(fed)?);
    spawner.spawn(report(alive)?);
    Ok(())
}

#[embassy_executor::task]
async fn brain(config: BrainConfig, base: CaseBase<'static>, keys: RobotKeys) -> ! {
    tasks::brain_with_keys(&config, base, keys, &BOXES).await
}

#[embassy_executor::task]
async fn control(wheels: WheelDrivers) -> ! {
    hardware::control(wheels, &BOXES, &WIRES).await
}

#[embassy_executor::task]
async fn kick(kicker: Kicker) -> ! {
    hardware::kicker(kicker, &WIRES).await
}

#[embassy_executor::task]
async fn sample(imu: Imu, analog: Analog) -> ! {
    sampling::run(imu, analog).await
}

#[embassy_executor::task]
async fn senses() -> ! {
    hardware::senses(Probes, &BOXES, &WIRES).await
}

#[embassy_executor::task]
async fn radio_receive(receiver: UartReceiver) -> ! {
    hardware::radio_receive(receiver, &BOXES).await
}

#[embassy_executor::task]
async fn radio_send(sender: UartSender) -> ! {
    tasks::radio_send(sender, &BOXES).await
}

#[embassy_executor::task]
async fn watchdog(fed: BoardWatchdog) -> ! {
    hardware::watchdog(fed, &BOXES).await
}

/// Blinks, and reports the board's state each second.
#[embassy_executor::task]
async fn report(mut alive: Output<'static>) -> ! {
    let mut ticker = Ticker::every(BLINK);
    loop {
        alive.set_high();
        ticker.next().await;
        alive.set_low();
        ticker.next().await;
        defmt::debug!(
            "{}; line errors {=u32}, unsent {=u32}, undelivered {=u32}",
            sampling::newest(),
            radio::noise(),
            BOXES.unsent(),
            BOXES.undelivered()
        );
    }
}

/// Reports what ended the last boot epoch.
fn log_crash(crash_context: &CrashContext) {
    if crash_context.panics > 0 {
        defmt::warn!(
            "start {=u32}; {=u32} panics, the last at {=str}",
            crash_context.boots,
            crash_context.panics,
            crash_context.place()
        );
    }
    if crash_context.bitten {
        defmt::warn!("awake after the watchdog's bite");
    }
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

/// Half of the lamp's period of a second.
const BLINK: Duration = Duration::from_millis(500);
