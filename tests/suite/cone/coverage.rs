//! Areas and centroids of a disc clipped by lines and circles, against sums over thin strips, in
//! which they are elementary, and in known limits.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use moire::internal::oracle::coverage::{
    Covered, Cuts, EVERYTHING, NOTHING, ball_overlap, circle_overlap, segment,
};

use crate::lookup::bench::Rng;

const STRIPS: usize = 4000;

/// Returns the mean over strips of constant y; `span` returns the covered interval of a strip, if any.
fn strips(span: impl Fn(f64) -> Option<[f64; 2]>) -> Covered {
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    let height = 2.0 / STRIPS as f64;
    for i in 0..STRIPS {
        let y = (i as f64 + 0.5) * height - 1.0;
        let rim = (1.0 - y * y).sqrt();
        let Some([from, to]) = span(y) else { continue };
        let (from, to) = (from.max(-rim), to.min(rim));
        if from < to {
            area += (to - from) * height;
            moment += DVec2::new(0.5 * (to * to - from * from), (to - from) * y) * height;
        }
    }
    Covered { share: area / PI, center: if area > 0.0 { moment / area } else { DVec2::ZERO } }
}

fn strips_of_lines(lines: &[DVec3]) -> Covered {
    strips(|y| {
        let mut span = [-2.0, 2.0f64];
        for line in lines {
            let rest = line.y * y + line.z;
            match line.x {
                x if x > 0.0 => span[0] = span[0].max(-rest / x),
                x if x < 0.0 => span[1] = span[1].min(-rest / x),
                _ if rest < 0.0 => return None,
                _ => {}
            }
        }
        Some(span)
    })
}

fn of_lines(lines: &[DVec3]) -> Covered {
    let mut cuts = Cuts::default();
    lines.iter().for_each(|line| cuts.by(*line));
    cuts.covered()
}

/// Strips err where a line or the rim ends within one: by the strip's area, 5e-4 of the disc's radius times a
/// short length, a few times.
fn assert_alike(found: Covered, wanted: Covered, what: &str) {
    assert!((found.share - wanted.share).abs() < 1e-4, "{what}: {found:?}, {wanted:?}");
    let off = (found.center - wanted.center).length() * wanted.share;
    assert!(off < 2e-4, "{what}: {found:?}, {wanted:?}");
}

fn line(rng: &mut Rng, reach: f64) -> DVec3 {
    let angle = rng.between(0.0, 2.0 * PI);
    let scale = rng.between(0.1, 10.0);
    DVec3::new(angle.cos(), angle.sin(), rng.between(-reach, reach)) * scale
}

#[test]
fn lines_leave_what_strips_add_up_to() {
    let mut rng = Rng::new(3);
    for count in 1..=6 {
        for case in 0..200 {
            let lines: Vec<DVec3> = (0..count).map(|_| line(&mut rng, 0.9)).collect();
            assert_alike(of_lines(&lines), strips_of_lines(&lines), &format!("{count} lines, case {case}"));
        }
    }
}

#[test]
fn both_sides_of_a_line_make_the_whole() {
    let mut rng = Rng::new(5);
    for _ in 0..500 {
        let cut = line(&mut rng, 1.2);
        let others: Vec<DVec3> = (0..2).map(|_| line(&mut rng, 0.7)).collect();
        let with = |more: DVec3| of_lines(&[others[0], others[1], more]).share;
        let all = of_lines(&others).share;
        assert!((with(cut) + with(-cut) - all).abs() < 3e-5, "{others:?} cut by {cut:?}");
        assert!((of_lines(&[cut]).share + of_lines(&[-cut]).share - 1.0).abs() < 2e-5);
        assert_eq!(of_lines(&[cut, -cut]), NOTHING, "{cut:?}");
        assert_alike(of_lines(&[cut, cut]), of_lines(&[cut]), "the same line twice");
    }
}

#[test]
fn limits_of_lines() {
    let x = |c: f64| DVec3::new(1.0, 0.0, c);
    assert_eq!(of_lines(&[]), EVERYTHING);
    assert_eq!(of_lines(&[x(1.0)]), EVERYTHING, "touching from outside");
    assert_eq!(of_lines(&[x(-1.0)]), NOTHING, "touching from inside");
    assert_eq!(of_lines(&[x(1e30)]), EVERYTHING);
    assert_eq!(of_lines(&[x(f64::NAN)]), NOTHING);
    assert_eq!(of_lines(&[DVec3::new(0.0, 0.0, 1.0)]), EVERYTHING, "at infinity");
    assert_eq!(of_lines(&[DVec3::new(0.0, 0.0, -1.0)]), NOTHING);
    for c in [0.0, -0.0] {
        let half = of_lines(&[x(c)]);
        assert!((half.share - 0.5).abs() < 1e-8, "{half:?}");
        assert!((half.center - DVec2::new(4.0 / (3.0 * PI), 0.0)).length() < 1e-8, "{half:?}");
    }
    let quarter = of_lines(&[x(0.0), DVec3::new(0.0, 1.0, 0.0)]);
    assert!((quarter.share - 0.25).abs() < 1e-8 && (quarter.center.x - 4.0 / (3.0 * PI)).abs() < 1e-7);
    // A square of side 0.2 within the disc, and one around all of it.
    for (half, share) in [(0.1, 0.04 / PI), (3.0, 1.0)] {
        let sides = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(x, y)| DVec3::new(x, y, half));
        let square = of_lines(&sides);
        assert!((square.share - share).abs() < 1e-12 && square.center.length() < 1e-12, "{square:?}");
    }
}

#[test]
fn circles_leave_what_strips_add_up_to() {
    let mut rng = Rng::new(8);
    for case in 0..1000 {
        let radius = 10f64.powf(rng.between(-1.0, 2.0));
        let apart = (radius + rng.between(-1.0, 1.0)).max(0.0);
        let angle = rng.between(0.0, 2.0 * PI);
        let middle = apart * DVec2::new(angle.cos(), angle.sin());
        let found = circle_overlap(middle, radius, radius - apart);
        let wanted = strips(|y| {
            let rest = radius * radius - (y - middle.y).powi(2);
            (rest > 0.0).then(|| [middle.x - rest.sqrt(), middle.x + rest.sqrt()])
        });
        assert_alike(found, wanted, &format!("case {case}: radius {radius} at {middle}"));
    }
}

#[test]
fn limits_of_circles() {
    let at = |x: f64, radius: f64| circle_overlap(DVec2::new(x, 0.0), radius, radius - x);
    assert_eq!(at(3.0, 2.0), NOTHING, "touching from outside");
    assert_eq!(at(1.0, 2.0), EVERYTHING, "touching around");
    assert_eq!(at(0.0, 1.0), EVERYTHING, "the disc itself");
    assert_eq!(at(0.75, 0.25), Covered { share: 0.0625, center: DVec2::new(0.75, 0.0) }, "touching within");
    assert_eq!(at(0.0, 1e-6), NOTHING, "smaller than any share");
    // A slightly curved circle is close to a line.
    for edge in [-0.9, -0.3, 0.0, 0.4, 0.8] {
        let radius = 1e7;
        let circle = circle_overlap(DVec2::new(radius - edge, 0.0), radius, edge);
        assert_alike(circle, of_lines(&[DVec3::new(1.0, 0.0, edge)]), &format!("edge {edge}"));
        assert!((circle.share - of_lines(&[DVec3::new(1.0, 0.0, edge)]).share).abs() < 1e-6);
    }
    // The series and the function that it approximates.
    for angle in [0.009, 0.0099, 0.0101, 0.2f64] {
        let wanted = angle - angle.sin() * angle.cos();
        assert!((segment(angle.sin(), angle.cos()) / wanted - 1.0).abs() < 1e-8, "{angle}");
    }
}

/// Pixels of a picture are √π disc radii apart.
#[test]
fn small_balls_are_seen_in_equal_parts_wherever_they_are() {
    let mut rng = Rng::new(13);
    let pitch = PI.sqrt();
    for radius in [0.05, 0.2, 0.5] {
        for _ in 0..100 {
            let at = DVec2::new(rng.between(-0.5, 0.5), rng.between(-0.5, 0.5)) * pitch;
            let mut sum = 0.0;
            for i in 0..9 {
                let middle = at - pitch * DVec2::new(f64::from(i % 3 - 1), f64::from(i / 3 - 1));
                sum += ball_overlap(middle, radius, radius - middle.length()).share;
            }
            // Nine parts, each of which may be too small to count.
            assert!((sum - radius * radius).abs() < 9e-5, "radius {radius} at {at}: {sum}");
        }
    }
}

#[test]
fn balls_grow_without_a_jump() {
    for apart in [0.0, 0.4, 0.9, 1.3] {
        let share =
            |radius: f64| ball_overlap(DVec2::new(apart, 0.3), radius, radius - apart.hypot(0.3)).share;
        for i in 0..2000 {
            let radius = 1e-3 * f64::from(i);
            let step = share(radius + 1e-3) - share(radius);
            assert!((-1e-3..1e-2).contains(&step), "at {apart}, radius {radius}: {step}");
        }
    }
}
