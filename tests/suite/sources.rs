//! Rust sources as tokens of the compiler's own lexer, with their lines; from these, the paths into the crate and
//! undocumented `unsafe`. Comments are no tokens, contents of literals are ignored, arguments of macros are included.

use std::collections::BTreeMap;

use proc_macro2::{Delimiter, Spacing, Span, TokenStream, TokenTree};

/// A name, `::`, a delimiter or another sign; a literal is `""`.
pub struct Token {
    pub line: usize,
    pub text: String,
}

/// Returns the tokens of a file, or the position at which it is not Rust.
pub fn tokens(text: &str) -> Result<Vec<Token>, String> {
    let stream: TokenStream = text.parse().map_err(|e| format!("this is not Rust: {e}"))?;
    let mut found = Vec::new();
    flatten(stream, &mut found);
    Ok(found)
}

fn flatten(stream: TokenStream, found: &mut Vec<Token>) {
    let mut stream = stream.into_iter().peekable();
    while let Some(tree) = stream.next() {
        let mut push = |span: Span, text: &str| {
            found.push(Token { line: span.start().line, text: text.to_string() });
        };
        match tree {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Brace => ("{", "}"),
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::None => ("", ""),
                };
                push(group.span_open(), open);
                flatten(group.stream(), found);
                found.push(Token { line: group.span_close().start().line, text: close.to_string() });
            }
            TokenTree::Ident(name) => push(name.span(), &name.to_string()),
            TokenTree::Literal(literal) => push(literal.span(), "\"\""),
            TokenTree::Punct(sign) if sign.as_char() == ':' && sign.spacing() == Spacing::Joint => {
                // The second half of `::`.
                let second = stream.next_if(|t| matches!(t, TokenTree::Punct(p) if p.as_char() == ':'));
                push(sign.span(), if second.is_some() { "::" } else { ":" });
            }
            TokenTree::Punct(sign) => push(sign.span(), &sign.as_char().to_string()),
        }
    }
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphanumeric() || c == '_')
}

/// Returns the paths into the crate, of up to three names, each with its line; including those of a grouped `use`, and
/// those that use `super` from the module `of`.
pub fn crate_paths(tokens: &[Token], of: &[&str]) -> Vec<(usize, String)> {
    let word = |i: usize| tokens.get(i).map_or("", |t| t.text.as_str());
    let path = |base: &[&str], i: usize| {
        let mut parts = base.to_vec();
        parts.push(word(i));
        let mut at = i;
        while parts.len() < 3 && word(at + 1) == "::" && is_name(word(at + 2)) {
            at += 2;
            parts.push(word(at));
        }
        (tokens[i].line, parts.join("::"))
    };
    let mut found = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        let begins = i == 0 || word(i - 1) != "::";
        let mut climbs = 0;
        while begins && word(i + 2 * climbs) == "super" && word(i + 2 * climbs + 1) == "::" {
            climbs += 1;
        }
        let base: &[&str] = match climbs {
            0 if begins && word(i) == "crate" && word(i + 1) == "::" => &[],
            0 => {
                i += 1;
                continue;
            }
            _ => &of[..of.len().saturating_sub(climbs)],
        };
        let first = i + 2 * climbs.max(1);
        i = first;
        if word(first) != "{" {
            found.push(path(base, first));
            continue;
        }
        let mut depth = 0;
        for j in first..tokens.len() {
            match word(j) {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ if depth == 1 && ["{", ","].contains(&word(j - 1)) && word(j) != "self" => {
                    found.push(path(base, j));
                }
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    found
}

/// Returns the lines with an unsafe block or impl whose statement has no `SAFETY:` comment on it or right above it.
pub fn undocumented_unsafe(text: &str, tokens: &[Token]) -> Vec<usize> {
    let lines: Vec<&str> = text.lines().collect();
    let last: BTreeMap<usize, &str> = tokens.iter().map(|t| (t.line, t.text.as_str())).collect();
    let ends = |line: &usize| matches!(last.get(line), Some(&";" | &"}"));
    let documented = |line: usize| {
        let above = (1..line).rev().take_while(|l| !ends(l));
        std::iter::once(line).chain(above).any(|l| lines[l - 1].contains("SAFETY:"))
    };
    let declares = |i: usize| tokens.get(i).is_some_and(|t| ["fn", "extern"].contains(&t.text.as_str()));
    let blocks = (0..tokens.len()).filter(|&i| tokens[i].text == "unsafe" && !declares(i + 1));
    let mut found: Vec<usize> = blocks.map(|i| tokens[i].line).filter(|&line| !documented(line)).collect();
    found.dedup();
    found
}
