//! `passes`: instruction count of the search for a pass. Places rated in full, and a search (Biswas et al.
//! 2014 §3.1).

use host::strategy::View;
use host::strategy::pass::{Kicks, PassScene, SAMPLES, Search};
use protocol::RobotId;
use rules::League;

use crate::scenes::{Random, SCENES};

/// Rates `count` places in full, [`PLACES`] a scene (a multiple of them).
pub(crate) fn locations(league: League, robots: u8, count: u32) -> String {
    let kicks = Kicks::of(league);
    let mut random = Random::new(1);
    let (mut sum, mut chips) = (0.0_f64, 0);
    // The number of scenes does not depend on the number of places rated: they cost the same for N and 2N.
    let scenes: Vec<View> = (0..SCENES).map(|_| random.view(league, robots)).collect();
    for group in 0..count / PLACES {
        let view = &scenes[(group % SCENES) as usize];
        let (Some(ball), Some(receiver)) = (view.ball, view.ours.get(1)) else { continue };
        let scene = PassScene::of(view, &kicks, ball.position, Some(RobotId::ZERO), receiver);
        for _ in 0..PLACES {
            let rating = scene.rate(random.place(view, 1.0));
            sum += f64::from(rating.value());
            chips += u32::from(rating.kick.is_chip());
        }
    }
    format!("mean {:.5}, {chips} chips", sum / f64::from(count))
}

/// Searches among `count` places, [`SAMPLES`] per scene: the search of the team in one snapshot.
pub(crate) fn searches(league: League, robots: u8, count: u32) -> String {
    let kicks = Kicks::of(league);
    let mut random = Random::new(1);
    let scenes: Vec<View> = (0..SCENES).map(|_| random.view(league, robots)).collect();
    let (mut sum, mut search) = (0.0_f64, Search::new(0));
    for group in 0..count / SAMPLES {
        let view = &scenes[(group / MOMENTS % SCENES) as usize];
        let (Some(ball), Some(receiver)) = (view.ball, view.ours.get(1)) else { continue };
        let scene = PassScene::of(view, &kicks, ball.position, Some(RobotId::ZERO), receiver);
        if group % MOMENTS == 0 {
            search = Search::new(u64::from(group));
        }
        sum += f64::from(search.step(&scene, SAMPLES).value());
    }
    format!("mean {:.5}", sum / f64::from(count / SAMPLES))
}

/// Consecutive snapshots over which one search continues.
const MOMENTS: u32 = 8;
/// Places rated in a row in one snapshot, as a search does; the snapshot's own part is in their cost.
const PLACES: u32 = 200;
