//! Names at the ends of lines. Input: the names with the ends' positions, important ones first. Output: a place for each
//! where it covers no other name, as near to its end as there is room and away from marks and lines.
//!
//! Names whose ends are so near that they would cover each other stand in one column, in the order of the ends, so that the
//! lines that lead to them do not cross.

/// Pixels of a line of text, and of a letter on average.
const HEIGHT: f64 = 14.0;
const LETTER: f64 = 6.7;
/// Between an end and its name, and more of that where lines lead to a column.
const GAP: f64 = 10.0;
const LED_GAP: f64 = 14.0;
/// How far a name may move from its end before a line must lead to it.
const NEAR: f64 = 9.0;
/// Ends that are further apart from left to right have names of their own, wherever there is room.
const TOGETHER: f64 = 40.0;
/// How many steps names may move up or down, and a column to the right.
const STEPS: i32 = 60;
const STEP: f64 = 7.0;
const ASIDE: [f64; 4] = [0.0, 18.0, 40.0, 70.0];
/// What standing on the other side of an end counts as.
const BEFORE: f64 = 30.0;
/// What covering another name, a mark, or a piece of a line costs, against a step.
const COVERED_NAME: f64 = 1e4;
const COVERED_MARK: f64 = 25.0;
const COVERED_LINE: f64 = 0.7;

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
    /// Where a line would lead to.
    pub joint: [f64; 2],
}

/// A rectangle: left, top, right, bottom.
pub(super) type Area = [f64; 4];

/// What names should keep clear of: marks and other texts, and pieces of lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Obstacles {
    pub marks: Vec<Area>,
    pub lines: Vec<Area>,
}

impl Obstacles {
    /// Adds a line from one point to another, in pieces.
    pub fn add_line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
        const PIECE: f64 = 6.0;
        let pieces = ((x2 - x1).hypot(y2 - y1) / PIECE).ceil().max(1.0) as u32;
        self.lines.extend((0..=pieces).map(|i| {
            let part = f64::from(i) / f64::from(pieces);
            let [x, y] = [x1 + part * (x2 - x1), y1 + part * (y2 - y1)];
            [x - 1.0, y - 1.0, x + 1.0, y + 1.0]
        }));
    }

    /// Returns what it costs to cover an area.
    pub fn cost(&self, area: &Area) -> f64 {
        let covered = |all: &[Area]| all.iter().filter(|other| overlap(area, other)).count() as f64;
        COVERED_MARK * covered(&self.marks) + COVERED_LINE * covered(&self.lines)
    }
}

/// Returns what a name covers that begins at a place, on the middle line of its letters.
pub(super) fn area([x, y]: [f64; 2], text: &str) -> Area {
    [x, y - 0.5 * HEIGHT, x + text.chars().count() as f64 * LETTER, y + 0.5 * HEIGHT]
}

/// Places names within `bounds`.
pub(super) fn place(labels: &[Label<'_>], bounds: Area, obstacles: &Obstacles) -> Vec<Placed> {
    let mut found = vec![Placed { at: [0.0; 2], is_led: false, joint: [0.0; 2] }; labels.len()];
    let mut names: Vec<Area> = Vec::new();
    for group in groups(labels) {
        let width = group.iter().map(|i| area([0.0; 2], labels[*i].text)[2]).fold(0.0, f64::max);
        let end = group.iter().map(|i| labels[*i].end[0]).fold(0.0, f64::max);
        let gap = if group.len() > 1 { LED_GAP } else { GAP };
        let ys = apart(&group.iter().map(|i| labels[*i].end[1]).collect::<Vec<_>>());
        let mut best: Option<(f64, Vec<[f64; 2]>)> = None;
        // One name alone may stand on the other side of its end.
        let before = (group.len() == 1).then_some(end - gap - width);
        let after = ASIDE.iter().map(|aside| (aside, (end + gap + aside).min(bounds[2] - width)));
        let columns = after.chain(before.map(|x| (&BEFORE, x.max(bounds[0]))));
        for ((aside, x), step) in columns.flat_map(|at| (-STEPS..=STEPS).map(move |k| (at, k))) {
            let places: Vec<[f64; 2]> = ys.iter().map(|y| [x, y + f64::from(step) * STEP]).collect();
            let areas = group.iter().zip(&places).map(|(i, at)| area(*at, labels[*i].text));
            let mut cost = f64::from(step.abs()) + 0.1 * aside;
            for own in areas {
                let outside = own[1] < bounds[1] || own[3] > bounds[3];
                let covered = names.iter().filter(|other| overlap(&own, other)).count();
                cost += obstacles.cost(&own)
                    + COVERED_NAME * covered as f64
                    + if outside { COVERED_NAME } else { 0.0 };
            }
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, places));
            }
        }
        for (i, at) in group.iter().zip(best.map_or_else(Vec::new, |best| best.1)) {
            let end = labels[*i].end;
            names.push(area(at, labels[*i].text));
            let right = area(at, labels[*i].text)[2];
            let beside = if at[0] < end[0] { end[0] - right } else { at[0] - end[0] };
            let is_led = (at[1] - end[1]).abs() > NEAR || !(0.0..=LED_GAP).contains(&beside);
            let joint = [if at[0] < end[0] { right.min(end[0]) } else { at[0] - 2.0 }, at[1]];
            found[*i] = Placed { at, is_led, joint };
        }
    }
    found
}

/// Returns groups of labels that would cover each other at their ends, each from above to below; larger groups first.
fn groups(labels: &[Label<'_>]) -> Vec<Vec<usize>> {
    let own = |i: usize| area([labels[i].end[0] + GAP, labels[i].end[1]], labels[i].text);
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in 0..labels.len() {
        let near = |other: usize| (labels[i].end[0] - labels[other].end[0]).abs() <= TOGETHER;
        let touches = |group: &Vec<usize>| group.iter().any(|o| near(*o) && overlap(&own(i), &own(*o)));
        let (touching, mut others): (Vec<_>, Vec<_>) = groups.into_iter().partition(touches);
        others.push(touching.into_iter().flatten().chain([i]).collect());
        groups = others;
    }
    for group in &mut groups {
        group.sort_by(|a, b| labels[*a].end[1].total_cmp(&labels[*b].end[1]));
    }
    groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
    groups
}

/// Returns sorted heights a line of text apart at least, moved as little as that takes (adjacent violators are pooled).
fn apart(heights: &[f64]) -> Vec<f64> {
    // Of each pool: the mean of heights less those of lines above, and how many there are.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (i, height) in heights.iter().enumerate() {
        pools.push((height - i as f64 * HEIGHT, 1));
        while let [.., a, b] = pools[..]
            && a.0 > b.0
        {
            let count = a.1 + b.1;
            pools.truncate(pools.len() - 2);
            pools.push(((a.0 * a.1 as f64 + b.0 * b.1 as f64) / count as f64, count));
        }
    }
    let all = pools.iter().flat_map(|(at, count)| std::iter::repeat_n(*at, *count));
    all.enumerate().map(|(i, at)| at + i as f64 * HEIGHT).collect()
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
        let placed = place(
            &labels,
            [0.0, 16.0, 860.0, 436.0],
            &Obstacles { marks: vec![mark], ..Obstacles::default() },
        );
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
        let placed = place(&labels, [0.0, 16.0, 860.0, 436.0], &Obstacles::default());
        assert!(areas(&labels, &placed)[0][2] <= 860.0 && placed[0].is_led);
    }

    #[test]
    fn names_of_lines_that_end_together_are_in_the_order_of_the_ends_and_near_them() {
        let ends = [330.0, 300.0, 310.0, 305.0, 320.0, 301.0, 315.0, 300.5];
        let labels: Vec<Label<'_>> =
            ends.iter().map(|y| Label { text: "a method", end: [400.0, *y] }).collect();
        let placed = place(&labels, [0.0, 16.0, 860.0, 436.0], &Obstacles::default());
        for (i, a) in placed.iter().enumerate() {
            assert!((a.at[1] - ends[i]).abs() <= 0.5 * 8.0 * HEIGHT, "{a:?} is far from {}", ends[i]);
            for (j, b) in placed.iter().enumerate() {
                assert!(ends[i] >= ends[j] || a.at[1] < b.at[1], "lines to {a:?} and {b:?} cross");
            }
        }
    }

    #[test]
    fn names_keep_off_lines_where_there_is_room_beside() {
        let labels = [Label { text: "a method", end: [400.0, 200.0] }];
        let mut obstacles = Obstacles::default();
        obstacles.add_line([400.0, 200.0], [700.0, 205.0]);
        let placed = place(&labels, [0.0, 16.0, 860.0, 436.0], &obstacles);
        let own = areas(&labels, &placed)[0];
        assert!(!obstacles.lines.iter().any(|line| overlap(&own, line)), "{own:?} lies on the line");
        assert!((placed[0].at[1] - 200.0).abs() < 30.0, "{placed:?}");
    }
}
