//! Lists of a packed scene → the bytes of its scene buffer, and where each list begins.

use super::PackedScene;
use crate::schema::layout::{self, Header, List, bytes_of};

/// Room in which short lists end.
const LIST_BYTES: usize = 64 * 16;

/// Where each list begins in the scene buffer, in units of 16 bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    pub lists: Vec<(List, u32)>,
    pub pixel_filter: u32,
}

impl PackedScene {
    /// The scene buffer and where its lists begin: that of the pixel filter and then the short ones first, so
    /// that all of them lie in the head. Close together, as devices cache few of them; or, where there is
    /// room, in steps, so that all small scenes have one compiled pipeline that keeps everything.
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

    /// What the scene buffer begins with.
    pub fn header_bytes(&self, header: &Header) -> Vec<u8> {
        bytes_of(&[*header], self.double)
    }
}

/// Bytes in which a list lies where lists begin in steps.
fn room(list: &[u8]) -> usize {
    list.len().max(1).next_multiple_of(LIST_BYTES)
}
