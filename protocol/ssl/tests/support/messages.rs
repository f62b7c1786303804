//! `messages`: map from the league's messages to our types. By the package and name of `golden/facts.txt`.

use ssl::Message;
use ssl::{common, controller, event, referee, simulation, tracker, vision};

/// Decodes a packet: its `Debug` text and its bytes encoded again.
pub(crate) type Decode = fn(&[u8]) -> Result<(String, Vec<u8>), ssl::DecodeError>;

fn decode<M: Message + Default + std::fmt::Debug>(
    bytes: &[u8],
) -> Result<(String, Vec<u8>), ssl::DecodeError> {
    let message = M::decode(bytes)?;
    Ok((format!("{message:?}"), message.encode_to_vec()))
}

macro_rules! decoders {
    ($($package:literal: $($name:literal => $type:ty),* $(,)?;)*) => {
        pub(crate) fn decoder(package: &str, name: &str) -> Decode {
            match (package, name) {
                $($(($package, $name) => decode::<$type>,)*)*
                _ => panic!("{package} {name}: not a message of ours"),
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
        "ControllerReply" => controller::ControllerReply,
        "Signature" => controller::Signature,
        "AutoRefRegistration" => controller::AutoRefRegistration,
        "AutoRefToController" => controller::AutoRefToController,
        "ControllerToAutoRef" => controller::ControllerToAutoRef,
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
}
