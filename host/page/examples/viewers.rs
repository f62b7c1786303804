//! `viewers`: load generator for `cargo xtask bench page`: opens many viewers of a page at once. `viewers
//! ADDRESS WAYS`, a letter for each viewer: `r` reads as fast as it can, `s` takes a scene a second, `d`
//! never reads, `v` disconnects without closing. Ends with the page, and prints how many were accepted.

use std::net::TcpStream;
use std::process::ExitCode;
use std::thread;
use std::time::Duration;

use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

type Viewer = WebSocket<MaybeTlsStream<TcpStream>>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [address, modes] = &arguments[..] else {
        eprintln!("usage: viewers ADDRESS WAYS, where WAYS is a letter of r, s, d, v for each");
        return ExitCode::from(2);
    };
    let url = format!("ws://{address}/socket");
    let mut viewers = Vec::new();
    for path in modes.chars() {
        match tungstenite::connect(&url) {
            Ok((viewer, _)) => viewers.push((path, viewer)),
            Err(error) => {
                eprintln!("{url}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    eprintln!("{} viewers look on", viewers.len());
    // A viewer that never reads does not notice the page's end: it stays until the others are done.
    let (deaf, others): (Vec<_>, Vec<_>) = viewers.into_iter().partition(|(path, _)| *path == 'd');
    let threads: Vec<_> =
        others.into_iter().map(|(path, viewer)| thread::spawn(move || look(path, viewer))).collect();
    let taken: u64 = threads.into_iter().filter_map(|thread| thread.join().ok()).sum();
    drop(deaf);
    println!("{taken}");
    ExitCode::SUCCESS
}

/// Reads until the page ends or the viewer is gone; returns the number of scenes taken.
fn look(path: char, mut viewer: Viewer) -> u64 {
    if path == 'v' {
        thread::sleep(Duration::from_secs(1));
        if let MaybeTlsStream::Plain(stream) = viewer.get_ref() {
            let _ = stream.shutdown(std::net::Shutdown::Both);
        }
        return 0;
    }
    let mut taken = 0;
    while viewer.read().is_ok_and(|message| message.is_text()) && viewer.send(Message::text(".")).is_ok() {
        taken += 1;
        if path == 's' {
            thread::sleep(Duration::from_secs(1));
        }
    }
    taken
}
