//! Labels beside their lines, moved apart where they would cover one another.

/// Heights near the wished ones, at least `gap` apart, between `top` and `bottom` as far as there is room.
/// The order is kept and the sum of squared moves is the least possible without the two ends.
pub(crate) fn spread(wished: &[f64], gap: f64, top: f64, bottom: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wished.len()).collect();
    order.sort_by(|a, b| wished[*a].total_cmp(&wished[*b]).then(a.cmp(b)));
    // Groups of labels that touch: how many, and where the first would stand on average.
    let mut groups: Vec<(usize, f64)> = Vec::new();
    for (n, i) in order.iter().enumerate() {
        let mut group = (1, wished[*i] - n as f64 * gap);
        while let Some(last) = groups.pop_if(|last| last.1 > group.1) {
            let (a, b) = (last.0 as f64, group.0 as f64);
            group = (last.0 + group.0, (last.1 * a + group.1 * b) / (a + b));
        }
        groups.push(group);
    }
    let mut places = vec![0.0; wished.len()];
    let slack = (bottom - top - gap * wished.len().saturating_sub(1) as f64).max(0.0);
    let mut n = 0;
    for (size, start) in groups {
        for _ in 0..size {
            places[order[n]] = start.clamp(top, top + slack) + n as f64 * gap;
            n += 1;
        }
    }
    places
}

/// The width of a text at plain size, a little more than most fonts take [px].
pub(crate) fn width(text: &str) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | 't' | 'f' | 'r' | '.' | ',' | ':' | '\'' | '|' | '(' | ')' | ' ' => 0.36,
        '\u{202f}' => 0.25,
        'm' | 'w' | 'M' | 'W' | '±' | '×' | '−' | '–' | '=' | '<' | '>' | '≥' | '≤' | '+' => {
            0.86
        }
        '⁰'..='⁹' | '¹' | '²' | '³' | '⁻' | '₀'..='₉' => 0.45,
        '½' => 0.97,
        'A'..='Z' => 0.7,
        _ => 0.61,
    };
    text.chars().map(em).sum::<f64>() * super::canvas::TEXT
}

/// The text, cut with an ellipsis where it is wider than `most` pixels.
pub(crate) fn fit(text: &str, most: f64) -> String {
    if width(text) <= most {
        return text.to_owned();
    }
    let mut cut = String::new();
    for c in text.chars() {
        cut.push(c);
        if width(&cut) + width("…") > most {
            cut.pop();
            break;
        }
    }
    cut.push('…');
    cut
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_stand_apart_near_their_lines_and_inside() {
        assert_eq!(spread(&[10.0, 50.0], 14.0, 0.0, 100.0), [10.0, 50.0]);
        assert_eq!(spread(&[50.0, 50.0], 14.0, 0.0, 100.0), [43.0, 57.0]);
        assert_eq!(spread(&[99.0, 98.0, 0.0], 14.0, 0.0, 100.0), [100.0, 86.0, 0.0]);
        let crowd = spread(&[5.0; 20], 14.0, 0.0, 100.0);
        assert!(crowd.windows(2).all(|w| w[1] - w[0] >= 14.0), "{crowd:?}");
        assert_eq!(fit("a name far too long", 60.0), "a name…");
        assert!(spread(&[], 14.0, 0.0, 1.0).is_empty());
    }

    #[test]
    fn a_fraction_has_the_room_that_it_takes() {
        // Its advance in DejaVu Sans, the widest of the fonts that a browser falls back to.
        assert!(width("½") >= 0.969 * crate::plot::canvas::TEXT);
    }
}
