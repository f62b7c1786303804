//! Are equal plans equal files, however they were played, and are the sums right?

use std::fs;
use std::path::PathBuf;

use host::strategy::Team;

use super::*;
use crate::evaluation::{csv_hash, merge, read, to_csv};

const GO_ON: &(dyn Fn(Progress) -> ControlFlow<()> + Sync) = &|_| ControlFlow::Continue(());

/// A folder of a test's own, gone when the test is.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("onetwo-matches-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn play(&self, shard: Shard, threads: usize) -> Vec<MatchRow> {
        let base = case_library::LEAGUES.iter().find(|league| league.name == "division-b").unwrap().base();
        let matches = Matches {
            plan: Plan {
                seed: 4,
                league: "division-b".to_owned(),
                duration_s: 4.0,
                pairings: Plan::against(&[Team::Reactive, Team::Zone]),
                matches: 2,
            },
            base,
            settings: Settings::default(),
            program: "test".to_owned(),
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| matches.play_shard(shard, &self.0.join(shard.file_name()), GO_ON)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn threads_shards_and_interrupts_change_no_byte() {
    let hash = |rows: &[MatchRow]| csv_hash(&to_csv(rows).unwrap());
    let alone = Folder::new("alone");
    let rows = alone.play(Shard::WHOLE, 1);
    assert_eq!(rows.len(), 4);
    let parts = Folder::new("parts");
    let halves = [1, 2].map(|i| {
        let shard = Shard::new(i, 2).unwrap();
        parts.play(shard, 2);
        read::<MatchRow>(&parts.0.join(shard.file_name())).unwrap().unwrap()
    });
    let (identity, merged) = merge(halves.to_vec()).unwrap();
    assert_eq!((hash(&merged), identity.plan.len()), (hash(&rows), 4));
    // The last line torn off: it is played again, the others are not.
    let file = alone.0.join(Shard::WHOLE.file_name());
    let bytes = fs::read(&file).unwrap();
    fs::write(&file, &bytes[..bytes.len() - 3]).unwrap();
    assert_eq!(hash(&alone.play(Shard::WHOLE, 2)), hash(&rows));
}

fn row(number: usize, goals: [u32; 2], halves: [f32; 2], shots: [u32; 2]) -> MatchRow {
    MatchRow {
        number,
        own: Team::Ours,
        opponent: Team::Zone,
        own_is_blue: true,
        seed: 1,
        goals: goals[0],
        goals_against: goals[1],
        ball_in_play: 0.5,
        their_half_s: halves[0],
        own_half_s: halves[1],
        shots: shots[0],
        shots_against: shots[1],
        chances: 0,
        chances_against: 0,
        possession_s: 30.0,
        possession_against_s: 10.0,
        passes: 0,
        passes_against: 0,
        losses: 0,
        losses_against: 0,
        fouls: "bot_pushed_bot:2".to_owned(),
        fouls_against: String::new(),
        trace_hash: String::new(),
    }
}

#[test]
fn ratios_goals_and_intervals_are_those_counted_by_hand() {
    let plan = Plan {
        seed: 1,
        league: "ssl-2013".to_owned(),
        duration_s: 600.0,
        pairings: Plan::against(&[Team::Zone]),
        matches: 3,
    };
    let rows = [
        row(0, [2, 0], [200.0, 100.0], [6, 2]),
        row(1, [1, 1], [100.0, 100.0], [4, 4]),
        row(2, [3, 0], [300.0, 100.0], [5, 0]),
    ];
    let outcome = outcomes(&plan, &rows).remove(0);
    assert_eq!(outcome.won_drawn_lost, [2, 1, 0]);
    assert_eq!(outcome.goals, [6, 1]);
    // 2, 1 and 3: mean 2, spread 1; t(2) at 97.5 % is 4.3027, over √3 2.4841.
    let offence = outcome.offence_ratio.unwrap();
    assert!((offence.mean - 2.0).abs() < 1e-9);
    assert!((offence.high.unwrap() - 4.4841).abs() < 1e-3 && (offence.low.unwrap() + 0.4841).abs() < 1e-3);
    // 3 and 1; the third match has none.
    let attack = outcome.attack_ratio.unwrap();
    assert!((attack.mean - 2.0).abs() < 1e-9 && attack.matches == 2);
    assert!((outcome.attack_ratio_of_all.unwrap() - 2.5).abs() < 1e-9);
    // Differences 2, 0 and 3: mean 5/3, spread 1.5275, t = 1.8898, p of two sides with 2 degrees 0.1994.
    assert!((outcome.goals_p.unwrap() - 0.1994).abs() < 1e-3, "{:?}", outcome.goals_p);
    assert!((outcome.possession.unwrap().mean - 0.75).abs() < 1e-9);
    assert_eq!(outcome.fouls[0]["bot_pushed_bot"], 6);
    let text = markdown(std::slice::from_ref(&outcome));
    assert!(text.contains("| ours | zone | 3 | 2, 1, 0 | 6 : 1 |"), "{text}");
    assert!(plot(&[outcome]).contains("ours – zone"));
}

#[test]
fn the_papers_rows_are_those_it_printed() {
    let goals = PAPER.iter().fold([0, 0], |sum, game| [sum[0] + game.goals[0], sum[1] + game.goals[1]]);
    // Without the game against an empty field and without shoot-outs.
    assert_eq!(goals, [20, 3]);
    assert_eq!(PAPER_PASSES.iter().map(|row| row.attempts).sum::<u32>(), 48);
    assert_eq!(PAPER_PASSES.iter().map(|row| row.successes).sum::<u32>(), 37);
}
