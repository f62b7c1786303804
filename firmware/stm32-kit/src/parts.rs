//! `parts`: the macro of a board's table of pins.

/// A board's table of pins: a struct for each part with the chip's peripherals that it owns, and `Parts` with
/// all of them. A line `name: PIN, "what";` is a wire, `name: TIM1, "what";` a part of the chip.
#[macro_export]
macro_rules! parts {
    ($($(#[$doc:meta])* $part:ident $field:ident { $($name:ident: $pin:ident, $what:literal;)* })*) => {
        $(
            $(#[$doc])*
            #[allow(missing_debug_implementations, reason = "pins have none")]
            pub struct $part {
                $(#[doc = $what] pub $name: embassy_stm32::Peri<'static, embassy_stm32::peripherals::$pin>,)*
            }
        )*

        /// All parts of the board.
        #[allow(missing_debug_implementations, reason = "pins have none")]
        pub struct Parts {
            $(#[doc = concat!("[`", stringify!($part), "`].")] pub $field: $part,)*
        }

        impl Parts {
            /// Distributes the chip's peripherals.
            pub fn of(all: embassy_stm32::Peripherals) -> Self {
                Self { $($field: $part { $($name: all.$pin,)* },)* }
            }
        }
    };
}
