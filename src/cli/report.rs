//! The result of a render: one JSON object on stdout, or lines of text on stderr.

use std::fs;

#[cfg(unix)]
use nix::sys::resource::{UsageWho, getrusage};
#[cfg(unix)]
use nix::sys::time::TimeVal;
use serde_json::{Map, Value, json};

use super::notify;
use crate::core::counted::{counted, verb};
use crate::core::film::Film;
use crate::pack::Diagnostic;
use crate::render::{Picture, Report};
use crate::scene::model::{Precision, Scene};

fn nonfinite_pixels(film: &Film) -> usize {
    film.pixels.iter().filter(|pixel| !pixel.iter().all(|v| v.is_finite())).count()
}

/// Returns seconds by the device's timestamps; tile culling and texture levels are included only if
/// the device computed them.
fn device_seconds(report: &Report) -> Value {
    let mut seconds = Map::from_iter([("render".into(), json!(report.device_render_seconds))]);
    seconds.extend(report.device_culling_seconds.map(|culling| ("survey".into(), json!(culling))));
    seconds.extend(report.device_mips_seconds.map(|mips| ("mips".into(), json!(mips))));
    seconds.into()
}

pub fn json(ran: &Picture, scene: &Scene, options: Value, outputs: &[String], nonfinite: bool) -> Value {
    let mut all = json!({
        "device": ran.device,
        "driver": ran.driver,
        "options": options,
        "precision": if ran.report.double { Precision::Double } else { Precision::Single }.name(),
        "left_out": ran.report.left_out,
        "warnings": ran.report.warnings,
        "samples": ran.film.samples,
        "reached": ran.report.outcome,
        "sampled_pixels": ran.report.sampled_pixels,
        "dropped": ran.report.dropped,
        "dropped_triangles": scene.dropped_triangles,
        "guards": ran.report.diagnostics.as_ref().map(|counts| {
            counts.iter().map(|(diagnostic, count)| (diagnostic.name().to_owned(), json!(count))).collect::<Map<_, _>>()
        }),
        "outputs": outputs,
        "seconds": ran.report.seconds,
        "device_seconds": device_seconds(&ran.report),
        "slices": ran.report.slices,
        "longest_slice_seconds": ran.report.longest_slice_seconds,
        "device_bytes": ran.report.device_bytes,
        "process": { "cpu_seconds": cpu_seconds(), "peak_host_bytes": peak_host_bytes() },
    });
    if nonfinite {
        let texels: Map<String, Value> =
            ran.nonfinite.iter().map(|(name, n)| (name.clone(), json!(n))).collect();
        all["nonfinite"] = json!({ "texels": texels, "pixels": nonfinite_pixels(&ran.film) });
    }
    all
}

/// Returns the noun of a diagnostic and the text that follows its count.
fn said(guard: Diagnostic) -> (&'static str, &'static str) {
    match guard {
        Diagnostic::Coordinates => ("look-up", "at coordinates that are no numbers, read at 0"),
        Diagnostic::Levels => ("look-up", "over more than a texel of the last level"),
        Diagnostic::Anisotropy => ("look-up", "over footprints longer than max_anisotropy widths, blurred"),
        Diagnostic::Grazing => {
            ("footprint", "of rays that graze a surface, cut off at 65536 times their width")
        }
        Diagnostic::Depth => ("path", "at max_depth, ended in black"),
        Diagnostic::Pieces => ("cone", "for which there was no room"),
        Diagnostic::Radiance => ("sample", "whose radiance is no number"),
        Diagnostic::Layers => ("path", "through more than 64 surfaces that let rays pass, ended in black"),
    }
}

pub fn say(ran: &Picture, outputs: &[String], verbose: bool) {
    let (report, seconds) = (&ran.report, &ran.report.seconds);
    for warning in &report.warnings {
        notify(format_args!("warning: {warning}"));
    }
    match nonfinite_pixels(&ran.film) {
        0 => {}
        count => notify(format_args!(
            "warning: {} {} not finite; .exr keeps them, other formats have NaN as black and \
             infinity as their largest value",
            counted(count, "pixel"),
            verb(count, "is", "are")
        )),
    }
    if verbose {
        notify("left out:");
        for line in &report.left_out {
            notify(format_args!("  {line}"));
        }
        for (diagnostic, count) in report.diagnostics.iter().flatten().filter(|(_, count)| *count > 0) {
            let (noun, rest) = said(*diagnostic);
            notify(format_args!("beyond a limit: {} {rest}", counted(*count, noun)));
        }
        notify(format_args!(
            "seconds: startup {:.3}, load {:.3}, compile {:.3}, upload {:.3}, render {:.3}, readback {:.3}, write {:.3}",
            seconds.startup,
            seconds.load,
            seconds.compile,
            seconds.upload,
            seconds.render,
            seconds.readback,
            seconds.write
        ));
        notify(format_args!(
            "device time of rendering: {:.4} s in {}",
            report.device_render_seconds,
            counted(report.slices, "slice")
        ));
        if let Some(culling) = report.device_culling_seconds {
            notify(format_args!("device time of tile culling: {culling:.4} s"));
        }
        if let Some(mips) = report.device_mips_seconds {
            notify(format_args!("device time of mip chains: {mips:.4} s"));
        }
    }
    if let Some(sampled) = report.sampled_pixels {
        let pixels = ran.film.pixels.len() as f64;
        notify(format_args!(
            "one beam a pixel; {} ({:.2} %) took samples, as beams cannot resolve them",
            counted(sampled, "pixel"),
            100.0 * sampled as f64 / pixels
        ));
    }
    if let Some(dropped) = report.dropped.filter(|d| *d > 0.0) {
        notify(format_args!(
            "cones left out {:.2e} of the picture's weight: shapes beyond the nearest of a pixel, faint reflections",
            dropped
        ));
    }
    if let Some(o) = &report.outcome {
        if o.beam_pixels > 0 {
            let share = 100.0 * o.beam_pixels as f64 / ran.film.pixels.len() as f64;
            notify(format_args!(
                "one beam a pixel resolved {} ({share:.2} %)",
                counted(o.beam_pixels, "pixel")
            ));
        }
        if o.estimated_bias > 0.0 {
            notify(format_args!(
                "the footprint's bias is about {:.2e} RMSE; --footprint none has none",
                o.estimated_bias
            ));
        }
        let interval = o.interval.map_or(String::new(), |[low, high]| {
            format!(" ({:.0} %: {low:.2e} to {high:.2e})", 100.0 * o.confidence)
        });
        notify(format_args!(
            "estimated RMSE {:.2e}{interval} after {}, {} a pixel{}",
            o.estimated_rmse,
            counted(o.passes, "pass"),
            range_of_samples(o.least_samples, o.most_samples),
            if o.reached { "" } else { "; the goal was not reached" }
        ));
    }
    notify(format_args!(
        "{}: {}×{} pixels, {} a pixel on {}, render {:.3} s, total {:.3} s",
        outputs.join(", "),
        ran.film.width,
        ran.film.height,
        counted(ran.film.samples, "sample"),
        ran.device,
        seconds.render,
        seconds.total
    ));
}

fn range_of_samples(least: u32, most: u32) -> String {
    if least == most { counted(most, "sample") } else { format!("{least} to {}", counted(most, "sample")) }
}

/// Returns user and system time of this process so far.
#[cfg(unix)]
fn cpu_seconds() -> Option<f64> {
    let usage = getrusage(UsageWho::RUSAGE_SELF).ok()?;
    let seconds = |time: TimeVal| time.tv_sec() as f64 + time.tv_usec() as f64 * 1e-6;
    Some(seconds(usage.user_time()) + seconds(usage.system_time()))
}

/// Unknown without `getrusage`.
#[cfg(not(unix))]
fn cpu_seconds() -> Option<f64> {
    None
}

/// Returns the peak memory of this process, from `/proc`; `getrusage` also counts the memory of the process that
/// started this one.
fn peak_host_bytes() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? * 1024)
}
