//! `common`: test helpers: libraries and problems, written out or from a small seeded stream.
#![allow(dead_code, reason = "every test file takes the part it needs")]

use std::fmt::Write as _;

use case_tools::{Files, Library, build};
use casebase::{Case, GoalEnd, PointMm, Problem};
use protocol::RobotId;

pub(crate) const LEAGUE: &str = r#"
[field]
length = 5400
width = 3600
margin = 300
goal_width = 800
penalty_area = { depth = 650, width = 1300 }

[pass]
r_min = 100
r_max = 300

[kicks.forward]
heading_deg = 0
length = 1000
r_min = 100
r_max = 300
primitive = "forward_soft"

[kicks.left]
heading_deg = 75
length = 900
r_min = 80
r_max = 250

[kicks.right]
heading_deg = -75
length = 900
r_min = 80
r_max = 250

[kicks.goal]
aim = "goal"
r_min = 100
r_max = 350

[kicks.goal_left]
aim = "goal"
offset = 250
r_min = 60
r_max = 200

[kicks.goal_right]
aim = "goal"
offset = -250
r_min = 60
r_max = 200
"#;

/// The example of docs/case-format.md §1.
pub(crate) const PASS_AROUND: &str = r#"intent = "Two attackers at the centre line, a defender ahead: pass around it and shoot."
defending = "yellow"
ball = { at = [-600, 0], scope = [450, 250] }

[[teammates]]
at = [-720, 0]
gameplay = ["get_ball", { pass_ball = 2 }]

[[teammates]]
at = [300, 900]
gameplay = ["wait", { receive_ball = 1 }, { kick = "goal" }]

[[opponents]]
at = [-150, -35]
scope = [300, 225]
"#;

/// A library from memory; a finding ends the test.
pub(crate) fn library(cases: &[(&str, &str)]) -> Library {
    build(&Files::from_texts("test", LEAGUE, cases)).unwrap_or_else(|findings| {
        let texts: Vec<_> = findings.iter().map(ToString::to_string).collect();
        panic!("{}", texts.join("\n"))
    })
}

/// One robot at the ball's position that gets the ball and then does `rest`.
pub(crate) fn single(ball: &str, scope: &str, rest: &str) -> String {
    format!(
        "intent = \"one\"\ndefending = \"yellow\"\nball = {{ at = {ball}, scope = {scope} }}\n\
         [[teammates]]\nat = {ball}\ngameplay = [\"get_ball\"{rest}]\n"
    )
}

pub(crate) fn problem(ball: (i32, i32), teammates: &[(u8, (i32, i32))], opponents: &[(i32, i32)]) -> Problem {
    let point = |(x, y): (i32, i32)| PointMm::new(x, y);
    Problem {
        ball: point(ball),
        defending: GoalEnd::Negative,
        teammates: teammates.iter().map(|(id, at)| (RobotId::new(*id).unwrap(), point(*at))).collect(),
        opponents: opponents.iter().map(|at| point(*at)).collect(),
    }
}

/// xorshift64*: enough for drawing test situations.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// From 0 to `end` − 1.
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % end
    }

    pub(crate) fn between(&mut self, low: i32, high: i32) -> i32 {
        low + self.below((high - low + 1) as u64) as i32
    }

    fn place(&mut self) -> (i32, i32) {
        (self.between(-2700, 2700), self.between(-1800, 1800))
    }

    fn near(&mut self, (x, y): (i32, i32), by: i32) -> (i32, i32) {
        let moved = (x + self.between(-by, by), y + self.between(-by, by));
        (moved.0.clamp(-2700, 2700), moved.1.clamp(-1800, 1800))
    }

    fn kick(&mut self) -> &'static str {
        ["forward", "left", "right", "goal", "goal_left", "goal_right"][self.below(6) as usize]
    }

    /// The text of a random case that passes every check. Robots and opponents stand around the ball.
    pub(crate) fn case(&mut self) -> String {
        let robots = self.between(1, 4);
        let ball = self.place();
        let (sx, sy) = (self.between(100, 900), self.between(100, 700));
        let defending = ["yellow", "cyan"][self.below(2) as usize];
        let mut text = format!(
            "intent = \"drawn\"\ndefending = \"{defending}\"\nball = {{ at = [{}, {}], scope = [{sx}, {sy}] }}\n",
            ball.0, ball.1
        );
        // The ball goes from robot to robot by passes; some dribble, some walk before they receive, the last
        // may kick and chase.
        for robot in 1..=robots {
            let at = self.near(ball, 1200);
            let mut plan = Vec::new();
            if robot == 1 {
                plan.push("\"get_ball\"".to_owned());
            } else {
                plan.push("\"wait\"".to_owned());
                if self.below(3) == 0 {
                    let to = self.place();
                    plan.push(format!("{{ go_to_point = [{}, {}] }}", to.0, to.1));
                }
                plan.push(format!("{{ receive_ball = {} }}", robot - 1));
            }
            if self.below(3) == 0 {
                let to = self.near(ball, 900);
                plan.push(format!("{{ dribble_to = [{}, {}] }}", to.0, to.1));
            }
            if self.below(4) == 0 {
                plan.push(format!("{{ turn = {{ heading_deg = {} }} }}", self.between(-90, 90)));
            }
            if robot < robots {
                plan.push(format!("{{ pass_ball = {} }}", robot + 1));
            } else {
                plan.push(format!("{{ kick = \"{}\" }}", self.kick()));
                if self.below(3) == 0 {
                    plan.push(format!("\"get_ball\", {{ kick = \"{}\" }}", self.kick()));
                }
            }
            write!(text, "[[teammates]]\nat = [{}, {}]\ngameplay = [{}]\n", at.0, at.1, plan.join(", "))
                .unwrap();
        }
        for _ in 0..self.below(5) {
            let at = self.near(ball, 1500);
            let (sx, sy) = (self.between(100, 600), self.between(100, 600));
            write!(text, "[[opponents]]\nat = [{}, {}]\nscope = [{sx}, {sy}]\n", at.0, at.1).unwrap();
            // Most scopes demand nothing, so that a good share of cases remain candidates.
            if let Some(presence) = ["required", "excluded"].get(self.below(8) as usize) {
                writeln!(text, "presence = \"{presence}\"").unwrap();
            }
        }
        text
    }

    pub(crate) fn library(&mut self, cases: usize) -> Library {
        let texts: Vec<_> = (0..cases).map(|i| (format!("drawn/{i:04}"), self.case())).collect();
        let borrowed: Vec<_> = texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        library(&borrowed)
    }

    /// A random problem near a random case of the base, so that a good share have several candidates.
    pub(crate) fn problem(&mut self, base: &casebase::CaseBase<'_>) -> Problem {
        let id = self.below(base.len() as u64) as u16;
        let case = base.case(protocol::CaseId(id)).expect("an id of the base");
        let scope = case.ball_scope();
        let reach = |radius: i32| radius + radius / 8;
        let ball = PointMm::new(
            case.ball().x + self.between(-reach(scope.x), reach(scope.x)),
            case.ball().y + self.between(-reach(scope.y), reach(scope.y)),
        );
        let mut ids: Vec<u8> = (0..16).collect();
        for i in 0..16 {
            ids.swap(i, self.below(16) as usize);
        }
        let mut places = self.places_near(&case, ball);
        places.truncate(1 + self.below(11) as usize);
        let opponents = (0..self.below(8)).map(|_| {
            let (x, y) = self.near((ball.x, ball.y), 2000);
            PointMm::new(x, y)
        });
        let opponents = opponents.collect();
        let teammates = places.into_iter().zip(ids).map(|(at, id)| (RobotId::new(id).unwrap(), at)).collect();
        Problem { ball, defending: case.defending(), teammates, opponents }
    }

    /// Robots near the adapted positions, and some anywhere.
    fn places_near(&mut self, case: &Case<'_>, ball: PointMm) -> Vec<PointMm> {
        let mut places: Vec<_> = case
            .robots()
            .map(|robot| {
                let at = case.adapted(robot, ball);
                PointMm::new(at.x + self.between(-700, 700), at.y + self.between(-700, 700))
            })
            .collect();
        places.extend((places.len()..11).map(|_| {
            let (x, y) = self.place();
            PointMm::new(x, y)
        }));
        places
    }
}
