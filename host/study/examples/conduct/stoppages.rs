//! `stoppages`: what stopped the play of a match, and how long each part of each stoppage took: halt, stop,
//! placement, preparation, awaited kick. By the referee's phases and its count of the time in play. s, m.

use std::collections::BTreeMap;
use std::fmt::Write;

use arena::game::Game;
use hil_sim::small_size::PhysicsEvent;
use hil_sim::small_size::referee::{Kind, RefereeEvent};
use protocol::Who;

use super::name;

/// A time out of play.
#[derive(Clone, Debug)]
pub(super) struct Stoppage {
    /// The event that stopped the game; `start` at the start of a half.
    pub(super) cause: &'static str,
    pub(super) from_s: f64,
    pub(super) parts: BTreeMap<&'static str, f64>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Stoppages {
    in_play_s: f32,
    match_s: f32,
    seen: usize,
    open: Option<Stoppage>,
    stopped_by: Option<Kind>,
    /// Touches of the ball, the last one last.
    touches: Vec<Touch>,
    pub(super) all: Vec<Stoppage>,
    /// How the ball was played that then went out of play, by the cause.
    pub(super) played: Vec<(&'static str, String)>,
    /// Each event with its situation, a line each.
    pub(super) story: Vec<String>,
}

/// One touch of the ball, and the order of its robot.
#[derive(Clone, Debug)]
struct Touch {
    at_s: f64,
    who: Who,
    /// Speed of the kick, m/s, and whether it is a chip; none: a touch without a kick.
    kick: Option<(f32, bool)>,
    order: String,
}

impl Stoppages {
    pub(super) fn look(&mut self, game: &Game<'_>) {
        for event in game.events() {
            let (who, kick) = match *event {
                PhysicsEvent::Kicked { robot, speed, chip, .. } => (robot, Some((speed, chip))),
                PhysicsEvent::Touched { robot, .. } => (robot, None),
                _ => continue,
            };
            let order = order_of(game, who);
            self.touches.push(Touch { at_s: game.time(), who, kick, order });
        }
        let events = game.referee().events();
        let new = &events[self.seen..];
        self.seen = events.len();
        for event in new {
            self.tell(game, event);
        }
        let metrics = game.referee().metrics();
        let (playing, passed_s) = (metrics.in_play_s > self.in_play_s, metrics.match_s - self.match_s);
        (self.in_play_s, self.match_s) = (metrics.in_play_s, metrics.match_s);
        let stops = |event: &&RefereeEvent| {
            let kind = event.what.kind();
            kind.stops_the_game() || kind == Kind::PossibleGoal
        };
        let cause = new.iter().find(stops).map(|event| event.what.kind());
        let now = game.time();
        if let Some(cause) = cause.filter(|_| self.open.is_none()) {
            self.stopped_by = Some(cause);
            let touches = self.touches.iter().rev();
            let last: Vec<&Touch> = touches.take_while(|touch| now - touch.at_s < 6.0).take(8).collect();
            self.played.push((cause.label(), way_out(&last)));
        }
        if playing || game.referee().stage().is_break() {
            self.all.extend(self.open.take());
            return;
        }
        // The referee looks less often than the match ticks.
        if passed_s <= 0.0 && new.is_empty() {
            return;
        }
        let open = self.open.get_or_insert_with(|| {
            let cause = self.stopped_by.take().map_or("start", Kind::label);
            Stoppage { cause, from_s: now, parts: BTreeMap::new() }
        });
        *open.parts.entry(name(game.referee().phase())).or_default() += f64::from(passed_s);
    }

    pub(super) fn end(&mut self) {
        self.all.extend(self.open.take());
    }

    fn tell(&mut self, game: &Game<'_>, event: &RefereeEvent) {
        let kind = event.what.kind();
        if !kind.is_offence() && !matches!(kind, Kind::NoProgress) && !kind.is_ball_out() {
            return;
        }
        let mut line = format!(
            "{:.2} s {:?} by {:?} {:?} at {:?}",
            game.time(),
            event.what,
            event.by,
            event.robot,
            event.place
        );
        let mut near: Vec<_> = game
            .world()
            .robots()
            .iter()
            .filter(|robot| robot.present)
            .map(|robot| (robot.pose.position.distance(event.place), robot))
            .filter(|(distance, _)| *distance < 0.6)
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (distance, robot) in near.iter().take(4) {
            let _ = write!(
                line,
                "\n        {} {}{} {distance:.2} m off at ({:.2}, {:.2}) with ({:.2}, {:.2}): {}",
                robot.who.colour.label(),
                robot.who.id,
                if robot.bystander { " (bystander)" } else { "" },
                robot.pose.position.x(),
                robot.pose.position.y(),
                robot.velocity.x(),
                robot.velocity.y(),
                order_of(game, robot.who)
            );
        }
        for touch in self.touches.iter().rev().take_while(|touch| game.time() - touch.at_s < 4.0).take(4) {
            let _ = write!(
                line,
                "\n        touched {:.2} s before by {} {} {:?}: {}",
                game.time() - touch.at_s,
                touch.who.colour.label(),
                touch.who.id,
                touch.kick,
                touch.order
            );
        }
        self.story.push(line);
    }
}

impl Stoppage {
    /// As a line: start, duration, cause, and each part.
    pub(super) fn line(&self) -> String {
        let parts: Vec<_> = self.parts.iter().map(|(part, s)| format!("{part} {s:.2}")).collect();
        let all: f64 = self.parts.values().sum();
        format!("stopped at {:.2} s for {all:.2} s, {}: {}", self.from_s, self.cause, parts.join(", "))
    }
}

/// The order that this robot's host has for it.
fn order_of(game: &Game<'_>, who: Who) -> String {
    let orders = game.host(who.colour).orders();
    let order = orders.iter().find(|order| order.robot == who.id);
    order.map_or("no order".into(), |order| {
        format!("{} {} {}", first_word(&order.role), first_word(&order.task), first_word(&order.why))
    })
}

/// The name of a value's variant.
fn first_word(value: &impl std::fmt::Debug) -> String {
    let text = format!("{value:?}");
    text.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_owned()
}

/// How the ball was played last, the newest touch first.
fn way_out(touches: &[&Touch]) -> String {
    let Some(last) = touches.first() else { return "untouched for 6 s".into() };
    let kick = touches.iter().find(|touch| touch.kick.is_some());
    let Some(kick) = kick else { return format!("touch without a kick, {}", last.order) };
    let (_, chip) = kick.kick.unwrap_or_default();
    let what = if chip { "chip" } else { "kick" };
    let deflected = if last.kick.is_some() {
        ""
    } else if last.who == kick.who {
        ", touched again"
    } else if last.who.colour == kick.who.colour {
        ", off a mate"
    } else {
        ", off an opponent"
    };
    format!("{what}{deflected}, {}", kick.order)
}

/// Prints the share of the time that each part of each kind of stoppage takes.
pub(super) fn print<'s>(matches: usize, match_s: f64, all: impl Iterator<Item = &'s Stoppages>) {
    let mut kinds = BTreeMap::<&str, (u32, BTreeMap<&str, f64>)>::new();
    let mut ways = BTreeMap::<(&str, &str), u32>::new();
    for stoppages in all {
        for stoppage in &stoppages.all {
            let (count, parts) = kinds.entry(stoppage.cause).or_default();
            *count += 1;
            for (part, seconds) in &stoppage.parts {
                *parts.entry(part).or_default() += seconds;
            }
        }
        for (cause, way) in &stoppages.played {
            *ways.entry((cause, way)).or_default() += 1;
        }
    }
    println!("stoppages: number a match, s each, share of the time; s of each part");
    for (kind, (count, parts)) in &kinds {
        let seconds: f64 = parts.values().sum();
        let each: Vec<_> =
            parts.iter().map(|(part, s)| format!("{part} {:.2}", s / f64::from(*count))).collect();
        println!(
            "  {kind}: {:.2}, {:.1} s, {:.1} %; {}",
            f64::from(*count) / matches as f64,
            seconds / f64::from(*count),
            100.0 * seconds / match_s,
            each.join(", ")
        );
    }
    println!("how the ball was played before, a match:");
    let mut ways: Vec<_> = ways.into_iter().collect();
    ways.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    for ((cause, way), count) in ways.iter().take(40) {
        println!("  {:.2} {cause}: {way}", f64::from(*count) / matches as f64);
    }
}
