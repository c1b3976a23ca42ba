//! SVG elements of a plot: a document with a title and a description, text, markers, and styles
//! that are readable in light and dark mode.

/// The number of colours that are easily distinguished; the last is grey.
pub const COLORS: usize = 7;
const MARKERS: usize = 8;

/// Okabe and Ito's colours that have contrast on white, and lighter ones of the same hues for dark
/// mode.
const STYLE: &str = "\
.plot{--c0:#0072b2;--c1:#c94f00;--c2:#00805c;--c3:#b0558a;--c4:#8a6500;--c5:#2a8fc4;--c6:#555;\
--ink:#1b1b1f;--faint:#d9d9de;--ground:#fff;color:var(--ink);background:var(--ground);\
font:14px system-ui,sans-serif}\
@media(prefers-color-scheme:dark){.plot{--c0:#5ab4f0;--c1:#ff9248;--c2:#35cfa2;--c3:#eda0cd;--c4:#e3bd4f;\
--c5:#93d6ff;--c6:#bbb;--ink:#ececf1;--faint:#3a3a42;--ground:#17171b}}\
.plot text{fill:currentColor}.plot .grid{stroke:var(--faint)}.plot .frame{stroke:currentColor;fill:none}.plot .axis{stroke:currentColor}\
.plot .guide{stroke:currentColor;opacity:.55;stroke-dasharray:2 5}\
.plot .level{stroke:currentColor;stroke-dasharray:9 5;opacity:.8}\
.plot .small{font-size:12px}.plot .series path.line{fill:none;stroke-width:1.8}\
.plot .series path.lead{stroke-width:3.2}.plot .series path.rest{stroke-width:1;opacity:.6}\
.plot .name{paint-order:stroke;stroke:var(--ground);stroke-width:3px;stroke-linejoin:round}\
.plot .lead{font-weight:600}.plot .leader{stroke:var(--c6);stroke-width:.8}\
.plot .cut{stroke:var(--ground);stroke-width:3}.plot .mark{stroke-width:1.6}.plot .off{opacity:.12}.plot .key{cursor:default}";

/// Escapes text for XML and HTML, including within double quotes.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns a whole document. `id` distinguishes the titles of several plots in one page.
pub fn document(id: &str, size: [f64; 2], title: &str, description: &str, body: &str) -> String {
    let mut style = String::from(STYLE);
    for c in 0..COLORS {
        style += &format!(".plot .s{c}{{stroke:var(--c{c})}}.plot .f{c},.plot text.t{c}{{fill:var(--c{c})}}");
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" \
         role=\"img\" aria-labelledby=\"{id}-title {id}-desc\">\n<title id=\"{id}-title\">{}</title>\n\
         <desc id=\"{id}-desc\">{}</desc>\n<style>{style}</style>\n{body}</svg>\n",
        size[0],
        size[1],
        size[0],
        size[1],
        escape(title),
        escape(description)
    )
}

pub fn text(x: f64, y: f64, anchor: &str, class: &str, content: &str) -> String {
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" class=\"{class}\">{}</text>\n",
        escape(content)
    )
}

pub fn line(from: [f64; 2], to: [f64; 2], class: &str) -> String {
    let [[x1, y1], [x2, y2]] = [from, to];
    format!("<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" class=\"{class}\"/>\n")
}

/// Returns the marker of a series, by the numbers of its colour and its shape, and its radius; the title is its tooltip.
pub fn marker([color, mark]: [usize; 2], [x, y]: [f64; 2], radius: f64, title: &str) -> String {
    let path = |points: &[[f64; 2]], closed: bool| {
        let steps: Vec<String> =
            points.iter().map(|p| format!("{:.1} {:.1}", x + radius * p[0], y + radius * p[1])).collect();
        format!("M{}{}", steps.join("L"), if closed { "Z" } else { "" })
    };
    let shape = match mark % MARKERS {
        0 => format!(
            "M{:.1} {y:.1}a{radius} {radius} 0 1 0 {} 0a{radius} {radius} 0 1 0 -{} 0Z",
            x - radius,
            2.0 * radius,
            2.0 * radius
        ),
        1 => path(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]], true),
        2 => path(&[[0.0, -1.1], [1.0, 0.8], [-1.0, 0.8]], true),
        3 => path(&[[0.0, -1.25], [1.25, 0.0], [0.0, 1.25], [-1.25, 0.0]], true),
        4 => path(&[[0.0, 1.1], [1.0, -0.8], [-1.0, -0.8]], true),
        5 => path(&[[-0.9, -0.9], [0.9, 0.9]], false) + &path(&[[-0.9, 0.9], [0.9, -0.9]], false),
        6 => path(&[[0.0, -1.2], [0.0, 1.2]], false) + &path(&[[-1.2, 0.0], [1.2, 0.0]], false),
        _ => path(&[[-1.0, -0.45], [0.0, -1.1], [1.0, -0.45], [0.65, 0.9], [-0.65, 0.9]], true),
    };
    let title = if title.is_empty() { String::new() } else { format!("<title>{}</title>", escape(title)) };
    format!("<path d=\"{shape}\" class=\"mark s{color} f{color}\">{title}</path>\n")
}
