//! `moire study SCENE`: measures error against time. All invalid input is refused before
//! the device starts. Ctrl-C leaves a folder from which the same command resumes.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use super::inputs::Inputs;
use super::outputs::{check_reference, folder_or_default};
use super::overrides::parse_size;
use super::progress::Bar;
use super::quantity::{positive, seconds};
use super::{DEVICE, MEASURING, OUTPUT, REPORT, VIEW};
use crate::core::counted::{counted, verb};
use crate::core::error::{Error, Result};
use crate::gpu::{DeviceSelect, Gpu};
use crate::lab::study::format::{names, own_error};
use crate::lab::study::method::Method;
use crate::lab::study::record::{self, Question, Record};
use crate::lab::study::{self, Options, ReferenceChoice, files, reference, steadiness};
use crate::scene::model::Scene;
use crate::scene::prune::prune;
use crate::scene::{MAX_SPP, Reading, Setting, is_standard_input, load_as};

/// What the default name of the folder has behind the scene's.
const FOLDER: &str = "study";
/// Heading of the options that ask for a recommendation.
const ASK: &str = "Ask for a recommendation";

/// Measure which method has the smallest error in a given time
///
/// Renders the scene with each method and sample count, compares every picture with a reference, and writes study.csv,
/// study.json, three plots as SVG and index.html, a self-contained page. An interrupted study is resumed by the same
/// command.
#[derive(clap::Args, Debug)]
pub struct StudyArgs {
    /// Scene file or model
    scene: PathBuf,
    /// Camera of a glTF file: number from 0, or name [default: the first]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = VIEW)]
    camera: Option<String>,
    /// Replace a value of the scene, such as camera.eye=[0,1,4]
    ///
    /// Any key of the scene format, as SECTION.KEY=VALUE or SECTION.ITEM.KEY=VALUE, such as
    /// sampler.ground.address=repeat; ITEM is a name, a number from 0, or * for all. May be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = str::parse::<Setting>, help_heading = VIEW)]
    set: Vec<Setting>,
    /// Folder for the results [default: the scene's name with -study, in the current folder]
    ///
    /// Its last component is created if it is missing.
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    out: Option<PathBuf>,
    /// best, halton+cone+ewa, … [default: all that suit the scene]
    ///
    /// Separated by commas: PATTERN, PATTERN+FOOTPRINT or PATTERN+FOOTPRINT+FILTER, with the names that `moire render`
    /// has for them, as in random,stratified,stratified+cone+ewa; adaptive, beam and cone. best among them, or alone:
    /// those that a coarse pass finds promising.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = Listed::parse, help_heading = MEASURING)]
    methods: Vec<Listed>,
    /// Recommend what errs least in this time, such as 50ms
    ///
    /// Of rendering; a number alone is seconds.
    #[arg(long, value_name = "TIME", value_parser = seconds, allow_negative_numbers = true, conflicts_with = "error", help_heading = ASK)]
    budget: Option<f64>,
    /// Recommend what comes to this RMSE fastest
    #[arg(long, value_name = "RMSE", value_parser = positive, allow_negative_numbers = true, help_heading = ASK)]
    error: Option<f64>,
    /// Samples per pixel
    ///
    /// Separated by commas, each rounded up to a number that the pattern supports.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1,4,16,64,256", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SPP)), help_heading = MEASURING)]
    spp: Vec<u32>,
    /// Renders of each point; their median counts
    #[arg(long, value_name = "N", default_value = "3", value_parser = clap::value_parser!(u32).range(1..=1000), help_heading = MEASURING)]
    repeats: u32,
    /// Picture size in pixels, such as 640x480
    #[arg(long, value_name = "WxH", value_parser = parse_size, help_heading = VIEW)]
    size: Option<[u32; 2]>,
    /// Device: index, part of its name, cpu or gpu [default: discrete GPU, else integrated, else CPU]
    ///
    /// `moire devices` lists them.
    #[arg(long, value_name = "SEL", help_heading = DEVICE)]
    device: Option<String>,
    /// A picture file, or oracle [default: many samples on the device]
    #[arg(long, value_name = "FILE|oracle", help_heading = MEASURING)]
    reference: Option<String>,
    /// Time limit of the study, such as 90s or 10min
    ///
    /// A number alone is seconds. The longest points are left out if it does not suffice.
    #[arg(long, value_name = "LIMIT", default_value = "600", value_parser = seconds, allow_negative_numbers = true, help_heading = MEASURING)]
    seconds: f64,
    /// Print the content of study.json on stdout
    #[arg(long, help_heading = REPORT)]
    json: bool,
    /// Print nothing but errors
    #[arg(short, long, conflicts_with = "verbose", help_heading = REPORT)]
    quiet: bool,
    /// Print the winner of each time and what was left out
    #[arg(short, long, help_heading = REPORT)]
    verbose: bool,
}

/// An element of the list of methods.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Listed {
    Method(Method),
    /// Those that a coarse pass finds promising.
    Best,
}

impl Listed {
    fn parse(text: &str) -> Result<Listed, String> {
        if text == "best" { Ok(Listed::Best) } else { Method::parse(text).map(Listed::Method) }
    }
}

pub fn run(args: &StudyArgs) -> Result<ExitCode> {
    let started = Instant::now();
    if is_standard_input(&args.scene) {
        return Err(Error::with_help(
            "a study needs a scene file: its page has commands that render the scene again",
            "write the scene to a file first",
        ));
    }
    check_reference(args.reference.as_deref(), "oracle")?;
    let bar = Bar::new(args.quiet)?;
    let select = match args.device.as_deref() {
        Some("oracle") => {
            return Err(Error::with_help(
                "a study measures a device; the oracle is no device, but it can make the reference",
                "name one that `moire devices` lists, or leave --device out; see --reference oracle",
            ));
        }
        Some(text) => DeviceSelect::parse(text)?,
        None => DeviceSelect::Default,
    };
    let camera = args.camera.as_deref();
    let mut scene = load_as(&args.scene, &Reading { camera, settings: &args.set, ..Reading::default() })?;
    if let Some([width, height]) = args.size {
        (scene.width, scene.height) = (width, height);
    }
    let out = folder_or_default(args.out.as_deref(), &args.scene, FOLDER, &[record::FILE, reference::FILE])?;
    let _folder = inputs(args, &scene).prepare_folder(&out, record::FILE, written(args))?;
    prune(&mut scene);
    let options = options(args, &out, started);
    let gpu = Gpu::open(&select)?;
    let outcome = study::run(&gpu, &scene, &options, &bar);
    bar.finish();
    for message in gpu.messages() {
        super::notify(format_args!("validation: {message}"));
    }
    match outcome {
        Err(Error::Interrupted) => {
            let points = record::read(&out).points.len();
            if points == 0 && !out.join(reference::FILE).is_file() {
                return Err(Error::Interrupted);
            }
            super::notify(format_args!(
                "interrupted: {} {} in {}; the same command goes on from there",
                counted(points, "point"),
                verb(points, "is", "are"),
                out.display()
            ));
            Ok(ExitCode::from(130))
        }
        outcome => {
            report(args, &out, &outcome?)?;
            Ok(ExitCode::SUCCESS)
        }
    }
}

/// Returns the picture that is the reference, if one is named.
fn named_reference(args: &StudyArgs) -> Option<&Path> {
    args.reference.as_deref().filter(|name| *name != "oracle").map(Path::new)
}

/// Returns the files that are read.
fn inputs(args: &StudyArgs, scene: &Scene) -> Inputs {
    named_reference(args)
        .into_iter()
        .fold(Inputs::of_scene(scene), |inputs, path| inputs.and(path, "the reference"))
}

/// Returns the names of the files that are written beside the record. A reference that is named is not.
fn written(args: &StudyArgs) -> impl Iterator<Item = &'static str> {
    let own = named_reference(args).is_none().then_some(reference::FILE);
    files::NAMES.into_iter().chain(own)
}

fn options(args: &StudyArgs, out: &Path, started: Instant) -> Options {
    let mut methods: Vec<Method> = Vec::new();
    for listed in &args.methods {
        if let Listed::Method(method) = listed
            && !methods.contains(method)
        {
            methods.push(method.clone());
        }
    }
    let mut arguments = Vec::new();
    if let Some(camera) = &args.camera {
        arguments.extend(["--camera".to_owned(), camera.clone()]);
    }
    arguments.extend(args.set.iter().flat_map(|setting| ["--set".to_owned(), setting.text().to_owned()]));
    if let Some([width, height]) = args.size {
        arguments.extend(["--size".to_owned(), format!("{width}x{height}")]);
    }
    if let Some(device) = &args.device {
        arguments.extend(["--device".to_owned(), device.clone()]);
    }
    Options {
        methods: (!methods.is_empty()).then_some(methods),
        best: args.methods.contains(&Listed::Best),
        question: args.budget.map(Question::Budget).or(args.error.map(Question::Error)),
        counts: args.spp.clone(),
        repeats: args.repeats,
        reference: match args.reference.as_deref() {
            None => ReferenceChoice::Device,
            Some("oracle") => ReferenceChoice::Oracle,
            Some(file) => ReferenceChoice::File(file.into()),
        },
        limit: args.seconds,
        started,
        out: out.to_owned(),
        arguments,
    }
}

fn report(args: &StudyArgs, out: &Path, record: &Record) -> Result<()> {
    if args.json {
        let json = serde_json::to_string_pretty(record);
        super::print(&json.map_err(|e| Error::new(format!("the study as JSON: {e}")))?)?;
    }
    if args.quiet {
        return Ok(());
    }
    let analysis = record.analysis.as_ref();
    if args.verbose {
        for w in analysis.iter().flat_map(|a| &a.winners) {
            super::notify(format_args!(
                "within {:.3e} s: {} with {}, RMSE {}",
                w.budget,
                names(record, w),
                w.taken,
                own_error(w.rmse, w.interval)
            ));
        }
        record.notes.iter().for_each(|note| super::notify(format_args!("note: {note}")));
    }
    if let Some(analysis) = analysis {
        super::notify(&analysis.recommendation);
    }
    if !args.verbose
        && let Some(note) = steadiness::note(record)
    {
        super::notify(format_args!("note: {note}"));
    }
    super::notify(format_args!(
        "{}: {}",
        out.join("index.html").display(),
        counted(record.points.len(), "point")
    ));
    Ok(())
}
