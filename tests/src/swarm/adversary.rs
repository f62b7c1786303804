//! `adversary`: attacker on the radio. Flipped bits, replayed recordings, packets of other teams, guessed
//! keys.

use geometry::GoalEnd;
use hil_sim::Stream;
use protocol::frame::{Frame, Key, Sender};
use protocol::host::{Directive, HostCommand, HostMessage, RuleRole, Welcome};
use protocol::host_link::HostLink;
use protocol::link::{Link, Packet};
use protocol::lockstep::{AIR_IN_BYTES_MAX, AIR_IN_MAX};
use protocol::quantized::{WirePoint, WirePose};
use protocol::team::{
    BallQuality, BallReport, Beacon, CycleState, Decision, Play, Progress, Role, Status, TeamMessage,
};
use protocol::{CaseId, CycleId, Instant, RobotId, TeamId};
use rules::Phase;

use super::honest::SentPackets;
use super::plan::{FIRST_BOOT_EPOCH, Plan, TEAM};

/// An attacker on one robot's radio.
#[derive(Debug)]
pub struct Adversary {
    chance: Stream,
    me: RobotId,
    flips: f32,
    replays: f32,
    foreign: f32,
}

impl Adversary {
    /// The attacker on that robot in the run of that plan.
    pub fn new(plan: &Plan, me: RobotId) -> Self {
        let chance = Stream::new(plan.seed, &format!("swarm adversary {me}"));
        Self { chance, me, flips: plan.flips, replays: plan.replays, foreign: plan.foreign }
    }

    /// What the robot receives in a tick in which `packets` reach it; the adversary knows all packets the
    /// team ever sent.
    pub fn tamper(&mut self, packets: Vec<Packet>, sent_packets: &SentPackets) -> Vec<Packet> {
        let mut received = Vec::new();
        for mut packet in packets {
            if self.chance.chance(self.flips) && !packet.is_empty() {
                for _ in 0..=self.chance.whole(0, 2) {
                    let bit = self.chance.whole(0, packet.len() as u32 * 8 - 1);
                    packet[(bit / 8) as usize] ^= 1 << (bit % 8);
                }
            }
            received.push(packet);
        }
        while self.chance.chance(self.replays) && !sent_packets.in_order.is_empty() {
            let i = self.chance.whole(0, sent_packets.in_order.len() as u32 - 1) as usize;
            self.insert(&mut received, sent_packets.in_order[i].clone());
        }
        while self.chance.chance(self.foreign) {
            let packet = self.foreign_packet();
            self.insert(&mut received, packet);
        }
        // A tick delivers no more than this; further packets are lost.
        let mut bytes = 0;
        received.truncate(AIR_IN_MAX);
        received.retain(|packet| {
            bytes += packet.len();
            bytes <= AIR_IN_BYTES_MAX
        });
        received
    }

    fn insert(&mut self, received: &mut Vec<Packet>, packet: Packet) {
        let place = self.chance.whole(0, received.len() as u32) as usize;
        received.insert(place, packet);
    }

    /// A packet of another team, of a sender without the key, or noise.
    fn foreign_packet(&mut self) -> Packet {
        let chance = &mut self.chance;
        let key = Key(std::array::from_fn(|_| chance.whole(0, 255) as u8));
        let team = if chance.chance(0.5) { TEAM } else { TeamId(2) };
        let epoch = if chance.chance(0.5) { u32::MAX } else { chance.whole(0, 20) };
        let sender = Sender::new(chance.whole(0, 16) as u8).unwrap_or(Sender::Host);
        let mut payload = [0; 64];
        let written = match (sender, chance.chance(0.5)) {
            (Sender::Host, true) => postcard::to_slice(&go_away(self.me), &mut payload),
            (Sender::Host, false) => {
                let welcome =
                    Welcome { to: self.me, boot_epoch: FIRST_BOOT_EPOCH + chance.whole(0, 4), offset: 0 };
                postcard::to_slice(&HostMessage::Welcome(welcome), &mut payload)
            }
            (Sender::Robot(robot), _) => {
                postcard::to_slice(&TeamMessage::Beacon(boast(robot, chance)), &mut payload)
            }
        };
        let length = written.map_or(0, |bytes| bytes.len());
        let (audience, counter, payload) = (None, u32::MAX, &payload[..length]);
        let frame = Frame { team, sender, audience, epoch, counter, payload };
        frame.emit(&key).unwrap_or_default()
    }
}

/// Packets that the team sent in an earlier match, in earlier epochs: with the team's own key.
pub fn earlier_match(plan: &Plan) -> Vec<Packet> {
    let mut chance = Stream::new(plan.seed, "swarm earlier match");
    let (mut recorded, now) = (Vec::new(), Instant(0));
    for boot_epoch in 1..FIRST_BOOT_EPOCH {
        let mut host = HostLink::new(TEAM, plan.key, boot_epoch);
        // More robots than play today.
        for robot in [0, 1, 2, 3, 5, 9].into_iter().filter_map(RobotId::new) {
            recorded
                .push(host.seal(now, &HostMessage::Welcome(Welcome { to: robot, boot_epoch, offset: 0 })));
            let mut link = Link::new(TEAM, robot, plan.key.of_robot(robot), boot_epoch);
            for _ in 0..6 {
                recorded.push(link.seal(&TeamMessage::Beacon(boast(robot, &mut chance))));
                recorded.push(host.seal(now, &go_away(robot)));
            }
        }
    }
    recorded
}

/// Drive to the corner at full speed.
fn go_away(to: RobotId) -> HostMessage {
    let pose = WirePose { at: WirePoint { x: 4_000, y: 2_500 }, heading: 0 };
    HostMessage::Command(HostCommand {
        to,
        defending: GoalEnd::Negative,
        phase: Phase::Run,
        rule_role: RuleRole::Player,
        directive: Directive::GoTo { pose },
    })
}

/// A beacon of a robot at the ball, far ahead in cycles.
fn boast(robot: RobotId, chance: &mut Stream) -> Beacon {
    let at = WirePoint { x: 100, y: 100 };
    let id = CycleId { counter: chance.whole(0, 2_000), proposer: robot };
    let robots = [Some(robot), RobotId::new(3)].into_iter().flatten().collect();
    let decision = match chance.whole(0, 2) {
        0 => Decision::Undecided,
        1 => Decision::NoCase,
        _ => Decision::Play(Play { case: CaseId(chance.whole(0, 200) as u16), ball: at, robots }),
    };
    Beacon {
        pose: WirePose { at, heading: 0 },
        ball: Some(BallReport { at, distance: 0, quality: BallQuality::default() }),
        status: Status::AVAILABLE.with(Status::RETRIEVER),
        case_base: 0,
        cycle: Some(CycleState { id, coordinator: robot, decision }),
        progress: Progress::Idle,
        role: Role::None,
    }
}
