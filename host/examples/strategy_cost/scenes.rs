//! `scenes`: random situations for the counts. All robots at places on the field drawn from a seed; attack
//! frame, SI.

use geometry::{Attack, Point, Vector};
use host::strategy::View;
use host::strategy::view::ViewBall;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use rules::{League, Phase, Side};

/// Different moments of a count.
pub(crate) const SCENES: u32 = 64;

/// Where the moments come from.
pub(crate) struct Random(Xoshiro128PlusPlus);

impl Random {
    /// The same moments for the same seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(Xoshiro128PlusPlus::seed_from_u64(seed))
    }

    /// A place in the middle `share` of the field.
    pub(crate) fn place(&mut self, view: &View, share: f32) -> Point<Attack> {
        let (x, y) = (view.field.length * 0.5 * share, view.field.width * 0.5 * share);
        Point::new(self.within(x), self.within(y))
    }

    /// Robots of both teams, equally many, at random places, half of them moving; the ball lies still.
    pub(crate) fn view(&mut self, league: League, robots: u8) -> View {
        let nowhere = (0..robots).map(|_| Point::default());
        let mut view = View::still(league.field(), Point::default(), nowhere.clone(), nowhere);
        view.ball = Some(ViewBall::at_rest(self.place(&view, 0.9)));
        for i in 0..usize::from(robots) {
            let pace = if i % 2 == 0 { 0.0 } else { 1.5 };
            for ours in [true, false] {
                let position = self.place(&view, 1.0);
                let velocity = Vector::new(self.within(pace), self.within(pace));
                let robot = if ours { &mut view.ours[i] } else { &mut view.theirs[i] };
                (robot.position, robot.velocity) = (position, velocity);
            }
        }
        view
    }

    /// The same with a ball that rolls.
    pub(crate) fn rolling(&mut self, league: League, robots: u8) -> View {
        let mut view = self.view(league, robots);
        let velocity = Vector::new(self.within(3.0), self.within(3.0));
        if let Some(ball) = &mut view.ball {
            ball.velocity = velocity;
        }
        view
    }

    /// Our free kick: the ball does not move, every second opponent at one of our robots.
    pub(crate) fn free_kick(&mut self, league: League, robots: u8) -> View {
        let mut view = View { phase: Phase::FreeKick(Side::Ours), ..self.view(league, robots) };
        let goal = view.their_goal();
        for i in (2..view.theirs.len()).step_by(2) {
            let at = view.ours[i].position;
            view.theirs[i].position = at + (goal - at).clamped(0.3);
        }
        view
    }

    fn within(&mut self, range: f32) -> f32 {
        ((self.0.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range
    }
}
