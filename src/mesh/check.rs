//! What must hold for a mesh of any format but glTF: finite numbers, indices of what exists, a number of triangles within the
//! limit.

use rayon::prelude::*;

use super::{Fault, Mesh, winding};

/// Elements that a thread takes at once.
const AT_ONCE: usize = 1 << 13;

/// Refuses more triangles than `most`.
pub(super) fn count(triangles: usize, most: usize) -> Result<(), Fault> {
    if triangles <= most {
        return Ok(());
    }
    Err(Fault::new("", format!("it has more than {most} triangles, the most a scene may have")))
}

/// Returns the mesh if its positions and texture coordinates are finite and all its indices in range; normals that are not
/// finite count as none, and fronts are where normals point.
pub(super) fn checked(mut mesh: Mesh) -> Result<Mesh, Fault> {
    let infinite = |what: &str, index: usize| Fault::new(format!("{what} {index}"), "a number is not finite");
    if let Some(i) = first(&mesh.positions, |p| !p.is_finite()) {
        return Err(infinite("position", i));
    }
    if let Some(i) = first(&mesh.uvs, |uv| !uv.is_finite()) {
        return Err(infinite("texture coordinate", i));
    }
    let wrong = |index: usize| {
        let triangle = mesh.triangles.get(index);
        let lists = [
            ("position", Some(triangle.positions), mesh.positions.len()),
            ("texture coordinate", triangle.uvs, mesh.uvs.len()),
            ("normal", triangle.normals, mesh.normals.len()),
        ];
        lists.into_iter().find_map(|(what, indices, count)| {
            let index = indices.into_iter().flatten().find(|&index| index as usize >= count)?;
            Some(format!("{what} {index} does not exist; the file has {count}"))
        })
    };
    let all = (0..mesh.triangles.len()).into_par_iter().with_min_len(AT_ONCE);
    if let Some((i, what)) = all.find_map_first(|i| Some((i, wrong(i)?))) {
        return Err(Fault::new(format!("triangle {i}"), what));
    }
    winding::settle(&mut mesh);
    Ok(mesh)
}

/// Returns the place of the first element that is wrong.
fn first<T: Sync>(list: &[T], is_wrong: impl Fn(&T) -> bool + Sync + Send) -> Option<usize> {
    let of_run = |(run, elements): (usize, &[T])| Some(run * AT_ONCE + elements.iter().position(&is_wrong)?);
    list.par_chunks(AT_ONCE).enumerate().find_map_first(of_run)
}
