//! Dependencies point down only.

use std::process::Command;

use serde_json::Value;

/// The layers from the bottom up; crates of one layer do not know each other.
const LAYERS: [&[&str]; 8] = [
    &["zeroset-ia"],
    &["zeroset-expr"],
    &["zeroset-raycast"],
    &["zeroset-cpu", "zeroset-model", "zeroset-shade"],
    &["zeroset-gpu"],
    &["zeroset-beam"],
    &["zeroset-bench"],
    &["zeroset"],
];

fn layer(name: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&name))
}

/// Every package of the workspace with the names of its dependencies of any kind.
fn packages() -> Vec<(String, Vec<String>)> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline"])
        .args(["--manifest-path", concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml")])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let name = |v: &Value| v["name"].as_str().unwrap().to_owned();
    let all = metadata["packages"].as_array().unwrap().iter();
    all.map(|p| (name(p), p["dependencies"].as_array().unwrap().iter().map(name).collect()))
        .collect()
}

#[test]
fn no_arrow_points_sideways_or_up() {
    let packages = packages();
    assert_eq!(packages.len(), LAYERS.iter().map(|l| l.len()).sum::<usize>(), "{packages:?}");
    let mut arrows = 0;
    for (from, dependencies) in &packages {
        let above = layer(from).unwrap_or_else(|| panic!("{from} is in no layer"));
        for to in dependencies {
            if let Some(below) = layer(to) {
                assert!(below < above, "{from} must not depend on {to}");
                arrows += 1;
            }
        }
    }
    assert!(arrows >= packages.len() - 1, "only {arrows} arrows were found");
}
