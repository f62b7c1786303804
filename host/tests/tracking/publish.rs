//! `publish`: tests: tracker packets contain the tracked world.

use geometry::{Point, Vector};
use host::tracking::{Publisher, Tracker};
use motion::ball::BallModel;
use motion::trajectory::Motion;
use rules::Colour::{Blue, Yellow};
use ssl::Message;
use ssl::tracker::{Capability, TeamColor, TrackerWrapperPacket};

use crate::stadium::{Stadium, Truth, play, who};

#[test]
fn a_tracker_packet_reports_robots_ball_and_kick_in_metres_on_visions_clock() {
    let mut stadium = Stadium { epoch: 1_795_220_511.0, ..Stadium::one_camera(41) };
    let from = Point::<geometry::Field>::new(-2.0, 0.0);
    let path = BallModel::default().kicked(from, Vector::new(4.0, 0.0));
    let truth = |t: f64| Truth {
        balls: vec![[f64::from(path.at((t - 1.0) as f32).position.x()), 0.0, 0.0]],
        robots: vec![(who(Yellow, 11), [-2.095, 0.0, 0.0]), (who(Blue, 0), [1.0, 2.0, -1.5])],
    };
    let (mut tracker, mut publisher) = (Tracker::default(), Publisher::new("a-b-c", "onetwo"));
    assert!(publisher.publish(&tracker).is_none(), "nothing seen yet");
    let mut frames = 0;
    play(&mut stadium, &mut tracker, (0.0, 1.5), truth, |_, tracker| {
        let bytes = publisher.publish(tracker).unwrap().encode_to_vec();
        let packet = TrackerWrapperPacket::decode(&bytes[..]).unwrap();
        assert_eq!((packet.uuid.as_str(), packet.source_name.as_deref()), ("a-b-c", Some("onetwo")));
        assert_eq!(packet.tracked_frame.unwrap().frame_number, frames);
        frames += 1;
    });
    let frame = publisher.publish(&tracker).unwrap().tracked_frame.clone().unwrap();
    let now = 1_795_220_511.0 + 89.0 / 60.0;
    assert!((frame.timestamp - now).abs() < 1e-5);
    let capabilities = [Capability::DetectFlyingBalls, Capability::DetectKickedBalls].map(|c| c as i32);
    assert_eq!(frame.capabilities, capabilities);
    let ids: Vec<_> =
        frame.robots.iter().map(|robot| (robot.robot_id.team_color, robot.robot_id.id)).collect();
    assert_eq!(ids, [(TeamColor::Yellow as i32, 11), (TeamColor::Blue as i32, 0)]);
    assert!((frame.robots[1].pos.y - 2.0).abs() < 0.01 && (frame.robots[1].orientation + 1.5).abs() < 0.05);
    assert_eq!(frame.balls.len(), 1);
    let rolled = path.at(89.0 / 60.0 - 1.0);
    assert!((frame.balls[0].pos.x - rolled.position.x()).abs() < 0.01);
    assert!((frame.balls[0].vel.unwrap().x - rolled.velocity.x()).abs() < 0.1);
    let kick = frame.kicked_ball.unwrap();
    assert_eq!(kick.robot_id.map(|id| (id.team_color, id.id)), Some((TeamColor::Yellow as i32, 11)));
    assert!((kick.pos.x + 2.0).abs() < 0.05 && (kick.vel.x - 4.0).abs() < 0.2 && kick.vel.z == 0.0);
    assert!((kick.start_timestamp - (1_795_220_511.0 + 1.0)).abs() < 0.02, "{kick:?}");
    let ends = 1_795_220_511.0 + 1.0 + f64::from(path.duration());
    assert!((kick.stop_timestamp.unwrap() - ends).abs() < 0.5, "{kick:?}");
    assert!((kick.stop_pos.unwrap().x - path.rest().x()).abs() < 0.4, "{kick:?}");
}
