//! The study as one self-contained HTML page with style, script, plots and pictures embedded.

use crate::core::error::Result;
use crate::lab::plot::html::{Header, Html, SCRIPT, code, document, html, scroll, section};
use crate::output::Format;

use super::choice::chosen;
use super::format::error;
use super::pictures::{crop, data_uri, differences, downscaled, false_color, ramp_css, scale};
use super::record::Record;
use super::showcase::Showcase;
use super::{steadiness, tables};

/// The charts of the page, each as SVG, wide and as narrow as a phone.
pub struct Plots {
    pub time: [String; 2],
    pub rays: [String; 2],
    pub stages: [String; 2],
}

/// The largest width of a picture in the page.
const MAX_WIDTH: u32 = 420;

pub fn html(record: &Record, showcase: &Showcase, plots: &Plots) -> Result<String> {
    let Some(analysis) = &record.analysis else { return Ok(String::new()) };
    let c = &record.conditions;
    let name = std::path::Path::new(&c.scene).file_stem().unwrap_or_default().to_string_lossy();
    let title = format!("Error against time: {name}");
    let facts = format!(
        "{}×{} pixels on {} ({}), {}",
        c.size[0], c.size[1], c.device.name, c.device.driver, c.program
    );
    let best = chosen(record, &analysis.winners).map(|point| point.command.as_str());
    let command = best.map(|c| scroll("The recommended setting as a command", code(c)));
    let busy = steadiness::note(record);
    let busy = busy.map_or(Html::default(), |note| html!("<p class=\"note\">{}</p>\n", note));
    let sections = [
        tables::answer(record),
        section("faults", "Three faults and what helps", faults(showcase)?),
        section(
            "time",
            "Error against time",
            plot("Error over time", &plots.time) + tables::winners(record, analysis),
        ),
        section(
            "rays",
            "Error against rays",
            plot("Error over rays", &plots.rays) + tables::slopes(record, analysis),
        ),
        section("reach", "Time to reach an error", tables::reach(record, analysis)),
        section("stages", "Where the time goes", plot("Time by stage", &plots.stages)),
        section("differences", "Where the error is", difference_pictures(showcase)?),
        section("points", "Every point", tables::points(record)),
        section("conditions", "Conditions", tables::conditions(record)),
    ];
    let header = Header {
        title: &title,
        facts: &facts,
        lead: &analysis.recommendation,
        more: busy + command.unwrap_or_default(),
    };
    Ok(document(&header, &sections.into_iter().collect(), SCRIPT))
}

/// Returns a chart in both widths, of which the style shows one.
fn plot(label: &str, [wide, narrow]: &[String; 2]) -> Html {
    html!(
        "<div class=\"wide-plot\">\n{}</div>\n<div class=\"narrow-plot\">\n{}</div>\n",
        scroll(label, Html::trusted(wide)),
        Html::trusted(narrow)
    )
}

fn image(uri: &str, size: [u32; 2], alt: &str, class: &str) -> Html {
    html!(
        "<img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" class=\"{}\"/>",
        uri,
        size[0],
        size[1],
        alt,
        class
    )
}

fn figure(picture: Html, heading: Html, text: Html) -> Html {
    marked_figure(false, picture, heading, text)
}

/// Returns a figure, with a frame if it shows what is recommended.
fn marked_figure(is_recommended: bool, picture: Html, heading: Html, text: Html) -> Html {
    let (class, mark) = if is_recommended {
        ("recommended", html!("<span class=\"badge\">recommended</span> "))
    } else {
        ("", Html::default())
    };
    html!(
        "<figure class=\"{}\">{}<figcaption>{}<b>{}</b> {}</figcaption></figure>\n",
        class,
        picture,
        mark,
        heading,
        text
    )
}

fn faults(showcase: &Showcase) -> Result<Html> {
    let w = showcase.window;
    let whole = downscaled(&showcase.reference, MAX_WIDTH);
    let percent = |part: u32, all: u32| format!("{:.2}", 100.0 * f64::from(part) / f64::from(all.max(1)));
    let frame = html!(
        "<span class=\"whole\">{}<span class=\"frame\" style=\"left:{}%;top:{}%;width:{}%;height:{}%\"></span></span>",
        image(
            &data_uri(&whole, Format::Jpeg)?,
            [whole.width, whole.height],
            "The whole reference picture; a frame marks the part shown magnified",
            ""
        ),
        percent(w.x, showcase.reference.width),
        percent(w.y, showcase.reference.height),
        percent(w.width, showcase.reference.width),
        percent(w.height, showcase.reference.height)
    );
    let scene = "The frame is where the pictures beside it differ most.";
    let mut figures = vec![figure(frame, html!("The scene."), html!("{}", scene))];
    for panel in &showcase.panels {
        let alt = format!(
            "{}: {} with {}, magnified part of the picture",
            panel.heading, panel.method, panel.taken
        );
        let part = data_uri(&crop(&panel.film, w), Format::Png)?;
        let text = html!("{}, {}, RMSE {}. {}", panel.method, panel.taken, error(panel.rmse), panel.text);
        let picture = image(&part, [w.width, w.height], &alt, "pixels");
        figures.push(marked_figure(panel.is_recommended, picture, html!("{}.", panel.heading), text));
    }
    let part = data_uri(&crop(&showcase.reference, w), Format::Png)?;
    let alt = "The same part of the reference picture, magnified";
    let picture = image(&part, [w.width, w.height], alt, "pixels");
    figures.push(figure(picture, html!("Reference."), html!("What all of them aim at.")));
    Ok(html!(
        "<p>{}×{} pixels from column {}, row {}, where the errors add up to most.</p>\n\
         <div class=\"grid\">\n{}</div>\n",
        w.width,
        w.height,
        w.x,
        w.y,
        figures.into_iter().collect::<Html>()
    ))
}

fn difference_pictures(showcase: &Showcase) -> Result<Html> {
    let values: Vec<Vec<f32>> =
        showcase.panels.iter().map(|p| differences(&p.film, &showcase.reference)).collect();
    let scale = scale(&values);
    let mut figures = Vec::new();
    for (panel, values) in showcase.panels.iter().zip(&values) {
        let picture = downscaled(&false_color(values, showcase.reference.width, scale), MAX_WIDTH);
        let alt = format!(
            "Error of {} with {} at each pixel, from dark (none) to light ({})",
            panel.method,
            panel.taken,
            error(f64::from(scale))
        );
        let picture = image(&data_uri(&picture, Format::Jpeg)?, [picture.width, picture.height], &alt, "");
        let text = html!("{}, RMSE {}.", panel.taken, error(panel.rmse));
        figures.push(marked_figure(panel.is_recommended, picture, html!("{}.", panel.method), text));
    }
    Ok(html!(
        "<p>Absolute difference from the reference, mean of three channels, all on one scale.</p>\n\
         <p class=\"ramp\"><span>0</span><span class=\"bar\" style=\"background:{}\"></span><span>{} or more</span></p>\n\
         <div class=\"grid\">\n{}</div>\n",
        ramp_css(),
        error(f64::from(scale)),
        figures.into_iter().collect::<Html>()
    ))
}
