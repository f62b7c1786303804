//! `host_cost`: instruction count of a host that processes a recorded match frame by frame.
//!
//! `cargo run --release -p onetwo-host --example host_cost -- FILE.trace` feeds the recording's first host. A
//! round is everything from one packet of vision to the next: tracking, the referee's packets, robots'
//! frames, deadlines, planning where it is due, and the commands encoded and sealed. `cargo xtask bench game`
//! counts each call of [`count_this_round`] under callgrind.

use std::fs::File;
use std::io::BufReader;
use std::process::ExitCode;

use flate2::bufread::MultiGzDecoder;
use host::record::header::RecordingHeader;
use host::record::trace::{Reader, Record, RecordKind};
use host::{Host, Input};
use protocol::frame::TeamKey;

fn main() -> ExitCode {
    let Some(file) = std::env::args().nth(1) else {
        eprintln!("usage: host_cost FILE.trace");
        return ExitCode::from(2);
    };
    match feed(&file) {
        Ok(description) => {
            println!("{description}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{file}: {error}");
            ExitCode::FAILURE
        }
    }
}

fn feed(file: &str) -> Result<String, Box<dyn std::error::Error>> {
    let mut reader = Reader::new(MultiGzDecoder::new(BufReader::new(File::open(file)?)))?;
    let header = RecordingHeader::from_json(reader.header())?;
    let first = header.hosts.first().ok_or("no host in it")?;
    let mut host =
        Host::new(first.settings(header.league()?, header.cases()?, TeamKey::ZERO)?, first.began());
    let (mut round, mut rounds, mut packets, mut bytes) = (Vec::<Record>::new(), 0, 0, 0);
    let mut image = None;
    for record in reader.by_ref().filter(|record| record.host == 0 && record.kind.is_input()) {
        let next = record.kind == RecordKind::Vision && image.is_none_or(|at| record.at > at);
        if next {
            let (sent, long) = count_this_round(&mut host, &round);
            (rounds, packets, bytes) = (rounds + u32::from(image.is_some()), packets + sent, bytes + long);
            round.clear();
            image = Some(record.at);
        }
        round.push(record);
    }
    Ok(format!("{rounds} rounds, {packets} packets of {bytes} bytes to the robots"))
}

/// Processes the inputs of one camera frame; returns the number of packets sent and their bytes.
#[inline(never)]
fn count_this_round(host: &mut Host, round: &[Record]) -> (u64, u64) {
    let (mut packets, mut bytes) = (0, 0);
    for record in round {
        let input = match record.kind {
            RecordKind::Vision => Input::Vision(&record.bytes),
            RecordKind::Referee => Input::Referee(&record.bytes, record.from),
            RecordKind::Robot => Input::Robot(&record.bytes),
            RecordKind::Timeout => Input::Timeout,
            RecordKind::Orders => Input::Orders(&record.bytes),
            RecordKind::Parameter => Input::Parameter(&record.bytes),
            RecordKind::Test => Input::Test(&record.bytes),
            RecordKind::Halt => Input::Halt,
            RecordKind::Sent | RecordKind::Lost => continue,
        };
        host.handle(record.at, input);
        while let Some((_, packet)) = host.poll_packet() {
            packets += 1;
            bytes += packet.len() as u64;
        }
    }
    (packets, bytes)
}
