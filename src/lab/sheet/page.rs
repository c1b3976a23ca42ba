//! A sheet as one self-contained HTML page. Input: its content. Output: text with all pictures in it; a glass follows the
//! pointer, or the arrow keys, over the same place of every picture.

use super::content::{Block, Body, Content, Entry};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::lab::plot::html::{Header, Html, SHEET_SCRIPT, code, document, html, scroll, section};
use crate::lab::study::format::error;
use crate::lab::study::pictures::{data_uri_with, ramp_css};
use crate::output::{DisplayTransform, Format, Gamut, WriteOptions};

pub fn html(content: &Content) -> Result<String> {
    let commands = commands(content);
    let mut tables = Html::default();
    for block in &content.blocks {
        tables = tables + table(block, content)?;
    }
    if let Some(scale) = content.difference_scale {
        tables = tables
            + html!(
                "<p class=\"ramp\"><span>0</span><span class=\"bar\" style=\"background:{}\"></span><span>{} or more</span></p>\n",
                ramp_css(),
                error(scale)
            );
    }
    let notes: Html = content.notes.iter().map(|note| html!("<li>{}</li>\n", note)).collect();
    let sections = [
        section("pictures", "Pictures", tables),
        section("notes", "How it was measured", html!("<ul>\n{}</ul>\n", notes)),
        section("commands", "Each picture alone", commands),
    ];
    let header = Header {
        title: &content.title,
        facts: "Point at a picture, or choose one with Tab and move with the arrow keys: all of them show that place enlarged.",
        lead: "",
        more: Html::default(),
    };
    Ok(document(&header, &sections.into_iter().collect(), SHEET_SCRIPT))
}

fn commands(content: &Content) -> Html {
    let entries = content.blocks.iter().flat_map(|block| &block.rows).flat_map(|row| &row.entries);
    let all: Vec<&str> = entries.filter_map(|entry| entry.command.as_deref()).collect();
    let summary = html!("<summary>{} commands</summary>\n", all.len().to_string());
    html!("<details>{}{}</details>\n", summary, scroll("Commands", code(&all.join("\n"))))
}

fn table(block: &Block, content: &Content) -> Result<Html> {
    let label = block.heading.as_deref().unwrap_or("pictures");
    let has_heads = block.rows.iter().any(|row| row.heading.is_some());
    let corner = if has_heads { html!("<td></td>") } else { Html::default() };
    let heads: Html = block.columns.iter().map(|head| html!("<th scope=\"col\">{}</th>", head)).collect();
    let head = match block.columns.is_empty() {
        true => Html::default(),
        false => html!("<thead><tr>{}{}</tr></thead>\n", corner, heads),
    };
    let mut rows = Html::default();
    for row in &block.rows {
        let heading =
            row.heading.as_ref().map_or(Html::default(), |head| html!("<th scope=\"row\">{}</th>", head));
        let mut cells = Html::default();
        for entry in &row.entries {
            cells = cells + html!("<td>{}</td>\n", figure(entry, content)?);
        }
        rows = rows + html!("<tr>{}{}</tr>\n", heading, cells);
    }
    let caption =
        block.heading.as_ref().map_or(Html::default(), |heading| html!("<caption>{}</caption>\n", heading));
    let table = html!("<table>\n{}{}<tbody>\n{}</tbody>\n</table>\n", caption, head, rows);
    Ok(html!("<div class=\"sheet\">{}</div>\n", scroll(label, table)))
}

fn figure(entry: &Entry, content: &Content) -> Result<Html> {
    let Entry { heading, body, description, caption, .. } = entry;
    let pictures = match body {
        Body::Missing(why) => html!("<p class=\"missing\">{}</p>\n", why),
        Body::Whole { film, full, part } => {
            let percent = |of: u32, all: u32| format!("{:.2}", 100.0 * f64::from(of) / f64::from(all.max(1)));
            html!(
                "<span class=\"whole\">{}<span class=\"frame\" style=\"left:{}%;top:{}%;width:{}%;height:{}%\"></span></span>\n",
                image(film, 1, content.gamut, description)?,
                percent(part.x, full[0]),
                percent(part.y, full[1]),
                percent(part.width, full[0]),
                percent(part.height, full[1])
            )
        }
        Body::Picture { film, difference } => {
            let own = seen(film, content, description)?;
            match difference {
                None => own,
                Some(difference) => {
                    own + seen(difference, content, &format!("Difference from the reference: {description}"))?
                }
            }
        }
    };
    let heading = heading.as_ref().map_or(Html::default(), |heading| html!("<b>{}</b><br/>", heading));
    let lines = Html::join(caption.iter().map(|line| html!("{}", line)), "<br/>");
    Ok(html!("<figure>{}<figcaption>{}{}</figcaption></figure>", pictures, heading, lines))
}

/// Returns a picture under the glass.
fn seen(film: &Film, content: &Content, description: &str) -> Result<Html> {
    Ok(html!(
        "<span class=\"seen\" tabindex=\"0\">{}<span class=\"glass\"></span></span>\n",
        image(film, content.factor, content.gamut, description)?
    ))
}

fn image(film: &Film, factor: u32, gamut: Gamut, description: &str) -> Result<Html> {
    let class = if factor > 1 { "pixels" } else { "" };
    let options =
        WriteOptions { display: DisplayTransform { gamut, ..Default::default() }, ..Default::default() };
    Ok(html!(
        "<img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" class=\"{}\" style=\"width:{}px\"/>",
        data_uri_with(film, Format::Png, &options)?,
        film.width * factor,
        film.height * factor,
        description,
        class,
        film.width * factor
    ))
}
