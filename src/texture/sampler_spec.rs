//! What a sampler does, as data: the table from which scene vocabulary, `VkSampler` objects,
//! shader constants, oracle and test names are all generated.

pub use crate::schema::enums::{Address, Filter, Method, MipMode, TexelCenter};

/// How a texture is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplerSpec {
    /// Along u and v.
    pub address: [Address; 2],
    /// Along w, of 3D textures.
    pub address_w: Address,
    /// The filter where a texel covers more than a pixel.
    pub mag: Filter,
    /// The filter where a footprint covers more than a texel.
    pub min: Filter,
    /// Which levels are read.
    pub mip: MipMode,
    /// The device's samplers only: least level of detail. Above 0, every look-up minifies.
    pub min_lod: f32,
    /// What `clamp-to-border` reads, red, green, blue and alpha.
    pub border_color: [f32; 4],
    /// Who filters.
    pub method: Method,
    /// Where texels have their centres.
    pub texel_center: TexelCenter,
    /// Longest footprint, in widths, that `anisotropic` and `ewa` follow; wider ones are blurred.
    pub max_anisotropy: u32,
    /// B and C of the cubic filter.
    pub cubic: [f32; 2],
}

/// B = 0, C = ½: interpolates.
pub const CATMULL_ROM: [f32; 2] = [0.0, 0.5];

impl Default for SamplerSpec {
    fn default() -> Self {
        SamplerSpec {
            address: [Address::Repeat; 2],
            address_w: Address::Repeat,
            mag: Filter::Linear,
            min: Filter::Linear,
            mip: MipMode::None,
            min_lod: 0.0,
            border_color: [0.0; 4],
            method: Method::Shader,
            texel_center: TexelCenter::Half,
            max_anisotropy: 16,
            cubic: CATMULL_ROM,
        }
    }
}

/// What texture units have.
const BASIC: [Filter; 2] = [Filter::Nearest, Filter::Linear];

impl SamplerSpec {
    /// Whether look-ups depend on what they are averaged over.
    pub fn needs_footprint(&self) -> bool {
        self.mag != self.min || self.mip != MipMode::None
    }

    /// Whether it mixes texels.
    pub fn blends(&self) -> bool {
        self.mag.traits().blends || self.min.traits().blends
    }

    /// Whether it follows the longer axis of footprints.
    pub fn follows_axis(&self) -> bool {
        self.min.traits().follows_axis
    }

    /// Whether it reads sums over rectangles.
    pub fn needs_sums(&self) -> bool {
        self.min.traits().needs_sums
    }

    /// Whether some axis has this address mode.
    pub fn has(&self, mode: Address) -> bool {
        self.address.contains(&mode) || self.address_w == mode
    }

    /// Whether it reads levels below the texture itself.
    pub fn reads_levels(&self) -> bool {
        self.mip != MipMode::None || self.min.traits().chooses_levels
    }

    /// Every variant of a device's sampler that differs in more than its border colour, texel centre or
    /// anisotropy: 5 × 5 address modes, 2 × 2 filters, 3 mip modes. Hardware tests and reports walk this
    /// table.
    pub fn all() -> impl Iterator<Item = SamplerSpec> {
        let axes = Address::ALL.iter().flat_map(|&u| Address::ALL.iter().map(move |&v| [u, v]));
        axes.flat_map(|address| {
            BASIC.iter().flat_map(move |&mag| {
                BASIC.iter().flat_map(move |&min| {
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
