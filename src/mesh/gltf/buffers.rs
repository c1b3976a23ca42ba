//! Buffers and views of them. Input: the file's lists of both, its binary chunk, and a way to read other files.
//! Output: the bytes of any view, which exist; a file that several buffers name is read once.

use std::borrow::Cow;
use std::collections::HashMap;

use super::document::Document;
use super::json::Json;
use super::notes::Notes;
use super::uri::Uri;
use crate::mesh::Fault;

/// Reads a file by its path relative to that of the glTF file, or says why it cannot.
pub(super) type Resolve<'r> = &'r mut dyn FnMut(&str) -> Result<Vec<u8>, String>;

/// The buffers of a file and the views of them.
pub(super) struct Buffers<'a> {
    contents: Vec<Cow<'a, [u8]>>,
    buffers: Vec<Buffer>,
    views: Vec<View>,
}

/// A buffer as the file states it.
struct Buffer {
    /// Which of the contents; none for one that only an extension fills.
    content: Option<usize>,
    length: usize,
}

/// Bytes of a buffer.
#[derive(Clone, Copy)]
struct View {
    buffer: usize,
    start: usize,
    length: usize,
    stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers, and the list of views.
    pub(super) fn read(
        document: &Document,
        binary: Option<&'a [u8]>,
        notes: &mut Notes,
        resolve: Resolve,
    ) -> Result<Buffers<'a>, Fault> {
        let mut all = Buffers { contents: Vec::new(), buffers: Vec::new(), views: Vec::new() };
        let mut files = HashMap::new();
        for (index, element) in document.list("buffers")?.elements().enumerate() {
            let element = element?;
            let chunk = binary.filter(|_| index == 0);
            let buffer = all.buffer(element.json(), chunk, &mut files, resolve)?;
            all.buffers.push(buffer);
        }
        for element in document.list("bufferViews")?.elements() {
            let view = all.view(element?.json(), notes)?;
            all.views.push(view);
        }
        Ok(all)
    }

    /// Reads a buffer and its content. `files` tells which contents files already are.
    fn buffer(
        &mut self,
        json: Json,
        chunk: Option<&'a [u8]>,
        files: &mut HashMap<String, usize>,
        resolve: Resolve,
    ) -> Result<Buffer, Fault> {
        let length = json.needed("byteLength", json.whole("byteLength")?)?;
        let content = match json.text("uri")? {
            None => chunk.map(|chunk| self.store(Cow::Borrowed(chunk))),
            Some(uri) => match Uri::read(uri).map_err(|what| json.fault_at("uri", what))? {
                Uri::Data(bytes, _) => Some(self.store(Cow::Owned(bytes))),
                Uri::Path(path) => match files.get(&path) {
                    Some(content) => Some(*content),
                    None => {
                        let bytes = resolve(&path).map_err(|what| json.fault_at("uri", what))?;
                        let content = self.store(Cow::Owned(bytes));
                        files.insert(path, content);
                        Some(content)
                    }
                },
            },
        };
        let found = content.and_then(|content| self.contents.get(content)).map(|content| content.len());
        match found.filter(|found| *found < length) {
            Some(found) => {
                Err(json.fault_at("byteLength", format!("it is {length}, but the data has {found} bytes")))
            }
            None => Ok(Buffer { content, length }),
        }
    }

    fn store(&mut self, content: Cow<'a, [u8]>) -> usize {
        self.contents.push(content);
        self.contents.len() - 1
    }

    /// Reads a view, whose bytes have to be within its buffer.
    fn view(&self, json: Json, notes: &mut Notes) -> Result<View, Fault> {
        let buffer = json.needed("buffer", json.index("buffer", self.buffers.len(), "buffers")?)?;
        let available = self.buffers.get(buffer).map_or(0, |buffer| buffer.length);
        let start = json.whole("byteOffset")?.unwrap_or(0);
        let length = json.needed("byteLength", json.whole("byteLength")?)?;
        if start.checked_add(length).is_none_or(|end| end > available) {
            let what = format!("{length} bytes from byte {start}; buffer {buffer} has {available}");
            return Err(json.fault_at("byteLength", what));
        }
        // Some programs write 0 for bytes that follow one another.
        let stride = json.whole("byteStride")?.filter(|stride| {
            if *stride == 0 {
                notes.add("a byteStride of 0 is taken as none; 4 to 252 are allowed", || json.pointer());
            }
            *stride != 0
        });
        if let Some(stride) = stride.filter(|stride| !(4..=252).contains(stride)) {
            return Err(json.fault_at("byteStride", format!("it is {stride}; 4 to 252 are allowed")));
        }
        Ok(View { buffer, start, length, stride })
    }

    /// Returns the number of views.
    pub(super) fn view_count(&self) -> usize {
        self.views.len()
    }

    /// Returns the number of bytes of all buffers.
    pub(super) fn byte_count(&self) -> usize {
        self.contents.iter().map(|content| content.len()).sum()
    }

    /// Returns the bytes of the view that a member names, and their stride if it states one.
    pub(super) fn view_bytes(&self, json: Json, key: &str) -> Result<(&[u8], Option<usize>), Fault> {
        let index = json.needed(key, json.index(key, self.view_count(), "buffer views")?)?;
        let bytes = self.views.get(index).and_then(|view| {
            let content = self.contents.get(self.buffers.get(view.buffer)?.content?)?;
            let bytes = content.get(view.start..view.start.checked_add(view.length)?)?;
            Some((bytes, view.stride))
        });
        bytes.ok_or_else(|| {
            let buffer = self.views.get(index).map_or(0, |view| view.buffer);
            let what =
                "it has no data: neither a uri, nor is it the first one of a .glb file with a binary chunk";
            Fault::new(format!("/buffers/{buffer}"), format!("{what}; {} needs it", json.pointer()))
        })
    }
}
