//! Writers of DDS and KTX2 files, as small as the specifications allow: a header, and the bytes that a test gives.

/// Numbers in DXGI and Vulkan of formats that several tests use.
pub const DXGI_RGBA8: u32 = 28;
pub const VK_RGBA8: u32 = 37;

/// A DDS file with the header of Direct3D 10.
pub struct Dds {
    pub size: [u32; 3],
    pub levels: u32,
    pub format: u32,
    pub is_cube: bool,
    pub layers: u32,
    pub data: Vec<u8>,
}

impl Dds {
    /// A flat texture of one level.
    pub fn flat(format: u32, [width, height]: [u32; 2], data: &[u8]) -> Dds {
        Dds { size: [width, height, 1], levels: 1, format, is_cube: false, layers: 1, data: data.to_vec() }
    }

    pub fn bytes(&self) -> Vec<u8> {
        let is_volume = self.size[2] > 1;
        let mut words = legacy_words(self.size, self.levels);
        (words[20], words[21]) = (4, u32::from_le_bytes(*b"DX10"));
        let axes = if is_volume { 4 } else { 3 };
        words.extend([self.format, axes, if self.is_cube { 4 } else { 0 }, self.layers, 0]);
        [words.iter().flat_map(|word| word.to_le_bytes()).collect(), self.data.clone()].concat()
    }
}

/// The words of a header of Direct3D 9 without a format.
fn legacy_words([width, height, depth]: [u32; 3], levels: u32) -> Vec<u32> {
    let mut words = vec![0; 32];
    words[0] = u32::from_le_bytes(*b"DDS ");
    (words[1], words[2]) = (124, 0x1007 | if depth > 1 { 0x80_0000 } else { 0 });
    (words[3], words[4], words[6], words[7]) = (height, width, depth, levels);
    (words[19], words[27], words[28]) = (32, 0x1000, if depth > 1 { 0x20_0000 } else { 0 });
    words
}

/// The format of a DDS file of Direct3D 9: flags, four letters, bits of a texel, masks.
pub struct Legacy {
    pub flags: u32,
    pub letters: [u8; 4],
    pub bits: u32,
    pub masks: [u32; 4],
    /// The second word of capabilities: cube, faces, volume.
    pub caps: u32,
}

/// A DDS file of Direct3D 9.
pub fn legacy_dds(size: [u32; 3], levels: u32, format: &Legacy, data: &[u8]) -> Vec<u8> {
    let mut words = legacy_words(size, levels);
    (words[20], words[21], words[22]) = (format.flags, u32::from_le_bytes(format.letters), format.bits);
    words[23..27].copy_from_slice(&format.masks);
    words[28] |= format.caps;
    [words.iter().flat_map(|word| word.to_le_bytes()).collect(), data.to_vec()].concat()
}

/// A level as it is stored, and its bytes before compression.
#[derive(Clone)]
pub struct Level {
    pub stored: Vec<u8>,
    pub bytes: u64,
}

/// A KTX2 file.
#[derive(Clone)]
pub struct Ktx2 {
    pub format: u32,
    /// 0 for an axis that there is not.
    pub size: [u32; 3],
    pub layers: u32,
    pub faces: u32,
    pub scheme: u32,
    /// 0 unspecified, 1 linear, 2 sRGB.
    pub transfer: u8,
    pub levels: Vec<Level>,
    pub metadata: Vec<u8>,
}

impl Ktx2 {
    /// A flat texture of uncompressed levels.
    pub fn flat(format: u32, [width, height]: [u32; 2], levels: &[Vec<u8>]) -> Ktx2 {
        let level = |stored: &Vec<u8>| Level { stored: stored.clone(), bytes: stored.len() as u64 };
        Ktx2 {
            format,
            size: [width, height, 0],
            layers: 0,
            faces: 1,
            scheme: 0,
            transfer: 1,
            levels: levels.iter().map(level).collect(),
            metadata: Vec::new(),
        }
    }

    /// The same file with its levels compressed once more.
    pub fn compressed(mut self, scheme: u32, compress: impl Fn(&[u8]) -> Vec<u8>) -> Ktx2 {
        self.scheme = scheme;
        self.levels.iter_mut().for_each(|level| level.stored = compress(&level.stored));
        self
    }

    pub fn bytes(&self) -> Vec<u8> {
        let mut descriptor = [0; 44];
        descriptor[0] = 44;
        (descriptor[12], descriptor[13], descriptor[14]) = (1, 1, self.transfer);
        let start = 80 + 24 * self.levels.len();
        let metadata = start + descriptor.len();
        let mut at = metadata + self.metadata.len();
        let words = [
            [self.format, 1, self.size[0], self.size[1], self.size[2], self.layers, self.faces],
            [
                self.levels.len() as u32,
                self.scheme,
                start as u32,
                44,
                metadata as u32,
                self.metadata.len() as u32,
                0,
            ],
        ];
        let mut file = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
        file.extend(words.concat().iter().flat_map(|word| word.to_le_bytes()));
        file.resize(80, 0);
        for level in &self.levels {
            for number in [at as u64, level.stored.len() as u64, level.bytes] {
                file.extend(number.to_le_bytes());
            }
            at += level.stored.len();
        }
        file.extend(descriptor);
        file.extend(&self.metadata);
        file.extend(self.levels.iter().flat_map(|level| level.stored.clone()));
        file
    }
}

/// An entry of the metadata of KTX2.
pub fn entry(key: &str, value: &str) -> Vec<u8> {
    let text = format!("{key}\0{value}\0");
    let mut bytes = [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat();
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes
}

/// A frame of Zstandard (RFC 8878) of one raw block.
pub fn zstd(bytes: &[u8]) -> Vec<u8> {
    let length = bytes.len() as u32;
    let block = (length << 3 | 1).to_le_bytes();
    [b"\x28\xb5\x2f\xfd\xa0", &length.to_le_bytes()[..], &block[..3], bytes].concat()
}

/// A stream of zlib.
pub fn zlib(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Levels of `side` texels and halves of it, each of one colour of four codes, down to one texel or the last colour.
pub fn solid_levels(side: u32, texels: impl Fn(u32) -> u32, colors: &[[u8; 4]]) -> Vec<Vec<u8>> {
    let count = (side.ilog2() as usize + 1).min(colors.len());
    (0..count).map(|level| colors[level].repeat(texels((side >> level).max(1)) as usize)).collect()
}
