//! How numbers are written: digits that match the error, powers of ten, the true minus sign.

/// The space between a number and its unit, and between groups of three digits.
pub(crate) const THIN: char = '\u{202f}';
/// What stands where there is no number.
pub(crate) const NONE: &str = "–";
/// Below this an error is round-off and its digits mean nothing.
pub(crate) const ROUND_OFF: f64 = 1e-13;
/// No measured value is written with more digits than this.
const MOST_DIGITS: i32 = 10;

/// `exponent` in superscript digits, as in `⁻⁷`.
pub(crate) fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' => '⁰',
            other => {
                char::from_u32(u32::from(other) - u32::from('4') + u32::from('⁴')).unwrap_or(other)
            }
        })
        .collect()
}

/// A power of ten as a tick shows it: `1`, `10`, `10⁻²`.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => format!("10{}", superscript(exponent)),
    }
}

/// A number with so many decimals, with the true minus sign and no negative zero.
pub(crate) fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// A number with so many significant digits: `0.0123`, `3.2 × 10⁻⁷`; trailing zeros are kept.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return not_finite(value);
    }
    let (mantissa, exponent) = parts(value, digits);
    if value == 0.0 {
        return "0".to_owned();
    }
    if (-3..5).contains(&exponent) {
        let decimals = i32::try_from(digits).unwrap_or(1) - 1 - exponent;
        return decimal(mantissa * 10f64.powi(exponent), usize::try_from(decimals).unwrap_or(0));
    }
    if digits == 1 && mantissa == 1.0 {
        return power_of_ten(exponent);
    }
    format!(
        "{}\u{202f}×\u{202f}10{}",
        decimal(mantissa, digits.saturating_sub(1)),
        superscript(exponent)
    )
}

/// A number as short as it can be written with at most six digits.
pub(crate) fn short(value: f64) -> String {
    (1..=6)
        .find(|digits| parse(value, *digits) == value)
        .map_or_else(|| trimmed(value, 6), |digits| trimmed(value, digits))
}

fn parse(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(f64::NAN)
}

/// Significant digits without zeros at the end.
fn trimmed(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (mantissa, rest) = text.split_at(text.find("\u{202f}×").unwrap_or(text.len()));
    if !mantissa.contains('.') {
        return text;
    }
    match mantissa.trim_end_matches('0').trim_end_matches('.') {
        "1" if !rest.is_empty() => rest.trim_start_matches("\u{202f}×\u{202f}").to_owned(),
        mantissa => format!("{mantissa}{rest}"),
    }
}

/// Ten digits; fewer where the number is short, as 0.75 is, but not where its tenth just happens to be a zero.
fn ten_digits(value: f64) -> String {
    if parse(value, 6) == parse(value, 10) { trimmed(value, 10) } else { significant(value, 10) }
}

/// A number split at its decimal exponent, rounded to so many digits.
fn parts(value: f64, digits: usize) -> (f64, i32) {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    (mantissa.parse().unwrap_or(value), exponent.parse().unwrap_or(0))
}

fn not_finite(value: f64) -> String {
    match (value.is_nan(), value < 0.0) {
        (true, _) => "not a number",
        (false, true) => "−∞",
        (false, false) => "∞",
    }
    .to_owned()
}

/// A relative error as the tables show it: two digits, round-off as `< 10⁻¹³`.
pub(crate) fn error(value: Option<f64>) -> String {
    match value {
        None => NONE.to_owned(),
        Some(v) if v.is_finite() && v.abs() < ROUND_OFF => "<\u{a0}10⁻¹³".to_owned(),
        Some(v) => significant(v, 2),
    }
}

/// A number with so many decimals, or the dash.
pub(crate) fn maybe(value: Option<f64>, decimals: usize) -> String {
    match value {
        Some(v) if v.is_finite() => decimal(v, decimals),
        Some(v) => not_finite(v),
        None => NONE.to_owned(),
    }
}

/// A count in groups of three: `5 000 000`.
pub(crate) fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.len() > 4 {
            text.push(THIN);
        }
        text.push(c);
    }
    text
}

/// The unit with its space; nothing for `1` or no unit.
pub(crate) fn unit(unit: &str) -> String {
    if matches!(unit.trim(), "" | "1") { String::new() } else { format!("{THIN}{}", unit.trim()) }
}

/// A printed number with the digits it is printed with.
pub(crate) fn printed(value: Option<f64>, digits: Option<u64>, of: &str) -> String {
    let Some(value) = value else { return NONE.to_owned() };
    let number = match digits.and_then(|d| usize::try_from(d).ok()) {
        Some(digits @ 1..=17) => significant(value, digits),
        _ => short(value),
    };
    format!("{number}{}", unit(of))
}

/// A value with four significant digits and its unit, and no error; fewer where the number is short, as 0.75 is.
pub(crate) fn four_digits(value: f64, of: &str) -> String {
    if !value.is_finite() {
        return not_finite(value);
    }
    let shorter = parse(value, 3) == parse(value, 10);
    let number = if shorter { trimmed(value, 3) } else { significant(value, 4) };
    format!("{number}{}", unit(of))
}

/// Whether a number without unit is a whole one: what is counted has no error worth saying.
fn is_count(value: f64) -> bool {
    value.abs() < 1e6 && value.fract() == 0.0
}

/// A value with its error, the digits of one matching the other.
pub(crate) fn with_error(value: f64, error: Option<f64>, of: &str) -> String {
    let unit = unit(of);
    if !value.is_finite() {
        return not_finite(value);
    }
    let Some(error) = error.filter(|e| e.is_finite() && *e >= 0.0) else {
        return format!("{}{unit}", short(value));
    };
    if value.abs() < 0.05 * error && error >= ROUND_OFF {
        return format!("0 ± {}{unit}", significant(error, 1));
    }
    if error < ROUND_OFF && unit.is_empty() && is_count(value) {
        return short(value);
    }
    if error < ROUND_OFF && (value == 0.0 || value.abs() > 1e-10) {
        return format!("{}{unit}, error <\u{a0}10⁻¹³", ten_digits(value));
    }
    if error == 0.0 {
        return format!("{}{unit} ± 0", trimmed(value, 10));
    }
    let digits = if parts(error, 1).0 == 1.0 { 2 } else { 1 };
    let (_, last) = parts(error, digits);
    let last = last + 1 - digits_as_i32(digits); // the exponent of the last digit written
    let first = parts(value.abs().max(error), 15).1;
    if first - last >= MOST_DIGITS {
        return format!("{} ± {}{unit}", ten_digits(value), significant(error, 1));
    }
    if (-3..5).contains(&first) {
        let decimals = usize::try_from(-last).unwrap_or(0);
        let value = decimal(round_to(value, last), decimals);
        let error = if last < -4 {
            significant(error, digits)
        } else {
            decimal(round_to(error, last), decimals)
        };
        return format!("{value} ± {error}{unit}");
    }
    let (scale, decimals) = (10f64.powi(-first), usize::try_from(first - last).unwrap_or(0));
    let (value, error) = (decimal(value * scale, decimals), decimal(error * scale, decimals));
    format!("({value} ± {error})\u{202f}×\u{202f}10{}{unit}", superscript(first))
}

fn digits_as_i32(digits: usize) -> i32 {
    i32::try_from(digits).unwrap_or(1)
}

/// Rounded at a digit left of the point; at others the formatting does it.
fn round_to(value: f64, last: i32) -> f64 {
    if last > 0 { (value / 10f64.powi(last)).round() * 10f64.powi(last) } else { value }
}

/// A sweep point as it is read: `gamma=0.25` as `γ = 0.25`.
pub(crate) fn point(text: &str) -> String {
    text.split(',')
        .map(|part| match part.split_once('=') {
            Some((name, value)) => {
                let value = value.trim();
                let value = value.parse::<f64>().map_or_else(|_| value.to_owned(), short);
                format!("{} = {value}", symbol(name.trim()))
            }
            None => part.trim().to_owned(),
        })
        .collect::<Vec<_>>()
        .join(", ")
}

/// The number of a sweep point with one parameter.
pub(crate) fn point_value(text: &str) -> Option<f64> {
    let (_, value) = text.split_once('=')?;
    value.trim().parse().ok().filter(|v: &f64| v.is_finite())
}

/// A parameter's name as the paper's symbol: `sigma_0` as `σ₀`.
pub(crate) fn symbol(name: &str) -> String {
    if let Some((_, symbol)) = PAPER.iter().find(|(key, _)| *key == name) {
        return (*symbol).to_owned();
    }
    let (stem, index) = name.split_once('_').map_or((name, ""), |(a, b)| (a, b));
    let greek = GREEK.iter().find(|(word, _)| *word == stem).map_or(stem, |(_, letter)| letter);
    let digits: Option<String> = index
        .chars()
        .map(|c| c.to_digit(10).and_then(|d| char::from_u32(u32::from('₀') + d)))
        .collect();
    match digits {
        _ if index.is_empty() => greek.to_owned(),
        Some(digits) => format!("{greek}{digits}"),
        None => format!("{greek}_{index}"),
    }
}

/// A text with the names of Greek letters as letters: `sigma = 1.5; sigma_0 = 2` as `σ = 1.5; σ₀ = 2`.
pub(crate) fn greek(text: &str) -> String {
    text.split(' ').map(symbol).collect::<Vec<_>>().join(" ")
}

/// Keys whose symbol the paper writes with capitals.
const PAPER: &[(&str, &str)] = &[("f_c", "F_C"), ("f_s", "F_S"), ("v_s", "v_S")];

const GREEK: &[(&str, &str)] = &[
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_written_with_the_digits_its_error_leaves() {
        let table: &[(f64, Option<f64>, &str, &str)] = &[
            (1.554_22, Some(2e-16), "J", "1.55422\u{202f}J, error <\u{a0}10⁻¹³"),
            (1.553_958_630_01, Some(2e-16), "J", "1.553958630\u{202f}J, error <\u{a0}10⁻¹³"),
            (1.554_220_345_098, Some(3e-9), "J", "1.554220345 ± 3\u{202f}×\u{202f}10⁻⁹\u{202f}J"),
            (2.6, Some(0.05), "J", "2.60 ± 0.05\u{202f}J"),
            (2.6, Some(0.012), "1", "2.600 ± 0.012"),
            (-1.5, Some(0.2), "", "−1.5 ± 0.2"),
            (-0.001, Some(0.2), "N", "0 ± 0.2\u{202f}N"),
            (1234.0, Some(30.0), "", "1230 ± 30"),
            (1.234e-7, Some(5e-10), "m", "(1.234 ± 0.005)\u{202f}×\u{202f}10⁻⁷\u{202f}m"),
            (3.2e6, Some(1e5), "Pa", "(3.20 ± 0.10)\u{202f}×\u{202f}10⁶\u{202f}Pa"),
            (0.75, None, "N", "0.75\u{202f}N"),
            (1e300, Some(1e-300), "", "10³⁰⁰, error <\u{a0}10⁻¹³"),
            (f64::NAN, Some(1.0), "", "not a number"),
            (0.0, Some(1e-12), "N", "0 ± 10⁻¹²\u{202f}N"),
            (0.0, Some(0.0), "", "0"),
            (2.0, Some(7e-15), "1", "2"),
            (2.0, Some(7e-15), "m", "2\u{202f}m, error <\u{a0}10⁻¹³"),
            (2.0, Some(0.05), "1", "2.00 ± 0.05"),
            (1.0, Some(f64::INFINITY), "", "1"),
        ];
        for (value, error, unit, text) in table {
            assert_eq!(with_error(*value, *error, unit), *text, "{value} {error:?}");
        }
    }

    #[test]
    fn a_claim_shows_four_digits_and_no_error() {
        let table = [
            (1.553_958_629, "J", "1.554\u{202f}J"),
            (-0.02, "m", "−0.02\u{202f}m"),
            (4.000_000_64e-7, "m/s", "4.000\u{202f}×\u{202f}10⁻⁷\u{202f}m/s"),
            (2.0, "1", "2"),
            (f64::INFINITY, "N", "∞"),
        ];
        for (value, unit, text) in table {
            assert_eq!(four_digits(value, unit), text, "{value:e} {unit}");
        }
    }

    #[test]
    fn an_error_has_two_digits_and_round_off_is_named() {
        let table = [
            (None, "–"),
            (Some(0.0), "<\u{a0}10⁻¹³"),
            (Some(3e-16), "<\u{a0}10⁻¹³"),
            (Some(3.21e-7), "3.2\u{202f}×\u{202f}10⁻⁷"),
            (Some(9.96e-7), "1.0\u{202f}×\u{202f}10⁻⁶"),
            (Some(0.0123), "0.012"),
            (Some(1.0), "1.0"),
            (Some(1260.0), "1300"),
            (Some(f64::INFINITY), "∞"),
        ];
        for (value, text) in table {
            assert_eq!(error(value), text);
        }
    }

    #[test]
    fn ticks_counts_and_points_read_as_in_print() {
        assert_eq!(
            [0, 1, 2, -2, -16, 14].map(power_of_ten),
            ["1", "10", "10²", "10⁻²", "10⁻¹⁶", "10¹⁴"]
        );
        assert_eq!(
            [999, 1025, 12_345, 5_000_000].map(count),
            ["999", "1025", "12\u{202f}345", "5\u{202f}000\u{202f}000"]
        );
        assert_eq!(
            [0.25, -1.0, 1e-5, 0.1 + 0.2, 1e5, 33.0].map(short),
            ["0.25", "−1", "10⁻⁵", "0.3", "10⁵", "33"]
        );
        assert_eq!(point("gamma=0.250"), "γ = 0.25");
        assert_eq!(point("sigma_0=1e5, v_s=0.001"), "σ₀ = 10⁵, v_S = 0.001");
        assert_eq!(point(""), "");
        assert_eq!(greek("dahl: f_c = 0.75; sigma = 1.5"), "dahl: F_C = 0.75; σ = 1.5");
        assert_eq!(point_value("gamma=1.5"), Some(1.5));
        assert_eq!(printed(Some(2.6), Some(2), "J"), "2.6\u{202f}J");
        assert_eq!(printed(Some(2.0), Some(3), "1"), "2.00");
    }
}
