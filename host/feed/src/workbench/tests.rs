//! `tests`: requests as the page sends them, on a library of files.

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use arena::cases::LibraryHandle;
use page::MatchProblem;

use study::store::Experiment;

use super::*;

/// A directory that is removed with its value.
struct Directory(PathBuf);

impl Directory {
    fn new(of: &str) -> Self {
        let root = std::env::temp_dir().join(format!("onetwo-workbench-{of}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&root);
        let league = case_library::league("division-b").unwrap();
        let directory = Self(root);
        fs::create_dir_all(directory.library().join("center")).unwrap();
        fs::write(directory.library().join("league.toml"), league.rules).unwrap();
        let one = league.names.iter().position(|name| *name == "center/one-two").unwrap();
        fs::write(directory.file("center/one-two"), league.sources[one]).unwrap();
        directory
    }

    fn library(&self) -> PathBuf {
        self.0.join("division-b")
    }

    fn file(&self, name: &str) -> PathBuf {
        self.library().join(format!("{name}.toml"))
    }

    fn workbench(&self) -> CaseWorkbench {
        let library = SharedLibrary::new(Some(LibraryHandle::read(&self.library(), |_, _| {}).unwrap()));
        CaseWorkbench::new(library, RetrievalSettings::default())
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Where the balls of the match's problems lie: x, mm.
const BALLS: [i32; 4] = [0, 0, 300, 3000];

fn asked(text: &Value, may_ask: bool, powers: Powers) -> WorkbenchRequest {
    let problem = |x: i32| MatchProblem { team: None, t: 1.0, problem: situation(x) };
    let problems = Box::new(move || BALLS.map(problem).to_vec());
    WorkbenchRequest { text: text.to_string(), may_ask, powers, problems }
}

fn ask(workbench: &CaseWorkbench, text: &Value) -> Result<Value, String> {
    let answer = workbench.answer(&asked(text, true, Powers::Simulation))?;
    Ok(serde_json::from_str(&answer).unwrap())
}

/// Two of ours about a ball, one of theirs ahead.
fn situation(x: i32) -> Value {
    json!({ "ball": [x, 0], "defending": "yellow", "teammates": { "1": [x - 120, 0], "3": [x + 900, 800] }, "opponents": [[x + 700, -300]] })
}

fn draft(workbench: &CaseWorkbench) -> String {
    let sheet = ask(workbench, &json!({ "do": "draft", "problem": situation(0) })).unwrap();
    assert_eq!((&sheet["name"], &sheet["findings"]), (&json!("draft/moment-1"), &json!([])));
    sheet["text"].as_str().unwrap().to_owned()
}

#[test]
fn a_draft_is_edited_saved_and_found_by_the_checks_without_findings() {
    let directory = Directory::new("draft");
    let workbench = directory.workbench();
    let text = draft(&workbench);
    let edit = json!({ "edit": "move", "part": "tm2", "to": [950, -700] });
    let edited = ask(
        &workbench,
        &json!({ "do": "edit", "name": "center/new", "text": text, "symmetry": "across-x", "edit": edit }),
    )
    .unwrap();
    assert_eq!(edited["copies"][1]["robots"][1]["at"], json!([950, -700]));
    assert_eq!(edited["copies"][0]["robots"][1]["at"], json!([950, 700]));
    let text = &edited["text"];
    let checked = ask(&workbench, &json!({ "do": "check", "name": "center/new", "text": text })).unwrap();
    assert_eq!(checked["findings"], json!([]));
    ask(&workbench, &json!({ "do": "save", "name": "center/new", "text": text, "over": null })).unwrap();
    assert_eq!(fs::read_to_string(directory.file("center/new")).unwrap(), text.as_str().unwrap());
    let listed = ask(&workbench, &json!({ "do": "list" })).unwrap();
    assert_eq!(listed["names"], json!(["center/new", "center/one-two"]));
    // The match goes on with what it began with; the next one has the new case.
    assert_eq!(workbench.library.now().unwrap().names(), ["center/one-two"]);
    workbench.library.read_again().unwrap();
    assert_eq!(workbench.library.now().unwrap().names(), ["center/new", "center/one-two"]);
}

#[test]
fn nothing_is_written_over_unseen_outside_the_library_or_with_an_error() {
    let directory = Directory::new("save");
    let workbench = directory.workbench();
    let text = draft(&workbench);
    let save = |name: &str, text: &str, over: Option<&str>| {
        ask(&workbench, &json!({ "do": "save", "name": name, "text": text, "over": over })).map(drop)
    };
    let before = fs::read_to_string(directory.file("center/one-two")).unwrap();
    for (name, over, words) in [
        ("center/one-two", None, "there is a case of that name"),
        ("center/one-two", Some("what was there"), "was changed meanwhile"),
        ("../outside", None, "is named region/name"),
        ("center/../../outside", None, "is named region/name"),
        ("league", None, "is named region/name"),
    ] {
        let refused = save(name, &text, over).unwrap_err();
        assert!(refused.contains(words), "{name}: {refused}");
    }
    let faulty = text.replace("\"get_ball\"", "\"wait\"");
    assert!(save("center/new", &faulty, None).unwrap_err().contains("0 robots begin with get_ball"));
    assert!(!directory.file("center/new").exists());
    assert_eq!(fs::read_to_string(directory.file("center/one-two")).unwrap(), before);
    save("center/one-two", &text, Some(&before)).unwrap();
    assert_eq!(fs::read_to_string(directory.file("center/one-two")).unwrap(), text);
}

#[cfg(unix)]
#[test]
fn a_region_that_is_a_link_to_elsewhere_is_not_written_to() {
    let directory = Directory::new("link");
    let workbench = directory.workbench();
    let text = draft(&workbench);
    let elsewhere = directory.0.join("elsewhere");
    fs::create_dir_all(&elsewhere).unwrap();
    std::os::unix::fs::symlink(&elsewhere, directory.library().join("away")).unwrap();
    let refused = ask(&workbench, &json!({ "do": "save", "name": "away/new", "text": text, "over": null }))
        .unwrap_err();
    assert!(refused.contains("outside the library"), "{refused}");
    assert_eq!(fs::read_dir(&elsewhere).unwrap().count(), 0);
}

#[test]
fn writing_and_rehearsing_need_the_token_and_a_real_field_has_none() {
    let directory = Directory::new("token");
    let workbench = directory.workbench();
    let text = draft(&workbench);
    let rehearse = json!({ "do": "rehearse", "name": "center/new", "text": text, "trials": 2, "opponents": "playing", "seed": 1 });
    let tries =
        json!({ "do": "tries", "plan": { "skill": "kick", "world": "nominal", "tries": 2, "seed": 1 } });
    let save = json!({ "do": "save", "name": "center/new", "text": text, "over": null });
    for request in [&rehearse, &save, &tries] {
        let refused = workbench.answer(&asked(request, false, Powers::Simulation)).unwrap_err();
        assert!(refused.contains("?token="), "{refused}");
    }
    assert!(!directory.file("center/new").exists());
    assert!(
        workbench
            .answer(&asked(&json!({ "do": "open", "name": "center/one-two" }), false, Powers::None))
            .is_ok()
    );
    // Parameters that may change on a real field do not give the machine away.
    for powers in [Powers::Halt, Powers::Tune] {
        for request in [&rehearse, &tries] {
            let refused = workbench.answer(&asked(request, true, powers)).unwrap_err();
            assert!(refused.contains("real field"), "{refused}");
        }
    }
    let built_in = SharedLibrary::new(case_library::league("division-b").map(LibraryHandle::built_in));
    let built_in = CaseWorkbench::new(built_in, RetrievalSettings::default());
    let refused = ask(&built_in, &json!({ "do": "save", "name": "center/new", "text": text, "over": null }))
        .unwrap_err();
    assert!(refused.contains("--library DIR"), "{refused}");
}

#[test]
fn tries_of_a_skill_are_counted_as_by_the_command_and_others_are_refused() {
    let directory = Directory::new("tries");
    let workbench = directory.workbench();
    let begin = |skill: &str, world: &str, tries: u32| {
        let plan = json!({ "skill": skill, "world": world, "tries": tries, "seed": 7 });
        ask(&workbench, &json!({ "do": "tries", "plan": plan }))
    };
    for (skill, world, tries) in [("fly", "nominal", 1), ("kick", "mars", 1), ("kick", "nominal", 501)] {
        assert!(begin(skill, world, tries).is_err(), "{skill} {world} {tries}");
    }
    let choices = ask(&workbench, &json!({ "do": "tries" })).unwrap();
    assert_eq!(choices["report"], Value::Null);
    assert!(choices["choices"]["skills"].as_array().unwrap().contains(&json!("get-ball")));
    begin("kick", "weak-kickers", 3).unwrap();
    let over = (0..600).find_map(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        let report = ask(&workbench, &json!({ "do": "tries" })).unwrap()["report"].take();
        (report["over"] == true).then_some(report)
    });
    let report = over.expect("three tries take seconds");
    let plan = SkillPlan {
        league: League::DivisionB,
        world: "weak-kickers".to_owned(),
        worlds: vec!["weak-kickers".parse().unwrap()],
        tries: 3,
        first: 0,
        seed: 7,
        skills: vec![Skill::Kick],
    };
    let rows = study::skills::rows(&plan, &plan.play_all(&|| ()).unwrap());
    assert_eq!(report["row"], serde_json::to_value(&rows[0]).unwrap());
    assert_eq!(report["failed"].as_array().unwrap().len(), 3 - rows[0].succeeded);
}

/// What retrieval answers on disk to the match's problems under `thr`: names.
fn answers(directory: &Directory, thr: &str) -> Vec<Option<String>> {
    let library = case_tools::load(&directory.library()).unwrap();
    let mut settings = RetrievalSettings::default();
    settings.set("thr", thr).unwrap();
    let answer = |x| {
        let best = casebase::retrieve(&library.base(), &read(&situation(x)).unwrap(), &settings).best?;
        Some(library.names[usize::from(best.case.0) / 4].clone())
    };
    BALLS.into_iter().map(answer).collect()
}

#[test]
fn wins_and_what_settings_change_are_counted_as_retrieval_answers() {
    let directory = Directory::new("count");
    let workbench = directory.workbench();
    let text = draft(&workbench);
    let counted = ask(&workbench, &json!({ "do": "count", "name": "center/new", "text": text })).unwrap();
    let before = answers(&directory, "0.367");
    ask(&workbench, &json!({ "do": "save", "name": "center/new", "text": text, "over": null })).unwrap();
    let after = answers(&directory, "0.367");
    let new = Some("center/new".to_owned());
    let wins = after.iter().filter(|answer| **answer == new).count();
    assert!(wins >= 3, "{after:?}");
    assert_eq!((&counted["problems"], &counted["wins"]), (&json!(4), &json!([0, wins])));
    let taken = |from: &Option<String>| {
        before.iter().zip(&after).filter(|(old, now)| *old == from && **now == new).count()
    };
    for pair in counted["takes"].as_array().unwrap() {
        let from: Option<String> = serde_json::from_value(pair[0].clone()).unwrap();
        assert_eq!(pair[1], json!(taken(&from)), "{counted}");
    }
    let ranked = json!({ "do": "rank", "name": "center/new", "text": text, "problem": situation(0) });
    let ranked = ask(&workbench, &ranked).unwrap();
    assert!(ranked["ids"].as_array().unwrap().contains(&ranked["answer"]["winner"]), "{ranked}");

    // A ball 300 mm off has a similarity of 0.85: under thr = 0.95 it is no longer in the scope.
    let tight = answers(&directory, "0.95");
    let changed = after.iter().zip(&tight).filter(|(now, then)| now != then).count();
    assert!(changed > 0, "{after:?} {tight:?}");
    let told = ask(&workbench, &json!({ "do": "settings", "values": { "thr": "0.95" } })).unwrap();
    let answered = |answers: &[Option<String>]| answers.iter().flatten().count();
    assert_eq!((&told["problems"], &told["changed"]), (&json!(4), &json!(changed)));
    assert_eq!(told["answered"], json!([answered(&after), answered(&tight)]));
    let same = ask(&workbench, &json!({ "do": "settings", "values": {} })).unwrap();
    assert_eq!((&same["changed"], &same["cases"]), (&json!(0), &json!([])));
    let refused = ask(&workbench, &json!({ "do": "settings", "values": { "thr": "2" } })).unwrap_err();
    assert!(refused.starts_with("thr takes"), "{refused}");
}

#[test]
fn a_rehearsal_counts_what_cases_play_counts_and_offers_three_attempts_to_watch() {
    let directory = Directory::new("rehearse");
    let workbench = directory.workbench();
    let text = draft(&workbench);
    let order = json!({ "do": "rehearse", "name": "center/new", "text": text, "trials": 4, "opponents": "standing", "seed": 3 });
    ask(&workbench, &order).unwrap();
    let mut report = Value::Null;
    for _ in 0..600 {
        report = ask(&workbench, &json!({ "do": "rehearsal" })).unwrap();
        if report["over"] == json!(true) {
            break;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    assert_eq!((&report["done"], &report["error"]), (&json!(4), &Value::Null));
    let library = workbench.library_with("center/new", &text).unwrap();
    let case_trial = arena::CaseTrial {
        league: rules::League::DivisionB,
        base: library.base(),
        names: arena::CaseNames::new(library.names.clone()),
        settings: RetrievalSettings::default(),
        trials: 4,
        seed: 3,
    };
    let case = case_trial.case(0).unwrap();
    let attempts = case_trial.play(&case, arena::Opposition::Standing, &|| ()).unwrap();
    let score = arena::Score::of("center/new".to_owned(), "standing", &attempts);
    assert_eq!(report["score"], serde_json::to_value(score).unwrap());
    assert_eq!(report["samples"].as_array().unwrap().len(), 3);
    let sample =
        ask(&workbench, &json!({ "do": "sample", "number": report["samples"][0]["number"] })).unwrap();
    assert!(sample["moments"].as_array().unwrap().len() > 10);
    assert_eq!(sample["moments"][0]["robots"].as_array().unwrap().len(), 3);
    assert!(ask(&workbench, &json!({ "do": "sample", "number": 99 })).is_err());
}

#[test]
fn what_learning_has_left_beside_the_library_is_told_of_a_case() {
    let directory = Directory::new("learned");
    let workbench = directory.workbench();
    let learned = json!({ "do": "learned", "name": "center/one-two" });
    let refused = ask(&workbench, &learned).unwrap_err();
    assert!(refused.contains("no evidence.jsonl and no report.json beside "), "{refused}");
    let record = json!({ "library": "1", "world": "2", "case": "center/one-two", "symmetry": 1, "ring": "risk",
        "pattern": "1/1", "opponents": "dg", "area": 4, "plays": 8, "to_goal": 3, "ends": { "finished": 8 } });
    fs::write(directory.0.join("evidence.jsonl"), format!("{record}\n")).unwrap();
    let report = json!({ "changes": [{ "edit": { "case": "center/one-two", "change": { "ball-scope": [333, 222] } },
        "text": "center/one-two: ball scope [333, 222]", "reason": "r", "verdict": "proposed", "pairs": 9, "raised": 5,
        "lowered": 2, "gain": 33.3 }] });
    fs::write(directory.0.join("report.json"), report.to_string()).unwrap();
    let answer = ask(&workbench, &learned).unwrap();
    assert_eq!(answer["told"]["all"], json!({ "plays": 8, "to_goal": 3 }));
    assert_eq!(answer["told"]["now"]["plays"], 0, "of another library");
    assert!(answer["proposals"][0]["after"].as_str().unwrap().contains("scope = [333, 222]"));
    let words = &answer["proposals"][0]["words"];
    let refuse = |words: &Value, refused: bool| {
        ask(
            &workbench,
            &json!({ "do": "refuse", "name": "center/one-two", "words": words, "refused": refused }),
        )
    };
    assert_eq!(answer["proposals"][0]["refused"], false);
    assert_eq!(refuse(words, true).unwrap()["proposals"][0]["refused"], true);
    let kept = fs::read_to_string(directory.0.join("refused.jsonl")).unwrap();
    assert_eq!(
        study::learning::read_refusals(&kept).unwrap(),
        learned::refusals(&directory.library()).unwrap()
    );
    assert_eq!((kept.lines().count(), ask(&workbench, &learned).unwrap()), (1, refuse(words, true).unwrap()));
    assert_eq!(refuse(words, false).unwrap()["proposals"][0]["refused"], false);
    assert!(learned::refusals(&directory.library()).unwrap().is_empty());
    assert!(refuse(&json!("another"), true).unwrap_err().starts_with("the report has no such change"));
    fs::write(directory.0.join("evidence.jsonl"), "{}\n").unwrap();
    let refused = ask(&workbench, &learned).unwrap_err();
    assert!(refused.starts_with("evidence.jsonl: line 1: "), "{refused}");
}
