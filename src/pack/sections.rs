//! Writes the lists of a packed scene to the bytes of its scene buffer, and records the offset of each.

use super::PackedScene;
use crate::schema::layout::{self, Header, List, bytes_of};

/// Bytes to which the size of a short list is rounded.
const LIST_BYTES: usize = 64 * 16;

/// The offset of each list in the scene buffer, in units of 16 bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    pub lists: Vec<(List, u32)>,
    pub pixel_filter: u32,
}

impl PackedScene {
    /// Returns the scene buffer and the offsets of its lists: first that of the pixel filter and the short
    /// ones, so that all of them are in the uniform buffer. Close together, as devices cache few of them; or,
    /// if there is room, at fixed steps, so that all small scenes share one compiled pipeline that keeps
    /// everything.
    pub fn scene_bytes(&self, in_steps: bool) -> (Vec<u8>, Sections) {
        let mut sections = Sections::default();
        let bytes_of_list = |&list: &List| (list, self.records.bytes(list, self.double));
        let mut lists: Vec<(List, Vec<u8>)> = List::ALL.iter().map(bytes_of_list).collect();
        lists.sort_by_key(|(_, bytes)| if in_steps { room(bytes) } else { bytes.len() });
        let mut bytes = self.header_bytes(&self.header);
        bytes.extend(bytes_of(&[self.records.lengths()], self.double));
        sections.pixel_filter = (bytes.len() / 16) as u32;
        bytes.extend_from_slice(bytemuck::cast_slice(&self.pixel_filter));
        let alike = bytes.len().next_multiple_of(LIST_BYTES);
        let all: usize = lists.iter().map(|(_, list)| room(list)).sum();
        let step = if in_steps && alike + all <= layout::HEAD_BYTES { LIST_BYTES } else { 16 };
        bytes.resize(bytes.len().next_multiple_of(step), 0);
        for (list, content) in lists {
            sections.lists.push((list, (bytes.len() / 16) as u32));
            let end = bytes.len() + if step == LIST_BYTES { room(&content) } else { content.len() };
            bytes.extend_from_slice(&content);
            bytes.resize(end, 0);
        }
        bytes.resize(bytes.len().max(layout::HEAD_BYTES), 0);
        (bytes, sections)
    }

    /// Returns the bytes of the scene buffer's header.
    pub fn header_bytes(&self, header: &Header) -> Vec<u8> {
        bytes_of(&[*header], self.double)
    }
}

/// Returns the bytes of a list rounded to steps.
fn room(list: &[u8]) -> usize {
    list.len().max(1).next_multiple_of(LIST_BYTES)
}
