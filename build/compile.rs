//! Compiles a shader's text to SPIR-V, again only if it or a file that it includes has changed. Warnings are
//! errors.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::{AnyError, uncontracted};

/// Compiles a shader whose text includes everything else. `BASE.spv` holds the words, `BASE.comp` the text
/// and `BASE.inputs` the files from which they were made, one per line. `schema/NAME` is one of the generated
/// files, which include those of `glsl/shared`.
pub fn compile_if_changed(
    compiler: &shaderc::Compiler,
    text: &str,
    base: &Path,
    generated: &Path,
) -> Result<Vec<u32>, AnyError> {
    let [spv, own, inputs] = ["spv", "comp", "inputs"].map(|extension| base.with_extension(extension));
    let same = fs::read_to_string(&own).is_ok_and(|old| old == text);
    if let (true, Ok(made), Ok(list)) = (same, modified(&spv), fs::read_to_string(&inputs)) {
        let current = list
            .lines()
            .chain(["build/compile.rs", "build/uncontracted.rs"])
            .all(|f| modified(Path::new(f)).is_ok_and(|t| t < made));
        if current {
            return Ok(words_of(&fs::read(&spv)?));
        }
    }
    let included = RefCell::new(BTreeSet::new());
    let mut options = shaderc::CompileOptions::new()?;
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_2 as u32);
    options.set_target_spirv(shaderc::SpirvVersion::V1_5);
    // Drivers optimise once the constants are known; unoptimised code keeps the names.
    options.set_optimization_level(shaderc::OptimizationLevel::Zero);
    options.set_generate_debug_info();
    options.set_warnings_as_errors();
    options.set_include_callback(|name, _kind, from, _depth| {
        let path = match name.strip_prefix("schema/") {
            Some(name) => generated.join(name),
            None if Path::new(from).starts_with(generated) => Path::new("glsl/shared").join(name),
            None => Path::new(from).parent().unwrap_or(Path::new("")).join(name),
        };
        let content = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        included.borrow_mut().insert(path.clone());
        Ok(shaderc::ResolvedInclude { resolved_name: path.to_string_lossy().into_owned(), content })
    });
    let name = format!("glsl/{}.comp", base.file_name().unwrap_or_default().to_string_lossy());
    let binary =
        compiler.compile_into_spirv(text, shaderc::ShaderKind::Compute, &name, "main", Some(&options))?;
    let list: Vec<_> = included.borrow().iter().map(|p: &PathBuf| p.to_string_lossy().into_owned()).collect();
    fs::write(&inputs, list.join("\n"))?;
    fs::write(&own, text)?;
    // Last, and by renaming, so that an interrupted build leaves no file that looks current.
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
