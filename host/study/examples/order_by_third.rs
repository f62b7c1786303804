//! `order_by_third`: what the settings of retrieval would give if each third of the field had its own
//! (docs/learning.md). Situations are decisions of trials; each setting's change is played from those of a
//! third of the field against no change, with the same seeds. The two best changes of each third are chosen
//! in some situations and judged in others.
//!
//! `cargo run --release -p onetwo-study --example order_by_third -- DIR [SEED]`, `DIR` being the library.

use std::error::Error;
use std::path::Path;

use arena::Profile;
use case_tools::Files;
use hil_sim::Configuration;
use rayon::prelude::*;
use study::learning::{
    Edit, KINDS, PlayError, Playable, Situation, StartStream, Unit, Variant, Wager, Work, kind_of,
    order_edits,
};

/// Starts whose decisions are the situations.
const STARTS: u32 = 8192;
/// Situations of a third that a change is chosen in, and those that the chosen one is judged in.
const CHOICE: usize = 400;
const JUDGED: usize = 3000;
/// Borders of the thirds of the 5,400 mm field, in the direction of attack, mm.
const BORDERS: [i32; 2] = [-900, 900];
const THIRDS: [&str; 3] = ["own", "middle", "opponents'"];

struct Place {
    situation: Situation,
    two_defenders: bool,
    profile: Profile,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let directory = arguments.next().ok_or("give the directory of a four-legged library")?;
    let seed: u64 = arguments.next().map_or(Ok(1), |seed| seed.parse())?;
    let files = Files::read(Path::new(&directory)).map_err(|error| format!("{error:?}"))?;
    let current = Variant::new(files).map_err(|error| format!("{error:?}"))?;
    let changes: Vec<(Edit, Variant)> = order_edits(&current)
        .into_iter()
        .filter_map(|edit| Some((edit.clone(), current.edited(&edit).ok()?)))
        .collect();
    let places = places(&current, seed)?;
    println!("third       change                                                  chosen with       judged");
    for (third, places) in THIRDS.into_iter().zip(&places) {
        let (choice, judged) = places.split_at(CHOICE.min(places.len()));
        let mut tried = Vec::new();
        for (edit, changed) in &changes {
            tried.push((compare(&current, changed, choice, seed)?, edit, changed));
        }
        tried.sort_by(|a, b| b.0.z().total_cmp(&a.0.z()));
        for (wager, edit, changed) in tried.iter().take(2) {
            let fresh = compare(&current, changed, judged, seed)?;
            println!(
                "{third:<10}  {:<54} {:>+6.1} z {:>4.1}  {:>+6.2} ± {:.2} points in {} situations",
                edit.to_string(),
                wager.gain(),
                wager.z(),
                fresh.gain(),
                196.0 * f64::from(fresh.raised + fresh.lowered).sqrt() / f64::from(fresh.pairs.max(1)),
                fresh.pairs
            );
        }
    }
    Ok(())
}

/// Situations in which retrieval decided, by third of the field.
fn places(current: &Variant, seed: u64) -> Result<[Vec<Place>; 3], Box<dyn Error>> {
    let starts: Vec<u32> = (0..STARTS).collect();
    let played = starts.par_iter().map(|index| {
        let work = Work::Starts { stream: StartStream::Exploration, indices: vec![*index], record: true };
        Unit { variant: current, work }.play(seed)
    });
    let played: Vec<_> = played.collect::<Result<_, _>>()?;
    let mut places = [const { Vec::new() }; 3];
    for (index, trial) in (0..).zip(played.into_iter().flatten()) {
        let kind = KINDS[kind_of(index).0];
        let decisions = trial.decisions.into_iter().filter(|decision| decision.retrieved);
        for situation in decisions.map(|decision| decision.situation).filter(Situation::is_usable) {
            let third = BORDERS.iter().filter(|border| situation.ball[0] >= **border).count();
            let two_defenders = kind.opponents == Configuration::TwoDefenders;
            places[third].push(Place { situation, two_defenders, profile: kind.profile });
        }
    }
    for places in &mut places {
        places.truncate(CHOICE + JUDGED);
    }
    Ok(places)
}

/// Pairs with and without the change.
fn compare(
    current: &Variant,
    changed: &Variant,
    places: &[Place],
    seed: u64,
) -> Result<Wager, Box<dyn Error>> {
    let pair = |(number, place): (usize, &Place)| {
        let work = Work::Situation {
            situation: place.situation.clone(),
            profile: place.profile,
            two_defenders: place.two_defenders,
            first: number as u32,
            trials: 1,
        };
        let to_goal = |variant| -> Result<bool, PlayError> {
            let trials = Unit { variant, work: work.clone() }.play(seed)?;
            Ok(trials.iter().any(study::learning::LearningTrial::to_goal))
        };
        Ok::<_, PlayError>((to_goal(changed)?, to_goal(current)?))
    };
    let pairs: Vec<(bool, bool)> = places.par_iter().enumerate().map(pair).collect::<Result<_, _>>()?;
    let mut wager = Wager::default();
    for (with, without) in pairs {
        wager.add(with, without);
    }
    Ok(wager)
}
