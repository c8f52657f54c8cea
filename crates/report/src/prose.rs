//! The little notation that texts of experiments use: `F_C`, `w^(1−γ)`, `*words*`.
//! It is recognised before anything is escaped, so that all else stays plain text.

use crate::{escape, number};

/// No exponent and no emphasis is longer; hostile text cannot nest them deeper than this.
const LONGEST: usize = 90;

/// A piece of a text, and the element it stands in; none for plain text.
type Piece = (Option<&'static str>, String);

/// As HTML.
pub(crate) fn html(text: &str) -> String {
    write(text, &mut escape::html)
}

/// As Markdown, in one line.
pub(crate) fn markdown(text: &str) -> String {
    let mut begins = true;
    write(&escape::one_line(text), &mut |piece| {
        escape::markdown_piece(piece, std::mem::take(&mut begins))
    })
}

/// As HTML inside Markdown, in one line: no markup of either is taken for ours.
pub(crate) fn markdown_html(text: &str) -> String {
    write(&escape::one_line(text), &mut escape::markdown_entities)
}

fn write(text: &str, escape: &mut dyn FnMut(&str) -> String) -> String {
    let mut out = String::new();
    for (element, piece) in pieces(text) {
        match element {
            None => out.push_str(&escape(&piece)),
            // An exponent can hold indices; it is shorter than what it stands in, so this ends.
            Some(name) => put!(out, "<{name}>{}</{name}>", write(&piece, escape)),
        }
    }
    out
}

fn pieces(text: &str) -> Vec<Piece> {
    let chars: Vec<char> = text.chars().collect();
    let (mut all, mut plain, mut i) = (Vec::new(), String::new(), 0);
    let mut after_index = None;
    while i < chars.len() {
        if let Some((end, number)) = power(&chars, i) {
            plain.push_str(&number);
            i = end;
            continue;
        }
        let found = match chars[i] {
            '_' => subscript(&chars, i, after_index).map(|(end, inner)| ("sub", end, inner)),
            '^' => exponent(&chars, i).map(|(end, inner)| ("sup", end, inner)),
            '*' => emphasis(&chars, i).map(|(end, inner)| ("em", end, inner)),
            _ => None,
        };
        // A minus sign, where a hyphen stands before a number.
        let digit = chars.get(i + 1).is_some_and(char::is_ascii_digit);
        let minus = chars[i] == '-' && digit && (i == 0 || " (=[".contains(chars[i - 1]));
        if let Some((element, end, inner)) = found {
            all.push((None, std::mem::take(&mut plain)));
            all.push((Some(element), inner));
            i = end;
            after_index = (element == "sub").then_some(end);
        } else {
            plain.push(match chars[i] {
                '-' if minus => '−',
                ' ' => space(&chars, i),
                other => other,
            });
            i += 1;
        }
    }
    all.push((None, plain));
    all.retain(|(_, piece)| !piece.is_empty());
    all
}

/// Units that never begin a line: a number stands before them.
const UNITS: [&str; 14] =
    ["N", "J", "m", "s", "mm", "kg", "rad", "Hz", "%", "/m", "m/s", "N/m", "N·m", "rad/s"];

/// The space here, one that breaks no line between a number and its unit or inside a short relation.
fn space(chars: &[char], at: usize) -> char {
    let edge = |c: &&char| !c.is_whitespace();
    let mut left: Vec<char> = chars[..at].iter().rev().take_while(edge).take(6).copied().collect();
    left.reverse();
    let right: String = chars[at + 1..].iter().take_while(edge).take(8).collect();
    let right = right.trim_end_matches(['.', ',', ';', ':', ')']);
    let relation = |word: &str| matches!(word, "=" | "<" | ">" | "≤" | "≥");
    let word: String = left.iter().collect();
    let short = |word: &str| !word.is_empty() && word.chars().count() <= 5;
    let digit = left.last().is_some_and(|c| c.is_ascii_digit() || "⁰¹²³⁴⁵⁶⁷⁸⁹".contains(*c));
    if digit && UNITS.contains(&right) {
        number::THIN
    } else if (relation(right) && short(&word)) || (relation(&word) && short(right)) {
        '\u{a0}'
    } else {
        ' '
    }
}

/// The index of a symbol of one letter: `F_C`, `v_S`, but not `tr_bdf2`.
/// A symbol can follow an index at once, as in `k_iΔ_i`: it begins at `start`.
fn subscript(chars: &[char], at: usize, start: Option<usize>) -> Option<(usize, String)> {
    let letter = at > 0 && chars[at - 1].is_alphabetic();
    // A factor may stand before the letter, as in `2F_C` or `½k_i`, but not a name, as in `dop853_f`.
    let before = chars[..at.saturating_sub(1)].iter().rfind(|c| !is_factor(**c));
    let follows = at > 0 && start == Some(at - 1);
    let alone = follows || !before.is_some_and(|c| c.is_alphanumeric() || *c == '_');
    let mut inner = String::new();
    for c in &chars[at + 1..] {
        let next = !inner.is_empty() && is_greek(*c);
        if next || !(c.is_alphabetic() || c.is_ascii_digit()) {
            break;
        }
        inner.push(*c);
    }
    let end = at + 1 + inner.chars().count();
    let closed = chars.get(end) != Some(&'_');
    (letter && alone && closed && (1..=3).contains(&(end - at - 1))).then_some((end, inner))
}

fn is_greek(c: char) -> bool {
    matches!(c, 'Α'..='Ω' | 'α'..='ω')
}

/// A digit, or a fraction in one character.
fn is_factor(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '½' | '¼' | '¾' | '⅓' | '⅔')
}

/// What is raised: a bracket's inside or one short word.
fn exponent(chars: &[char], at: usize) -> Option<(usize, String)> {
    if chars.get(at + 1) == Some(&'(') {
        let mut depth = 0;
        let inside = |c: &&char| {
            depth += i32::from(**c == '(') - i32::from(**c == ')');
            depth > 0 && **c != '\n'
        };
        let inner: String =
            chars[at + 1..].iter().take(LONGEST).take_while(inside).skip(1).collect();
        let end = at + 2 + inner.chars().count();
        return (chars.get(end) == Some(&')') && !inner.is_empty()).then_some((end + 1, inner));
    }
    let raised = |c: &&char| c.is_alphanumeric() || **c == '−' || **c == '-';
    let inner: String = chars[at + 1..].iter().take_while(raised).collect();
    let length = inner.chars().count();
    (1..=4).contains(&length).then_some((at + 1 + length, inner))
}

/// A number in computer notation: `2e-16` as `2 × 10⁻¹⁶`.
fn power(chars: &[char], at: usize) -> Option<(usize, String)> {
    let edge = |c: Option<&char>| !c.is_some_and(|c| c.is_alphanumeric() || "._-−".contains(*c));
    if !chars[at].is_ascii_digit() || !(at == 0 || edge(chars.get(at - 1))) {
        return None;
    }
    let number = |c: &&char| c.is_ascii_digit() || "e.-+".contains(**c);
    let word: String = chars[at..].iter().take_while(number).collect();
    let (mantissa, exponent) = word.trim_end_matches(['.', '-', '+']).split_once('e')?;
    let end = at + mantissa.len() + 1 + exponent.len();
    let value: f64 = mantissa.parse().ok()?;
    let power = number::power_of_ten(exponent.parse().ok()?);
    let text = match value {
        0.0 => "0".to_owned(),
        1.0 => power,
        _ => format!("{mantissa}\u{202f}×\u{202f}{power}"),
    };
    (!chars.get(end).is_some_and(|c| c.is_alphanumeric())).then_some((end, text))
}

/// Words between two stars that touch them.
fn emphasis(chars: &[char], at: usize) -> Option<(usize, String)> {
    let inner: String = chars[at + 1..].iter().take(LONGEST).take_while(|c| **c != '*').collect();
    let length = inner.chars().count();
    let closed = chars.get(at + 1 + length) == Some(&'*');
    let touches = !inner.starts_with(char::is_whitespace) && !inner.ends_with(char::is_whitespace);
    (closed && touches && length > 0).then_some((at + 2 + length, inner))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_get_their_index_and_exponent_and_names_stay_as_they_are() {
        assert_eq!(html("F_C > v_S"), "F<sub>C</sub>\u{a0}&gt;\u{a0}v<sub>S</sub>");
        assert_eq!(html("sinh(1/(2F_C)), dop853_f"), "sinh(1/(2F<sub>C</sub>)), dop853_f");
        assert_eq!(html("w^(1−γ) + |x|^γ"), "w<sup>1−γ</sup> + |x|<sup>γ</sup>");
        assert_eq!(html("tr_bdf2, ode_solvers, 2 * 3 * 4"), "tr_bdf2, ode_solvers, 2 * 3 * 4");
        assert_eq!(html("see *Error*, **b**"), "see <em>Error</em>, *<em>b</em>*");
        assert_eq!(html("e^((σ/F_C)(u − 1))"), "e<sup>(σ/F<sub>C</sub>)(u − 1)</sup>");
        assert_eq!(
            html("2e-16 N, 1e-12. 0e0; fig-1e5 3edges"),
            "2\u{202f}×\u{202f}10⁻¹⁶\u{202f}N, 10⁻¹². 0; fig-1e5 3edges"
        );
        assert_eq!(html("-0.5 N, 2-3, (-1)"), "−0.5\u{202f}N, 2-3, (−1)");
        let (k, d) = ("k<sub>i</sub>", "Δ<sub>i</sub>");
        assert_eq!(html("Σ k_iΔ_i²"), format!("Σ {k}{d}²"));
        assert_eq!(
            html("4k_iΔ_i(u_max − Δ_i), ½k_iΔ_i²"),
            format!("4{k}{d}(u<sub>max</sub> − {d}), ½{k}{d}²")
        );
        assert_eq!(html("k_iΔ_long_name"), format!("{k}Δ_long_name"));
        assert_eq!(html("<^<b>_C"), "&lt;^&lt;b&gt;_C");
    }

    #[test]
    fn a_number_keeps_its_unit_and_a_relation_its_sides() {
        assert_eq!(html("1 m for γ = 0.25, two N"), "1\u{202f}m for γ\u{a0}=\u{a0}0.25, two N");
        assert_eq!(html("3 meshes > everything"), "3 meshes &gt; everything");
    }

    #[test]
    fn a_hostile_nest_of_exponents_ends() {
        let nest = "^(".repeat(100_000) + &")".repeat(100_000);
        assert!(html(&nest).matches("<sup>").count() < 100_000);
    }

    #[test]
    fn markdown_keeps_the_spaces_around_an_element() {
        let text = "the F_C of *a | b* is 1. and - so";
        assert_eq!(markdown(text), "the F<sub>C</sub> of <em>a \\| b</em> is 1. and - so");
        assert_eq!(markdown("tr_bdf2"), "tr\\_bdf2");
    }
}
