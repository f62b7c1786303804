//! `glance`: our robots at a glance: for each what cameras, radio and its telemetry say of it, beside what it
//! should have. Times on the host's clock; ms, V.

use std::fmt::Write as _;

use protocol::host::Condition;
use protocol::station::PacketCounts;
use protocol::{Duration, Instant, RobotId, Who};
use serde::Serialize;

use crate::Host;
use crate::health_checks::{failed_parts, other_image};
use crate::radio::Quality;

/// A camera is listed for this time after it has seen the robot last; the last one stays.
const LISTED_FOR: Duration = Duration::millis(10_000);

/// One robot of ours at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RobotGlance {
    /// Colour of the team: `blue` or `yellow`.
    pub team: &'static str,
    /// Number on the shell.
    pub shell: u8,
    /// Radio number, with which it is commanded.
    pub radio: u8,
    /// Cameras that have detected it, and how long ago, ms; the latest first.
    pub cameras: Vec<(u32, u64)>,
    /// Since its last frame was received, ms; `None`: never.
    pub heard_ms: Option<u64>,
    /// Voltage of the battery, V; `None` where it is not measured.
    pub battery: Option<f32>,
    /// Packets that its base station sent to it; `None` without one that counts them.
    pub packets: Option<PacketCounts>,
    /// What its telemetry reports as wrong, each in two words.
    pub faults: Vec<&'static str>,
    /// Version of its firmware, and hashes of its image's sources, its `robot.toml` and its case base, as it
    /// reports them; `None`: not reported.
    pub version: Option<String>,
    /// Hash of its case base by its newest beacon, hexadecimal.
    pub case_base: Option<String>,
    /// What it should have and has not, each in a sentence with its remedy.
    pub wrong: Vec<String>,
}

/// Our robots that a camera has seen, radio has received, or the settings name; by shell number.
pub fn robots(host: &Host, now: Instant) -> Vec<RobotGlance> {
    RobotId::all().filter_map(|shell| robot(host, shell, now)).collect()
}

fn robot(host: &Host, shell: RobotId, now: Instant) -> Option<RobotGlance> {
    let (us, numbers) = (host.settings().us, host.radio().numbers());
    let mut seen: Vec<_> = host.tracker().sightings(Who { colour: us, id: shell }).collect();
    seen.sort_by_key(|(camera, at)| (std::cmp::Reverse(*at), *camera));
    let listed = seen.iter().take_while(|(_, at)| now.since(*at) < LISTED_FOR).count().max(1);
    let cameras: Vec<_> = seen.iter().take(listed).map(|(id, at)| (*id, now.since(*at).0 / 1_000)).collect();
    let quality = host.quality(shell);
    if cameras.is_empty() && quality.is_none() && numbers.given(shell).is_none() {
        return None;
    }
    let version = quality.and_then(Quality::version);
    let expected = host.settings().expected.filter(|_| quality.is_some() && version.is_none());
    let silent = expected.map(|expected| {
        format!(
            "It reports no version ({expected} is expected): just started, with a journal, or an image of before 0.2; \
             flash it with `onetwo firmware flash --board BOARD`."
        )
    });
    Some(RobotGlance {
        team: us.label(),
        shell: shell.number(),
        radio: numbers.radio(shell).number(),
        cameras,
        heard_ms: quality.and_then(|quality| quality.silence(now)).map(|silence| silence.0 / 1_000),
        packets: quality.and_then(Quality::station).map(|report| report.packets),
        battery: quality.and_then(Quality::battery),
        faults: quality.map(|quality| faults(quality, now)).unwrap_or_default(),
        version: version.map(|report| report.to_string()),
        case_base: host.beacon(shell).map(|beacon| format!("{:08x}", beacon.case_base)),
        wrong: [other_image(host, shell), failed_parts(host, shell)]
            .into_iter()
            .flatten()
            .map(|fault| fault.to_string())
            .chain(silent)
            .collect(),
    })
}

/// What a robot's newest telemetry reports as wrong, and its silence.
pub fn faults(quality: &Quality, now: Instant) -> Vec<&'static str> {
    let condition = quality.condition();
    let reported = [
        (condition.has(Condition::TIPPED), "tipped over"),
        (condition.has(Condition::BATTERY_LOW), "battery low"),
        (condition.has(Condition::LINK_LOST), "link lost"),
        (condition.has(Condition::FLOODED), "radio flooded"),
        (!quality.is_present(now), "silent"),
    ];
    reported.into_iter().filter(|(holds, _)| *holds).map(|(_, fault)| fault).collect()
}

/// The robots as a table, one line each, for a terminal.
pub fn table(robots: &[RobotGlance]) -> String {
    let mut text = String::from(
        "shell radio  seen by camera (ms ago)    heard ms  battery V  cases     version; faults",
    );
    for robot in robots {
        let cameras: Vec<String> = robot.cameras.iter().map(|(id, ms)| format!("{id} ({ms})")).collect();
        let _ = write!(
            text,
            "\n{:>5} {:>5}  {:<26}{:>8}  {:>9}  {:<8}  {}; {}",
            robot.shell,
            robot.radio,
            or_dash(Some(cameras.join(", ")).filter(|cameras| !cameras.is_empty())),
            or_dash(robot.heard_ms.map(|ms| ms.to_string())),
            or_dash(robot.battery.map(|volts| format!("{volts:.1}"))),
            or_dash(robot.case_base.clone()),
            or_dash(robot.version.clone()),
            if robot.faults.is_empty() { "none".to_owned() } else { robot.faults.join(", ") }
        );
        if let Some(packets) = robot.packets {
            let _ = write!(
                text,
                "\n             base station: {} packets, {} acknowledged, {} repeats, {} lost",
                packets.sent, packets.acknowledged, packets.repeats, packets.lost
            );
        }
        for sentence in &robot.wrong {
            let _ = write!(text, "\n             {sentence}");
        }
    }
    text
}

fn or_dash(value: Option<String>) -> String {
    value.unwrap_or_else(|| "-".to_owned())
}
