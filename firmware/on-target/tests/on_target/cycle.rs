//! `cycle`: tests: a robot goes through its cycle as in the paper's Fig. 10. A walking robot alone with the
//! ball, with synthetic sensor frames.

#[embedded_test::tests]
mod tests {
    use brain::{Brain, BrainConfig};
    use geometry::{Angle, Point, Pose};
    use heapless::Vec;
    use protocol::robot_io::{ActuatorFrame, BallSight, SensorFrame};
    use protocol::team::{AbortReason, Closure, Decision, Progress, TeamMessage};
    use protocol::{Duration, Instant, RobotId, TeamId};

    /// A brain step of a walking robot (docs/architecture.md §2.3).
    const STEP: Duration = Duration::millis(40);

    #[test]
    fn a_robot_listens_adapts_executes_and_leaves_a_case_whose_ball_has_gone() {
        let mut robot = Robot::new();
        let mut changes = Vec::<Progress, 8>::new();
        let mut first_at = None;
        // Behind the ball, which lies before the goal; the robot has not reached it yet.
        for _ in 0..75 {
            let before = robot.now;
            if let Some(progress) = robot.step(Point::new(1.2, 0.0), Point::new(1.6, 0.0))
                && changes.last().copied().map(kind) != Some(kind(progress))
            {
                if matches!(progress, Progress::Adapt { .. }) {
                    first_at.get_or_insert(before);
                }
                changes.push(progress).expect("few changes");
            }
        }
        // It listens for one lease, 400 ms, before it proposes (docs/architecture.md §5.1).
        assert!(first_at.is_some_and(|at| at >= Instant(400_000)), "{first_at:?}: {changes:?}");
        assert_eq!(
            changes.iter().take(2).copied().map(kind).collect::<Vec<_, 2>>()[..],
            [0, 1],
            "{changes:?}"
        );
        assert!(robot.playing, "a case was chosen");
        // Now it stands beside the ball: it executes.
        for _ in 0..50 {
            robot.step(Point::new(1.45, 0.0), Point::new(1.6, 0.0));
            if robot.progress.is_some_and(|progress| kind(progress) == 2) {
                break;
            }
        }
        assert_eq!(robot.progress.map(kind), Some(2), "{:?}", robot.progress);
        // The ball is taken away, to the other end of the field.
        for _ in 0..25 {
            robot.step(Point::new(1.45, 0.0), Point::new(-2.2, 1.0));
        }
        assert_eq!(robot.ends.first(), Some(&AbortReason::BallOutOfScope), "{:?}", robot.ends);
    }

    fn kind(progress: Progress) -> u8 {
        match progress {
            Progress::Idle => 0,
            Progress::Adapt { .. } => 1,
            Progress::Execute { .. } => 2,
            Progress::WaitEnd { .. } => 3,
        }
    }

    struct Robot {
        brain: Brain<'static>,
        now: Instant,
        progress: Option<Progress>,
        playing: bool,
        ends: Vec<AbortReason, 8>,
    }

    impl Robot {
        fn new() -> Self {
            let id = RobotId::new(1).expect("an id");
            let config = BrainConfig::new(id, TeamId(0));
            let brain = Brain::new(Instant(0), &config, case_library::four_legged());
            Self { brain, now: Instant(0), progress: None, playing: false, ends: Vec::new() }
        }

        /// One step of the brain; the progress it reported, if any.
        fn step(&mut self, at: Point<geometry::Field>, ball: Point<geometry::Field>) -> Option<Progress> {
            self.now = Instant(self.now.0 + STEP.0);
            while let Some(due) = self.brain.poll_timeout().filter(|due| *due <= self.now) {
                self.brain.handle_timeout(due);
            }
            let sensors = SensorFrame {
                pose: Some(Pose { position: at, heading: Angle::ZERO }),
                ball: Some(BallSight { position: ball, sigma: 0.01, age: Duration(0) }),
                ..SensorFrame::default()
            };
            self.brain.handle_sensors(self.now, &sensors);
            let mut progress = None;
            while let Some(message) = self.brain.poll_message(self.now) {
                let TeamMessage::Beacon(beacon) = message else { continue };
                progress = Some(beacon.progress);
                match beacon.cycle.map(|cycle| cycle.decision) {
                    Some(Decision::Play(_)) => self.playing = true,
                    Some(Decision::Closed(Closure::Aborted { reason, .. }))
                        if self.ends.last() != Some(&reason) =>
                    {
                        self.ends.push(reason).expect("few ends");
                    }
                    _ => {}
                }
            }
            let order = self.brain.poll_actuators(self.now);
            assert!(matches!(order, Some(ActuatorFrame::Legged { .. })), "an order every step");
            self.progress = progress.or(self.progress);
            progress
        }
    }
}
