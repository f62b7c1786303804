//! `referee_fuzz`: fuzz tests of the referee listener and of geometry. Packets of the recordings with bits
//! flipped, and with numbers of the referee that no referee would send.

use std::path::PathBuf;

use geometry::Point;
use host::field_geometry::VisionGeometry;
use host::referee::team_port::TeamPort;
use host::referee::{Listener, SenderAddress};
use protocol::Instant;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rules::{Colour, League};
use ssl::Message;
use ssl::referee::Referee;
use ssl::vision::WrapperPacket;

/// Packets of each kind; a second for both.
const ROUNDS: u32 = 20_000;

fn packet(name: &str) -> Vec<u8> {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../protocol/ssl/tests/data/packets");
    std::fs::read(data.join(name)).unwrap()
}

/// Flips one to three bits of `bytes`.
fn turned(bytes: &[u8], random: &mut Xoshiro256PlusPlus) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.next_u32() % 3 {
        let at = random.next_u32() as usize % bytes.len();
        bytes[at] ^= 1 << (random.next_u32() % 8);
    }
    bytes
}

fn sound(listener: &Listener) {
    let game = listener.game();
    assert!(game.placement.is_none_or(|at| at.x().abs() < 100.0 && at.y().abs() < 100.0));
    let times = [game.stage_time_left, game.action_time_left];
    assert!(times.iter().flatten().all(|time| time.is_finite()));
}

#[test]
fn turned_packets_of_the_referee_leave_a_game_with_finite_places() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let names = ["ball_placement_blue", "halt", "normal_start", "with_yellow_card", "prepare_penalty_blue"];
    let packets = names.map(|name| packet(&format!("referee_{name}.bin")));
    let mut listener = Listener::new(League::DivisionB.limits().unwrap(), None, Instant(0));
    let mut received = 0;
    for round in 0..ROUNDS {
        let bytes = turned(&packets[round as usize % packets.len()], &mut random);
        let now = Instant(u64::from(round) * 25_000);
        if let Ok(packet) = Referee::decode(&bytes[..]) {
            listener.receive(&packet, SenderAddress::INTERNAL, now, None);
            received += 1;
        }
        listener.tick(now, None);
        sound(&listener);
    }
    assert!(received > ROUNDS / 10, "{received} of {ROUNDS} decode");
}

#[test]
fn numbers_that_no_referee_sends_are_survived() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let good = Referee::decode(&packet("referee_ball_placement_blue.bin")[..]).unwrap();
    let mut listener = Listener::new(League::DivisionA.limits().unwrap(), None, Instant(0));
    // Any number, or one near to the present one.
    let mut any = move |near: u64| match random.next_u32() % 4 {
        0 => random.next_u64(),
        1 => u64::MAX,
        _ => near.wrapping_add(random.next_u64() % 100_000),
    };
    for round in 0..ROUNDS {
        let mut odd = good.clone();
        odd.packet_timestamp = any(good.packet_timestamp + u64::from(round) * 25_000);
        odd.command_timestamp = any(good.command_timestamp);
        odd.command = if any(0) % 8 == 0 { any(0) as i32 } else { (any(0) % 18) as i32 };
        odd.command_counter = any(u64::from(round)) as u32;
        odd.stage = any(0) as i32;
        odd.stage_time_left = Some(any(0) as i64);
        odd.current_action_time_remaining = Some(any(0) as i64);
        odd.next_command = Some(any(0) as i32);
        odd.blue.goalkeeper = any(0) as u32;
        odd.blue.timeout_time = any(0) as u32;
        let [x, y] = [any(0), any(0)].map(|bits| f32::from_bits(bits as u32));
        odd.designated_position = Some(ssl::referee::Point { x, y });
        odd.source_identifier = (any(0) % 16 > 0).then(|| "b".into());
        // Our own clock may take any value too, but mostly advances.
        let now = u64::from(round) * 25_000;
        let (now, ball) = (Instant(if any(0) % 64 == 0 { any(now) } else { now }), Some(Point::new(x, y)));
        // One machine sends most of them, eleven others the remaining ones.
        let machine = if any(0) % 4 == 0 { any(0) as u8 % 12 } else { 1 };
        let from = SenderAddress::new(([10, 0, 0, machine], 40_000).into());
        listener.receive(&odd, from, now, ball);
        assert!(listener.warnings(now).iter().all(|warning| !warning.to_string().is_empty()));
        listener.tick(Instant(any(0)), ball);
        listener.silence(Instant(any(0)));
        sound(&listener);
    }
    let counts = listener.counts();
    assert!(counts.taken > 100 && counts.doubted > 1000 && counts.other_source > 100, "{counts:?}");
    assert!(counts.old > 10 && counts.steps > 10 && counts.restrained > 100, "{counts:?}");
}

#[test]
fn turned_packets_of_vision_leave_a_field_that_can_be() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let packets = ["erforce_vision.bin", "vision_detection_and_geometry.bin"].map(packet);
    let mut geometry = VisionGeometry::default();
    let (mut received, mut refused) = (0, 0);
    for round in 0..ROUNDS {
        let bytes = turned(&packets[round as usize % packets.len()], &mut random);
        if let Some(data) = WrapperPacket::decode(&bytes[..]).ok().and_then(|packet| packet.geometry) {
            received += 1;
            refused += u32::from(geometry.receive(&data).is_err());
        }
        assert!(geometry.field().is_none_or(|field| field.checked().is_ok()));
        let places = geometry.cameras().values().flat_map(|camera| camera.position);
        assert!(places.into_iter().all(|x| x.abs() < 100.0));
    }
    assert!(received > ROUNDS / 10 && refused > 10, "{received} of {ROUNDS} decode, {refused} refused");
}

#[test]
fn noise_on_the_teams_port_is_given_up_and_tried_again() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut port = TeamPort::new("onetwo", Colour::Blue);
    let mut connections = 0;
    for round in 0..ROUNDS {
        let now = Instant(u64::from(round) * 100_000);
        if port.wants_connection(now) {
            port.connected(now);
            connections += 1;
        }
        let mut noise = [0; 32];
        random.fill_bytes(&mut noise);
        port.receive(&noise[..(random.next_u32() % 33) as usize], now);
        port.tick(now);
        while port.poll_transmit().is_some() || port.poll_event().is_some() {}
    }
    assert!(connections > 100, "{connections}");
}
