//! Names at the ends of lines. Input: the names with the ends' positions, important ones first. Output: a place for each
//! where it covers no other name and no mark, as near to its end as there is room.

/// Pixels of a line of text, and of a letter on average.
const HEIGHT: f64 = 14.0;
const LETTER: f64 = 6.7;
/// Between an end and its name.
const GAP: f64 = 10.0;
/// How far a name may move from its end before a line must lead to it.
const NEAR: f64 = 9.0;
/// How many steps a name may move up or down.
const STEPS: i32 = 60;
const STEP: f64 = 7.0;

pub(super) struct Label<'a> {
    pub text: &'a str,
    /// The end of its line.
    pub end: [f64; 2],
}

/// The place of a name: its left end on the middle line of its letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placed {
    pub at: [f64; 2],
    /// True if it is so far from its end that a line has to lead there.
    pub is_led: bool,
}

/// A rectangle: left, top, right, bottom.
pub(super) type Area = [f64; 4];

/// Returns what a name covers that begins at a place, on the middle line of its letters.
pub(super) fn area([x, y]: [f64; 2], text: &str) -> Area {
    [x, y - 0.5 * HEIGHT, x + text.chars().count() as f64 * LETTER, y + 0.5 * HEIGHT]
}

/// Places names within `bounds`. `taken`: areas to be kept free.
pub(super) fn place(labels: &[Label<'_>], bounds: Area, taken: &[Area]) -> Vec<Placed> {
    let mut areas = taken.to_vec();
    let mut found = Vec::with_capacity(labels.len());
    for label in labels {
        let width = area([0.0, 0.0], label.text)[2];
        let x = (label.end[0] + GAP).min(bounds[2] - width);
        let area = |y: f64| area([x, y], label.text);
        let offsets = (0..=STEPS).flat_map(|k| [f64::from(k) * STEP, -f64::from(k) * STEP]);
        let places = offsets.map(|offset| label.end[1] + offset);
        let mut inside = places.filter(|y| area(*y)[1] >= bounds[1] && area(*y)[3] <= bounds[3]);
        let y = inside.find(|y| !areas.iter().any(|other| overlap(&area(*y), other)));
        // Where there is no room at all, names have to cover each other.
        let y = y.unwrap_or(label.end[1]);
        areas.push(area(y));
        found.push(Placed { at: [x, y], is_led: (y - label.end[1]).abs() > NEAR || x < label.end[0] });
    }
    found
}

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn areas(labels: &[Label<'_>], placed: &[Placed]) -> Vec<Area> {
        labels.iter().zip(placed).map(|(label, place)| area(place.at, label.text)).collect()
    }

    #[test]
    fn names_of_lines_that_end_together_cover_neither_each_other_nor_marks() {
        let texts = ["multi-jittered", "Sobol-Owen", "stratified", "EWA, cone footprint", "random", "Halton"];
        let ends = [300.0, 301.0, 302.0, 300.0, 300.5, 418.0];
        let labels: Vec<Label<'_>> =
            texts.iter().zip(ends).map(|(text, y)| Label { text, end: [600.0, y] }).collect();
        let mark = [605.0, 290.0, 615.0, 300.0];
        let placed = place(&labels, [0.0, 16.0, 860.0, 436.0], &[mark]);
        let areas = areas(&labels, &placed);
        for (i, a) in areas.iter().enumerate() {
            assert!(a[1] >= 16.0 && a[3] <= 436.0 && a[2] <= 860.0, "{a:?} is outside");
            assert!(!overlap(a, &mark) && !areas[..i].iter().any(|b| overlap(a, b)), "{a:?} covers another");
        }
        assert!(!placed[5].is_led && placed.iter().filter(|p| p.is_led).count() >= 2, "{placed:?}");
    }

    #[test]
    fn names_that_would_leave_the_plot_move_to_the_left() {
        let labels = [Label { text: "a long name of a method", end: [850.0, 100.0] }];
        let placed = place(&labels, [0.0, 16.0, 860.0, 436.0], &[]);
        assert!(areas(&labels, &placed)[0][2] <= 860.0 && placed[0].is_led);
    }
}
