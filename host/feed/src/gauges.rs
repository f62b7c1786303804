//! `gauges`: health figures. Vision, radio and the program's own tick time, with their limits.

use std::time::Duration;

use host::Host;
use page::{Gauge, milli};
use protocol::{Instant, RobotId};

/// A camera frame older than this misses three periods at 60 Hz, ms.
const VISION_AGE_MS: f32 = 50.0;
/// Least rate of vision, packets a second: below it, less than one slow camera sends.
const VISION_RATE: f32 = 50.0;
/// Longest round trip: two periods of the radio, ms.
const TRIP_MS: f32 = 40.0;
/// Largest loss of frames, percent.
const LOSS_MAX_PERCENT: f32 = 10.0;
/// Longest tick, ms: brains step every 10 ms.
const TICK_MS: f32 = 10.0;

#[derive(Debug, Default)]
pub(super) struct Rate {
    since: Option<(f64, u64)>,
    value: f32,
}

impl Rate {
    /// Packets a second, computed each half second.
    pub(super) fn of(&mut self, t: f64, count: u64) -> f32 {
        let (begin, before) = *self.since.get_or_insert((t, count));
        if t - begin >= 0.5 || t < begin {
            self.value =
                if t > begin { ((count - before.min(count)) as f64 / (t - begin)) as f32 } else { 0.0 };
            self.since = Some((t, count));
        }
        self.value
    }
}

pub(super) fn gauge(group: &str, name: &str, value: f32, unit: &str, limit: Option<f32>) -> Gauge {
    Gauge {
        group: group.to_owned(),
        name: name.to_owned(),
        value: milli(value),
        unit: unit.to_owned(),
        limit,
    }
}

/// All gauges except those that the loop itself measures.
pub(super) fn of_hosts(hosts: &[&Host], now: Instant, vision: f32) -> Vec<Gauge> {
    let mut out = vec![gauge("vision", "packets a second", vision, "/s", Some(-VISION_RATE))];
    if let Some(host) = hosts.first() {
        let seen = host.world().robots().map(|robot| robot.seen).max();
        let age = seen.map_or(0.0, |seen| now.since(seen).0 as f32 * 1e-3);
        out.push(gauge("vision", "age of the newest image", age, "ms", Some(VISION_AGE_MS)));
        out.push(gauge("vision", "camera to host", host.tracker().delay().0 as f32 * 1e-3, "ms", None));
        let lost = host.undecodable();
        out.push(gauge("vision", "undecodable", (lost.vision + lost.referee) as f32, "", Some(0.5)));
    }
    for host in hosts {
        learned(&mut out, host);
        strategy(&mut out, host);
        let group = format!("radio, {}", host.settings().us.label());
        let links: Vec<_> =
            RobotId::all().filter_map(|id| host.quality(id)).filter(|link| link.is_present(now)).collect();
        if links.is_empty() {
            continue;
        }
        let worst = |of: &dyn Fn(&host::radio::Quality) -> Option<f64>| {
            links.iter().filter_map(|link| of(link)).fold(0.0_f64, f64::max) as f32
        };
        out.push(gauge(&group, "robots received", links.len() as f32, "", None));
        out.push(gauge(
            &group,
            "worst round trip",
            worst(&|link| link.round_trip().mean()),
            "ms",
            Some(TRIP_MS),
        ));
        out.push(gauge(
            &group,
            "worst loss to robots",
            worst(&|link| link.loss_down()),
            "%",
            Some(LOSS_MAX_PERCENT),
        ));
        out.push(gauge(
            &group,
            "worst loss from robots",
            worst(&|link| link.loss_up()),
            "%",
            Some(LOSS_MAX_PERCENT),
        ));
        let refused: u32 = host.radio().refused().iter().sum();
        out.push(gauge(&group, "refused frames", refused as f32, "", None));
        let lowest = links.iter().filter_map(|link| link.battery()).fold(f32::INFINITY, f32::min);
        if lowest.is_finite() {
            out.push(gauge(&group, "lowest battery", lowest, "V", None));
        }
    }
    out
}

fn strategy(out: &mut Vec<Gauge>, host: &Host) {
    let Some((_, drawing)) = host.strategy_drawing() else { return };
    let group = format!("strategy, {}", host.settings().us.label());
    out.push(gauge(&group, "refused answers", host.refused_answers().0 as f32, "", Some(0.5)));
    out.extend(drawing.values.iter().map(|(name, value)| gauge(&group, name, *value, "", None)));
}

/// Learned values of robots and field.
fn learned(out: &mut Vec<Gauge>, host: &Host) {
    let (known, us) = (host.learned(), host.settings().us.label());
    let group = format!("learned, {us}");
    for id in RobotId::all() {
        if let Some(gain) = known.kick(id) {
            out.push(gauge(&group, &format!("kick of robot {id} over order"), gain.value, "×", None));
        }
        if let Some(latency) = known.latency(id) {
            let name = format!("robot {id}, order to motion");
            out.push(gauge(&group, &name, latency.value * 1e3, "ms", None));
        }
    }
    if let Some(roll) = known.friction() {
        out.push(gauge(&group, "rolling ball slows by", roll.value, "m/s²", None));
    }
}

/// Computing time of a tick.
pub fn tick(took: Duration) -> Gauge {
    gauge("program", "a tick takes", took.as_secs_f32() * 1e3, "ms", Some(TICK_MS))
}
