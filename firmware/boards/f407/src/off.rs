//! `off`: emergency stop of everything that moves. It bypasses all drivers, because they are not accessible
//! in a panic.

use embassy_stm32::pac;

/// No current into motors and coils, the charger off, the capacitor on its resistor.
///
/// A timer in reset drives its pins low. A test holds this to the table in `pins`.
pub fn everything() {
    pac::RCC.apb2rstr().modify(|reset| {
        reset.set_tim1rst(true);
        reset.set_tim9rst(true);
        reset.set_tim11rst(true);
    });
    pac::RCC.apb1rstr().modify(|reset| reset.set_tim12rst(true));
    // PE0 enables the motors' current, PE4 keeps the capacitor's charge.
    pac::GPIOE.bsrr().write(|pins| {
        pins.set_br(0, true);
        pins.set_br(4, true);
    });
}
