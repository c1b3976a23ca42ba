//! Uploads textures as images with samplers, one pair for each slot of the scene: only in the forms that its
//! samplers read, with levels that the device may have generated.

use std::borrow::Cow;

use super::mip_chain::{MipGenerator, MipSource, sizes};
use crate::core::error::{Error, Result};
use crate::gpu::{Gpu, Image, ImageDesc, ImageFormat, ImageShape, Sampler, Swizzle};
use crate::pack::{MAX_SLOTS, PackedScene, Slot, TextureKind};
use crate::texture::data::{ColorSpace, TexelFormat};
use crate::texture::sampler_spec::{Address, SamplerSpec};

/// Uploads images; one image serves all slots that read a texture in the same form.
pub struct Uploads<'a> {
    gpu: &'a Gpu,
    packed: &'a PackedScene,
    generator: MipGenerator<'a>,
    images: Vec<((usize, Form), Image)>,
}

impl<'a> Uploads<'a> {
    pub fn new(gpu: &'a Gpu, packed: &'a PackedScene, generator: MipGenerator<'a>) -> Uploads<'a> {
        Uploads { gpu, packed, generator, images: Vec::new() }
    }

    /// Returns the device time of generating levels, if any were generated.
    pub fn mips_seconds(&self) -> Option<f64> {
        self.generator.seconds
    }

    /// Returns image and sampler of each slot. Without slots it returns a pair that is never read, as a
    /// binding must not be empty.
    pub fn slots(&mut self, slots: &[Slot], kind: TextureKind) -> Result<Vec<(Image, Sampler)>> {
        if slots.len() > MAX_SLOTS {
            return Err(Error::with_help(
                format!(
                    "the scene reads {} pairs of texture and sampler through images; {MAX_SLOTS} are possible",
                    slots.len()
                ),
                "one sampler of method \"hardware\" makes all look-ups go through images: use method \"shader\", \
                 or share samplers and textures",
            ));
        }
        if slots.is_empty() {
            let image = self.gpu.image(&unread(kind))?;
            return Ok(vec![(image, self.gpu.sampler(&SamplerSpec::default())?)]);
        }
        slots.iter().map(|slot| self.slot(slot)).collect()
    }

    fn slot(&mut self, slot: &Slot) -> Result<(Image, Sampler)> {
        let spec = self.packed.sampler_specs[slot.sampler];
        let form = Form::of(self.packed, slot, &spec);
        let image = match self.images.iter().find(|(key, _)| *key == (slot.texture, form)) {
            Some((_, image)) => image.clone(),
            None => {
                let image = upload_image(self.gpu, self.packed, &mut self.generator, slot.texture, form)?;
                self.images.push(((slot.texture, form), image.clone()));
                image
            }
        };
        let sampler = if slot.hardware { spec } else { SamplerSpec::default() };
        Ok((image, self.gpu.sampler(&sampler)?))
    }
}

/// Returns true if images can hold all 2D textures of a scene as its look-ups of method shader read them.
pub fn hold(gpu: &Gpu, packed: &PackedScene) -> bool {
    let most = gpu.info().limits.max_image_2d;
    let holds = |slot: &Slot| {
        let texture = &packed.records.textures[slot.texture];
        texture.size.x.max(texture.size.y) <= most && gpu.supports(image_format(texture.format, false), false)
    };
    packed.slots.len() <= MAX_SLOTS && packed.slots.iter().all(holds)
}

/// Returns an image of one texel per face, which is never read.
fn unread(kind: TextureKind) -> ImageDesc<'static> {
    const TEXELS: [&[u8]; 2] = [&[0], &[0; 6]];
    let faces = usize::from(kind == TextureKind::Cube);
    ImageDesc {
        name: "unread",
        shape: shape(kind),
        width: 1,
        height: 1,
        depth: TEXELS[faces].len() as u32,
        format: ImageFormat::R8,
        swizzle: Swizzle::Grey,
        levels: &TEXELS[faces..=faces],
    }
}

fn shape(kind: TextureKind) -> ImageShape {
    match kind {
        TextureKind::Flat | TextureKind::Procedural => ImageShape::Flat,
        TextureKind::Volume => ImageShape::Volume,
        TextureKind::Cube => ImageShape::Cube,
    }
}

/// The form in which an image is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Form {
    /// The texture unit decodes sRGB before it filters.
    decode: bool,
    /// Four channels although the file has fewer: a border colour is not swizzled, and drivers support sRGB
    /// with four channels only.
    expand: bool,
    /// The texture unit interpolates.
    filtered: bool,
}

impl Form {
    fn of(packed: &PackedScene, slot: &Slot, spec: &SamplerSpec) -> Form {
        let texture = &packed.records.textures[slot.texture];
        let srgb = texture.color_space == ColorSpace::Srgb;
        Form::new(slot.hardware, srgb, spec)
    }

    fn new(hardware: bool, srgb: bool, spec: &SamplerSpec) -> Form {
        let border = spec.has(Address::ClampToBorder);
        Form {
            decode: hardware && srgb,
            expand: hardware && (srgb || border),
            filtered: hardware && spec.blends(),
        }
    }
}

/// Returns true if the device's own samplers support a sampler on textures of this format.
pub fn can_sample(gpu: &Gpu, spec: &SamplerSpec, format: TexelFormat, space: ColorSpace) -> bool {
    let limits = &gpu.info().limits;
    let form = Form::new(true, space == ColorSpace::Srgb, spec);
    let channels = if form.expand { 4 } else { format.channels() };
    let stored = image_format(TexelFormat::new(channels, format.component()), form.decode);
    let mirrors = limits.mirror_clamp_to_edge || !spec.has(Address::MirrorClampToEdge);
    mirrors && gpu.supports(stored, form.filtered)
}

fn upload_image(
    gpu: &Gpu,
    packed: &PackedScene,
    generator: &mut MipGenerator<'_>,
    index: usize,
    form: Form,
) -> Result<Image> {
    let record = &packed.records.textures[index];
    let [width, height, depth] = record.size.to_array();
    let mut format = record.format;
    let name = &packed.texture_names[index];
    let made_there = packed.device_levels.contains(&index);
    let uploaded = if made_there { 1 } else { record.levels };
    let mut levels: Vec<Cow<'_, [u8]>> =
        (0..uploaded).map(|level| Cow::Borrowed(packed.level_texels(index, level))).collect();
    if form.expand && format.channels() != 4 {
        levels = levels.iter().map(|level| Cow::Owned(expanded(level, format))).collect();
        format = TexelFormat::new(4, format.component());
    }
    let levels: Vec<&[u8]> = levels.iter().map(|level| level.as_ref()).collect();
    let stored = image_format(format, form.decode);
    if !gpu.supports(stored, form.filtered) {
        let filtering = if form.filtered { "with linear filtering" } else { "as a sampled image" };
        return Err(Error::with_help(
            format!(
                "texture `{name}`: device \"{}\" does not support {stored} images {filtering}",
                gpu.info().name
            ),
            "use method = \"shader\" with --texels auto or buffer, or store the texture with 8 bits",
        ));
    }
    let desc = ImageDesc {
        name,
        shape: shape(record.kind),
        width,
        height,
        depth,
        format: stored,
        swizzle: match format.channels() {
            1 => Swizzle::Grey,
            2 => Swizzle::GreyAlpha,
            _ => Swizzle::Rgba,
        },
        levels: &levels,
    };
    if !made_there {
        return gpu.image(&desc);
    }
    let space = record.color_space;
    let top = MipSource { name, format, space, sizes: &sizes(packed, index), texels: levels[0] };
    let mip_chain = generator.make(&top)?;
    gpu.image_from(&desc, &mip_chain.buffer, &mip_chain.starts)
}

/// Expands the texels of a grey format to four channels.
fn expanded(bytes: &[u8], format: TexelFormat) -> Vec<u8> {
    let component = format.component();
    let (width, channels, opaque) = (component.bytes(), format.channels(), component.one());
    let mut out = Vec::with_capacity(bytes.len() / channels * 4);
    for texel in bytes.chunks_exact(width * channels) {
        let (grey, alpha) = texel.split_at(width);
        for _ in 0..3 {
            out.extend_from_slice(grey);
        }
        out.extend_from_slice(if channels == 2 { alpha } else { &opaque[..width] });
    }
    out
}

fn image_format(format: TexelFormat, srgb: bool) -> ImageFormat {
    match format {
        TexelFormat::Grey8 => ImageFormat::R8,
        TexelFormat::GreyAlpha8 => ImageFormat::Rg8,
        TexelFormat::Rgba8 if srgb => ImageFormat::Rgba8Srgb,
        TexelFormat::Rgba8 => ImageFormat::Rgba8,
        TexelFormat::Grey16 => ImageFormat::R16,
        TexelFormat::GreyAlpha16 => ImageFormat::Rg16,
        TexelFormat::Rgba16 => ImageFormat::Rgba16,
        TexelFormat::GreyFloat => ImageFormat::R32f,
        TexelFormat::GreyAlphaFloat => ImageFormat::Rg32f,
        TexelFormat::RgbaFloat => ImageFormat::Rgba32f,
    }
}
