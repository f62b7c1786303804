//! `sanity`: a healthy match reports no finding, and a field on which something does not fit is reported
//! within two seconds, for both divisions.

use arena::game::{Game, GameConfig, NoWatcher};
use geometry::{Angle, Point, Pose};
use hil_sim::NativeBackend;
use host::health_checks::{Fault, HealthChecks, SideEvidence};
use protocol::{RobotId, Who};
use rules::{Colour, League};

const DIVISIONS: [League; 2] = [League::DivisionA, League::DivisionB];

/// Plays for this number of seconds; every 100 ms the findings of each host go to `see`, with the time in ms.
fn play(
    config: &GameConfig,
    seconds: u32,
    mut hand: impl FnMut(&mut Game<'static>, u32),
    mut see: impl FnMut(u32, Colour, Vec<Fault>),
) {
    let base = match config.league {
        League::DivisionB => case_library::division_b(),
        _ => casebase::CaseBase::default(),
    };
    let mut backend = NativeBackend::new(base);
    let mut game = Game::new(config, &mut backend).unwrap();
    let mut sanity = [HealthChecks::default(), HealthChecks::default()];
    for tick in 0..seconds * 100 {
        hand(&mut game, tick * 10);
        game.step(&mut NoWatcher).unwrap();
        if tick % 10 == 9 {
            for colour in [Colour::Yellow, Colour::Blue] {
                let now = game.now();
                see((tick + 1) * 10, colour, sanity[colour as usize].look(now, game.host(colour)));
            }
        }
    }
}

#[test]
fn a_healthy_match_of_either_division_raises_no_warning() {
    for (league, seconds, seeds) in [(League::DivisionB, 120, 1..=4), (League::DivisionA, 60, 1..=2)] {
        for seed in seeds {
            let config = GameConfig::new(league, seed, f64::from(seconds));
            play(
                &config,
                seconds,
                |_, _| (),
                |ms, colour, found| {
                    assert!(
                        found.is_empty(),
                        "{} seed {seed}, {ms} ms, {}: {found:?}",
                        league.name(),
                        colour.label()
                    );
                },
            );
        }
    }
}

/// The time of the first finding for which `is` is true, ms, by both hosts.
fn first(
    config: &GameConfig,
    hand: impl FnMut(&mut Game<'static>, u32),
    is: impl Fn(&Fault) -> bool,
) -> [Option<(u32, Fault)>; 2] {
    let mut first = [None, None];
    play(config, 12, hand, |ms, colour, found| {
        let place = &mut first[colour as usize];
        if place.is_none() {
            *place = found.into_iter().find(|found| is(found)).map(|found| (ms, found));
        }
    });
    first
}

#[test]
fn a_robot_more_than_the_league_allows_is_reported_by_both_hosts_within_two_seconds() {
    for league in DIVISIONS {
        let config = GameConfig::new(league, 1, 12.0);
        let number = league.limits().unwrap().robots as u8;
        let who = Who { colour: Colour::Blue, id: RobotId::new(number).unwrap() };
        let hand = |game: &mut Game<'static>, ms| {
            if ms == 5_000 {
                let at = Point::new(0.5, league.field().width * 0.5 - 0.3);
                game.put_robot(who, Pose { position: at, heading: Angle::ZERO });
            }
        };
        let found = first(&config, hand, |found| matches!(found, Fault::Robots(_)));
        for (colour, found) in [Colour::Yellow, Colour::Blue].into_iter().zip(found) {
            let (ms, found) = found.expect("it is found");
            assert!((5_000..=7_000).contains(&ms), "{}: {ms} ms", league.name());
            let Fault::Robots(many) = &found else { unreachable!() };
            assert_eq!((many.team, many.ours), (Colour::Blue, colour == Colour::Blue));
            assert_eq!((many.on_field, many.allowed), (usize::from(number) + 1, usize::from(number)));
            assert!(found.to_string().contains("allows"), "{found}");
        }
    }
}

#[test]
fn teams_that_start_at_each_others_goals_are_reported_within_two_seconds() {
    for league in DIVISIONS {
        let config = GameConfig::new(league, 1, 12.0);
        let field = league.field();
        // Both teams have been put into the wrong halves by hand.
        let hand = |game: &mut Game<'static>, ms: u32| {
            if ms == 0 {
                let robots: Vec<_> =
                    game.world().robots().iter().map(|robot| (robot.who, robot.pose)).collect();
                for (who, pose) in robots {
                    let at = Point::new(-pose.position.x(), pose.position.y());
                    let at = if who.id == RobotId::ZERO {
                        Point::new(at.x().signum() * (field.length * 0.5 - 0.3), 0.0)
                    } else {
                        at
                    };
                    game.put_robot(who, Pose { position: at, heading: pose.heading });
                }
            }
        };
        let found = first(&config, hand, |found| matches!(found, Fault::Side(_)));
        for found in found {
            let (ms, found) = found.expect("it is found");
            assert!(ms <= 2_000, "{}: {ms} ms", league.name());
            let Fault::Side(wrong) = found else { unreachable!() };
            assert!(
                matches!(wrong.evidence, SideEvidence::OurKeeper(_) | SideEvidence::Halves(..)),
                "{wrong:?}"
            );
        }
    }
}
