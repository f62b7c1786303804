//! `bring_up`: plays the checks of a robot's first start ([`runtime::bring_up`]) on a board, logs what each
//! found and what to look at, and reports it and the log to the host by radio (`onetwo robot bring-up`),
//! which may measure the kicker.

use core::cell::{Cell, RefCell};

use defmt::Display2Format;
use embassy_futures::join::join3;
use embassy_futures::select::select3;
use embassy_time::{Duration, Ticker};
use protocol::bring_up::Reporter;
use runtime::bring_up::{BringUp, Listener, LogRing, REPORT_EVERY, Reading, Results, RobotLog};
use runtime::kicker::KickerAct;
use runtime::ports::{Kicker, Probes as _, RadioReceiver, RadioSender, Watchdog, WheelsPort};
use runtime::tasks::now;
use runtime::wheel::{CONTROL_PERIOD, Motors};

use crate::imu::Gyroscope;
use crate::radio;
use crate::robot::Identity;
use crate::sampling::{self, AnalogInputs, Probes};

/// Plays all checks, then leaves the motors without current. The robot on a stand, wheels off the ground, the
/// kicker's board unplugged: nothing here charges unless the host arms the kicker, and then no wheel is
/// driven any more. A robot that has its page reports to its host, and sends it what `log` has; without it
/// all is on the log alone. Never returns.
pub async fn run(
    wheels: impl WheelsPort,
    (kicker, watchdog): (impl Kicker, impl Watchdog),
    (sender, receiver): (impl RadioSender, impl RadioReceiver),
    gyroscope: impl Gyroscope,
    analog: impl AnalogInputs,
    who: Option<Identity>,
    log: impl LogRing,
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
            report(sender, results, &listener, RobotLog::new(log)).await;
        }
    };
    let results = results.as_ref();
    let plays = join3(checks(wheels, &listener, results), reports, kicks(kicker, watchdog, results));
    select3(plays, receive(receiver, &listener, results), sampling::run(gyroscope, analog)).await;
}

/// Reports the state of checks and kicker to the host, then a piece of the log, for ever.
async fn report(
    mut sender: impl RadioSender,
    results: &RefCell<Results>,
    listener: &Cell<Listener>,
    mut log: RobotLog<impl LogRing>,
) {
    let mut ticker = Ticker::every(Duration::from_micros(REPORT_EVERY.0));
    loop {
        ticker.next().await;
        let began = now();
        // All borrows end before anything waits.
        let (host, packets) = results.try_borrow_mut().map_or((0, None), |mut results| {
            let host = listener.get().host_epoch(results.team());
            (host, Some([results.packet(host), Some(results.kick_packet(began, host))]))
        });
        for packet in packets.into_iter().flatten().flatten() {
            sender.send(packet).await;
        }
        // A line that is busy for half of the time with the rest has no room for the log.
        let is_busy = 2 * now().since(began).0 > REPORT_EVERY.0;
        let piece = log.report(now(), if is_busy { 0 } else { host });
        let results = piece.as_ref().and_then(|_| results.try_borrow_mut().ok());
        let packet = results.zip(piece).map(|(mut results, piece)| results.log_packet(&piece));
        if let Some(packet) = packet {
            sender.send(packet).await;
        }
    }
}

/// The kicker, which runs empty until the host arms it.
async fn kicks(
    mut kicker: impl Kicker,
    mut watchdog: impl Watchdog,
    results: Option<&RefCell<Results>>,
) -> ! {
    loop {
        watchdog.feed();
        let (state, results) = (kicker.state(), results.and_then(|results| results.try_borrow_mut().ok()));
        let act = results.map_or(KickerAct::Bleed, |mut results| results.kicks.step(now(), state));
        kicker.act(act).await;
    }
}

async fn receive(
    mut receiver: impl RadioReceiver,
    listener: &Cell<Listener>,
    results: Option<&RefCell<Results>>,
) -> ! {
    loop {
        let packet = receiver.receive().await;
        let mut counted = listener.get();
        counted.receive(&packet);
        listener.set(counted);
        if let Some(mut results) = results.and_then(|results| results.try_borrow_mut().ok()) {
            results.kicks.receive(now(), &packet);
        }
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
            if results.kicks.is_armed(now()) {
                wheels.release();
                defmt::warn!("the kicker is measured: no check goes on until the next start");
                return;
            }
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
