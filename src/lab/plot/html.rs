//! An HTML page that needs no other file: style and script are in it, boxes that are wider than a phone scroll
//! by themselves. In: texts, which are escaped by their type, and sections as markup. Out: the page's text.

use std::borrow::Cow;
use std::ops::Add;

use super::svg::escape;

/// The script that lets legends toggle their series.
pub const SCRIPT: &str = include_str!("page/script.js");
/// The script of the glass over the pictures of a sheet.
pub const SHEET_SCRIPT: &str = include_str!("page/sheet.js");

/// Markup. `html!` makes it from a template and values, and escapes each value that is not markup itself.
#[derive(Clone, Debug, Default)]
pub struct Html(String);

impl Html {
    /// Returns what is known to be markup: templates and drawings of this crate.
    pub fn trusted(markup: impl Into<String>) -> Html {
        Html(markup.into())
    }

    /// Returns the markup of all with `between` between them.
    pub fn join(all: impl IntoIterator<Item = Html>, between: &'static str) -> Html {
        Html(all.into_iter().map(|html| html.0).collect::<Vec<_>>().join(between))
    }
}

impl Add for Html {
    type Output = Html;

    fn add(mut self, other: Html) -> Html {
        self.0 += &other.0;
        self
    }
}

impl FromIterator<Html> for Html {
    fn from_iter<I: IntoIterator<Item = Html>>(all: I) -> Html {
        Html::join(all, "")
    }
}

/// A value in a template.
pub trait Fragment {
    /// Returns the value as markup.
    fn markup(&self) -> Cow<'_, str>;
}

impl Fragment for Html {
    fn markup(&self) -> Cow<'_, str> {
        Cow::Borrowed(&self.0)
    }
}

impl Fragment for str {
    fn markup(&self) -> Cow<'_, str> {
        Cow::Owned(escape(self))
    }
}

impl Fragment for String {
    fn markup(&self) -> Cow<'_, str> {
        self.as_str().markup()
    }
}

impl Fragment for u32 {
    fn markup(&self) -> Cow<'_, str> {
        Cow::Owned(self.to_string())
    }
}

impl<T: Fragment + ?Sized> Fragment for &T {
    fn markup(&self) -> Cow<'_, str> {
        (*self).markup()
    }
}

/// Returns [`Html`] from a template as that of `format!`. Names within braces do not compile, so that no value
/// is put in unescaped.
macro_rules! html {
    ($template:literal $(, $value:expr)* $(,)?) => {
        $crate::lab::plot::html::Html::trusted(format!(
            concat!($template),
            $($crate::lab::plot::html::Fragment::markup(&$value)),*
        ))
    };
}

pub(crate) use html;

/// What a page opens with.
pub struct Header<'a> {
    pub title: &'a str,
    /// The conditions: device, scene and size.
    pub facts: &'a str,
    /// The result in one sentence, if there is one.
    pub lead: &'a str,
    pub more: Html,
}

/// Returns the page around `sections`, without a script if `script` is empty.
pub fn document(header: &Header<'_>, sections: &Html, script: &str) -> String {
    let Header { title, facts, lead, more } = header;
    let lead = match *lead {
        "" => Html::default(),
        lead => html!("<p class=\"lead\">{}</p>\n", lead),
    };
    let script = match script {
        "" => Html::default(),
        script => html!("<script>\n{}</script>\n", Html::trusted(script)),
    };
    html!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{}</title>\n\
         <link rel=\"icon\" href=\"data:,\"/>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n\
         <header>\n<h1>{}</h1>\n<p class=\"facts\">{}</p>\n{}{}</header>\n\
         {}</main>\n{}</body>\n</html>\n",
        title,
        Html::trusted(include_str!("page/style.css")),
        title,
        facts,
        lead,
        more,
        sections,
        script
    )
    .0
}

pub fn section(id: &str, heading: &str, body: Html) -> Html {
    html!(
        "<section aria-labelledby=\"{}-h\">\n<h2 id=\"{}-h\">{}</h2>\n{}</section>\n",
        id,
        id,
        heading,
        body
    )
}

/// Returns a box that scrolls horizontally, by keyboard too.
pub fn scroll(label: &str, body: Html) -> Html {
    boxed("scroll", label, body)
}

/// Returns a box that scrolls vertically.
pub fn scroll_long(label: &str, body: Html) -> Html {
    boxed("scroll long", label, body)
}

fn boxed(class: &str, label: &str, body: Html) -> Html {
    html!(
        "<div class=\"{}\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">\n{}</div>\n",
        class,
        label,
        body
    )
}

pub fn code(command: &str) -> Html {
    html!("<pre><code>{}</code></pre>\n", command)
}

/// A table in a box. The first cell of a row is its heading.
pub fn table(caption: &str, head: &[&str], rows: &[Vec<Html>]) -> Html {
    scroll(caption, bare_table(caption, head, rows))
}

pub fn long_table(caption: &str, head: &[&str], rows: &[Vec<Html>]) -> Html {
    scroll_long(caption, bare_table(caption, head, rows))
}

fn bare_table(caption: &str, head: &[&str], rows: &[Vec<Html>]) -> Html {
    let head: Html = head.iter().map(|h| html!("<th scope=\"col\">{}</th>", h)).collect();
    let row = |row: &Vec<Html>| {
        let mut cells = row.iter();
        let heading: Html =
            cells.next().map(|c| html!("<tr><th scope=\"row\">{}</th>", c)).into_iter().collect();
        let cells: Html = cells.map(|c| html!("<td>{}</td>", c)).collect();
        html!("{}{}</tr>\n", heading, cells)
    };
    let rows: Html = rows.iter().map(row).collect();
    html!(
        "<table>\n<caption><span>{}</span></caption>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n",
        caption,
        head,
        rows
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_markup_is_not() {
        let name = "a<b & \"c\"";
        let cell = html!("<td title=\"{}\">{}</td>", name, html!("<b>{}</b>", String::from(name)));
        let escaped = "a&lt;b &amp; &quot;c&quot;";
        assert_eq!(cell.0, format!("<td title=\"{escaped}\"><b>{escaped}</b></td>"));
        assert_eq!(Html::join([html!("{}", 1), html!("<br/>")], ", ").0, "1, <br/>");
    }
}
