//! `start`: the moment of a recording that a simulated match starts from: field by our tracker, referee by
//! its packets. s since the recording's start; m, m/s, rad, field frame.

use std::path::Path;

use arena::game::{GameStart, LEAD_IN_TICKS, TICK_US};
use arena::{BallState, RobotState, Snapshot};
use geometry::Point;
use hil_sim::small_size::referee::remote::RemoteMatch;
use host::health_checks::other_field;
use host::tracking::Tracker;
use host::world::World;
use protocol::{Instant, RobotId};
use rules::{Colour, FieldSpec, League};
use ssl::log::{Packet, Record};
use ssl::referee::Referee;

use super::failure::{RecordedError, RecordingFailure, in_file};
use super::packets::{LeaguePacket, LeaguePackets};

/// The moment at `at_s` of a league log file or a trace. The robots of team `led` get their tracks for at
/// most `after_s` after it. An error where the file ends before it, has no field, ball, image or robot until
/// then, or another league's field or number of robots, or where the match is over.
pub fn start_from(
    file: &Path,
    league: League,
    at_s: f64,
    (led, after_s): (Option<Colour>, f64),
) -> Result<GameStart, RecordingFailure> {
    let mut packets = LeaguePackets::open(file)?;
    let mut reader = Reader::new(league, at_s).map_err(in_file(file))?;
    let ticks = LEAD_IN_TICKS + if led.is_some() { (after_s * 1e6) as u32 / TICK_US as u32 } else { 0 };
    let mut end = Instant(0);
    for packet in packets.by_ref() {
        end = packet.at;
        reader.frames_until(packet.at, ticks as usize).map_err(in_file(file))?;
        if reader.frames.len() > ticks as usize {
            break;
        }
        reader.read(packet);
    }
    if reader.frames.len() <= LEAD_IN_TICKS as usize {
        let asked = format!("it ends after {:.3} s, before {at_s} s", end.0 as f64 * 1e-6);
        return Err(in_file(file)(RecordedError::NotThere { asked, damage: packets.damage() }));
    }
    let blue_on_positive = reader.blue_on_positive();
    let Reader { frames, moment, .. } = reader;
    let referee = moment
        .ok_or_else(|| RecordedError::NoStart(format!("no frame at {at_s} s")))
        .map_err(in_file(file))?;
    Ok(GameStart { frames, referee, blue_on_positive, led })
}

struct Reader {
    league: League,
    /// The moment, µs.
    at_us: u64,
    tracker: Tracker,
    referee: RemoteMatch,
    /// The referee at the moment.
    moment: Option<RemoteMatch>,
    newest: Option<Referee>,
    frames: Vec<Snapshot>,
}

impl Reader {
    fn new(league: League, at_s: f64) -> Result<Self, RecordedError> {
        let referee = RemoteMatch::new(league).map_err(|_| RecordedError::NoRules)?;
        let (tracker, frames) = (Tracker::default(), Vec::new());
        Ok(Self { league, at_us: (at_s * 1e6) as u64, tracker, referee, moment: None, newest: None, frames })
    }

    /// Adds the frames that are due before `now`, until there is one more than `ticks`.
    fn frames_until(&mut self, now: Instant, ticks: usize) -> Result<(), RecordedError> {
        loop {
            let after = self.at_us + self.frames.len() as u64 * TICK_US;
            let due = Instant(after.saturating_sub(u64::from(LEAD_IN_TICKS) * TICK_US));
            if due >= now || self.frames.len() > ticks {
                return Ok(());
            }
            let world = self.tracker.world(due);
            if self.frames.len() == LEAD_IN_TICKS as usize {
                self.check(&world, due)?;
                let ball = world.ball.map_or(Point::default(), |ball| ball.position);
                self.referee.tick(due, ball);
                self.moment = Some(self.referee.clone());
            }
            let frame = self.frame(&world, due);
            self.frames.push(frame);
        }
    }

    fn read(&mut self, packet: LeaguePacket) {
        let record = Record { timestamp_ns: packet.unix_ns, kind: packet.kind, payload: packet.bytes };
        let decoded = match record.present() {
            Some((kind, bytes)) => Packet::decode(kind, &bytes),
            None => record.decode().map(|_| None),
        };
        match decoded {
            Ok(Some(Packet::Vision(vision))) => {
                self.tracker.handle(&vision, packet.at);
            }
            Ok(Some(Packet::Referee(referee))) if self.moment.is_none() => {
                let ball = self.tracker.world(packet.at).ball.map_or(Point::default(), |ball| ball.position);
                self.referee.receive(referee.clone(), packet.at, ball);
                self.referee.tick(packet.at, ball);
                self.newest = Some(referee);
            }
            _ => {}
        }
    }

    /// Why no match of the league can start here, if so.
    fn check(&self, world: &World, at: Instant) -> Result<(), RecordedError> {
        let at_s = at.0 as f64 * 1e-6;
        let Some(announced) = self.tracker.geometry().field() else {
            return refused(format!(
                "no geometry of the field until {at_s} s: take a later second, or a log with vision"
            ));
        };
        if let Some(other) = other_field(self.league, announced) {
            let [length, width] = other.announced;
            let fits = other.fits.map_or_else(
                || "no league that is simulated has it".to_owned(),
                |fits| format!("add --league {}", fits.name()),
            );
            return refused(format!(
                "its field is {length:.1} × {width:.1} m, not that of {}: {fits}",
                self.league.name()
            ));
        }
        if world.ball.is_none() || world.robots().next().is_none() {
            let what = if world.ball.is_none() { "ball" } else { "robot" };
            return refused(format!("vision sees no {what} at {at_s} s: take another second"));
        }
        if self.newest.as_ref().is_some_and(|newest| newest.stage == ssl::referee::Stage::PostGame as i32) {
            return refused(format!("the match is over at {at_s} s: take an earlier second"));
        }
        let most = self.league.limits().map_or(RobotId::COUNT, |limits| limits.robots as usize);
        for team in [Colour::Blue, Colour::Yellow] {
            let on_field = world.team(team).filter(|robot| plays(announced, robot)).count();
            if on_field > most {
                return refused(format!(
                    "{on_field} {} robots are on the field at {at_s} s, {} allows {most}: take another second or --league",
                    team.label(),
                    self.league.name()
                ));
            }
        }
        Ok(())
    }

    /// The tracked field; where no ball is known, that of the frame before.
    fn frame(&self, world: &World, at: Instant) -> Snapshot {
        let field = self.tracker.geometry().field().copied().unwrap_or(self.league.field());
        let ball = world.ball.map(|ball| BallState {
            at: [ball.position.x(), ball.position.y()],
            velocity: [ball.velocity.x(), ball.velocity.y()],
            height: ball.height.max(0.0),
            climb: ball.climb,
            // A ball that is not sliding after a kick rolls.
            spin: if ball.velocity.norm() < ball.rolls_below {
                [ball.velocity.x(), ball.velocity.y()]
            } else {
                [0.0; 2]
            },
            hops: u32::from(ball.bounced),
        });
        let before = self.frames.last().map_or_else(BallState::default, |before| before.ball);
        let robots = world.robots().filter(|robot| plays(&field, robot)).map(|robot| RobotState {
            blue: robot.who.colour == Colour::Blue,
            id: robot.who.id.number(),
            at: [robot.pose.position.x(), robot.pose.position.y()],
            heading: robot.pose.heading.radians(),
            velocity: [robot.velocity.x(), robot.velocity.y()],
            turning: robot.angular,
        });
        let (league, t) = (self.league.name().to_owned(), at.0 as f64 * 1e-6);
        Snapshot { league, t, ball: ball.unwrap_or(before), robots: robots.collect() }
    }

    /// Whether blue defends +x: by the referee, else by where the teams stand.
    fn blue_on_positive(&self) -> bool {
        let announced = self.newest.as_ref().and_then(|newest| newest.blue_team_on_positive_half);
        announced.unwrap_or_else(|| {
            let moment = self.frames.get(LEAD_IN_TICKS as usize);
            let robots = moment.map_or(&[][..], |frame| &frame.robots);
            robots.iter().map(|robot| if robot.blue { robot.at[0] } else { -robot.at[0] }).sum::<f32>() > 0.0
        })
    }
}

fn refused(reason: String) -> Result<(), RecordedError> {
    Err(RecordedError::NoStart(reason))
}

/// Whether a robot is on the field, and not beside it with those that wait.
fn plays(field: &FieldSpec, robot: &host::world::Robot) -> bool {
    let at = robot.pose.position;
    field.clamp(at, -rules::limits::ROBOT_RADIUS) == at
}

#[cfg(test)]
mod tests {
    use arena::game::{Game, GameConfig, NoWatcher, STEPS_A_TICK};
    use hil_sim::NativeBackend;
    use protocol::Who;

    use super::*;

    const AT_S: f64 = 15.0;

    fn start(led: Option<Colour>) -> GameStart {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../protocol/ssl/tests/data");
        let file = data.join("grsim_divB_22s.log.gz");
        start_from(&file, League::DivisionB, AT_S, (led, 2.0)).expect("a start")
    }

    fn game(start: GameStart) -> Game<'static> {
        let config = GameConfig::new(League::DivisionB, 1, 5.0).starting_from(start.into());
        Game::new(&config, &mut NativeBackend::new(case_library::division_b())).expect("a game")
    }

    #[test]
    fn the_field_at_the_moment_is_the_recordings_and_both_hosts_know_it() {
        let start = start(None);
        let moment = start.moment().expect("a moment").clone();
        assert_eq!(moment.robots.len(), 12);
        assert!((moment.t - AT_S).abs() < 1e-6);
        let mut game = game(start);
        for _ in 0..=LEAD_IN_TICKS {
            game.step(&mut NoWatcher).expect("a tick");
        }
        let ball = Point::new(moment.ball.at[0], moment.ball.at[1]);
        // The tick after the moment is played: 10 ms at 1 m/s. The tracked ball lies within a robot's
        // outline, which pushes it out by its radius.
        assert!(game.world().ball.position.distance(ball) < 0.1);
        for robot in &moment.robots {
            let at = Point::new(robot.at[0], robot.at[1]);
            let who = robot.who().expect("a robot");
            let truth = game.world().robot(who).expect("it plays");
            assert!(truth.pose.position.distance(at) < 0.05, "{who:?}");
            for host in [Colour::Blue, Colour::Yellow].map(|team| game.host(team)) {
                let known = host.world().team(who.colour).find(|known| known.who == who).expect("seen");
                assert!(known.pose.position.distance(at) < 0.05, "{who:?} {known:?}");
                assert_eq!(host.game().phase, rules::Phase::Run);
            }
        }
        assert_eq!(game.referee().phase(), rules::Phase::Run);
    }

    #[test]
    fn a_led_team_follows_its_recorded_tracks_until_they_end() {
        let start = start(Some(Colour::Yellow));
        let frames = start.frames.clone();
        assert_eq!(frames.len(), LEAD_IN_TICKS as usize + 201);
        let mut game = game(start);
        let (mut near, mut moved) = (0, 0.0_f32);
        for _ in 0..LEAD_IN_TICKS + 100 {
            game.step(&mut NoWatcher).expect("a tick");
        }
        let tick = (game.world().now() / STEPS_A_TICK) as usize;
        for track in frames[tick].robots.iter().filter(|track| !track.blue) {
            let who = Who { colour: Colour::Yellow, id: RobotId::new(track.id).expect("a number") };
            let own = game.world().robot(who).expect("it plays").pose.position;
            let from = frames[LEAD_IN_TICKS as usize].robots.iter().find(|from| from.who() == track.who());
            let [at, from] = [track.at, from.expect("it was there").at].map(|[x, y]| Point::new(x, y));
            moved = moved.max(at.distance(from));
            near += usize::from(own.distance(at) < 0.05);
        }
        // One of them has the ball, and decides by itself.
        assert!(near >= 4 && moved > 0.3, "{near} on their tracks, the farthest by {moved} m");
    }
}
