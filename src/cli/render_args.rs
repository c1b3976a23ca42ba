//! The arguments of `moire render`. In: the command line. Out: a scene or a picture to render again, the outputs, and all
//! options.

use std::path::PathBuf;

use clap::Args;

use super::display::FileArgs;
use super::layers::LayerArgs;
use super::overrides::Overrides;
use super::{DEVICE, MEASURING, OUTPUT, REPORT, TEXTURES, VIEW};
use crate::core::range::Rect;
use crate::output::{self, ENDING_NAMES, Format};
use crate::render::{EstimateChoice, MipChoice, TexelChoice, Tuning};

/// Render a scene file into one or more pictures
///
/// Options change the scene before it is rendered; `--set` changes any value of it. Pictures carry a record by which
/// `--from` renders them again.
#[derive(Args, Debug)]
#[command(override_usage = "moire render [OPTIONS] <SCENE>\n       moire render [OPTIONS] --from <PICTURE>")]
pub struct RenderArgs {
    /// Scene file, model (glTF, OBJ, PLY, STL), @NAME of a scene of the program, or - for standard input
    #[arg(required_unless_present = "from")]
    pub scene: Option<PathBuf>,
    /// Render a picture again from the record that it carries
    ///
    /// It stands in place of a scene. Other options override those of the record.
    #[arg(long, value_name = "PICTURE", conflicts_with = "scene", help_heading = VIEW)]
    pub from: Option<PathBuf>,
    /// Leave options of the record out, such as crop,white-balance
    ///
    /// With --from: recorded options by their names, separated by commas.
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = VIEW)]
    pub without: Vec<String>,
    /// Picture to write: .exr .hdr .png .jpg .tif, or - [default: the scene's name with .png]
    ///
    /// The ending selects the format: exr and hdr hold linear floats, png, jpg and tif are for screens. May be given
    /// several times, for several files of one rendering. - is standard output. Without it the picture goes into the
    /// current folder.
    #[arg(short, long = "output", value_name = "OUT", help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Format of what -o - writes
    #[arg(long, value_name = "FORMAT", value_parser = super::named_parser(&ENDING_NAMES, output::format_named), help_heading = OUTPUT)]
    pub format: Option<Format>,
    #[command(flatten)]
    pub layers: LayerArgs,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub files: FileArgs,
    /// Device: index, part of its name, cpu, gpu or oracle [default: discrete GPU, else integrated, else CPU]
    ///
    /// `moire devices` lists them; oracle is float64 on the CPU. May be given several times, also one device: strips of
    /// the picture are assigned to them in turn.
    #[arg(long, value_name = "SEL", help_heading = DEVICE)]
    pub device: Vec<String>,
    /// Render only this part, in pixels of the full picture
    #[arg(long, value_name = "X,Y,W,H", help_heading = VIEW, allow_hyphen_values = true, value_parser = parse_part)]
    pub crop: Option<Rect>,
    /// Build the pipeline with all features
    ///
    /// Measures the gain of leaving out those that the scene does not need.
    #[arg(long, help_heading = MEASURING)]
    pub keep_everything: bool,
    /// Accept textures with NaN and infinite texels
    ///
    /// They are errors otherwise. The pixels that show them are NaN or infinite too, and counted.
    #[arg(long, help_heading = TEXTURES)]
    pub allow_nonfinite: bool,
    /// Where look-ups of method shader read texels
    #[arg(long, value_name = "SOURCE", help_heading = MEASURING, default_value = "auto", value_parser = super::named_parser(TexelChoice::NAMES, TexelChoice::from_name))]
    pub texels: TexelChoice,
    /// Where box mip chains are made
    ///
    /// Of textures whose lengths are powers of two.
    #[arg(long, value_name = "PLACE", help_heading = MEASURING, default_value = "auto", value_parser = super::named_parser(MipChoice::NAMES, MipChoice::from_name))]
    pub mips: MipChoice,
    /// Where errors are estimated
    ///
    /// With --target-error, --budget and adaptive sampling: where errors are estimated and samples distributed.
    #[arg(long, value_name = "PLACE", help_heading = MEASURING, default_value = "auto", value_parser = super::named_parser(EstimateChoice::NAMES, EstimateChoice::from_name))]
    pub estimates: EstimateChoice,
    /// Shape of workgroups [default: by device]
    #[arg(long, value_name = "WxH", help_heading = MEASURING, value_parser = |s: &str| Tuning::parse_group(s).map_err(|e| e.to_string()))]
    pub workgroup: Option<[u32; 2]>,
    /// Count how often limits are exceeded, as -v does
    ///
    /// On the device: coordinates that are NaN or infinite, levels, footprints, depth.
    #[arg(long, help_heading = MEASURING)]
    pub guards: bool,
    /// Render again when the scene or a file of it changes
    ///
    /// Until Ctrl-C. Devices, pipelines and textures are kept from one picture to the next.
    #[arg(long, conflicts_with_all = ["json", "from"], help_heading = OUTPUT)]
    pub watch: bool,
    /// Write no record of scene and options into pictures
    #[arg(long, help_heading = OUTPUT)]
    pub no_metadata: bool,
    /// Print one JSON object on stdout
    #[arg(long, help_heading = REPORT)]
    pub json: bool,
    /// Print nothing but errors
    #[arg(short, long, conflicts_with = "verbose", help_heading = REPORT)]
    pub quiet: bool,
    /// Print what was left out and how textures are stored
    #[arg(short, long, help_heading = REPORT)]
    pub verbose: bool,
}

pub(super) fn parse_part(text: &str) -> Result<Rect, String> {
    let numbers: Vec<u32> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, width, height] if text.split(',').count() == 4 && width > 0 && height > 0 => {
            Ok(Rect { x, y, width, height })
        }
        _ => Err("expected X,Y,W,H in whole pixels, with W and H at least 1".into()),
    }
}
