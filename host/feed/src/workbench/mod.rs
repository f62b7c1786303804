//! `workbench`: the page's case workbench: files of a library, a draft that is edited, and what retrieval,
//! simulator and checks say of it. JSON in, JSON out.
//!
//! The draft is the viewer's: it comes with every request, so that several viewers can each edit their own.
//! Kept here: the library, and one rehearsal.

mod asked;
mod count;
mod course;
mod learned;
mod play_on;
mod rehearsal;
mod save;
mod shared_library;
mod skill_tests;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock};

use arena::cases::{Chosen, described, explained_by, problem};
use case_tools::workbench::{FindingNote, Sheet, Workbench, case_name, is_case_name};
use case_tools::{Finding, Library, SkeletonError, never_retrieved, skeleton};
use casebase::RetrievalSettings;
use hil_sim::small_size::worlds::WorldChoice;
use page::{Powers, WorkbenchRequest};
use protocol::CaseId;
use rules::League;
use serde::Serialize;
use serde_json::{Value, json};
use study::skills::{Skill, SkillPlan};

use crate::MomentSource;

use asked::{Asked, TriesPlan};
use count::Problems;
use play_on::PlayOn;
use rehearsal::{Rehearsal, RehearsalOrder};
use skill_tests::SkillTests;

pub use learned::refusals;
pub use shared_library::SharedLibrary;

/// Problems that are drawn to find out whether a case is ever retrieved, as by `cases check`.
const DRAWN_PROBLEMS: u64 = 20_000;

pub(crate) struct CaseWorkbench {
    library: SharedLibrary,
    settings: RetrievalSettings,
    /// Where moments to play on from are found; none where there are none.
    pub(crate) moments: Option<MomentSource>,
    /// The files, read when they are first asked for, and after every saving.
    bench: RwLock<Option<Arc<Workbench>>>,
    rehearsal: Mutex<Option<Rehearsal>>,
    tries: Mutex<Option<SkillTests>>,
    play_on: Mutex<Option<PlayOn>>,
}

impl CaseWorkbench {
    /// A workbench over `library`, whose cases are retrieved with these settings.
    pub(crate) fn new(library: SharedLibrary, settings: RetrievalSettings) -> Self {
        Self {
            library,
            settings,
            moments: None,
            bench: RwLock::default(),
            rehearsal: Mutex::default(),
            tries: Mutex::default(),
            play_on: Mutex::default(),
        }
    }

    pub(crate) fn answer(&self, request: &WorkbenchRequest) -> Result<String, String> {
        let asked: Asked =
            serde_json::from_str(&request.text).map_err(|error| format!("no request: {error}"))?;
        if asked.needs_token() && !request.may_ask {
            return Err(NO_TOKEN.to_owned());
        }
        let answer = match asked {
            Asked::List {} => self.list(request)?,
            Asked::Open { name } => self.open(&name)?,
            Asked::Draft { problem } => self.draft(&problem)?,
            Asked::Look { name, text } => self.sheet(&name, &text)?,
            Asked::Edit { name, text, symmetry, edit } => {
                let edited = self.bench()?.edited(&name, &text, edit, symmetry.into());
                self.sheet(&name, &edited.map_err(|error| error.to_string())?)?
            }
            Asked::Check { name, text } => self.check(&name, &text)?,
            Asked::Rank { name, text, problem } => self.rank(&name, &text, &problem)?,
            Asked::Count { name, text } => {
                let library = self.library_with(&name, &text)?;
                let bench = self.bench()?;
                let before = case_tools::build(bench.files()).map_err(|findings| refused(&findings))?;
                let problems = Problems::of(&(request.problems)());
                value(&count::wins(&problems, &before, &library, &name, &self.settings))?
            }
            Asked::Learned { name } => {
                learned::of_case(self.library.directory(), self.bench()?.files(), &name)?
            }
            Asked::Refuse { name, words, refused } => {
                learned::refuse(self.library.directory(), &name, &words, refused)?;
                learned::of_case(self.library.directory(), self.bench()?.files(), &name)?
            }
            Asked::Settings { values } => {
                let bench = self.bench()?;
                let library = case_tools::build(bench.files()).map_err(|findings| refused(&findings))?;
                let mut changed = self.settings.clone();
                for (name, text) in &values {
                    changed.set(name, text).map_err(|error| error.to_string())?;
                }
                let problems = Problems::of(&(request.problems)());
                value(&count::changes(&problems, &library, &self.settings, &changed))?
            }
            Asked::Rehearse { name, text, trials, opponents, seed } => {
                if is_real(request.powers) {
                    return Err(REAL_FIELD.to_owned());
                }
                let library = self.library_with(&name, &text)?;
                let order = RehearsalOrder { name, trials, opponents, seed, settings: self.settings.clone() };
                let rehearsal = Rehearsal::begin(library, order)?;
                if let Some(old) = locked(&self.rehearsal).replace(rehearsal) {
                    old.course.stop();
                }
                self.rehearsed()?
            }
            Asked::Rehearsal {} => self.rehearsed()?,
            Asked::Stop {} => {
                if let Some(rehearsal) = &*locked(&self.rehearsal) {
                    rehearsal.course.stop();
                }
                self.rehearsed()?
            }
            Asked::Sample { number } => {
                let rehearsal = locked(&self.rehearsal);
                let sample = rehearsal.as_ref().ok_or(NO_REHEARSAL)?.sample(number);
                sample.ok_or("there is no such attempt: rehearse again")?
            }
            Asked::Tries { plan: Some(_) } if is_real(request.powers) => return Err(REAL_FIELD.to_owned()),
            Asked::Tries { plan: Some(plan) } => {
                let tests = SkillTests::begin(self.tries_plan(plan)?)?;
                if let Some(old) = locked(&self.tries).replace(tests) {
                    old.course.stop();
                }
                self.tried()
            }
            Asked::Tries { plan: None } => self.tried(),
            Asked::StopTries {} => {
                if let Some(tests) = &*locked(&self.tries) {
                    tests.course.stop();
                }
                self.tried()
            }
            Asked::PlayOn { plan } => {
                if let Some(plan) = plan {
                    let source = self.moments.clone().ok_or(NO_MOMENT)?;
                    if let Some(old) = locked(&self.play_on).replace(PlayOn::begin(source, plan)?) {
                        old.course.stop();
                    }
                }
                self.played_on()
            }
            Asked::StopPlayOn {} => {
                if let Some(played) = &*locked(&self.play_on) {
                    played.course.stop();
                }
                self.played_on()
            }
            Asked::Save { name, text, over } => {
                let directory = self.library.directory().ok_or(NO_DIRECTORY)?;
                let sheet = self.bench()?.sheet(&name, &text);
                save::save(directory, &sheet, over.as_deref())?;
                // The next request reads what is there now.
                *self.bench.write().unwrap_or_else(PoisonError::into_inner) = None;
                self.open(&name)?
            }
        };
        serde_json::to_string(&answer).map_err(|error| error.to_string())
    }

    fn played_on(&self) -> Value {
        let from = self.moments.as_ref().map(|source| match source {
            MomentSource::Recording(..) => "recording",
            MomentSource::Match(_) => "match",
        });
        json!({ "from": from, "report": locked(&self.play_on).as_ref().map(PlayOn::report) })
    }

    /// The tries that are asked for, in the league of the cases.
    fn tries_plan(&self, plan: TriesPlan) -> Result<SkillPlan, String> {
        let skill = Skill::from_label(&plan.skill).ok_or("there is no such skill")?;
        let choice: WorldChoice = plan.world.parse().map_err(|_| "there is no such world".to_owned())?;
        let named = self.bench().map(|bench| bench.files().league.clone());
        let has_wheels = [League::Ssl2013, League::DivisionB, League::DivisionA];
        let named = has_wheels.into_iter().find(|league| named.as_deref() == Ok(league.name()));
        let league = named.unwrap_or(League::DivisionB);
        let TriesPlan { world, tries, seed, .. } = plan;
        Ok(SkillPlan { league, world, worlds: vec![choice], tries, first: 0, seed, skills: vec![skill] })
    }

    fn tried(&self) -> Value {
        let report = locked(&self.tries).as_ref().map(SkillTests::report);
        json!({ "choices": SkillTests::choices(), "report": report })
    }

    fn bench(&self) -> Result<Arc<Workbench>, String> {
        if let Some(bench) = &*self.bench.read().unwrap_or_else(PoisonError::into_inner) {
            return Ok(bench.clone());
        }
        let files = self.library.files()?;
        let bench = Arc::new(Workbench::new(files).map_err(|findings| refused(&findings))?);
        *self.bench.write().unwrap_or_else(PoisonError::into_inner) = Some(bench.clone());
        Ok(bench)
    }

    fn library_with(&self, name: &str, text: &str) -> Result<Library, String> {
        named(name)?;
        self.bench()?.library(name, text).map_err(|findings| refused(&findings))
    }

    fn list(&self, request: &WorkbenchRequest) -> Result<Value, String> {
        let bench = self.bench()?;
        let names: Vec<_> = bench.files().cases.iter().map(|file| &file.name).collect();
        let kicks: Vec<_> = bench.league().kicks.iter().map(|(name, _)| name).collect();
        Ok(json!({
            "league": bench.files().league,
            "names": names,
            "kicks": kicks,
            "saves": self.library.directory().is_some(),
            "rehearses": !is_real(request.powers),
            "settings": described(&self.settings),
        }))
    }

    fn sheet(&self, name: &str, text: &str) -> Result<Value, String> {
        named(name)?;
        value(&Sheeted { sheet: self.bench()?.sheet(name, text), notes: Vec::new() })
    }

    fn open(&self, name: &str) -> Result<Value, String> {
        let bench = self.bench()?;
        let file = bench.files().cases.iter().find(|file| file.name == name);
        let file = file.ok_or_else(|| format!("there is no case {}", foreign::excerpt(name, 80)))?;
        self.sheet(name, &file.text)
    }

    /// A first version for a situation, as by `cases new`.
    fn draft(&self, problem: &Value) -> Result<Value, String> {
        let bench = self.bench()?;
        let draft = skeleton(&bench.files().rules, &read(problem)?).map_err(|error| match error {
            SkeletonError::NoTeammate => {
                "no robot of that team is available for a case at this moment".to_owned()
            }
            SkeletonError::League(findings) => refused(&findings),
        })?;
        let mut name = String::new();
        for number in 1.. {
            name = format!("draft/moment-{number}");
            if bench.files().cases.iter().all(|file| file.name != name) {
                break;
            }
        }
        value(&Sheeted { sheet: bench.sheet(&name, &draft.text), notes: draft.notes })
    }

    /// Everything that `cases check` finds in this file, the drawn problems too.
    fn check(&self, name: &str, text: &str) -> Result<Value, String> {
        let mut sheet = self.bench()?.sheet(name, text);
        if let Ok(library) = self.library_with(name, text) {
            let drawn = library.survey().map_err(|error| error.to_string())?;
            let sampler = library.sampler(1);
            let counters = drawn.over((0..DRAWN_PROBLEMS).map(|number| (number, sampler.problem(number))));
            let own = |finding: &Finding| case_name(&finding.file) == name;
            let never = never_retrieved(&library, &counters);
            sheet.findings.extend(never.iter().filter(|f| own(f)).map(FindingNote::of));
        }
        value(&Sheeted { sheet, notes: Vec::new() })
    }

    /// The verdicts of all cases on one problem, and the ids of the case's copies.
    fn rank(&self, name: &str, text: &str, problem: &Value) -> Result<Value, String> {
        let library = self.library_with(name, text)?;
        let authored = library.names.iter().position(|known| known == name).unwrap_or(0);
        let chosen = Chosen { settings: self.settings.clone(), changed: Vec::new() };
        let name_of = |id: CaseId| library.names[usize::from(id.0) / 4].as_str();
        let answer = explained_by(&library.base(), &name_of, &chosen, &problem.to_string())?;
        let answer: Value = serde_json::from_str(&answer).map_err(|error| error.to_string())?;
        Ok(json!({ "ids": (0..4).map(|copy| 4 * authored + copy).collect::<Vec<_>>(), "answer": answer }))
    }

    fn rehearsed(&self) -> Result<Value, String> {
        Ok(locked(&self.rehearsal).as_ref().ok_or(NO_REHEARSAL)?.report())
    }
}

fn locked<T>(kept: &Mutex<T>) -> MutexGuard<'_, T> {
    kept.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A field with real robots: the host needs the machine.
const fn is_real(powers: Powers) -> bool {
    matches!(powers, Powers::Halt | Powers::Tune)
}

/// A sheet, and what a draft leaves out of its situation.
#[derive(Serialize)]
struct Sheeted {
    #[serde(flatten)]
    sheet: Sheet,
    notes: Vec<String>,
}

fn value(answer: &impl Serialize) -> Result<Value, String> {
    serde_json::to_value(answer).map_err(|error| error.to_string())
}

fn read(problem: &Value) -> Result<casebase::Problem, String> {
    problem::parse(&problem.to_string()).map_err(|malformed| malformed.to_string())
}

fn named(name: &str) -> Result<(), String> {
    if is_case_name(name) { Ok(()) } else { Err(NAME_FORM.to_owned()) }
}

/// The first of the findings that refuse a library.
fn refused(findings: &[Finding]) -> String {
    let errors = findings.iter().filter(|finding| finding.severity == case_tools::Severity::Error);
    let count = errors.clone().count();
    let line = |finding: &Finding| {
        let FindingNote { file, line, message, hint, .. } = FindingNote::of(finding);
        format!("{file}.toml:{line}: {message}; {hint}")
    };
    let first = errors.map(line).next().unwrap_or_default();
    if count > 1 { format!("{first} (and {} more)", count - 1) } else { first }
}

const NAME_FORM: &str = "a case is named region/name, both of letters, digits, - and _";
const NO_DIRECTORY: &str = "the cases of this program are built in: to save, start it with --library DIR, a copy of a league's directory";
const NO_REHEARSAL: &str = "nothing was rehearsed yet";
const NO_MOMENT: &str = "moments are played on from in onetwo play and onetwo replay --watch";
const NO_TOKEN: &str = "this page is open to the network: to rehearse, to try skills and to save, open it by the address with ?token=";
const REAL_FIELD: &str = "beside a real field nothing is rehearsed and no skill tried: the host needs the machine; use onetwo play";

#[cfg(test)]
mod tests;
