//! The versions a report names are the ones that were built.

#[test]
fn the_stated_versions_are_the_locked_ones() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.lock");
    let lock = std::fs::read_to_string(path).unwrap();
    for (name, version) in integrate::versions() {
        let entry = format!("name = \"{name}\"\nversion = \"{version}\"\n");
        assert!(lock.contains(&entry), "{name} {version} is not what Cargo.lock holds");
    }
}
