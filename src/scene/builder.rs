//! A scene, part by part. In: camera, size, textures, samplers, materials, shapes and lights, from a file of any format
//! or from code. Out: the whole scene, every reference checked and every number within its limits, or what is wrong
//! with the first part that breaks a rule.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::checks;
use super::geometry::{self, Fields, Kind, Section, Shapes};
use super::limits::{MAX_TEXTURES, check_filters};
use super::model::{
    Background, Camera, DEFAULT, Light, MappingKind, Material, PixelFilter, Sampling, Scene, TextureSource,
};
use super::refusal::{Check, Key};
use super::setting::Setting;
use super::tiles;
use super::whole;
use crate::core::error::Result;
use crate::texture::sampler_spec::SamplerSpec;

/// Collects the parts of a scene. Each part that others refer to returns its index.
#[derive(Clone, Debug)]
pub struct SceneBuilder {
    scene: Scene,
    /// The first shape that is one too many.
    over: Option<Key>,
    /// Meshes stay whole, and nodes of glTF files apart.
    keeps_meshes: bool,
    /// Warnings, each with its place among them and how often it was told.
    notes: HashMap<String, (usize, usize)>,
}

impl SceneBuilder {
    /// Begins a scene that this camera sees on a picture of so many pixels.
    pub fn new(camera: Camera, width: u32, height: u32) -> SceneBuilder {
        let scene = Scene {
            path: PathBuf::from("scene"),
            camera,
            width,
            height,
            pixel_filter: PixelFilter::default(),
            sampling: Sampling::default(),
            background: Background::default(),
            textures: Vec::new(),
            samplers: Vec::new(),
            materials: Vec::new(),
            shapes: Shapes::default(),
            dropped_triangles: 0,
            first_dropped: String::new(),
            lights: Vec::new(),
            sources: Vec::new(),
            settings: Vec::new(),
            notes: Vec::new(),
        };
        SceneBuilder { scene, over: None, keeps_meshes: false, notes: HashMap::new() }
    }

    /// Names the scene, for messages.
    pub fn path(&mut self, path: &Path) -> &mut Self {
        self.scene.path = path.to_owned();
        self
    }

    /// Makes each mesh, and each node of a glTF file with its material, a shape of its own, whatever its number of
    /// triangles.
    /// Returns what held before.
    pub(super) fn keep_meshes(&mut self, keeps: bool) -> bool {
        std::mem::replace(&mut self.keeps_meshes, keeps)
    }

    /// Returns true if a material has a texture that it reads by coordinates of triangles.
    pub(super) fn is_textured(&self, material: usize) -> bool {
        let material = self.scene.materials.get(material);
        material.is_some_and(|own| own.is_mapped() && own.mapping.kind == MappingKind::Surface)
    }

    /// Returns true if a mesh of this material has to be a shape of its own, as one of its triangles would have another
    /// number, box or centre.
    pub(super) fn is_kept_whole(&self, material: usize) -> bool {
        let mapping = self.scene.materials.get(material).map(|material| material.mapping);
        self.keeps_meshes || mapping.is_some_and(|mapping| mapping.depends_on_shape())
    }

    /// Sets the camera and the pixels of the picture anew.
    pub(super) fn view(&mut self, camera: Camera, width: u32, height: u32) -> &mut Self {
        (self.scene.camera, self.scene.width, self.scene.height) = (camera, width, height);
        self
    }

    /// Sets how samples around a pixel are weighted; a box of its own square else.
    pub fn pixel_filter(&mut self, filter: PixelFilter) -> &mut Self {
        self.scene.pixel_filter = filter;
        self
    }

    /// Sets how the picture is sampled; 16 stratified samples a pixel else.
    pub fn sampling(&mut self, sampling: Sampling) -> &mut Self {
        self.scene.sampling = sampling;
        self
    }

    /// Sets what rays see that hit nothing; black else.
    pub fn background(&mut self, background: Background) -> &mut Self {
        self.scene.background = background;
        self
    }

    /// Adds a texture and returns its index. Its files are opened by the render.
    pub fn texture(&mut self, texture: TextureSource) -> usize {
        push(&mut self.scene.textures, texture)
    }

    /// Adds a sampler and returns its index.
    pub fn sampler(&mut self, sampler: SamplerSpec) -> usize {
        push(&mut self.scene.samplers, sampler)
    }

    /// Returns the index of an equal sampler, which is added if there is none.
    pub(super) fn sampler_like(&mut self, sampler: SamplerSpec) -> usize {
        let known = self.scene.samplers.iter().position(|other| *other == sampler);
        known.unwrap_or_else(|| self.sampler(sampler))
    }

    /// Adds a material and returns its index. Textures and samplers that it names may follow later.
    pub fn material(&mut self, material: Material) -> usize {
        push(&mut self.scene.materials, material)
    }

    /// Adds a shape.
    pub fn shape(&mut self, shape: impl Kind) -> &mut Self {
        self.over = self.over.or(geometry::add(&mut self.scene.shapes, shape));
        self
    }

    /// Adds a shape that a scene format has read; returns whether no ray meets it.
    pub(super) fn read_shape(
        &mut self,
        kind: &Section,
        fields: &dyn Fields,
        material: usize,
        motion: DVec3,
    ) -> Result<bool> {
        let added = (kind.add)(fields, material, motion, &mut self.scene.shapes)?;
        self.over = self.over.or(added.over);
        Ok(added.is_empty)
    }

    /// Returns true if it has a shape.
    pub(super) fn has_shapes(&self) -> bool {
        self.scene.shapes.iter().next().is_some()
    }

    /// Names a further file that the scene was read from.
    pub(super) fn source(&mut self, path: PathBuf) {
        self.scene.sources.push(path);
    }

    /// Names what replaced values of the scene's file.
    pub(super) fn settings(&mut self, settings: &[Setting]) {
        self.scene.settings.extend(settings.iter().map(|setting| setting.text().to_owned()));
    }

    /// Adds a warning about the files of the scene; the same one more often is told once, with its count.
    pub(super) fn note(&mut self, note: String) {
        match self.notes.get_mut(&note) {
            Some((_, count)) => *count += 1,
            None => {
                self.notes.insert(note, (self.notes.len(), 1));
            }
        }
    }

    /// Gives the scene its warnings, in the order in which each was first told.
    fn tell(&mut self) {
        let mut notes: Vec<_> = std::mem::take(&mut self.notes).into_iter().collect();
        notes.sort_unstable_by_key(|(_, (place, _))| *place);
        self.scene.notes.extend(notes.into_iter().map(|(note, (_, count))| match count {
            1 => note,
            _ => format!("{note} ({count} times)"),
        }));
    }

    /// Adds a light.
    pub fn light(&mut self, light: Light) -> &mut Self {
        self.scene.lights.push(light);
        self
    }

    /// Returns the scene, or the first rule that it breaks.
    pub fn build(self) -> Result<whole::Scene> {
        let scene = self.check().map_err(|refusal| refusal.error())?;
        check_filters(&scene)?;
        Ok(whole::Scene::new(scene))
    }

    /// Returns the scene, or the item and key that break a rule.
    pub(super) fn check(mut self) -> Check<Scene> {
        self.check_counts()?;
        self.tell();
        self.complete();
        let scene = &self.scene;
        checks::camera(Key::item("camera", 0), &scene.camera)?;
        checks::image(Key::item("image", 0), [scene.width, scene.height], &scene.pixel_filter)?;
        checks::sampling(Key::item("sampling", 0), &scene.sampling)?;
        each("texture", &scene.textures, checks::texture)?;
        each("sampler", &scene.samplers, checks::sampler)?;
        let (textures, samplers) = (&scene.textures, scene.samplers.len());
        each("material", &scene.materials, |key, m| checks::material(key, m, textures, samplers))?;
        checks::background(Key::item("background", 0), &scene.background, textures, samplers)?;
        geometry::check(scene)?;
        each("light", &scene.lights, checks::light)?;
        tiles::apply(&mut self.scene)?;
        self.simplify();
        Ok(self.scene)
    }

    fn check_counts(&self) -> Check {
        let refuse = |key: Key, count: usize, what: &str, most: usize| {
            key.refuse(format!("{count} {what}; a scene may have {most} at most"), "one too many")
        };
        let textures = self.scene.textures.len();
        if textures > MAX_TEXTURES {
            return refuse(Key::item("texture", MAX_TEXTURES), textures, "textures", MAX_TEXTURES);
        }
        geometry::check_count(&self.scene.shapes, self.over)
    }

    /// Adds the default sampler and the default material where something has them.
    fn complete(&mut self) {
        let scene = &mut self.scene;
        let added = scene.samplers.len();
        // Without any sampler, index 0 means the default one too.
        let is_default = |sampler: usize| sampler == DEFAULT || added == 0 && sampler == 0;
        let mut samplers: Vec<&mut usize> = Vec::new();
        for material in &mut scene.materials {
            if !material.is_mapped() {
                material.sampler = 0;
            } else {
                samplers.extend(material.sampler_indices_mut().filter(|sampler| is_default(**sampler)));
            }
        }
        let environment = scene.background.environment.as_mut().map(|e| &mut e.sampler);
        samplers.extend(environment.filter(|sampler| is_default(**sampler)));
        if !samplers.is_empty() {
            samplers.into_iter().for_each(|sampler| *sampler = added);
            scene.samplers.push(SamplerSpec::default());
        }
        let added = scene.materials.len();
        let mut uses_default = false;
        for shape in scene.shapes.iter_mut().filter(|shape| shape.material() == DEFAULT) {
            *shape.material_mut() = added;
            uses_default = true;
        }
        if uses_default {
            scene.materials.push(Material::default());
        }
    }

    /// Leaves out what has no extent: lenses, balls and suns of size 0, triangles without area.
    fn simplify(&mut self) {
        let scene = &mut self.scene;
        scene.camera.lens = scene.camera.lens.filter(|lens| lens.radius > 0.0);
        for light in &mut scene.lights {
            *light = match *light {
                Light::Sphere { position, radius: 0.0, intensity } => Light::Point { position, intensity },
                Light::Sun { direction, angle: 0.0, irradiance } => {
                    Light::Directional { direction, irradiance }
                }
                light => light,
            };
        }
        let first = geometry::drop_empty(scene);
        scene.first_dropped = first.map_or(String::new(), |first| format!("number {first}"));
    }
}

fn push<T>(items: &mut Vec<T>, item: T) -> usize {
    items.push(item);
    items.len() - 1
}

fn each<T>(section: &'static str, items: &[T], check: impl Fn(Key, &T) -> Check) -> Check {
    items.iter().enumerate().try_for_each(|(i, item)| check(Key::item(section, i), item))
}
