//! `decided`: orders and reasons at a moment, as text: the orders of a host that decides the same again.

use host::Host;
use protocol::Who;
use serde::Serialize;

use crate::description;

/// A robot's current directive and what decided it; places in m, field frame.
#[derive(Debug, Serialize)]
pub(crate) struct Decided {
    role: String,
    directive: String,
    why: String,
}

impl Decided {
    /// Of the host of its team, where there is one and it commands the robot.
    pub(crate) fn of(hosts: &[&Host], who: Who) -> Option<Self> {
        let host = hosts.iter().find(|host| host.settings().us == who.colour)?;
        let order = host.orders().iter().find(|order| order.robot == who.id)?;
        Some(Self {
            role: description::role(order.role),
            directive: description::directive(&order.task.directive(description::flip(host))),
            why: description::why(host, order),
        })
    }

    /// `kicker: kick at (1.20, -0.45), 6.2 m/s (the best target for the ball, 0.80 m of room)`.
    pub(crate) fn text(&self) -> String {
        let Self { role, directive, why } = self;
        format!("{role}: {directive} ({why})")
    }
}
