//! Lists of a packed scene → the bytes of its scene buffer, and where each list begins.

use super::PackedScene;
use crate::schema::layout::{self, Header, bytes_of};

/// Room in which short lists end.
const LIST_BYTES: usize = 64 * 16;

/// Where each list begins in the scene buffer, in units of 16 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    pub planes: u32,
    pub spheres: u32,
    pub triangles: u32,
    pub lights: u32,
    pub materials: u32,
    pub uv_projections: u32,
    pub textures: u32,
    pub samplers: u32,
    pub procedurals: u32,
    pub motions: u32,
    pub pixel_filter: u32,
}

impl PackedScene {
    /// The scene buffer and where its lists begin: that of the pixel filter and then the short ones first, so
    /// that all of them lie in the head. Close together, as devices cache few of them; or, where there is
    /// room, in steps, so that all small scenes have one compiled pipeline that keeps everything.
    pub fn scene_bytes(&self, in_steps: bool) -> (Vec<u8>, Sections) {
        let mut sections = Sections::default();
        let double = self.double;
        let mut lists: [(Vec<u8>, &mut u32); 10] = [
            (bytes_of(&self.planes, double), &mut sections.planes),
            (bytes_of(&self.spheres, double), &mut sections.spheres),
            (bytes_of(&self.triangles, double), &mut sections.triangles),
            (bytes_of(&self.lights, double), &mut sections.lights),
            (bytes_of(&self.materials, double), &mut sections.materials),
            (bytes_of(&self.uv_projections, double), &mut sections.uv_projections),
            (bytes_of(&self.textures, double), &mut sections.textures),
            (bytes_of(&self.samplers, double), &mut sections.samplers),
            (bytes_of(&self.procedurals, double), &mut sections.procedurals),
            (bytes_of(&self.motions, double), &mut sections.motions),
        ];
        lists.sort_by_key(|(list, _)| if in_steps { room(list) } else { list.len() });
        let mut bytes = self.header_bytes(&self.header);
        sections.pixel_filter = (bytes.len() / 16) as u32;
        bytes.extend_from_slice(bytemuck::cast_slice(&self.pixel_filter));
        let alike = bytes.len().next_multiple_of(LIST_BYTES);
        let all: usize = lists.iter().map(|(list, _)| room(list)).sum();
        let step = if in_steps && alike + all <= layout::HEAD_BYTES { LIST_BYTES } else { 16 };
        bytes.resize(bytes.len().next_multiple_of(step), 0);
        for (list, at) in lists {
            *at = (bytes.len() / 16) as u32;
            let end = bytes.len() + if step == LIST_BYTES { room(&list) } else { list.len() };
            bytes.extend_from_slice(&list);
            bytes.resize(end, 0);
        }
        bytes.resize(bytes.len().max(layout::HEAD_BYTES), 0);
        (bytes, sections)
    }

    /// What the scene buffer begins with.
    pub fn header_bytes(&self, header: &Header) -> Vec<u8> {
        bytes_of(&[*header], self.double)
    }
}

/// Bytes in which a list lies where lists begin in steps.
fn room(list: &[u8]) -> usize {
    list.len().max(1).next_multiple_of(LIST_BYTES)
}
