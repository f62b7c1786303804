//! `recording`: header of a match recording. Everything both hosts received and sent;
//! [`host::record::Recorder`] writes it (docs/architecture.md §7.4).

use host::Input;
use host::radio::To;
use host::record::Recorder;
use host::record::header::{HostHeader, RecordingHeader};
use protocol::Instant;
use rules::Colour;
use ssl::log::MessageKind;

use super::{GameConfig, Watcher};

impl Watcher for Recorder {
    fn vision(&mut self, now: Instant, bytes: &[u8]) {
        self.received(now, MessageKind::Vision2014, bytes);
    }

    fn referee(&mut self, now: Instant, bytes: &[u8]) {
        self.received(now, MessageKind::Refbox2013, bytes);
    }

    fn input(&mut self, now: Instant, host: Colour, input: Input<'_>) {
        Self::input(self, now, host, input);
    }

    fn sent(&mut self, now: Instant, host: Colour, to: To, packet: &[u8]) {
        Self::sent(self, now, host, to, packet);
    }
}

/// The header of a match's recording, with version and commit of the program.
pub fn header(version: &str, commit: &str, config: &GameConfig) -> RecordingHeader {
    let hosts = [Colour::Yellow, Colour::Blue];
    RecordingHeader {
        version: version.to_owned(),
        commit: commit.to_owned(),
        seed: Some(config.seed),
        league: config.league.name().to_owned(),
        world: Some(config.world.to_string()),
        zero_unix_us: None,
        hosts: hosts.map(|colour| HostHeader::of(&config.host_settings(colour), Instant(0))).to_vec(),
        case_table: None,
    }
    .with_cases(config.cases)
}
