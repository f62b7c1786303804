//! `hostile`: fuzz tests of readers and brains. A bounded run; `cargo run --release -p match-tests --example
//! hostile -- --count 10000000` is a long one, `protocol/fuzz` has the same targets for `cargo fuzz`.

use match_tests::hostile::{corpus, run};

#[test]
fn no_reader_or_brain_panics_on_200_000_byte_strings() {
    let corpus = corpus().expect("the committed corpus");
    for seed in 0..4 {
        if let Err(panicked) = run(&corpus, seed, 50_000) {
            panic!("seed {seed}: {} with {:02x?}", panicked.target, panicked.bytes);
        }
    }
}

#[test]
fn every_fuzz_target_has_seeds_with_all_worked_examples() {
    let corpus = corpus().expect("the committed corpus");
    assert!(corpus.iter().all(|(_, seeds)| !seeds.is_empty()));
    let all: Vec<&Vec<u8>> = corpus.iter().flat_map(|(_, seeds)| seeds).collect();
    let specification = include_str!("../../protocol/SPEC.md");
    let examples = specification.split("```hex ").skip(1);
    for example in examples {
        let (name, text) = example.split_once('\n').expect("a name");
        let text = text.split("```").next().unwrap_or("");
        let bytes: Vec<u8> =
            text.split_whitespace().filter_map(|byte| u8::from_str_radix(byte, 16).ok()).collect();
        assert!(all.contains(&&bytes), "{name} is not in protocol/fuzz/corpus");
    }
    // The targets accept valid messages.
    for ((_, target), seeds) in &corpus {
        for bytes in seeds {
            target(bytes);
        }
    }
}
