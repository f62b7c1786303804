//! `robot`: the start of the robot's board, and what it has. The program names its radio.
//!
//! A step of the brain of 40,000 instructions, its budget, takes a fifth of a millisecond here; the longest
//! in docs/firmware.md takes three times as long. A control step may be late by this time.

use board_kit::robot::{Board, BoardParts, identity, log_crash};
use board_kit::wheels::Wheels;
use board_kit::{ledger, robot_tasks};
use board_stm32::drivers::{self, BoardWatchdog, Drivers, Encoders, Kicker};
use board_stm32::flash::{self, Ledger};
use board_stm32::{fault, off};
use case_library::division_b;
use embassy_executor::Executor;
use embassy_stm32::gpio::Output;
use static_cell::StaticCell;
use stm32_kit::pwm::low;
use stm32_kit::{analog, lines};

/// A robot's board with an STM32H743.
struct Stm32;

impl Board for Stm32 {
    type Wheels = Wheels<Drivers, Encoders>;
    type Kicker = Kicker;
    type Gyroscope = lines::BoardImu;
    type Analog = analog::Analog;
    type Sender = crate::radio::Sender;
    type Receiver = crate::radio::Receiver;
    type Watchdog = BoardWatchdog;
    type Lamp = Output<'static>;
}

robot_tasks!(Stm32);

#[cortex_m_rt::entry]
fn main() -> ! {
    let parts = board_stm32::start();
    // First of all, the levels of the motors' wires before they are driven.
    let motors = drivers::motors(parts.motors);
    let kicker = drivers::kicker(parts.kicker);
    let (mut alarm, alive) = (low(parts.lamps.alarm), low(parts.lamps.alive));
    log_crash(&fault::crash_record());
    let who = identity(flash::page(), ledger::begin(&mut Ledger::new(parts.keeper.flash)));
    let radio = who.as_ref().and_then(|who| crate::radio::open(who, parts.radio, parts.chip));
    let (Some(who), Some((sender, receiver))) = (who, radio) else {
        alarm.set_high();
        off::everything();
        loop {
            cortex_m::asm::wfi();
        }
    };
    let parts = BoardParts::<Stm32> {
        wheels: Wheels::new(motors, drivers::encoders(parts.encoders)),
        kicker,
        gyroscope: drivers::imu(parts.imu),
        analog: drivers::analog(parts.analog),
        sender,
        receiver,
        // The last step that may take long is over.
        watchdog: BoardWatchdog::start(parts.keeper.watchdog),
        alive,
    };
    static EXECUTOR: StaticCell<Executor> = StaticCell::new();
    EXECUTOR.init(Executor::new()).run(|spawner| {
        run(spawner, who, division_b(), parts).expect("every task is started once");
    })
}
