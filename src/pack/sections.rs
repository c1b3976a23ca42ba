//! Writes the lists of a packed scene to the bytes of its scene buffer, and records the offset of each.

use super::PackedScene;
use crate::schema::layout::{self, Header, List, Places, bytes_of};

/// The offset of each list in the scene buffer, in units of 16 bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    pub lists: Vec<(List, u32)>,
    pub pixel_filter: u32,
}

impl PackedScene {
    /// Returns the scene buffer and the offsets of its lists: first that of the pixel filter and the short
    /// ones, so that all of them are in the uniform buffer, and close together, as devices cache few of them.
    pub fn scene_bytes(&self) -> (Vec<u8>, Sections) {
        let mut sections = Sections::default();
        let bytes_of_list = |&list: &List| (list, self.records.bytes(list, self.double));
        let mut lists: Vec<(List, Vec<u8>)> = List::ALL.iter().map(bytes_of_list).collect();
        lists.sort_by_key(|(_, bytes)| bytes.len());
        let mut bytes = self.header_bytes(&self.header);
        bytes.extend(bytes_of(&[self.records.lengths()], self.double));
        let at_places = bytes.len();
        bytes.extend(bytes_of(&[Places::default()], self.double));
        sections.pixel_filter = (bytes.len() / 16) as u32;
        bytes.extend_from_slice(bytemuck::cast_slice(&self.pixel_filter));
        bytes.resize(bytes.len().next_multiple_of(16), 0);
        let mut places = Places::default();
        for (list, content) in lists {
            let place = (bytes.len() / 16) as u32;
            *places.of(list) = place;
            sections.lists.push((list, place));
            bytes.extend_from_slice(&content);
        }
        let places = bytes_of(&[places], self.double);
        bytes[at_places..at_places + places.len()].copy_from_slice(&places);
        bytes.resize(bytes.len().max(layout::HEAD_BYTES), 0);
        (bytes, sections)
    }

    /// Returns the bytes of the scene buffer's header.
    pub fn header_bytes(&self, header: &Header) -> Vec<u8> {
        bytes_of(&[*header], self.double)
    }
}
