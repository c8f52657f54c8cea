//! The rig of P6 with other friction, many times.

use super::{AnchorError, rig_lugre};
use crate::{Task, properties::Draw};
use duhem::Parameters;

/// The keys of what is varied, with the paper's values, as they stand in a table's columns.
const FRICTION: [(&str, f64); 6] = [
    ("f_c", 0.6),
    ("f_s", 1.0),
    ("v_s", 1e-3),
    ("sigma_0", 1e3),
    ("sigma_1", 31.622_776_601_683_793),
    ("sigma_2", 1.3),
];

/// So many rigs with parameters uniform within 30 % of the paper's, the same ones always.
pub fn rigs(count: usize) -> Result<Vec<Task>, AnchorError> {
    let rig = rig_lugre()?.task;
    let mut draw = Draw(4);
    let one = |_| {
        let keys = FRICTION.map(|(key, value)| (key, value * draw.uniform(0.7, 1.3)));
        Task { parameters: keys.into_iter().collect(), ..rig.clone() }
    };
    Ok((0..count).map(one).collect())
}

/// The rigs of a table: a header with the six keys, then a row of six numbers for each.
///
/// # Errors
/// In words, with the line.
pub fn rigs_of(text: &str) -> Result<Vec<Task>, String> {
    let rig = rig_lugre().map_err(|why| why.to_string())?.task;
    let mut lines = (1..).zip(text.lines());
    let expected = FRICTION.map(|(key, _)| key).join(",");
    let header = lines.next().map_or("", |(_, line)| line.trim());
    if header != expected {
        return Err(format!("line 1: found `{header}`, expected `{expected}`"));
    }
    lines
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(number, line)| {
            let values: Option<Vec<f64>> =
                line.split(',').map(|field| field.trim().parse().ok()).collect();
            let values = values.filter(|v| v.len() == FRICTION.len()).ok_or_else(|| {
                format!("line {number}: found `{line}`, expected {} numbers", FRICTION.len())
            })?;
            let keys = FRICTION.iter().map(|(key, _)| *key);
            let parameters: Parameters = keys.zip(values).collect();
            let task = Task { parameters, ..rig.clone() };
            task.friction().map_err(|why| format!("line {number}: {why}"))?;
            Ok(task)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_values_varied_are_those_of_the_anchor() {
        let rig = rig_lugre().unwrap().task;
        let paper: Parameters = FRICTION.into_iter().collect();
        assert_eq!(rig.parameters, paper);
        for task in rigs(50).unwrap() {
            assert!(task.friction().is_ok(), "{:?}", task.parameters);
            assert_ne!(task.parameters, paper);
        }
    }

    #[test]
    fn a_table_is_read_and_what_is_wrong_with_it_is_told_with_the_line() {
        let header = "f_c,f_s,v_s,sigma_0,sigma_1,sigma_2\n";
        let rows = rigs_of(&format!("{header}0.6,1,1e-3,1000,30,1.3\n\n")).unwrap();
        assert_eq!(rows.len(), 1);
        let told = |text: &str| rigs_of(text).unwrap_err();
        assert!(told("a,b\n").starts_with("line 1: found `a,b`, expected `f_c,"));
        assert!(told(&format!("{header}0.6,1,1e-3\n")).starts_with("line 2: "));
        assert!(told(&format!("{header}0.6,1,x,1,1,1\n")).starts_with("line 2: "));
        assert!(told(&format!("{header}-0.6,1,1e-3,1000,30,1.3\n")).starts_with("line 2: f_c"));
    }
}
