//! `league`: the contents of `league.toml`: field, passes, kick kinds (docs/case-format.md §1.1). mm,
//! degrees.

use casebase::action::KICKS_MAX;
use casebase::plan_simulation::Kicks;
use casebase::{CaseKick, FieldMm, KickAim, KickId, Pass, Primitive};

use crate::codes::code;
use crate::document::{Reader, Table, Value};
use crate::files::SourceFile;
use crate::keys::{self, COORDINATES, DEGREES, INNER, POSITIVE, SIDES};
use crate::lineup::Lineup;
use foreign::Finding;

/// A league's rules, as `league.toml` states them.
#[derive(Clone, Debug)]
pub struct CaseLeague {
    /// Dimensions of the field, mm.
    pub field: FieldMm,
    /// Radii r_min and r_max of passes, mm.
    pub pass: Pass,
    /// Longest roll of a pass, mm, where the file states it: the greatest distance of its receiver.
    pub pass_reach: Option<i32>,
    /// Kick kinds by name, in the order of their names: this order is their [`KickId`]s.
    pub kicks: Vec<(String, CaseKick)>,
    /// Areas of the robots in drawn problems, where the file contains them.
    pub lineup: Option<Lineup>,
    /// Longest roll of each kick kind at the goal, mm, where the file states it.
    reaches: Vec<Option<i32>>,
    /// The kind that replaces each under a single reflection.
    partners: Vec<KickId>,
}

impl CaseLeague {
    /// Reads `league.toml`, with its findings; without the league they are errors.
    pub(crate) fn read(file: &SourceFile) -> (Option<Self>, Vec<Finding>) {
        let mut reader = Reader::new(file);
        let league = reader.parse().and_then(|root| read_league(&mut reader, &Table::root(&root)));
        let faulty = reader.findings.iter().any(|finding| finding.severity == foreign::Severity::Error);
        (league.filter(|_| !faulty), reader.findings)
    }

    /// Reads `league.toml`; `None` where it is refused.
    pub fn of(file: &SourceFile) -> Option<Self> {
        Self::read(file).0
    }

    /// A kick kind by its name.
    pub fn kick_id(&self, name: &str) -> Option<KickId> {
        self.kicks.iter().position(|(known, _)| known == name).map(|at| KickId(at as u8))
    }

    /// Longest roll of a kick kind at the goal, mm, where the file states it.
    pub(crate) fn reach(&self, id: KickId) -> Option<i32> {
        self.reaches.get(usize::from(id.0)).copied().flatten()
    }

    /// The kind that replaces it under a single reflection.
    pub(crate) fn partner(&self, id: KickId) -> KickId {
        self.partners[usize::from(id.0)]
    }
}

impl Kicks for CaseLeague {
    fn kick(&self, id: KickId) -> Option<CaseKick> {
        self.kicks.get(usize::from(id.0)).map(|(_, kick)| *kick)
    }
    fn pass(&self) -> Pass {
        self.pass
    }
    fn field(&self) -> FieldMm {
        self.field
    }
}

fn read_league(reader: &mut Reader<'_>, root: &Table<'_, '_>) -> Option<CaseLeague> {
    root.refuse_others(reader, keys::LEAGUE);
    let field = root.required(reader, "field").and_then(|value| read_field(reader, value));
    let pass = root.required(reader, "pass").and_then(|value| read_pass(reader, value));
    let lineup = root.optional("problems").and_then(|value| Lineup::read(reader, value));
    let mut kicks = Vec::new();
    let mut reaches = Vec::new();
    let mut spans = Vec::new();
    if let Some(table) = root.optional("kicks").and_then(|value| reader.table(value, "kicks")) {
        let mut entries = table.entries();
        entries.sort_by_key(|(name, ..)| name.as_bytes());
        if let Some((_, span, _)) = entries.get(KICKS_MAX) {
            let message = format!("{} kick kinds, at most {KICKS_MAX} fit", entries.len());
            reader.error(code::TOO_MANY_KICKS, span.clone(), message, "take some out");
        }
        for (name, span, value) in entries {
            if let Some((kick, reach)) = read_kick(reader, &format!("kicks.{name}"), value) {
                kicks.push((name.to_owned(), kick));
                reaches.push(reach);
                spans.push(span);
            }
        }
    }
    let mut partners = Vec::new();
    for ((name, kick), span) in kicks.iter().zip(spans) {
        if let Some(at) = kicks.iter().position(|(_, other)| are_partners(*kick, *other)) {
            partners.push(KickId(at as u8));
        } else {
            let message = format!("kicks.{name} has no partner to the other side");
            let hint = "add a kind of opposite heading_deg or offset with equal length and radii, for the mirrored cases";
            reader.error(code::NO_PARTNER, span, message, hint);
        }
    }
    let (pass, pass_reach) = pass?;
    Some(CaseLeague { field: field?, pass, pass_reach, kicks, lineup, reaches, partners })
}

fn read_field(reader: &mut Reader<'_>, value: Value<'_, '_>) -> Option<FieldMm> {
    let table = reader.table(value, "field")?;
    table.refuse_others(reader, keys::FIELD);
    let length = table.whole(reader, "length", &SIDES);
    let width = table.whole(reader, "width", &SIDES);
    let margin =
        table.optional("margin").map_or(Some(0), |value| reader.whole(value, "field.margin", &INNER));
    let goal_width = table.whole(reader, "goal_width", &INNER);
    let area = table.required(reader, "penalty_area").and_then(|value| {
        let area = reader.table(value, "field.penalty_area")?;
        area.refuse_others(reader, keys::PENALTY_AREA);
        let (depth, width) = (area.whole(reader, "depth", &INNER), area.whole(reader, "width", &INNER));
        Some((depth?, width?))
    });
    let (penalty_depth, penalty_width) = area?;
    let (length, width, margin, goal_width) = (length?, width?, margin?, goal_width?);
    Some(FieldMm { length, width, margin, goal_width, penalty_depth, penalty_width })
}

fn read_pass(reader: &mut Reader<'_>, value: Value<'_, '_>) -> Option<(Pass, Option<i32>)> {
    let table = reader.table(value, "pass")?;
    table.refuse_others(reader, keys::PASS);
    let (r_min, r_max) = (table.whole(reader, "r_min", &POSITIVE), table.whole(reader, "r_max", &POSITIVE));
    let reach = read_reach(reader, &table)?;
    Some((Pass { r_min: r_min?, r_max: r_max? }, reach))
}

/// The distance in `reach`, `None` within where there is none.
#[allow(clippy::option_option, reason = "a fault is not an absent key")]
fn read_reach(reader: &mut Reader<'_>, table: &Table<'_, '_>) -> Option<Option<i32>> {
    let Some(value) = table.optional("reach") else { return Some(None) };
    reader.whole(value, &table.name_of("reach"), &POSITIVE).map(Some)
}

fn read_kick(reader: &mut Reader<'_>, name: &str, value: Value<'_, '_>) -> Option<(CaseKick, Option<i32>)> {
    let table = reader.table(value, name)?;
    let mut reach = None;
    let (r_min, r_max) = (table.whole(reader, "r_min", &POSITIVE), table.whole(reader, "r_max", &POSITIVE));
    let primitive = table.optional("primitive").and_then(|value| read_primitive(reader, name, value));
    let aim = if let Some(value) = table.optional("aim") {
        table.refuse_others(reader, keys::KICK_AT_GOAL);
        let label = reader.text(value, &table.name_of("aim"))?;
        if label != "goal" {
            let message = format!("{name} aims at {label:?}");
            reader.error(
                code::BAD_VALUE,
                value.span(),
                message,
                "write aim = \"goal\", or give heading_deg and length",
            );
            return None;
        }
        let offset =
            table.optional("offset").map_or(Some(0), |value| reader.whole(value, "offset", &COORDINATES));
        reach = read_reach(reader, &table)?;
        KickAim::Goal { offset_mm: offset? }
    } else {
        table.refuse_others(reader, keys::KICK_AHEAD);
        let degrees = table.whole(reader, "heading_deg", &DEGREES);
        let length_mm = table.whole(reader, "length", &(0..=*POSITIVE.end()));
        KickAim::Heading { degrees: degrees?, length_mm: length_mm? }
    };
    let primitive = primitive.unwrap_or_default();
    Some((CaseKick { aim, r_min: r_min?, r_max: r_max?, primitive }, reach))
}

fn read_primitive(reader: &mut Reader<'_>, name: &str, value: Value<'_, '_>) -> Option<Primitive> {
    let label = reader.text(value, &format!("{name}.primitive"))?;
    let primitive = Primitive::from_label(label).filter(|primitive| *primitive != Primitive::Unspecified);
    if primitive.is_none() {
        let known = Primitive::ALL.map(Primitive::label).join(", ");
        let message = format!("{name} asks the body for {label:?}, which no body knows");
        let hint = format!("take one of: {}", known.trim_start_matches(", "));
        reader.warning(code::UNKNOWN_PRIMITIVE, value.span(), message, hint);
    }
    primitive
}

/// Returns whether `other` is a mirror image of `kick`.
fn are_partners(kick: CaseKick, other: CaseKick) -> bool {
    let opposite = match (kick.aim, other.aim) {
        (
            KickAim::Heading { degrees, length_mm },
            KickAim::Heading { degrees: other_degrees, length_mm: other_length },
        ) => (degrees + other_degrees).rem_euclid(360) == 0 && length_mm == other_length,
        (KickAim::Goal { offset_mm }, KickAim::Goal { offset_mm: other_offset }) => {
            offset_mm == -other_offset
        }
        _ => false,
    };
    // A kind that is its own mirror image is its own partner, however many others equal it.
    let own_image = match kick.aim {
        KickAim::Heading { degrees, .. } => (2 * degrees).rem_euclid(360) == 0,
        KickAim::Goal { offset_mm } => offset_mm == 0,
    };
    opposite && kick.r_min == other.r_min && kick.r_max == other.r_max && (!own_image || kick == other)
}
