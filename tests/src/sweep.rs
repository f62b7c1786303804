//! `sweep`: cost of packet loss for a team: finished gameplays, robots that stop for lack of their host, and
//! the time to a new cycle, from no loss to half of all packets, independent and in bursts.

use std::fmt::Write as _;

use figures::{Anchor, Axis, Column, Font, Svg, Table, Theme, row};
use hil_sim::{AirSettings, Bursts};

use crate::swarm::plan::{Plan, Squad};
use crate::swarm::{Counters, Found, play};

/// Distribution of packet loss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Each packet independently of the others.
    Independent,
    /// In bursts of [`BURST_MS`] on average, per link.
    Bursty,
}

impl Kind {
    /// Both kinds, independent first.
    pub const ALL: [Self; 2] = [Self::Independent, Self::Bursty];

    /// Its label in the table.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Bursty => "in stretches",
        }
    }

    fn air(self, percent: u32, squad: Squad) -> AirSettings {
        let loss = percent as f32 * 0.01;
        match self {
            Self::Independent => AirSettings::with_loss(loss),
            Self::Bursty => {
                let ticks = BURST_MS / squad.tick_ms() as f32;
                let bursts = (percent > 0).then_some(Bursts { share: loss, ticks });
                AirSettings { bursts, ..AirSettings::default() }
            }
        }
    }
}

/// A row of the table: the results of one kind and share of loss.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Kind of the robots: legs or wheels.
    pub squad: Squad,
    /// The kind of loss.
    pub kind: Kind,
    /// The share of lost packets, percent.
    pub percent: u32,
    /// Sums over the runs of this row.
    pub counters: Counters,
    /// Robot-seconds under loss, approximately: runs of two to four robots.
    pub seconds: f64,
}

impl Row {
    /// Share of the ended gameplays that were finished, percent.
    pub fn finished(&self) -> Option<f64> {
        let all = self.counters.finished + self.counters.stopped;
        (all > 0).then(|| 100.0 * f64::from(self.counters.finished) / f64::from(all))
    }

    /// Stops for lack of a host, per robot and minute; only robots on wheels have one.
    pub fn false_stops(&self) -> Option<f64> {
        (self.squad == Squad::Wheels).then(|| 60.0 * f64::from(self.counters.false_stops) / self.seconds)
    }

    /// Share of the time for which a robot stood for that reason, percent.
    pub fn stood(&self) -> Option<f64> {
        (self.squad == Squad::Wheels).then(|| 0.1 * self.counters.stood_ms as f64 / self.seconds)
    }

    /// From the end of a gameplay to a newer cycle that all robots know, ms.
    pub fn gap(&self) -> Option<f64> {
        (self.counters.gaps > 0).then(|| self.counters.gaps_ms as f64 / f64::from(self.counters.gaps))
    }
}

/// All rows in order, with `seeds` runs each. A violation ends the sweep.
pub fn sweep(seeds: u64) -> Result<Vec<Row>, (u64, Found)> {
    let mut rows = Vec::new();
    for squad in [Squad::Legged, Squad::Wheels] {
        for kind in Kind::ALL {
            for percent in PERCENT {
                let mut row = Row { squad, kind, percent, counters: Counters::default(), seconds: 0.0 };
                for seed in 0..seeds {
                    let plan = Plan::with_air(seed, squad, RUN_MS, kind.air(percent, squad));
                    // Stops are counted until the run's end.
                    let watched = f64::from(plan.end - plan.trouble.from) * 1e-3;
                    row.seconds += watched * plan.brains.len() as f64;
                    row.counters = row.counters.with(play(plan).map_err(|found| (seed, found))?);
                }
                rows.push(row);
            }
        }
    }
    Ok(rows)
}

/// The page of the documentation.
pub fn page(rows: &[Row], seeds: u64) -> String {
    let mut text = format!(
        "# What loss costs\n\n\
         How much of its play a team loses when radio packets are lost: gameplays, stops, time to a new cycle. \
         Written by `cargo xtask faults --write`: {seeds} runs a row, {} s each under loss and 3 s without after it, native brains. \
         Walking robots play by themselves, robots on wheels under a host that says `Gameplay` 75 times a second. Lost is \
         what any one receiver does not hear: each packet by itself, or everything of one direction between two stations in \
         stretches of {BURST_MS} ms on the mean (Gilbert and Elliott). All promises of [architecture.md](architecture.md) \
         §5.4 and §6.2 are watched meanwhile; none was broken.\n\n\
         - *finished*: of the gameplays that ended, those that all their robots played to the end; the rest were aborted.\n\
         - *stops*: how often a robot that was armed braked because its host was silent for 100 ms, in a robot's minute; *stood*: the \
         share of the time for which it then stood (after a silence of half a second it takes half a second to be armed again).\n\
         - *new cycle*: from the end of a gameplay until all robots know a newer cycle.\n\n\
         ![Gameplays finished, stops and time to a new cycle against loss](faults/loss.svg)\n",
        RUN_MS / 1000
    );
    for squad in [Squad::Legged, Squad::Wheels] {
        let name = if squad == Squad::Legged { "Walking robots" } else { "Robots on wheels" };
        // Writing to a String cannot fail.
        let _ =
            write!(text, "\n## {name}\n\n{}", table(rows.iter().filter(|row| row.squad == squad)).markdown());
    }
    text
}

fn table<'a>(rows: impl Iterator<Item = &'a Row>) -> Table {
    let numbers = ["gameplays", "finished, %", "stops a minute", "stood, %", "new cycle, ms"];
    let columns = [Column::number("lost", ""), Column::text("how")];
    let numbers = numbers.map(|head| Column::number(head, ""));
    Table::new(columns.into_iter().chain(numbers)).with_rows(rows.map(|row| {
        let ended = row.counters.finished + row.counters.stopped;
        let measures = [row.finished(), row.false_stops(), row.stood(), row.gap()].map(number);
        row![format!("{} %", row.percent), row.kind.label(), ended].with(measures)
    }))
}

fn number(value: Option<f64>) -> String {
    value.map_or("–".into(), |value| format!("{value:.1}"))
}

/// Chart of three panels, a line for each squad and kind.
pub fn loss_chart(rows: &[Row]) -> String {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    type Measure = (&'static str, fn(&Row) -> Option<f64>);
    let panels: [Measure; 3] = [
        ("gameplays finished, %", Row::finished),
        ("stops in a robot's minute", Row::false_stops),
        ("time to a new cycle, ms", Row::gap),
    ];
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    for (place, (title, measure)) in panels.into_iter().enumerate() {
        let left = 60.0 + 320.0 * place as f64;
        let most = rows.iter().filter_map(measure).fold(1.0, f64::max);
        let up = Axis::in_intervals([0.0, most], [60.0, 260.0], 5.0);
        let across = Axis::linear([0.0, 50.0], [left, left + 250.0]);
        svg.text([left, 290.0], title, Anchor::Start, Font { bold: true, ..font });
        up.draw_beside(&mut svg, left, left + 250.0);
        across.draw_below(&mut svg, 260.0, 60.0, "lost, %");
        for (squad, kind, color, dash) in LINES {
            let own = rows.iter().filter(|row| row.squad == squad && row.kind == kind);
            let points: Vec<_> = own
                .filter_map(|row| Some([across.place(f64::from(row.percent)), up.place(measure(row)?)]))
                .collect();
            svg.polyline(&points, format!(r#"stroke="{color}" stroke-width="2" stroke-dasharray="{dash}""#));
            for point in points {
                svg.circle(point, 3.0, format!(r#"fill="{color}""#));
            }
        }
    }
    let mut x = 60.0;
    for (squad, kind, color, dash) in LINES {
        let name = if squad == Squad::Legged { "walking" } else { "wheels" };
        let style = format!(r#"stroke="{color}" stroke-width="2" stroke-dasharray="{dash}""#);
        svg.line([x, 324.0], [x + 30.0, 324.0], style);
        svg.text([x + 36.0, 320.0], &format!("{name}, {}", kind.label()), Anchor::Start, font);
        x += 220.0;
    }
    svg.finish([0.0, 0.0], [1_000.0, 350.0], 1.0, colors.paper, "What loss costs a team")
}

/// Dark enough for white paper, and distinguishable without red.
const LINES: [(Squad, Kind, &str, &str); 4] = [
    (Squad::Legged, Kind::Independent, "#0072b2", "none"),
    (Squad::Legged, Kind::Bursty, "#0072b2", "6 4"),
    (Squad::Wheels, Kind::Independent, "#d55e00", "none"),
    (Squad::Wheels, Kind::Bursty, "#d55e00", "6 4"),
];
/// Shares of lost packets, percent: the rows of the table.
pub const PERCENT: [u32; 7] = [0, 5, 10, 20, 30, 40, 50];
/// How long a run is under loss, ms: a few gameplays.
const RUN_MS: u32 = 15_000;
/// Mean length of a dead period, ms: a body that blocks the radio for a moment, and as long as a robot waits
/// for its host.
pub const BURST_MS: f32 = 100.0;
