//! What a sampler does, as data: the table from which scene vocabulary, `VkSampler` objects,
//! shader constants, oracle and test names are all generated.

use crate::named::named_enum;

named_enum! {
    /// What a coordinate outside [0, 1) reads (Vulkan 1.3, "Wrapping Operation").
    pub enum Address {
        Repeat = "repeat",
        MirroredRepeat = "mirrored-repeat",
        ClampToEdge = "clamp-to-edge",
        ClampToBorder = "clamp-to-border",
        MirrorClampToEdge = "mirror-clamp-to-edge",
    }
}

named_enum! {
    pub enum Filter {
        Nearest = "nearest",
        Linear = "linear",
    }
}

named_enum! {
    pub enum MipMode {
        None = "none",
        Nearest = "nearest",
        Linear = "linear",
    }
}

named_enum! {
    /// Who filters: our shader in f32, or the device's texture unit.
    pub enum Method {
        Shader = "shader",
        Hardware = "hardware",
    }
}

named_enum! {
    /// Half: texel i is centred at i + ½ (Vulkan). Integer: at i (the lecture's formulas).
    pub enum TexelCenter {
        Half = "half",
        Integer = "integer",
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplerSpec {
    /// Along u and v.
    pub address: [Address; 2],
    pub mag: Filter,
    pub min: Filter,
    pub mip: MipMode,
    /// The device's samplers only: least level of detail. Above 0, every look-up minifies.
    pub min_lod: f32,
    pub border_color: [f32; 4],
    pub method: Method,
    pub texel_center: TexelCenter,
}

impl Default for SamplerSpec {
    fn default() -> Self {
        SamplerSpec {
            address: [Address::Repeat; 2],
            mag: Filter::Linear,
            min: Filter::Linear,
            mip: MipMode::None,
            min_lod: 0.0,
            border_color: [0.0; 4],
            method: Method::Shader,
            texel_center: TexelCenter::Half,
        }
    }
}

impl SamplerSpec {
    /// Every variant that differs in more than its border colour or texel centre: 5 × 5 address
    /// modes, 2 × 2 filters, 3 mip modes. Hardware tests and reports walk this table.
    pub fn all() -> impl Iterator<Item = SamplerSpec> {
        let axes = Address::ALL.iter().flat_map(|&u| Address::ALL.iter().map(move |&v| [u, v]));
        axes.flat_map(|address| {
            Filter::ALL.iter().flat_map(move |&mag| {
                Filter::ALL.iter().flat_map(move |&min| {
                    MipMode::ALL.iter().map(move |&mip| SamplerSpec {
                        address,
                        mag,
                        min,
                        mip,
                        ..Default::default()
                    })
                })
            })
        })
    }

    /// `repeat/clamp-to-edge mag=linear min=nearest mip=none`: names tests and report rows.
    pub fn label(&self) -> String {
        let [u, v] = self.address;
        format!("{u}/{v} mag={} min={} mip={}", self.mag, self.min, self.mip)
    }
}
