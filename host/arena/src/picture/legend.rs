//! `legend`: legend of a trial's figure. The part below the field.

use super::page::{Page, Px, bold, font};
use super::{ATTACKERS, BALL, FAINT, INK, OPPONENTS, SIDE};
use crate::recording::{Recording, Start};
use figures::Anchor;

/// Draws signs and list from `top` down; returns the height that the figure needs.
pub(super) fn draw(page: &mut Page, recording: &Recording, starts: &[&Start], width: f32, top: f32) -> f32 {
    let y = top + 24.0;
    signs(page, y);
    let rows = starts.len().min(LISTED).div_ceil(2);
    let list = y + 30.0;
    for (i, start) in starts.iter().take(LISTED).enumerate() {
        // Down the left column, then down the right one.
        let (column, row) = (i / rows.max(1), i % rows.max(1));
        let at = Px::new(SIDE + 11.0 + column as f32 * width * 0.5, list + row as f32 * ROW);
        entry(page, recording, start, i + 1, at);
    }
    let mut bottom = list + rows as f32 * ROW;
    if starts.len() > LISTED {
        let text = format!("… and {} more", starts.len() - LISTED);
        page.text(Px::new(SIDE, bottom + 5.0), &text, Anchor::Start, font(13.0, FAINT));
        bottom += ROW;
    }
    if starts.is_empty() { y + 22.0 } else { bottom }
}

/// A gameplay's number on a white disc.
pub(super) fn number(page: &mut Page, at: Px, number: usize) {
    page.circle(at, 10.5, &format!(r#"fill="white" stroke="{INK}" stroke-width="1.5""#));
    page.text(at.moved(0.0, 4.3), &number.to_string(), Anchor::Middle, bold(12.0, INK));
}

fn entry(page: &mut Page, recording: &Recording, start: &Start, n: usize, at: Px) {
    number(page, at, n);
    let cycle = recording.report.as_ref().and_then(|report| report.cycles.get(start.cycle));
    let end = cycle.map_or("", |cycle| cycle.end).replace('-', " ");
    let until = cycle.map_or(start.time, |cycle| cycle.end_s as f32);
    let players = start.players.join(" + ");
    let copy = if start.symmetry == "identity" { String::new() } else { format!(" · {}", start.symmetry) };
    page.text(at.moved(18.0, 4.5), &start.case, Anchor::Start, bold(12.5, INK));
    let details = format!("{players}{copy} · {:.1}–{until:.1} s · {end}", start.time);
    page.text(at.moved(220.0, 4.5), &details, Anchor::Start, font(12.0, FAINT));
}

fn signs(page: &mut Page, y: f32) {
    let mut x = SIDE + 8.0;
    let print = |page: &mut Page, x: &mut f32, after: f32, description: &str| {
        page.text(Px::new(*x + after, y + 4.5), description, Anchor::Start, font(13.0, FAINT));
        // The mean advance of a wide sans-serif at 13 px.
        *x += after + description.chars().count() as f32 * 7.2 + 22.0;
    };
    let (blue, grey) = (ATTACKERS[0], OPPONENTS[0]);
    page.circle(Px::new(x, y), 7.0, &format!(r#"fill="white" stroke="{blue}" stroke-width="2""#));
    page.circle(Px::new(x + 20.0, y), 7.0, &format!(r#"fill="{blue}" stroke="{blue}" stroke-width="2""#));
    print(page, &mut x, 33.0, "attacker: start, end");
    let square = |fill| format!(r#"fill="{fill}" stroke="{grey}" stroke-width="2" rx="2""#);
    page.rect(Px::new(x - 7.0, y - 7.0), 13.0, 13.0, &square("white"));
    page.rect(Px::new(x + 13.0, y - 7.0), 13.0, 13.0, &square(grey));
    print(page, &mut x, 33.0, "opponent");
    page.circle(Px::new(x, y), 6.0, &format!(r#"fill="{BALL}" stroke="{INK}" stroke-width="2""#));
    print(page, &mut x, 13.0, "ball at the end");
    let (from, to) = (Px::new(x - 4.0, y), Px::new(x + 24.0, y));
    page.line(from, to, &format!(r#"stroke="{blue}" stroke-width="6" stroke-linecap="round""#));
    print(page, &mut x, 34.0, "ball carried");
    let (from, to) = (Px::new(x - 4.0, y), Px::new(x + 26.0, y));
    let dotted = r#"stroke-width="4.5" stroke-linecap="round" stroke-dasharray="0.1 9""#;
    page.line(from, to, &format!(r#"stroke="{blue}" {dotted}"#));
    page.arrowhead(to.moved(9.0, 0.0), (1.0, 0.0), 13.0, blue);
    print(page, &mut x, 42.0, "ball kicked, by whom");
    number(page, Px::new(x, y), 1);
    print(page, &mut x, 16.0, "a gameplay begins");
}

/// Gameplays in the list; more would make it longer than the field is high.
pub(super) const LISTED: usize = 24;
/// Height of a row of the list, px.
const ROW: f32 = 26.0;
