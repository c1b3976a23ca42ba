//! The pictures of the gallery, as PNG files without compression, which therefore have the same bytes whoever writes them,
//! and a DDS file.

use png::{BitDepth, ColorType};

/// Returns a PNG file of these bytes.
pub fn png(size: [u32; 2], color: ColorType, depth: BitDepth, bytes: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::NoCompression);
    encoder.set_filter(png::Filter::NoFilter);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(bytes));
    written.expect("memory takes as many bytes as the picture has");
    file
}

/// Returns a picture with these texels, counted from the upper left.
pub fn rgb(size: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    png(size, ColorType::Rgb, BitDepth::Eight, texels(size, texel).as_flattened())
}

/// Returns a picture with alpha.
pub fn rgba(size: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    png(size, ColorType::Rgba, BitDepth::Eight, texels(size, texel).as_flattened())
}

/// Returns a grey picture of 16 bits.
pub fn grey16(size: [u32; 2], texel: impl Fn(u32, u32) -> u16) -> Vec<u8> {
    let bytes: Vec<u8> = texels(size, texel).iter().flat_map(|code| code.to_be_bytes()).collect();
    png(size, ColorType::Grayscale, BitDepth::Sixteen, &bytes)
}

pub fn texels<T>([width, height]: [u32; 2], texel: impl Fn(u32, u32) -> T) -> Vec<T> {
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect()
}

/// Returns a texel of the letter F in white on a ground that is red to the right and green downwards, 8 × 8.
pub fn letter_texel(x: u32, y: u32) -> [u8; 3] {
    const ROWS: [u8; 8] =
        [0b0000_0000, 0b0111_1110, 0b0110_0000, 0b0111_1100, 0b0110_0000, 0b0110_0000, 0b0110_0000, 0];
    if ROWS[y as usize] >> (7 - x) & 1 == 1 { [255; 3] } else { [x as u8 * 32, y as u8 * 32, 96] }
}

/// Returns the letter.
pub fn letter() -> Vec<u8> {
    rgb([8, 8], letter_texel)
}

/// Returns 2 × 2 texels, dark where `x + y` is odd.
pub fn checker(light: u8, dark: u8) -> Vec<u8> {
    rgb([2, 2], |x, y| [if (x + y) % 2 == 0 { light } else { dark }; 3])
}

/// Returns a normal map of four domes that rise from a flat ground, 32 × 32; green points up.
pub fn domes() -> Vec<u8> {
    rgb([32, 32], |x, y| {
        let [dx, dy] = [x, y].map(|i| (f64::from(i % 16) + 0.5) / 8.0 - 1.0);
        let square = dx * dx + dy * dy;
        let normal = if square < 0.64 { [dx, -dy, (1.0 - square).sqrt()] } else { [0.0, 0.0, 1.0] };
        normal.map(|n| (127.5 + 127.5 * n).round() as u8)
    })
}

/// Returns a green leaf whose alpha falls from the middle outwards, 16 × 16.
pub fn leaf() -> Vec<u8> {
    rgba([16, 16], |x, y| {
        let [dx, dy] = [x, y].map(|i| (f64::from(i) + 0.5) / 8.0 - 1.0);
        let alpha = 1.25 * (1.0 - (dx * dx + dy * dy).sqrt());
        [40, 160, 60 + 8 * x as u8, (255.0 * alpha.clamp(0.0, 1.0)).round() as u8]
    })
}

/// Returns the letter as a DDS file of texels R8G8B8A8 in sRGB, in the header of Direct3D 10.
pub fn letter_dds() -> Vec<u8> {
    let mut words = [0u32; 37];
    words[0] = u32::from_le_bytes(*b"DDS ");
    // Sizes of the header and of its format, and which of its members count.
    (words[1], words[2], words[3], words[4]) = (124, 0x1007, 8, 8);
    (words[6], words[7], words[19], words[20]) = (1, 1, 32, 4);
    (words[21], words[27]) = (u32::from_le_bytes(*b"DX10"), 0x1000);
    // DXGI_FORMAT_R8G8B8A8_UNORM_SRGB, two dimensions, one picture.
    (words[32], words[33], words[35]) = (29, 3, 1);
    let texels = texels([8, 8], letter_texel);
    let texels = texels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]);
    words.iter().flat_map(|word| word.to_le_bytes()).chain(texels).collect()
}
