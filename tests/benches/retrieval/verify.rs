//! `verify`: check of retrieval against the scan.

use casebase::{RetrievalSettings, retrieve, retrieve_best};
use workloads::retrieval::scan;

use crate::bases::Base;

/// Answers random problems of each base by both methods, on all processor cores; `problems` is their number
/// per base.
pub(crate) fn run(problems: [usize; 4]) -> Result<(), String> {
    let bases = Base::all();
    let (mut sum, mut answered, mut several) = (0, 0, 0);
    for (base, count) in bases.iter().zip(problems) {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let shares: Vec<Result<[usize; 2], String>> = std::thread::scope(|scope| {
            let share = |seed: usize| {
                let count = count / threads + usize::from(seed < count % threads);
                scope.spawn(move || differences(base, seed as u64, count))
            };
            let running: Vec<_> = (0..threads).map(share).collect();
            running.into_iter().map(|thread| thread.join().expect("no panic")).collect()
        });
        for share in shares {
            let [some, more] = share?;
            answered += some;
            several += more;
        }
        sum += count;
        println!("{} stored cases: {count} problems answered as the scan answers", base.library.base().len());
    }
    println!(
        "{sum} problems, {answered} with a candidate, {several} with several: all answers are the scan's"
    );
    Ok(())
}

/// Number of problems with candidates, and with several; an error reports the first that was answered
/// differently.
fn differences(base: &Base, seed: u64, count: usize) -> Result<[usize; 2], String> {
    let table = base.library.base();
    let settings = RetrievalSettings::default();
    let (mut some, mut several) = (0, 0);
    for problem in base.random_problems(seed).take(count) {
        let expected = scan(&table, &problem);
        let best = retrieve_best(&table, &problem, &settings);
        let counted = retrieve(&table, &problem, &settings);
        if counted != expected || best != expected.best {
            return Err(format!("{problem:?}: {expected:?} expected, got {counted:?} and {best:?}"));
        }
        some += usize::from(expected.candidates > 0);
        several += usize::from(expected.candidates > 1);
    }
    Ok([some, several])
}
