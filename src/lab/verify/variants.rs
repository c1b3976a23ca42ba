//! The table of variants. At level 0 of 2D textures: every sampler (`SamplerSpec::all`) with every
//! class of texel formats, read by the device's sampler or by the shader from either texel source.
//! Formats, sizes and border colours rotate through the table, so that each group of variants meets
//! all of them. Other levels and kinds of textures: `level_variants`.

use super::level_variants;
use crate::core::named::named_enum;
use crate::texture::data::{ColorSpace, Component, Dimension, TexelFormat};
use crate::texture::sampler_spec::{Address, Filter, Method, SamplerSpec};

named_enum! {
    /// Formats that a device filters with equal precision.
    pub enum FormatClass {
        Unorm8 = "unorm8",
        Srgb8 = "srgb8",
        Unorm16 = "unorm16",
        Float32 = "float32",
    }
}

impl FormatClass {
    /// Returns the formats of one, two and four channels.
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
    /// The implementation that addresses and filters, and the source of its texels.
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

named_enum! {
    /// The levels that are read: level 0, or those that the footprint selects. A sampler magnifies
    /// where the level of detail is at most 0 (Vulkan 1.3, "Scale Factor Operation, Level-of-Detail
    /// Operation and Image Level(s) Selection").
    pub enum Scale {
        /// Level 0 by the magnification filter.
        Magnified = "mag",
        /// Level 0 by the minification filter.
        Minified = "min",
        /// All levels.
        Levels = "levels",
        /// Footprints that the device filters anisotropically.
        Anisotropic = "aniso",
    }
}

/// A level of detail that minifies but still selects level 0, including the largest one that
/// `MipMode::None` allows.
const MINIFYING_LOD: f32 = 0.125;

/// One row of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    pub reader: Reader,
    pub spec: SamplerSpec,
    pub scale: Scale,
    pub class: FormatClass,
    pub format: TexelFormat,
    pub dimension: Dimension,
    /// Width, height, and depth or faces.
    pub size: [u32; 3],
}

impl Variant {
    /// Returns the filter that is read; over all levels that of minification.
    pub fn filter(&self) -> Filter {
        if self.scale == Scale::Magnified { self.spec.mag } else { self.spec.min }
    }

    /// Returns true if the variant is looked up over footprints.
    pub fn is_filtered(&self) -> bool {
        matches!(self.scale, Scale::Levels | Scale::Anisotropic)
    }

    /// Returns the corresponding sampler of the device.
    pub fn device_sampler(&self) -> SamplerSpec {
        let min_lod = if self.scale == Scale::Minified { MINIFYING_LOD } else { 0.0 };
        SamplerSpec { min_lod, ..self.spec }
    }

    /// Returns the sampler for the oracle: at level 0 regardless of scale.
    pub fn asked_sampler(&self) -> SamplerSpec {
        let filter = self.filter();
        if self.is_filtered() { self.spec } else { SamplerSpec { mag: filter, min: filter, ..self.spec } }
    }

    /// Returns the address modes of the texture's axes.
    pub fn addresses(&self) -> Vec<Address> {
        let [u, v] = self.spec.address;
        match self.dimension {
            Dimension::One => vec![u],
            Dimension::Two => vec![u, v],
            Dimension::Three => vec![u, v, self.spec.address_w],
            Dimension::Cube => Vec::new(),
        }
    }

    /// Returns a label: `sampler 2d repeat/repeat mag=linear min=linear mip=none (mag), grey8
    /// linear 5×3`.
    pub fn label(&self) -> String {
        let Variant { reader, dimension, spec, scale, format, .. } = self;
        let addresses: Vec<&str> = self.addresses().iter().map(|a| a.name()).collect();
        let addresses = if addresses.is_empty() { String::new() } else { addresses.join("/") + " " };
        let most =
            if *scale == Scale::Anisotropic { format!(" {}", spec.max_anisotropy) } else { String::new() };
        let size: Vec<String> = self.size.iter().map(u32::to_string).collect();
        let axes = if self.size[2] == 1 { 2 } else { 3 };
        format!(
            "{reader} {dimension} {addresses}mag={} min={} mip={} ({scale}{most}), {format} {} {}",
            spec.mag,
            spec.min,
            spec.mip,
            self.class.color_space(),
            size[..axes].join("×")
        )
    }
}

/// Sizes that are difficult cases of addressing: one texel, odd, powers of two.
pub const SIZES: [[u32; 2]; 6] = [[5, 3], [64, 64], [7, 4], [1, 1], [2, 2], [1, 9]];

fn flat([width, height]: [u32; 2]) -> [u32; 3] {
    [width, height, 1]
}

const STANDARD_BORDERS: [[f32; 4]; 3] = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [1.0; 4]];

/// Uncommon, distinct values, so that a wrong border channel is detected.
pub const ODD_BORDER: [f32; 4] = [0.9, 0.1, 0.6, 0.3];

/// Returns the default set; `rounds` is the number of rounds of the shader's variants.
pub fn all(custom_border_color: bool, rounds: usize) -> Vec<Variant> {
    let mut all = sampler_variants(custom_border_color);
    for reader in [Reader::ShaderBuffer, Reader::ShaderImage] {
        all.extend((0..rounds).flat_map(|round| shader_variants(reader, round)));
    }
    all.extend(level_variants::all());
    all
}

const LEVEL_0: [Scale; 2] = [Scale::Magnified, Scale::Minified];

/// Returns the device's own samplers: all of them, magnifying and minifying, with each class of
/// formats.
pub fn sampler_variants(custom_border_color: bool) -> Vec<Variant> {
    let mut borders = STANDARD_BORDERS.to_vec();
    if custom_border_color {
        borders.push(ODD_BORDER);
    }
    let mut all = Vec::new();
    for (i, spec) in SamplerSpec::all().enumerate() {
        let [mag, min, mip] = [spec.mag as usize, spec.min as usize, spec.mip as usize];
        let pair = i / (2 * 2 * 3);
        for (j, &class) in FormatClass::ALL.iter().enumerate() {
            let border_color = borders[(i + i / 6 + j) % borders.len()];
            all.extend(LEVEL_0.map(|scale| Variant {
                reader: Reader::Sampler,
                spec: SamplerSpec { method: Method::Hardware, border_color, ..spec },
                scale,
                class,
                // The six that share a filter meet all numbers of channels and all sizes.
                format: class.formats()[(mip + pair / 2) % 3],
                dimension: Dimension::Two,
                size: flat(SIZES[(2 * mip + (mag ^ min) + pair + j) % SIZES.len()]),
            }));
        }
    }
    all
}

/// The shader's point filters. Tests compare footprint filters with the oracle.
pub const SHADER_FILTERS: [Filter; 3] = [Filter::Nearest, Filter::Linear, Filter::Cubic];

/// Returns the shader's filters from one texel source: 5 × 5 address modes, 3 filters, each class
/// and number of channels. `round` rotates the sizes of the textures.
pub fn shader_variants(reader: Reader, round: usize) -> Vec<Variant> {
    let mut all = Vec::new();
    for &u in Address::ALL {
        for &v in Address::ALL {
            for filter in SHADER_FILTERS {
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
                    scale: Scale::Magnified,
                    class,
                    format,
                    dimension: Dimension::Two,
                    size: flat(SIZES[(i + round) % SIZES.len()]),
                }));
            }
        }
    }
    all
}
