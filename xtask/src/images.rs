//! `images`: size and panic check of the robots' firmware images (docs/architecture.md §9).
//!
//! One image per body, the one that runs by its own clock, and the one for a real robot's board; the list of
//! places that may panic is `firmware/panics.allow`, with a board's own `panics.allow`, for all images
//! together.

use std::collections::BTreeMap;
use std::fs;

use firmware_build::inspect::{Allowed, Image, Sizes, panic_sites};
use firmware_build::{Program, boards};

use crate::context::{Context, Failure};

pub(crate) const WHAT: &str = "the robots' images link, keep to their budgets, have no doubles, and panic only where firmware/panics.allow permits";

/// Builds all firmware images and checks them.
pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    // Installed first here: `build_image` itself installs nothing system-wide.
    context.ensure_target()?;
    let mut sites = BTreeMap::new();
    let mut faults = Vec::new();
    for program in Program::images() {
        let path = firmware_build::build_program(context.root(), program).map_err(Failure::Image)?;
        let bytes = fs::read(&path).map_err(|error| Failure::unreadable(&path, &error))?;
        let image = Image::parse(&bytes).map_err(|error| Failure::unreadable(&path, &error))?;
        let sizes = Sizes::of(&image);
        println!("xtask: {}: {} B flash, {} B RAM", path.display(), sizes.flash, sizes.ram);
        if let Err(over) = program.budget().check(&sizes) {
            faults.push(format!("{}: {over}", program.name()));
        }
        if let Some(name) = image.soft_double() {
            faults.push(format!("{}: computes with doubles ({name})", program.name()));
        }
        for (site, lines) in panic_sites(&image) {
            sites.entry(site).or_insert(lines);
        }
    }
    let allowed = Allowed::parse(&allowed_places(context)?)
        .map_err(|error| Failure::Firmware(vec![format!("{LIST}, and that of each board: {error}")]))?;
    let verdict = allowed.judge(&sites);
    faults.extend(
        verdict.unknown.iter().map(|(site, lines)| format!("may panic: {site} ({})", lines.join(", "))),
    );
    faults.extend(
        verdict.gone.iter().map(|site| format!("{LIST}: no image has `{site}` any more; take the line out")),
    );
    if faults.is_empty() { Ok(()) } else { Err(Failure::Firmware(faults)) }
}

/// The common list, and those of boards that have one of their own.
fn allowed_places(context: &Context) -> Result<String, Failure> {
    let lists = boards().iter().map(|board| format!("firmware/boards/{}/{OWN_LIST}", board.name));
    let own = lists.filter(|list| context.root().join(list).is_file());
    let mut text = String::new();
    for list in std::iter::once(LIST.to_owned()).chain(own) {
        let part = fs::read_to_string(context.root().join(&list));
        text += &part.map_err(|error| Failure::Firmware(vec![format!("{list}: {error}")]))?;
        text.push('\n');
    }
    Ok(text)
}

/// Places that may panic in a board's own crate and its chip's drivers, in the board's directory.
const OWN_LIST: &str = "panics.allow";
/// Places that may panic, each with its reason.
const LIST: &str = "firmware/panics.allow";
