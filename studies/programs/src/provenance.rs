//! Where a report comes from. It is kept apart from the tables and charts, which are the same bytes for the same plan, but for times.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::plan::Plan;
use measure::error::Error;
use measure::files::{self, RowFile};
use measure::shard::Part;
use measure::study::Study;

/// What measured the rows of a report, and by which plan. A page needs nothing but this and the rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the columns of all rows: another one has other columns, or the same with another meaning.
    pub schema: u32,
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
    /// SHA-256 of the plan as TOML, in hexadecimal digits.
    #[serde(default)]
    pub plan_sha256: String,
    /// The part of the work that was done, where it was a part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<ShardSeal>,
    /// The files of rows, by name.
    #[serde(default)]
    pub rows: BTreeMap<String, Seal>,
}

/// What a file of rows is known by.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seal {
    /// Number of its rows.
    pub rows: usize,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

/// What a part of the work is known by.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShardSeal {
    /// The program that ran it: `report`, or the name of a study.
    pub program: String,
    /// Which part, from 1 to `count`.
    pub index: usize,
    /// How many parts there are.
    pub count: usize,
    /// What each study did.
    pub studies: BTreeMap<String, Part>,
}

/// The version of the columns that this program writes, and the only one that it reads.
pub const SCHEMA: u32 = 2;

/// The files of rows, one a study.
const STUDIES: [&str; 8] =
    ["convergence", "drift", "rotation", "adequacy", "stability", "loops", "tradeoff", "ensemble"];

const REMEDY: &str = "put the file back as a run wrote it, or run again";

fn sha256(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

#[derive(Deserialize)]
struct Version {
    schema: u32,
    version: String,
}

/// The file among a report's that holds it.
pub const MANIFEST: &str = "manifest.json";
/// The file among a report's that holds its plan alone, to be run again.
pub const PLAN: &str = "plan.toml";

impl Manifest {
    /// Of rows that this program measures.
    pub fn of(plan: &Plan) -> Self {
        Manifest {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("STUDIES_COMMIT").to_owned(),
            compiler: env!("STUDIES_COMPILER").to_owned(),
            target: env!("STUDIES_TARGET").to_owned(),
            processor: processor(),
            plan: plan.clone(),
            plan_sha256: String::new(),
            shard: None,
            rows: BTreeMap::new(),
        }
    }

    /// The same with the seals of the plan and of the rows among these files.
    ///
    /// # Errors
    /// As [`Plan::to_toml`].
    pub fn sealed(self, files: &[(String, Vec<u8>)]) -> Result<Self, Error> {
        let is_rows = |name: &str| {
            name.strip_suffix(".csv")
                .and_then(|name| name.split('.').next())
                .is_some_and(|study| STUDIES.contains(&study))
        };
        let seal = |(name, bytes): &(String, Vec<u8>)| {
            let rows = bytes.iter().filter(|byte| **byte == b'\n').count().saturating_sub(1);
            (name.clone(), Seal { rows, sha256: sha256(bytes) })
        };
        let rows = files.iter().filter(|(name, _)| is_rows(name)).map(seal).collect();
        Ok(Manifest { plan_sha256: sha256(self.plan.to_toml()?.as_bytes()), rows, ..self })
    }

    /// The rows of one study in a directory, if they are those that this manifest was written with.
    ///
    /// # Errors
    /// Rows that cannot be read, that no run writes, or that are not those of the manifest: with file and line.
    pub fn rows_of<S: Study>(&self, directory: &Path) -> Result<Vec<S::Row>, Error> {
        let files = files::of::<S>();
        let listed: Vec<&RowFile> = files.iter().filter(|file| self.rows.contains_key(&file.name)).collect();
        if listed.is_empty() {
            let manifest = directory.join(MANIFEST).display().to_string();
            let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
            let message = format!("rows: none of {} is among them; {REMEDY}", names.join(", "));
            return Err(Error::plan(manifest, message));
        }
        let mut rows = Vec::new();
        for file in listed {
            rows.extend(self.rows_in::<S>(file, directory)?);
        }
        Ok(rows)
    }

    /// The rows of one file.
    fn rows_in<S: Study>(&self, file: &RowFile, directory: &Path) -> Result<Vec<S::Row>, Error> {
        let path = directory.join(&file.name);
        let place = path.display().to_string();
        let at = |line: usize, message: String| Error::plan(format!("{place}:{line}"), format!("{message}; {REMEDY}"));
        let text = read(&path)?;
        let rows: Vec<S::Row> = file.read::<S>(&text, &place)?;
        let header = file.header::<S>(&rows)?;
        if !rows.is_empty() && text.lines().next() != Some(&header) {
            return Err(at(1, format!("the columns are not those of schema {SCHEMA}, {header}")));
        }
        for (line, row) in (2..).zip(&rows) {
            S::check(row).map_err(|message| at(line, message))?;
        }
        let seal = &self.rows[&file.name];
        if seal.rows != rows.len() {
            let message = format!("{} rows where {MANIFEST} counts {}", rows.len(), seal.rows);
            return Err(at(text.lines().count().max(1), message));
        }
        let found = sha256(text.as_bytes());
        if found != seal.sha256 {
            let message = format!("not the file that {MANIFEST} describes: SHA-256 {found}, not {}", seal.sha256);
            return Err(at(1, message));
        }
        Ok(rows)
    }

    /// Of rows that lie in a directory.
    ///
    /// # Errors
    /// A manifest that is missing, or is not one: with line and column.
    pub fn read(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(MANIFEST);
        let text = read(&path)?;
        let wrong = |error: serde_json::Error| {
            let place = format!("{}:{}:{}", path.display(), error.line(), error.column());
            let said = error.to_string();
            let said = said.split(" at line ").next().unwrap_or_default().to_owned();
            Error::plan(place, format!("{said}; {REMEDY}"))
        };
        // Another schema may have other keys, too: it is looked at first.
        let line = |key: &str| 1 + text.lines().take_while(|line| !line.contains(key)).count();
        if let Ok(Version { schema, version }) = serde_json::from_str(&text)
            && schema != SCHEMA
        {
            let place = format!("{}:{}", path.display(), line("\"schema\""));
            let message = format!("rows of schema {schema}, and this program reads schema {SCHEMA}");
            let remedy = format!("run again, or read them with the version that wrote them, {version}");
            return Err(Error::plan(place, format!("{message}; {remedy}")));
        }
        let manifest: Manifest = serde_json::from_str(&text).map_err(wrong)?;
        if manifest.plan_sha256 != sha256(manifest.plan.to_toml()?.as_bytes()) {
            let place = format!("{}:{}", path.display(), line("\"plan\""));
            return Err(Error::plan(place, format!("not the plan that the rows were measured by; {REMEDY}")));
        }
        Ok(manifest)
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

/// Whether a file is the one that its seal describes.
///
/// # Errors
/// A file that cannot be read or is another, with what is wrong.
pub(crate) fn unbroken(path: &Path, seal: &Seal) -> Result<String, Error> {
    let text = read(path)?;
    let (found, rows) = (sha256(text.as_bytes()), text.matches('\n').count().saturating_sub(1));
    if found == seal.sha256 {
        return Ok(text);
    }
    let message = if rows == seal.rows {
        format!("not the file that {MANIFEST} describes: SHA-256 {found}, not {}", seal.sha256)
    } else {
        format!("{rows} rows where {MANIFEST} counts {}", seal.rows)
    };
    Err(Error::plan(path.display().to_string(), format!("{message}; run this shard again")))
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
