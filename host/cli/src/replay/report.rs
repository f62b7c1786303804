//! `report`: statistics of a league log file. Counts of everything, as text and as JSON. Times: s since the
//! start.

use std::collections::{BTreeMap, BTreeSet};

use feed::recording::{ClockStep, Rate, RefereeEvent, Score, Sheet};
use foreign::printable;
use host::referee::RefereeCounts;
use host::tracking::TrackingCounts;
use serde::Serialize;
use ssl::log::MessageKind;
use ssl::vision::WrapperPacket;

/// A league log file in numbers.
#[derive(Debug, Default, Serialize)]
pub(super) struct Report {
    pub(super) kind: &'static str,
    pub(super) file: String,
    /// From the first to the last message.
    pub(super) span_s: f64,
    /// The first message, Unix time.
    pub(super) began_unix_s: f64,
    pub(super) messages: BTreeMap<String, OfKind>,
    pub(super) undecodable: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) first_undecodable: Option<String>,
    /// The damage, if the file did not end properly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) damage: Option<String>,
    /// Messages that are earlier than the one before.
    pub(super) back_steps: u64,
    /// Times at which the recorder's clock was set, or nothing at all was recorded.
    pub(super) clock_steps: Vec<ClockStep>,
    /// Steps beyond those that are listed.
    pub(super) clock_steps_more: u64,
    /// Number of files joined to the first one, and the time at which the first of them begins.
    pub(super) joined: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) joined_at_s: Option<f64>,
    /// Fields that vision sent after another one, and when.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) other_fields: Vec<OtherField>,
    /// Messages that were counted and could not be used, by reason.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) unused: Vec<String>,
    /// Last state of field and teams.
    #[serde(flatten)]
    pub(super) sheet: Sheet,
    pub(super) cameras: BTreeMap<u32, Camera>,
    pub(super) robots: Robots,
    /// The highest ball speed of the tracker, m/s.
    pub(super) ball_speed_max: f32,
    pub(super) score: Score,
    #[serde(rename = "events")]
    pub(super) match_events: Vec<RefereeEvent>,
    pub(super) gaps: Vec<Gap>,
    /// Gaps beyond those that are listed.
    pub(super) gaps_more: u64,
    pub(super) tracker: Tracker,
    pub(super) referee: RefereeCounts,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) host: Option<Host>,
}

/// A field of other measures than the one before.
#[derive(Debug, Serialize)]
pub(super) struct OtherField {
    pub(super) at_s: f64,
    /// The one before, as text.
    pub(super) before: String,
}

#[derive(Debug, Default, Serialize)]
pub(super) struct OfKind {
    pub(super) messages: u64,
    pub(super) bytes: u64,
    pub(super) undecodable: u64,
    /// While it came: pauses of more than 2 s and steps of the recorder's clock are left out.
    pub(super) rate_hz: f64,
    #[serde(skip)]
    pub(super) rate: Rate,
}

#[derive(Debug, Default, Serialize)]
pub(super) struct Camera {
    pub(super) images: u64,
    pub(super) rate_hz: f64,
    #[serde(skip)]
    pub(super) rate: Rate,
}

/// Shell numbers of the tracker's robots.
#[derive(Debug, Default, Serialize)]
pub(super) struct Robots {
    pub(super) blue: BTreeSet<u8>,
    pub(super) yellow: BTreeSet<u8>,
}

/// A time without messages.
#[derive(Debug, Serialize)]
pub(super) struct Gap {
    pub(super) at_s: f64,
    pub(super) of: String,
    pub(super) for_s: f64,
}

/// Counts of camera frames by what the tracker did with them.
#[derive(Debug, Default, Serialize)]
pub(super) struct Tracker {
    images: u64,
    #[serde(flatten)]
    counts: TrackingCounts,
}

/// Output of a host for the log file.
#[derive(Debug, Default, Serialize)]
pub(super) struct Host {
    pub(super) colour: String,
    pub(super) inputs: u64,
    pub(super) packets: u64,
    pub(super) bytes: u64,
    /// Hash over all packets, to compare two runs.
    pub(super) packets_hash: String,
}

/// Number of changes of the field that are listed.
const FIELDS_LISTED: usize = 20;
/// Number of gaps that are listed; beyond it they are only counted.
const GAPS_LISTED: usize = 20;

impl Report {
    pub(super) fn gap(&mut self, gap: Gap) {
        if self.gaps.len() < GAPS_LISTED { self.gaps.push(gap) } else { self.gaps_more += 1 }
    }

    /// The field of a packet of vision.
    pub(super) fn field(&mut self, packet: &WrapperPacket, at_s: f64) {
        let before = self.sheet.field;
        self.sheet.vision(packet);
        if let Some(before) = before.filter(|before| self.sheet.field != Some(*before))
            && self.other_fields.len() < FIELDS_LISTED
        {
            let before = format!("{:.3} x {:.3} m", before.length, before.width);
            self.other_fields.push(OtherField { at_s, before });
        }
    }

    /// Notes what was counted and not used; after [`take`](Self::take).
    pub(super) fn note_unused(&mut self, geometry_refused: u64) {
        let images: u64 = self.cameras.values().map(|camera| camera.images).sum();
        let (tracker, referee) = (&self.tracker.counts, &self.referee);
        let tracked = tracker.newest + tracker.reordered + tracker.restarts;
        let heard = referee.taken + referee.old + referee.copies;
        let told = self.messages.get(&MessageKind::Refbox2013.to_string()).map_or(0, |kind| kind.messages);
        let unused = [
            (self.undecodable > 0).then(|| format!("{} messages cannot be decoded", self.undecodable)),
            (images > 0 && tracked == 0).then(|| format!("none of {images} camera frames could be tracked")),
            (geometry_refused > 0).then(|| format!("{geometry_refused} geometries are of no field")),
            (told > 0 && heard == 0).then(|| format!("none of {told} referee messages could be obeyed")),
        ];
        self.unused.extend(unused.into_iter().flatten());
    }

    pub(super) fn take(&mut self, tracker: &TrackingCounts, referee: RefereeCounts) {
        self.tracker = Tracker { images: tracker.images(), counts: *tracker };
        self.referee = referee;
    }

    pub(super) fn text(&self) -> String {
        let mut lines = vec![format!("{}: a league log file of {:.1} s", printable(&self.file), self.span_s)];
        for (name, messages) in &self.messages {
            let bad = if messages.undecodable > 0 {
                format!(", {} undecodable", messages.undecodable)
            } else {
                String::new()
            };
            lines.push(format!("  {:>7} {name}, {:.1} a second{bad}", messages.messages, messages.rate_hz));
        }
        if let Some(first) = &self.first_undecodable {
            lines.push(format!("  the first undecodable one: {first}"));
        }
        if self.back_steps > 0 {
            lines.push(format!("  {} messages are earlier than the one before them", self.back_steps));
        }
        for step in &self.clock_steps {
            let ClockStep { at_s, by_s, played_s } = step;
            lines.push(if *by_s > *played_s && *by_s > 0.0 {
                format!("  the recorder's clock was set forward by {:.3} s at {at_s:.2} s", by_s - played_s)
            } else if *by_s < 0.0 {
                format!("  the recorder's clock was set back by {:.3} s at {at_s:.2} s", -by_s)
            } else {
                format!("  nothing at all for {by_s:.3} s from {at_s:.2} s on: a pause, or the recorder's clock was set forward")
            });
        }
        if let Some(at_s) = self.joined_at_s {
            let more = if self.joined > 1 {
                format!(", and {} more after it", self.joined - 1)
            } else {
                String::new()
            };
            lines.push(format!("  a second log begins in the file, at {at_s:.2} s{more}"));
        }
        if self.clock_steps_more > 0 {
            lines.push(format!("  and {} such steps more", self.clock_steps_more));
        }
        for OtherField { at_s, before } in &self.other_fields {
            lines.push(format!("the field was another one, {before}, until {at_s:.2} s"));
        }
        lines.extend(self.sheet.text());
        for (id, camera) in &self.cameras {
            lines.push(format!("camera {id}: {} images, {:.1} a second", camera.images, camera.rate_hz));
        }
        let numbers = |ids: &BTreeSet<u8>| {
            if ids.is_empty() {
                "none".to_owned()
            } else {
                ids.iter().map(u8::to_string).collect::<Vec<_>>().join(" ")
            }
        };
        lines.push(format!(
            "robots: blue {}, yellow {}",
            numbers(&self.robots.blue),
            numbers(&self.robots.yellow)
        ));
        lines.push(format!("fastest ball: {:.2} m/s", self.ball_speed_max));
        let Tracker { images, counts: t } = &self.tracker;
        lines.push(format!(
            "tracker: {images} images, {} newest, {} put in between, {} repeated, {} late, {} of another clock, {} nonsense, {} restarts",
            t.newest, t.reordered, t.repeated, t.late, t.foreign, t.nonsense, t.restarts
        ));
        let r = &self.referee;
        lines.push(format!(
            "referee: {} packets, {} commands, {} never received, {} old, {} copies, {} of others, {} unknown",
            r.taken, r.commands, r.missed, r.old, r.copies, r.other_source, r.unknown
        ));
        if let Some(host) = &self.host {
            lines.push(format!(
                "{}'s host: {} inputs, {} packets to robots, {} bytes, hash {}",
                host.colour, host.inputs, host.packets, host.bytes, host.packets_hash
            ));
        }
        for gap in &self.gaps {
            lines.push(format!("gap: no {} for {:.2} s from {:.2} s on", gap.of, gap.for_s, gap.at_s));
        }
        if self.gaps_more > 0 {
            lines.push(format!("and {} gaps more", self.gaps_more));
        }
        let Score { blue, yellow } = self.score;
        lines.push(format!("score: blue {blue} : {yellow} yellow"));
        lines.extend(self.match_events.iter().map(RefereeEvent::line));
        for unused in &self.unused {
            lines.push(format!("not used: {unused}"));
        }
        if let Some(damage) = &self.damage {
            lines.push(format!("the file is damaged: {}", printable(damage)));
        }
        lines.join("\n") + "\n"
    }
}
