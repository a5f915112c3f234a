//! Where a report comes from. It is kept apart from the tables and charts, which are the same bytes for the same plan, but for times.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::plan::Plan;
use measure::error::Error;

/// What measured the rows of a report, and by which plan. A page needs nothing but this and the rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the workspace.
    pub version: String,
    /// Commit it was built from.
    pub commit: String,
    /// Compiler it was built with.
    pub compiler: String,
    /// Machine it was built for.
    pub target: String,
    /// Processor it ran on, by the name that the processor gives itself.
    pub processor: String,
    /// What was run.
    pub plan: Plan,
}

/// The file among a report's that holds it.
pub const MANIFEST: &str = "manifest.json";
/// The file among a report's that holds its plan alone, to be run again.
pub const PLAN: &str = "plan.toml";

impl Manifest {
    /// Of rows that this program measures.
    pub fn of(plan: &Plan) -> Self {
        Manifest {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("STUDIES_COMMIT").to_owned(),
            compiler: env!("STUDIES_COMPILER").to_owned(),
            target: env!("STUDIES_TARGET").to_owned(),
            processor: processor(),
            plan: plan.clone(),
        }
    }

    /// Of rows that lie in a directory.
    ///
    /// # Errors
    /// A manifest that is missing, or is not one: with line and column.
    pub fn read(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(MANIFEST);
        let text = read(&path)?;
        serde_json::from_str(&text).map_err(|error| {
            let place = format!("{}:{}:{}", path.display(), error.line(), error.column());
            let said = error.to_string();
            let said = said.split(" at line ").next().unwrap_or_default().to_owned();
            Error::plan(place, format!("{said}; put the file back as a run wrote it, or run again"))
        })
    }

    /// As JSON.
    ///
    /// # Errors
    /// None that is known: every field has a form in JSON.
    pub fn to_json(&self) -> Result<String, Error> {
        let text = serde_json::to_string_pretty(self).map_err(|error| Error::plan(MANIFEST, error.to_string()))?;
        Ok(text + "\n")
    }

    /// The same for a reader: name and value.
    pub fn lines(&self) -> Vec<(String, String)> {
        let every = |names: &[String]| if names.is_empty() { "all".to_owned() } else { names.join(", ") };
        let plan = &self.plan;
        let steps: Vec<String> = plan.steps.iter().map(u64::to_string).collect();
        [
            ("version", format!("{} ({})", self.version, self.commit)),
            ("compiler", format!("{}, {}", self.compiler, self.target)),
            ("processor", self.processor.clone()),
            ("scene", every(&plan.scene)),
            ("method", every(&plan.method)),
            ("precision", every(&plan.precision)),
            ("set", plan.set.join(", ")),
            ("steps", steps.join(", ")),
            ("quick", plan.quick.to_string()),
            ("run again", format!("cargo run --release -- --plan {PLAN}")),
        ]
        .map(|(name, value)| (name.to_owned(), value))
        .into_iter()
        .filter(|(_, value)| !value.is_empty())
        .collect()
    }
}

/// The text of a file of an earlier run.
///
/// # Errors
/// A file that cannot be read.
pub fn read(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(|error| {
        let message =
            format!("cannot be read: {error}; --from takes a directory that a run of the same program has written");
        Error::plan(path.display().to_string(), message)
    })
}

/// The name that the processor gives itself, where the system tells it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
