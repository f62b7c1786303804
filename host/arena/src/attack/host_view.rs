//! `host_view`: the ball and the robots as a host sees them, for recordings and real fields: kicks as its
//! tracking fits them; a robot touches the ball that comes to within [`TOUCHES_WITHIN`] of its centre.

use geometry::{Field, Point};
use host::Host;
use host::world::{Kick, World};
use protocol::Who;
use rules::contact::TOUCHES_WITHIN;
use rules::limits::ROBOT_HEIGHT;
use rules::{Colour, FieldSpec};

use super::{BallContact, BallLook};

/// Looks at a match through a host. Times are on the host's clock, s.
#[derive(Clone, Debug, Default)]
pub struct HostView {
    field: Option<FieldSpec>,
    kick: Option<Followed>,
    ball: Option<(Point<Field>, f32)>,
    robots: Vec<(Who, Point<Field>)>,
    /// Robots at the ball at the moment before.
    at_ball: Vec<Who>,
    contacts: Vec<BallContact>,
}

/// A kick that the tracker refits as it sees more of it.
#[derive(Clone, Copy, Debug)]
struct Followed {
    kick: Kick,
    by: Who,
    /// It was passed on.
    settled: bool,
}

impl Followed {
    /// Whether it is the tracker's newer fit of a kick that is known.
    fn is_same_kick(&self, known: &Self) -> bool {
        self.by == known.by && self.kick.at.since(known.kick.at).0 < SAME_KICK_US
    }
}

impl HostView {
    /// View of `host` at `now`; `None` before it has seen a ball.
    pub fn look(&mut self, host: &Host, now: f64) -> Option<BallLook<'_>> {
        let (world, game) = (host.world(), host.game());
        self.robots.clear();
        self.robots.extend(world.robots().map(|robot| (robot.who, robot.pose.position)));
        self.contacts.clear();
        self.follow_kick(world);
        self.find_touches(world, now);
        let (ball, height) = self.ball?;
        let settings = host.settings();
        let own_ends = Colour::ALL.map(|team| {
            let assumed =
                if team == settings.us { settings.defending } else { settings.defending.opposite() };
            game.own_goal(team).unwrap_or(assumed)
        });
        Some(BallLook {
            now,
            field: self.field.insert(host.field()),
            ball,
            height,
            robots: &self.robots,
            phase: game.phase,
            score: Colour::ALL.map(|team| game.team(team).score),
            own_ends,
            contacts: &self.contacts,
        })
    }

    /// A kick counts as it is fitted [`FITTED_AFTER_US`] after it, or before the ball's motion is due to
    /// something else.
    fn follow_kick(&mut self, world: &World) {
        let newest = world.ball.as_ref().and_then(|ball| ball.kicked);
        let newest = newest.and_then(|kick| Some(Followed { kick, by: kick.by?, settled: false }));
        match (&mut self.kick, newest) {
            (Some(known), Some(new)) if new.is_same_kick(known) => known.kick = new.kick,
            _ => {
                self.settle();
                self.kick = newest;
            }
        }
        if self.kick.is_some_and(|known| world.time.since(known.kick.at).0 >= FITTED_AFTER_US) {
            self.settle();
        }
    }

    /// Passes the kick on as it is fitted now.
    fn settle(&mut self) {
        if let Some(Followed { kick, by, settled }) = &mut self.kick
            && !std::mem::replace(settled, true)
        {
            let (at, from, velocity) = (kick.at.0 as f64 * 1e-6, kick.from, kick.velocity);
            self.contacts.push(BallContact::Kicked { by: *by, at, from, velocity });
        }
    }

    fn find_touches(&mut self, world: &World, now: f64) {
        let Some(ball) = &world.ball else { return };
        // The referee stops play as the ball crosses a line; the newest camera frame shows it before.
        let ahead = (now - world.time.0 as f64 * 1e-6).clamp(0.0, AHEAD_MAX_S);
        self.ball = Some((ball.after(ahead as f32, &world.models).position, ball.height));
        let low = ball.height < ROBOT_HEIGHT;
        let near = |at: Point<Field>| low && at.distance(ball.position) < TOUCHES_WITHIN;
        let at_ball = self.robots.iter().filter(|(_, at)| near(*at)).map(|(who, _)| *who);
        let at_ball: Vec<Who> = at_ball.collect();
        for by in at_ball.iter().copied().filter(|who| !self.at_ball.contains(who)).collect::<Vec<_>>() {
            if self.kick.is_some_and(|known| known.by != by) {
                self.settle();
            }
            self.contacts.push(BallContact::Touched { by, at: ball.position });
        }
        self.at_ball = at_ball;
    }
}

/// A kick of the same robot within this time of the one before is the same, µs.
const SAME_KICK_US: u64 = 200_000;
/// A kick's speed is known after this time, µs: some six camera frames.
const FITTED_AFTER_US: u64 = 100_000;
/// A world is at most this old, s; an older one is of a camera that sends nothing.
const AHEAD_MAX_S: f64 = 0.2;
