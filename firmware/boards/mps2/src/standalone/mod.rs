//! `standalone`: start-up of the free-running board: clock, provisioned page, tasks, and their log.
//!
//! Without a page ([`protocol::provision`]) it drives nothing and sends nothing. Its log goes to stderr over
//! semihosting. A page and a fault to be tried out ([`mod@trial`]) are put into its flash by the emulator's
//! loader.

mod body;
mod clock;
mod console;
mod fault;
#[path = "../register.rs"]
mod register;
#[path = "../stack.rs"]
mod stack;
mod trial;
mod uart;
mod watchdog;

use casebase::CaseBase;
use embassy_executor::{SpawnError, Spawner};
use protocol::frame::RobotKeys;
use protocol::provision::{self, PAGE_LEN};
use runtime::hardware::{self, Wires};
use runtime::{BrainConfig, Mailboxes, tasks};

use console::print;

#[cortex_m_rt::entry]
fn main() -> ! {
    let core = cortex_m::Peripherals::take().expect("taken once, at start");
    clock::start(core.SYST);
    uart::start();
    let crash_context = fault::crash_context();
    if crash_context.panics > 0 {
        print(&[b"awake after a panic at ", crash_context.place()]);
    } else if watchdog::has_bitten() {
        print(&[b"awake after the watchdog's bite"]);
    }
    let who = match provision::read(page(), false) {
        Ok(who) => who,
        Err(error) => {
            let why: &[u8] = match error {
                provision::ProvisionError::Empty => b"no page",
                provision::ProvisionError::Version(_) => b"a page of another version",
                provision::ProvisionError::Damaged => b"a damaged page",
                provision::ProvisionError::OpenKey => b"a key of zeros",
            };
            print(&[why, b": no host can command this robot; run `onetwo firmware provision`"]);
            clock::run(|_| ())
        }
    };
    // Rises with every boot: recorded frames of an earlier boot epoch are refused in this one
    // (docs/architecture.md §6.1).
    let epoch = crash_context.boots;
    let config = BrainConfig { epoch, ..BrainConfig::hosted(who.robot, who.team, who.league) };
    print(&[b"ready"]);
    clock::run(|spawner| {
        start(spawner, config, case_library::division_b(), who.keys).expect("every task is started once");
    })
}

/// The provisioned page.
fn page() -> &'static [u8] {
    // SAFETY: plain memory of the board above the firmware (build.rs), never written after the start.
    unsafe { core::slice::from_raw_parts(protocol::slot::PAGE_ADDRESS as *const u8, PAGE_LEN) }
}

static BOXES: Mailboxes = Mailboxes::new();
static WIRES: Wires = Wires::new();

fn start(
    spawner: Spawner,
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
    spawner.spawn(watchdog()?);
    spawner.spawn(trial()?);
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

#[embassy_executor::task]
async fn watchdog() -> ! {
    hardware::watchdog(watchdog::start(), &BOXES).await
}

#[embassy_executor::task]
async fn trial() {
    trial::run().await;
}
