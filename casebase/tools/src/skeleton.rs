//! `skeleton`: draft of a case file for a given situation. A file to author from; mm, field frame.
//!
//! Robots and opponents stand at the problem's positions; the robot nearest to the ball gets it. Its further
//! actions are the first plan that the checks pass, preferably without a warning, and whose case is retrieved
//! from the problem itself: a kick of the league whose path is free, else a dribble.

use std::fmt::Write as _;

use casebase::{
    FieldMm, GoalEnd, KickAim, OPPONENTS_MAX, PointMm, Problem, RetrievalSettings, TEAMMATES_MAX,
    retrieve_best,
};
use protocol::RobotId;

use crate::files::{Files, SourceFile};
use crate::league::CaseLeague;
use crate::library::build;
use foreign::Finding;

/// A drafted case file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skeleton {
    /// The text of the file.
    pub text: String,
    /// Differences from the problem: robots that were left out, and robots that were moved inside the field.
    /// Sentences, also in the file.
    pub notes: Vec<String>,
    /// The findings of `cases check` on it.
    pub findings: Vec<Finding>,
    /// True if the case is retrieved from the problem, as the only one.
    pub retrieved: bool,
}

/// Reason why there is no draft.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SkeletonError {
    /// The problem has no robot of ours, and a case needs one.
    NoTeammate,
    /// The league's `league.toml` is refused.
    League(Vec<Finding>),
}

/// A case file for the situation of a problem, in the league of `rules`.
pub fn skeleton(rules: &SourceFile, problem: &Problem) -> Result<Skeleton, SkeletonError> {
    let (league, findings) = CaseLeague::read(rules);
    let league = league.ok_or(SkeletonError::League(findings))?;
    if problem.teammates.is_empty() {
        return Err(SkeletonError::NoTeammate);
    }
    let scene = Scene::new(problem, league.field);
    let made: Vec<_> =
        plans(&league, &scene).iter().map(|plan| tried(rules, problem, &scene, plan)).collect();
    let usable = |made: &&Skeleton| made.retrieved;
    let best = made.iter().filter(usable).find(|made| made.findings.is_empty());
    // The dribble comes last and is kept with all its findings.
    let best = best.or_else(|| made.iter().find(usable)).or(made.last());
    best.cloned().ok_or(SkeletonError::NoTeammate)
}

/// The part of a problem that a case can contain: the robots nearest to the ball, inside the field.
struct Scene {
    defending: GoalEnd,
    ball: PointMm,
    teammates: Vec<(RobotId, PointMm)>,
    opponents: Vec<PointMm>,
    field: FieldMm,
    notes: Vec<String>,
}

impl Scene {
    fn new(problem: &Problem, field: FieldMm) -> Self {
        let ball = problem.ball;
        let mut teammates = problem.teammates.to_vec();
        teammates.sort_by_key(|(id, at)| (square(*at, ball), id.number()));
        let mut opponents: Vec<(usize, PointMm)> = (1..).zip(problem.opponents.iter().copied()).collect();
        opponents.sort_by_key(|(number, at)| (square(*at, ball), *number));
        let robots = teammates.split_off(teammates.len().min(TEAMMATES_MAX));
        let others = opponents.split_off(opponents.len().min(OPPONENTS_MAX));
        let mut notes = Vec::new();
        notes.extend(left_out("robot", robots.iter().map(|(id, _)| id), TEAMMATES_MAX));
        notes.extend(left_out("opponent", others.iter().map(|(number, _)| number), OPPONENTS_MAX));
        let mut inside = |who: String, at: PointMm| {
            let moved = field.clamp(at);
            if moved != at {
                notes.push(format!("moved inside the field: {who} from [{}, {}]", at.x, at.y));
            }
            moved
        };
        Self {
            defending: problem.defending,
            ball: inside("the ball".to_owned(), ball),
            teammates: teammates
                .into_iter()
                .map(|(id, at)| (id, inside(format!("robot {id}"), at)))
                .collect(),
            opponents: opponents.into_iter().map(|(n, at)| inside(format!("opponent {n}"), at)).collect(),
            field,
            notes,
        }
    }

    fn toml(&self, plan: &str) -> String {
        let Self { ball, defending, .. } = self;
        let mut text =
            String::from("# A first draft from one situation: edit it. mm, whole degrees, field frame.\n");
        for note in &self.notes {
            let _ = writeln!(text, "# {note}.");
        }
        let scope = [BALL_SCOPE_X, BALL_SCOPE_Y].map(|part| part.of(self.field.length));
        let _ = write!(
            text,
            "\nintent = \"A first draft: say in a sentence what the case is for.\"\n\
             defending = \"{}\"\n\
             # scope = [x, y]: how far off the ball may lie for the case to apply.\n\
             ball = {{ at = {}, scope = {scope:?} }}\n",
            defending.label(),
            point(*ball),
        );
        for (number, (id, at)) in (1..).zip(&self.teammates) {
            let (who, gameplay) = if number == 1 {
                (", the nearest to the ball", plan.to_owned())
            } else {
                ("; give it something to do", format!("{{ turn = {{ face = {} }} }}", point(*ball)))
            };
            let _ = write!(
                text,
                "\n# tm{number}: robot {id} of the situation{who}.\n[[teammates]]\nat = {}\ngameplay = [{gameplay}]\n",
                point(*at)
            );
        }
        let scope = OPPONENT_SCOPE.of(self.field.length);
        for (number, at) in (1..).zip(&self.opponents) {
            let _ = write!(
                text,
                "\n# opp{number}: keep those that justify the gameplay.\n[[opponents]]\nat = {}\nscope = [{scope}, {scope}]\n",
                point(*at)
            );
        }
        text
    }
}

/// Note of the robots that a case has no room for; none where there are none.
fn left_out(who: &str, names: impl Iterator<Item = impl ToString>, most: usize) -> Option<String> {
    let names: Vec<_> = names.map(|name| name.to_string()).collect();
    let names = (!names.is_empty()).then(|| names.join(", "))?;
    Some(format!("left out, as a case has {most} at most and they are farther off: {who} {names}"))
}

/// Possible plans of the robot at the ball, the likeliest first: in the attacking half at the goal, else
/// straight ahead.
fn plans(league: &CaseLeague, scene: &Scene) -> Vec<String> {
    let attacks = scene.defending.attack_sign() * scene.ball.x > 0;
    let mut kicks: Vec<_> = league.kicks.iter().collect();
    kicks.sort_by_key(|(_, kick)| match kick.aim {
        KickAim::Goal { offset_mm } => (!attacks, offset_mm.abs(), 0),
        KickAim::Heading { degrees, length_mm } => (attacks, degrees.abs(), -length_mm),
    });
    let mut plans = Vec::new();
    for (name, _) in kicks {
        plans.push(format!("\"get_ball\", {{ kick = {} }}", toml::Value::from(name.as_str())));
    }
    let ahead = PointMm::new(scene.defending.attack_sign() * DRIBBLE.of(scene.field.length), 0);
    plans.push(format!(
        "\"get_ball\", {{ dribble_to = {} }}",
        point(scene.field.clamp(scene.ball.plus(ahead)))
    ));
    plans
}

fn tried(rules: &SourceFile, problem: &Problem, scene: &Scene, plan: &str) -> Skeleton {
    let text = scene.toml(plan);
    let (findings, retrieved) = match build(&Files::from_texts("new", &rules.text, &[("draft/new", &text)])) {
        Ok(library) => {
            let best = retrieve_best(&library.base(), problem, &RetrievalSettings::default());
            // Warnings about the league do not concern the draft.
            let of_case = |finding: &Finding| finding.file.ends_with("draft/new.toml");
            (library.findings.iter().filter(|finding| of_case(finding)).cloned().collect(), best.is_some())
        }
        Err(findings) => (findings, false),
    };
    Skeleton { text, notes: scene.notes.clone(), findings, retrieved }
}

fn point(at: PointMm) -> String {
    format!("[{}, {}]", at.x, at.y)
}

/// Squared distance of two points, mm².
fn square(a: PointMm, b: PointMm) -> i128 {
    let [dx, dy] = [i128::from(a.x) - i128::from(b.x), i128::from(a.y) - i128::from(b.y)];
    dx * dx + dy * dy
}

/// A share of the field's length.
#[derive(Clone, Copy)]
struct Share {
    part: i32,
    least_mm: i32,
    most_mm: i32,
}

impl Share {
    fn of(self, length: i32) -> i32 {
        (length / self.part / 10 * 10).clamp(self.least_mm, self.most_mm)
    }
}

/// 450 × 300 mm on the four-legged field, the average of the built-in cases; below the size that the checks
/// call large.
const BALL_SCOPE_X: Share = Share { part: 12, least_mm: 10, most_mm: 900 };
const BALL_SCOPE_Y: Share = Share { part: 18, least_mm: 10, most_mm: 700 };
/// 300 mm on the four-legged field: the example of docs/case-format.md §1.
const OPPONENT_SCOPE: Share = Share { part: 18, least_mm: 10, most_mm: 700 };
/// 540 mm on the four-legged field: a few steps.
const DRIBBLE: Share = Share { part: 10, least_mm: 10, most_mm: 1000 };
