//! `guest`: retrieval benchmark on the robot's processor. The bench's firmware image under QEMU, which counts
//! instructions.

use std::path::{Path, PathBuf};
use std::{env, fs};

use casebase::{CaseBase, Problem, RetrievalSettings, retrieve, retrieve_best};
use firmware_build::Program;
use firmware_build::count::CountingImage;
use workloads::retrieval::{Answer, LEN_MAX, PROBLEMS_ADDRESS, TABLE_ADDRESS, encode, header, scan};

pub(crate) struct Board(CountingImage);

impl Board {
    pub(crate) fn new() -> Result<Self, String> {
        CountingImage::new(Program::RetrievalBench).map(Self)
    }

    pub(crate) fn answers(&self, table: &[u8], problems: &[Problem]) -> Result<Vec<Answer>, String> {
        let directory = Directory::new()?;
        let (table_file, problem_file) = (directory.0.join("table"), directory.0.join("problems"));
        let (table, in_memory) = ([&header(table.len(), 1), table].concat(), in_memory(problems));
        if table.len().max(in_memory.len()) > LEN_MAX {
            return Err(format!("table or problems are over {LEN_MAX} bytes"));
        }
        write(&table_file, &table)?;
        write(&problem_file, &in_memory)?;
        let devices = [
            ("-device", loader(&table_file, TABLE_ADDRESS)),
            ("-device", loader(&problem_file, PROBLEMS_ADDRESS)),
        ];
        let arguments: Vec<String> =
            devices.into_iter().flat_map(|(label, device)| [label.to_owned(), device]).collect();
        self.0.lines(&arguments, |line| line.parse().ok(), problems.len())
    }
}

/// Checks that the board's answers equal this machine's, bit for bit.
pub(crate) fn agrees(base: &CaseBase<'_>, problems: &[Problem], answers: &[Answer]) -> Result<(), String> {
    let settings = RetrievalSettings::default();
    for (problem, answer) in problems.iter().zip(answers) {
        let best = retrieve_best(base, problem, &settings);
        let here = Answer::new(
            best.as_ref(),
            &retrieve(base, problem, &settings),
            &scan(base, problem),
            answer.instructions,
        );
        if here != *answer || !here.agrees() {
            return Err(format!("{problem:?}: {here} here, {answer} on the board"));
        }
    }
    Ok(())
}

/// The problems in the encoding that the firmware image reads from memory.
pub(crate) fn in_memory(problems: &[Problem]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for problem in problems {
        bytes.extend(encode(problem, &mut [0; 512]).expect("a problem is shorter than 512 bytes"));
    }
    [&header(bytes.len(), problems.len())[..], &bytes].concat()
}

/// QEMU's device that puts a file into memory; commas of a path are doubled.
fn loader(file: &Path, address: usize) -> String {
    format!("loader,file={},addr={address:#x},force-raw=on", file.display().to_string().replace(',', ",,"))
}

pub(crate) fn write(file: &Path, bytes: &[u8]) -> Result<(), String> {
    fs::write(file, bytes).map_err(|error| format!("cannot write {}: {error}", file.display()))
}

/// A temporary directory that is deleted on drop.
pub(crate) struct Directory(pub(crate) PathBuf);

impl Directory {
    pub(crate) fn new() -> Result<Self, String> {
        let directory = env::temp_dir().join(format!("onetwo-bench-{}", std::process::id()));
        fs::create_dir_all(&directory)
            .map_err(|error| format!("cannot make {}: {error}", directory.display()))?;
        Ok(Self(directory))
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        // A temporary directory that stays is no error.
        let _ = fs::remove_dir_all(&self.0);
    }
}
