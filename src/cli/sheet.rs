//! `moire sheet SCENE --vary NAME=VALUES`: settings side by side in one labelled picture, or one page. All invalid input is
//! refused before the device starts; a combination that the scene does not allow is told in its cell.

mod words;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::display::DisplayArgs;
use super::inputs::Inputs;
use super::outputs::{check_distinct, check_reference, name_of};
use super::overrides::Overrides;
use super::progress::Bar;
use super::render_args::parse_part;
use super::vary::{self, Combination, Vary};
use super::vary_conflicts;
use super::vary_mistakes::of_scene;
use super::{DEVICE, MEASURING, OUTPUT, REPORT};
use crate::core::counted::counted;
use crate::core::error::{Error, Result};
use crate::core::range::Rect;
use crate::gpu::{DeviceSelect, Gpu};
use crate::lab::metrics::read_picture;
use crate::lab::sheet::plan::{Cell, Job, Plan, ReferenceChoice, View};
use crate::lab::sheet::record::Record;
use crate::lab::sheet::{self, Content};
use crate::output::{self, DisplayTransform, Format, Named, WriteOptions};
use crate::scene::model::Scene;
use crate::scene::prune::prune;
use crate::scene::{MAX_SPP, advice, is_standard_input};
use crate::texture::sampler_spec::SamplerSpec;

/// The most samples of each half of a reference, unless their number is given.
const MAX_HALF: u32 = 1 << 14;

/// Headings of the options of sheets.
const VARY: &str = "Choose what differs";
const ARRANGE: &str = "Arrange the pictures";

/// Compare settings in one labelled picture or page
///
/// Renders the scene with each combination of the values of up to three settings: the first makes columns, the second
/// rows, the third blocks. Each picture has its error against a reference and the time that it took. The ending of the
/// output chooses a picture or a self-contained HTML page.
#[derive(clap::Args, Debug)]
pub struct SheetArgs {
    /// Scene file or model
    scene: PathBuf,
    /// A setting that varies, such as filter=nearest,ewa; up to three times
    ///
    /// An option of `moire render` by its name, or a key of the scene, with its values. The first makes columns, the
    /// second rows, the third blocks.
    #[arg(long, required = true, value_name = "NAME=A,B,…", value_parser = vary::parse, help_heading = VARY)]
    vary: Vec<Vary>,
    /// Picture or page: .png .jpg .tif .html [default: the scene's name with -sheet.png]
    ///
    /// The ending selects the format. May be given several times. Without it the picture goes into the current folder.
    #[arg(short, long = "output", value_name = "OUT", help_heading = OUTPUT)]
    output: Vec<PathBuf>,
    /// Show only this part of each picture, enlarged
    ///
    /// And where it lies in the whole.
    #[arg(long, value_name = "X,Y,W,H", help_heading = ARRANGE, allow_hyphen_values = true, value_parser = parse_part)]
    zoom: Option<Rect>,
    /// Pixels as squares of this many [default: as many as fit into 288, with --zoom]
    #[arg(long, value_name = "N", help_heading = ARRANGE, conflicts_with = "cell", value_parser = clap::value_parser!(u32).range(1..=64))]
    zoom_factor: Option<u32>,
    /// Show pictures at most this wide
    ///
    /// Wider ones are averaged over squares of pixels, and say so.
    #[arg(long, value_name = "PIXELS", help_heading = ARRANGE, value_parser = clap::value_parser!(u32).range(16..=16384))]
    cell: Option<u32>,
    /// Most pictures in a row, where one setting varies [default: 4]
    #[arg(long, value_name = "N", help_heading = ARRANGE, value_parser = clap::value_parser!(u32).range(1..=64))]
    columns: Option<u32>,
    /// Show differences from the reference, too
    ///
    /// Under each picture, all on one scale.
    #[arg(long, help_heading = ARRANGE)]
    diff: bool,
    /// Reference: a picture file, or none [default: many samples without a prefilter, on the device]
    #[arg(long, value_name = "FILE|none", help_heading = MEASURING)]
    reference: Option<String>,
    /// Samples per pixel of the reference [default: as many as it takes to judge the cells]
    ///
    /// Within about as much time as the cells take.
    #[arg(long, value_name = "N", help_heading = MEASURING, conflicts_with = "reference", value_parser = clap::value_parser!(u32).range(2..=i64::from(MAX_SPP)))]
    reference_spp: Option<u32>,
    /// Renders of each cell; their median time counts
    #[arg(long, value_name = "N", help_heading = MEASURING, default_value = "3", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,
    #[command(flatten)]
    overrides: Overrides,
    #[command(flatten)]
    display: DisplayArgs,
    /// Device: index, part of its name, cpu or gpu [default: discrete GPU, else integrated, else CPU]
    ///
    /// `moire devices` lists them.
    #[arg(long, value_name = "SEL", help_heading = DEVICE)]
    device: Option<String>,
    /// Print what was measured as one JSON object on stdout
    #[arg(long, help_heading = REPORT)]
    json: bool,
    /// Print nothing but errors
    #[arg(short, long, help_heading = REPORT)]
    quiet: bool,
}

pub fn run(args: &SheetArgs) -> Result<ExitCode> {
    let bar = Bar::new(args.quiet)?;
    if is_standard_input(&args.scene) {
        return Err(Error::with_help(
            "a sheet reads its scene several times, and names it in commands",
            "write the scene to a file first",
        ));
    }
    let select = match args.device.as_deref() {
        Some("oracle") => {
            return Err(Error::with_help(
                "a sheet measures a device, and the oracle is none",
                "name one that `moire devices` lists, or leave --device out",
            ));
        }
        Some(text) => DeviceSelect::parse(text)?,
        None => DeviceSelect::Default,
    };
    check_reference(args.reference.as_deref(), "none")?;
    let outputs = outputs(args)?;
    let Planned { plan, warnings, inputs } = plan(args)?;
    sheet::check(&plan)?;
    outputs.iter().try_for_each(|output| inputs.check_file(&output.path))?;

    let gpu = Gpu::open(&select)?;
    let sheet = sheet::render(&gpu, &plan, &bar);
    bar.finish();
    for message in gpu.messages() {
        super::notify(format_args!("validation: {message}"));
    }
    let sheet = sheet?;
    let mut record = sheet.record.clone();
    record.warnings.splice(..0, warnings);
    record.outputs = outputs.iter().map(|output| output.path.display().to_string()).collect();
    write(&outputs, &Content::new(&plan, sheet))?;
    report(args, &record)?;
    Ok(ExitCode::SUCCESS)
}

struct Output {
    path: PathBuf,
    is_page: bool,
}

fn outputs(args: &SheetArgs) -> Result<Vec<Output>> {
    let mut paths = args.output.clone();
    if paths.is_empty() {
        let mut name = name_of(&args.scene);
        name.push("-sheet.png");
        paths.push(name.into());
    }
    let output = |path: PathBuf| {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_page = matches!(ending.as_deref(), Some("html" | "htm"));
        if is_page {
            return Ok(Output { path, is_page });
        }
        let format = output::format_of(&path).ok();
        if !matches!(format, Some(Format::Png | Format::Jpeg | Format::Tiff)) {
            return Err(Error::with_help(
                format!("{}: a sheet is a picture with text, or a page", path.display()),
                "end its name with one of .png, .jpg, .tif, .html",
            ));
        }
        Ok(Output { path, is_page })
    };
    check_distinct(paths.iter().map(PathBuf::as_path))?;
    paths.into_iter().map(output).collect()
}

/// What is to be rendered, warnings about it, and the files that it reads.
struct Planned {
    plan: Plan,
    warnings: Vec<String>,
    inputs: Inputs,
}

/// Returns what is to be rendered.
fn plan(args: &SheetArgs) -> Result<Planned> {
    let base = (&args.overrides, &args.display);
    vary_conflicts::check(&args.vary, base)?;
    let (axes, combinations) = vary::combine(&args.vary, base)?;
    if args.columns.is_some() && axes.len() > 1 {
        return Err(Error::with_help(
            "--columns arranges the values of one setting, and the first of several has its own columns",
            "leave --columns away, or vary one setting",
        ));
    }
    let base = args.overrides.load(&args.scene, false)?;
    let mut inputs = Inputs::of_scene(&base);
    let samples = args.reference_spp.map(|all| all.div_ceil(2));
    let mut scenes = Vec::with_capacity(combinations.len());
    for combination in &combinations {
        let read = combination.overrides.load(&args.scene, false);
        let mut scene = read.map_err(|error| of_scene(&combination.settings, error))?;
        inputs.add_scene(&scene);
        let file = scene.clone();
        let applied = combination.overrides.apply(&mut scene).map(|_| scene);
        scenes.push((file, applied));
    }
    let overrides = combinations.first().map_or(&args.overrides, |first| &first.overrides);
    let idle = overrides.idle_spp();
    let mut warnings: Vec<String> = idle.into_iter().map(String::from).collect();
    let title = words::title(args, idle.is_some());
    let mut cells = Vec::with_capacity(combinations.len());
    for (combination, (file, applied)) in combinations.into_iter().zip(scenes) {
        let job = match applied {
            Ok(scene) => Ok(job(args, &combination, [&base, &file], scene, samples)?),
            Err(why) => Err(why.to_string()),
        };
        let told = job.iter().flat_map(|job| advice::of_scene(&job.scene)).collect::<Vec<_>>();
        warnings.extend(told.into_iter().filter(|told| !warnings.contains(told)).collect::<Vec<_>>());
        let command = words::command(args, &combination);
        let Combination { at, settings, film_of, display, .. } = combination;
        cells.push(Cell { at, settings, command, film_of, display: display.transform(), job });
    }
    let reference = match args.reference.as_deref() {
        None => ReferenceChoice::Rendered { samples },
        Some("none") => ReferenceChoice::None,
        Some(name) => {
            inputs = inputs.and(Path::new(name), "the reference");
            ReferenceChoice::File { name: name.to_owned(), film: read_picture(Path::new(name))? }
        }
    };
    if args.diff && matches!(reference, ReferenceChoice::None) {
        return Err(Error::with_help(
            "--diff shows differences from a reference, and --reference none has none",
            "leave one of them away",
        ));
    }
    let view = View {
        zoom: args.zoom,
        factor: args.zoom_factor,
        width: args.cell,
        difference: args.diff,
        columns: args.columns,
    };
    let scene = args.scene.display().to_string();
    let display = args.display.transform();
    let plan = Plan { title, scene, axes, cells, reference, repeats: args.repeats, view, display };
    Ok(Planned { plan, warnings, inputs })
}

/// Returns the work of a cell. `base` is the scene as it is read without what varies, `file` with it.
fn job(
    args: &SheetArgs,
    combination: &Combination,
    [base, file]: [&Scene; 2],
    mut scene: Scene,
    samples: Option<u32>,
) -> Result<Job> {
    let goal = combination.overrides.goal();
    let mut reference = file.clone();
    if base.samplers.len() == file.samplers.len() {
        // Filters that vary are judged by one reference, which has those of the scene.
        for (own, base) in reference.samplers.iter_mut().zip(&base.samplers) {
            let SamplerSpec { address, address_w, border_color, texel_center, .. } = *own;
            *own = SamplerSpec { address, address_w, border_color, texel_center, ..*base };
        }
    }
    let most = samples.unwrap_or(MAX_HALF);
    // Without it, too, this is what tells one view from another.
    let applied = combination.overrides.as_reference(&args.overrides, most).apply(&mut reference);
    if let (Err(why), None) = (applied, &args.reference) {
        return Err(Error::with_help(
            format!("no reference without a prefilter can be rendered: {why}"),
            "name a picture with --reference, or --reference none",
        ));
    }
    prune(&mut scene);
    prune(&mut reference);
    Ok(Job { scene, reference, goal })
}

fn write(outputs: &[Output], content: &Content) -> Result<()> {
    let page = outputs.iter().any(|output| output.is_page).then(|| sheet::html(content)).transpose()?;
    let film = outputs.iter().any(|output| !output.is_page).then(|| sheet::compose(content));
    let display = DisplayTransform { gamut: content.gamut, ..DisplayTransform::default() };
    let options = &WriteOptions { display, ..WriteOptions::default() };
    let pictures: Vec<Named<'_>> = outputs
        .iter()
        .filter(|output| !output.is_page)
        .filter_map(|output| Some(Named { film: film.as_ref()?, path: &output.path, options }))
        .collect();
    output::write_pictures(&pictures, || {
        let pages = outputs.iter().filter(|output| output.is_page);
        pages
            .zip(page.iter().cycle())
            .try_for_each(|(output, page)| output::write_file(&output.path, page.as_bytes()))
    })
}

fn report(args: &SheetArgs, record: &Record) -> Result<()> {
    if args.json {
        let json = serde_json::to_string_pretty(record);
        super::print(&json.map_err(|e| Error::new(format!("the sheet as JSON: {e}")))?)?;
    }
    if args.quiet {
        return Ok(());
    }
    record.warnings.iter().for_each(|warning| super::notify(format_args!("warning: {warning}")));
    for cell in &record.cells {
        if let Some(why) = &cell.error {
            super::notify(format_args!("{}: no picture: {why}", cell.label));
        }
    }
    super::notify(format_args!("{}: {}", record.outputs.join(", "), counted(record.cells.len(), "cell")));
    Ok(())
}
