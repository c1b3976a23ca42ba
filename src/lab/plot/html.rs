//! A self-contained HTML page with embedded style and script, in which boxes wider than a phone's
//! screen scroll on their own. Takes sections as HTML and returns the page's text.

use super::svg::escape;

/// The script that lets legends toggle their series.
pub const SCRIPT: &str = include_str!("page/script.js");

/// The head of a page; all fields are HTML.
pub struct Header<'a> {
    pub title: &'a str,
    /// The conditions: device, scene and size.
    pub facts: &'a str,
    /// The result in one sentence.
    pub lead: &'a str,
    pub more: &'a str,
}

/// Returns the page around `sections`, without a script if `script` is empty.
pub fn document(header: &Header<'_>, sections: &str, script: &str) -> String {
    let Header { title, facts, lead, more } = header;
    let script = if script.is_empty() { String::new() } else { format!("<script>\n{script}</script>\n") };
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"data:,\"/>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n\
         <header>\n<h1>{title}</h1>\n<p class=\"facts\">{facts}</p>\n<p class=\"lead\">{lead}</p>\n{more}</header>\n\
         {sections}</main>\n{script}</body>\n</html>\n",
        include_str!("page/style.css"),
    )
}

pub fn section(id: &str, heading: &str, body: &str) -> String {
    format!("<section aria-labelledby=\"{id}-h\">\n<h2 id=\"{id}-h\">{heading}</h2>\n{body}</section>\n")
}

/// Returns a box that scrolls horizontally, by keyboard too.
pub fn scroll(label: &str, body: &str) -> String {
    boxed("scroll", label, body)
}

/// Returns a box that scrolls vertically.
pub fn scroll_long(label: &str, body: &str) -> String {
    boxed("scroll long", label, body)
}

fn boxed(class: &str, label: &str, body: &str) -> String {
    let label = escape(label);
    format!("<div class=\"{class}\" role=\"region\" tabindex=\"0\" aria-label=\"{label}\">\n{body}</div>\n")
}

pub fn code(command: &str) -> String {
    format!("<pre><code>{}</code></pre>\n", escape(command))
}

/// Returns a table in a scrolling box. The first cell of a row is its heading; cells are HTML.
pub fn table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    scroll(caption, &bare_table(caption, head, rows))
}

pub fn long_table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    scroll_long(caption, &bare_table(caption, head, rows))
}

fn bare_table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let mut out = format!("<table>\n<caption>{}</caption>\n<thead><tr>", escape(caption));
    head.iter().for_each(|h| out += &format!("<th scope=\"col\">{}</th>", escape(h)));
    out += "</tr></thead>\n<tbody>\n";
    for row in rows {
        let mut cells = row.iter();
        out += &cells.next().map_or(String::new(), |c| format!("<tr><th scope=\"row\">{c}</th>"));
        cells.for_each(|c| out += &format!("<td>{c}</td>"));
        out += "</tr>\n";
    }
    out + "</tbody>\n</table>\n"
}
