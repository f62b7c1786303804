//! `resume`: the same run in one process, in several, on any number of threads, and after an interrupt. Plays
//! real trials: run in release.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use arena::evaluation::Shard;
use case_tools::Files;
use learning::{Evidence, JournalPlayer, Kind, LearnSettings, PlayError, json, learn};

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
        shuffle: false,
        dry_run: false,
    }
}

fn learned(directory: &Path, shard: Shard, threads: usize) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut player = JournalPlayer::open(directory, "{\"run\":1}", shard, 4, &STOPPED, &|_| {}).unwrap();
        let learned = learn(files, Evidence::default(), &settings(), &mut player).unwrap();
        json(&learned).to_string() + &learned.evidence.to_jsonl()
    })
}

#[test]
fn threads_shards_and_interrupts_change_nothing() {
    let one = directory("one");
    let first = learned(&one, Shard::WHOLE, 1);
    assert!(first.contains("\"unconfirmed\"") || first.contains("\"screened-out\""));

    let two = directory("two");
    let text = fs::read(one.join("journal-1-of-1.jsonl")).unwrap();
    // Killed in the middle of a line, at a third of the run.
    fs::write(two.join("journal-1-of-1.jsonl"), &text[..text.len() / 3]).unwrap();
    assert_eq!(learned(&two, Shard::WHOLE, 2), first, "two threads, killed and resumed");

    let shared = directory("shared");
    let shards = [1, 2].map(|i| Shard::new(i, 2).unwrap());
    let results = std::thread::scope(|scope| {
        let shared = &shared;
        let handles = shards.map(|shard| scope.spawn(move || learned(shared, shard, 1)));
        handles.map(|handle| handle.join().unwrap())
    });
    assert_eq!(results, [first.clone(), first], "two shards");

    let other = JournalPlayer::open(&one, "{\"run\":2}", Shard::WHOLE, 4, &STOPPED, &|_| {});
    assert!(matches!(other, Err(PlayError::OtherRun(_))));
    for directory in [one, two, shared] {
        fs::remove_dir_all(directory).unwrap();
    }
}
