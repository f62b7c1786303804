//! `cluster`: tests of docs/cluster/array.sh, the script of a Slurm job array, without Slurm: the variables
//! that Slurm sets for a task are set by hand. Tiny budgets.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

const EVALUATE: &[&str] =
    &["evaluate", "--opponents", "2d", "--scenario", "4", "--seed", "3", "--trials", "12", "--maps", "2"];
const MATCHES: &[&str] = &[
    "evaluate",
    "matches",
    "--duration",
    "3",
    "--matches",
    "4",
    "--seed",
    "3",
    "--opponents",
    "zone,marking",
];
const LEARN: &[&str] = &["cases", "learn", "--budget", "1", "--seed", "7", "--only", "scopes"];

/// Shards of every array here.
const OF: usize = 3;

/// A directory that is not there yet.
fn scratch(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cluster").join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(directory.parent().unwrap()).unwrap();
    directory
}

fn onetwo(command: &[&str], out: &Path) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_onetwo"));
    program.args(command).arg("--out").arg(out).output().unwrap()
}

/// The script with a command line and an output directory.
fn script(arguments: &[&str], out: &Path) -> Command {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/cluster/array.sh");
    let mut command = Command::new("bash");
    command.arg(file).args(arguments).arg("--out").arg(out);
    command
        .env("ONETWO", env!("CARGO_BIN_EXE_onetwo"))
        .env_remove("ONETWO_SHARDS")
        .env_remove("SLURM_JOB_ID");
    command.env_remove("SLURM_ARRAY_TASK_ID").env("SLURM_CPUS_PER_TASK", "1");
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// A task of an array that was submitted as `--array=FIRST-LAST`.
fn task(arguments: &[&str], out: &Path, index: usize, (first, last): (usize, usize)) -> Command {
    let mut command = script(arguments, out);
    for (name, value) in [
        ("SLURM_ARRAY_TASK_ID", index),
        ("SLURM_ARRAY_TASK_MIN", first),
        ("SLURM_ARRAY_TASK_MAX", last),
        ("SLURM_ARRAY_TASK_COUNT", last + 1 - first),
    ] {
        command.env(name, value.to_string());
    }
    command
}

/// Task `index` of the whole array.
fn of_array(arguments: &[&str], out: &Path, index: usize) -> Command {
    task(arguments, out, index, (1, OF))
}

fn merge(arguments: &[&str], out: &Path) -> Output {
    script(&[&["merge"], arguments].concat(), out).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn succeeds(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
}

/// Starts a task and kills it without warning once its file has some finished lines behind its `head`.
fn kill_midway(mut task: Command, file: &Path, head: usize) {
    let mut child = task.spawn().unwrap();
    let lines = || fs::read_to_string(file).map_or(0, |text| text.lines().count());
    while lines() <= head && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Every file below a directory but those of shards, with its bytes.
fn results(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut open = vec![directory.to_owned()];
    while let Some(folder) = open.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.strip_prefix(directory).unwrap().to_str().unwrap().to_owned();
            if path.is_dir() {
                open.push(path);
            } else if !name.starts_with("trials-") && !name.starts_with("journal-") {
                files.insert(name, fs::read(path).unwrap());
            }
        }
    }
    files
}

fn assert_equal(own: &Path, other: &Path) {
    let (own, other) = (results(own), results(other));
    assert!(own.len() > 2, "{:?}", own.keys());
    assert_eq!(own.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
    for (name, bytes) in own {
        assert!(bytes == other[&name], "{name} differs");
    }
}

/// A killed and repeated, a twice played and a lost task.
fn an_array_equals_one_run(name: &str, command: &[&str]) {
    let (one, array) = (scratch(&format!("{name}-one")), scratch(&format!("{name}-array")));
    succeeds(&onetwo(command, &one));
    let file = |index: usize| array.join(format!("trials-{index}-of-{OF}.csv"));
    for index in [3, 1, 1] {
        succeeds(&of_array(command, &array, index).output().unwrap());
    }
    kill_midway(of_array(command, &array, 2), &file(2), 2);
    // The kill may have come when all was over: the last trials are torn off.
    let kept = fs::read_to_string(file(2)).unwrap();
    let lines: Vec<_> = kept.split_inclusive('\n').collect();
    fs::write(file(2), lines[..3].concat() + &lines[2][..9]).unwrap();

    fs::remove_file(file(3)).unwrap();
    let refused = merge(command, &array);
    assert_eq!(refused.status.code(), Some(1));
    let error = stderr(&refused);
    let asked = format!("array.sh {} --out {}", command.join(" "), array.display()).replace(',', "\\,");
    for index in [2, 3] {
        assert!(error.contains(&format!("  --shard {index}/3: trials-{index}-of-3.csv lacks ")), "{error}");
        assert!(error.contains(&format!("play it: ONETWO_SHARDS=3 sbatch --array={index} ")), "{error}");
    }
    assert!(!error.contains("--shard 1/3") && error.contains(&asked), "{error}\n{asked}");
    assert!(results(&array).is_empty(), "nothing is written of a part");

    succeeds(&task(command, &array, 2, (2, 2)).env("ONETWO_SHARDS", "3").output().unwrap());
    succeeds(&of_array(command, &array, 3).output().unwrap());
    succeeds(&merge(command, &array));
    assert_equal(&one, &array);
    succeeds(&merge(command, &array));
    assert_equal(&one, &array);
}

#[test]
fn an_array_of_evaluate_gives_the_bytes_of_one_run() {
    an_array_equals_one_run("evaluate", EVALUATE);
}

#[test]
fn an_array_of_matches_gives_the_bytes_of_one_run() {
    an_array_equals_one_run("matches", MATCHES);
}

#[test]
fn an_array_of_learning_gives_the_bytes_of_one_run() {
    let (one, array) = (scratch("learn-one"), scratch("learn-array"));
    succeeds(&onetwo(LEARN, &one));
    let others = [1, 3].map(|index| of_array(LEARN, &array, index).spawn().unwrap());
    kill_midway(of_array(LEARN, &array, 2), &array.join("journal-2-of-3.jsonl"), 1);
    succeeds(&of_array(LEARN, &array, 2).output().unwrap());
    for child in others {
        succeeds(&child.wait_with_output().unwrap());
    }
    assert_equal(&one, &array);
    // The first task writes the results: it is lost with them, and so is what it has played.
    for name in ["journal-1-of-3.jsonl", "report.json", "report.html", "evidence.jsonl"] {
        fs::remove_file(array.join(name)).unwrap();
    }
    succeeds(&merge(LEARN, &array));
    assert_equal(&one, &array);
}

#[test]
fn a_second_process_on_the_same_shard_is_refused() {
    for (name, command, file, head) in [
        ("evaluate", &["evaluate", "--trials", "4000"][..], "trials-1-of-3.csv", 2),
        ("learn", &["cases", "learn", "--budget", "100000"], "journal-1-of-3.jsonl", 1),
    ] {
        let out = scratch(&format!("twice-{name}"));
        let mut first = of_array(command, &out, 1).spawn().unwrap();
        while fs::read_to_string(out.join(file)).map_or(0, |text| text.lines().count()) <= head {
            assert!(first.try_wait().unwrap().is_none(), "{name} ended before it was repeated");
            sleep(Duration::from_millis(5));
        }
        let second = of_array(command, &out, 1).output().unwrap();
        first.kill().unwrap();
        first.wait().unwrap();
        assert_eq!(second.status.code(), Some(1));
        let error = stderr(&second);
        assert!(error.contains("another process") && error.contains(file), "{error}");
        fs::remove_dir_all(&out).unwrap();
    }
}

/// A value of a shard's head, which is JSON behind a mark.
fn head(file: &Path, key: &str) -> String {
    let text = fs::read_to_string(file).unwrap();
    let head = text.lines().next().unwrap();
    let json: serde_json::Value = serde_json::from_str(&head[head.find('{').unwrap()..]).unwrap();
    json[key].as_str().unwrap().to_owned()
}

#[test]
fn merge_refuses_shards_of_other_libraries_settings_or_programs() {
    let other = |name: &str, command: &[&str], more: &[&str]| {
        let out = scratch(&format!("other-{name}"));
        succeeds(&of_array(command, &out, 1).output().unwrap());
        succeeds(&of_array(&[command, more].concat(), &out, 2).output().unwrap());
        succeeds(&of_array(command, &out, 3).output().unwrap());
        let refused = merge(command, &out);
        assert_eq!(refused.status.code(), Some(1));
        let error = stderr(&refused);
        assert!(error.contains("trials-2-of-3.csv: is not of the evaluation of "), "{error}");
        (out, error)
    };
    let (out, error) = other("library", EVALUATE, &["--no-symmetry"]);
    let hash = |index: usize| head(&out.join(format!("trials-{index}-of-3.csv")), "case_base");
    assert!(error.contains(&format!("cases {}, not mirrored, not {}", hash(2), hash(1))), "{error}");
    let (_, error) = other("settings", EVALUATE, &["--set", "thr_c=1400"]);
    assert!(error.contains("settings thr_c=1400, not thr_c=1500;"), "{error}");
    let (_, error) = other("worlds", MATCHES, &["--world", "grsim"]);
    assert!(error.contains("world grsim, not nominal;"), "{error}");

    // What another program or another simulator would have written.
    for (key, value) in [("program", "9.9.9 (commit 1)"), ("world", "12345678")] {
        let out = scratch(&format!("other-{key}"));
        for index in 1..=OF {
            succeeds(&of_array(EVALUATE, &out, index).output().unwrap());
        }
        let file = out.join("trials-2-of-3.csv");
        let (text, own) = (fs::read_to_string(&file).unwrap(), head(&file, key));
        fs::write(&file, text.replacen(&own, value, 1)).unwrap();
        let error = stderr(&merge(EVALUATE, &out));
        assert!(
            error.contains(&format!("{key} {value}")) && error.contains(&format!("not {own}")),
            "{error}"
        );
    }
    let out = scratch("other-learn");
    fs::create_dir_all(&out).unwrap();
    succeeds(&onetwo(LEARN, &out));
    let text = fs::read_to_string(out.join("journal-1-of-1.jsonl")).unwrap();
    let (own, head) = (head(&out.join("journal-1-of-1.jsonl"), "world"), text.lines().next().unwrap());
    fs::write(out.join("journal-2-of-3.jsonl"), head.replace(&own, "12345678") + "\n").unwrap();
    let refused = of_array(LEARN, &out, 1).output().unwrap();
    let error = stderr(&refused);
    assert!(error.contains(&format!("of another run: world \"12345678\", not \"{own}\";")), "{error}");
}

#[test]
fn a_task_that_cannot_know_its_shard_is_refused_with_the_remedy() {
    let out = scratch("refused");
    let refused = |mut command: Command| {
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        stderr(&output)
    };
    assert!(refused(script(EVALUATE, &out)).contains("sbatch --array=1-N"));
    assert!(refused(task(EVALUATE, &out, 2, (2, 3))).contains("ONETWO_SHARDS=N"));
    assert!(refused(task(EVALUATE, &out, 0, (0, 2))).contains("--array=1-N"));
    let fresh = [EVALUATE, &["--fresh"]].concat();
    assert!(refused(of_array(&fresh, &out, 1)).contains("empty directory"));
    let sharded = [EVALUATE, &["--shard", "1/2"]].concat();
    assert!(refused(of_array(&sharded, &out, 1)).contains("comes from the array"));
    assert!(refused(script(&["merge", "trial"], &out)).contains("merge cases learn"));
    assert!(!out.exists());
}
