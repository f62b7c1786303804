//! `list`: the claims of §5, each with the place of its numbers. The sentences are ours; their content is the
//! paper's.

use brain::Approach::{self, Cases, Reactive};
use hil_sim::Scenario::{self, DefenderAhead, DefenderClose, LeftSide, MiddleBack};

use super::point::{ClaimPoint, Rows, Wanted};
use crate::evaluation::comparison::Measure;

/// The numbers of a claim; `None` where one was not measured.
pub(super) type Points = fn(&Rows<'_>) -> Vec<Option<ClaimPoint>>;

/// Name, section, sentence, numbers.
type Entry = (&'static str, &'static str, &'static str, Points);

const CBR_MORE: [Approach; 2] = [Cases, Reactive];
const CBR_LESS: [Approach; 2] = [Reactive, Cases];
const ALL: [Scenario; 4] = Scenario::PAPER;
const FIRST_THREE: [Scenario; 3] = [MiddleBack, LeftSide, DefenderAhead];

/// Whether it is a claim about trials with robots.
pub(super) fn is_of_robots(section: &str) -> bool {
    section.starts_with("5.3") || section == "5.4"
}

fn each(
    rows: &Rows<'_>,
    table: u8,
    scenarios: &[Scenario],
    measure: Measure,
    order: [Approach; 2],
) -> Vec<Option<ClaimPoint>> {
    scenarios.iter().map(|s| rows.pair((table, *s), measure, order, Wanted::Greater)).collect()
}

/// One measure of one scenario of Table 6.
fn robots(
    rows: &Rows<'_>,
    scenario: Scenario,
    measure: Measure,
    order: [Approach; 2],
) -> Vec<Option<ClaimPoint>> {
    vec![rows.pair((6, scenario), measure, order, Wanted::Greater)]
}

/// All of them, in the order of the paper.
pub(super) const CLAIMS: &[Entry] = &[
    ("dg-to-goal", "5.2.1", "More balls come to goal with cases than without, in all four scenarios.", |r| {
        each(r, 1, &ALL, Measure::ToGoal, CBR_MORE)
    }),
    (
        "dg-to-goal-3-4",
        "5.2.1",
        "In scenarios 3 and 4 more balls come to goal with cases, and that is no chance.",
        |r| each(r, 1, &[DefenderAhead, DefenderClose], Measure::ToGoal, CBR_MORE),
    ),
    (
        "dg-greatest-3-4",
        "5.2.1",
        "Cases gain more balls to goal in scenarios 3 and 4 than in 1 and 2.",
        |r| {
            let of = |front: Scenario, back: Scenario| {
                let names = [front, back].map(|scenario| format!("scenario {scenario}"));
                let cell = |scenario| (1, scenario, Measure::ToGoal);
                r.effects(cell(front), cell(back), CBR_MORE, names)
            };
            let fronts = [DefenderAhead, DefenderClose].into_iter();
            fronts.flat_map(|front| [MiddleBack, LeftSide].map(|back| of(front, back))).collect()
        },
    ),
    ("dg-out", "5.2.1", "Fewer balls go out with cases, in all four scenarios.", |r| {
        each(r, 1, &ALL, Measure::Out, CBR_LESS)
    }),
    (
        "dg-possession",
        "5.2.1",
        "The defender has the ball less often against cases, in all four scenarios.",
        |r| each(r, 1, &ALL, Measure::Possession, CBR_LESS),
    ),
    (
        "dg-time",
        "5.2.1",
        "Trials last longer with cases in scenarios 1 to 3, and shorter in scenario 4.",
        |r| {
            let mut points = each(r, 1, &FIRST_THREE, Measure::Time, CBR_MORE);
            points.extend(each(r, 1, &[DefenderClose], Measure::Time, CBR_LESS));
            points
        },
    ),
    (
        "dg-possession-rate",
        "5.2.1",
        "Against reactive attackers the defender gets at the ball more often in a second, in all four scenarios.",
        |r| {
            let rate = |scenario, approach| {
                let row = r.row(1, scenario, approach)?;
                Some(row.possession_mean? / row.time_mean.filter(|time| *time > 0.0)?)
            };
            let point = |scenario| {
                let (first, second) = (rate(scenario, Reactive)?, rate(scenario, Cases)?);
                let name = format!("scenario {scenario}");
                let point =
                    ClaimPoint::new(name, ("reactive", first), ("cbr", second), None, Wanted::Greater);
                Some(point.with_decimals(3))
            };
            ALL.map(point).into()
        },
    ),
    (
        "dg-possession-far",
        "5.2.1",
        "The defender has the ball more often in scenarios 1 to 3 than in 4, which begins nearer to the goal.",
        |r| {
            let pairs = [Cases, Reactive].into_iter().flat_map(|team| FIRST_THREE.map(|far| (team, far)));
            pairs.map(|(team, far)| r.scenarios(1, team, Measure::Possession, [far, DefenderClose])).collect()
        },
    ),
    (
        "backing-up-b",
        "5.2.1",
        "Of reactive attackers B backs up more often than A in scenarios 1 to 3.",
        |r| FIRST_THREE.map(|scenario| r.backups(scenario)).into(),
    ),
    (
        "backing-up-4",
        "5.2.1",
        "In scenario 4 reactive attackers share the backing up more evenly than in 1 to 3.",
        |r| {
            let share = |scenario| {
                let row = r.row(2, scenario, Reactive)?;
                let (a, b) = (row.backups_a?, row.backups_b?);
                (a + b > 0.0).then(|| 100.0 * a / (a + b))
            };
            let point = |far: Scenario| {
                let (near, other) = (share(DefenderClose)?, share(far)?);
                let second = (format!("scenario {far}"), other);
                let point =
                    ClaimPoint::new("percent by A", ("scenario 4", near), second, None, Wanted::Greater);
                Some(point.with_decimals(1))
            };
            FIRST_THREE.map(point).into()
        },
    ),
    (
        "cooperative-half",
        "5.2.1",
        "At least half of the used cases are for several robots, in all four scenarios.",
        |r| ALL.map(|scenario| r.half_cooperative(scenario)).into(),
    ),
    (
        "cooperative-4",
        "5.2.1",
        "Near the goal fewer of them are: scenario 4 has a smaller share of cases for several than 1 to 3.",
        |r| FIRST_THREE.map(|far| r.more_cooperative([far, DefenderClose])).into(),
    ),
    (
        "2d-to-goal",
        "5.2.2",
        "Two defenders: more balls come to goal with cases, in all four scenarios.",
        |r| each(r, 4, &ALL, Measure::ToGoal, CBR_MORE),
    ),
    ("2d-out", "5.2.2", "Two defenders: fewer balls go out with cases, in all four scenarios.", |r| {
        each(r, 4, &ALL, Measure::Out, CBR_LESS)
    }),
    (
        "2d-timeout",
        "5.2.2",
        "Two defenders: fewer trials run out of time with cases in scenario 4, and about as many in 1 to 3.",
        |r| {
            let alike = |scenario| r.pair((4, scenario), Measure::Timeout, CBR_LESS, Wanted::Alike);
            let mut points: Vec<_> = FIRST_THREE.map(alike).into();
            points.extend(each(r, 4, &[DefenderClose], Measure::Timeout, CBR_LESS));
            points
        },
    ),
    (
        "2d-midfield",
        "5.2.2",
        "The midfield defender has the ball less often against cases, in all four scenarios.",
        |r| each(r, 5, &ALL, Measure::MidfieldPossession, CBR_LESS),
    ),
    ("2d-defender", "5.2.2", "So has the defender behind it, if only a little.", |r| {
        each(r, 5, &ALL, Measure::Possession, CBR_LESS)
    }),
    (
        "2d-defender-alike",
        "5.2.2",
        "In scenarios 1 to 3 the defender's possession does not differ by more than chance.",
        |r| FIRST_THREE.map(|s| r.pair((5, s), Measure::Possession, CBR_LESS, Wanted::Alike)).into(),
    ),
    ("2d-time", "5.2.2", "Two defenders: trials are shorter with cases, in all four scenarios.", |r| {
        each(r, 5, &ALL, Measure::Time, CBR_LESS)
    }),
    (
        "2d-midfield-more",
        "5.2.2",
        "Cases keep the ball from the midfield defender by more than from the only defender before a goalie.",
        |r| {
            let point = |scenario| {
                let names = ["the midfield defender", "the only defender"].map(str::to_owned);
                let cells = ((5, scenario, Measure::MidfieldPossession), (1, scenario, Measure::Possession));
                let point = r.effects(cells.0, cells.1, CBR_LESS, names)?;
                let of = format!("scenario {scenario}, {}", point.of);
                Some(point.of(of))
            };
            ALL.map(point).into()
        },
    ),
    ("robots-3-to-goal", "5.3.1", "Robots, scenario 3: more balls come to goal with cases.", |r| {
        robots(r, DefenderAhead, Measure::ToGoal, CBR_MORE)
    }),
    (
        "robots-3-block",
        "5.3.1",
        "Robots, scenario 3: the goalie stops more balls of case-based attackers.",
        |r| robots(r, DefenderAhead, Measure::Block, CBR_MORE),
    ),
    ("robots-3-out", "5.3.1", "Robots, scenario 3: fewer balls go out with cases.", |r| {
        robots(r, DefenderAhead, Measure::Out, CBR_LESS)
    }),
    ("robots-3-put-out", "5.3.1", "Robots, scenario 3: opponents put fewer balls out.", |r| {
        vec![r.put_out(DefenderAhead, CBR_LESS)]
    }),
    (
        "robots-3-possession",
        "5.3.1",
        "Robots, scenario 3: the defender has the ball less often against cases.",
        |r| robots(r, DefenderAhead, Measure::Possession, CBR_LESS),
    ),
    ("robots-4-to-goal", "5.3.2", "Robots, scenario 4: more balls come to goal without cases.", |r| {
        robots(r, DefenderClose, Measure::ToGoal, CBR_LESS)
    }),
    (
        "robots-4-block",
        "5.3.2",
        "Robots, scenario 4: the goalie stops more balls of case-based attackers.",
        |r| robots(r, DefenderClose, Measure::Block, CBR_MORE),
    ),
    ("robots-4-out", "5.3.2", "Robots, scenario 4: fewer balls go out with cases.", |r| {
        robots(r, DefenderClose, Measure::Out, CBR_LESS)
    }),
    ("robots-4-put-out", "5.3.2", "Robots, scenario 4: opponents put fewer balls out.", |r| {
        vec![r.put_out(DefenderClose, CBR_LESS)]
    }),
    (
        "robots-4-possession",
        "5.3.2",
        "Robots, scenario 4: the defender has the ball less often against cases.",
        |r| robots(r, DefenderClose, Measure::Possession, CBR_LESS),
    ),
    (
        "order-turns",
        "5.4",
        "In scenario 4 cases bring more balls to goal in simulation, and fewer with robots.",
        |r| {
            let simulated = r.pair((1, DefenderClose), Measure::ToGoal, CBR_MORE, Wanted::Greater);
            let robots = r.pair((6, DefenderClose), Measure::ToGoal, CBR_LESS, Wanted::Greater);
            let named = |point: Option<ClaimPoint>, of: &str| point.map(|point| point.of(of));
            vec![named(simulated, "simulated"), named(robots, "robots")]
        },
    ),
    (
        "doubled-possession",
        "5.4",
        "Reactive attackers almost double the defender's chances: at least half as many again as with cases.",
        |r| {
            let dg = ALL.map(|s| r.times((1, s), Measure::Possession, CBR_LESS, ALMOST_DOUBLE));
            let robots = [DefenderAhead, DefenderClose].map(|s| {
                let point = r.times((6, s), Measure::Possession, CBR_LESS, ALMOST_DOUBLE)?;
                let of = format!("robots, {}", point.of);
                Some(point.of(of))
            });
            dg.into_iter().chain(robots).collect()
        },
    ),
    (
        "default-share",
        "5.4",
        "Default behaviour hardly matters: at most 5 percent of the time, in all four scenarios.",
        |r| {
            let point = |scenario| {
                let share = r.row(3, scenario, Cases)?.default_time?;
                let name = format!("scenario {scenario}");
                let point = ClaimPoint::new(
                    name,
                    ("at most", LITTLE_PERCENT),
                    ("default", share),
                    None,
                    Wanted::AtLeast,
                );
                Some(point.with_decimals(1))
            };
            ALL.map(point).into()
        },
    ),
    ("default-cause", "5.4", "Its only cause is the cost threshold, never a hole in the case base.", |r| {
        let point = |scenario| {
            let row = r.row(3, scenario, Cases)?;
            let others = row.none_ball? + row.none_robots? + row.none_path? + row.none_held?;
            let all = others + row.none_thr_c?;
            (all > 0.0).then_some(())?;
            let share = 100.0 * row.none_thr_c? / all;
            let name = format!("scenario {scenario}");
            let point = ClaimPoint::new(
                name,
                ("thr_c, percent of all causes", share),
                ("all", 100.0),
                None,
                Wanted::AtLeast,
            );
            Some(point.with_decimals(1))
        };
        ALL.map(point).into()
    }),
];

/// Between equal and double, at the middle: less than double and clearly more than equal.
const ALMOST_DOUBLE: f64 = 1.5;
/// The paper prints no share that it calls insignificant; this limit is our estimate, percent.
const LITTLE_PERCENT: f64 = 5.0;
