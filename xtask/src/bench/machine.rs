//! Which processor this is.

use std::{collections::BTreeMap, fs};

/// The processor's name with what sets it apart from others of the name, as the system tells it.
pub(super) fn processor() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    named(&text).unwrap_or_else(|| format!("unnamed {}", std::env::consts::ARCH))
}

/// The name in the system's list of processors: the first one's.
fn named(list: &str) -> Option<String> {
    let first = list.split("\n\n").next()?;
    let fields: BTreeMap<&str, &str> = first
        .lines()
        .filter_map(|line| line.split_once(':'))
        .map(|(key, value)| (key.trim(), value.trim()))
        .collect();
    let name = fields.get("model name").or_else(|| fields.get("CPU implementer"))?;
    let told = |key: &&str| fields.get(key).map(|value| format!("{key} {value}"));
    let numbers: Vec<String> =
        ["cpu family", "model", "stepping", "CPU part"].iter().filter_map(told).collect();
    Some(format!("{name} ({})", numbers.join(", ")))
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_processor_is_named_with_its_family_and_model() {
        let list = "processor\t: 0\ncpu family\t: 26\nmodel\t\t: 2\nmodel name\t: Some CPU\n\n\
                    processor\t: 1\nmodel name\t: Another\n";
        assert_eq!(super::named(list).as_deref(), Some("Some CPU (cpu family 26, model 2)"));
        assert_eq!(super::named(""), None);
    }
}
