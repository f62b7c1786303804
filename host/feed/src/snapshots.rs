//! `snapshots`: moments of a simulated field that viewers keep, return to, and save as files.

use arena::Snapshot;
use foreign::excerpt;
use hil_sim::small_size::World;
use page::{Page, UserRequest};
use rules::League;

/// Most moments that are kept; their numbers stay until the program ends.
const KEPT_MAX: usize = 20;

/// The kept moments of a match.
#[derive(Default)]
pub struct Snapshots {
    kept: Vec<Snapshot>,
}

/// Result of a request about moments.
pub enum SnapshotRequest<'s> {
    /// Another kind of request.
    Other,
    /// A moment was kept.
    Kept(String),
    /// Ball and robots are to return to this moment.
    Return(&'s Snapshot),
    /// Why it is refused.
    Refused(String),
}

impl Snapshots {
    /// Handles a request about moments; who drives the field returns to one.
    pub fn ask(
        &mut self,
        request: &UserRequest,
        world: &World,
        league: League,
        page: &Page,
    ) -> SnapshotRequest<'_> {
        let fresh = match request {
            UserRequest::Keep {} => Ok(Snapshot::of(world, league)),
            UserRequest::Load { snapshot } => Snapshot::from_json(&snapshot.to_string(), league),
            UserRequest::Return { number } => {
                return match self.kept.get(*number) {
                    Some(snapshot) => SnapshotRequest::Return(snapshot),
                    None => SnapshotRequest::Refused(format!("there is no snapshot {number}")),
                };
            }
            _ => return SnapshotRequest::Other,
        };
        match fresh {
            Ok(_) if self.kept.len() >= KEPT_MAX => {
                SnapshotRequest::Refused(format!("{KEPT_MAX} snapshots are kept: no more"))
            }
            Ok(snapshot) => {
                let described = format!("snapshot {} is kept: {:.2} s", self.kept.len(), snapshot.t);
                self.kept.push(snapshot);
                self.publish(page);
                SnapshotRequest::Kept(described)
            }
            Err(refused) => SnapshotRequest::Refused(excerpt(&refused.to_string(), WHY_LEN)),
        }
    }

    /// The moments for the page, each as a file of it is.
    pub fn publish(&self, page: &Page) {
        // Words and finite numbers: JSON can represent all of it.
        page.set_snapshots(serde_json::to_string(&self.kept).unwrap_or_default());
    }
}

/// Longest reason that is reported, characters: a file that is no snapshot may be quoted in it.
const WHY_LEN: usize = 200;
