//! `testing`: pins and PWM channels of the tests, which keep their last setting.

use std::cell::Cell;
use std::rc::Rc;

use embedded_hal::digital::{self, ErrorKind, InputPin, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};

/// A pin; its clones are the same wire.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pin(Rc<Cell<bool>>);

impl Pin {
    pub(crate) fn new() -> Self {
        Self::default()
    }

    pub(crate) fn put(&self, high: bool) {
        self.0.set(high);
    }

    pub(crate) fn is_set(&self) -> bool {
        self.0.get()
    }
}

impl digital::ErrorType for Pin {
    type Error = ErrorKind;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), ErrorKind> {
        self.put(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), ErrorKind> {
        self.put(true);
        Ok(())
    }
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, ErrorKind> {
        Ok(self.is_set())
    }

    fn is_low(&mut self) -> Result<bool, ErrorKind> {
        Ok(!self.is_set())
    }
}

/// A PWM channel of 1,000 steps, which may break.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pwm(Rc<Cell<(u16, bool)>>);

impl Pwm {
    pub(crate) fn new() -> Self {
        Self::default()
    }

    pub(crate) fn duty(&self) -> u16 {
        self.0.get().0
    }

    pub(crate) fn break_it(&self) {
        self.0.set((self.duty(), true));
    }
}

impl pwm::ErrorType for Pwm {
    type Error = pwm::ErrorKind;
}

impl SetDutyCycle for Pwm {
    fn max_duty_cycle(&self) -> u16 {
        1000
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), pwm::ErrorKind> {
        assert!(duty <= 1000, "{duty}");
        let (_, broken) = self.0.get();
        if broken {
            return Err(pwm::ErrorKind::Other);
        }
        self.0.set((duty, broken));
        Ok(())
    }
}
