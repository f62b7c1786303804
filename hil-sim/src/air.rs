//! `air`: simulated radio channel. A broadcast radio in steps of a tick: loss, delay, duplication,
//! reordering, partition.
//!
//! Loss, delay and copies are drawn per receiver from the channel's own random stream; packets that are due
//! in the same tick keep the order in which they were sent, unless reordering changes it. Packets that do not
//! fit into a tick ([`AIR_IN_MAX`], [`AIR_IN_BYTES_MAX`]) wait for the next.
//!
//! A team may have its host on this channel: it receives every robot's packets, sends to all robots or to
//! one, and its packets are lost and delayed like all others.

use protocol::RobotId;
use protocol::frame::Sender;
use protocol::link::Packet;
use protocol::lockstep::{AIR_IN_BYTES_MAX, AIR_IN_MAX};

use crate::rng::Stream;

/// Loss, delay, duplication and reach of the channel.
#[derive(Clone, Debug, PartialEq)]
pub struct AirSettings {
    /// Probability that a receiver does not receive a packet.
    pub loss: f32,
    /// Minimum and maximum delay, in ticks of 40 ms; at least 1: no packet is received in the tick in which
    /// it is sent.
    pub delay: [u32; 2],
    /// Probability that a receiver receives a packet twice; the copy has its own delay.
    pub duplication: f32,
    /// Probability that a packet changes places with the one sent before it to the same receiver, if that is
    /// not delivered yet.
    pub reordering: f32,
    /// Partition of a robot's radio, by id; packets pass within a partition only.
    pub groups: [u8; RobotId::COUNT],
    /// Partition of the host's radio.
    pub host_group: u8,
    /// Links whose loss probability differs from `loss`.
    pub links: Vec<LinkLoss>,
    /// Periods in which a link carries no packet at all, in addition to `loss`.
    pub bursts: Option<Bursts>,
}

/// Loss in bursts (Gilbert 1960, Elliott 1963): each direction between two radios alternates between good and
/// dead, both with exponentially distributed lengths. `loss` applies while it is good.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bursts {
    /// Share of the time in which a link is dead, 0 to below 1.
    pub share: f32,
    /// Mean length of a dead period, ticks; at least 1.
    pub ticks: f32,
}

impl Bursts {
    /// The state of a link one tick later.
    fn next(self, dead: bool, chance: &mut Stream) -> bool {
        let ends = 1.0 / self.ticks.max(1.0);
        // In equilibrium, equally many dead periods start and end.
        let begins = ends * self.share / (1.0 - self.share).max(f32::MIN_POSITIVE);
        if dead { !chance.chance(ends) } else { chance.chance(begins) }
    }
}

/// Loss of one direction between two radios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkLoss {
    /// The radio that sends.
    pub from: Sender,
    /// The radio that receives.
    pub to: Sender,
    /// Probability that the receiver does not receive a packet.
    pub loss: f32,
}

impl Default for AirSettings {
    /// Every packet is received one tick after it was sent.
    fn default() -> Self {
        Self {
            loss: 0.0,
            delay: [1, 1],
            duplication: 0.0,
            reordering: 0.0,
            groups: [0; RobotId::COUNT],
            host_group: 0,
            links: Vec::new(),
            bursts: None,
        }
    }
}

impl AirSettings {
    /// The default with this probability of loss.
    pub fn with_loss(loss: f32) -> Self {
        Self { loss, ..Self::default() }
    }

    fn group(&self, station: Sender) -> u8 {
        match station {
            Sender::Robot(robot) => self.groups[robot.index()],
            Sender::Host => self.host_group,
        }
    }

    fn loss_between(&self, from: Sender, to: Sender) -> f32 {
        let link = self.links.iter().find(|link| link.from == from && link.to == to);
        link.map_or(self.loss, |link| link.loss)
    }
}

/// Counts of all packets so far, one per receiver and packet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AirCounts {
    /// Packets sent to a receiver in reach.
    pub sent: u64,
    /// Packets lost, or sent out of reach.
    pub lost: u64,
    /// Number of packets delivered twice.
    pub doubled: u64,
    /// Number of packets delivered, copies included.
    pub delivered: u64,
}

/// The radio channel between the robots of a team, and their host where there is one.
#[derive(Clone, Debug)]
pub struct Air {
    settings: AirSettings,
    chance: Stream,
    /// Packets not delivered yet, by receiver, sorted by `(due, order)`.
    inbound: Vec<(Sender, Vec<InFlight>)>,
    order: u64,
    counts: AirCounts,
    /// Dead links by sender and receiver, and the tick up to which they are computed.
    dead: Vec<[bool; Sender::COUNT]>,
    dead_in: u32,
    stretches: Stream,
}

#[derive(Clone, Debug)]
struct InFlight {
    due: u32,
    /// Sequence number of the packet.
    order: u64,
    packet: Packet,
}

impl Air {
    /// A channel between `robots`, without packets.
    pub fn new(settings: AirSettings, seed: u64, robots: &[RobotId]) -> Self {
        let mut receivers = robots.to_vec();
        receivers.sort_unstable();
        Self {
            settings,
            chance: Stream::new(seed, "air"),
            inbound: receivers.into_iter().map(|robot| (Sender::Robot(robot), Vec::new())).collect(),
            order: 0,
            counts: AirCounts::default(),
            dead: vec![[false; Sender::COUNT]; Sender::COUNT],
            dead_in: 0,
            stretches: Stream::new(seed, "air bursts"),
        }
    }

    /// A channel between `robots` and their host, without packets.
    pub fn with_host(settings: AirSettings, seed: u64, robots: &[RobotId]) -> Self {
        let mut air = Self::new(settings, seed, robots);
        air.inbound.push((Sender::Host, Vec::new()));
        air
    }

    /// Settings for packets sent from now on; packets already sent keep their drawn delay.
    pub fn set(&mut self, settings: AirSettings) {
        self.settings = settings;
    }

    /// The settings in force for the next packets.
    pub fn settings(&self) -> &AirSettings {
        &self.settings
    }

    /// Counts of all packets so far.
    pub fn counts(&self) -> AirCounts {
        self.counts
    }

    /// Robot `from` sends in tick `now`; the others, and the host, receive it later or lose it.
    pub fn send(&mut self, now: u32, from: RobotId, packet: &Packet) {
        self.spread(now, Sender::Robot(from), None, packet);
    }

    /// The host sends in tick `now`, to all robots or to one.
    pub fn send_from_host(&mut self, now: u32, to: Option<RobotId>, packet: &Packet) {
        self.spread(now, Sender::Host, to.map(Sender::Robot), packet);
    }

    fn spread(&mut self, now: u32, from: Sender, only: Option<Sender>, packet: &Packet) {
        self.work_out_bursts(now);
        let Self { settings, chance, inbound, order, counts, dead, .. } = self;
        let meant = |to: Sender| to != from && only.is_none_or(|only| only == to);
        for (to, queue) in inbound.iter_mut().filter(|(to, _)| meant(*to)) {
            counts.sent += 1;
            let apart = settings.group(from) != settings.group(*to);
            let dead = settings.bursts.is_some() && dead[from.index()][to.index()];
            if apart || dead || chance.chance(settings.loss_between(from, *to)) {
                counts.lost += 1;
                continue;
            }
            let doubled = chance.chance(settings.duplication);
            counts.doubled += u64::from(doubled);
            for _ in 0..=u8::from(doubled) {
                *order += 1;
                let delay = chance.whole(settings.delay[0].max(1), settings.delay[1]);
                let mut arriving = InFlight { due: now + delay, order: *order, packet: packet.clone() };
                if chance.chance(settings.reordering) {
                    overtake(queue, &mut arriving);
                }
                enqueue(queue, arriving);
            }
        }
    }

    /// Computes which links are dead in tick `now`: all of them advance every tick, whether they are used or
    /// not.
    fn work_out_bursts(&mut self, now: u32) {
        let Some(bursts) = self.settings.bursts else {
            self.dead_in = now;
            return;
        };
        while self.dead_in < now {
            self.dead_in += 1;
            for dead in self.dead.iter_mut().flatten() {
                *dead = bursts.next(*dead, &mut self.stretches);
            }
        }
    }

    /// The packets robot `to` receives in tick `now`, in order.
    pub fn deliver(&mut self, now: u32, to: RobotId) -> heapless::Vec<Packet, AIR_IN_MAX> {
        let Some(queue) = self.queue(Sender::Robot(to)) else { return heapless::Vec::new() };
        let (mut due, mut bytes) = (0, 0);
        for arrived in queue.iter().take(AIR_IN_MAX).take_while(|arrived| arrived.due <= now) {
            bytes += arrived.packet.len();
            if bytes > AIR_IN_BYTES_MAX {
                break;
            }
            due += 1;
        }
        let packets = queue.drain(..due).map(|arrived| arrived.packet).collect();
        self.counts.delivered += due as u64;
        packets
    }

    /// All packets the host receives in tick `now`, in order.
    pub fn deliver_to_host(&mut self, now: u32) -> Vec<Packet> {
        let Some(queue) = self.queue(Sender::Host) else { return Vec::new() };
        let due = queue.iter().take_while(|packet| packet.due <= now).count();
        let packets = queue.drain(..due).map(|arrived| arrived.packet).collect();
        self.counts.delivered += due as u64;
        packets
    }

    /// A robot's radio is off: packets due for it by `now` are lost.
    pub fn discard(&mut self, now: u32, to: RobotId) {
        if let Some(queue) = self.queue(Sender::Robot(to)) {
            let before = queue.len();
            queue.retain(|packet| packet.due > now);
            let lost = before - queue.len();
            self.counts.lost += lost as u64;
        }
    }

    fn queue(&mut self, to: Sender) -> Option<&mut Vec<InFlight>> {
        self.inbound.iter_mut().find(|(station, _)| *station == to).map(|(_, queue)| queue)
    }
}

/// The new packet takes the place of the last queued packet, which takes the new one's.
fn overtake(queue: &mut Vec<InFlight>, newcomer: &mut InFlight) {
    let youngest = queue.iter().enumerate().max_by_key(|(_, packet)| packet.order).map(|(i, _)| i);
    if let Some(i) = youngest {
        let mut overtaken = queue.remove(i);
        std::mem::swap(&mut overtaken.due, &mut newcomer.due);
        std::mem::swap(&mut overtaken.order, &mut newcomer.order);
        enqueue(queue, overtaken);
    }
}

fn enqueue(queue: &mut Vec<InFlight>, packet: InFlight) {
    let place = queue.partition_point(|other| (other.due, other.order) < (packet.due, packet.order));
    queue.insert(place, packet);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn air(settings: AirSettings) -> Air {
        Air::new(settings, 9, &[id(2), id(1), id(3)])
    }

    fn packet(n: u32) -> Packet {
        Packet::from_slice(&n.to_le_bytes()).unwrap()
    }

    /// Robot 1 sends `n` numbered packets, one per tick; returns what robot 2 received, with the ticks.
    fn received(settings: AirSettings, n: u32) -> (Vec<(u32, u32)>, AirCounts) {
        let mut air = air(settings);
        let mut received = Vec::new();
        for tick in 0..n + 20 {
            for p in air.deliver(tick, id(2)) {
                received.push((tick, u32::from_le_bytes(p[..4].try_into().unwrap())));
            }
            if tick < n {
                air.send(tick, id(1), &packet(tick));
            }
        }
        (received, air.counts())
    }

    #[test]
    fn by_default_all_but_the_sender_receive_a_packet_one_tick_later() {
        let mut air = air(AirSettings::default());
        air.send(5, id(2), &packet(1));
        assert!(air.deliver(5, id(1)).is_empty());
        assert_eq!(air.deliver(6, id(1))[..], [packet(1)]);
        assert!(air.deliver(6, id(2)).is_empty());
        assert_eq!(air.deliver(9, id(3))[..], [packet(1)], "what was not fetched waits");
        assert!(air.deliver(9, id(7)).is_empty());
    }

    #[test]
    fn loss_and_duplication_have_the_configured_probabilities() {
        let settings = AirSettings { duplication: 0.1, ..AirSettings::with_loss(0.3) };
        let (received, counts) = received(settings, 4_000);
        let once = 4_000.0 * 0.7;
        // Deviations: √(4000·0.3·0.7) = 29 losses, and about √(2800·0.1·0.9) = 16 copies; four of each.
        assert!((received.len() as f32 - once * 1.1).abs() < 4.0 * (29.0 + 16.0), "{}", received.len());
        assert_eq!(counts.sent, 8_000);
        assert!(counts.lost.abs_diff(2_400) < 4 * 41 && counts.doubled.abs_diff(560) < 4 * 23, "{counts:?}");
    }

    #[test]
    fn bursts_have_the_configured_share_and_mean_length() {
        let settings =
            AirSettings { bursts: Some(Bursts { share: 0.3, ticks: 8.0 }), ..AirSettings::default() };
        let n = 40_000;
        let (received, _) = received(settings, n);
        let came: std::collections::BTreeSet<u32> = received.iter().map(|(_, number)| *number).collect();
        let lost = f64::from(n) - came.len() as f64;
        let stretches = (1..n).filter(|i| came.contains(&(i - 1)) && !came.contains(i)).count() as f64;
        // 1,500 dead periods of 8 ± 8: 0.2 of their mean, and 2 % of the share; four of each.
        assert!((lost / f64::from(n) - 0.3).abs() < 0.03, "{lost}");
        assert!((lost / stretches - 8.0).abs() < 0.9, "{}", lost / stretches);
    }

    #[test]
    fn delays_stay_within_their_bounds_and_reach_both_of_them() {
        let (received, _) = received(AirSettings { delay: [1, 3], ..AirSettings::default() }, 300);
        let delays: Vec<u32> = received.iter().map(|(tick, sent)| tick - sent).collect();
        assert!(delays.iter().all(|d| (1..=3).contains(d)) && [1, 2, 3].iter().all(|d| delays.contains(d)));
        assert_eq!(received.len(), 300);
    }

    #[test]
    fn reordering_swaps_and_loses_nothing() {
        let settings = AirSettings { reordering: 0.5, delay: [2, 2], ..AirSettings::default() };
        let (received, _) = received(settings, 300);
        let mut numbers: Vec<u32> = received.iter().map(|(_, n)| *n).collect();
        assert!(numbers.windows(2).any(|pair| pair[0] > pair[1]));
        numbers.sort_unstable();
        assert_eq!(numbers, (0..300).collect::<Vec<_>>());
    }

    #[test]
    fn a_partition_and_a_link_loss_cut_no_other_links() {
        let mut settings = AirSettings::default();
        settings.groups[3] = 1;
        settings.links.push(LinkLoss { from: Sender::Robot(id(1)), to: Sender::Robot(id(2)), loss: 1.0 });
        let mut air = air(settings);
        for robot in [1, 2, 3] {
            air.send(0, id(robot), &packet(u32::from(robot)));
        }
        assert_eq!(air.deliver(1, id(1))[..], [packet(2)]);
        assert!(air.deliver(1, id(2)).is_empty());
        assert!(air.deliver(1, id(3)).is_empty());
    }

    #[test]
    fn surplus_packets_wait_a_tick_and_a_radio_that_is_off_loses_them() {
        let mut air = air(AirSettings::default());
        for n in 0..20 {
            air.send(0, id(1), &packet(n));
        }
        assert_eq!(air.deliver(1, id(2)).len(), AIR_IN_MAX);
        assert_eq!(air.deliver(2, id(2)).len(), 20 - AIR_IN_MAX);
        air.discard(2, id(3));
        assert!(air.deliver(3, id(3)).is_empty());
        assert_eq!(air.counts().lost, 20);
    }

    #[test]
    fn packets_wait_when_the_bytes_of_a_tick_are_used_up() {
        let mut air = air(AirSettings::default());
        let long = Packet::from_slice(&[7; 120]).unwrap();
        (0..12).for_each(|_| air.send(0, id(1), &long));
        assert_eq!(air.deliver(1, id(2)).len(), AIR_IN_BYTES_MAX / 120);
        assert_eq!(air.deliver(2, id(2)).len(), 12 - AIR_IN_BYTES_MAX / 120);
    }

    #[test]
    fn a_host_sends_to_all_or_to_one_robot_and_receives_from_all() {
        let mut air = Air::with_host(AirSettings::default(), 9, &[id(2), id(1)]);
        air.send_from_host(0, None, &packet(7));
        air.send_from_host(0, Some(id(1)), &packet(8));
        air.send_from_host(0, Some(id(9)), &packet(9));
        air.send(0, id(1), &packet(1));
        assert_eq!(air.deliver(1, id(1))[..], [packet(7), packet(8)]);
        assert_eq!(air.deliver(1, id(2))[..], [packet(7), packet(1)]);
        assert_eq!(air.deliver_to_host(1), [packet(1)]);
        assert!(air.deliver_to_host(2).is_empty());
        assert_eq!(air.counts().sent, 2 + 1 + 2);
    }

    #[test]
    fn loss_applies_to_a_hosts_packets_too() {
        let deaf = LinkLoss { from: Sender::Host, to: Sender::Robot(id(2)), loss: 1.0 };
        let settings = AirSettings { links: vec![deaf], ..AirSettings::with_loss(0.3) };
        let mut air = Air::with_host(settings, 9, &[id(1), id(2)]);
        let mut received = [0, 0, 0];
        for tick in 0..4_000 {
            received[0] += air.deliver(tick, id(1)).len();
            received[1] += air.deliver(tick, id(2)).len();
            received[2] += air.deliver_to_host(tick).len();
            air.send_from_host(tick, None, &packet(tick));
            air.send(tick, id(2), &packet(tick));
        }
        // Robot 1 receives from two senders, robot 2 from none, the host from one; √(n·0.3·0.7) = 41 and 29,
        // four of each.
        assert!(received[0].abs_diff(5_600) < 4 * 41 && received[2].abs_diff(2_800) < 4 * 29, "{received:?}");
        assert_eq!(received[1], 0);
        air.discard(4_500, id(1));
        air.set(AirSettings { host_group: 1, ..AirSettings::default() });
        air.send_from_host(5_000, None, &packet(0));
        assert!(air.deliver(5_001, id(1)).is_empty(), "out of reach");
    }
}
