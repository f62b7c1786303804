//! `off`: emergency stop of everything that moves. It bypasses all drivers, because they are not accessible
//! in a panic. A timer in reset drives its pins low: RM0433, 8.7.28.

stm32_kit::emergency_stop! {
    timers in reset: {
        apb2rstr: set_tim1rst, set_tim15rst, set_tim16rst;
        apb1lrstr: set_tim5rst;
    }
    // PE0 enables the motors' current, PE4 keeps the capacitor's charge.
    pins low: GPIOE 0, 4
}
