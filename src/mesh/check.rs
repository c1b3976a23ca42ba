//! What must hold for a mesh of any format: finite numbers, indices of what exists, a number of triangles within the
//! limit.

use super::{Fault, Mesh};

/// Refuses more triangles than `most`.
pub(super) fn count(triangles: usize, most: usize) -> Result<(), Fault> {
    if triangles <= most {
        return Ok(());
    }
    Err(Fault::new("", format!("it has more than {most} triangles, the most a scene may have")))
}

/// Returns the mesh if all its numbers are finite and all its indices in range.
pub(super) fn checked(mesh: Mesh) -> Result<Mesh, Fault> {
    let infinite = |what: &str, index: usize| Fault::new(format!("{what} {index}"), "a number is not finite");
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(infinite("position", i));
    }
    if let Some(i) = mesh.uvs.iter().position(|uv| !uv.is_finite()) {
        return Err(infinite("texture coordinate", i));
    }
    if let Some(i) = mesh.normals.iter().position(|n| !n.is_finite()) {
        return Err(infinite("normal", i));
    }
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let lists = [
            ("position", Some(triangle.positions), mesh.positions.len()),
            ("texture coordinate", triangle.uvs, mesh.uvs.len()),
            ("normal", triangle.normals, mesh.normals.len()),
        ];
        for (what, indices, count) in lists {
            let wrong = indices.into_iter().flatten().find(|&index| index as usize >= count);
            if let Some(index) = wrong {
                let what = format!("{what} {index} does not exist; the file has {count}");
                return Err(Fault::new(format!("triangle {i}"), what));
            }
        }
    }
    Ok(mesh)
}
