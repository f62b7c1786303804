//! Looks on, in many ways at once: for `cargo xtask bench page`. `viewers ADDRESS N SECONDS`: every third one reads, every third one
//! never does, and the rest vanish without a word.

use std::net::TcpStream;
use std::process::ExitCode;
use std::thread;
use std::time::{Duration, Instant};

use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [address, count, seconds] = &words[..] else {
        eprintln!("usage: viewers ADDRESS N SECONDS");
        return ExitCode::from(2);
    };
    let (Ok(count), Ok(seconds)) = (count.parse::<u32>(), seconds.parse::<u64>()) else {
        eprintln!("N and SECONDS are numbers");
        return ExitCode::from(2);
    };
    let until = Instant::now() + Duration::from_secs(seconds);
    let url = format!("ws://{address}/socket");
    let mut viewers = Vec::new();
    for _ in 0..count {
        match tungstenite::connect(&url) {
            Ok((viewer, _)) => viewers.push(viewer),
            Err(error) => {
                eprintln!("{url}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    eprintln!("{count} viewers look on");
    let threads: Vec<_> =
        (0..).zip(viewers).map(|(i, viewer)| thread::spawn(move || look(i, viewer, until))).collect();
    let taken: u64 = threads.into_iter().filter_map(|thread| thread.join().ok()).sum();
    println!("{taken} scenes taken");
    ExitCode::SUCCESS
}

fn look(i: u32, mut viewer: WebSocket<MaybeTlsStream<TcpStream>>, until: Instant) -> u64 {
    let mut taken = 0;
    match i % 3 {
        0 => {
            while Instant::now() < until && viewer.read().is_ok() {
                taken += 1;
                if viewer.send(Message::text(".")).is_err() {
                    break;
                }
            }
        }
        1 => thread::sleep(until.saturating_duration_since(Instant::now())),
        _ => {
            thread::sleep(Duration::from_secs(1));
            if let MaybeTlsStream::Plain(stream) = viewer.get_ref() {
                let _ = stream.shutdown(std::net::Shutdown::Both);
            }
        }
    }
    taken
}
