//! `pins`: pin assignment. This table is the only source; README.md lists it as wiring, and a test holds both
//! equal.
//!
//! All pins are reachable on a NUCLEO-H743ZI2 and free there, Ethernet, USB and the virtual serial line left
//! as they are. A line `name: PIN, "what";` is a wire, `name: TIM1, "what";` a part of the chip.

stm32_kit::parts! {
    /// Four motor drivers, and the one of the dribbler. Wheels in the order of the wire: front right, back
    /// right, back left, front left.
    Motors motors {
        timer: TIM1, "the wheels' PWM";
        pwm_front_right: PE9, "out: PWM of the front right wheel";
        pwm_back_right: PE11, "out: PWM of the back right wheel";
        pwm_back_left: PE13, "out: PWM of the back left wheel";
        pwm_front_left: PE14, "out: PWM of the front left wheel";
        dir_front_right: PE8, "out: high turns the front right wheel backwards";
        dir_back_right: PE10, "out: high turns the back right wheel backwards";
        dir_back_left: PE12, "out: high turns the back left wheel backwards";
        dir_front_left: PE15, "out: high turns the front left wheel backwards";
        enable: PE0, "out: high lets current into all five motors; needs a pull-down";
        fault: PE3, "in, pulled up: a driver that has switched itself off pulls it low";
        dribbler_timer: TIM5, "the dribbler's PWM";
        dribbler: PA0, "out: PWM of the dribbler";
    }

    /// Four encoders of two channels each.
    Encoders encoders {
        front_right: TIM2, "counts the front right wheel";
        front_right_a: PA5, "in: front right wheel, channel A";
        front_right_b: PB3, "in: front right wheel, channel B";
        back_right: TIM3, "counts the back right wheel";
        back_right_a: PA6, "in: back right wheel, channel A";
        back_right_b: PB5, "in: back right wheel, channel B";
        back_left: TIM4, "counts the back left wheel";
        back_left_a: PD12, "in: back left wheel, channel A";
        back_left_b: PD13, "in: back left wheel, channel B";
        front_left: TIM8, "counts the front left wheel";
        front_left_a: PC6, "in: front left wheel, channel A";
        front_left_b: PC7, "in: front left wheel, channel B";
    }

    /// Charger, capacitor and coils.
    Kicker kicker {
        coils: TIM15, "the coils' pulses";
        flat: PE5, "out: high lets current into the flat kicker's coil; needs a pull-down";
        chip: PE6, "out: high lets current into the chip kicker's coil; needs a pull-down";
        charger: TIM16, "the charger's pulses";
        charge: PB8, "out: high lets the charger run; needs a pull-down";
        hold: PE4, "out: low lets the capacitor run empty through its resistor; needs a pull-down";
    }

    /// The gyroscope and accelerometer ICM-42688-P.
    Imu imu {
        bus: SPI3, "its bus";
        clock: PC10, "out: SPI clock of the IMU";
        from: PC11, "in: SPI data from the IMU";
        to: PC12, "out: SPI data to the IMU";
        select: PD2, "out: low selects the IMU";
    }

    /// Inputs measured as a voltage, 0 to 3.3 V, and the lamp of the break-beam sensor.
    Analog analog {
        converter: ADC1, "reads them";
        battery: PA3, "in: battery, divided by 11";
        capacitor: PC0, "in: kicker's capacitor, divided by 101";
        break_beam: PB1, "in: receiver of the light barrier, brighter is higher";
        lamp: PD7, "out: high lights the light barrier";
    }

    /// The radio modem on its serial line, 1 Mbit/s, 8N1.
    Radio radio {
        line: USART2, "the line";
        tx: PD5, "out: serial data to the radio";
        rx: PD6, "in: serial data from the radio";
        tx_dma: DMA1_CH0, "carries what goes";
        rx_dma: DMA1_CH1, "carries what comes";
    }

    /// The radio chip nRF24L01+, instead of a modem on a robot, and on a base station.
    Chip chip {
        bus: SPI5, "its bus";
        clock: PF7, "out: SPI clock of the radio chip";
        from: PF8, "in: SPI data from the radio chip";
        to: PF9, "out: SPI data to the radio chip";
        select: PF10, "out: low selects the radio chip (CSN)";
        enable: PF6, "out: high lets the radio chip send and listen (CE)";
        news: PF5, "in, pulled up: the radio chip pulls it low when there is something to do (IRQ)";
    }

    /// Indicator lamps on the board.
    Lamps lamps {
        alive: PB0, "out: green, blinks as long as the robot runs";
        alarm: PB14, "out: red, lit when no host can command the robot";
    }

    /// Watchdog and backup registers.
    Keeper keeper {
        watchdog: IWDG1, "resets the chip";
        flash: FLASH, "keeps the ledger of starts";
    }
}
