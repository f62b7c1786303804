//! `camera`: cameras and their vision packets, with a frame rate, delay and noise of their own, in
//! SSL-Vision's format.
//!
//! Each camera takes and numbers its frames independently and has its own random stream of errors; a packet
//! is due after its delay. Times on the wire are exact milliseconds of the simulation, on the configured
//! clock.

mod field;
mod mishaps;
mod view;

use std::collections::VecDeque;

use ssl::vision::{DetectionFrame, GeometryData, Source, WrapperPacket};

use super::World;
use super::compatibility::{Clock, Compatibility, GeometryStyle, Profile};
use super::parameters::{CameraParameters, NoiseParameters};
use super::worlds::VisionModel;
use mishaps::Mishaps;
use view::View;

/// Everything that determines what cameras send.
#[derive(Clone, Copy, Debug)]
pub struct CameraSettings {
    /// Number, frame rate and delay.
    pub camera: CameraParameters,
    /// Errors of detections: noise, misses, false ones.
    pub noise: NoiseParameters,
    /// The clock of their time stamps.
    pub clock: Clock,
    /// Compatibility profile of the packets.
    pub compatibility: Compatibility,
}

/// The cameras over one field.
#[derive(Clone, Debug)]
pub struct Cameras {
    settings: CameraSettings,
    views: Vec<View>,
    /// Packets not sent yet, by the step they are due in.
    sent: VecDeque<(u64, WrapperPacket)>,
    next_geometry: u64,
    mishaps: Mishaps,
    seed: u64,
}

impl Cameras {
    /// Cameras over `world`'s field; random streams come from `seed`.
    pub fn new(settings: CameraSettings, world: &World, seed: u64) -> Self {
        let mut cameras = Self {
            settings,
            views: Vec::new(),
            sent: VecDeque::new(),
            next_geometry: 0,
            mishaps: Mishaps::new(VisionModel::IDEAL, seed),
            seed,
        };
        cameras.hang(world);
        cameras
    }

    /// Cameras with the settings of `profile`, in `world`'s league.
    pub fn of(profile: Profile, unix_now: f64, world: &World, seed: u64) -> Self {
        let ours = world.parameters();
        let camera = profile.cameras(ours.camera);
        let noise = profile.noise(ours.noise);
        let compatibility = profile.compatibility(&camera);
        Self::new(
            CameraSettings { camera, noise, clock: profile.clock(unix_now), compatibility },
            world,
            seed,
        )
    }

    /// The same with the frame faults of a random world model.
    pub fn of_model(profile: Profile, unix_now: f64, world: &World, vision: VisionModel, seed: u64) -> Self {
        let mishaps = Mishaps::new(vision, seed);
        Self { mishaps, ..Self::of(profile, unix_now, world, seed) }
    }

    /// The settings in force for the next camera frames.
    pub fn settings(&self) -> &CameraSettings {
        &self.settings
    }

    /// Other noise, delay or losses from the next camera frame on; number and rate of cameras stay.
    pub fn set_realism(&mut self, camera: CameraParameters, noise: NoiseParameters) {
        let CameraParameters { count, rate, height, .. } = self.settings.camera;
        self.settings.camera = CameraParameters { count, rate, height, ..camera };
        self.settings.noise = noise;
    }

    /// Places the cameras again over a changed field.
    pub fn hang(&mut self, world: &World) {
        self.views = View::hang(&self.settings, world, self.seed);
        self.next_geometry = world.now();
    }

    /// Takes the frames due after a step; to be called after every step.
    pub fn watch(&mut self, world: &World) {
        let now = world.now();
        if let GeometryStyle::Own(every) = self.settings.compatibility.geometry
            && now >= self.next_geometry
        {
            self.next_geometry = now + ((every * 1000.0) as u64).max(1);
            let geometry = self.geometry(world, None);
            self.send(now, WrapperPacket { detection: None, geometry: Some(geometry), source: None });
        }
        let time = self.time(now);
        self.mishaps.go_on(now, world, self.settings.camera.rate);
        for i in 0..self.views.len() {
            if self.views[i].due() > now {
                continue;
            }
            let mut detection = self.views[i].look(world, &self.settings, time);
            if self.mishaps.in_gap(now) {
                continue;
            }
            self.mishaps.swap_ids(&mut detection);
            let geometry = self.attached(world, i, &detection);
            let late = (self.settings.camera.delay * 1000.0) as u64;
            let due = self.mishaps.delayed(now + late);
            self.send(due, WrapperPacket { detection: Some(detection), geometry, source: None });
        }
    }

    /// The next packet that is due by step `now`.
    pub fn poll(&mut self, now: u64) -> Option<WrapperPacket> {
        let due = self.sent.front().is_some_and(|(due, _)| *due <= now);
        due.then(|| self.sent.pop_front())?.map(|(_, packet)| packet)
    }

    /// All frames of the present world, at once and without delay: for a caller that steps the simulation.
    pub fn capture(&mut self, world: &World) -> Vec<DetectionFrame> {
        let time = self.time(world.now());
        let settings = self.settings;
        self.views.iter_mut().map(|view| view.look(world, &settings, time)).collect()
    }

    /// The geometry packet, with one camera alone or with all.
    pub fn geometry(&self, world: &World, camera: Option<usize>) -> GeometryData {
        let views = match camera {
            Some(i) => &self.views[i..=i],
            None => &self.views[..],
        };
        field::geometry(world, &self.settings.compatibility, views)
    }

    fn attached(&self, world: &World, i: usize, detection: &DetectionFrame) -> Option<GeometryData> {
        match self.settings.compatibility.geometry {
            GeometryStyle::Own(_) => None,
            GeometryStyle::EveryFrame => Some(self.geometry(world, None)),
            GeometryStyle::OneCamera(every) => {
                detection.frame_number.is_multiple_of(every).then(|| self.geometry(world, Some(i)))
            }
        }
    }

    fn time(&self, step: u64) -> f64 {
        let seconds = step as f64 * 0.001;
        match self.settings.clock {
            Clock::Simulation => seconds,
            Clock::Unix(start) => start + seconds,
        }
    }

    /// Inserts into the queue, behind packets due earlier or at the same time.
    fn send(&mut self, due: u64, mut packet: WrapperPacket) {
        // The league's list has no number for our simulator; the others leave the field out.
        packet.source =
            (self.settings.compatibility.profile == Profile::Ours).then_some(Source::Other as i32);
        let place = self.sent.partition_point(|(other, _)| *other <= due);
        self.sent.insert(place, (due, packet));
    }
}

#[cfg(test)]
mod tests;
