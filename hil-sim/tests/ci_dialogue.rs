//! `ci_dialogue`: tests of a match under the league's game controller in its CI mode, against a recorded
//! dialogue of the real one (`data/README.md`).

use std::io::Read as _;
use std::net::TcpListener;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use geometry::{Angle, Field, Point, Pose, Vector};
use hil_sim::small_size::camera::Cameras;
use hil_sim::small_size::compatibility::Profile;
use hil_sim::small_size::network::{CiController, ControllerChoice};
use hil_sim::small_size::referee::{InternalReferee, Kind, RefereeEvent, RefereeSettings};
use hil_sim::small_size::worlds::WorldModel;
use hil_sim::small_size::{Ball, World};
use protocol::{RobotId, Who};
use rules::{Colour, League, Phase};
use ssl::Message;
use ssl::controller::ci::{ChangeOf, CiInput, CiOutput};
use ssl::event::GameEventType;
use ssl::net::Connection;
use ssl::referee::Referee;
use ssl::stream::FrameReader;

/// Simulated time between two observations, ms: five exchanges' worth, so that the recording is small.
const PERIOD_MS: u64 = 100;
/// Simulated length of the dialogue, s.
const LENGTH_S: f64 = 28.0;
/// Largest message of the recording, bytes.
const MESSAGE_MAX: usize = 64 * 1024;

/// The recorded answers, those to each message of the simulator together.
fn recorded() -> Vec<Vec<CiOutput>> {
    let mut bytes = Vec::new();
    let packed = &include_bytes!("data/ci_dialogue.bin.gz")[..];
    flate2::read::GzDecoder::new(packed).read_to_end(&mut bytes).expect("a gzip file");
    let mut frames = FrameReader::new(MESSAGE_MAX);
    frames.push(&bytes);
    let mut groups: Vec<Vec<CiOutput>> = Vec::new();
    // An empty message precedes the answers to each message.
    while let Some(message) = frames.next_message().expect("whole messages") {
        match groups.last_mut().filter(|_| !message.is_empty()) {
            Some(group) => group.push(CiOutput::decode(message).expect("an answer")),
            None => groups.push(Vec::new()),
        }
    }
    groups
}

/// A controller that gives the recorded answers; returns what it was sent.
fn controller() -> (String, JoinHandle<Vec<CiInput>>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    let server = thread::spawn(move || {
        let (stream, _) = listener.accept().expect("a connection");
        let mut link = Connection::over(stream).expect("a link");
        let mut inputs = Vec::new();
        for group in recorded() {
            let Ok(Some(input)) = link.receive::<CiInput>(Duration::from_secs(20)) else { break };
            inputs.push(input);
            for output in group {
                link.send(&output).expect("sent");
            }
        }
        inputs
    });
    (address, server)
}

fn at(x: f32, y: f32) -> Point<Field> {
    Point::new(x, y)
}

/// Both teams stand in their halves, yellow in the negative one; no robot drives.
struct Scene {
    world: World,
    referee: InternalReferee,
    controller: CiController,
    phases: Vec<Phase<Colour>>,
    packets: Vec<Referee>,
}

impl Scene {
    fn new(address: &str) -> Self {
        let (league, seed) = (League::DivisionB, 1);
        let model = WorldModel::of(league, &"nominal".parse().expect("a world")).expect("wheels");
        let mut world = World::of_model(league, &model, seed);
        for id in 0..6 {
            let y = -2.4 + 0.8 * f32::from(id);
            let id = RobotId::new(id).expect("a number");
            for (colour, x) in [(Colour::Yellow, -2.5), (Colour::Blue, 2.5)] {
                world.put(Who { colour, id }, Pose { position: at(x, y), heading: Angle::ZERO });
            }
        }
        let settings = RefereeSettings::new(league);
        let cameras = Cameras::of_model(Profile::Ours, 0.0, &world, model.vision, seed);
        let choice = ControllerChoice::from(address);
        let geometry = cameras.geometry(&world, None);
        let controller = CiController::start(&choice, &settings, seed, geometry).expect("connected");
        let referee = InternalReferee::new(settings, seed).expect("a league with rules");
        Self { world, referee, controller, phases: Vec::new(), packets: Vec::new() }
    }

    fn step(&mut self) {
        for _ in 0..PERIOD_MS {
            self.world.step();
        }
        let mut events = Vec::new();
        self.world.take_events(&mut events);
        let packets = self.controller.look(&mut self.world, &events, &mut self.referee).expect("an exchange");
        self.packets.extend(packets);
        if self.phases.last() != Some(&self.referee.phase()) {
            self.phases.push(self.referee.phase());
        }
    }

    /// What happens on the field: the kick-off goes out, the ball is placed as ordered, and then lies in
    /// blue's goal.
    fn play(&mut self) {
        while self.world.time() < LENGTH_S {
            self.step();
            let changed = self.phases.len();
            let ball = match self.phases.last() {
                Some(Phase::Kickoff(_)) => at(1.0, 3.2),
                Some(Phase::BallPlacement(_)) => self.referee.placement().unwrap_or_default(),
                Some(Phase::Run) if changed == self.phases.len() => at(4.6, 0.0),
                _ => continue,
            };
            self.world.put_ball(Ball::rolling(ball, Vector::default()));
        }
    }
}

/// The kinds of events that were reported to the controller, oldest first.
fn reported(inputs: &[CiInput]) -> Vec<GameEventType> {
    let changes = inputs.iter().flat_map(|input| &input.api_inputs).filter_map(|act| act.change.as_ref());
    let events = changes.filter_map(|change| match change.change.as_ref()? {
        ChangeOf::AddGameEvent(added) => added.game_event.as_ref()?.r#type,
        _ => None,
    });
    events.map(|kind| GameEventType::try_from(kind).expect("a kind")).collect()
}

#[test]
fn the_real_controllers_answers_lead_from_halt_by_kick_off_and_placement_to_a_goal() {
    let (address, server) = controller();
    let mut scene = Scene::new(&address);
    scene.play();
    let Scene { referee, controller, phases, packets, .. } = scene;
    drop(controller);
    let inputs = server.join().expect("the controller's side");
    assert_eq!(
        phases,
        [
            Phase::Halt,
            Phase::Stop,
            Phase::PrepareKickoff(Colour::Yellow),
            Phase::Kickoff(Colour::Yellow),
            Phase::Run,
            Phase::Stop,
            Phase::BallPlacement(Colour::Blue),
            Phase::Stop,
            Phase::Run,
            Phase::Stop,
            Phase::PrepareKickoff(Colour::Blue),
        ]
    );
    let kinds: Vec<Kind> = referee.events().iter().map(|event: &RefereeEvent| event.what.kind()).collect();
    assert_eq!(kinds, [Kind::NoProgress, Kind::PlacementSucceeded, Kind::Goal]);
    let scores = [Colour::Yellow, Colour::Blue].map(|team| referee.accounts().of(team).score);
    assert_eq!(scores, [1, 0]);
    use GameEventType::{Goal, NoProgressInGame, PlacementSucceeded};
    assert_eq!(reported(&inputs), [NoProgressInGame, PlacementSucceeded, Goal]);
    assert!(referee.blocked().is_none());

    // The controller's clock is the simulation's, and so are the times of its packets.
    let times: Vec<i64> = inputs.iter().filter_map(|input| input.timestamp).collect();
    assert_eq!(times.len() as u64, (LENGTH_S * 1e3) as u64 / PERIOD_MS);
    assert!(times.windows(2).all(|pair| pair[1] - pair[0] == PERIOD_MS as i64 * 1_000_000));
    let stamps: Vec<u64> = packets.iter().map(|packet| packet.packet_timestamp).collect();
    assert!(stamps.is_sorted() && stamps.iter().all(|stamp| stamp % (PERIOD_MS * 1_000) == 0));
    let marks = packets.iter().filter_map(|packet| packet.status_message.as_ref());
    assert_eq!(marks.count(), 0, "the texts that mark the end of acts are not for teams");
}

#[test]
fn a_controller_that_closes_is_an_error_of_the_match() {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let mut scene = Scene::new(&listener.local_addr().expect("an address").to_string());
    drop(listener.accept().expect("a connection"));
    let (mut events, Scene { world, referee, controller, .. }) = (Vec::new(), &mut scene);
    world.step();
    world.take_events(&mut events);
    let error = controller.look(world, &events, referee).expect_err("no controller");
    assert!(error.to_string().contains("closed the connection"), "{error}");
}
