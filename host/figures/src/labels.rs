//! `labels`: label placement without overlaps. Symbols are registered first, then each name takes the first
//! free side.

use crate::{Anchor, At, Font, Svg, width};

/// Names to be placed, and occupied areas. mm.
#[derive(Debug, Default)]
pub(super) struct Labels {
    taken: Vec<[At; 2]>,
    waiting: Vec<Label>,
}

#[derive(Debug)]
struct Label {
    at: At,
    /// From the symbol's middle to its edge.
    reach: f64,
    text: String,
    fill: &'static str,
}

impl Labels {
    /// Registers a symbol of this half width that no name may cover.
    pub(super) fn keep_free(&mut self, [x, y]: At, half: f64) {
        self.taken.push([[x - half, y - half], [x + half, y + half]]);
    }

    /// Registers a name for the symbol at `at`.
    pub(super) fn name(&mut self, at: At, reach: f64, text: impl Into<String>, fill: &'static str) {
        self.waiting.push(Label { at, reach, text: text.into(), fill });
    }

    /// The first of these positions where a symbol of this half width covers nothing registered so far.
    pub(super) fn free(&self, places: impl IntoIterator<Item = At>, half: f64) -> Option<At> {
        places.into_iter().find(|[x, y]| {
            let place = [[x - half, y - half], [x + half, y + half]];
            !self.taken.iter().any(|other| overlap(&place, other))
        })
    }

    /// Writes all names, in the order of registration; where every side is occupied, above.
    pub(super) fn write(&mut self, svg: &mut Svg, size: f64, halo: &str) {
        for label in std::mem::take(&mut self.waiting) {
            let places = places(&label, size);
            let free = places.iter().find(|place| !self.taken.iter().any(|other| overlap(place, other)));
            let place = free.unwrap_or(&places[0]);
            let [[left, low], [right, _]] = *place;
            let font = Font { size, fill: label.fill, bold: false, halo: Some(halo) };
            let middle = f64::midpoint(left, right);
            svg.text([middle, low + size * 0.15], &label.text, Anchor::Middle, font);
            self.taken.push(*place);
        }
    }
}

/// Above, below, right, left, then farther out.
fn places(label: &Label, size: f64) -> [[At; 2]; 12] {
    let ([x, y], half) = (label.at, width(&label.text, size) * 0.5);
    let sides = [0.0, 1.1, 2.2].map(|farther| {
        let reach = label.reach + size * farther;
        let (up, out) = (reach + size * 0.6, reach + half + size * 0.2);
        [[x, y + up], [x, y - up], [x + out, y], [x - out, y]]
    });
    std::array::from_fn(|i| {
        let [x, y] = sides[i / 4][i % 4];
        [[x - half, y - size * 0.5], [x + half, y + size * 0.5]]
    })
}

fn overlap([low, high]: &[At; 2], [other_low, other_high]: &[At; 2]) -> bool {
    (0..2).all(|axis| low[axis] < other_high[axis] && other_low[axis] < high[axis])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_names_of_one_place_do_not_lie_on_each_other() {
        let label = Label { at: [0.0, 0.0], reach: 10.0, text: "tm1".to_owned(), fill: "" };
        let places = places(&label, 10.0);
        // Above, the text's middle is 10 + 0.6 × 10 mm from the symbol's.
        assert!((f64::midpoint(places[0][0][1], places[0][1][1]) - 16.0).abs() < 1e-9);
        let mut labels = Labels::default();
        labels.name([0.0, 0.0], 10.0, "tm1", "");
        labels.name([0.0, 0.0], 10.0, "tm2", "");
        let mut svg = Svg::default();
        labels.write(&mut svg, 10.0, "");
        let body = svg.finish([0.0; 2], [1.0; 2], 1.0, "", "");
        assert_eq!(labels.free([[0.0, 16.0], [0.0, 40.0]], 4.0), Some([0.0, 40.0]));
        // The second goes below: baselines at 16 − 5 + 1.5 and −16 − 5 + 1.5 mm, written with y down.
        assert!(body.contains(r#"y="-12.5""#) && body.contains(r#"y="19.5""#), "{body}");
    }
}
