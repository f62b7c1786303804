//! `off`: emergency stop of everything that moves. It bypasses all drivers, because they are not accessible
//! in a panic.

use embassy_stm32::pac;

/// No current into motors and coils, the charger off, the capacitor on its resistor.
///
/// A timer in reset drives its pins low (RM0433, 8.7.28). A test holds this to the table in `pins`.
pub fn everything() {
    pac::RCC.apb2rstr().modify(|reset| {
        reset.set_tim1rst(true);
        reset.set_tim15rst(true);
        reset.set_tim16rst(true);
    });
    pac::RCC.apb1lrstr().modify(|reset| reset.set_tim5rst(true));
    // PE0 enables the motors' current, PE4 keeps the capacitor's charge.
    pac::GPIOE.bsrr().write(|pins| {
        pins.set_br(0, true);
        pins.set_br(4, true);
    });
}
