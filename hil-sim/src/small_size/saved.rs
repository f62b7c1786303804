//! `saved`: worlds as bytes. [`World`] implements serde's traits over all of its state, caches and random
//! streams included, so that a world read back goes on bit for bit; here is the check of what was read.

use super::{SLOTS, World};

impl World {
    /// Whether robots, their slots and the lists of near ones fit together. A world read from bytes must be
    /// asked before its first step: serde checks each value alone.
    pub fn is_consistent(&self) -> bool {
        let count = self.robots.len();
        let known = |index: &u8| usize::from(*index) < count;
        count <= SLOTS
            && self.senses.len() == count
            && self.crashes.len() == SLOTS * SLOTS
            && self.robots.is_sorted_by(|a, b| a.who < b.who)
            && self.places.iter().enumerate().all(|(slot, place)| place.is_none_or(|at| self.is_in(at, slot)))
            && self.places.iter().flatten().count() == count
            && self.near_ball.iter().chain(&self.near_edge).all(known)
            && self.pairs.iter().all(|(a, b)| a != b && known(a) && known(b))
    }

    /// Whether there is a robot of that number in the list, and its slot is this one.
    fn is_in(&self, place: u8, slot: usize) -> bool {
        self.robots.get(usize::from(place)).is_some_and(|robot| robot.who.slot() == slot)
    }
}

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;
    use crate::four_legged::trace::TraceHash;
    use crate::small_size::tests::{lead, six_a_side, yellow};
    use crate::small_size::worlds::{WorldChoice, WorldModel};
    use crate::small_size::{Drive, KickCommand, Order};
    use geometry::{Twist, Vector};

    fn chase() -> Order {
        let drive = Drive::Local(Twist { linear: Vector::new(1.5, 0.4), angular: 0.7 });
        Order { drive, kick: Some(KickCommand { speed: 3.0, angle: 0.6 }), dribbler: 0.5, discharge: false }
    }

    /// The hash after more play, every tick with the order that arrives after the world's latency.
    fn hash_after_play(world: &mut World) -> String {
        let mut hash = TraceHash::default();
        for tick in 0..100 {
            world.send_order(yellow(2), chase());
            lead(world, yellow(1), chase(), 10);
            hash.small_size_tick(tick, world);
        }
        hash.digits()
    }

    #[test]
    fn a_world_read_back_goes_on_bit_for_bit_in_every_kind_of_world() {
        for choice in (0..20).map(WorldChoice::Random).chain([WorldChoice::Nominal]) {
            let model = WorldModel::of(League::DivisionB, &choice).unwrap();
            let mut world = six_a_side(World::of_model(League::DivisionB, &model, 3));
            hash_after_play(&mut world);
            let bytes = postcard::to_extend(&world, Vec::new()).unwrap();
            let mut back: World = postcard::from_bytes(&bytes).unwrap();
            assert!(back.is_consistent());
            assert_eq!(format!("{back:?}"), format!("{world:?}"), "{choice}");
            assert_eq!(hash_after_play(&mut back), hash_after_play(&mut world), "{choice}");
        }
    }

    #[test]
    fn a_world_whose_lists_do_not_fit_together_is_noticed() {
        let model = WorldModel::of(League::DivisionB, &WorldChoice::Nominal).unwrap();
        let world = six_a_side(World::of_model(League::DivisionB, &model, 3));
        for damage in [
            |world: &mut World| world.robots.swap(0, 1),
            |world: &mut World| world.near_ball.push(12),
            |world: &mut World| world.pairs.push((0, 12)),
            |world: &mut World| world.places[yellow(0).slot()] = None,
            |world: &mut World| world.senses.truncate(3),
            |world: &mut World| world.crashes.truncate(7),
        ] {
            let mut damaged = world.clone();
            damage(&mut damaged);
            assert!(world.is_consistent() && !damaged.is_consistent());
        }
    }
}
