//! `cargo xtask pictures`: draws the figures in the documentation again.

use crate::context::{Context, Failure, run};

pub(crate) fn draw(context: &Context) -> Result<(), Failure> {
    PICTURES
        .iter()
        .try_for_each(|line| run(&mut context.cargo(&format!("run --release --features png -- {line}"))))?;
    for case in PLAYS {
        let file = format!("docs/plays/{}.svg", case.replace('/', "-"));
        let line = format!("run --release -- cases render {case} --league division-b --out {file}");
        run(&mut context.cargo(&line))?;
    }
    run(&mut context.cargo("run --release -p onetwo-host --example strategy_pictures -- docs/strategy"))?;
    let line = "run --release --features png -- cases render --out docs/case-problem.svg --problem";
    run(context.cargo(line).arg(PROBLEM))
}

/// The program's arguments for each figure.
const PICTURES: [&str; 4] = [
    // One of the third of all trials that end in a goal.
    "trial --seed 72 --svg docs/trial.svg",
    "cases render center/pass-around --out docs/case.svg",
    "cases render --sheet docs/cases-four-legged.svg",
    "cases coverage --out docs/coverage-four-legged.svg",
];
/// The cases of docs/plays.md.
const PLAYS: [&str; 10] = [
    "front/shot-and-decoy",
    "front-side/near-post",
    "front-side/sharp-angle",
    "front/step-aside",
    "back/carry-out",
    "side/up-the-line",
    "side/inside-shot",
    "center/give-and-go-wide",
    "side/inside-to-middle",
    "center/one-two",
];
/// The situation of docs/case-format.md §5.1: drawn over the case that is retrieved.
const PROBLEM: &str = r#"{"ball":[-600,10],"defending":"yellow","teammates":{"1":[-700,0],"3":[200,800]},"opponents":[[-150,40]]}"#;
