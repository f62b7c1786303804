//! `minds`: state of each robot for the page. From the last command of its host and the robot's own reports.

use std::collections::BTreeMap;

use host::Host;
use host::world::Robot;
use page::{AirCounts, Intent, LinkWindow, RobotDetail, Timer, Vitals, milli};
use protocol::host::Condition;
use protocol::station::StationReport;
use protocol::team::{Progress, Role, Status};
use protocol::{Instant, RobotId};
use rules::{Colour, RuleRole};

use super::description;
use super::layers::Played;
use super::names::Names;
use super::overlay_input::Aim;

/// Since when robots are in their states: reuse, and what they are ordered.
#[derive(Debug, Default)]
pub(super) struct Clocks {
    states: BTreeMap<(bool, u8), (String, f64)>,
    roles: BTreeMap<(bool, u8), (String, f64)>,
}

/// Seconds since the state of `who` is `description`.
fn since(of: &mut BTreeMap<(bool, u8), (String, f64)>, who: (bool, u8), description: &str, t: f64) -> f32 {
    let entry = of.entry(who).or_insert_with(|| (description.to_owned(), t));
    if entry.0 != description || t < entry.1 {
        *entry = (description.to_owned(), t);
    }
    (t - entry.1) as f32
}

/// The state of a robot of that host's team, and the position it is ordered to.
pub(super) fn detail(
    host: &Host,
    robot: &Robot,
    played: Option<&Played<'_>>,
    names: &Names,
    clocks: &mut Clocks,
    (now, t): (Instant, f64),
) -> Option<(RobotDetail, Option<Aim>)> {
    let id = robot.who.id;
    let order = host.orders().iter().find(|order| order.robot == id)?;
    let directive = order.task.directive(description::flip(host));
    let beacon = host.beacon(id);
    let part = played.and_then(|played| Some((played, played.place_of(id)?)));
    let progress = beacon.map_or(Progress::Idle, |beacon| beacon.progress);
    let bound = part.is_some() && matches!(progress, Progress::Adapt { .. } | Progress::Execute { .. });
    let in_case = part.as_ref().filter(|_| bound || matches!(progress, Progress::WaitEnd { .. }));
    let (state, step) =
        description::progress(progress, part.as_ref().map(|(played, (robot, _))| (&played.case, *robot)));
    let here = [milli(robot.pose.position.x()), milli(robot.pose.position.y())];
    let (to, ball_to) = description::aims(&directive);
    let place = part.as_ref().filter(|_| matches!(progress, Progress::Adapt { .. })).map(|(_, (_, at))| *at);
    let rule_role = match order.role {
        host::strategy::Role::Keeper => RuleRole::Keeper,
        host::strategy::Role::Kicker => RuleRole::Kicker,
        _ => RuleRole::Player,
    };
    let aim = place.or(to).map(|to| Aim { who: robot.who, to, rule_role });
    // A straight line until its path is planned.
    let path = aim.map_or_else(Vec::new, |aim| vec![here, aim.to]);
    let who = (host.settings().us == Colour::Blue, id.number());
    let role = description::role(order.role);
    let timers = vec![
        Timer { name: format!("as {role}"), seconds: since(&mut clocks.roles, who, &role, t) },
        Timer { name: format!("in {state}"), seconds: since(&mut clocks.states, who, &state, t) },
    ];
    let detail = RobotDetail {
        role,
        directive: description::directive(&directive),
        why: description::why(host, order),
        state,
        step,
        part: in_case.map_or_else(String::new, |(played, (robot, _))| {
            format!("case robot {} of {}", robot.number(), names.of(played.play.case))
        }),
        reactive: match beacon.map(|beacon| beacon.role) {
            Some(Role::Attacker) => "attacks".to_owned(),
            Some(Role::Supporter) => "backs up".to_owned(),
            Some(Role::None) | None => String::new(),
        },
        available: is_available(host, id, now),
        intent: Intent { path, ball_to },
        timers,
    };
    Some((detail, aim))
}

/// True if a robot can be given a part in a case, as far as its host knows.
pub(super) fn is_available(host: &Host, id: RobotId, now: Instant) -> bool {
    let received = host.quality(id).is_some_and(|quality| quality.is_present(now));
    received && host.beacon(id).is_some_and(|beacon| beacon.status.has(Status::AVAILABLE))
}

/// State of a robot and its link.
pub(super) fn vitals(host: &Host, robot: &Robot, now: Instant, link: LinkWindow) -> Option<Vitals> {
    let quality = host.quality(robot.who.id)?;
    let received = quality.received_at()?;
    let condition = quality.condition();
    let ms = |us: u64| milli(us as f32 * 1e-3);
    let counters = |value: Option<f64>| value.map(|value| milli(value as f32));
    Some(Vitals {
        battery: quality.battery().map(milli),
        silence_ms: Some(ms(now.since(received).0)),
        trip_ms: counters(quality.round_trip().mean()),
        loss_down: counters(quality.loss_down()),
        loss_up: counters(quality.loss_up()),
        frames: counters(quality.frame_rate().mean()),
        link,
        air: quality.station().map(|StationReport { plan, packets, .. }| AirCounts {
            channel: plan.channel,
            megabits: plan.megabits,
            sent: packets.sent,
            acknowledged: packets.acknowledged,
            repeats: packets.repeats,
            lost: packets.lost,
        }),
        telemetry_ms: quality.telemetry().map(|(at, _)| ms(now.since(*at).0)),
        governed: condition.has(Condition::GOVERNED),
        refused: quality.refused(),
        lives: quality.lives(),
        unseen_ms: ms(now.since(robot.seen).0),
        faults: host::glance::faults(quality, now).into_iter().map(str::to_owned).collect(),
        ball: condition.has(Condition::BALL_CONTACT),
        kicker: condition.has(Condition::KICKER_READY),
    })
}

/// Messages about robots that rebooted or fell silent since the last call.
#[derive(Debug, Default)]
pub(super) struct Faults {
    lives: BTreeMap<(bool, u8), u32>,
    present: BTreeMap<(bool, u8), bool>,
}

impl Faults {
    pub(super) fn look(&mut self, host: &Host, now: Instant) -> Vec<String> {
        let us = host.settings().us;
        let mut reported = Vec::new();
        for id in RobotId::all() {
            let Some(quality) = host.quality(id).filter(|quality| quality.received_at().is_some()) else {
                continue;
            };
            let who = (us == Colour::Blue, id.number());
            let name = format!("{} {}", us.label(), id.number());
            let (lives, here) = (quality.lives(), quality.is_present(now));
            if self.lives.insert(who, lives).is_some_and(|before| lives > before) {
                reported.push(format!("{name} booted again"));
            }
            match self.present.insert(who, here) {
                Some(true) if !here => reported.push(format!("{name} is silent")),
                Some(false) if here => reported.push(format!("{name} is received again")),
                _ => {}
            }
        }
        reported
    }
}
