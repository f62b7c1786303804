//! `standalone`: start-up of a board that runs by its own clock: clock, provisioned page, tasks, and their
//! log. The program names its radio and body ([`crate::parts`]).
//!
//! Without a page ([`protocol::provision`]) it drives nothing and sends nothing. Its log goes to stderr over
//! semihosting. A page and a fault to be tried out ([`mod@trial`]) are put into its flash by the emulator's
//! loader.

mod clock;
pub(crate) mod console;
mod fault;
#[path = "../stack.rs"]
mod stack;
mod trial;
mod watchdog;

use protocol::provision::{self, PAGE_LEN};
use runtime::{BrainConfig, hardware};

use crate::parts;
use console::print;

#[cortex_m_rt::entry]
fn main() -> ! {
    let core = cortex_m::Peripherals::take().expect("taken once, at start");
    clock::start(core.SYST);
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
    let radio = match parts::open() {
        Ok(radio) => radio,
        Err(why) => {
            print(&[why]);
            clock::run(|_| ())
        }
    };
    // Rises with every boot: recorded frames of an earlier boot epoch are refused in this one
    // (docs/architecture.md §6.1).
    let epoch = crash_context.boots;
    let config = BrainConfig { epoch, ..BrainConfig::hosted(who.robot, who.team, who.league) };
    print(&[b"ready"]);
    clock::run(|spawner| {
        parts::start(spawner, radio, config, case_library::division_b(), who.keys)
            .expect("every task is started once");
        spawner.spawn(watchdog().expect("started once"));
        spawner.spawn(trial().expect("started once"));
    })
}

fn page() -> &'static [u8] {
    // SAFETY: plain memory of the board above the firmware (build.rs), never written after the start.
    unsafe { core::slice::from_raw_parts(protocol::slot::PAGE_ADDRESS as *const u8, PAGE_LEN) }
}

#[embassy_executor::task]
async fn watchdog() -> ! {
    hardware::watchdog(watchdog::start(), &parts::BOXES).await
}

#[embassy_executor::task]
async fn trial() {
    trial::run().await;
}
