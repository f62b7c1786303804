//! `hall`: bench test of one brushless motor with three PWMs and hall sensors, commutated in the interrupt of
//! the sensors' edges; how a board with such motors wires them in (docs/boards.md, motor schemes).
//!
//! **The motor alone on the bench, its shaft free; a supply limited to 2 A.** Connect, instead of the wheels'
//! drivers and encoders: the driver's PWMs at PE9, PE11, PE13, its enables at PE8, PE10, PE12, its common
//! enable at PE0; the sensors at PA5, PA6, PC7, pulled up. See: two seconds forwards, two seconds back, at a
//! sixth of the battery's voltage, and six edges a turn and pair of poles on the log. It trembles or draws
//! current and stands: sensors and phases are in another of their six orders. `no edge`: a sensor's supply.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod robot {
    use board_f407::pins::Parts;
    use board_kit::motors::{HallMotor, ThreePwm};
    use embassy_stm32::gpio::{Input, Output, OutputType, Pull};
    use embassy_stm32::interrupt::InterruptExt as _;
    use embassy_stm32::peripherals::TIM1;
    use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwmChannel};
    use embassy_stm32::{interrupt, pac};
    use stm32_kit::pwm::{low, phases};

    type Motor = HallMotor<SimplePwmChannel<'static, TIM1>, Output<'static>, Input<'static>>;

    /// Both the control loop and the interrupt reach it. A robot has four.
    pub(crate) static MOTOR: Motor = HallMotor::new();

    /// Lines of the interrupt, which are the pins' numbers: PA5, PA6, PC7.
    const LINES: [(usize, u8); 3] = [(5, PORT_A), (6, PORT_A), (7, PORT_C)];
    const PORT_A: u8 = 0;
    const PORT_C: u8 = 2;

    /// The motor without current; returns the common enable, low.
    pub(crate) fn start(parts: Parts) -> Output<'static> {
        let (motors, encoders) = (parts.motors, parts.encoders);
        let pwm = phases(
            motors.timer,
            PwmPin::new(motors.pwm_front_right, OutputType::PushPull),
            PwmPin::new(motors.pwm_back_right, OutputType::PushPull),
            PwmPin::new(motors.pwm_back_left, OutputType::PushPull),
        );
        let enables = [low(motors.dir_front_right), low(motors.dir_back_right), low(motors.dir_back_left)];
        let sensors = [
            Input::new(encoders.front_right_a, Pull::Up),
            Input::new(encoders.back_right_a, Pull::Up),
            Input::new(encoders.front_left_b, Pull::Up),
        ];
        MOTOR.wire(ThreePwm::new(pwm, enables, sensors));
        for (line, port) in LINES {
            pac::SYSCFG.exticr(line / 4).modify(|lines| lines.set_exti(line % 4, port));
            pac::EXTI.rtsr(0).modify(|lines| lines.set_line(line, true));
            pac::EXTI.ftsr(0).modify(|lines| lines.set_line(line, true));
            pac::EXTI.imr(0).modify(|lines| lines.set_line(line, true));
        }
        // SAFETY: its handler is below, and the motor has its driver.
        unsafe { interrupt::EXTI9_5.enable() };
        low(motors.enable)
    }

    /// An edge of a sensor.
    #[interrupt]
    fn EXTI9_5() {
        // Cleared first: an edge that comes meanwhile raises the interrupt again.
        pac::EXTI.pr(0).write(|lines| LINES.iter().for_each(|(line, _)| lines.set_line(*line, true)));
        let _ = MOTOR.edge();
    }
}

#[cfg(target_os = "none")]
#[embassy_executor::main]
async fn main(spawner: embassy_executor::Spawner) {
    let _ = spawner;
    use board_kit::motors::Bridge as _;
    use embassy_time::{Duration, Ticker, Timer};
    use robot::MOTOR;

    /// Share of the battery's voltage.
    const DUTY: f32 = 0.16;

    let mut enable = robot::start(board_f407::start());
    let mut motor = &MOTOR;
    Timer::after_secs(2).await;
    enable.set_high();
    let mut ticker = Ticker::every(Duration::from_millis(1));
    for duty in [DUTY, -DUTY] {
        let before = MOTOR.count();
        for _ in 0..2_000 {
            ticker.next().await;
            // As the control loop does, a thousand times a second.
            if !motor.set(duty) {
                defmt::error!("the sensors show no place of a motor: a cable or their supply");
                Timer::after_secs(1).await;
            }
        }
        let edges = MOTOR.count().wrapping_sub(before).cast_signed();
        if edges == 0 {
            defmt::error!("no edge");
        } else {
            defmt::info!("{=i16} edges in two seconds", edges);
        }
        motor.off();
        Timer::after_secs(1).await;
    }
    enable.set_low();
    defmt::info!("done; without current");
}

#[cfg(not(target_os = "none"))]
fn main() {}
