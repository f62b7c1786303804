//! `compatibility`: compatibility profiles: this simulator's own behaviour on the wire, or that of the
//! league's other simulators.
//!
//! For tests of a host against what it will receive there: clocks, cameras, geometry, which settings are
//! accepted and how robots are answered, as observed on running grSim and ER-Force's simulator. The physics
//! stays ours except for the ball model on the wire.

use super::parameters::{BallParameters, CameraParameters, NoiseParameters};

/// The simulator that is imitated on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Profile {
    /// This simulator's own behaviour.
    #[default]
    Ours,
    /// The simulator grSim, of team Parsian.
    Grsim,
    /// The simulator of team ER-Force.
    ErForce,
}

/// Origin of `t_capture` and `t_sent`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// Seconds of the simulation, from 0.
    Simulation,
    /// Unix time; the value is that time at the simulation's start, s.
    Unix(f64),
}

/// Times at which geometry packets are sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GeometryStyle {
    /// In separate packets with all cameras, with this period, s.
    Own(f32),
    /// With every frame, all cameras.
    EveryFrame,
    /// With every n-th frame of a camera, that camera alone.
    OneCamera(u32),
}

/// Behaviour of a simulator on the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compatibility {
    /// The profile that it belongs to.
    pub profile: Profile,
    /// Times at which geometry packets are sent.
    pub geometry: GeometryStyle,
    /// Cameras take their frames one after another instead of all at once.
    pub staggered: bool,
    /// Geometry packets contain the fields of newer versions, true camera poses and pixels.
    pub full_geometry: bool,
    /// Lines are drawn this far inside the field's edge, m, and goals are drawn too.
    pub drawn_goals: bool,
    /// The ball model on the wire, if it is not that of the physics.
    pub reported_ball: Option<ReportedBall>,
    /// Robots whose states an answer contains.
    pub feedback: Feedback,
    /// A control message is answered even where nothing was refused.
    pub answers_control: bool,
    /// Probability that a robot's answer is left out.
    pub answer_loss: f32,
    /// A command without a dribbler speed stops the dribbler; else it keeps its speed.
    pub dribbler_resets: bool,
    /// The value of a dribbler speed is ignored: above 0 it turns at full speed.
    pub dribbler_switches: bool,
    /// Robots accept velocities in their own frame alone.
    pub local_velocity_only: bool,
    /// A command without a velocity leaves the robot's motion unchanged; else it brakes.
    pub keeps_moving: bool,
    /// Only robots' specifications can be set.
    pub only_specs: bool,
    /// `teleport_safely` and `roll` are supported.
    pub safe_teleport: bool,
    /// A teleport may leave out one coordinate of two, and a robot's specification the values that stay.
    pub partial: bool,
    /// A robot may be placed far outside the walls: it is parked.
    pub parks: bool,
    /// Vision reports the ball's height, and its true position instead of the one a camera would see.
    pub ball_height: bool,
}

/// Robots whose states an answer contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// Those of all robots of the team on the field.
    Present,
    /// Those of all robots commanded in the message, also of removed ones.
    Commanded,
    /// The same without removed robots; a message without any state is not sent.
    CommandedPresent,
}

/// A ball model as in geometry packets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportedBall {
    /// Sliding acceleration, m/s², < 0.
    pub slide: f64,
    /// Rolling acceleration, m/s², < 0.
    pub roll: f64,
    /// Share of the kick's speed below which the ball rolls.
    pub switch: f64,
    /// Shares of speed kept on landing: along the ground at the first and at later landings, and upwards.
    pub hops: [f64; 3],
}

impl ReportedBall {
    /// The model of the physics.
    pub fn of(ball: &BallParameters) -> Self {
        Self {
            slide: -f64::from(ball.slide),
            roll: -f64::from(ball.roll),
            switch: 5.0 / 7.0,
            hops: [ball.hop_along, ball.hop_along_later, ball.hop_up].map(f64::from),
        }
    }
}

impl Profile {
    /// The behaviour of the profile.
    pub fn compatibility(self, camera: &CameraParameters) -> Compatibility {
        let ours = Compatibility {
            profile: Self::Ours,
            geometry: GeometryStyle::Own(camera.geometry_every),
            staggered: true,
            full_geometry: true,
            drawn_goals: false,
            reported_ball: None,
            feedback: Feedback::Present,
            answers_control: true,
            answer_loss: 0.0,
            dribbler_resets: false,
            dribbler_switches: false,
            local_velocity_only: false,
            keeps_moving: false,
            only_specs: false,
            safe_teleport: true,
            partial: true,
            parks: false,
            ball_height: false,
        };
        match self {
            Self::Ours => ours,
            Self::Grsim => Compatibility {
                profile: self,
                geometry: GeometryStyle::OneCamera(120),
                staggered: false,
                full_geometry: false,
                drawn_goals: true,
                reported_ball: Some(ReportedBall {
                    slide: -14.0,
                    roll: -0.7,
                    switch: 0.7,
                    hops: [0.6, 0.96, 0.42],
                }),
                feedback: Feedback::Commanded,
                dribbler_switches: true,
                keeps_moving: true,
                only_specs: true,
                safe_teleport: false,
                parks: true,
                ball_height: true,
                ..ours
            },
            Self::ErForce => Compatibility {
                profile: self,
                geometry: GeometryStyle::EveryFrame,
                staggered: false,
                full_geometry: false,
                reported_ball: Some(ReportedBall {
                    slide: -3.9,
                    roll: -0.35,
                    switch: 0.69,
                    hops: [0.715, 1.0, 0.566],
                }),
                feedback: Feedback::CommandedPresent,
                answers_control: false,
                answer_loss: 0.1,
                dribbler_resets: true,
                local_velocity_only: true,
                partial: false,
                ..ours
            },
        }
    }

    /// The profile's cameras: grSim has four, on its own clock and without delay; ER-Force's simulator has
    /// one.
    pub fn cameras(self, ours: CameraParameters) -> CameraParameters {
        match self {
            Self::Ours => ours,
            Self::Grsim => CameraParameters { count: 4, rate: 60.0, delay: 0.0, processing: 0.0, ..ours },
            Self::ErForce => CameraParameters { count: 1, rate: 100.0, ..ours },
        }
    }

    /// The profile's noise: grSim starts without any.
    pub fn noise(self, ours: NoiseParameters) -> NoiseParameters {
        if self == Self::Grsim { NoiseParameters::NONE } else { ours }
    }

    /// The profile's clock: grSim's own, Unix time for all others.
    pub fn clock(self, unix_now: f64) -> Clock {
        if self == Self::Grsim { Clock::Simulation } else { Clock::Unix(unix_now) }
    }
}
