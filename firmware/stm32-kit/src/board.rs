//! `board`: macros for what boards have alike but for the names of peripherals and registers: emergency stop,
//! fault handlers, drivers of the parts, the robot's start and the checks of its first start.

/// Declares `everything`, the emergency stop: these timers in reset, these pins of a port low.
#[macro_export]
macro_rules! emergency_stop {
    (timers in reset: { $($register:ident: $($timer:ident),+;)+ } pins low: $port:ident $($pin:literal),+) => {
        /// Takes the current off motors and coils, switches the charger off and leaves the capacitor on its
        /// resistor.
        ///
        /// A timer in reset drives its pins low. A test holds this to the table in `pins`.
        pub fn everything() {
            use $crate::embassy_stm32::pac;
            $(pac::RCC.$register().modify(|reset| {
                $(reset.$timer(true);)+
            });)+
            pac::$port.bsrr().write(|pins| {
                $(pins.set_br($pin, true);)+
            });
        }
    };
}

/// Declares `crash_record` and the handlers of panics and hard faults: the emergency stop, then the place
/// kept in the chip's backup registers and reported, then a restart.
#[macro_export]
#[allow(clippy::crate_in_macro_def, reason = "the stop is the board's own: its module `off`")]
macro_rules! fault_handlers {
    (backup registers: $registers:literal, cause of the reset: $status:ident, $watchdog:ident) => {
        /// Counts this start; must be called once, after the clocks are started.
        pub fn crash_record() -> board_kit::crash::CrashRecord {
            use $crate::embassy_stm32::pac::RCC;
            let reset = RCC.$status().read();
            RCC.$status().modify(|flags| flags.set_rmvf(true));
            board_kit::crash::CrashRecord::begin(&mut kept_words(), reset.$watchdog())
        }

        fn kept_words() -> $crate::words::BackupRegisters<$registers> {
            $crate::words::BackupRegisters::open()
        }

        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
            crate::off::everything();
            cortex_m::interrupt::disable();
            ended(runtime::ending::Ending::Panic(info.location()))
        }

        #[cortex_m_rt::exception]
        unsafe fn HardFault(frame: &cortex_m_rt::ExceptionFrame) -> ! {
            crate::off::everything();
            ended(runtime::ending::Ending::Fault(frame.pc()))
        }

        /// Keeps and prints the place, then restarts.
        fn ended(how: runtime::ending::Ending<'_>) -> ! {
            let kept = board_kit::crash::KeptPlace::keep(&mut kept_words(), how);
            cortex_m::asm::dsb();
            // Last, because the log itself may be what failed.
            defmt::error!("panic at {=str}; everything off, restarting", kept.text());
            cortex_m::peripheral::SCB::sys_reset()
        }
    };
}

/// Declares `page`, the provisioned key page, and `Ledger`, the counter of starts in two sectors: both at
/// these offsets in the chip's flash. `read` copies a cell's bytes from an address.
#[macro_export]
macro_rules! flash {
    (counter: $counter:literal, page: $page:literal, read: $read:path) => {
        use runtime::persistent_counter::{CELL_LEN, CounterCell, CounterPlace, cell};

        /// The provisioned page with keys and identity, unchecked; erased flash reads as 0xff.
        pub fn page() -> &'static [u8] {
            let page = (FLASH_START + $page) as *const u8;
            // SAFETY: flash behind the firmware (memory.x), of a sector that this program never writes.
            unsafe { core::slice::from_raw_parts(page, protocol::provision::PAGE_LEN) }
        }

        /// The two halves of the counter of starts.
        #[allow(missing_debug_implementations, reason = "the chip's driver has none")]
        pub struct Ledger(
            $crate::embassy_stm32::flash::Flash<'static, $crate::embassy_stm32::flash::Blocking>,
        );

        impl Ledger {
            /// The counter in this flash.
            pub fn new(
                flash: $crate::embassy_stm32::Peri<'static, $crate::embassy_stm32::peripherals::FLASH>,
            ) -> Self {
                Self($crate::embassy_stm32::flash::Flash::new_blocking(flash))
            }
        }

        impl board_kit::ledger::LedgerFlash for Ledger {
            const CELLS: usize = SECTOR_LEN as usize / CELL_LEN;

            fn read(&self, at: CounterPlace) -> CounterCell {
                let mut bytes = [0; CELL_LEN];
                $read(FLASH_START + offset(at), &mut bytes);
                CounterCell::of(&bytes)
            }

            /// Up to two seconds.
            fn erase(&mut self, half: usize) -> bool {
                let from = $counter + SECTOR_LEN * half as u32;
                self.0.blocking_erase(from, from + SECTOR_LEN).is_ok()
            }

            fn write(&mut self, at: CounterPlace, epoch: u32) -> bool {
                self.0.blocking_write(offset(at), &cell(epoch)).is_ok()
            }
        }

        /// Offset of a cell from the flash's start, bytes.
        fn offset(at: CounterPlace) -> u32 {
            $counter + SECTOR_LEN * at.half as u32 + (CELL_LEN * at.index) as u32
        }

        const FLASH_START: u32 = 0x0800_0000;
        /// Length of the sectors of the counter and of the page, bytes.
        const SECTOR_LEN: u32 = 0x0002_0000;
    };
}

/// Declares the drivers of the parts that boards have alike, each from its pins: `motors`, `encoders`, `imu`,
/// `analog` and `radio`. The dribbler's PWM, the line's interrupts and the analog inputs' settings are the
/// board's.
#[macro_export]
macro_rules! drivers {
    (dribbler: |$parts:ident| $dribbler:expr, interrupts: $interrupts:ident, analog: $analog:expr) => {
        /// The drivers of all five motors, without current.
        pub fn motors($parts: pins::Motors) -> Drivers {
            use $crate::embassy_stm32::gpio::OutputType::PushPull;
            use $crate::embassy_stm32::timer::simple_pwm::PwmPin;
            use $crate::pwm::{self, low};
            let directions = [
                low($parts.dir_front_right),
                low($parts.dir_back_right),
                low($parts.dir_back_left),
                low($parts.dir_front_left),
            ];
            let pins = pwm::WheelPins {
                front_right: PwmPin::new($parts.pwm_front_right, PushPull),
                back_right: PwmPin::new($parts.pwm_back_right, PushPull),
                back_left: PwmPin::new($parts.pwm_back_left, PushPull),
                front_left: PwmPin::new($parts.pwm_front_left, PushPull),
                directions,
            };
            let enable = low($parts.enable);
            let dribbler = $dribbler;
            pwm::drivers($parts.timer, pins, dribbler, enable, $parts.fault)
        }

        /// The four quadrature counters, at zero.
        pub fn encoders(parts: pins::Encoders) -> Encoders {
            use $crate::embassy_stm32::timer::qei::{Config, Qei};
            let config = Config::default();
            Encoders {
                front_right: Qei::new(parts.front_right, parts.front_right_a, parts.front_right_b, config),
                back_right: Qei::new(parts.back_right, parts.back_right_a, parts.back_right_b, config),
                back_left: Qei::new(parts.back_left, parts.back_left_a, parts.back_left_b, config),
                front_left: Qei::new(parts.front_left, parts.front_left_a, parts.front_left_b, config),
            }
        }

        /// The IMU, not started yet.
        pub fn imu(parts: pins::Imu) -> $crate::lines::BoardImu {
            use $crate::embassy_stm32::spi::Spi;
            let config = $crate::lines::imu_config();
            let bus = Spi::new_blocking(parts.bus, parts.clock, parts.to, parts.from, config);
            $crate::lines::imu(bus, parts.select)
        }

        /// The measured voltages; the lamp of the break-beam sensor is dark.
        pub fn analog(parts: pins::Analog) -> $crate::analog::Analog {
            let pins::Analog { converter, battery, capacitor, break_beam, lamp } = parts;
            $crate::analog::Analog::new(converter, battery, capacitor, break_beam, lamp, $analog)
        }

        /// Both directions of the radio's line; `None` where it cannot have this rate. Call once.
        pub fn radio(parts: pins::Radio) -> Option<($crate::lines::Sender, $crate::lines::Receiver)> {
            use $crate::embassy_stm32::usart::Uart;
            let pins::Radio { line, rx, tx, tx_dma, rx_dma, .. } = parts;
            let config = $crate::lines::radio_config();
            Uart::new(line, rx, tx, tx_dma, rx_dma, $interrupts, config).ok().map($crate::lines::radio)
        }
    };
}

/// Declares a robot's program on the board of that crate, with its tasks and `main`. `radio` opens both
/// directions of the radio from identity and parts.
#[macro_export]
macro_rules! robot_main {
    (
        $board:ident of $support:ident, sender: $sender:ty, receiver: $receiver:ty,
        radio: |$who:ident, $parts:ident| $radio:expr
    ) => {
        impl board_kit::robot::Board for $board {
            type Wheels = board_kit::wheels::Wheels<$support::drivers::Drivers, $support::drivers::Encoders>;
            type Kicker = $support::drivers::Kicker;
            type Gyroscope = $crate::lines::BoardImu;
            type Analog = $crate::analog::Analog;
            type Sender = $sender;
            type Receiver = $receiver;
            type Watchdog = $support::drivers::BoardWatchdog;
            type Lamp = $crate::embassy_stm32::gpio::Output<'static>;
        }

        board_kit::robot_tasks!($board);

        #[cortex_m_rt::entry]
        fn main() -> ! {
            use $crate::pwm::low;
            use $support::drivers;
            let $parts = $support::start();
            // First of all, the levels of the motors' wires before they are driven.
            let motors = drivers::motors($parts.motors);
            let kicker = drivers::kicker($parts.kicker);
            let (mut alarm, alive) = (low($parts.lamps.alarm), low($parts.lamps.alive));
            board_kit::robot::log_crash(&$support::fault::crash_record());
            let mut flash = $support::flash::Ledger::new($parts.keeper.flash);
            let who =
                board_kit::robot::identity($support::flash::page(), board_kit::ledger::begin(&mut flash));
            let radio = who.as_ref().and_then(|$who| $radio);
            let (Some(who), Some((sender, receiver))) = (who, radio) else {
                alarm.set_high();
                $support::off::everything();
                loop {
                    cortex_m::asm::wfi();
                }
            };
            let parts = board_kit::robot::BoardParts::<$board> {
                wheels: board_kit::wheels::Wheels::new(motors, drivers::encoders($parts.encoders)),
                kicker,
                gyroscope: drivers::imu($parts.imu),
                analog: drivers::analog($parts.analog),
                sender,
                receiver,
                // The last step that may take long is over.
                watchdog: drivers::BoardWatchdog::start($parts.keeper.watchdog),
                alive,
            };
            static EXECUTOR: static_cell::StaticCell<embassy_executor::Executor> =
                static_cell::StaticCell::new();
            EXECUTOR.init(embassy_executor::Executor::new()).run(|spawner| {
                run(spawner, who, case_library::division_b(), parts).expect("every task is started once");
            })
        }
    };
}

/// Declares `RttRing`, the ring into which defmt-rtt logs. It is only read: read offset and mode, which are
/// a debug probe's, stay as they are.
#[macro_export]
macro_rules! rtt_ring {
    () => {
        use core::sync::atomic::{AtomicPtr, AtomicU32, Ordering};

        struct RttRing;

        /// RTT's control block as SEGGER lays it out for probes, up to what is used of the first up channel.
        #[repr(C)]
        struct ControlBlock {
            id: [u8; 16],
            channels: [u32; 2],
            name: AtomicPtr<u8>,
            buffer: AtomicPtr<u8>,
            len: u32,
            write: AtomicU32,
        }

        unsafe extern "C" {
            // SAFETY: a static of defmt-rtt under the name by which probes find it. It is longer than this
            // part of it, initialised, and changes in `write` and in fields after it alone.
            safe static _SEGGER_RTT: ControlBlock;
        }

        impl runtime::bring_up::LogRing for RttRing {
            fn look<T>(&self, read: impl FnOnce(&[u8], usize) -> T) -> T {
                // defmt-rtt writes the ring in critical sections alone, so that it does not change in here.
                cortex_m::interrupt::free(|_| {
                    let buffer = _SEGGER_RTT.buffer.load(Ordering::Relaxed);
                    // SAFETY: `buffer` points to `len` bytes, a static of defmt-rtt. Nothing else runs on the
                    // processor before the slice is gone, and a probe only reads it.
                    let ring = unsafe { core::slice::from_raw_parts(buffer, _SEGGER_RTT.len as usize) };
                    read(ring, _SEGGER_RTT.write.load(Ordering::Acquire) as usize)
                })
            }
        }
    };
}

/// Declares `main` of the checks of a robot's first start, on the board of that crate.
#[macro_export]
macro_rules! bring_up_main {
    ($support:ident) => {
        #[embassy_executor::main]
        async fn main(spawner: embassy_executor::Spawner) {
            use board_kit::{ledger, robot::identity, wheels::Wheels};
            use $support::{drivers, flash};

            // One task is enough.
            let _ = spawner;
            let parts = $support::start();
            let wheels = Wheels::new(drivers::motors(parts.motors), drivers::encoders(parts.encoders));
            let who = identity(flash::page(), ledger::begin(&mut flash::Ledger::new(parts.keeper.flash)));
            let Some(radio) = drivers::radio(parts.radio) else {
                defmt::error!("the radio's line cannot have this rate");
                return;
            };
            let (gyroscope, analog) = (drivers::imu(parts.imu), drivers::analog(parts.analog));
            // The last step that may take long is over.
            let watchdog = drivers::BoardWatchdog::start(parts.keeper.watchdog);
            let kicking = (drivers::kicker(parts.kicker), watchdog);
            board_kit::bring_up::run(wheels, kicking, radio, gyroscope, analog, who, RttRing).await;
        }

        $crate::rtt_ring!();
    };
}
