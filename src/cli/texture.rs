//! `moire texture FILE`: describes a texture file, its levels, whether it tiles, and draws it repeated 2×2. A
//! texture that does not tile or that contains NaN is described like any other, with exit code 0.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serde_json::{Value, json};

use super::inputs::Inputs;
use super::texture_levels::{Extra, Profile};
use super::{interrupt, named_parser};
use crate::core::counted::{counted, plural};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::lab::metrics::read::film_of;
use crate::output::{self, WriteOptions};
use crate::texture::analysis::{Analysis, AxisAnalysis, Channel, Seam, Verdict, analyse};
use crate::texture::analysis_levels::{analyse_levels, analyse_normals};
use crate::texture::data::{ColorSpace, Component, Dimension, TextureData};
use crate::texture::decode::texture_of;
use crate::texture::read_file::{self, FileFacts, Picture};
use crate::texture::source::{OrientationUse, ProfileUse, ReadOptions};

/// Describe a texture file, and whether it tiles
///
/// Size, format, range and mean, levels, non-finite texels.
/// An axis tiles if the step from the last texels to the first is as common as others inside, or an edge as the texture
/// has inside, and if the texture's own period continues across it: yes, no, or perhaps.
#[derive(Debug, clap::Args)]
pub struct TextureArgs {
    /// PNG, JPEG, TIFF, TGA, HDR, EXR, WebP, DDS or KTX2
    pub file: PathBuf,
    /// Picture of it, repeated 2×2
    ///
    /// It looks like the file; alpha is left out.
    #[arg(short, long, value_name = "OUT.png")]
    pub out: Option<PathBuf>,
    /// Meaning of the values [default: what the file says, else linear]
    ///
    /// As in a scene; with srgb, range and mean are of linear values.
    #[arg(long, value_name = "SPACE",
          value_parser = named_parser(ColorSpace::NAMES, ColorSpace::from_name))]
    pub color_space: Option<ColorSpace>,
    /// Layer, part or channel of an EXR file [default: the one without a name]
    #[arg(long, value_name = "NAME")]
    pub layer: Option<String>,
    /// What becomes of an orientation (Exif)
    ///
    /// Apply it to the picture, or ignore it. TIFF files state one, too.
    #[arg(long, value_name = "USE", default_value = "apply",
          value_parser = named_parser(OrientationUse::NAMES, OrientationUse::from_name))]
    pub orientation: OrientationUse,
    /// Colour profile that a file states
    ///
    /// Colours of a file that is read as srgb are converted from another profile to sRGB.
    #[arg(long, value_name = "USE", default_value = "apply",
          value_parser = named_parser(ProfileUse::NAMES, ProfileUse::from_name))]
    pub color_profile: ProfileUse,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &TextureArgs) -> Result<ExitCode> {
    interrupt::ends_at_once()?;
    if let Some(path) = &args.out {
        Inputs::of(&args.file, "the texture that is described").check_picture(path)?;
    }
    let reading = ReadOptions {
        orientation: args.orientation,
        color_profile: args.color_profile,
        layer: args.layer.clone(),
    };
    let mut picture = read_file::read_any(&args.file, &reading)?;
    for note in std::mem::take(&mut picture.notes) {
        super::notify(format_args!("warning: {note}"));
    }
    let is_float = picture.texels.format.component() == Component::Float32;
    let color_space = args.color_space.or(picture.facts.color_space).unwrap_or(ColorSpace::Linear);
    if is_float && color_space == ColorSpace::Srgb {
        return Err(Error::with_help(
            format!("{}: float texels are linear light, not sRGB", args.file.display()),
            "leave out --color-space srgb; sRGB is an encoding of 8- and 16-bit values",
        ));
    }
    if let Some(path) = &args.out {
        // As many bits as the file has, so that its values are preserved.
        let png_bits = if picture.texels.format.component() == Component::Unorm16 { 16 } else { 8 };
        output::write(
            &repeated(&picture, &args.file)?,
            path,
            &WriteOptions { png_bits, ..WriteOptions::default() },
        )?;
    }
    let FileFacts { encoding, color_space: stated, dimension, profile, .. } = &picture.facts;
    let (encoding, stated, dimension, profile) = (encoding.clone(), *stated, *dimension, profile.clone());
    let clipped = if color_space == ColorSpace::Srgb { picture.apply_profile(&args.file) } else { None };
    let profile = profile.map(|stated| Profile { stated, clipped });
    let texture = texture_of(&args.file.display().to_string(), dimension, color_space, picture);
    let (levels, normals) = (analyse_levels(&texture), analyse_normals(&texture));
    let extra = Extra { encoding, profile, stated, levels, normals };
    let analysis = analyse_all(&texture);
    let text = if args.json {
        json(args, &texture, &analysis, &extra)?
    } else {
        table(args, &texture, &analysis, &extra)
    };
    super::print(text.trim_end()).map(|()| ExitCode::SUCCESS)
}

/// Returns the statistics of all slices or faces, with the steps of the first one.
fn analyse_all(texture: &TextureData) -> Analysis {
    let first = analyse(texture);
    if texture.depth == 1 {
        return first;
    }
    let rows = TextureData { height: texture.height * texture.depth, depth: 1, ..texture.clone() };
    Analysis { u: first.u, v: first.v, ..analyse(&rows) }
}

/// The longest side of a picture that is read again.
const MAX_OUT: u32 = 65_536;

/// Returns two by two copies, of several slices or faces those of the first. 8- and 16-bit values are decoded from sRGB whatever their meaning as
/// a texture: writing encodes them again, so that the picture looks like the file. Float values are
/// unchanged.
fn repeated(picture: &Picture, file: &Path) -> Result<Film> {
    let texels = &picture.texels;
    let (width, height) = (texels.width * 2, texels.height * 2);
    if width.max(height) > MAX_OUT {
        return Err(Error::with_help(
            format!("{}: {width}×{height} pixels are too many for a picture", file.display()),
            format!("leave out --out: pictures have at most {MAX_OUT} pixels a side"),
        ));
    }
    let mut pixels = Vec::new();
    pixels.try_reserve_exact(width as usize * height as usize).map_err(|_| {
        Error::with_help(
            format!("{}: {width}×{height} pixels do not fit into memory", file.display()),
            "leave out --out, or scale the texture down",
        )
    })?;
    let film = film_of(picture);
    for row in film.pixels.chunks_exact(texels.width as usize).take(texels.height as usize) {
        pixels.extend_from_slice(row);
        pixels.extend_from_slice(row);
    }
    pixels.extend_from_within(..);
    Ok(Film { width, height, pixels, samples: 0 })
}

fn json(args: &TextureArgs, texture: &TextureData, analysis: &Analysis, extra: &Extra) -> Result<String> {
    let report = json!({
        "file": texture.name,
        "size": [texture.width, texture.height],
        "dimension": texture.dimension.name(),
        "depth": texture.depth,
        "encoding": extra.encoding,
        "color_profile": extra.profile_json(),
        "stated_color_space": extra.stated.map(ColorSpace::name),
        "format": texture.format.name(),
        "file_channels": texture.file_channels,
        "bytes": texture.texels.len(),
        "color_space": texture.color_space.name(),
        "channels": analysis.channels.iter().map(channel_json).collect::<Vec<_>>(),
        "levels": extra.levels_json(),
        "normals": extra.normals_json(),
        "non_finite_texels": analysis.non_finite_texels,
        "first_non_finite": analysis.first_non_finite,
        "tiling": { "u": axis_json(&analysis.u), "v": axis_json(&analysis.v) },
        "out": args.out.as_ref().map(|path| path.display().to_string()),
    });
    serde_json::to_string_pretty(&report).map_err(|e| Error::new(format!("the report as JSON: {e}")))
}

fn channel_json(channel: &Channel) -> Value {
    json!({
        "name": channel.name,
        "min": channel.min,
        "max": channel.max,
        "mean": channel.mean,
        "nan": channel.nan,
        "infinite": channel.infinite,
    })
}

fn axis_json(axis: &AxisAnalysis) -> Value {
    json!({
        "tiles": axis.seam.tiles(),
        "verdict": axis.seam.verdict().name(),
        "seam": axis.seam.name(),
        "rank": axis.rank.map(|rank| rank.share),
        "of_largest": axis.rank.and_then(|rank| rank.of_largest),
        "period": axis.period.map(|period| period.texels),
        "misfit": axis.period.map(|period| period.misfit),
        "seam_rms": axis.seam_rms,
        "interior_rms": axis.interior_rms,
        "ratio": axis.ratio,
        "recurrence": axis.recurrence,
    })
}

fn table(args: &TextureArgs, texture: &TextureData, analysis: &Analysis, extra: &Extra) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12}{value}");
    };
    let of_file = texture.file_channels;
    line("file", texture.name.clone());
    line("size", size(texture));
    line(
        "format",
        format!(
            "{} from {}, {}",
            texture.format,
            counted(of_file, "channel"),
            counted(texture.texels.len(), "byte")
        ),
    );
    line("values", meaning(texture).into());
    for channel in &analysis.channels {
        line(channel.name, channel_line(channel));
    }
    extra.lines(texture).into_iter().for_each(|(name, value)| line(&name, value));
    let first = analysis.first_non_finite.map_or(String::new(), |[x, y]| format!(", first ({x}, {y})"));
    line("non-finite", format!("{}{first}", analysis.non_finite_texels));
    if texture.dimension != Dimension::Cube {
        line("tiles in u", axis_line(&analysis.u, texture.width, "column"));
        line("tiles in v", axis_line(&analysis.v, texture.height, "row"));
    }
    if let Some(path) = &args.out {
        line("written", path.display().to_string());
    }
    text
}

fn size(texture: &TextureData) -> String {
    let TextureData { width, height, depth, .. } = texture;
    match texture.dimension {
        Dimension::Three => format!("{width}×{height}×{depth} texels"),
        Dimension::Cube => {
            format!("6 faces of {width}×{height} {}", plural(u64::from(*width) * u64::from(*height), "texel"))
        }
        _ => format!("{width}×{height} {}", plural(u64::from(*width) * u64::from(*height), "texel")),
    }
}

fn meaning(texture: &TextureData) -> &'static str {
    match (texture.format.component(), texture.color_space) {
        (Component::Float32, _) => "as stored",
        (_, ColorSpace::Linear) => "as stored, scaled to [0, 1]",
        (_, ColorSpace::Srgb) => "decoded from sRGB",
    }
}

fn channel_line(channel: &Channel) -> String {
    let mut text = match (channel.min, channel.max, channel.mean) {
        (Some(min), Some(max), Some(mean)) => format!("{min:.6} to {max:.6}, mean {mean:.6}"),
        _ => "no finite value".into(),
    };
    if channel.nan + channel.infinite > 0 {
        let _ = write!(text, "; {} NaN, {} infinite", channel.nan, channel.infinite);
    }
    text
}

fn axis_line(axis: &AxisAnalysis, texels: u32, line: &str) -> String {
    let verdict = axis.seam.verdict();
    let why = match axis.seam {
        Seam::Smooth => String::new(),
        Seam::Pattern => ": the edge at the seam is one that the texture has inside".into(),
        Seam::Doubled => format!(", but the last {line} repeats the first: leave one out"),
        Seam::Constant if texels == 1 => ": one texel".into(),
        Seam::Constant => ": constant".into(),
        Seam::Visible => ": no step inside is like the seam".into(),
        Seam::Broken => ": what repeats inside does not go on across the seam".into(),
        Seam::Uncertain => ": the seam is among the largest steps inside; look at it with --out".into(),
        Seam::Unknown => ": no finite pair of texels".into(),
    };
    format!("{verdict}{why}{}", axis_numbers(axis, line, verdict))
}

fn axis_numbers(axis: &AxisAnalysis, line: &str, verdict: Verdict) -> String {
    let (Some(seam), Some(interior)) = (axis.seam_rms, axis.interior_rms) else { return String::new() };
    let mut text = format!(" (seam {seam:.6}, interior {interior:.6}");
    if let Some(ratio) = axis.ratio {
        let _ = write!(text, ", ratio {ratio:.3}");
    }
    if let Some((rank, largest)) = axis.rank.and_then(|r| Some((r, r.of_largest?))) {
        let share = 100.0 * rank.share;
        let _ = write!(text, "; larger than {share:.1} % of the steps inside, {largest:.2} of the largest");
    }
    if let Some(period) = axis.period.filter(|_| verdict != Verdict::Unknown) {
        let _ = write!(text, "; repeats every {}", counted(period.texels, line));
    }
    text + ")"
}
