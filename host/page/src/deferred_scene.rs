//! `deferred_scene`: a scene with the work that still has to be done to it. The page's own thread does that,
//! so that planned paths, maps and beliefs cost the match's thread nothing.

use std::fmt;

use crate::scene::Scene;

/// Finishes a scene from captured state of the moment.
type Finish = Box<dyn FnOnce(&mut Scene) + Send>;

/// A scene, to be finished off the match's thread.
pub struct DeferredScene {
    /// The part that is known at once.
    pub scene: Scene,
    finish: Option<Finish>,
}

impl DeferredScene {
    /// A scene that `finish` completes; scenes are finished in the order in which they are passed to the
    /// page.
    pub fn new(scene: Scene, finish: impl FnOnce(&mut Scene) + Send + 'static) -> Self {
        Self { scene, finish: Some(Box::new(finish)) }
    }

    /// The finished scene: runs the deferred work on this thread.
    pub fn finished(self) -> Scene {
        let Self { mut scene, finish } = self;
        if let Some(finish) = finish {
            finish(&mut scene);
        }
        scene
    }
}

impl From<Scene> for DeferredScene {
    fn from(scene: Scene) -> Self {
        Self { scene, finish: None }
    }
}

impl fmt::Debug for DeferredScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DeferredScene").field("scene", &self.scene).finish_non_exhaustive()
    }
}
