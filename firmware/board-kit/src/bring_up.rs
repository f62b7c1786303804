//! `bring_up`: plays the checks of a robot's first start ([`runtime::bring_up`]) on a board, logs what each
//! found and what to look at, and reports it to the host by radio (`onetwo robot bring-up`).

use core::cell::{Cell, RefCell};

use defmt::Display2Format;
use embassy_futures::join::join;
use embassy_futures::select::select3;
use embassy_time::{Duration, Ticker};
use protocol::bring_up::Reporter;
use runtime::bring_up::{BringUp, Listener, REPORT_EVERY, Reading, Results};
use runtime::ports::{Probes as _, RadioReceiver, RadioSender, WheelsPort};
use runtime::tasks::now;
use runtime::wheel::{CONTROL_PERIOD, Motors};

use crate::imu::Gyroscope;
use crate::radio;
use crate::robot::Identity;
use crate::sampling::{self, AnalogInputs, Probes};

/// Plays all checks, then leaves the motors without current. The robot on a stand, wheels off the ground, the
/// kicker's board unplugged: nothing here charges. A robot that has its page reports the results to its host
/// for as long as it runs; without it they are on the log alone, and this ends.
pub async fn run(
    wheels: impl WheelsPort,
    (sender, receiver): (impl RadioSender, impl RadioReceiver),
    gyroscope: impl Gyroscope,
    analog: impl AnalogInputs,
    who: Option<Identity>,
) {
    let listener = Cell::new(Listener::default());
    let results = who.map(|who| {
        let (team, robot, epoch) = (who.config.team, who.config.robot, who.config.epoch);
        RefCell::new(Results::new(Reporter { team, robot, key: who.keys.host, epoch }))
    });
    if results.is_none() {
        defmt::warn!("no report to a host: the results are on this log alone");
    }
    let reports = async {
        if let Some(results) = &results {
            report(sender, results, &listener).await;
        }
    };
    let plays = join(checks(wheels, &listener, results.as_ref()), reports);
    select3(plays, receive(receiver, &listener), sampling::run(gyroscope, analog)).await;
}

/// Reports the state of the checks to the host, for ever.
async fn report(mut sender: impl RadioSender, results: &RefCell<Results>, listener: &Cell<Listener>) {
    let mut ticker = Ticker::every(Duration::from_micros(REPORT_EVERY.0));
    loop {
        ticker.next().await;
        // Both borrows end before anything waits.
        let packet = results.try_borrow_mut().ok().and_then(|mut results| {
            let team = results.team();
            results.packet(listener.get().host_epoch(team))
        });
        if let Some(packet) = packet {
            sender.send(packet).await;
        }
    }
}

async fn receive(mut receiver: impl RadioReceiver, listener: &Cell<Listener>) -> ! {
    loop {
        let packet = receiver.receive().await;
        let mut counted = listener.get();
        counted.receive(&packet);
        listener.set(counted);
    }
}

async fn checks(mut wheels: impl WheelsPort, listener: &Cell<Listener>, results: Option<&RefCell<Results>>) {
    let mut ticker = Ticker::every(Duration::from_micros(CONTROL_PERIOD.0));
    let (mut list, mut shown, mut failed) = (BringUp::new(), None, 0_u8);
    loop {
        ticker.next().await;
        let radio = listener.get().counts(radio::line_errors());
        let step = list.step(now(), &Reading { rims: wheels.measured(), seen: Probes.look(), radio });
        match step.motors {
            Motors::Driven(duty) => wheels.drive(duty, 0.0),
            Motors::Released => wheels.release(),
        }
        if let Some(mut results) = results.and_then(|results| results.try_borrow_mut().ok()) {
            results.take(&step);
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
