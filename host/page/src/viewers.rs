//! `viewers`: newest scene and mailboxes of viewers. A viewer's socket carries the newest scene whenever the
//! viewer has taken the one before.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};

/// Scenes queued for a viewer that has not yet taken them.
const UNTAKEN_MAX: u32 = 2;
/// Refusals that wait for a viewer that does not read; more are dropped.
const REFUSALS_MAX: usize = 16;

/// The newest scene, and who wants the next.
#[derive(Debug, Default)]
pub(crate) struct Viewers(Mutex<All>);

#[derive(Debug, Default)]
struct All {
    newest: Option<Arc<str>>,
    transport: Option<Arc<str>>,
    mailboxes: Vec<Weak<Mailbox>>,
    ended: bool,
}

impl Viewers {
    /// Hands a scene to all of them. Never waits for a viewer.
    pub(crate) fn show(&self, scene: &Arc<str>) {
        let mut all = locked(&self.0);
        all.newest = Some(scene.clone());
        all.mailboxes.retain(|mailbox| {
            let mailbox = mailbox.upgrade();
            mailbox.is_some_and(|mailbox| mailbox.change(|mail| mail.scene = Some(scene.clone())))
        });
    }

    /// Hands the moment that is sent to all of them, and to those to come. Never waits for a viewer.
    pub(crate) fn follow(&self, transport: &Arc<str>) {
        let mut all = locked(&self.0);
        all.transport = Some(transport.clone());
        for mailbox in all.mailboxes.iter().filter_map(Weak::upgrade) {
            mailbox.change(|mail| mail.transport = Some(transport.clone()));
        }
    }

    /// The mailbox of a new viewer, with the newest scene.
    pub(crate) fn join(&self) -> Arc<Mailbox> {
        let mut all = locked(&self.0);
        let (scene, transport) = (all.newest.clone(), all.transport.clone());
        let mail = Mail { scene, transport, gone: all.ended, ..Mail::default() };
        let mailbox = Arc::new(Mailbox { mail: Mutex::new(mail), changed: Condvar::new() });
        all.mailboxes.push(Arc::downgrade(&mailbox));
        mailbox
    }

    /// The page ends: every socket does, and none begins.
    pub(crate) fn end(&self) {
        let mut all = locked(&self.0);
        all.ended = true;
        all.mailboxes.drain(..).filter_map(|mailbox| mailbox.upgrade()).for_each(|mailbox| mailbox.leave());
    }

    pub(crate) fn have_ended(&self) -> bool {
        locked(&self.0).ended
    }
}

/// Scene, refusals and answer that wait for one viewer.
#[derive(Debug)]
pub(crate) struct Mailbox {
    mail: Mutex<Mail>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Mail {
    scene: Option<Arc<str>>,
    transport: Option<Arc<str>>,
    untaken: u32,
    refusals: VecDeque<String>,
    ping: Option<Vec<u8>>,
    gone: bool,
}

/// The next thing that is sent to a viewer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Sent {
    Scene(Arc<str>),
    /// The moment of a recording that is sent to the network.
    Transport(Arc<str>),
    /// Reason for which a request of the viewer is not carried out.
    Refusal(String),
    /// The answer to a ping.
    Pong(Vec<u8>),
}

impl Mailbox {
    /// Waits for it; none where the socket is over.
    pub(crate) fn next(&self) -> Option<Sent> {
        let mut mail = locked(&self.mail);
        loop {
            if mail.gone {
                return None;
            }
            if let Some(payload) = mail.ping.take() {
                return Some(Sent::Pong(payload));
            }
            if let Some(reason) = mail.refusals.pop_front() {
                return Some(Sent::Refusal(reason));
            }
            if let Some(transport) = mail.transport.take() {
                return Some(Sent::Transport(transport));
            }
            if mail.untaken < UNTAKEN_MAX
                && let Some(scene) = mail.scene.take()
            {
                mail.untaken += 1;
                return Some(Sent::Scene(scene));
            }
            mail = self.changed.wait(mail).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// The viewer has taken a scene.
    pub(crate) fn take(&self) {
        self.change(|mail| mail.untaken = mail.untaken.saturating_sub(1));
    }

    /// Sends the viewer the reason for which something is not done; dropped where it reads nothing.
    pub(crate) fn refuse(&self, reason: String) {
        self.change(|mail| {
            if mail.refusals.len() < REFUSALS_MAX {
                mail.refusals.push_back(reason);
            }
        });
    }

    /// The viewer asks whether the page is there. Of many such questions the last is answered, as the
    /// standard allows.
    pub(crate) fn ping(&self, payload: Vec<u8>) {
        self.change(|mail| mail.ping = Some(payload));
    }

    /// The socket is over.
    pub(crate) fn leave(&self) {
        self.change(|mail| mail.gone = true);
    }

    /// Applies the change; true while the viewer is still there.
    fn change(&self, with: impl FnOnce(&mut Mail)) -> bool {
        let mut mail = locked(&self.mail);
        with(&mut mail);
        self.changed.notify_all();
        !mail.gone
    }
}

/// The value behind the lock; a thread that panicked left it consistent.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_viewer_has_two_scenes_on_their_way_and_then_the_newest() {
        let viewers = Viewers::default();
        let scenes: Vec<Arc<str>> = ["1", "2", "3", "4"].map(Arc::from).to_vec();
        viewers.show(&scenes[0]);
        let mailbox = viewers.join();
        assert_eq!(mailbox.next(), Some(Sent::Scene(scenes[0].clone())));
        viewers.show(&scenes[1]);
        assert_eq!(mailbox.next(), Some(Sent::Scene(scenes[1].clone())));
        viewers.show(&scenes[2]);
        viewers.show(&scenes[3]);
        mailbox.refuse("no".to_owned());
        assert_eq!(mailbox.next(), Some(Sent::Refusal("no".to_owned())), "a scene would be the third");
        mailbox.take();
        assert_eq!(mailbox.next(), Some(Sent::Scene(scenes[3].clone())), "and the one between is old");
    }

    #[test]
    fn the_end_closes_present_and_later_mailboxes() {
        let viewers = Viewers::default();
        let before = viewers.join();
        viewers.end();
        assert_eq!((before.next(), viewers.join().next(), viewers.have_ended()), (None, None, true));
    }

    #[test]
    fn the_newest_moment_that_is_sent_reaches_present_and_later_viewers() {
        let viewers = Viewers::default();
        let before = viewers.join();
        let moments: Vec<Arc<str>> = ["1", "2"].map(Arc::from).to_vec();
        for moment in &moments {
            viewers.follow(moment);
        }
        for mailbox in [before, viewers.join()] {
            assert_eq!(mailbox.next(), Some(Sent::Transport(moments[1].clone())));
        }
    }

    #[test]
    fn a_viewer_that_does_not_read_holds_bounded_memory() {
        let viewers = Viewers::default();
        let mailbox = viewers.join();
        (0..1000).for_each(|n| mailbox.refuse(n.to_string()));
        let held = (0..REFUSALS_MAX).filter(|n| mailbox.next() == Some(Sent::Refusal(n.to_string())));
        assert_eq!(held.count(), REFUSALS_MAX);
        mailbox.ping(vec![1]);
        assert_eq!(mailbox.next(), Some(Sent::Pong(vec![1])), "no more refusals are kept");
    }
}
