//! `serial`: parts of the free-running board without a simulator: a serial line for a radio, simulated
//! motors, and the tasks of a real robot's body.

mod body;
#[path = "../register.rs"]
mod register;
mod uart;

use casebase::CaseBase;
use embassy_executor::{SpawnError, Spawner};
use protocol::frame::RobotKeys;
use runtime::hardware::{self, Wires};
use runtime::{BrainConfig, Mailboxes, tasks};

pub(crate) static BOXES: Mailboxes = Mailboxes::new();
static WIRES: Wires = Wires::new();

/// Takes the current off all actuators at once, in any state.
pub(crate) fn stop() {
    body::stop();
}

pub(crate) struct Radio(());

#[allow(clippy::unnecessary_wraps, reason = "the other image's radio can be missing")]
pub(crate) fn open() -> Result<Radio, &'static [u8]> {
    uart::start();
    Ok(Radio(()))
}

pub(crate) fn start(
    spawner: Spawner,
    _radio: Radio,
    config: BrainConfig,
    base: CaseBase<'static>,
    keys: RobotKeys,
) -> Result<(), SpawnError> {
    spawner.spawn(control()?);
    spawner.spawn(kicker()?);
    spawner.spawn(senses()?);
    spawner.spawn(radio_send()?);
    spawner.spawn(radio_receive()?);
    spawner.spawn(brain(config, base, keys)?);
    Ok(())
}

#[embassy_executor::task]
async fn brain(config: BrainConfig, base: CaseBase<'static>, keys: RobotKeys) -> ! {
    tasks::brain_with_keys(&config, base, keys, &BOXES).await
}

#[embassy_executor::task]
async fn control() -> ! {
    hardware::control(body::Motors, &BOXES, &WIRES).await
}

#[embassy_executor::task]
async fn kicker() -> ! {
    hardware::kicker(body::Coil::new(), &WIRES).await
}

#[embassy_executor::task]
async fn senses() -> ! {
    hardware::senses(body::Senses, &BOXES, &WIRES).await
}

#[embassy_executor::task]
async fn radio_receive() -> ! {
    hardware::radio_receive(uart::UartReceiver::new(), &BOXES).await
}

#[embassy_executor::task]
async fn radio_send() -> ! {
    tasks::radio_send(uart::UartSender, &BOXES).await
}
