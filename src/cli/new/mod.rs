//! `moire new`: writes a short scene that renders at once. Input: what to show, and files of pictures or a model, at which it
//! looks; or a scene of the program. Output: a commented scene file, with the files of the program that it names beside it.

mod bands;
mod copies;
mod green;
mod inputs;
mod material;
mod names;
mod paths;
mod photo;
mod surface;
mod text;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::inputs::Inputs;
use super::interrupt;
use crate::core::error::{Error, ErrorKind, Result};
use crate::core::named::named_enum;
use crate::lab::study::quote;
use crate::output;
use crate::scene::{BuiltIn, is_model, is_standard_input, parse};
use copies::Copies;
use inputs::Subject;
use photo::Photo;
use surface::Surface;

named_enum! {
    /// What a new scene shows.
    pub enum Kind {
        /// A floor up to the horizon.
        Floor = "floor",
        /// A ball on the ground.
        Ball = "ball",
        /// The picture itself, which fills the image.
        Quad = "quad",
        /// A model, seen whole.
        Model = "model",
    }
}

/// Write a scene of your pictures or model, or copy one
///
/// Pictures are looked at: color space, orientation, alpha, whether their borders fit together, and what they are by the
/// usual names of an artist's set (albedo, normal, roughness, …). Comments of the scene say what was chosen and why.
#[derive(clap::Args, Debug)]
pub struct NewArgs {
    /// floor, ball, quad or model, the file of a model, or @NAME for a copy of a scene of the program [default: floor]
    what: Option<PathBuf>,
    /// File of the model (glTF, OBJ, PLY, STL)
    model: Option<PathBuf>,
    /// Pictures for the surface, or a folder of them, or the model: colors, normal map, roughness, sky
    #[arg(short, long = "texture", value_name = "FILE", num_args = 1..)]
    texture: Vec<PathBuf>,
    /// Scene file to write [default: what it shows with .toml, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    /// List the scenes of the program, each with what it shows
    #[arg(long, conflicts_with_all = ["what", "model", "texture", "output", "force"])]
    list: bool,
    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(args: &NewArgs) -> Result<ExitCode> {
    interrupt::ends_at_once()?;
    if args.list {
        return list();
    }
    args.output.as_deref().map_or(Ok(()), check_name)?;
    if let Some(what) = &args.what
        && let Some(scene) = BuiltIn::named(what)?
    {
        return copy(args, scene);
    }
    let Subject { kind, model, pictures, none } = inputs::subject(args)?;
    let out = args.output.clone().unwrap_or_else(|| format!("{}.toml", kind.name()).into());
    let folder = out.parent().unwrap_or(Path::new(""));
    let mut copies = Copies::default();
    let is_empty = pictures.is_empty() && model.is_none();
    let photos = Photo::look_all(&if is_empty { copies.samples(kind) } else { pictures })?;
    let model = model.or_else(|| (kind == Kind::Model).then(|| copies.model()));
    let mut surface = Surface::new(photos, kind);
    surface.left_out.extend(none);
    let writer = text::Writer { kind, surface: &surface, model: model.as_deref(), folder };
    let text = writer.scene()?;
    // It is read again, so that it can be rendered.
    parse(&copies.place(&out), &text).map_err(|error| {
        let what = format!("{}: the new scene cannot be read: {error}", out.display());
        Error::new(what).of_kind(ErrorKind::Internal)
    })?;
    write(args, &out, &text, &copies)?;
    if !args.quiet {
        surface.left_out.iter().for_each(|why| super::notify(format_args!("left out: {why}")));
        surface.notes.iter().for_each(|what| super::notify(format_args!("note: {what}")));
        told(&out, &copies);
    }
    Ok(ExitCode::SUCCESS)
}

fn list() -> Result<ExitCode> {
    let scenes = BuiltIn::all();
    let width = scenes.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    let line = |scene: &BuiltIn| format!("@{:width$}  {}", scene.name, scene.summary());
    super::print(&scenes.iter().map(line).collect::<Vec<_>>().join("\n"))?;
    Ok(ExitCode::SUCCESS)
}

/// Writes a scene of the program with its files.
fn copy(args: &NewArgs, scene: BuiltIn) -> Result<ExitCode> {
    if let Some(file) = args.model.as_ref().or(args.texture.first()) {
        return Err(Error::with_help(
            format!("{}: a copy of {} has files of its own", file.display(), scene.shown()),
            "write the copy first, and name the file in it; or try --set with `moire render`",
        ));
    }
    let out = args.output.clone().unwrap_or_else(|| format!("{}.toml", scene.name).into());
    let (text, copies) = copies::of_scene(scene)?;
    write(args, &out, &text, &copies)?;
    if !args.quiet {
        told(&out, &copies);
    }
    Ok(ExitCode::SUCCESS)
}

/// Refuses the name of a picture or of a model for a scene, and standard output, beside which no texture can be written.
fn check_name(out: &Path) -> Result<()> {
    let what = if is_standard_input(out) {
        "-o -: a new scene is a file, to whose folder its paths are relative".to_owned()
    } else if output::format_of(out).is_ok() {
        format!("{}: this is a picture's name, and `moire new` writes a scene", out.display())
    } else if is_model(out) {
        format!("{}: this is a model's name, and `moire new` writes a scene", out.display())
    } else {
        return Ok(());
    };
    Err(Error::with_help(
        what,
        "name a scene file, such as -o scene.toml; `moire render` makes the picture of it",
    ))
}

/// Writes the scene and the files of the program beside it, unless one of them would replace another file.
fn write(args: &NewArgs, out: &Path, text: &str, copies: &Copies) -> Result<()> {
    let read = args.texture.iter().chain(&args.model).chain(&args.what);
    let inputs = read.fold(Inputs::default(), |inputs, path| inputs.and(path, "a file of the scene"));
    let folder = out.parent().unwrap_or(Path::new(""));
    let beside: Vec<(PathBuf, &[u8])> =
        copies.files().map(|(name, bytes)| (folder.join(name), bytes)).collect();
    for (path, bytes) in
        beside.iter().map(|(path, bytes)| (path.as_path(), *bytes)).chain([(out, text.as_bytes())])
    {
        inputs.check_file(path)?;
        let is_other = path.exists() && std::fs::read(path).map_or(true, |there| there != bytes);
        if is_other && !args.force {
            return Err(Error::with_help(
                format!("{}: the file exists", path.display()),
                "choose another name with -o, or replace it with --force",
            ));
        }
    }
    // The scene last: where it is, its files are.
    beside.iter().try_for_each(|(path, bytes)| output::write_file(path, bytes))?;
    output::write_file(out, text.as_bytes())
}

fn told(out: &Path, copies: &Copies) {
    let names: Vec<&str> = copies.files().map(|(name, _)| name).collect();
    let beside = if names.is_empty() { String::new() } else { format!(", beside it {}", names.join(", ")) };
    super::notify(format_args!("{}{beside}", out.display()));
    super::notify(format_args!("moire render {}", quote(&out.display().to_string())));
}
