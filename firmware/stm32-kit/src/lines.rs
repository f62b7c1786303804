//! `lines`: the radio's serial line, the radio chip's bus and the IMU's, set up for `board_kit`'s drivers.

use board_kit::imu::Imu;
use board_kit::nrf24::{ChipReceiver, ChipWires};
use board_kit::radio::{BAUD, RING_LEN, UartReceiver, UartSender};
use embassy_stm32::Peri;
use embassy_stm32::gpio::{Input, Level, Output, Pin, Pull, Speed};
use embassy_stm32::mode::{Async, Blocking};
use embassy_stm32::spi::mode::Master;
use embassy_stm32::spi::{self, MODE_0, MODE_3, Spi};
use embassy_stm32::time::Hertz;
use embassy_stm32::usart::{self, RingBufferedUartRx, Uart, UartTx};
use embassy_time::Delay;
use embedded_hal_bus::spi::ExclusiveDevice;
use protocol::serial::LINE_LEN_MAX;
use rules::{ImuModel, RadioLine, RobotSpec};
use static_cell::StaticCell;

/// Sending half of the line, by DMA.
pub type Sender = UartSender<UartTx<'static, Async>>;
/// Receives by DMA into a ring.
pub type Receiver = UartReceiver<RingBufferedUartRx<'static>>;
/// The IMU on a blocking bus.
pub type BoardImu = Imu<Spi<'static, Blocking, Master>, Output<'static>>;

/// A radio chip nRF24L01+ alone on its blocking bus.
pub type ChipBus = ExclusiveDevice<Spi<'static, Blocking, Master>, Output<'static>, Delay>;
/// Wires of the radio chip.
pub type RadioChip = ChipWires<ChipBus, Output<'static>, Input<'static>, Delay>;
/// A robot's receiver with such a chip.
pub type RadioChipReceiver = ChipReceiver<ChipBus, Output<'static>, Input<'static>, Delay>;

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

/// The radio chip's bus settings: mode 0, at most [`CHIP_CLOCK`].
pub fn chip_config() -> spi::Config {
    let mut config = spi::Config::default();
    config.mode = MODE_0;
    config.frequency = CHIP_CLOCK;
    config
}

/// The radio chip on its bus, neither selected nor enabled.
pub fn chip(
    bus: Spi<'static, Blocking, Master>,
    select: Peri<'static, impl Pin>,
    enable: Peri<'static, impl Pin>,
    irq: Peri<'static, impl Pin>,
) -> RadioChip {
    let select = Output::new(select, Level::High, Speed::High);
    let Ok(spi) = ExclusiveDevice::new(bus, select, Delay);
    let enable = Output::new(enable, Level::Low, Speed::High);
    ChipWires { spi, enable, irq: Input::new(irq, Pull::Up), pause: Delay }
}

/// SPI clock of the radio chip, which allows 10 MHz (PS 8.3.2).
pub const CHIP_CLOCK: Hertz = Hertz(8_000_000);
/// SPI clock; the sensor allows 24 MHz.
pub const IMU_CLOCK: Hertz = Hertz(8_000_000);
/// Parts that these boards are wired for.
const _: () = {
    assert!(
        matches!(RobotSpec::OURS.parts.imu, ImuModel::Icm42688P),
        "this board has an ICM-42688-P; the robot's description has another `imu.model`"
    );
    assert!(
        matches!(RobotSpec::OURS.parts.radio, RadioLine::Serial),
        "this board's radio is on a serial line; the robot's description has another `radio.line`"
    );
};
