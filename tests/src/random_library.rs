//! `random_library`: random valid libraries. Seeded, as TOML files like those of an author.
//!
//! Everything docs/case-format.md §1 permits occurs: 1–4 teammates, 0–4 opponents, every action, kicks by
//! heading and at the goal with their partners, plans of several legs, a later `get_ball` after a kick,
//! either goal, points outside the field, region names whose order as strings differs from that as
//! directories. Mm, whole degrees, field frame.

mod dice;
mod problems;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

pub use dice::Dice;
pub use problems::random_problem;

use crate::oracle::library::Library;

/// A league's directory before it is written.
#[derive(Clone, Debug)]
pub struct RandomLibrary {
    /// The text of `league.toml`.
    pub league: String,
    /// Case files by `region/name`.
    pub cases: BTreeMap<String, String>,
}

impl RandomLibrary {
    /// A library of `size` authored cases; the same seed gives the same bytes.
    pub fn new(seed: u64, size: usize) -> Self {
        let mut dice = Dice::new(seed);
        let league = League::random(&mut dice);
        let text = league.to_toml(&mut dice);
        let mut cases = BTreeMap::new();
        while cases.len() < size {
            let name = format!("{}/{}-{}", dice.pick(&REGIONS), dice.pick(&NAMES), dice.between(0, 999));
            let case = random_case(&mut dice, &league);
            let alone = BTreeMap::from([(name.clone(), case.clone())]);
            // A plan that another robot's earlier `get_ball` makes unplayable is drawn again.
            if Library::from_texts(&text, &alone).is_ok() {
                cases.insert(name, case);
            }
        }
        Self { league: text, cases }
    }

    /// Deletes and rewrites the directory `dir`.
    pub fn write(&self, dir: &Path) -> io::Result<()> {
        if dir.exists() {
            fs::remove_dir_all(dir)?;
        }
        fs::create_dir_all(dir)?;
        fs::write(dir.join("league.toml"), &self.league)?;
        for (name, text) in &self.cases {
            let path = dir.join(format!("{name}.toml"));
            if let Some(region) = path.parent() {
                fs::create_dir_all(region)?;
            }
            fs::write(path, text)?;
        }
        Ok(())
    }
}

/// With a `/` appended their order as strings differs from that as directory names: `-` comes before `/`.
const REGIONS: [&str; 6] = ["front", "front-side", "front2", "Back", "center", "corner"];
const NAMES: [&str; 4] = ["pass", "shot", "Run", "pass-on"];

/// The part of its league that a case uses.
struct League {
    length: i64,
    width: i64,
    kicks: Vec<String>,
    /// Tables of `kicks`, ready to print.
    kinds: Vec<String>,
}

impl League {
    fn random(dice: &mut Dice) -> Self {
        let mut league = Self {
            length: dice.between(3000, 9001),
            width: dice.between(2000, 6001),
            kicks: Vec::new(),
            kinds: Vec::new(),
        };
        league.kick(dice, "goal", "aim = \"goal\"", None);
        let ahead = format!("heading_deg = 0\nlength = {}", dice.between(200, 3000));
        league.kick(dice, "ahead", &ahead, None);
        for pair in 0..dice.between(1, 3) {
            let heading = dice.between(1, 170);
            let length = dice.between(200, 3000);
            league.kick(
                dice,
                &format!("side{pair}"),
                &format!("heading_deg = {heading}\nlength = {length}"),
                Some(&format!("heading_deg = {}\nlength = {length}", -heading)),
            );
        }
        let offset = dice.between(1, 500);
        league.kick(
            dice,
            "post",
            &format!("aim = \"goal\"\noffset = {offset}"),
            Some(&format!("aim = \"goal\"\noffset = -{offset}")),
        );
        league
    }

    /// Adds a kind, and its partner of the same radii.
    fn kick(&mut self, dice: &mut Dice, name: &str, aim: &str, partner: Option<&str>) {
        let radii = corridor(dice);
        let primitive = if dice.chance(0.3) { "primitive = \"forward_hard\"\n" } else { "" };
        for (suffix, aim) in [("", Some(aim)), ("-mirrored", partner)] {
            if let Some(aim) = aim {
                self.kicks.push(format!("{name}{suffix}"));
                self.kinds.push(format!("[kicks.{name}{suffix}]\n{aim}\n{radii}{primitive}"));
            }
        }
    }

    fn to_toml(&self, dice: &mut Dice) -> String {
        let margin = if dice.chance(0.5) { "margin = 300\n" } else { "" };
        format!(
            "[field]\nlength = {}\nwidth = {}\n{margin}goal_width = 800\n\
             penalty_area = {{ depth = 650, width = 1300 }}\n\n[pass]\n{}\n{}",
            self.length,
            self.width,
            corridor(dice),
            self.kinds.join("\n"),
        )
    }
}

fn corridor(dice: &mut Dice) -> String {
    format!("r_min = {}\nr_max = {}\n", dice.between(1, 200), dice.between(50, 500))
}

fn random_case(dice: &mut Dice, league: &League) -> String {
    let (half_x, half_y) = (league.length / 2, league.width / 2);
    // About a third of the cases lie at one place, so that several are candidates at once.
    let crowded = dice.chance(0.35);
    let reach = if crowded { 6 } else { 1 };
    let ball = (dice.between(-half_x, half_x) / reach, dice.between(-half_y, half_y) / reach);
    let around = |dice: &mut Dice, spread: i64| {
        let x = (ball.0 + dice.between(-spread, spread)).clamp(-half_x, half_x);
        let y = (ball.1 + dice.between(-spread, spread)).clamp(-half_y, half_y);
        format!("[{x}, {y}]")
    };
    let robots = dice.between(1, 4) as usize;
    let plan = random_plan(dice, league, robots);

    let defending = if dice.chance(0.7) { "yellow" } else { "cyan" };
    let mut text = format!(
        "intent = \"Drawn by lot.\"\ndefending = \"{defending}\"\nball = {{ at = [{}, {}], scope = {} }}\n",
        ball.0,
        ball.1,
        scope(dice)
    );
    for gameplay in plan {
        let at = around(dice, 1500);
        let _ = write!(text, "\n[[teammates]]\nat = {at}\ngameplay = [{}]\n", gameplay.join(", "));
    }
    for _ in 0..dice.between(0, 4) {
        let at = around(dice, 1200);
        let _ = write!(text, "\n[[opponents]]\nat = {at}\nscope = {}\n", scope(dice));
    }
    text
}

fn scope(dice: &mut Dice) -> String {
    format!("[{}, {}]", dice.between(50, 1000), dice.between(50, 1000))
}

/// One list of actions per robot, such that the plan can be played.
fn random_plan(dice: &mut Dice, league: &League, robots: usize) -> Vec<Vec<String>> {
    let mut plan: Vec<Vec<String>> = vec![Vec::new(); robots];
    let mut holder = dice.between(0, robots as i64 - 1) as usize;
    for (robot, list) in plan.iter_mut().enumerate() {
        if robot != holder {
            idle(dice, league, list);
        }
    }
    plan[holder].push("\"get_ball\"".to_owned());
    for _ in 0..dice.between(0, 6) {
        idle(dice, league, &mut plan[holder]);
        let other = dice.between(0, robots as i64 - 1) as usize;
        match dice.between(0, 3) {
            0 => {
                let to = point(dice, league);
                plan[holder].push(format!("{{ dribble_to = {to} }}"));
            }
            1 if other != holder => {
                plan[holder].push(format!("{{ pass_ball = {} }}", other + 1));
                idle(dice, league, &mut plan[other]);
                plan[other].push(format!("{{ receive_ball = {} }}", holder + 1));
                holder = other;
            }
            _ => {
                let kind = dice.pick(&league.kicks).clone();
                plan[holder].push(format!("{{ kick = \"{kind}\" }}"));
                if dice.chance(0.4) {
                    break;
                }
                idle(dice, league, &mut plan[other]);
                plan[other].push("\"get_ball\"".to_owned());
                holder = other;
            }
        }
    }
    for list in &mut plan {
        if list.is_empty() || dice.chance(0.3) {
            list.push("\"wait\"".to_owned());
        }
    }
    plan
}

/// Adds, with some probability, an action without the ball.
fn idle(dice: &mut Dice, league: &League, list: &mut Vec<String>) {
    match dice.between(0, 9) {
        0 => list.push("\"wait\"".to_owned()),
        1 | 2 => list.push(format!("{{ go_to_point = {} }}", point(dice, league))),
        3 => list.push(format!("{{ turn = {{ heading_deg = {} }} }}", dice.between(-180, 180))),
        4 => list.push(format!("{{ turn = {{ face = {} }} }}", point(dice, league))),
        _ => {}
    }
}

/// A point an action names; it may lie beyond the lines.
fn point(dice: &mut Dice, league: &League) -> String {
    let (x, y) = (league.length * 11 / 20, league.width * 11 / 20);
    format!("[{}, {}]", dice.between(-x, x), dice.between(-y, y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_determines_a_library_and_every_action_occurs() {
        let library = RandomLibrary::new(7, 60);
        assert_eq!(library.cases, RandomLibrary::new(7, 60).cases);
        assert_ne!(library.cases, RandomLibrary::new(8, 60).cases);
        let all: String = library.cases.values().cloned().collect();
        for label in ["wait", "go_to_point", "heading_deg", "face", "dribble_to", "pass_ball", "receive_ball"]
        {
            assert!(all.contains(label), "{label}");
        }
        for kind in ["\"goal\"", "\"ahead\"", "\"side0\"", "\"side0-mirrored\"", "\"post\"", "cyan"] {
            assert!(all.contains(kind), "{kind}");
        }
        let later = library.cases.values().filter(|text| text.matches("\"get_ball\"").count() > 1).count();
        assert!(later > 5, "{later} cases with a later get_ball");
    }
}
