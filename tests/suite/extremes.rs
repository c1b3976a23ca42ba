//! Every case of the stability report on the device under test: no error above its bound.

use moire::internal::core::progress::NoProgress;
use moire::internal::lab::stability::all;
use moire::internal::lab::stability::case::Bench;

use crate::stage::device;

fn holds(group: &str) {
    let gpu = device();
    let bench = Bench::new(&gpu, &NoProgress);
    let mut complaints = Vec::new();
    for case in all().iter().filter(|case| case.group == group) {
        let points = (case.run)(&bench).unwrap();
        let worst = points.iter().max_by(|a, b| a.error.total_cmp(&b.error)).unwrap();
        println!(
            "{group}: {}: {:.3e} of {:.3e} at {:e}, {}",
            case.name, worst.error, case.bound, worst.parameter, worst.place
        );
        complaints.extend(points.iter().filter(|p| p.error > case.bound).map(|p| {
            format!(
                "{}: {:.3e} {} at {:e}, {}; bound {:.3e}",
                case.name, p.error, case.unit, p.parameter, p.place, case.bound
            )
        }));
    }
    assert!(complaints.is_empty(), "{group}:\n{}", complaints.join("\n"));
}

#[test]
fn texels_at_the_ends_of_f32() {
    holds("texels");
}

#[test]
fn footprints_of_any_size() {
    holds("footprints");
}

#[test]
fn procedural_textures_anywhere() {
    holds("procedurals");
}

#[test]
fn seams_and_poles() {
    holds("seams");
}
