//! Reference tables whose first columns are generated and whose last columns a person writes. In: a page, the
//! heading above the table, and the rows of the code. Out: what differs, and the page as it should be.

/// The mark of a cell that is not yet written.
const UNKNOWN: &str = "?";

/// Returns the cells of a table's line; `\|` stands for a bar.
pub fn cells(line: &str) -> Vec<String> {
    let inner = line.trim().trim_start_matches('|').trim_end_matches('|').replace("\\|", "\u{1}");
    inner.split('|').map(|cell| cell.trim().replace('\u{1}', "|")).collect()
}

fn line_of(cells: &[String]) -> String {
    format!("| {} |", cells.iter().map(|c| c.replace('|', "\\|")).collect::<Vec<_>>().join(" | "))
}

/// Returns the lines of the first table below a heading, without its two lines of head.
fn rows_below(lines: &[String], heading: &str) -> Option<std::ops::Range<usize>> {
    let at = lines.iter().position(|line| line == heading)?;
    let end = (at + 1..lines.len()).find(|&i| lines[i].starts_with('#')).unwrap_or(lines.len());
    let first = (at + 1..end).find(|&i| lines[i].starts_with('|'))?;
    let last = (first..end).find(|&i| !lines[i].starts_with('|')).unwrap_or(end);
    Some((first + 2).min(last)..last)
}

/// Returns the rows of the table below a heading.
pub fn rows(text: &str, heading: &str) -> Vec<Vec<String>> {
    let lines: Vec<String> = text.lines().map(String::from).collect();
    rows_below(&lines, heading).map_or(Vec::new(), |range| lines[range].iter().map(|l| cells(l)).collect())
}

/// Holds the table below `heading` against the `wanted` first cells of its rows, of which the very first names
/// the row, and corrects `text`. The whole table has `columns`. Faults are added to `faults`.
pub fn correct(
    text: &mut String,
    heading: &str,
    columns: usize,
    wanted: &[Vec<String>],
    faults: &mut Vec<String>,
) {
    let mut lines: Vec<String> = text.lines().map(String::from).collect();
    let Some(range) = rows_below(&lines, heading) else {
        faults.push(format!("no table below the heading \"{heading}\": write both"));
        return;
    };
    let found: Vec<Vec<String>> = lines[range.clone()].iter().map(|line| cells(line)).collect();
    let mut rows = Vec::new();
    for row in &found {
        let Some(right) = wanted.iter().find(|w| w[0] == row[0]) else {
            faults.push(format!("{heading}: {} is not in the code", row[0]));
            continue;
        };
        let mut row = row.clone();
        row.resize(columns, UNKNOWN.into());
        for (cell, right) in row.iter_mut().zip(right) {
            if cell != right {
                faults.push(format!("{heading}: {}: \"{cell}\" is \"{right}\"", right_name(wanted, right)));
                cell.clone_from(right);
            }
        }
        if row.iter().any(|cell| cell == UNKNOWN) {
            faults.push(format!("{heading}: {} is not described", row[0]));
        }
        rows.push(row);
    }
    for right in wanted.iter().filter(|w| !found.iter().any(|row| row[0] == w[0])) {
        faults.push(format!("{heading}: {} is missing", right[0]));
        let mut row = right.clone();
        row.resize(columns, UNKNOWN.into());
        rows.push(row);
    }
    lines.splice(range, rows.iter().map(|row| line_of(row)));
    *text = lines.join("\n") + "\n";
}

/// Returns the name of the row that has this cell.
fn right_name<'a>(wanted: &'a [Vec<String>], cell: &str) -> &'a str {
    wanted.iter().find(|row| row.iter().any(|c| c == cell)).map_or("", |row| &row[0])
}

const PLANTED: &str = "## `[camera]`\n\n| key | values | meaning |\n| --- | --- | --- |\n| `eye` | a point | where it is |\n| `up` | a \\| b | above |\n\n## `[image]`\n";

fn wanted(rows: &[[&str; 2]]) -> Vec<Vec<String>> {
    rows.iter().map(|row| row.map(String::from).to_vec()).collect()
}

fn faults_of(rows: &[[&str; 2]]) -> (String, Vec<String>) {
    let (mut text, mut faults) = (PLANTED.to_string(), Vec::new());
    correct(&mut text, "## `[camera]`", 3, &wanted(rows), &mut faults);
    (text, faults)
}

#[test]
fn a_table_that_is_right_stays_as_it_is() {
    assert_eq!(faults_of(&[["`eye`", "a point"], ["`up`", "a | b"]]), (PLANTED.to_string(), vec![]));
}

#[test]
fn planted_faults_are_found_and_corrected() {
    let (text, faults) = faults_of(&[["`eye`", "3 numbers"], ["`fov`", "degrees"]]);
    assert_eq!(faults.len(), 3, "{faults:?}");
    assert!(
        text.contains("| `eye` | 3 numbers | where it is |\n| `fov` | degrees | ? |\n\n## `[image]`"),
        "{text}"
    );
    // A new row waits for its meaning.
    let mut again = Vec::new();
    correct(
        &mut text.clone(),
        "## `[camera]`",
        3,
        &wanted(&[["`eye`", "3 numbers"], ["`fov`", "degrees"]]),
        &mut again,
    );
    assert_eq!(again, ["## `[camera]`: `fov` is not described"]);
    let mut none = Vec::new();
    correct(&mut text.clone(), "## `[image]`", 3, &[], &mut none);
    assert_eq!(none.len(), 1, "a heading without a table");
}
