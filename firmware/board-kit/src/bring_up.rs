//! `bring_up`: plays the checks of a robot's first start ([`runtime::bring_up`]) on a board, and logs what
//! each found and what to look at.

use core::cell::Cell;

use defmt::Display2Format;
use embassy_futures::select::select3;
use embassy_time::{Duration, Ticker};
use runtime::bring_up::{BringUp, Listener, Reading};
use runtime::ports::{Probes as _, RadioReceiver, WheelsPort};
use runtime::tasks::now;
use runtime::wheel::{CONTROL_PERIOD, Motors};

use crate::imu::Gyroscope;
use crate::radio;
use crate::sampling::{self, AnalogInputs, Probes};

/// Plays all checks, then leaves the motors without current. The robot on a stand, wheels off the ground, the
/// kicker's board unplugged: nothing here charges.
pub async fn run(
    wheels: impl WheelsPort,
    receiver: impl RadioReceiver,
    gyroscope: impl Gyroscope,
    analog: impl AnalogInputs,
) {
    let heard = Cell::new(Listener::default());
    select3(checks(wheels, &heard), hear(receiver, &heard), sampling::run(gyroscope, analog)).await;
}

async fn hear(mut receiver: impl RadioReceiver, heard: &Cell<Listener>) -> ! {
    loop {
        let packet = receiver.receive().await;
        let mut listener = heard.get();
        listener.hear(&packet);
        heard.set(listener);
    }
}

async fn checks(mut wheels: impl WheelsPort, heard: &Cell<Listener>) {
    let mut ticker = Ticker::every(Duration::from_micros(CONTROL_PERIOD.0));
    let (mut list, mut shown, mut failed) = (BringUp::new(), None, 0_u8);
    loop {
        ticker.next().await;
        let radio = heard.get().counts(radio::noise());
        let step = list.step(now(), &Reading { rims: wheels.measured(), seen: Probes.look(), radio });
        match step.motors {
            Motors::Driven(duty) => wheels.drive(duty, 0.0),
            Motors::Released => wheels.release(),
        }
        if step.check != shown {
            shown = step.check;
            if let Some(check) = &step.check {
                defmt::info!("{}", Display2Format(check));
            }
        }
        match step.report.map(|report| report.result) {
            Some(Ok(value)) => defmt::info!("  pass ({=f32})", value),
            Some(Err(finding)) => {
                failed = failed.saturating_add(1);
                defmt::error!("  FAIL: {}", Display2Format(&finding));
            }
            None => {}
        }
        if step.check.is_none() {
            defmt::info!("done: {=u8} failed; all without current", failed);
            return;
        }
    }
}
