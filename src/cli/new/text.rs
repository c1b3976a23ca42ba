//! The text of a new scene. Input: what is shown, its pictures or model, and the folder of the scene. Output: a commented
//! scene file; comments say what was found in the files, and what was chosen for that.

use std::fmt::Write as _;
use std::path::Path;

use super::Kind;
use super::material::{MaterialWriter, one_line};
use super::paths::{relative, toml_string};
use super::surface::Surface;
use crate::core::error::Result;
use crate::scene::{ModelView, model_view};

const SAMPLING: &str = "\n[sampling]\npattern = \"sobol-owen\"\nspp = 16                      # samples a pixel\n\
                        footprint = \"cone\"            # each look-up averages over what its sample covers\n";
const LAMP: &str = "\n[[light]]                     # a large lamp: soft shadows\nkind = \"sphere\"\n\
                    position = [-3.0, 5.0, 4.0]\nradius = 0.8\nintensity = [110.0, 105.0, 95.0]\n\n\
                    [[light]]                     # the sky's share\nkind = \"directional\"\n\
                    direction = [0.5, 1.0, 0.6]\nirradiance = [0.5, 0.6, 0.8]\n";
/// Most pixels of a side of the picture of a quad.
const MAX_SIDE: u32 = 512;

pub(super) struct Writer<'a> {
    pub kind: Kind,
    pub surface: &'a Surface,
    pub model: Option<&'a Path>,
    /// The folder in which the scene lies.
    pub folder: &'a Path,
}

impl Writer<'_> {
    pub fn scene(&self) -> Result<String> {
        let mut text = self.head();
        for why in &self.surface.left_out {
            let _ = writeln!(text, "# Left out: {}", one_line(why));
        }
        for what in &self.surface.notes {
            let _ = writeln!(text, "# Note: {}", one_line(what));
        }
        let materials = MaterialWriter { kind: self.kind, surface: self.surface, folder: self.folder };
        let model = self.model.map(model_view).transpose()?;
        text += "\n";
        text += &self.view(model.as_ref());
        text += &self.background(model.as_ref());
        text += &materials.textures()?;
        text += &materials.material();
        text += &self.shape(materials.replaces_own())?;
        text += &self.lights(model.as_ref());
        Ok(text)
    }

    /// Returns the sky where it shines, else the lights of the model or a lamp, if light has to fall on anything.
    fn lights(&self, model: Option<&ModelView>) -> String {
        match (self.surface.is_sky_light(), model) {
            (true, _) => "\n[[light]]\nkind = \"environment\"          # the sky lights the scene\n".into(),
            (false, Some(model)) => model.lights.clone(),
            (false, None) if self.kind == Kind::Ball || self.surface.is_lit() => LAMP.into(),
            (false, None) => String::new(),
        }
    }

    fn head(&self) -> String {
        let what = match self.kind {
            Kind::Floor => "A floor to the horizon",
            Kind::Ball => "A ball on the ground",
            Kind::Quad => "A picture that fills the image",
            Kind::Model => "A model, seen whole",
        };
        format!("# {what}. Paths are relative to this file; docs/scene-format.md has all keys.\n")
    }

    fn view(&self, model: Option<&ModelView>) -> String {
        let view = match self.kind {
            Kind::Floor => {
                "[camera]\neye = [0.0, 1.6, 0.0]         # as high as a person's eyes, if a unit is a metre\n\
                            look_at = [0.4, 1.15, -2.0]\nvertical_fov = 50.0\n\n[image]\nsize = [384, 288]\n"
                    .into()
            }
            Kind::Ball => {
                "[camera]\neye = [0.0, 1.5, 4.0]\nlook_at = [0.0, 0.95, 0.0]\nvertical_fov = 40.0\n\n\
                           [image]\nsize = [384, 288]\n"
                    .into()
            }
            Kind::Quad => {
                let [width, height] = self.quad_size();
                format!(
                    "[camera]\neye = [0.0, 0.0, 1.0]\nlook_at = [0.0, 0.0, 0.0]\n\
                     orthographic_height = 2.0     # parallel rays: the picture from -1 to 1\n\n\
                     [image]\nsize = [{width}, {height}]\n"
                )
            }
            Kind::Model => return model.map(|model| model.view.clone()).unwrap_or_default(),
        };
        view + SAMPLING
    }

    /// Returns the size of the picture, in the shape of the texture.
    fn quad_size(&self) -> [u32; 2] {
        let [width, height] = self.surface.color.as_ref().map_or([MAX_SIDE; 2], |color| color.size);
        let longest = width.max(height);
        let of = |side: u32| {
            (u64::from(side) * u64::from(MAX_SIDE.min(longest)) / u64::from(longest)).max(1) as u32
        };
        [of(width), of(height)]
    }

    fn background(&self, model: Option<&ModelView>) -> String {
        match (&self.surface.sky, model) {
            (Some(_), _) => "\n[background]\nenvironment = \"sky\"\n".into(),
            (None, Some(model)) => model.background.clone(),
            (None, None) => "\n[background]\ncolor = [0.45, 0.6, 0.85]     # the sky\n".into(),
        }
    }

    fn shape(&self, replaces_own: bool) -> Result<String> {
        Ok(match self.kind {
            Kind::Floor => "\n[[plane]]\norigin = [0.0, 0.0, 0.0]\n\
                            tangent = [1.0, 0.0, 0.0]     # u grows to the right,\n\
                            bitangent = [0.0, 0.0, 1.0]   # v towards the viewer, as rows of a picture grow downwards\n\
                            material = \"surface\"\n"
                .into(),
            Kind::Ball => "\n[[material]]\nname = \"ground\"\ncolor = [0.35, 0.33, 0.3]\n\n\
                           [[sphere]]\ncenter = [0.0, 1.0, 0.0]\nradius = 1.0\nmaterial = \"surface\"\n\n\
                           [[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\n\
                           bitangent = [0.0, 0.0, -1.0]\nhalf_extent = 3.0\nmaterial = \"ground\"\n"
                .into(),
            Kind::Quad => {
                let [width, height] = self.quad_size();
                format!(
                    "\n[[plane]]                     # u from left to right, v from the upper edge to the lower\n\
                     origin = [0.0, 0.0, 0.0]\ntangent = [{:?}, 0.0, 0.0]\nbitangent = [0.0, -1.0, 0.0]\n\
                     half_extent = 1.0\nmaterial = \"surface\"\n",
                    f64::from(width) / f64::from(height)
                )
            }
            Kind::Model => {
                let file = toml_string(&relative(self.model.unwrap_or(Path::new("")), self.folder)?);
                let own = "material = \"surface\"          # in place of its own\n";
                let material = if replaces_own { own } else { "" };
                format!("\n[[mesh]]\nfile = {file}\n{material}")
            }
        })
    }
}
