//! `off`: emergency stop of everything that moves. It bypasses all drivers, because they are not accessible
//! in a panic.

stm32_kit::emergency_stop! {
    timers in reset: {
        apb2rstr: set_tim1rst, set_tim9rst, set_tim11rst;
        apb1rstr: set_tim12rst;
    }
    // PE0 enables the motors' current, PE4 keeps the capacitor's charge.
    pins low: GPIOE 0, 4
}
