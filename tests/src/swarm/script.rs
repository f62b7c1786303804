//! A host whose strategy is a script: the phase of the game and each robot's directive, drawn in advance; the
//! radio is the host's own.

use geometry::{GoalEnd, Point};
use hil_sim::Stream;
use hil_sim::small_size::World;
use host::radio::{Radio, RadioSettings, RadioSituation, To};
use host::world::{Ball, BallModels, Robot};
use protocol::host::{Directive, HostCommand, KickOrder, RuleRole};
use protocol::link::Packet;
use protocol::quantized::{WirePoint, WirePose};
use protocol::{Instant, RobotId, Who};
use rules::{Colour, Phase, Side};

use super::plan::{Plan, Span};

/// A host's messages by time: the part of the present span, or else `Gameplay` in a running game.
#[derive(Clone, Debug, Default)]
pub(super) struct Script {
    parts: Vec<(Span, Phase<Side>, [Directive; 4])>,
}

impl Script {
    /// A running game of free robots.
    pub(super) fn free_play() -> Self {
        Self::default()
    }

    /// The script of that plan: random parts during the trouble, a running game before and after.
    pub(super) fn drawn(plan: &Plan) -> Self {
        Self::within(plan.trouble, &mut Stream::new(plan.seed, "swarm script"))
    }

    pub(super) fn drawn_for_second(plan: &Plan) -> Self {
        Self::within(plan.trouble, &mut Stream::new(plan.seed, "swarm second script"))
    }

    fn within(trouble: Span, chance: &mut Stream) -> Self {
        let mut parts = Vec::new();
        let mut from = trouble.from;
        while from < trouble.to {
            let to = (from + chance.whole(200, 1_500)).min(trouble.to);
            // Half of the time the game runs.
            let phase = if chance.chance(0.5) { Phase::Run } else { phase(chance) };
            parts.push((Span { from, to }, phase, std::array::from_fn(|_| directive(chance))));
            from = to;
        }
        Self { parts }
    }

    fn at(&self, ms: u32, place: usize) -> (Phase<Side>, Directive) {
        let part = self.parts.iter().find(|(span, ..)| span.has(ms));
        part.map_or((Phase::Run, Directive::Gameplay { hint: None }), |(_, phase, directives)| {
            (*phase, directives[place % directives.len()].clone())
        })
    }
}

pub(super) struct Headquarters {
    radio: Radio,
    us: Colour,
    defending: GoalEnd,
    script: Script,
}

impl Headquarters {
    pub(super) fn new(settings: RadioSettings, us: Colour, defending: GoalEnd, script: Script) -> Self {
        Self { radio: Radio::new(settings), us, defending, script }
    }

    /// Takes packets of robots and of another host.
    pub(super) fn receive(&mut self, now: Instant, packets: &[Packet]) {
        for packet in packets {
            // Refused packets are counted by the radio.
            let _ = self.radio.handle_packet(now, packet);
        }
    }

    /// Gives the radio the field and the script's command of this moment.
    pub(super) fn lead(&mut self, now: Instant, ms: u32, plan: &Plan, ids: &[RobotId], truth: &World) {
        let phase = self.script.at(ms, 0).0;
        let commands: Vec<HostCommand> = (ids.iter().enumerate())
            .map(|(i, to)| HostCommand {
                to: *to,
                defending: self.defending,
                phase,
                rule_role: if i == 0 && phase != Phase::Run { RuleRole::Kicker } else { RuleRole::Player },
                directive: self.script.at(ms, i).1,
            })
            .collect();
        let placement = matches!(phase, Phase::BallPlacement(_)).then(|| Point::new(0.0, 1.0));
        let situation = RadioSituation { us: self.us, phase, placement };
        debug_assert_eq!(plan.brains.len(), ids.len());
        self.radio.offer(now, &seen(now, truth), situation, &commands);
    }

    pub(super) fn speak(&mut self, mut send: impl FnMut(Option<RobotId>, &Packet)) {
        while let Some((to, packet)) = self.radio.poll_packet() {
            match to {
                To::All => send(None, &packet),
                To::One(robot) => send(Some(robot), &packet),
            }
        }
    }
}

/// The true state as a host's world model.
fn seen(now: Instant, truth: &World) -> host::world::World {
    let mut world = host::world::World::empty(now, BallModels::default());
    let ball = &truth.ball;
    world.ball = Some(Ball {
        height: ball.height,
        velocity: ball.velocity,
        climb: ball.climb,
        ..Ball::at_rest(ball.position, now)
    });
    for robot in truth.robots().iter().filter(|robot| robot.present) {
        world.put(Robot {
            who: Who { colour: robot.who.colour, id: robot.who.id },
            pose: robot.pose,
            velocity: robot.velocity,
            angular: robot.turning,
            confidence: 1.0,
            seen: now,
        });
    }
    world
}

fn phase(chance: &mut Stream) -> Phase<Side> {
    let side = if chance.chance(0.5) { Side::Ours } else { Side::Theirs };
    match chance.whole(0, 9) {
        0 | 1 => Phase::Halt,
        2 | 3 => Phase::Stop,
        4 => Phase::Timeout(side),
        5 => Phase::BallPlacement(side),
        6 => Phase::PrepareKickoff(side),
        7 => Phase::Kickoff(side),
        8 => Phase::PreparePenalty(side),
        _ => Phase::FreeKick(side),
    }
}

fn directive(chance: &mut Stream) -> Directive {
    let mut point = |far: f32| -> WirePoint {
        Point::<geometry::Field>::new(chance.between(-4.0, 4.0) * far, chance.between(-2.5, 2.5) * far).into()
    };
    let (a, b) = (point(1.0), point(0.5));
    let kick = KickOrder::Flat(chance.whole(100, 700) as u16);
    match chance.whole(0, 11) {
        0 => Directive::Stand,
        1 | 2 => Directive::GoTo { pose: WirePose { at: a, heading: 0 } },
        3 => Directive::GetBall { face: None },
        4 => Directive::Kick { at: a, kick },
        5 => Directive::Receive { at: b, then: Some(a) },
        6 => Directive::Block { from: a, to: b },
        _ => Directive::Gameplay { hint: None },
    }
}
