//! Compiles every `glsl/*.comp` to SPIR-V and writes `$OUT_DIR/shaders.rs`: for each shader where its
//! words lie and what reflection finds in them (descriptor bindings, the two specialization constants of
//! the workgroup's size, all named specialization constants). A shader is compiled again only when
//! it or a file it includes has changed. Warnings are errors.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{env, fs};

#[path = "build/uncontracted.rs"]
mod uncontracted;

type AnyError = Box<dyn std::error::Error>;

fn main() -> Result<(), AnyError> {
    println!("cargo:rerun-if-changed=glsl");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=build");
    let out = PathBuf::from(env::var("OUT_DIR")?);
    let mut sources: Vec<PathBuf> =
        fs::read_dir("glsl")?.map(|e| e.map(|e| e.path())).collect::<Result<_, _>>()?;
    sources.retain(|p| p.extension().is_some_and(|e| e == "comp"));
    sources.sort();

    let mut rust = String::new();
    let compiler = shaderc::Compiler::new()?;
    for source in &sources {
        let stem = source.file_stem().and_then(|s| s.to_str()).ok_or("shader name is not UTF-8")?;
        let words = compile_if_changed(&compiler, source, &out.join(stem))?;
        write_shader(&mut rust, stem, &words)?;
    }
    fs::write(out.join("shaders.rs"), rust)?;
    Ok(())
}

/// `BASE.spv` holds the words, `BASE.inputs` the files they were made from, one a line.
fn compile_if_changed(
    compiler: &shaderc::Compiler,
    source: &Path,
    base: &Path,
) -> Result<Vec<u32>, AnyError> {
    let (spv, inputs) = (base.with_extension("spv"), base.with_extension("inputs"));
    if let (Ok(made), Ok(list)) = (modified(&spv), fs::read_to_string(&inputs)) {
        let current = list
            .lines()
            .chain(["build.rs", "build/uncontracted.rs"])
            .all(|f| modified(Path::new(f)).is_ok_and(|t| t < made));
        if current {
            return Ok(words_of(&fs::read(&spv)?));
        }
    }
    let included = RefCell::new(BTreeSet::from([source.to_path_buf()]));
    let mut options = shaderc::CompileOptions::new()?;
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_2 as u32);
    options.set_target_spirv(shaderc::SpirvVersion::V1_5);
    // Drivers optimise after the constants are known; unoptimised code keeps the names.
    options.set_optimization_level(shaderc::OptimizationLevel::Zero);
    options.set_generate_debug_info();
    options.set_warnings_as_errors();
    options.set_include_callback(|name, _kind, from, _depth| {
        let path = Path::new(from).parent().unwrap_or(Path::new("")).join(name);
        let content = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        included.borrow_mut().insert(path.clone());
        Ok(shaderc::ResolvedInclude { resolved_name: path.to_string_lossy().into_owned(), content })
    });
    let text = fs::read_to_string(source)?;
    let name = source.to_string_lossy();
    let binary =
        compiler.compile_into_spirv(&text, shaderc::ShaderKind::Compute, &name, "main", Some(&options))?;
    let list: Vec<_> = included.borrow().iter().map(|p| p.to_string_lossy().into_owned()).collect();
    fs::write(&inputs, list.join("\n"))?;
    // Last and by renaming: a build that is interrupted here leaves no words that look current.
    let part = base.with_extension("part");
    let words = uncontracted::uncontracted(binary.as_binary());
    fs::write(&part, words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>())?;
    fs::rename(&part, &spv)?;
    Ok(words)
}

fn modified(path: &Path) -> std::io::Result<SystemTime> {
    fs::metadata(path)?.modified()
}

fn words_of(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// What the reflection reads off: SPIR-V 1.5, section 3 (binary form). Only decorations, names,
/// the types behind descriptors, and the defaults of scalar specialization constants matter.
#[derive(Default)]
struct Reflection {
    names: BTreeMap<u32, String>,
    spec_ids: BTreeMap<u32, u32>,
    bindings: BTreeMap<u32, u32>,
    types: BTreeMap<u32, (u32, Vec<u32>)>,
    variables: Vec<(u32, u32, u32)>,
    spec_defaults: BTreeMap<u32, u32>,
}

impl Reflection {
    fn new(words: &[u32]) -> Reflection {
        let mut r = Reflection::default();
        let mut at = 5;
        while at < words.len() {
            let (op, len) = (words[at] & 0xFFFF, (words[at] >> 16) as usize);
            let w = &words[at + 1..at + len];
            match op {
                5 => drop(r.names.insert(w[0], literal_string(&w[1..]))),
                71 if w[1] == 1 => drop(r.spec_ids.insert(w[0], w[2])),
                71 if w[1] == 33 => drop(r.bindings.insert(w[0], w[2])),
                19..=32 => drop(r.types.insert(w[0], (op, w[1..].to_vec()))),
                48 => drop(r.spec_defaults.insert(w[1], 1)),
                49 => drop(r.spec_defaults.insert(w[1], 0)),
                50 => drop(r.spec_defaults.insert(w[1], w[2])),
                59 => r.variables.push((w[1], w[0], w[2])),
                _ => {}
            }
            at += len;
        }
        r
    }

    /// (binding, kind) of every descriptor, in order of binding.
    fn descriptors(&self) -> Result<Vec<(u32, &'static str)>, AnyError> {
        const UNIFORM_CONSTANT: u32 = 0;
        const UNIFORM: u32 = 2;
        const STORAGE_BUFFER: u32 = 12;
        let mut found = Vec::new();
        for &(variable, pointer, storage) in &self.variables {
            let Some(&binding) = self.bindings.get(&variable) else { continue };
            let kind = match storage {
                UNIFORM => "UniformBuffer",
                STORAGE_BUFFER => "StorageBuffer",
                UNIFORM_CONSTANT => self.opaque_kind(self.types[&pointer].1[1])?,
                other => return Err(format!("binding {binding}: storage class {other} is not known").into()),
            };
            found.push((binding, kind));
        }
        found.sort();
        Ok(found)
    }

    fn opaque_kind(&self, id: u32) -> Result<&'static str, AnyError> {
        const DIM_BUFFER: u32 = 5;
        match &self.types[&id] {
            (28, operands) => self.opaque_kind(operands[0]), // OpTypeArray of sampled images
            (27, operands) => {
                // OpTypeSampledImage of an OpTypeImage: sampled type, dimension, …
                let buffer = self.types[&operands[0]].1[1] == DIM_BUFFER;
                Ok(if buffer { "TexelBuffer" } else { "SampledImage" })
            }
            (op, _) => Err(format!("descriptor of type instruction {op} is not known").into()),
        }
    }

    /// (name, id, default) of every named specialization constant. The workgroup's size has ids 0
    /// and 1 and no names of its own.
    fn constants(&self) -> Vec<(String, u32, u32)> {
        let mut found: Vec<_> = self
            .spec_ids
            .iter()
            .filter_map(|(id, &spec)| {
                let name = match spec {
                    0 => "GROUP_X".into(),
                    1 => "GROUP_Y".into(),
                    _ => self.names.get(id)?.clone(),
                };
                Some((name, spec, *self.spec_defaults.get(id)?))
            })
            .collect();
        found.sort_by_key(|c| c.1);
        found
    }
}

fn literal_string(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).take_while(|&b| b != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

fn write_shader(rust: &mut String, stem: &str, words: &[u32]) -> Result<(), AnyError> {
    let reflection = Reflection::new(words);
    let name = stem.to_uppercase();
    writeln!(rust, "/// `glsl/{stem}.comp`")?;
    writeln!(rust, "pub static {name}: Shader = Shader {{ name: {stem:?}, bindings: &[")?;
    for (binding, kind) in reflection.descriptors()? {
        writeln!(rust, "    ReflectedBinding {{ binding: {binding}, kind: BindingKind::{kind} }},")?;
    }
    writeln!(rust, "], constants: &[")?;
    for (name, id, default) in reflection.constants() {
        writeln!(rust, "    SpecConstant {{ name: {name:?}, id: {id}, default: {default} }},")?;
    }
    // As literals they would take seconds and a gigabyte to compile.
    writeln!(rust, "], spirv: &Words(*include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{stem}.spv\"))) }};")?;
    Ok(())
}
