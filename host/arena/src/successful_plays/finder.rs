//! `finder`: plays of a match of the Small Size League that led to a shot or a goal. Passes, shots and
//! possessions are those of [`AttackWatch`], of the match as a host sees it ([`HostView`]). s, m, field
//! frame.

use std::collections::VecDeque;

use geometry::{Field, GoalEnd, Point, Vector};
use host::Host;
use protocol::Who;
use rules::{Colour, FieldSpec};

use super::{HOLDINGS_MAX, Holding, PlayEnd, ROBOTS_MAX, SuccessfulPlay, seen};
use crate::attack::{AttackWatch, BallContact, BallEvent, BallLook, HostView};

/// Follows a match and keeps the successful plays of both teams.
#[derive(Clone, Debug, Default)]
pub struct PlayFinder {
    view: HostView,
    follower: Follower,
}

impl PlayFinder {
    /// Takes a moment as `host` sees it, s on its clock.
    pub fn look(&mut self, host: &Host, now: f64) {
        if let Some(look) = self.view.look(host, now) {
            self.follower.look(&look);
        }
    }

    /// The plays found, in the order of their shots.
    pub fn finish(self) -> Vec<SuccessfulPlay> {
        self.follower.found.into_iter().map(|found| found.play).collect()
    }
}

/// The same for moments from anywhere.
#[derive(Clone, Debug, Default)]
pub(super) struct Follower {
    attack: AttackWatch,
    scenes: VecDeque<Scene>,
    /// The robot that touched the ball last, and since when it alone did.
    owner: Option<(Who, f64)>,
    /// The last kicks of all robots.
    kicks: VecDeque<Kick>,
    /// Passes in a row that arrived, by team.
    chains: [Vec<Pass>; 2],
    /// The last kick of a team that was neither a shot nor a pass that arrived, with the passes before it.
    missed: [Option<(Vec<Pass>, Kick)>; 2],
    pub(super) found: Vec<Found>,
}

#[derive(Clone, Debug)]
struct Scene {
    at: f64,
    ball: Point<Field>,
    robots: Vec<(Who, Point<Field>)>,
}

#[derive(Clone, Copy, Debug)]
struct Kick {
    by: Who,
    at: f64,
    from: Point<Field>,
    velocity: Vector<Field>,
    /// Since when the robot had the ball before.
    had: f64,
}

#[derive(Clone, Copy, Debug)]
struct Pass {
    kick: Kick,
    receiver: Who,
    received: f64,
    reception: Point<Field>,
}

#[derive(Clone, Debug)]
pub(super) struct Found {
    team: Colour,
    at: f64,
    pub(super) play: SuccessfulPlay,
}

impl Follower {
    pub(super) fn look(&mut self, look: &BallLook<'_>) {
        self.attack.look(look);
        self.scenes.push_back(Scene { at: look.now, ball: look.ball, robots: look.robots.to_vec() });
        while self.scenes.front().is_some_and(|scene| look.now - scene.at > KEPT_S) {
            self.scenes.pop_front();
        }
        for contact in look.contacts {
            self.touch(look.now, contact);
        }
        for event in self.attack.events().to_vec() {
            self.follow(look, &event);
        }
    }

    fn touch(&mut self, now: f64, contact: &BallContact) {
        let (by, at) = match *contact {
            BallContact::Kicked { by, at, .. } => (by, at),
            BallContact::Touched { by, .. } => (by, now),
        };
        let since = self.owner.filter(|(who, _)| *who == by).map_or(at, |(_, since)| since);
        self.owner = Some((by, since));
        if let BallContact::Kicked { by, at, from, velocity } = *contact {
            self.kicks.push_back(Kick { by, at, from, velocity, had: since });
            if self.kicks.len() > KICKS_KEPT {
                self.kicks.pop_front();
            }
        }
    }

    fn follow(&mut self, look: &BallLook<'_>, event: &BallEvent) {
        match *event {
            BallEvent::Kick { by, at, arrived } => {
                let kick = self.kicks.iter().rev().find(|kick| kick.by == by && kick.at == at).copied();
                let chain = &mut self.chains[by.colour as usize];
                let Some(kick) = kick else { return chain.clear() };
                if !leads_to(chain, &kick) {
                    chain.clear();
                }
                let mut contacts = look.contacts.iter().map(robot_and_place);
                let teammate = contacts.find(|(who, _)| who.colour == by.colour && *who != by);
                match teammate.filter(|_| arrived) {
                    Some((receiver, reception)) => {
                        chain.push(Pass { kick, receiver, received: look.now, reception });
                    }
                    None => self.missed[by.colour as usize] = Some((std::mem::take(chain), kick)),
                }
            }
            BallEvent::Shot { by } => {
                let kick = self.kicks.iter().rev().find(|kick| kick.by == by).copied();
                let chain = std::mem::take(&mut self.chains[by.colour as usize]);
                if let Some(kick) = kick {
                    self.add(look, chain, &kick, false);
                }
            }
            BallEvent::Goal { team } => self.scored(look, team),
            BallEvent::Lost { team, .. } => self.chains[team as usize].clear(),
            BallEvent::Stopped | BallEvent::Resumed => {
                self.chains.iter_mut().for_each(Vec::clear);
                self.owner = None;
            }
        }
    }

    /// The goal is the last shot's, or that of a slower kick.
    fn scored(&mut self, look: &BallLook<'_>, team: Colour) {
        let recent = |at: f64| look.now - at < GOAL_WITHIN_S;
        let missed = self.missed[team as usize].take().filter(|(_, kick)| recent(kick.at));
        let shot = self.found.iter_mut().rev().find(|found| found.team == team && recent(found.at));
        match (shot, missed) {
            (Some(shot), missed) if missed.as_ref().is_none_or(|(_, kick)| kick.at < shot.at) => {
                shot.play.goal = true;
            }
            (_, Some((chain, kick))) => self.add(look, chain, &kick, true),
            _ => {}
        }
    }

    fn add(&mut self, look: &BallLook<'_>, chain: Vec<Pass>, kick: &Kick, goal: bool) {
        let chain = if leads_to(&chain, kick) { chain } else { Vec::new() };
        if let Some(play) = self.play(look, &chain, kick, goal)
            && play.is_sane()
        {
            self.found.push(Found { team: kick.by.colour, at: kick.at, play });
        }
    }

    fn play(&self, look: &BallLook<'_>, chain: &[Pass], shot: &Kick, goal: bool) -> Option<SuccessfulPlay> {
        let passes = &chain[chain.len().saturating_sub(HOLDINGS_MAX - 1)..];
        let kicks = || passes.iter().map(|pass| pass.kick).chain([*shot]);
        let scene = self.beginning(&kicks().collect::<Vec<_>>())?;
        let team = shot.by.colour;
        let sign = look.own_ends[team as usize].opposite().sign() as f32;
        let places = [scene.ball].into_iter().chain(passes.iter().map(|pass| pass.reception));
        let of = |own: bool| {
            let robots = scene.robots.iter().filter(move |(who, _)| (who.colour == team) == own);
            robots.map(|(who, at)| (who.id.number(), seen(*at, sign))).take(ROBOTS_MAX)
        };
        let holdings = kicks().zip(places).map(|(kick, got)| Holding {
            robot: kick.by.id.number(),
            got: seen(got, sign),
            left: seen(kick.from, sign),
        });
        Some(SuccessfulPlay {
            field: size(look.field),
            teammates: of(true).collect(),
            opponents: of(false).map(|(_, at)| at).collect(),
            holdings: holdings.collect(),
            end: PlayEnd::Shot(crossing(look.field, look.own_ends[team as usize], shot)),
            goal,
        })
    }

    /// The earliest moment at which the first robot had the ball, did not carry it too far from there, and
    /// all robots that had it later were seen.
    fn beginning(&self, kicks: &[Kick]) -> Option<&Scene> {
        let first = kicks.first()?;
        let had = first.had.max(first.at - CARRIES_FOR_S) - TICK_S;
        let seen =
            |scene: &&Scene| kicks.iter().all(|kick| scene.robots.iter().any(|(who, _)| *who == kick.by));
        let mut before = self.scenes.iter().rev().filter(|scene| scene.at <= first.at).filter(seen);
        // A ball that was kicked as it came begins at the kick.
        let latest = before.next()?;
        let held = |scene: &&Scene| scene.at >= had && scene.ball.distance(first.from) < CARRIES_WITHIN_M;
        Some(before.take_while(held).last().unwrap_or(latest))
    }
}

/// Whether the receiver of the last pass is the robot that kicks, in time.
fn leads_to(chain: &[Pass], kick: &Kick) -> bool {
    chain.last().is_some_and(|pass| {
        pass.receiver == kick.by && (-KICK_LATE_S..HOLDS_FOR_S).contains(&(kick.at - pass.received))
    })
}

fn robot_and_place(contact: &BallContact) -> (Who, Point<Field>) {
    match *contact {
        BallContact::Kicked { by, from, .. } => (by, from),
        BallContact::Touched { by, at } => (by, at),
    }
}

/// Place where the kick's line crosses the goal line that its team attacks, mm, seen in attack towards +x.
fn crossing(field: &FieldSpec, own: GoalEnd, kick: &Kick) -> i32 {
    let sign = own.opposite().sign() as f32;
    let (x, y) = (kick.from.x() * sign, kick.from.y() * sign);
    let (forward, aside) = (kick.velocity.x() * sign, kick.velocity.y() * sign);
    if forward <= 0.0 {
        return 0;
    }
    let half = 0.5 * field.width;
    ((y + aside * (0.5 * field.length - x) / forward).clamp(-half, half) * 1000.0).round() as i32
}

fn size(field: &FieldSpec) -> [i32; 2] {
    [field.length, field.width].map(|m| (m * 1000.0).round() as i32)
}

/// Scenes are kept for this time, s: three passes and what was carried between them.
const KEPT_S: f64 = 20.0;
const KICKS_KEPT: usize = 16;
/// A goal within this time of a kick is that kick's, s: the referee takes some seconds to give it.
const GOAL_WITHIN_S: f64 = 10.0;
/// A receiver that has the ball for longer plays on from there: another play, s.
const HOLDS_FOR_S: f64 = 5.0;
/// A kick is known so much later than it was made, s; a volley may so be older than its reception.
const KICK_LATE_S: f64 = 0.3;
/// The first robot's part of a play begins at most this long before its kick, s, …
const CARRIES_FOR_S: f64 = 3.0;
/// … and this far from it, m: rules of the Small Size League let a robot carry the ball for a metre.
const CARRIES_WITHIN_M: f32 = 0.9;
/// Moments of a match are this far apart, s.
const TICK_S: f64 = 0.02;
