//! `schema`: tests of `onetwo cases schema` with an independent validator.

use boon::{Compiler, SchemaIndex, Schemas};
use case_library::LEAGUES;
use serde_json::Value;

use crate::common::{LEAGUE, PASS_AROUND, onetwo};

struct Schema(Schemas, SchemaIndex);

impl Schema {
    fn of(arguments: &[&str]) -> Self {
        let run = onetwo(&[&["cases", "schema"], arguments].concat());
        assert_eq!((run.code, run.stderr.as_str()), (0, ""));
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        compiler.add_resource("schema.json", serde_json::from_str(&run.stdout).unwrap()).unwrap();
        let index = compiler.compile("schema.json", &mut schemas).expect("a sound schema");
        Self(schemas, index)
    }

    fn admits(&self, text: &str) -> bool {
        let table: toml::Table = text.parse().expect("TOML");
        let value: Value = serde_json::to_value(table).unwrap();
        self.0.validate(&value, self.1).is_ok()
    }

    #[track_caller]
    fn refuses(&self, text: &str, old: &str, new: &str) {
        assert!(text.contains(old), "{old} is not in the text");
        assert!(!self.admits(&text.replacen(old, new, 1)), "{new}");
    }
}

#[test]
fn every_built_in_file_is_admitted() {
    let (case, league) = (Schema::of(&[]), Schema::of(&["--league-file"]));
    for built_in in LEAGUES {
        assert!(league.admits(built_in.rules), "{}", built_in.name);
        for (name, text) in built_in.names.iter().zip(built_in.sources) {
            assert!(case.admits(text), "{name}");
        }
    }
    assert!(case.admits(PASS_AROUND) && league.admits(LEAGUE));
}

#[test]
fn broken_case_files_are_refused() {
    let schema = Schema::of(&[]);
    for (old, new) in [
        ("\"yellow\"", "\"blue\""),
        ("intent", "purpose"),
        ("at = [-720, 0]", "at = [-720, 0]\nspeed = 3"),
        ("[-600, 0]", "[-600.5, 0]"),
        ("[-720, 0]", "[-720, 0, 0]"),
        ("[450, 250]", "[450, 0]"),
        ("\"wait\"", "\"sleep\""),
        ("{ pass_ball = 2 }", "{ pass = 2 }"),
        ("{ pass_ball = 2 }", "{ pass_ball = 2, kick = \"goal\" }"),
        ("{ pass_ball = 2 }", "{ pass_ball = 5 }"),
        ("\"wait\"", "{ turn = { left = 90 } }"),
        ("scope = [300, 225]", ""),
    ] {
        schema.refuses(PASS_AROUND, old, new);
    }
    let turns =
        PASS_AROUND.replacen("\"wait\"", "{ turn = { heading_deg = 90 } }, { turn = { face = [0, 0] } }", 1);
    assert!(schema.admits(&turns));
}

#[test]
fn broken_league_files_are_refused() {
    let schema = Schema::of(&["--league-file"]);
    for (old, new) in [
        ("length = 5400", "length = 0"),
        ("width = 3600\n", ""),
        ("aim = \"goal\"", "aim = \"corner\""),
        ("r_min = 100", "r_min = 0"),
        ("length = 1200\n", ""),
        ("[field]", "[field]\nheight = 1"),
    ] {
        schema.refuses(LEAGUE, old, new);
    }
    assert!(schema.admits(&LEAGUE.replacen("margin = 300\n", "", 1)));
}
