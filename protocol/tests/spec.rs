//! Does the code write the bytes that `SPEC.md` says? Every worked example there is named and checked, both ways.

use protocol::frame::{Frame, Sender, TeamKey};
use protocol::quantized::{WirePoint, WirePose};
use protocol::team::{
    AbortReason, BallReport, Beacon, Closure, CycleState, Decision, Play, Progress, Role, Status, TeamMessage,
};
use protocol::{CaseId, CycleId, RobotId, TeamId};

const SPEC: &str = include_str!("../SPEC.md");

/// The bytes of the block that begins with ```` ```hex NAME ````: two hexadecimal digits a byte, `|` and words after
/// `;` are for the eye.
fn worked(name: &str) -> Vec<u8> {
    let block = SPEC
        .split("```")
        .find(|block| block.lines().next() == Some(&format!("hex {name}")))
        .unwrap_or_else(|| panic!("SPEC.md has no example {name}"));
    block
        .lines()
        .skip(1)
        .flat_map(|line| line.split(';').next().unwrap_or("").split_whitespace())
        .filter(|word| *word != "|")
        .map(|word| u8::from_str_radix(word, 16).unwrap_or_else(|_| panic!("{name}: {word} is no byte")))
        .collect()
}

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn quiet() -> Beacon {
    Beacon {
        pose: WirePose { at: WirePoint { x: -700, y: 0 }, heading: 1571 },
        ball: None,
        status: Status::default(),
        case_base: 0x0403_0201,
        cycle: None,
        progress: Progress::Idle,
        role: Role::None,
    }
}

fn playing() -> Beacon {
    Beacon {
        ball: Some(BallReport { at: WirePoint { x: -600, y: 10 }, distance: 100 }),
        status: Status::AVAILABLE.with(Status::RETRIEVER),
        cycle: Some(CycleState {
            id: CycleId { counter: 7, proposer: robot(1) },
            coordinator: robot(3),
            decision: Decision::Play(Play {
                case: CaseId(12),
                ball: WirePoint { x: -600, y: 10 },
                robots: [robot(1), robot(3)].into_iter().collect(),
            }),
        }),
        progress: Progress::Execute { done: 2 },
        ..quiet()
    }
}

fn aborted() -> Beacon {
    Beacon {
        cycle: Some(CycleState {
            id: CycleId { counter: 7, proposer: robot(1) },
            coordinator: robot(3),
            decision: Decision::Closed(Closure::Aborted { by: robot(1), reason: AbortReason::PathBlocked }),
        }),
        status: Status::AVAILABLE,
        ..quiet()
    }
}

#[test]
fn messages_have_the_bytes_of_the_specification() {
    for (name, beacon) in [("quiet", quiet()), ("playing", playing()), ("aborted", aborted())] {
        let message = TeamMessage::Beacon(beacon);
        let mut out = [0; 64];
        let bytes = postcard::to_slice(&message, &mut out).unwrap();
        assert_eq!(bytes, &worked(name)[..], "{name}: {}", hex(bytes));
        assert_eq!(postcard::from_bytes::<TeamMessage>(&worked(name)), Ok(message), "{name}");
    }
}

#[test]
fn frames_have_the_bytes_of_the_specification() {
    let payload = worked("quiet");
    let frame =
        Frame { team: TeamId(1), sender: Sender::Robot(robot(3)), epoch: 1, counter: 258, payload: &payload };
    let mut out = [0; 64];
    let n = frame.emit(&TeamKey::ZERO, &mut out).unwrap();
    assert_eq!(&out[..n], &worked("frame")[..], "{}", hex(&out[..n]));
    assert_eq!(Frame::parse(&worked("frame"), TeamId(1)), Ok(frame));
}

fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x} ");
        text
    })
}
