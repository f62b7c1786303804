//! Do our structs have the league's numbers and types? Packets assembled from the league's tables by another program
//! (`golden/assemble.py`) decode to what it put in, and encode to the same bytes.

#[path = "support/shown.rs"]
mod shown;

use serde_json::Value;
use ssl::Message;
use ssl::{common, controller, event, radio, referee, simulation, tracker, vision};

/// Decodes a packet: its `Debug` text and its bytes encoded again.
type Decode = fn(&[u8]) -> Result<(String, Vec<u8>), ssl::DecodeError>;

fn decode<M: Message + Default + std::fmt::Debug>(
    bytes: &[u8],
) -> Result<(String, Vec<u8>), ssl::DecodeError> {
    let message = M::decode(bytes)?;
    Ok((format!("{message:?}"), message.encode_to_vec()))
}

#[test]
fn every_message_decodes_to_what_was_put_in_and_encodes_to_the_same_bytes() {
    let mut messages = std::collections::BTreeSet::new();
    for (package, packets, lines) in GOLDEN {
        let mut rest = packets;
        for line in lines.lines() {
            let line: Value = serde_json::from_str(line).expect("a line of JSON");
            let name = line["message"].as_str().expect("a message's name");
            let what = format!("{package} {name}, {}", line["sample"]);
            let bytes = take_delimited(&mut rest);
            let (shown, again) =
                decoder(package, name)(bytes).unwrap_or_else(|error| panic!("{what}: {error}"));
            shown::agree(&shown, &line["fields"]).unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_eq!(again, bytes, "{what} encodes differently");
            messages.insert((package, name.to_owned()));
        }
        assert!(rest.is_empty(), "{package}: {} bytes without a line", rest.len());
    }
    let facts = FACTS.lines().filter(|line| line.starts_with("message ")).count();
    assert_eq!(messages.len(), facts, "not every message has a packet");
}

#[test]
fn every_field_of_every_message_is_set_in_some_packet() {
    let mut seen = std::collections::BTreeSet::new();
    for (package, _, lines) in GOLDEN {
        for line in lines.lines() {
            let line: Value = serde_json::from_str(line).expect("a line of JSON");
            let fields = line["fields"].as_object().expect("fields");
            let message = line["message"].as_str().expect("a message's name");
            seen.extend(fields.keys().map(|field| format!("{package} {message} {field}")));
        }
    }
    let mut message = String::new();
    let mut missing = Vec::new();
    for line in FACTS.lines() {
        let words: Vec<_> = line.split(' ').collect();
        match words[..] {
            ["message", package, name] => message = format!("{package} {name}"),
            ["enum", ..] => message.clear(),
            ["", "", _, field, _, ..] if !message.is_empty() => {
                let field = format!("{message} {field}");
                if !seen.contains(&field) {
                    missing.push(field);
                }
            }
            _ => {}
        }
    }
    assert!(missing.is_empty(), "{missing:?}");
    assert!(seen.len() > 500, "only {} fields", seen.len());
}

#[test]
fn every_enum_has_the_leagues_numbers_and_names() {
    for line in include_str!("golden/enums.tsv").lines() {
        let [package, name, number, value] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("{line}: four columns")
        };
        let number = number.parse().expect("a number");
        let variant = variant(package, name, number).unwrap_or_else(|| panic!("{line}: unknown here"));
        assert!(shown::same_variant(value, &variant), "{line}: here {variant}");
    }
}

#[test]
fn a_number_no_enum_knows_survives_and_reads_as_the_safe_first_one() {
    let sent = referee::Referee { command: 99, ..Default::default() };
    let heard = referee::Referee::decode(&sent.encode_to_vec()[..]).expect("decodes");
    assert_eq!(heard.command, 99);
    assert!(referee::Command::try_from(heard.command).is_err());
    assert_eq!(heard.command(), referee::Command::Halt);
}

#[test]
fn a_field_no_message_knows_is_passed_over() {
    let ball = vision::DetectionBall { x: 1.5, ..Default::default() };
    let mut bytes = ball.encode_to_vec();
    bytes.extend([0xa2, 0x06, 3, 1, 2, 3]); // number 100, three bytes
    assert_eq!(vision::DetectionBall::decode(&bytes[..]), Ok(ball));
}

fn take_delimited<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let length = prost::decode_length_delimiter(&mut *rest).expect("a length");
    let (bytes, after) = rest.split_at(length);
    *rest = after;
    bytes
}

macro_rules! decoders {
    ($($package:literal: $($name:literal => $type:ty),* $(,)?;)*) => {
        fn decoder(package: &str, name: &str) -> Decode {
            match (package, name) {
                $($(($package, $name) => decode::<$type>,)*)*
                _ => panic!("{package} {name}: not a message of ours"),
            }
        }
    };
}

macro_rules! enums {
    ($($package:literal $name:literal => $type:ty),* $(,)?) => {
        fn variant(package: &str, name: &str, number: i32) -> Option<String> {
            match (package, name) {
                $(($package, $name) => <$type>::try_from(number).ok().map(|value| format!("{value:?}")),)*
                _ => panic!("{package} {name}: not an enum of ours"),
            }
        }
    };
}

decoders! {
    "google":
        "Any" => common::Any,
        "Duration" => common::Duration,
    ;
    "vision":
        "Vector2f" => vision::Vector2f,
        "SSL_FieldLineSegment" => vision::FieldLineSegment,
        "SSL_FieldCircularArc" => vision::FieldCircularArc,
        "SSL_GeometryFieldSize" => vision::GeometryFieldSize,
        "SSL_GeometryCameraCalibration" => vision::GeometryCameraCalibration,
        "SSL_BallModelStraightTwoPhase" => vision::BallModelStraightTwoPhase,
        "SSL_BallModelChipFixedLoss" => vision::BallModelChipFixedLoss,
        "SSL_GeometryModels" => vision::GeometryModels,
        "SSL_GeometryData" => vision::GeometryData,
        "SSL_DetectionBall" => vision::DetectionBall,
        "SSL_DetectionRobot" => vision::DetectionRobot,
        "SSL_DetectionFrame" => vision::DetectionFrame,
        "SSL_WrapperPacket" => vision::WrapperPacket,
    ;
    "legacy":
        "SSL_GeometryFieldSize" => vision::legacy::GeometryFieldSize,
        "SSL_GeometryData" => vision::legacy::GeometryData,
        "SSL_WrapperPacket" => vision::legacy::WrapperPacket,
    ;
    "gc":
        "Vector2" => common::Vector2,
        "Vector3" => common::Vector3,
        "RobotId" => common::RobotId,
        "Referee" => referee::Referee,
        "Referee.TeamInfo" => referee::TeamInfo,
        "Referee.Point" => referee::Point,
        "GameEventProposalGroup" => referee::GameEventProposalGroup,
        "GameEvent" => event::GameEvent,
        "BallLeftField" => event::BallLeftField,
        "AimlessKick" => event::AimlessKick,
        "Goal" => event::Goal,
        "IndirectGoal" => event::IndirectGoal,
        "ChippedGoal" => event::ChippedGoal,
        "BotTooFastInStop" => event::BotTooFastInStop,
        "DefenderTooCloseToKickPoint" => event::DefenderTooCloseToKickPoint,
        "BotCrashDrawn" => event::BotCrashDrawn,
        "BotCrashUnique" => event::BotCrashUnique,
        "BotPushedBot" => event::BotPushedBot,
        "BotTippedOver" => event::BotTippedOver,
        "BotDroppedParts" => event::BotDroppedParts,
        "DefenderInDefenseArea" => event::DefenderInDefenseArea,
        "DefenderInDefenseAreaPartially" => event::DefenderInDefenseAreaPartially,
        "AttackerTouchedBallInDefenseArea" => event::AttackerTouchedBallInDefenseArea,
        "BotKickedBallTooFast" => event::BotKickedBallTooFast,
        "BotDribbledBallTooFar" => event::BotDribbledBallTooFar,
        "AttackerTouchedOpponentInDefenseArea" => event::AttackerTouchedOpponentInDefenseArea,
        "AttackerDoubleTouchedBall" => event::AttackerDoubleTouchedBall,
        "AttackerTooCloseToDefenseArea" => event::AttackerTooCloseToDefenseArea,
        "BotHeldBallDeliberately" => event::BotHeldBallDeliberately,
        "BotInterferedPlacement" => event::BotInterferedPlacement,
        "MultipleCards" => event::MultipleCards,
        "MultipleFouls" => event::MultipleFouls,
        "MultiplePlacementFailures" => event::MultiplePlacementFailures,
        "KickTimeout" => event::KickTimeout,
        "NoProgressInGame" => event::NoProgressInGame,
        "PlacementFailed" => event::PlacementFailed,
        "UnsportingBehaviorMinor" => event::UnsportingBehaviorMinor,
        "UnsportingBehaviorMajor" => event::UnsportingBehaviorMajor,
        "KeeperHeldBall" => event::KeeperHeldBall,
        "PlacementSucceeded" => event::PlacementSucceeded,
        "Prepared" => event::Prepared,
        "BotSubstitution" => event::BotSubstitution,
        "ExcessiveBotSubstitution" => event::ExcessiveBotSubstitution,
        "ChallengeFlag" => event::ChallengeFlag,
        "ChallengeFlagHandled" => event::ChallengeFlagHandled,
        "EmergencyStop" => event::EmergencyStop,
        "TooManyRobots" => event::TooManyRobots,
        "BoundaryCrossing" => event::BoundaryCrossing,
        "PenaltyKickFailed" => event::PenaltyKickFailed,
        "AutoRefCiInput" => controller::AutoRefCiInput,
        "AutoRefCiOutput" => controller::AutoRefCiOutput,
        "Output" => controller::Output,
        "Protocol" => controller::Protocol,
        "ProtocolEntry" => controller::ProtocolEntry,
        "Input" => controller::Input,
        "CiInput" => controller::CiInput,
        "CiOutput" => controller::CiOutput,
        "ControllerReply" => controller::ControllerReply,
        "Signature" => controller::Signature,
        "AutoRefRegistration" => controller::AutoRefRegistration,
        "AutoRefToController" => controller::AutoRefToController,
        "ControllerToAutoRef" => controller::ControllerToAutoRef,
        "RemoteControlRegistration" => controller::RemoteControlRegistration,
        "RemoteControlToController" => controller::RemoteControlToController,
        "ControllerToRemoteControl" => controller::ControllerToRemoteControl,
        "RemoteControlTeamState" => controller::RemoteControlTeamState,
        "TeamRegistration" => controller::TeamRegistration,
        "TeamToController" => controller::TeamToController,
        "ControllerToTeam" => controller::ControllerToTeam,
    ;
    "sim":
        "SimulatorError" => simulation::SimulatorError,
        "RobotFeedback" => simulation::RobotFeedback,
        "RobotControlResponse" => simulation::RobotControlResponse,
        "RobotCommand" => simulation::RobotCommand,
        "RobotMoveCommand" => simulation::RobotMoveCommand,
        "MoveWheelVelocity" => simulation::MoveWheelVelocity,
        "MoveLocalVelocity" => simulation::MoveLocalVelocity,
        "MoveGlobalVelocity" => simulation::MoveGlobalVelocity,
        "RobotControl" => simulation::RobotControl,
        "RealismConfigErForce" => simulation::RealismConfigErForce,
        "RobotLimits" => simulation::RobotLimits,
        "RobotWheelAngles" => simulation::RobotWheelAngles,
        "RobotSpecs" => simulation::RobotSpecs,
        "RealismConfig" => simulation::RealismConfig,
        "SimulatorConfig" => simulation::SimulatorConfig,
        "TeleportBall" => simulation::TeleportBall,
        "TeleportRobot" => simulation::TeleportRobot,
        "SimulatorControl" => simulation::SimulatorControl,
        "SimulatorCommand" => simulation::SimulatorCommand,
        "SimulatorResponse" => simulation::SimulatorResponse,
        "SimulationSyncRequest" => simulation::SimulationSyncRequest,
        "SimulationSyncResponse" => simulation::SimulationSyncResponse,
        "RobotSpecErForce" => simulation::RobotSpecErForce,
    ;
    "tracker":
        "Vector2" => common::Vector2,
        "Vector3" => common::Vector3,
        "RobotId" => tracker::TrackedRobotId,
        "TrackedBall" => tracker::TrackedBall,
        "KickedBall" => tracker::KickedBall,
        "TrackedRobot" => tracker::TrackedRobot,
        "TrackedFrame" => tracker::TrackedFrame,
        "TrackerWrapperPacket" => tracker::TrackerWrapperPacket,
    ;
    "radio":
        "RadioProtocolCommand" => radio::RadioProtocolCommand,
        "RadioProtocolWrapper" => radio::RadioProtocolWrapper,
    ;
}

enums! {
    "vision" "SSL_FieldShapeType" => vision::FieldShapeType,
    "vision" "SSL_Source" => vision::Source,
    "gc" "Team" => common::Team,
    "gc" "Division" => common::Division,
    "gc" "Referee.Stage" => referee::Stage,
    "gc" "Referee.Command" => referee::Command,
    "gc" "MatchType" => referee::MatchType,
    "gc" "HullColor" => referee::HullColor,
    "gc" "Type" => event::GameEventType,
    "gc" "ControllerReply.StatusCode" => controller::StatusCode,
    "gc" "ControllerReply.Verification" => controller::Verification,
    "gc" "RemoteControlToController.Request" => controller::RemoteControlRequest,
    "gc" "RemoteControlRequestType" => controller::RemoteControlRequestType,
    "gc" "AdvantageChoice" => controller::AdvantageChoice,
    "tracker" "TeamColor" => tracker::TeamColor,
    "tracker" "Capability" => tracker::Capability,
}

const FACTS: &str = include_str!("golden/facts.txt");

const GOLDEN: [(&str, &[u8], &str); 7] = [
    ("google", include_bytes!("golden/google.bin"), include_str!("golden/google.jsonl")),
    ("vision", include_bytes!("golden/vision.bin"), include_str!("golden/vision.jsonl")),
    ("legacy", include_bytes!("golden/legacy.bin"), include_str!("golden/legacy.jsonl")),
    ("gc", include_bytes!("golden/gc.bin"), include_str!("golden/gc.jsonl")),
    ("sim", include_bytes!("golden/sim.bin"), include_str!("golden/sim.jsonl")),
    ("tracker", include_bytes!("golden/tracker.bin"), include_str!("golden/tracker.jsonl")),
    ("radio", include_bytes!("golden/radio.bin"), include_str!("golden/radio.jsonl")),
];
