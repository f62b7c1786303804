//! `overlay_builder`: deferred overlays. Planned paths, maps of passes, threats, the tactics that opponents
//! are believed to play: computed from a snapshot, on the page's own thread, so that the match thread pays
//! for the snapshot only. m, s, field frame.

use std::sync::{Arc, Mutex, PoisonError};

use page::{DeferredScene, Scene};

use super::overlay_input::{Aim, OverlayInput};
use super::paths::Paths;
use super::tactics::Tactics;

/// Paints one moment after the other; state between moments is shared by its sketches.
#[derive(Clone, Debug, Default)]
pub(super) struct OverlayBuilder {
    tactics: Arc<Mutex<Tactics>>,
}

impl OverlayBuilder {
    /// The scene as it is, with the overlays deferred to the page's thread.
    pub(super) fn deferred_scene(&self, scene: Scene, input: OverlayInput) -> DeferredScene {
        let tactics = self.tactics.clone();
        DeferredScene::new(scene, move |scene| {
            // After a panic of another thread the stored state is still usable.
            let mut tactics = tactics.lock().unwrap_or_else(PoisonError::into_inner);
            paint(scene, &input, &mut tactics);
        })
    }
}

fn paint(scene: &mut Scene, input: &OverlayInput, tactics: &mut Tactics) {
    let OverlayInput { world, game, field, .. } = input;
    for Aim { who, to, rule_role } in &input.aims {
        let (Some(robot), Some(own)) = (world.robot(*who), game.own_goal(who.colour)) else { continue };
        let paths = Paths { world, phase: game.phase, placement: game.placement, field, own };
        let displayed = scene
            .robots
            .iter_mut()
            .find(|displayed| displayed.team == super::team(who.colour) && displayed.id == who.id.number());
        if let Some(detail) = displayed.and_then(|displayed| displayed.detail.as_mut()) {
            detail.intent.path = paths.to(robot, *to, *rule_role);
        }
    }
    let [maps, above] = tactics.layers(input);
    scene.layers.splice(0..0, maps);
    scene.layers.extend(above);
}
