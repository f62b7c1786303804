//! `manual_referee`: a referee that sends the command it is given, for tries and rehearsals that judge for
//! themselves.

use geometry::{Field, Point};
use ssl::referee::Command;

use super::{Game, NoWatcher};

/// A command of the referee.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RefereeOrder {
    /// STOP.
    Stop,
    /// The ball is in play.
    Run,
    /// Team yellow places the ball there.
    Place(Point<Field>),
}

/// Sends its newest command to both teams, as often as the game controller does; STOP at first.
pub struct ManualReferee {
    packet: ssl::referee::Referee,
    first_stamp: u64,
    next: u64,
}

impl ManualReferee {
    /// The referee of this game, in the first half.
    pub fn new(game: &Game<'_>) -> Self {
        let mut packet = ssl::referee::Referee {
            stage: ssl::referee::Stage::NormalFirstHalf as i32,
            command: Command::Stop as i32,
            next_command: None,
            ..game.referee().packet()
        };
        // Bystanders belong to no team, or our robots would have to leave for them.
        packet.yellow.max_allowed_bots = Some(u32::from(u8::MAX));
        Self { first_stamp: packet.packet_timestamp, packet, next: 0 }
    }

    /// Gives this command from now on.
    pub fn send(&mut self, game: &Game<'_>, order: RefereeOrder) {
        let command = match order {
            RefereeOrder::Stop => Command::Stop,
            RefereeOrder::Run => Command::ForceStart,
            RefereeOrder::Place(_) => Command::BallPlacementYellow,
        };
        self.packet.command = command as i32;
        self.packet.command_counter += 1;
        self.packet.command_timestamp = self.first_stamp + game.now().0;
        if let RefereeOrder::Place(at) = order {
            let at = ssl::referee::Point { x: at.x() * 1000.0, y: at.y() * 1000.0 };
            self.packet.designated_position = Some(at);
            self.packet.next_command = Some(Command::DirectFreeYellow as i32);
        }
        self.next = 0;
    }

    /// Sends its packet when it is due.
    pub fn speak(&mut self, game: &mut Game<'_>) {
        let now = game.now();
        if now.0 < self.next {
            return;
        }
        self.next = now.0 + PERIOD_US;
        self.packet.packet_timestamp = self.first_stamp + now.0;
        game.announce(now, &self.packet, &mut NoWatcher);
    }
}

/// Between two packets of the referee, µs: as the game controller's.
const PERIOD_US: u64 = 25_000;
