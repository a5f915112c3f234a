//! Where a report comes from. It is kept apart from the tables and charts, which are the same bytes for the same plan.

use serde::Serialize;

use crate::cli::Common;

#[derive(Serialize)]
struct Manifest {
    version: &'static str,
    commit: &'static str,
    compiler: &'static str,
    target: &'static str,
    processor: String,
    scenes: Vec<String>,
    methods: Vec<String>,
    precisions: Vec<String>,
    set: Vec<String>,
    steps: Vec<u64>,
    quick: bool,
}

fn of(common: &Common) -> Manifest {
    Manifest {
        version: env!("CARGO_PKG_VERSION"),
        commit: env!("STUDIES_COMMIT"),
        compiler: env!("STUDIES_COMPILER"),
        target: env!("STUDIES_TARGET"),
        processor: processor(),
        scenes: common.scene.clone(),
        methods: common.method.clone(),
        precisions: common.precision.clone(),
        set: common.set.clone(),
        steps: common.steps.clone(),
        quick: common.quick,
    }
}

/// The name that the processor gives itself, where the system tells it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

/// The manifest as JSON.
pub(crate) fn manifest(common: &Common) -> String {
    serde_json::to_string_pretty(&of(common)).map_or_else(|error| error.to_string(), |text| text + "\n")
}

/// The same for a reader: name and value.
pub(crate) fn lines(common: &Common) -> Vec<(String, String)> {
    let manifest = of(common);
    let every = |names: Vec<String>| if names.is_empty() { "all".to_owned() } else { names.join(", ") };
    [
        ("version", format!("{} ({})", manifest.version, manifest.commit)),
        ("compiler", format!("{}, {}", manifest.compiler, manifest.target)),
        ("processor", manifest.processor),
        ("scenes", every(manifest.scenes)),
        ("methods", every(manifest.methods)),
        ("precisions", every(manifest.precisions)),
        ("set", manifest.set.join(", ")),
        ("quick", manifest.quick.to_string()),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into_iter()
    .filter(|(_, value)| !value.is_empty())
    .collect()
}
