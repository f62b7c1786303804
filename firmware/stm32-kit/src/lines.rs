//! `lines`: the radio's serial line and the IMU's bus, set up for `board_kit`'s drivers.

use board_kit::imu::Imu;
use board_kit::radio::{BAUD, RING_LEN, UartReceiver, UartSender};
use embassy_stm32::Peri;
use embassy_stm32::gpio::{Level, Output, Pin, Pull, Speed};
use embassy_stm32::mode::{Async, Blocking};
use embassy_stm32::spi::mode::Master;
use embassy_stm32::spi::{self, MODE_3, Spi};
use embassy_stm32::time::Hertz;
use embassy_stm32::usart::{self, RingBufferedUartRx, Uart, UartTx};
use protocol::serial::LINE_LEN_MAX;
use static_cell::StaticCell;

/// Sends by DMA.
pub type Sender = UartSender<UartTx<'static, Async>>;
/// Receives by DMA into a ring.
pub type Receiver = UartReceiver<RingBufferedUartRx<'static>>;
/// The IMU on a blocking bus.
pub type BoardImu = Imu<Spi<'static, Blocking, Master>, Output<'static>>;

/// The radio's rate; where no radio is plugged in, the line is idle.
pub fn radio_config() -> usart::Config {
    let mut config = usart::Config::default();
    config.baudrate = BAUD;
    config.rx_pull = Pull::Up;
    config
}

/// Both directions of the line. Call once.
pub fn radio(line: Uart<'static, Async>) -> (Sender, Receiver) {
    static RING: StaticCell<[u8; RING_LEN]> = StaticCell::new();
    static LINE: StaticCell<[u8; LINE_LEN_MAX]> = StaticCell::new();
    let (tx, rx) = line.split();
    let rx = rx.into_ring_buffered(RING.init([0; RING_LEN]));
    (UartSender::new(tx, LINE.init([0; LINE_LEN_MAX])), UartReceiver::new(rx))
}

/// The IMU's bus settings: mode 3, at most [`IMU_CLOCK`].
pub fn imu_config() -> spi::Config {
    let mut config = spi::Config::default();
    config.mode = MODE_3;
    config.frequency = IMU_CLOCK;
    config
}

/// The IMU on its bus.
pub fn imu(bus: Spi<'static, Blocking, Master>, select: Peri<'static, impl Pin>) -> BoardImu {
    Imu::new(bus, Output::new(select, Level::High, Speed::Low))
}

/// SPI clock; the sensor allows 24 MHz.
pub const IMU_CLOCK: Hertz = Hertz(8_000_000);
