//! `camera`: cameras and their vision packets, with a frame rate, delay and noise of their own, in
//! SSL-Vision's format.
//!
//! Each camera takes its pictures by itself, numbers them by itself and errs by its own stream of chance; a packet waits its
//! delay and is then due. Times on the wire are exact milliseconds of the simulation, on the clock that was asked for.

mod field;
mod mishaps;
mod view;

use std::collections::VecDeque;

use ssl::vision::{DetectionFrame, GeometryData, Source, WrapperPacket};

use super::World;
use super::parameters::{CameraParameters, NoiseParameters};
use super::quirks::{Clock, GeometryStyle, Profile, Quirks};
use super::worlds::VisionModel;
use mishaps::Mishaps;
use view::View;

/// Everything that decides what cameras send.
#[derive(Clone, Copy, Debug)]
pub struct CameraSettings {
    /// How many, how fast, how late.
    pub camera: CameraParameters,
    /// How wrong.
    pub noise: NoiseParameters,
    /// Which time they tell.
    pub clock: Clock,
    /// Whose manners they have.
    pub quirks: Quirks,
}

/// The cameras over one field.
#[derive(Clone, Debug)]
pub struct Cameras {
    settings: CameraSettings,
    views: Vec<View>,
    /// By the step they are due in.
    sent: VecDeque<(u64, WrapperPacket)>,
    next_geometry: u64,
    mishaps: Mishaps,
    seed: u64,
}

impl Cameras {
    /// Cameras over `world`'s field; chance comes from `seed`.
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

    /// As `profile` has it, in `world`'s league.
    pub fn of(profile: Profile, unix_now: f64, world: &World, seed: u64) -> Self {
        let ours = world.parameters();
        let camera = profile.cameras(ours.camera);
        let noise = profile.noise(ours.noise);
        let quirks = profile.quirks(&camera);
        Self::new(CameraSettings { camera, noise, clock: profile.clock(unix_now), quirks }, world, seed)
    }

    /// The same with what befalls frames in a world of the family.
    pub fn of_model(profile: Profile, unix_now: f64, world: &World, vision: VisionModel, seed: u64) -> Self {
        let mishaps = Mishaps::new(vision, seed);
        Self { mishaps, ..Self::of(profile, unix_now, world, seed) }
    }

    /// The settings.
    pub fn settings(&self) -> &CameraSettings {
        &self.settings
    }

    /// Other noise, delay or losses from the next picture on; the number and rate of cameras stay.
    pub fn set_realism(&mut self, camera: CameraParameters, noise: NoiseParameters) {
        let CameraParameters { count, rate, height, .. } = self.settings.camera;
        self.settings.camera = CameraParameters { count, rate, height, ..camera };
        self.settings.noise = noise;
    }

    /// Hangs the cameras anew over a field that has changed.
    pub fn hang(&mut self, world: &World) {
        self.views = View::hang(&self.settings, world, self.seed);
        self.next_geometry = world.now();
    }

    /// Looks at the world as it is after a step; to be called after every step.
    pub fn watch(&mut self, world: &World) {
        let now = world.now();
        if let GeometryStyle::Own(every) = self.settings.quirks.geometry
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

    /// All frames that would be taken of the world as it is, at once and without delay: for those who step the simulation.
    pub fn snapshot(&mut self, world: &World) -> Vec<DetectionFrame> {
        let time = self.time(world.now());
        let settings = self.settings;
        self.views.iter_mut().map(|view| view.look(world, &settings, time)).collect()
    }

    /// The description of the field; of one camera alone, or of all.
    pub fn geometry(&self, world: &World, camera: Option<usize>) -> GeometryData {
        let views = match camera {
            Some(i) => &self.views[i..=i],
            None => &self.views[..],
        };
        field::geometry(world, &self.settings.quirks, views)
    }

    fn attached(&self, world: &World, i: usize, detection: &DetectionFrame) -> Option<GeometryData> {
        match self.settings.quirks.geometry {
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

    /// Into the queue, behind what is due before or with it.
    fn send(&mut self, due: u64, mut packet: WrapperPacket) {
        // The league's list has no number for us; the others leave the field out.
        packet.source = (self.settings.quirks.profile == Profile::Ours).then_some(Source::Other as i32);
        let place = self.sent.partition_point(|(other, _)| *other <= due);
        self.sent.insert(place, (due, packet));
    }
}

#[cfg(test)]
mod tests;
