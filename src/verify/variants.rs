//! The table of variants: every sampler (`SamplerSpec::all`) with every class of texel formats, read by
//! the device's sampler or by the shader from either texel source. Formats, sizes and border colours
//! rotate through the table, so that each group of variants meets all of them.

use crate::named::named_enum;
use crate::texture::data::{ColorSpace, Component, TexelFormat};
use crate::texture::sampler_spec::{Address, Filter, Method, SamplerSpec};

named_enum! {
    /// Formats that a device filters alike.
    pub enum FormatClass {
        Unorm8 = "unorm8",
        Srgb8 = "srgb8",
        Unorm16 = "unorm16",
        Float32 = "float32",
    }
}

impl FormatClass {
    /// One, two and four channels.
    pub fn formats(self) -> [TexelFormat; 3] {
        let component = match self {
            FormatClass::Unorm8 | FormatClass::Srgb8 => Component::Unorm8,
            FormatClass::Unorm16 => Component::Unorm16,
            FormatClass::Float32 => Component::Float32,
        };
        [1, 2, 4].map(|channels| TexelFormat::new(channels, component))
    }

    pub fn color_space(self) -> ColorSpace {
        if self == FormatClass::Srgb8 { ColorSpace::Srgb } else { ColorSpace::Linear }
    }
}

named_enum! {
    /// Who addresses and filters, and where the texels lie.
    pub enum Reader {
        Sampler = "sampler",
        ShaderBuffer = "shader, buffer",
        ShaderImage = "shader, image",
    }
}

impl Reader {
    pub fn method(self) -> Method {
        if self == Reader::Sampler { Method::Hardware } else { Method::Shader }
    }
}

/// One row of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    pub reader: Reader,
    pub spec: SamplerSpec,
    pub class: FormatClass,
    pub format: TexelFormat,
    pub size: [u32; 2],
}

impl Variant {
    /// `sampler repeat/repeat mag=linear min=linear mip=none, grey8 linear 5×3`
    pub fn label(&self) -> String {
        let [width, height] = self.size;
        let space = self.class.color_space();
        format!("{} {}, {} {space} {width}×{height}", self.reader, self.spec.label(), self.format)
    }
}

/// Sizes with every remainder that addressing can trip over: one texel, odd, powers of two.
pub const SIZES: [[u32; 2]; 6] = [[5, 3], [64, 64], [7, 4], [1, 1], [2, 2], [1, 9]];

const STANDARD_BORDERS: [[f32; 4]; 3] = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [1.0; 4]];

/// Odd values, all different: a border channel taken from elsewhere shows.
pub const ODD_BORDER: [f32; 4] = [0.9, 0.1, 0.6, 0.3];

/// The device's own samplers: all of them, with each class of formats.
pub fn sampler_variants(custom_border_color: bool) -> Vec<Variant> {
    let mut borders = STANDARD_BORDERS.to_vec();
    if custom_border_color {
        borders.push(ODD_BORDER);
    }
    let mut all = Vec::new();
    for (i, spec) in SamplerSpec::all().enumerate() {
        for (j, &class) in FormatClass::ALL.iter().enumerate() {
            let border_color = borders[(i + i / 6 + j) % borders.len()];
            all.push(Variant {
                reader: Reader::Sampler,
                spec: SamplerSpec { method: Method::Hardware, border_color, ..spec },
                class,
                // Six variants of minification and mips follow each other: each meets another size,
                // every second one another number of channels.
                format: class.formats()[(i / 2 + i / 6) % 3],
                size: SIZES[(i * 5 + j) % SIZES.len()],
            });
        }
    }
    all
}

/// The shader's filters from one texel source: 5 × 5 address modes, 2 filters, each class and number of
/// channels. `round` shifts which texture has which size.
pub fn shader_variants(reader: Reader, round: usize) -> Vec<Variant> {
    let mut all = Vec::new();
    for &u in Address::ALL {
        for &v in Address::ALL {
            for &filter in Filter::ALL {
                let spec = SamplerSpec {
                    address: [u, v],
                    mag: filter,
                    min: filter,
                    border_color: ODD_BORDER,
                    ..Default::default()
                };
                let formats = FormatClass::ALL.iter().flat_map(|&c| c.formats().map(|f| (c, f)));
                all.extend(formats.enumerate().map(|(i, (class, format))| Variant {
                    reader,
                    spec,
                    class,
                    format,
                    size: SIZES[(i + round) % SIZES.len()],
                }));
            }
        }
    }
    all
}
