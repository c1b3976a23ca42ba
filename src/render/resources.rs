//! Packed scene → buffers and images on the device: only what the features name, and of the
//! textures only the source in use.

use crate::error::{Error, Result};
use crate::features::{Features, TexelSource};
use crate::gpu::{
    BindGroup, BindingKind, Bound, Buffer, BufferUse, Gpu, Image, ImageDesc, ImageFormat, ImageShape,
    Pipeline, Sampler, Swizzle,
};
use crate::layout::HEAD_BYTES;
use crate::pack::{MAX_SLOTS, PackedScene, Sections, Slot};
use crate::shaders::{self, ReflectedBinding, Shader};
use crate::texture::data::{ColorSpace, TexelFormat};
use crate::texture::sampler_spec::{Address, Filter, SamplerSpec};

/// The render shader that reads texels from `source`.
pub fn shader_for(source: TexelSource) -> &'static Shader {
    match source {
        TexelSource::None => &shaders::RENDER_NONE,
        TexelSource::Buffer => &shaders::RENDER_TEXELS,
        TexelSource::Image => &shaders::RENDER_IMAGES,
    }
}

pub struct Resources {
    pub sections: Sections,
    scene: Buffer,
    texels: Option<Buffer>,
    images: Vec<(Image, Sampler)>,
}

impl Resources {
    pub fn upload(gpu: &Gpu, packed: &PackedScene, features: &Features) -> Result<Resources> {
        let (bytes, sections) = packed.scene_bytes();
        let scene = gpu.upload_buffer("scene", BufferUse::Storage, &bytes)?;
        let texels = match features.source {
            TexelSource::Buffer if packed.texels.is_empty() => {
                Some(gpu.upload_buffer("texels", BufferUse::TexelUint, &[0; 4])?)
            }
            TexelSource::Buffer => Some(upload_texels(gpu, packed)?),
            TexelSource::None | TexelSource::Image => None,
        };
        let images = match features.source {
            TexelSource::Image => upload_images(gpu, packed)?,
            TexelSource::None | TexelSource::Buffer => Vec::new(),
        };
        Ok(Resources { sections, scene, texels, images })
    }

    /// The shader's bindings with what they bind: 0 what it writes, 4 a list of queries, the other
    /// storage buffers the scene.
    pub fn bind(
        &self,
        gpu: &Gpu,
        pipeline: &Pipeline,
        shader: &Shader,
        output: &Buffer,
        queries: Option<&Buffer>,
    ) -> Result<BindGroup> {
        let images: Vec<(&Image, &Sampler)> = self.images.iter().map(|(i, s)| (i, s)).collect();
        let resource = |b: &ReflectedBinding| {
            let resource = match (b.kind, b.binding) {
                (BindingKind::StorageBuffer, 0) => Bound::Buffer(output),
                (BindingKind::StorageBuffer, 4) => Bound::Buffer(queries?),
                (BindingKind::StorageBuffer, _) => Bound::Buffer(&self.scene),
                (BindingKind::UniformBuffer, _) => Bound::Head(&self.scene, HEAD_BYTES as u64),
                (BindingKind::TexelBuffer, _) => Bound::Texels(self.texels.as_ref()?),
                (BindingKind::SampledImage, _) => Bound::Images(&images),
            };
            Some((b.binding, resource))
        };
        let bound: Vec<(u32, Bound<'_>)> = shader.bindings.iter().filter_map(resource).collect();
        gpu.bind(pipeline, &bound)
    }
}

fn upload_texels(gpu: &Gpu, packed: &PackedScene) -> Result<Buffer> {
    let words = packed.texels.len() as u64 / 4;
    // The shader's index is an `int`, whatever the device allows.
    let limit = gpu.info().limits.max_texel_buffer_elements.min(i32::MAX as u64);
    if words > limit {
        return Err(Error::with_help(
            format!(
                "the textures {} together take {} MiB, over the {} MiB of a texel buffer on device \"{}\"",
                packed.texture_names.join(", "),
                packed.texels.len() >> 20,
                (limit * 4) >> 20,
                gpu.info().name
            ),
            "use smaller textures, or --texels image (up to 16 textures)",
        ));
    }
    gpu.upload_buffer("texels", BufferUse::TexelUint, &packed.texels)
}

fn upload_images(gpu: &Gpu, packed: &PackedScene) -> Result<Vec<(Image, Sampler)>> {
    if packed.slots.len() > MAX_SLOTS {
        return Err(Error::with_help(
            format!(
                "the scene reads {} pairs of texture and sampler through images; {MAX_SLOTS} are possible",
                packed.slots.len()
            ),
            "one sampler of method \"hardware\" makes all look-ups go through images: use --method shader, \
             or share samplers and textures",
        ));
    }
    // One image serves all slots that read it in the same form.
    let mut images: Vec<((usize, Form), Image)> = Vec::new();
    let mut slots = Vec::new();
    for slot in &packed.slots {
        let spec = packed.sampler_specs[slot.sampler];
        let form = Form::of(packed, slot, &spec);
        let image = match images.iter().find(|(key, _)| *key == (slot.texture, form)) {
            Some((_, image)) => image.clone(),
            None => {
                let image = upload_image(gpu, packed, slot.texture, form)?;
                images.push(((slot.texture, form), image.clone()));
                image
            }
        };
        let sampler = if slot.hardware { spec } else { SamplerSpec::default() };
        slots.push((image, gpu.sampler(&sampler)?));
    }
    Ok(slots)
}

/// In what form an image is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Form {
    /// Decode sRGB in the texture unit, before it filters.
    decode: bool,
    /// Four channels although the file has fewer: a border colour must not be swizzled, and drivers
    /// know sRGB with four channels only.
    expand: bool,
    /// The texture unit interpolates.
    filtered: bool,
}

impl Form {
    fn of(packed: &PackedScene, slot: &Slot, spec: &SamplerSpec) -> Form {
        let texture = &packed.textures[slot.texture];
        let srgb = texture.link[0] == ColorSpace::Srgb as u32;
        Form::new(slot.hardware, srgb, spec)
    }

    fn new(hardware: bool, srgb: bool, spec: &SamplerSpec) -> Form {
        let border = spec.address.contains(&Address::ClampToBorder);
        Form {
            decode: hardware && srgb,
            expand: hardware && (srgb || border),
            filtered: hardware && (spec.mag == Filter::Linear || spec.min == Filter::Linear),
        }
    }
}

/// Whether the device's own samplers read textures of this format so.
pub fn can_sample(gpu: &Gpu, spec: &SamplerSpec, format: TexelFormat, space: ColorSpace) -> bool {
    let limits = &gpu.info().limits;
    let form = Form::new(true, space == ColorSpace::Srgb, spec);
    let channels = if form.expand { 4 } else { format.channels() };
    let stored = image_format(TexelFormat::new(channels, format.component()), form.decode);
    let mirrors = limits.mirror_clamp_to_edge || !spec.address.contains(&Address::MirrorClampToEdge);
    mirrors && gpu.supports(stored, form.filtered)
}

fn upload_image(gpu: &Gpu, packed: &PackedScene, index: usize, form: Form) -> Result<Image> {
    let record = &packed.textures[index];
    let [first_word, width, height, format] = record.place;
    let format = TexelFormat::ALL[format as usize];
    let start = first_word as usize * 4;
    let bytes = &packed.texels[start..start + width as usize * height as usize * format.bytes_per_texel()];
    let name = &packed.texture_names[index];
    let expanded = expanded(bytes, format, form);
    let (format, texels) = expanded.as_ref().map_or((format, bytes), |(f, b)| (*f, b.as_slice()));
    let stored = image_format(format, form.decode);
    if !gpu.supports(stored, form.filtered) {
        let filtering = if form.filtered { "with linear filtering" } else { "as a sampled image" };
        return Err(Error::with_help(
            format!(
                "texture `{name}`: device \"{}\" does not support {stored} images {filtering}",
                gpu.info().name
            ),
            "use method = \"shader\" with --texels buffer, or store the texture with 8 bits",
        ));
    }
    gpu.image(&ImageDesc {
        name,
        shape: ImageShape::Flat,
        width,
        height,
        depth: 1,
        format: stored,
        swizzle: match format.channels() {
            1 => Swizzle::Grey,
            2 => Swizzle::GreyAlpha,
            _ => Swizzle::Rgba,
        },
        levels: &[texels],
    })
}

/// The texels with four channels, where `expand` asks for it.
fn expanded(bytes: &[u8], format: TexelFormat, form: Form) -> Option<(TexelFormat, Vec<u8>)> {
    if !form.expand || format.channels() == 4 {
        return None;
    }
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
    Some((TexelFormat::new(4, component), out))
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
