//! `practice`: practice on a part of the field. What cameras see outside it is ignored, and no place outside
//! it is planned. Whole mm, field frame.

use std::fmt;

use protocol::host::Directive;
use protocol::quantized::{WirePoint, WirePose, whole_mm};
use rules::Colour;
use serde::{Deserialize, Serialize};
use ssl::vision::DetectionFrame;

/// The part of the field that is practised on, in words ([`Practice`]).
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PracticeSettings {
    /// Played in: `+x`, `-x`, `+y` or `-y` for a half, or two corners `X,Y,X,Y`, mm.
    pub within: Option<String>,
    /// Left out: a rectangle in the same words.
    pub without: Option<String>,
    /// Cameras left out, with commas between.
    pub cameras: Option<String>,
}

/// The part of the field that is practised on; by default all of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Practice {
    /// The rectangle that is played in.
    within: Option<Rectangle>,
    /// A rectangle that is left out.
    without: Option<Rectangle>,
    /// Cameras that are left out, a bit each.
    cameras: u16,
}

/// A rectangle along the field's axes: least x and y, greatest x and y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Rectangle([i16; 4]);

impl Rectangle {
    /// From `X,Y,X,Y`, two opposite corners, or a half: `+x`, `-x`, `+y`, `-y`.
    fn parse(text: &str) -> Option<Self> {
        const FAR: i16 = FAR_MM;
        match text.trim() {
            "+x" => return Some(Self([0, -FAR, FAR, FAR])),
            "-x" => return Some(Self([-FAR, -FAR, 0, FAR])),
            "+y" => return Some(Self([-FAR, 0, FAR, FAR])),
            "-y" => return Some(Self([-FAR, -FAR, FAR, 0])),
            _ => {}
        }
        let numbers: Vec<i16> = text.split(',').map(|n| n.trim().parse().ok()).collect::<Option<_>>()?;
        let [x1, y1, x2, y2] = <[i16; 4]>::try_from(numbers).ok()?;
        let corners = [x1.min(x2), y1.min(y2), x1.max(x2), y1.max(y2)];
        let wide = corners[2] > corners[0] && corners[3] > corners[1];
        (wide && corners.iter().all(|mm| (-FAR..=FAR).contains(mm))).then_some(Self(corners))
    }

    /// From the words of a key, where it has any; or the key, and what it takes.
    fn of_key(key: &'static str, text: Option<&str>) -> Result<Option<Self>, (&'static str, String)> {
        let Some(text) = text else { return Ok(None) };
        Self::parse(text).map(Some).ok_or_else(|| {
            (key, format!("`{text}` is no rectangle; two corners in mm as X,Y,X,Y, or +x, -x, +y, -y"))
        })
    }

    fn holds(self, [x, y]: [i32; 2]) -> bool {
        let [x0, y0, x1, y1] = self.0.map(i32::from);
        (x0..=x1).contains(&x) && (y0..=y1).contains(&y)
    }

    /// The nearest place in it.
    fn nearest(self, at: WirePoint) -> WirePoint {
        let [x0, y0, x1, y1] = self.0;
        WirePoint { x: at.x.clamp(x0, x1), y: at.y.clamp(y0, y1) }
    }
}

impl fmt::Display for Rectangle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x0, y0, x1, y1] = self.0;
        write!(f, "{x0},{y0},{x1},{y1}")
    }
}

impl Practice {
    /// From the words of `team.toml`; or the key, and what it takes.
    pub fn parse(settings: &PracticeSettings) -> Result<Self, (&'static str, String)> {
        let mut cameras = 0;
        for number in settings.cameras.iter().flat_map(|text| text.split(',')) {
            let known = number.trim().parse::<u32>().ok().filter(|number| *number < u16::BITS);
            cameras |= 1
                << known.ok_or_else(|| {
                    ("practice.cameras", format!("`{number}` is no camera; 0 to 15, with commas between"))
                })?;
        }
        let within = Rectangle::of_key("practice.within", settings.within.as_deref())?;
        let without = Rectangle::of_key("practice.without", settings.without.as_deref())?;
        Ok(Self { within, without, cameras })
    }

    /// The words of it, as [`Self::parse`] reads them.
    pub fn words(&self) -> PracticeSettings {
        let cameras: Vec<_> =
            (0..u16::BITS).filter(|n| self.cameras & 1 << n != 0).map(|n| n.to_string()).collect();
        PracticeSettings {
            within: self.within.map(|area| area.to_string()),
            without: self.without.map(|area| area.to_string()),
            cameras: (!cameras.is_empty()).then(|| cameras.join(",")),
        }
    }

    /// Whether all of the field is played on.
    pub fn is_all(&self) -> bool {
        *self == Self::default()
    }

    /// Whether a place is practised on, m.
    pub fn holds(&self, at: geometry::Point<geometry::Field>) -> bool {
        let at = [whole_mm(at.x()), whole_mm(at.y())];
        self.within.is_none_or(|area| area.holds(at)) && !self.without.is_some_and(|area| area.holds(at))
    }

    fn holds_mm(&self, x: f32, y: f32) -> bool {
        self.holds(geometry::Point::new(x * 0.001, y * 0.001))
    }

    /// Takes out of a camera frame what is not practised on, but for robots of `ours` a little outside: one
    /// that is not seen gets no order, and would never come back.
    pub fn filter(&self, frame: &mut DetectionFrame, ours: Colour) {
        let seen = frame.camera_id >= u16::BITS || self.cameras & 1 << frame.camera_id == 0;
        frame.balls.retain(|ball| seen && self.holds_mm(ball.x, ball.y));
        for (colour, robots) in
            [(Colour::Blue, &mut frame.robots_blue), (Colour::Yellow, &mut frame.robots_yellow)]
        {
            robots.retain(|robot| {
                seen && (self.holds_mm(robot.x, robot.y) || colour == ours && self.is_near(robot.x, robot.y))
            });
        }
    }

    /// Whether a place, mm, is within [`OURS_BEYOND_MAX_MM`] of one that is practised on.
    fn is_near(&self, x: f32, y: f32) -> bool {
        let at = WirePoint { x: x as i16, y: y as i16 };
        let mut inside = at;
        self.bound(&mut inside);
        let (dx, dy) = (i32::from(at.x) - i32::from(inside.x), i32::from(at.y) - i32::from(inside.y));
        dx * dx + dy * dy <= OURS_BEYOND_MAX_MM * OURS_BEYOND_MAX_MM
    }

    /// The directive with its places moved to the nearest ones that are practised on. Cases are not played: a
    /// robot that would choose one stands.
    pub fn bounded(&self, mut directive: Directive) -> Directive {
        if self.is_all() {
            return directive;
        }
        match &mut directive {
            Directive::Stand | Directive::GetBall { face: None } => {}
            Directive::GoTo { pose } | Directive::Dribble { pose } => self.bound(&mut pose.at),
            Directive::GetBall { face: Some(at) }
            | Directive::Kick { at, .. }
            | Directive::Pass { at, .. }
            | Directive::PlaceBall { at } => self.bound(at),
            Directive::Receive { at, then } => {
                [Some(at), then.as_mut()].into_iter().flatten().for_each(|at| self.bound(at));
            }
            Directive::Block { from, to } => [from, to].into_iter().for_each(|at| self.bound(at)),
            Directive::Gameplay { .. } => directive = Directive::Stand,
        }
        directive
    }

    /// The directive, or for a robot that would stand outside the way to the nearest place that is practised
    /// on.
    pub fn called_back(&self, directive: Directive, pose: geometry::Pose<geometry::Field>) -> Directive {
        if directive != Directive::Stand || self.holds(pose.position) {
            return directive;
        }
        let mut pose = WirePose::from(pose);
        self.bound(&mut pose.at);
        Directive::GoTo { pose }
    }

    /// Into the rectangle, and out of the one that is left out over its nearest edge.
    fn bound(&self, at: &mut WirePoint) {
        let inside = self.within.map_or(*at, |area| area.nearest(*at));
        *at = inside;
        let Some(Rectangle([x0, y0, x1, y1])) =
            self.without.filter(|area| area.holds([inside.x.into(), inside.y.into()]))
        else {
            return;
        };
        let beside = [
            WirePoint { x: x0.saturating_sub(1), ..inside },
            WirePoint { x: x1.saturating_add(1), ..inside },
            WirePoint { y: y0.saturating_sub(1), ..inside },
            WirePoint { y: y1.saturating_add(1), ..inside },
        ];
        let free = beside.into_iter().filter(|at| self.within.is_none_or(|area| area.nearest(*at) == *at));
        let nearest = free.min_by_key(|at| {
            i32::from(at.x).abs_diff(inside.x.into()) + i32::from(at.y).abs_diff(inside.y.into())
        });
        *at = nearest.unwrap_or(inside);
    }
}

/// A robot of ours this far outside has slid or was pushed there, mm: from 3 m/s it stops in 1.3 m, 0.1 to
/// 0.2 s after the ball that it follows is outside. Farther away it is another team's that practises beside
/// us in our colour.
const OURS_BEYOND_MAX_MM: i32 = 2000;
/// No field reaches farther, mm.
const FAR_MM: i16 = 20_000;

#[cfg(test)]
mod tests {
    use geometry::Point;
    use protocol::RobotId;
    use protocol::host::KickOrder;
    use protocol::quantized::WirePose;
    use ssl::vision::{DetectionBall, DetectionRobot};

    use super::*;

    fn practice(within: &str, without: &str) -> Practice {
        let text = |text: &str| (!text.is_empty()).then(|| text.to_owned());
        let settings =
            PracticeSettings { within: text(within), without: text(without), cameras: Some("2".to_owned()) };
        Practice::parse(&settings).expect("words")
    }

    #[test]
    fn places_go_to_the_nearest_that_is_left_and_detections_elsewhere_are_ignored() {
        let half = practice("+x", "1000,-500,2000,500");
        for (from, to) in [
            ([-700, 100], [0, 100]),
            ([1900, 0], [2001, 0]),
            ([300, 40], [300, 40]),
            ([1500, 450], [1500, 501]),
        ] {
            let mut at = WirePoint { x: from[0], y: from[1] };
            half.bound(&mut at);
            assert_eq!(at, WirePoint { x: to[0], y: to[1] });
            assert!(half.holds(Point::new(f32::from(at.x) * 0.001, f32::from(at.y) * 0.001)));
        }
        let ball = |x: f32| DetectionBall { x, ..DetectionBall::default() };
        for (camera_id, left) in [(0, 1), (2, 0), (20, 1)] {
            let balls = vec![ball(-10.0), ball(10.0), ball(1500.0)];
            let mut frame = DetectionFrame { camera_id, balls, ..DetectionFrame::default() };
            let robot = |x: f32| DetectionRobot { x, ..DetectionRobot::default() };
            frame.robots_blue = vec![robot(-2100.0), robot(-1900.0), robot(500.0)];
            frame.robots_yellow.clone_from(&frame.robots_blue);
            half.filter(&mut frame, Colour::Blue);
            assert_eq!(frame.balls.len(), left, "camera {camera_id}");
            let robots = (frame.robots_blue.len(), frame.robots_yellow.len());
            assert_eq!(robots, (2 * left, left), "ours a little outside, theirs not: camera {camera_id}");
        }
        assert_eq!(Practice::parse(&half.words()), Ok(half));
    }

    #[test]
    fn no_directive_has_a_place_outside_what_is_left() {
        let half = practice("-2000,-1500,3000,2500", "-300,-300,400,400");
        let kick = KickOrder::Flat(300);
        for step in 0..4000_i32 {
            let at = WirePoint { x: (step * 37 % 9000 - 4500) as i16, y: (step * 53 % 6000 - 3000) as i16 };
            let from = WirePoint { x: at.y, y: at.x };
            let pose = WirePose { at, heading: 0 };
            let receiver = RobotId::ZERO;
            for directive in [
                Directive::GoTo { pose },
                Directive::Dribble { pose },
                Directive::GetBall { face: Some(at) },
                Directive::Kick { at, kick },
                Directive::Pass { at, receiver, kick, ready: true },
                Directive::Receive { at, then: Some(from) },
                Directive::Block { from, to: at },
                Directive::PlaceBall { at },
            ] {
                let places = match half.bounded(directive) {
                    Directive::GoTo { pose } | Directive::Dribble { pose } => vec![pose.at],
                    Directive::GetBall { face: Some(at) }
                    | Directive::Kick { at, .. }
                    | Directive::Pass { at, .. }
                    | Directive::PlaceBall { at } => vec![at],
                    Directive::Receive { at, then: Some(then) } => vec![at, then],
                    Directive::Block { from, to } => vec![from, to],
                    other => panic!("{other:?}"),
                };
                let within =
                    |at: &WirePoint| half.holds(Point::new(f32::from(at.x) * 1e-3, f32::from(at.y) * 1e-3));
                assert!(places.iter().all(within), "{places:?}");
            }
        }
        assert_eq!(half.bounded(Directive::Gameplay { hint: None }), Directive::Stand);
        let called = |x: f32| half.called_back(Directive::Stand, geometry::Pose::from_mm_deg(x, 500.0, 0.0));
        assert_eq!(called(1000.0), Directive::Stand);
        assert!(
            matches!(called(-2500.0), Directive::GoTo { pose } if pose.at == WirePoint { x: -2000, y: 500 })
        );
    }
}
