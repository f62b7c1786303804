//! `resume`: the same run in one process, in several, on any number of threads, and after an interrupt. Plays
//! real trials: run in release.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use case_tools::Files;
use study::learning::{Collected, JournalPlayer, Kind, LearnSettings, PlayError, Worlds, json, learn};
use study::store::Shard;

static STOPPED: AtomicBool = AtomicBool::new(false);

fn directory(name: &str) -> PathBuf {
    let directory = std::env::temp_dir().join(format!("onetwo-learning-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).unwrap();
    directory
}

fn settings() -> LearnSettings {
    LearnSettings {
        seed: 4,
        budget: 1,
        kinds: BTreeSet::from([Kind::Scopes, Kind::New]),
        error_rate: 0.1,
        tries: 100,
        worlds: Worlds::Both,
        refused: BTreeSet::new(),
        shuffle: false,
        dry_run: false,
    }
}

fn learned(directory: &Path, shard: Shard, threads: usize) -> String {
    learned_within(directory, shard, threads, Duration::from_secs(10))
}

/// Silent shards count as absent after `patience`.
fn learned_within(directory: &Path, shard: Shard, threads: usize, patience: Duration) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let player = JournalPlayer::open(directory, "{\"run\":1}", shard, 4, &STOPPED, &|_| {}).unwrap();
        let mut player = player.with_patience(patience);
        let learned = learn(files, Collected::default(), &settings(), &mut player).unwrap();
        json(&learned).to_string() + &learned.evidence.to_jsonl()
    })
}

/// The run in one process on one thread, which all others are compared with.
struct Alone {
    learned: String,
    journal: Vec<u8>,
}

static ALONE: LazyLock<Alone> = LazyLock::new(|| {
    let directory = directory("alone");
    let learned = learned(&directory, Shard::WHOLE, 1);
    let journal = fs::read(directory.join("journal-1-of-1.jsonl")).unwrap();
    fs::remove_dir_all(directory).unwrap();
    Alone { learned, journal }
});

#[test]
fn threads_shards_and_interrupts_change_nothing() {
    let Alone { learned: first, journal: text } = &*ALONE;
    assert!(first.contains("\"unconfirmed\"") || first.contains("\"screened-out\""));

    let two = directory("two");
    // Killed in the middle of a line, at a third of the run.
    fs::write(two.join("journal-1-of-1.jsonl"), &text[..text.len() / 3]).unwrap();
    assert_eq!(learned(&two, Shard::WHOLE, 2), *first, "two threads, killed and resumed");

    let shared = directory("shared");
    let shards = [1, 2].map(|i| Shard::new(i, 2).unwrap());
    let results = std::thread::scope(|scope| {
        let shared = &shared;
        let handles = shards.map(|shard| scope.spawn(move || learned(shared, shard, 1)));
        handles.map(|handle| handle.join().unwrap())
    });
    assert_eq!(results, [first.clone(), first.clone()], "two shards");

    let other: Result<JournalPlayer<'_>, _> =
        JournalPlayer::open(&two, "{\"run\":2}", Shard::WHOLE, 4, &STOPPED, &|_| {});
    let error = other.unwrap_err();
    assert!(matches!(error, PlayError::OtherRun(..)), "{error}");
    assert!(
        error
            .to_string()
            .ends_with("journal-1-of-1.jsonl is of another run: run 1, not 2; take another --out")
    );
    for directory in [two, shared] {
        fs::remove_dir_all(directory).unwrap();
    }
}

fn third(index: usize) -> Shard {
    Shard::new(index, 3).unwrap()
}

fn units_kept(directory: &Path, shard: &str) -> usize {
    fs::read_to_string(directory.join(format!("journal-{shard}.jsonl"))).unwrap().lines().count() - 1
}

#[test]
fn a_shard_that_never_starts_or_starts_last_changes_nothing() {
    let expected = &ALONE.learned;
    let units = String::from_utf8_lossy(&ALONE.journal).lines().count() - 1;

    let shared = directory("absent");
    let short = Duration::from_millis(200);
    let two = std::thread::scope(|scope| {
        let shared = &shared;
        let handles = [1, 3].map(|i| scope.spawn(move || learned_within(shared, third(i), 1, short)));
        handles.map(|handle| handle.join().unwrap())
    });
    assert_eq!(two, [expected.clone(), expected.clone()], "the second of three never starts");
    let played = units_kept(&shared, "1-of-3") + units_kept(&shared, "3-of-3");
    assert!((units..2 * units).contains(&played), "{played} units played, {units} needed");
    assert_eq!(learned(&shared, third(2), 1), *expected, "it starts when the others are over");
    assert_eq!(units_kept(&shared, "2-of-3"), 0, "and plays nothing again");
    assert_eq!(learned(&shared, Shard::WHOLE, 1), *expected, "one process reads all shards");
    assert_eq!(units_kept(&shared, "1-of-1"), 0);

    // One of three shards was played and is lost, another one is damaged, a third one of another run.
    fs::remove_file(shared.join("journal-1-of-3.jsonl")).unwrap();
    assert_eq!(learned(&shared, Shard::WHOLE, 2), *expected, "what is lost is played again");
    let damaged = shared.join("journal-2-of-3.jsonl");
    fs::write(&damaged, "{\"run\":1}\n{\"unit\":7,\n").unwrap();
    let settings = settings();
    let refused = || {
        let player = JournalPlayer::open(&shared, "{\"run\":1}", third(1), 4, &STOPPED, &|_| {}).unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let files = Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap();
        learn(files, Collected::default(), &settings, &mut { player }).unwrap_err().to_string()
    };
    let error = refused();
    assert!(error.contains("journal-2-of-3.jsonl: the line at byte 10 is no unit of trials"), "{error}");
    fs::write(&damaged, "{\"run\":1,\"world\":\"5\"}\n").unwrap();
    let error = refused();
    assert!(error.contains("journal-2-of-3.jsonl is of another run: world \"5\", not null;"), "{error}");
    fs::remove_dir_all(shared).unwrap();
}
