//! `hardware`: hardware tasks of a robot's computer: wheel control (1 kHz), kicker, sensors, and the watchdog
//! over all of them.
//!
//! ```text
//! brain ─► orders ─► control (1 kHz) ─► wheels, dribbler
//!                      │  └─ rims ─► senses (100 Hz) ─► inbox ─► brain
//!                      └─ request ─► kicker (1 kHz) ─► capacitor, coils
//! control, radio, brain ─► progress ─► watchdog
//! ```
//!
//! **What may be lost.** Orders, rim speeds and kicker requests are signals: only the newest counts. Packets
//! and sensor frames go through the channels of [`Mailboxes`], which count what they drop.

use core::pin::pin;
use core::sync::atomic::{AtomicBool, Ordering};

use embassy_futures::select::{Either, select};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, Ticker, Timer};
use protocol::parts::{Part, PartState};
use protocol::robot_io::{Health, OmniKick, SensorFrame, WHEELED_STEP};

use crate::kicker::{ChargeWatch, Interlock, KickerAct};
use crate::mailboxes::{Arrival, Mailboxes};
use crate::parts::{Means, PartsEstimator, Rolled};
use crate::ports::{Kicker, Probes, RadioReceiver, Watchdog, WheelsPort};
use crate::progress::RobotPart;
use crate::tasks::now;
use crate::wheel::{CONTROL_PERIOD, Control, Lost, Motors, WHEELS};

/// Signals between the tasks of this module.
pub struct Wires {
    /// Measured rim speeds, m/s.
    rims: Signal<CriticalSectionRawMutex, [f32; WHEELS]>,
    /// Means of the control loop's readings over the brain's period.
    rolled: Signal<CriticalSectionRawMutex, Rolled>,
    /// Parts that the control loop goes on without.
    lost: Signal<CriticalSectionRawMutex, Lost>,
    /// Newest request to the kicker.
    request: Signal<CriticalSectionRawMutex, OmniKick>,
    /// The capacitor's voltage does not follow the orders to the kicker.
    charge_doubted: AtomicBool,
}

impl Wires {
    /// Signals of which none is set.
    pub const fn new() -> Self {
        Self {
            rims: Signal::new(),
            rolled: Signal::new(),
            lost: Signal::new(),
            request: Signal::new(),
            charge_doubted: AtomicBool::new(false),
        }
    }
}

impl Default for Wires {
    fn default() -> Self {
        Self::new()
    }
}

/// Controls the wheels to the brain's orders, and to a stop without orders. Replaces
/// [`tasks::body`](crate::tasks::body).
pub async fn control(mut wheels: impl WheelsPort, boxes: &Mailboxes, wires: &Wires) -> ! {
    let mut ticker = Ticker::every(Duration::from_micros(CONTROL_PERIOD.0));
    let mut control = Control::new();
    let mut means = Means::default();
    loop {
        ticker.next().await;
        let now = now();
        if let Some(orders) = boxes.orders.try_take() {
            control.take_orders(now, orders);
        }
        if let Some(lost) = wires.lost.try_take() {
            control.lose(lost);
        }
        let measured = wheels.measured();
        let step = control.step(now, measured);
        match step.motors {
            Motors::Driven(duty) => wheels.drive(duty, step.dribbler),
            Motors::Released => wheels.release(),
        }
        if let Some(rolled) = means.add(measured, step.motors) {
            wires.rolled.signal(rolled);
        }
        wires.rims.signal(measured);
        wires.request.signal(step.kick);
        boxes.progress.mark(RobotPart::Control);
    }
}

/// Charges and fires, as far as the interlock allows.
pub async fn kicker(mut kicker: impl Kicker, wires: &Wires) -> ! {
    let (mut interlock, mut watch) = (Interlock::new(), ChargeWatch::new());
    loop {
        // The control loop requests it every millisecond; once it stops, the kicker must not fire.
        let request = match select(wires.request.wait(), Timer::after(CONTROL_SILENT_AFTER)).await {
            Either::First(request) => request,
            Either::Second(()) => OmniKick::Discharge,
        };
        let (now, state) = (now(), kicker.state());
        let act = interlock.step(now, request, state);
        wires.charge_doubted.store(watch.step(now, act, state.volts), Ordering::Relaxed);
        kicker.act(act).await;
        if matches!(act, KickerAct::Flat(_) | KickerAct::Chip(_)) {
            // A request made while the coil had current is outdated.
            wires.request.reset();
        }
    }
}

/// Passes the readings of wheels and probes to the brain, at its pace. The robot's position comes from the
/// host.
pub async fn senses(mut probes: impl Probes, boxes: &Mailboxes, wires: &Wires) -> ! {
    let mut ticker = Ticker::every(BRAIN_PERIOD);
    let mut parts = PartsEstimator::new();
    let mut rims = [0.0; WHEELS];
    loop {
        ticker.next().await;
        if let Some(newest) = wires.rims.try_take() {
            rims = newest;
        }
        let seen = probes.look();
        if let Some(rolled) = wires.rolled.try_take() {
            let before = parts.lost();
            let time = now();
            let [beam, radio] = boxes.doubted(time);
            parts.step(time, &rolled, seen.turn, [beam, wires.charge_doubted.load(Ordering::Relaxed), radio]);
            boxes.parts.lock(|report| report.set(parts.report()));
            if parts.lost() != before {
                wires.lost.signal(parts.lost());
            }
        }
        // A gyroscope measures the turning rate better than four wheels, where there is one.
        let odometry = parts.odometry(rims, seen.turn);
        let health = Health { battery: seen.battery, tipped: seen.tipped, kicker_ready: seen.kicker_ready };
        let sensors = SensorFrame {
            pose: None,
            ball: None,
            opponents: heapless::Vec::new(),
            // A sensor that has failed is no ball: the host's is left.
            ball_contact: seen.ball && parts.report().state(Part::BREAK_BEAM) != PartState::Failed,
            busy: false,
            odometry,
            health,
            camera: None,
        };
        boxes.room_for_arrival().await;
        boxes.deliver(Arrival::Sensors(sensors));
    }
}

/// Receives as [`tasks::radio_receive`](crate::tasks::radio_receive) does, and reports that it listens,
/// whether it receives something or not.
pub async fn radio_receive(mut radio: impl RadioReceiver, boxes: &Mailboxes) -> ! {
    loop {
        let packet = {
            // Not cancelled midway: bytes of a packet that is coming in would be lost.
            let mut next = pin!(radio.receive());
            loop {
                boxes.progress.mark(RobotPart::Radio);
                if let Either::First(packet) = select(next.as_mut(), Timer::after(RADIO_REPORT_PERIOD)).await
                {
                    break packet;
                }
            }
        };
        boxes.room_for_arrival().await;
        boxes.deliver(Arrival::Packet(packet));
        boxes.note_radio(now(), radio.faults());
    }
}

/// Feeds the watchdog as long as control, radio and brain all run.
pub async fn watchdog<D: Watchdog>(mut watchdog: D, boxes: &Mailboxes) -> ! {
    let mut ticker = Ticker::every(Duration::from_micros(D::TIMEOUT.0 / CHECKS_PER_TIMEOUT));
    loop {
        ticker.next().await;
        if boxes.progress.all() {
            watchdog.feed();
        }
    }
}

/// The brain's pace on wheels (docs/architecture.md §2.3).
const BRAIN_PERIOD: Duration = Duration::from_micros(WHEELED_STEP.0);
/// The control loop has been silent for ten of its steps.
const CONTROL_SILENT_AFTER: Duration = Duration::from_millis(10);
/// Period in which a radio that receives nothing reports that it listens.
const RADIO_REPORT_PERIOD: Duration = Duration::from_millis(10);
/// Number of checks by the watchdog's task within its time-out.
const CHECKS_PER_TIMEOUT: u64 = 5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::World;
    use core::cell::{Cell, RefCell};
    use geometry::Twist;
    use motion::omni::Omni;
    use protocol::link::Packet;
    use protocol::robot_io::ActuatorFrame;
    use std::boxed::Box;
    use std::vec::Vec;

    use crate::kicker::KickerState;
    use crate::ports::Seen;

    /// Wheels that reach two thirds of a change in 30 ms.
    struct Motor(&'static Cell<Option<[f32; WHEELS]>>, [f32; WHEELS]);
    impl WheelsPort for Motor {
        fn measured(&mut self) -> [f32; WHEELS] {
            self.1
        }
        fn drive(&mut self, duty: [f32; WHEELS], _dribbler: f32) {
            for (speed, duty) in self.1.iter_mut().zip(duty) {
                *speed += (6.0 * duty - *speed) / 30.0;
            }
            self.0.set(Some(duty));
        }
        fn release(&mut self) {
            self.0.set(None);
        }
    }

    struct Coil(&'static RefCell<Vec<KickerAct>>);
    impl Kicker for Coil {
        fn state(&mut self) -> KickerState {
            KickerState { ball: true, volts: 210.0 }
        }
        async fn act(&mut self, act: KickerAct) {
            self.0.borrow_mut().push(act);
        }
    }

    struct Quiet;
    impl RadioReceiver for Quiet {
        async fn receive(&mut self) -> Packet {
            core::future::pending().await
        }
    }

    struct Counting(&'static Cell<u32>);
    impl Watchdog for Counting {
        const TIMEOUT: protocol::Duration = protocol::Duration::millis(100);
        fn feed(&mut self) {
            self.0.set(self.0.get() + 1);
        }
    }

    struct Still;
    impl Probes for Still {
        fn look(&mut self) -> Seen {
            Seen { turn: None, ball: true, tipped: false, battery: Some(15.0), kicker_ready: false }
        }
    }

    fn leaked<T>(value: T) -> &'static T {
        Box::leak(Box::new(value))
    }

    const GO: ActuatorFrame =
        ActuatorFrame::Omni { wheels: [1.0; 4], dribbler: 0.0, kick: OmniKick::Flat(4.0) };

    #[test]
    fn an_order_drives_and_kicks_and_its_absence_brakes_and_discharges() {
        let (boxes, wires) = (leaked(Mailboxes::new()), leaked(Wires::new()));
        let (duty, acts) = (leaked(Cell::new(None)), leaked(RefCell::new(Vec::new())));
        let mut world = World::new();
        world.spawn(control(Motor(duty, [0.0; WHEELS]), boxes, wires));
        world.spawn(kicker(Coil(acts), wires));
        world.settle();
        world.advance(5_000);
        assert_eq!(duty.get(), None, "no order yet, no current");
        boxes.orders.signal(GO);
        world.advance(30_000);
        assert!(duty.get().is_some_and(|duty| duty[0] > 0.1));
        assert_eq!(acts.borrow().iter().filter(|act| matches!(act, KickerAct::Flat(_))).count(), 1);
        world.advance(300_000);
        assert!(duty.get().is_some_and(|duty| duty.iter().all(|duty| duty.abs() < 0.02)), "{duty:?}");
        assert_eq!(acts.borrow().last(), Some(&KickerAct::Bleed));
    }

    #[test]
    fn the_brain_sees_wheels_and_probes_a_hundred_times_a_second() {
        let (boxes, wires) = (leaked(Mailboxes::new()), leaked(Wires::new()));
        let mut world = World::new();
        world.spawn(senses(Still, boxes, wires));
        world.settle();
        wires
            .rims
            .signal(Omni::default().rims(Twist { linear: geometry::Vector::new(1.0, 0.0), angular: 0.0 }));
        world.advance(10_000);
        let Ok(Arrival::Sensors(sensors)) = boxes.inbox.try_receive() else { panic!("nothing seen") };
        assert!((sensors.odometry.linear.x() - 1.0).abs() < 1e-3 && sensors.ball_contact);
        assert_eq!((sensors.pose, sensors.health.battery), (None, Some(15.0)));
        world.advance(60_000);
        assert_eq!(boxes.inbox.len(), 5);
    }

    #[test]
    fn the_watchdog_is_fed_only_while_control_radio_and_brain_all_run() {
        let (boxes, wires) = (leaked(Mailboxes::new()), leaked(Wires::new()));
        let (fed, duty) = (leaked(Cell::new(0)), leaked(Cell::new(None)));
        let mut world = World::new();
        world.spawn(control(Motor(duty, [0.0; WHEELS]), boxes, wires));
        world.spawn(radio_receive(Quiet, boxes));
        world.spawn(watchdog(Counting(fed), boxes));
        world.settle();
        world.advance(1_000_000);
        assert_eq!(fed.get(), 0, "the brain has not said a word");
        for ms in (1_000..2_000).step_by(10) {
            boxes.progress.mark(RobotPart::Brain);
            world.advance(ms * 1_000);
        }
        assert!((45..=50).contains(&fed.get()), "{}", fed.get());
        let before = fed.get();
        world.advance(3_000_000);
        assert!(fed.get() <= before + 1, "the brain is silent again");
    }
}
