//! `quirks`: compatibility profiles. Its own, or those in which the league's other simulators differ on the
//! wire.
//!
//! So that a host can be tried against what it will meet: clocks, cameras, geometry, which settings are taken and how robots
//! are answered, as they were seen when grSim and ER-Force's simulator ran. Physics stay ours but for the ball's wire model.

use super::parameters::{BallParameters, CameraParameters, NoiseParameters};

/// A simulator to be like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Profile {
    /// This one.
    #[default]
    Ours,
    /// grSim.
    Grsim,
    /// ER-Force's simulator.
    ErForce,
}

/// What `t_capture` and `t_sent` count from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// Seconds of the simulation, from 0.
    Simulation,
    /// Unix time, which was this when the simulation began, s.
    Unix(f64),
}

/// When the field is described.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GeometryStyle {
    /// In packets of its own with all cameras, every so many seconds.
    Own(f32),
    /// With every frame, all cameras.
    EveryFrame,
    /// With one camera's frame out of so many, that camera alone.
    OneCamera(u32),
}

/// How a simulator behaves on the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quirks {
    /// Whose these are.
    pub profile: Profile,
    /// When the field is described.
    pub geometry: GeometryStyle,
    /// Cameras take their pictures one after another instead of all at once.
    pub staggered: bool,
    /// Geometry has the numbers that newer packets have, true camera poses and pixels.
    pub full_geometry: bool,
    /// Lines are drawn this far inside the field's edge, m, and goals are drawn too.
    pub drawn_goals: bool,
    /// The ball's model told on the wire, if it is not the physics' own.
    pub told_ball: Option<ToldBall>,
    /// Whose state a robots' answer tells.
    pub feedback: Feedback,
    /// A control message is answered even where nothing was refused.
    pub answers_control: bool,
    /// Probability that a robot's answer is left out.
    pub answer_loss: f32,
    /// A command without a dribbler's speed stops the dribbler; else it goes on as before.
    pub dribbler_resets: bool,
    /// A dribbler's speed is not looked at: above 0 it turns.
    pub dribbler_switches: bool,
    /// Robots obey velocities in their own frame alone.
    pub local_velocity_only: bool,
    /// A command without a velocity leaves the robot moving as it did; else it brakes.
    pub keeps_moving: bool,
    /// Nothing but robots' specifications may be set.
    pub only_specs: bool,
    /// `teleport_safely` and `roll` are understood.
    pub safe_teleport: bool,
    /// A teleport may leave out one coordinate of two, a robot's specification what is to stay.
    pub partial: bool,
    /// A robot may be put far outside the hall: it is parked.
    pub parks: bool,
    /// Vision tells the ball's height, and its place as it is instead of where a camera would see it.
    pub ball_height: bool,
}

/// Whose state a robots' answer tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// Every robot's of the team that is on the field.
    Present,
    /// Every robot's that was commanded in the message, also of those that were taken away.
    Commanded,
    /// The same, but robots that were taken away say nothing, and a message without any is not sent.
    CommandedPresent,
}

/// A ball model as geometry packets tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToldBall {
    /// m/s², < 0.
    pub slide: f64,
    /// m/s², < 0.
    pub roll: f64,
    /// Share of the kick's speed from which on it rolls.
    pub switch: f64,
    /// Landing: along the ground, first and later, and up.
    pub hops: [f64; 3],
}

impl ToldBall {
    /// The physics' own.
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
    /// How it behaves.
    pub fn quirks(self, camera: &CameraParameters) -> Quirks {
        let ours = Quirks {
            profile: Self::Ours,
            geometry: GeometryStyle::Own(camera.geometry_every),
            staggered: true,
            full_geometry: true,
            drawn_goals: false,
            told_ball: None,
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
            Self::Grsim => Quirks {
                profile: self,
                geometry: GeometryStyle::OneCamera(120),
                staggered: false,
                full_geometry: false,
                drawn_goals: true,
                told_ball: Some(ToldBall { slide: -14.0, roll: -0.7, switch: 0.7, hops: [0.6, 0.96, 0.42] }),
                feedback: Feedback::Commanded,
                dribbler_switches: true,
                keeps_moving: true,
                only_specs: true,
                safe_teleport: false,
                parks: true,
                ball_height: true,
                ..ours
            },
            Self::ErForce => Quirks {
                profile: self,
                geometry: GeometryStyle::EveryFrame,
                staggered: false,
                full_geometry: false,
                told_ball: Some(ToldBall {
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

    /// Its cameras: grSim has four and tells their time as its own, without delay; ER-Force's has one.
    pub fn cameras(self, ours: CameraParameters) -> CameraParameters {
        match self {
            Self::Ours => ours,
            Self::Grsim => CameraParameters { count: 4, rate: 60.0, delay: 0.0, processing: 0.0, ..ours },
            Self::ErForce => CameraParameters { count: 1, rate: 100.0, ..ours },
        }
    }

    /// Its noise: grSim starts without any.
    pub fn noise(self, ours: NoiseParameters) -> NoiseParameters {
        if self == Self::Grsim { NoiseParameters::NONE } else { ours }
    }

    /// Its clock: grSim's own, everybody else's Unix time.
    pub fn clock(self, unix_now: f64) -> Clock {
        if self == Self::Grsim { Clock::Simulation } else { Clock::Unix(unix_now) }
    }
}
