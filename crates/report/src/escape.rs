//! Text from a record, made harmless where it is shown.

/// Text inside HTML or SVG, in content and in quoted attributes.
pub(crate) fn html(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            // Control characters and the two non-characters are not allowed in XML at all.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// Text in a Markdown table's cell or in a line: no markup of it is taken for ours.
pub(crate) fn markdown(text: &str) -> String {
    markdown_piece(&one_line(text), true)
}

/// Text in a quoted attribute of an element in Markdown.
pub(crate) fn markdown_attribute(text: &str) -> String {
    markdown_entities(&one_line(text))
}

/// Text of an element in Markdown: what either takes for markup stands as entities.
pub(crate) fn markdown_entities(flat: &str) -> String {
    let entity = |c: char| match c {
        '[' | ']' | '`' | '*' | '_' | '|' | '$' | '~' | '@' => format!("&#{};", u32::from(c)),
        _ => c.to_string(),
    };
    html(flat).chars().map(entity).collect()
}

/// Runs of blanks and line ends as single spaces.
pub(crate) fn one_line(text: &str) -> String {
    text.split_ascii_whitespace().collect::<Vec<_>>().join(" ")
}

/// A piece of one line; `begins` if a line begins with it.
pub(crate) fn markdown_piece(flat: &str, begins: bool) -> String {
    let mut out = String::with_capacity(flat.len());
    for (i, c) in flat.char_indices() {
        match c {
            '\\' | '`' | '*' | '_' | '[' | ']' | '#' | '~' | '|' => {
                out.push('\\');
                out.push(c);
            }
            '-' | '+' | '=' if begins && i == 0 => {
                out.push('\\');
                out.push(c);
            }
            '.' | ')' if begins && is_list_mark(flat, i) => {
                out.push('\\');
                out.push(c);
            }
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '$' => out.push_str("&#36;"),
            '@' => out.push_str("&#64;"),
            // Without its slashes an address is not made a link.
            '/' if flat[..i].ends_with(':') => out.push_str("&#47;"),
            c if c.is_control() => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out.replace("www.", "www&#46;")
}

/// Whether the character at `i` would make a list's number of the digits before it.
fn is_list_mark(text: &str, i: usize) -> bool {
    let ends = text[i + 1..].chars().next().is_none_or(|next| next == ' ');
    i > 0 && ends && text[..i].bytes().all(|b| b.is_ascii_digit())
}

/// A field of a CSV file.
pub(crate) fn csv(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// A name that can be a file's, a folder's and an element's: letters, digits, `-`, `_`, `.`, `=`.
pub(crate) fn slug(text: &str) -> String {
    let slug: String = text
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || "-_.=".contains(c) { c } else { '-' })
        .collect();
    let slug = slug.trim_matches(|c| matches!(c, '.' | '-')).to_owned();
    if slug.is_empty() { "unnamed".to_owned() } else { slug }
}

/// The sentences of a text, one each; abbreviations such as `p.` and `Fig.` end none.
pub(crate) fn sentences(text: &str) -> Vec<String> {
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let (mut all, mut now) = (Vec::new(), String::new());
    for (i, word) in words.iter().enumerate() {
        if !now.is_empty() {
            now.push(' ');
        }
        now.push_str(word);
        let next_begins = words.get(i + 1).is_some_and(|w| !w.starts_with(char::is_lowercase));
        if word.ends_with(['.', '!', '?']) && !is_abbreviation(word) && next_begins {
            all.push(std::mem::take(&mut now));
        }
    }
    if !now.is_empty() {
        all.push(now);
    }
    all
}

fn is_abbreviation(word: &str) -> bool {
    let word = word.trim_start_matches('(').to_lowercase();
    matches!(
        word.as_str(),
        "p." | "pp." | "fig." | "figs." | "eq." | "eqs." | "e.g." | "i.e." | "cf." | "vs." | "no."
    )
}

/// The path of our code named at the start of `code`, if it is one that can be linked to.
pub(crate) fn code_path(code: &str) -> Option<&str> {
    let end = code.find(".rs")? + 3;
    let path = &code[..end];
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./".contains(c);
    let inside = path.starts_with("crates/") && !path.contains("..") && !path.contains("//");
    (inside && path.chars().all(plain)).then_some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_text_loses_its_teeth() {
        assert_eq!(html("<b a='1'>&\"\u{1}"), "&lt;b a=&#39;1&#39;&gt;&amp;&quot;\u{fffd}");
        assert_eq!(markdown("a|b `c` <d>\n# e"), "a\\|b \\`c\\` &lt;d&gt; \\# e");
        assert_eq!(markdown("http://x.y $1$"), "http:&#47;/x.y &#36;1&#36;");
        assert_eq!(["- a", "1. a", "2.6 J"].map(markdown), ["\\- a", "1\\. a", "2.6 J"]);
        assert_eq!(csv("a,\"b\""), "\"a,\"\"b\"\"\"");
        assert_eq!(slug("../../etc/passwd"), "etc-passwd");
        assert_eq!(slug("…"), "unnamed");
        assert_eq!(code_path("crates/duhem/src/lib.rs: area"), Some("crates/duhem/src/lib.rs"));
        assert_eq!(code_path("crates/../../x.rs"), None);
        assert_eq!(code_path("javascript:alert(1).rs"), None);
    }

    #[test]
    fn a_text_is_cut_at_its_sentences_only() {
        let text = "See p. 97 of it. Then γ = 0.5 holds! In Fig. 2 too.";
        assert_eq!(sentences(text), ["See p. 97 of it.", "Then γ = 0.5 holds!", "In Fig. 2 too."]);
        assert_eq!(sentences(" "), Vec::<String>::new());
    }
}
