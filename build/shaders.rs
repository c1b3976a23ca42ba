//! The shaders, in families that share a main file. A family has one shader for each combination of the sources of
//! texels (`TexelSource`) and precisions of geometry (`Reals`) that it lists; without any it has no texels or computes
//! in f32. The names of source and precision are appended to that of the family.

pub struct Family {
    pub name: &'static str,
    /// Path relative to `glsl`.
    pub main: &'static str,
    pub sources: &'static [&'static str],
    pub reals: &'static [&'static str],
}

const fn family(
    name: &'static str,
    main: &'static str,
    sources: &'static [&'static str],
    reals: &'static [&'static str],
) -> Family {
    Family { name, main, sources, reals }
}

pub const FAMILIES: &[Family] = &[
    family("render", "shared/render_main.glsl", &["none", "buffer", "image", "solids"], &["f32", "f64-math"]),
    family("cone", "shared/cone_main.glsl", &["none", "buffer", "image", "solids"], &[]),
    family("beam", "shared/beam_main.glsl", &[], &["f32", "f64-records"]),
    family("tile_culling", "shared/tile_culling_main.glsl", &[], &["f32", "f64-records"]),
    family("mips", "mips.glsl", &[], &[]),
    family("goal", "goal/main.glsl", &[], &[]),
    family("probe", "shared/probe_main.glsl", &["buffer", "image", "solids"], &[]),
    family("probe_rays", "shared/probe_rays_main.glsl", &["none"], &["f32", "f64-math"]),
    family("probe_procedural", "probe_procedural.glsl", &["none"], &[]),
    family("probe_disk_sampling", "probe_disk_sampling.glsl", &[], &[]),
    family("probe_glass", "probe_glass.glsl", &[], &[]),
    family("strata", "strata.glsl", &[], &[]),
];

/// One shader of a family.
pub struct Variant {
    pub name: String,
    pub source: Option<&'static str>,
    pub reals: Option<&'static str>,
    /// The input of the compiler: definitions, and the include of the main file.
    pub text: String,
}

impl Family {
    pub fn variants(&self) -> Vec<Variant> {
        let each = |names: &'static [&'static str]| -> Vec<Option<&'static str>> {
            if names.is_empty() { vec![None] } else { names.iter().map(|n| Some(*n)).collect() }
        };
        let of_source = |source| each(self.reals).into_iter().map(move |reals| self.variant(source, reals));
        each(self.sources).into_iter().flat_map(of_source).collect()
    }

    fn variant(&self, source: Option<&'static str>, reals: Option<&'static str>) -> Variant {
        let mut name = self.name.to_string();
        let mut text = String::from("#version 460\n#extension GL_GOOGLE_include_directive : require\n");
        if let Some(source) = source {
            text += &format!("#define SOURCE SOURCE_{}\n", source.to_uppercase());
            if self.sources.len() > 1 {
                name += &format!("_{source}");
            }
        }
        if let Some(reals) = reals.filter(|r| *r != "f32") {
            let constant = reals.replace('-', "_");
            text += &format!("#define {}\n", constant.to_uppercase());
            name += &format!("_{constant}");
        }
        text += &format!("#include \"{}\"\n", self.main);
        Variant { name, source, reals, text }
    }
}
