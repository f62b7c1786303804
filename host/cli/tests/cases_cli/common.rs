//! `common`: test helpers: the built program, a library directory of the test's own, and the output.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The league of the worked example (docs/case-format.md §1, §5.1).
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

[kicks.goal]
aim = "goal"
r_min = 100
r_max = 300

[kicks.left]
heading_deg = 45
length = 1200
r_min = 100
r_max = 250

[kicks.right]
heading_deg = -45
length = 1200
r_min = 100
r_max = 250
"#;

/// The case file of docs/case-format.md §1, verbatim.
pub(crate) const PASS_AROUND: &str = r#"intent = "Two attackers at the centre line, a defender ahead: pass around it and shoot."
defending = "yellow"
ball = { at = [-600, 0], scope = [450, 250] }        # mm; scope = (τx, τy)

[[teammates]]                                         # tm1
at = [-720, 0]
gameplay = ["get_ball", { pass_ball = 2 }]

[[teammates]]                                         # tm2
at = [300, 900]
gameplay = ["wait", { receive_ball = 1 }, { kick = "goal" }]

[[opponents]]                                         # opp1
at = [-150, -35]
scope = [300, 225]
"#;

/// A case with a robot alone that shoots; applies at every ball position.
pub(crate) fn shot_at(x: i32, y: i32) -> String {
    format!(
        "intent = \"Alone near the goal: shoot.\"\ndefending = \"yellow\"\n\
         ball = {{ at = [{x}, {y}], scope = [450, 250] }}\n\n\
         [[teammates]]\nat = [{}, {y}]\ngameplay = [\"get_ball\", {{ kick = \"goal\" }}]\n",
        x - 120
    )
}

/// The problem of docs/case-format.md §5.1, verbatim.
pub(crate) const PROBLEM: &str = r#"{"ball":[-600,10],"defending":"yellow","teammates":{"1":[-700,0],"3":[200,800]},"opponents":[[-150,40]]}"#;

/// A library directory under the build's scratch space, created again: `league.toml` and these files.
pub(crate) fn library(test: &str, files: &[(&str, &str)]) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cases-cli").join(test);
    if directory.exists() {
        fs::remove_dir_all(&directory).unwrap();
    }
    fs::create_dir_all(&directory).unwrap();
    for (name, text) in [("league.toml", LEAGUE)].iter().chain(files) {
        let path = directory.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    directory
}

/// The worked example's library: the case of docs/case-format.md §1 alone.
pub(crate) fn worked_example(test: &str) -> PathBuf {
    library(test, &[("center/pass-around.toml", PASS_AROUND)])
}

pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    pub(crate) fn lines(&self) -> Vec<&str> {
        self.stdout.lines().collect()
    }
}

/// Runs `onetwo` with these arguments and nothing on stdin.
pub(crate) fn onetwo(arguments: &[&str]) -> Run {
    onetwo_fed(arguments, b"")
}

/// Runs `onetwo cases VERB --library FOLDER …` with `input` on stdin.
pub(crate) fn cases(verb: &str, directory: &Path, more: &[&str], input: impl AsRef<[u8]>) -> Run {
    let directory = directory.to_str().unwrap();
    onetwo_fed(&[&["cases", verb, "--library", directory], more].concat(), input.as_ref())
}

fn onetwo_fed(arguments: &[&str], input: &[u8]) -> Run {
    let mut child = command(arguments).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let output = std::thread::scope(|scope| {
        scope.spawn(move || {
            // A program that ends without reading its input does not fail the test.
            let _ = stdin.write_all(input);
        });
        child.wait_with_output().unwrap()
    });
    let Output { status, stdout, stderr } = output;
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Run { code: status.code().expect("ended by a signal"), stdout: text(stdout), stderr: text(stderr) }
}

/// The program, not started yet, with all three streams piped.
pub(crate) fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_onetwo"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}
