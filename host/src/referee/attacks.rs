//! `attacks`: tests: HALT has priority over forged packets, second referees and clocks that step. The attacks
//! of the security review in virtual time: a genuine controller at 40 Hz, an attacker's packets, and how long
//! robots were let play under HALT.

use rules::{Colour, League};
use ssl::referee::{Command as Wire, TeamInfo};

use super::*;

const S: u64 = 1_000_000;
const MS: u64 = 1_000;
/// The controller's period, µs.
const PERIOD: u64 = 25 * MS;
/// Unix time at instant 0 of the host, µs.
const EPOCH: u64 = 1_795_220_000 * S;

/// A program that sends referee packets.
#[derive(Clone)]
struct Program {
    identifier: &'static str,
    address: SenderAddress,
    counter: u32,
}

impl Program {
    fn new(identifier: &'static str, machine: u8) -> Self {
        let address = SenderAddress::new(([10, 0, 0, machine], 40_000).into());
        Self { identifier, address, counter: 1 }
    }

    /// A packet stamped `off` from its sending, µs.
    fn packet(&self, now: u64, off: i64, command: Wire) -> Referee {
        let stamp = (EPOCH + now).saturating_add_signed(off);
        let team = |name: &str| TeamInfo { name: name.into(), ..TeamInfo::default() };
        Referee {
            packet_timestamp: stamp,
            command: command as i32,
            command_counter: self.counter,
            command_timestamp: stamp,
            yellow: team("yellow"),
            blue: team("blue"),
            source_identifier: Some(self.identifier.into()),
            ..Referee::default()
        }
    }
}

fn listener(pin: Option<&str>) -> Listener {
    Listener::new(League::DivisionB.limits().unwrap(), pin.map(SourcePin::of), Instant(0))
}

/// The controller at 40 Hz from second 0 on, FORCE_START until `halt_at`, HALT from then on, seen for
/// `total`; `clock` is its clock's error at a time, `more` gives an attacker's packets at a time. Returns the
/// time in which robots were allowed to move under HALT, from the first HALT that arrived on, µs.
fn play(
    listener: &mut Listener,
    (halt_at, total): (u64, u64),
    clock: impl Fn(u64) -> i64,
    mut more: impl FnMut(u64) -> Vec<(Program, Referee)>,
) -> u64 {
    let mut genuine = Program::new("gc", 1);
    let (mut free, mut halted) = (0, false);
    for now in (0..total).step_by(5 * MS as usize) {
        for (program, packet) in more(now) {
            listener.receive(&packet, program.address, Instant(now), None);
        }
        if now % PERIOD == 0 {
            let halt = now >= halt_at;
            genuine.counter = if halt { 8 } else { 7 };
            let command = if halt { Wire::Halt } else { Wire::ForceStart };
            let packet = genuine.packet(now, clock(now), command);
            listener.receive(&packet, genuine.address, Instant(now), None);
            halted |= halt;
        }
        listener.tick(Instant(now), None);
        if halted && listener.game().phase != Phase::Halt {
            free += 5 * MS;
        }
    }
    free
}

#[test]
fn finding_1_a_spoofed_stamp_of_the_future_does_not_hide_a_halt() {
    for off in [200 * MS, 290 * MS, 310 * MS, 4_900 * MS, 3_600 * S] {
        // One packet with the controller's identifier and address, 10 ms before HALT; and then one with every
        // fourth.
        for again in [false, true] {
            let mut listener = listener(None);
            let mut forger = Program::new("gc", 1);
            forger.counter = 9;
            let free = play(
                &mut listener,
                (8 * S, 16 * S),
                |_| 0,
                |now| {
                    let send = now == 8 * S - 10 * MS || (again && now > 8 * S && now % (100 * MS) == 5 * MS);
                    let packet = forger.packet(now, off as i64, Wire::ForceStart);
                    if send { vec![(forger.clone(), packet)] } else { vec![] }
                },
            );
            assert_eq!(free, 0, "stamped {off} µs ahead, again: {again}: {:?}", listener.counts());
        }
    }
}

#[test]
fn a_stamp_ahead_of_its_arrival_never_becomes_the_newest() {
    let mut listener = listener(None);
    let genuine = Program::new("gc", 1);
    let receive = |listener: &mut Listener, now: u64, off: i64, command, counter| {
        let program = Program { counter, ..genuine.clone() };
        listener.receive(&program.packet(now, off, command), genuine.address, Instant(now), None)
    };
    receive(&mut listener, 0, 0, Wire::Stop, 1);
    let verdict = receive(&mut listener, S, 4_900_000, Wire::ForceStart, 2);
    assert_eq!(
        verdict,
        RefereeVerdict::Doubted { doubt: Doubt::Ahead(Duration(4_900_000)), restrains: false }
    );
    assert_eq!(listener.game().phase, Phase::Stop);
    // Genuine packets are followed as before.
    assert!(matches!(receive(&mut listener, S + PERIOD, 0, Wire::ForceStart, 2), RefereeVerdict::Taken(_)));
    assert_eq!(listener.game().phase, Phase::Run);
    let warned = listener.warnings(Instant(S + PERIOD));
    assert!(warned.iter().any(|warning| warning.to_string().contains("4.9 s ahead")), "{warned:?}");
}

#[test]
fn finding_1_a_stepping_clock_delays_no_halt_and_is_followed_within_the_window() {
    for step in
        [-3_600 * S as i64, -4_000_000, -310_000, -250_000, 250_000, 310_000, 4_000_000, 3_600 * S as i64]
    {
        let mut halts = listener(None);
        let clock = |now| if now >= 9 * S { step } else { 0 };
        assert_eq!(play(&mut halts, (9 * S, 14 * S), clock, |_| vec![]), 0, "{step}");
        // A command that lets robots play is followed within the window.
        let mut listener = listener(None);
        let mut genuine = Program::new("gc", 1);
        let mut followed = None;
        for now in (0..2 * S).step_by(PERIOD as usize) {
            let stepped = now >= S;
            genuine.counter = 1 + u32::from(stepped);
            let command = if stepped { Wire::ForceStart } else { Wire::Stop };
            let packet = genuine.packet(now, if stepped { step } else { 0 }, command);
            listener.receive(&packet, genuine.address, Instant(now), None);
            if listener.game().phase == Phase::Run {
                followed.get_or_insert(now - S);
            }
        }
        assert!(
            followed.is_some_and(|after| after <= WINDOW.0),
            "step {step}: followed after {followed:?} µs"
        );
        let warned = listener.warnings(Instant(2 * S));
        let far = step.unsigned_abs() > WINDOW.0;
        let stepped = |warning: &Warning| matches!(warning, Warning::ClockStepped { by, .. } if (by - step).abs() < 1_000);
        assert_eq!(warned.iter().any(stepped), far, "{step}: {warned:?}");
        assert_eq!(listener.counts().steps, u64::from(far));
    }
}

#[test]
fn finding_2_a_source_that_returns_every_2_8_s_does_not_hide_halt() {
    let mut listener = listener(None);
    let evil = Program::new("evil", 66);
    // It sends before the controller does, and then every 2.8 s; HALT for 17.5 s at 40 Hz.
    let mut first = listener.clone();
    first.receive(&evil.packet(0, 0, Wire::ForceStart), evil.address, Instant(0), None);
    let free = play(
        &mut first,
        (S, S + 17_500 * MS),
        |_| 0,
        |now| {
            let send = now % (2_800 * MS) == 0;
            if send { vec![(evil.clone(), evil.packet(now, 0, Wire::ForceStart))] } else { vec![] }
        },
    );
    assert_eq!(free, 0);
    let warned = first.warnings(Instant(18_500 * MS));
    let [Warning::Disagreement { .. }] = &warned[..] else { panic!("{warned:?}") };
    let description = warned[0].to_string();
    assert!(
        description.contains("10.0.0.1:40000") && description.contains("10.0.0.66:40000"),
        "{description}"
    );
    assert!(description.contains("--referee-source"), "{description}");
    // The same where it comes second.
    let free = play(
        &mut listener,
        (S, S + 17_500 * MS),
        |_| 0,
        |now| {
            let send = now % (2_800 * MS) == 10 * MS;
            if send { vec![(evil.clone(), evil.packet(now, 0, Wire::ForceStart))] } else { vec![] }
        },
    );
    assert_eq!(free, 0);
}

/// A source's newest packet, all at one time.
fn send_packet(listener: &mut Listener, program: &mut Program, now: u64, command: Wire) {
    program.counter += 1;
    listener.receive(&program.packet(now, 0, command), program.address, Instant(now), None);
}

#[test]
fn of_two_sources_the_stricter_is_obeyed_at_once_whoever_came_first() {
    let orders = [
        (Wire::Halt, Wire::ForceStart, Phase::Halt),
        (Wire::Halt, Wire::Stop, Phase::Halt),
        (Wire::Halt, Wire::TimeoutBlue, Phase::Halt),
        (Wire::Stop, Wire::ForceStart, Phase::Stop),
        (Wire::TimeoutBlue, Wire::ForceStart, Phase::Stop),
        (Wire::Stop, Wire::TimeoutBlue, Phase::Stop),
        (Wire::Stop, Wire::BallPlacementBlue, Phase::Stop),
    ];
    for (strict, loose, expected) in orders {
        for strict_first in [true, false] {
            let mut listener = listener(None);
            let (mut one, mut two) = (Program::new("a", 1), Program::new("b", 2));
            let (first, second) = if strict_first { (strict, loose) } else { (loose, strict) };
            send_packet(&mut listener, &mut one, 0, Wire::Stop);
            send_packet(&mut listener, &mut one, S, first);
            send_packet(&mut listener, &mut two, S + 1, second);
            let phase = listener.game().phase;
            // A timeout that is followed is one; that of another source is read as STOP.
            let timeout = first == Wire::TimeoutBlue && second == Wire::ForceStart;
            let expected = if timeout { Phase::Timeout(Colour::Blue) } else { expected };
            assert_eq!(phase, expected, "{first:?} then {second:?}");
        }
    }
}

#[test]
fn two_that_differ_and_neither_is_stricter_are_read_as_stop_after_the_window() {
    let mut listener = listener(None);
    let (mut one, mut two) = (Program::new("a", 1), Program::new("b", 2));
    for program in [&mut one, &mut two] {
        send_packet(&mut listener, program, 0, Wire::PrepareKickoffBlue);
    }
    // One controller on two networks: the second packet comes later, and nothing happens in between.
    send_packet(&mut listener, &mut one, S, Wire::NormalStart);
    assert_eq!(listener.game().phase, Phase::Kickoff(Colour::Blue));
    listener.tick(Instant(S + WINDOW.0 - 1), None);
    assert_eq!(listener.game().phase, Phase::Kickoff(Colour::Blue));
    listener.tick(Instant(S + WINDOW.0), None);
    assert_eq!(listener.game().phase, Phase::Stop);
    send_packet(&mut listener, &mut two, 2 * S, Wire::NormalStart);
    assert_eq!(listener.game().phase, Phase::Kickoff(Colour::Blue), "they agree again");
    assert!(listener.warnings(Instant(2 * S)).iter().all(|warning| !warning.is_urgent()));
}

#[test]
fn one_controller_on_two_networks_is_followed_without_a_stop() {
    // The same packets from two addresses, the second 30 ms later, and copies of each 60 ms later.
    let mut listener = listener(None);
    let (one, two) = (Program::new("gc", 1), Program::new("gc", 2));
    let commands = [
        Wire::Halt,
        Wire::Stop,
        Wire::PrepareKickoffBlue,
        Wire::NormalStart,
        Wire::Stop,
        Wire::DirectFreeYellow,
    ];
    let mut phases = vec![];
    let packet_of = |sent: u64| {
        let number = (sent / (3 * S)) as usize;
        let command = commands[number.min(commands.len() - 1)];
        Program { counter: number as u32, ..one.clone() }.packet(sent, 0, command)
    };
    for now in (0..18 * S).step_by(5 * MS as usize) {
        for (delay, program) in [(0, &one), (30 * MS, &two), (60 * MS, &one), (90 * MS, &two)] {
            if let Some(sent) = now.checked_sub(delay).filter(|sent| sent % PERIOD == 0) {
                listener.receive(&packet_of(sent), program.address, Instant(now), None);
            }
        }
        listener.tick(Instant(now), None);
        let phase = listener.game().phase;
        if phases.last() != Some(&phase) {
            phases.push(phase);
        }
    }
    let blue = Colour::Blue;
    let expected = [
        Phase::Halt,
        Phase::Stop,
        Phase::PrepareKickoff(blue),
        Phase::Kickoff(blue),
        Phase::Stop,
        Phase::FreeKick(blue.other()),
    ];
    assert_eq!(phases, expected);
    assert_eq!((listener.counts().doubted, listener.counts().restrained), (0, 0));
}

#[test]
fn a_late_copy_of_an_old_stop_restrains_once_and_briefly() {
    let mut listener = listener(None);
    let genuine = Program::new("gc", 1);
    let receive = |listener: &mut Listener, sent: u64, now: u64, command, counter| {
        let program = Program { counter, ..genuine.clone() };
        listener.receive(&program.packet(sent, 0, command), genuine.address, Instant(now), None);
        listener.game().phase
    };
    assert_eq!(receive(&mut listener, 0, 0, Wire::Stop, 1), Phase::Stop);
    assert_eq!(receive(&mut listener, S - 50 * MS, S - 50 * MS, Wire::Stop, 1), Phase::Stop);
    assert_eq!(receive(&mut listener, S, S, Wire::ForceStart, 2), Phase::Run);
    // A copy of a received packet restrains nothing.
    assert_eq!(receive(&mut listener, S - 50 * MS, S + 10 * MS, Wire::Stop, 1), Phase::Run);
    // The first network lost this one, the second was late.
    assert_eq!(receive(&mut listener, S - PERIOD, S + 20 * MS, Wire::Stop, 1), Phase::Stop);
    listener.tick(Instant(S + 20 * MS + HOLD.0 - 1), None);
    assert_eq!(listener.game().phase, Phase::Stop);
    listener.tick(Instant(S + 20 * MS + HOLD.0), None);
    assert_eq!(listener.game().phase, Phase::Run, "the newer command stood underneath");
}

#[test]
fn a_source_that_changes_its_mind_with_every_packet_is_two_programs_and_halts() {
    // A forger with the controller's identifier and address, stamps in order and counters that rise.
    let mut listener = listener(None);
    let mut forger = Program::new("gc", 1);
    forger.counter = 9;
    let free = play(
        &mut listener,
        (S, 5 * S),
        |_| 0,
        |now| {
            if now <= S || now % PERIOD != 10 * MS {
                return vec![];
            }
            forger.counter += 1;
            vec![(forger.clone(), forger.packet(now, 0, Wire::ForceStart))]
        },
    );
    // It is followed once, until the next genuine packet: 15 ms, and no longer.
    assert!(free <= PERIOD, "{free} µs: {:?}", listener.counts());
}

#[test]
fn a_pinned_referee_is_obeyed_alone_and_the_other_is_reported() {
    for (pin, evil) in [("10.0.0.1", Program::new("gc", 66)), ("gc", Program::new("evil", 1))] {
        let mut listener = listener(Some(pin));
        let mut genuine = Program::new("gc", 1);
        send_packet(&mut listener, &mut genuine, 0, Wire::Stop);
        send_packet(&mut listener, &mut genuine, S, Wire::ForceStart);
        let packet = evil.packet(S, 0, Wire::Halt);
        let verdict = listener.receive(&packet, evil.address, Instant(S), None);
        assert!(matches!(verdict, RefereeVerdict::Excluded { .. }), "{verdict:?}");
        assert_eq!((listener.game().phase, listener.counts().excluded), (Phase::Run, 1));
        let warned = listener.warnings(Instant(S));
        assert!(matches!(&warned[..], [Warning::Excluded { .. }]), "{warned:?}");
        assert!(warned[0].to_string().contains(pin), "{}", warned[0]);
    }
    // A controller that was restarted on the pinned machine is taken: another port, another identifier.
    let mut listener = listener(Some("10.0.0.1"));
    send_packet(&mut listener, &mut Program::new("before", 1), 0, Wire::Stop);
    let mut restarted = Program::new("after", 1);
    restarted.address = SenderAddress::new(([10, 0, 0, 1], 50_000).into());
    send_packet(&mut listener, &mut restarted, 500 * MS, Wire::Halt);
    assert_eq!(listener.game().phase, Phase::Halt, "the stricter of the two, at once");
}

#[test]
fn a_second_source_that_halts_for_ever_halts_us_is_reported_and_ends_with_a_stop() {
    let mut listener = listener(None);
    let (mut genuine, mut other) = (Program::new("gc", 1), Program::new("forgotten", 2));
    send_packet(&mut listener, &mut genuine, 0, Wire::Stop);
    send_packet(&mut listener, &mut genuine, 100 * MS, Wire::ForceStart);
    let mut now = 100 * MS;
    for _ in 0..200 {
        now += PERIOD;
        listener.receive(&genuine.packet(now, 0, Wire::ForceStart), genuine.address, Instant(now), None);
        send_packet(&mut listener, &mut other, now, Wire::Halt);
        assert_eq!(listener.game().phase, Phase::Halt);
        assert!(listener.warnings(Instant(now)).iter().any(Warning::is_urgent));
    }
    // Its end: robots do not start without a command.
    let ended = now;
    let mut phases = vec![];
    while now < ended + 10 * S {
        now += PERIOD;
        listener.receive(&genuine.packet(now, 0, Wire::ForceStart), genuine.address, Instant(now), None);
        if phases.last().is_none_or(|(_, phase)| *phase != listener.game().phase) {
            phases.push((now - ended, listener.game().phase));
        }
    }
    let order: Vec<_> = phases.iter().map(|(_, phase)| *phase).collect();
    assert_eq!(order, [Phase::Halt, Phase::Stop, Phase::Run], "{phases:?}");
    assert!(phases[1].0 >= SILENCE.0 && phases[2].0 - phases[1].0 >= 2 * S, "{phases:?}");
    assert!(listener.warnings(Instant(now)).is_empty());
}

#[test]
fn no_flood_of_invented_sources_hides_a_halt() {
    let mut listener = listener(None);
    let mut number = 0_u32;
    let free = play(
        &mut listener,
        (S, 3 * S),
        |_| 0,
        |now| {
            // 20 new sources every 5 ms, all of which send FORCE_START.
            let invented = (0..20).map(|_| {
                number += 1;
                let [_, a, b, c] = number.to_be_bytes();
                let mut program = Program::new("invented", 1);
                program.address = SenderAddress::new(([172, a, b, c], 9).into());
                let packet = program.packet(now, 0, Wire::ForceStart);
                (program, packet)
            });
            invented.collect()
        },
    );
    assert_eq!(free, 0);
    assert!(listener.warnings(Instant(3 * S)).len() <= SOURCES_MAX * 2);
}

#[test]
fn a_counter_that_starts_again_is_followed_once_it_stays() {
    let mut listener = listener(None);
    let mut genuine = Program::new("gc", 1);
    genuine.counter = 40;
    listener.receive(&genuine.packet(0, 0, Wire::ForceStart), genuine.address, Instant(0), None);
    genuine.counter = 0;
    let verdict =
        listener.receive(&genuine.packet(PERIOD, 0, Wire::Halt), genuine.address, Instant(PERIOD), None);
    assert_eq!(verdict, RefereeVerdict::Doubted { doubt: Doubt::Counter, restrains: true });
    assert_eq!(listener.game().phase, Phase::Halt, "HALT at once");
    let mut now = PERIOD;
    let taken = loop {
        now += PERIOD;
        let received =
            listener.receive(&genuine.packet(now, 0, Wire::Halt), genuine.address, Instant(now), None);
        assert_eq!(listener.game().phase, Phase::Halt);
        if let RefereeVerdict::Taken(taken) = received {
            break taken;
        }
    };
    assert!(taken.counter_restarted && now - PERIOD <= WINDOW.0, "{now}");
    assert_eq!(listener.warnings(Instant(now)), [], "the league's controller does so when it resets a match");
}

#[test]
fn a_goal_that_the_controller_announces_with_its_next_commands_counter_is_in_order() {
    let mut listener = listener(None);
    let mut genuine = Program::new("gc", 1);
    genuine.counter = 40;
    listener.receive(&genuine.packet(0, 0, Wire::ForceStart), genuine.address, Instant(0), None);
    genuine.counter = 41;
    for (now, command) in [(PERIOD, Wire::GoalBlue), (2 * PERIOD, Wire::Halt), (3 * PERIOD, Wire::Halt)] {
        let verdict = listener.receive(&genuine.packet(now, 0, command), genuine.address, Instant(now), None);
        assert!(matches!(verdict, RefereeVerdict::Taken(_)), "{command:?}: {verdict:?}");
    }
    assert_eq!((listener.game().phase, listener.warnings(Instant(3 * PERIOD))), (Phase::Halt, vec![]));
}

#[test]
fn a_referee_whose_stamps_stand_still_is_obeyed_when_it_says_halt() {
    // A test program that fills in no time and counts nothing.
    let mut listener = listener(None);
    let silly = Program { counter: 0, ..Program::new("script", 1) };
    let mut free = 0;
    for now in (0..6 * S).step_by(5 * MS as usize) {
        let command = if (2 * S..4 * S).contains(&now) { Wire::ForceStart } else { Wire::Halt };
        if now % PERIOD == 0 {
            let mut packet = silly.packet(now, 0, command);
            packet.packet_timestamp = 0;
            packet.command_timestamp = 0;
            listener.receive(&packet, silly.address, Instant(now), None);
        }
        listener.tick(Instant(now), None);
        free += u64::from(now >= 4 * S && listener.game().phase != Phase::Halt);
    }
    assert_eq!(free, 0);
}
