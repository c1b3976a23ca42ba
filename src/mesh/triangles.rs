//! Triangles of a mesh in little memory, as meshes have millions: a list of corners, and lists of what else corners or
//! triangles have only where that is not the same for all. Input and output: single triangles in the order of the file.

use rayon::prelude::*;

use super::MeshTriangle;

/// Triangles that a thread looks at together.
const AT_ONCE: usize = 1 << 12;

/// Stands for no index.
const NONE: u32 = u32::MAX;

/// Triangles over shared positions, texture coordinates and normals.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// Into the positions.
    positions: Vec<[u32; 3]>,
    uvs: Corners,
    normals: Corners,
    materials: Materials,
}

/// Indices of one attribute at the corners of all triangles.
#[derive(Clone, Debug, Default)]
enum Corners {
    /// None has any.
    #[default]
    Absent,
    /// Those of the positions.
    Same,
    /// A list as long as that of the positions, `NONE` where a triangle has none.
    Own(Vec<[u32; 3]>),
}

/// Indices of materials.
#[derive(Clone, Debug)]
enum Materials {
    All(Option<u32>),
    /// A list as long as that of the positions.
    Each(Vec<u32>),
}

impl Default for Materials {
    fn default() -> Materials {
        Materials::All(None)
    }
}

impl Triangles {
    /// Makes triangles of which each corner has one index for all that it has.
    pub fn of_vertices(
        positions: Vec<[u32; 3]>,
        has_uvs: bool,
        has_normals: bool,
        material: Option<u32>,
    ) -> Triangles {
        let corners = |has: bool| if has { Corners::Same } else { Corners::Absent };
        let (uvs, normals) = (corners(has_uvs), corners(has_normals));
        Triangles { positions, uvs, normals, materials: Materials::All(material) }
    }

    /// Returns their number.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Returns the indices of all corners into the positions.
    pub fn positions(&self) -> &[[u32; 3]] {
        &self.positions
    }

    /// Returns the triangle at a place.
    ///
    /// # Panics
    ///
    /// If there is none.
    pub fn get(&self, index: usize) -> MeshTriangle {
        let positions = self.positions[index];
        MeshTriangle {
            positions,
            uvs: self.uvs.get(index, positions),
            normals: self.normals.get(index, positions),
            material: self.material(index),
        }
    }

    /// Returns the material of the triangle at a place.
    pub fn material(&self, index: usize) -> Option<u32> {
        match &self.materials {
            Materials::All(material) => *material,
            Materials::Each(list) => Some(list[index]).filter(|&material| material != NONE),
        }
    }

    /// Returns true if all have the same material, or none.
    pub fn have_one_material(&self) -> bool {
        match &self.materials {
            Materials::All(_) => true,
            Materials::Each(list) => list.par_iter().all(|material| *material == list[0]),
        }
    }

    /// Gives all of them the material of this index, or none.
    pub fn set_material(&mut self, material: Option<u32>) {
        self.materials = Materials::All(material);
    }

    /// Returns the triangles in their order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = MeshTriangle> + DoubleEndedIterator {
        (0..self.len()).map(|index| self.get(index))
    }

    /// Adds a triangle.
    pub fn push(&mut self, triangle: MeshTriangle) {
        let MeshTriangle { positions, uvs, normals, material } = triangle;
        self.uvs.push(uvs, positions, &self.positions);
        self.normals.push(normals, positions, &self.positions);
        self.materials.push(material, self.positions.len());
        self.positions.push(positions);
    }

    /// Turns those around of which this is true; returns their number.
    pub fn turn_where(&mut self, turns: impl Fn(&MeshTriangle) -> bool + Sync) -> usize {
        let places = (0..self.len()).into_par_iter().with_min_len(AT_ONCE);
        let turned: Vec<usize> = places.filter(|&place| turns(&self.get(place))).collect();
        for &place in &turned {
            self.positions[place].swap(1, 2);
            self.uvs.turn(place);
            self.normals.turn(place);
        }
        turned.len()
    }

    /// Adds the triangles of another list.
    pub fn append(&mut self, others: Triangles) {
        if self.is_empty() {
            *self = others;
        } else {
            self.extend(others.iter());
        }
    }
}

impl Corners {
    fn get(&self, index: usize, positions: [u32; 3]) -> Option<[u32; 3]> {
        match self {
            Corners::Absent => None,
            Corners::Same => Some(positions),
            Corners::Own(list) => Some(list[index]).filter(|corners| *corners != [NONE; 3]),
        }
    }

    /// Turns the triangle at a place around, whose positions are turned as well.
    fn turn(&mut self, place: usize) {
        if let Corners::Own(list) = self {
            list[place].swap(1, 2);
        }
    }

    /// Adds the indices of a triangle with these positions behind `before`.
    fn push(&mut self, own: Option<[u32; 3]>, positions: [u32; 3], before: &[[u32; 3]]) {
        match (&mut *self, own) {
            (Corners::Absent, None) => {}
            (Corners::Same, Some(own)) if own == positions => {}
            (Corners::Absent, Some(own)) if before.is_empty() && own == positions => *self = Corners::Same,
            (Corners::Own(list), own) => list.push(own.unwrap_or([NONE; 3])),
            (Corners::Absent, own) => {
                let mut list = vec![[NONE; 3]; before.len()];
                list.push(own.unwrap_or([NONE; 3]));
                *self = Corners::Own(list);
            }
            (Corners::Same, own) => {
                let mut list = before.to_vec();
                list.push(own.unwrap_or([NONE; 3]));
                *self = Corners::Own(list);
            }
        }
    }
}

impl Materials {
    /// Adds the material of a triangle behind `before` others.
    fn push(&mut self, material: Option<u32>, before: usize) {
        match self {
            Materials::All(all) if *all == material => {}
            Materials::All(all) if before == 0 => *all = material,
            Materials::All(all) => {
                let mut list = vec![all.unwrap_or(NONE); before];
                list.push(material.unwrap_or(NONE));
                *self = Materials::Each(list);
            }
            Materials::Each(list) => list.push(material.unwrap_or(NONE)),
        }
    }
}

impl Extend<MeshTriangle> for Triangles {
    fn extend<I: IntoIterator<Item = MeshTriangle>>(&mut self, triangles: I) {
        let triangles = triangles.into_iter();
        self.positions.reserve(triangles.size_hint().0);
        triangles.for_each(|triangle| self.push(triangle));
    }
}

impl FromIterator<MeshTriangle> for Triangles {
    fn from_iter<I: IntoIterator<Item = MeshTriangle>>(triangles: I) -> Triangles {
        let mut all = Triangles::default();
        all.extend(triangles);
        all
    }
}

/// Equal triangles are equal however they are held.
impl PartialEq for Triangles {
    fn eq(&self, other: &Triangles) -> bool {
        self.iter().eq(other.iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles whose attributes come, differ and go, in every order of four.
    #[test]
    fn what_was_added_comes_back() {
        let same = [0, 1, 2];
        let uvs = [None, Some(same), Some([7, 8, 9]), Some([NONE, 0, NONE])];
        let materials = [None, Some(0), Some(3)];
        let mut kinds = Vec::new();
        for uvs in uvs {
            for normals in [None, Some(same), Some([4, 5, 6])] {
                kinds.extend(materials.map(|material| MeshTriangle {
                    positions: same,
                    uvs,
                    normals,
                    material,
                }));
            }
        }
        for a in &kinds {
            for b in &kinds {
                for c in [&kinds[0], &kinds[kinds.len() - 1], a] {
                    let expected = [*a, *a, *b, *c];
                    let all: Triangles = expected.into_iter().collect();
                    assert_eq!(all.iter().collect::<Vec<_>>(), expected);
                    let mut joined: Triangles = expected[..2].iter().copied().collect();
                    joined.append(expected[2..].iter().copied().collect());
                    assert_eq!(joined, all);
                    assert_eq!(all.have_one_material(), a.material == b.material && b.material == c.material);
                }
            }
        }
    }

    #[test]
    fn turned_triangles_are_seen_from_their_backs() {
        let of = |own: [u32; 3], material| MeshTriangle {
            positions: [own[0], own[1] + 4, own[2]],
            uvs: Some(own),
            normals: None,
            material,
        };
        for uvs_differ in [false, true] {
            let mut expected: Vec<MeshTriangle> =
                [[0, 1, 2], [2, 1, 3], [4, 0, 1]].map(|own| of(own, Some(1))).to_vec();
            if !uvs_differ {
                expected.iter_mut().for_each(|triangle| triangle.uvs = Some(triangle.positions));
            }
            let mut all: Triangles = expected.iter().copied().collect();
            assert_eq!(all.turn_where(|triangle| triangle.positions[0] == 2), 1);
            expected[1] = expected[1].reversed();
            assert_eq!(all.iter().collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn corners_of_one_index_take_no_lists_of_their_own() {
        let of = |positions: [u32; 3]| MeshTriangle {
            positions,
            uvs: Some(positions),
            normals: None,
            material: Some(1),
        };
        let all: Triangles = [of([0, 1, 2]), of([2, 1, 3])].into_iter().collect();
        assert!(matches!((&all.uvs, &all.normals), (Corners::Same, Corners::Absent)));
        assert!(matches!(all.materials, Materials::All(Some(1))));
        assert_eq!(all, Triangles::of_vertices(vec![[0, 1, 2], [2, 1, 3]], true, false, Some(1)));
    }
}
