//! `soak`: samples of what `cargo xtask soak` plays for hours: mutated matches into a whole host, mutated
//! files into their readers.

use match_tests::soak::{Labels, Material, Target};

fn labels(target: &str, recipes: &[Vec<u64>], material: &Material) -> Labels {
    let target = Target::named(target).expect("a target");
    let mut all = Labels::new();
    for recipe in recipes {
        let (labels, result) = target.play(material, recipe);
        assert!(result.is_ok(), "cargo xtask soak --repeat {}:{recipe:?}: {result:?}", target.name);
        all.extend(labels);
    }
    all
}

#[test]
fn mutated_matches_and_files_break_nothing_and_reach_far() {
    let material = Material::gather().expect("the repository's own files");
    let recipes: Vec<_> = (0..40).map(|seed| vec![seed, seed + 1000]).collect();
    let host = labels("host", &recipes, &material);
    for reached in
        ["phase Run", "phase Halt", "phase Stop", "verdict Halted", "verdict NoAnswer", "verdict Undecodable"]
    {
        assert!(host.iter().any(|label| label.starts_with(reached)), "{reached} in {host:?}");
    }
    let recipes: Vec<_> = (0..400).map(|seed| vec![seed]).collect();
    let files = labels("files", &recipes, &material);
    for reached in ["case true", "robot ", "team ", "trace ", "log "] {
        assert!(files.iter().any(|label| label.starts_with(reached)), "{reached} in {files:?}");
    }
    assert_eq!(
        host,
        labels("host", &(0..40).map(|seed| vec![seed, seed + 1000]).collect::<Vec<_>>(), &material)
    );
}
