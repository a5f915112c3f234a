//! The parts of a run, each in a directory of its own, put together.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use measure::error::Error;
use measure::shard;
use measure::study::Study;

use crate::provenance::{MANIFEST, Manifest, SCHEMA, ShardSeal, unbroken};

/// The file of a study's rows in a shard's directory: in the order of the work, with every column.
pub(crate) fn file_of(study: &str) -> String {
    format!("{study}.rows.csv")
}

/// Every part of one run.
pub(crate) struct Shards {
    /// In the order of their numbers.
    parts: Vec<(PathBuf, Manifest, ShardSeal)>,
}

impl Shards {
    /// The parts in these directories.
    ///
    /// # Errors
    /// A directory that holds no part, a part of another run or of another program, one that is missing or there twice.
    pub(crate) fn read(directories: &[PathBuf]) -> Result<Self, Error> {
        let mut parts: Vec<(PathBuf, Manifest, ShardSeal)> = Vec::new();
        for directory in directories {
            let manifest = Manifest::read(directory)?;
            let at = |message: String| Error::plan(directory.join(MANIFEST).display().to_string(), message);
            let Some(seal) = manifest.shard.clone() else {
                return Err(at(
                    "a whole run, not a part of one; give directories that --shard K/N has written".to_owned()
                ));
            };
            if let Some((first, theirs, their_seal)) = parts.first() {
                let first = first.display();
                let build = |m: &Manifest| format!("{} ({}, {}, {})", m.version, m.commit, m.compiler, m.target);
                let differ = [
                    ("program", seal.program.clone(), their_seal.program.clone()),
                    ("plan", manifest.plan_sha256.clone(), theirs.plan_sha256.clone()),
                    ("build", build(&manifest), build(theirs)),
                    ("number of shards", seal.count.to_string(), their_seal.count.to_string()),
                ];
                if let Some((what, ours, theirs)) = differ.into_iter().find(|(_, ours, theirs)| ours != theirs) {
                    let message = format!("another {what} than {first}: {ours}, not {theirs}");
                    return Err(at(format!("{message}; give the shards of one run")));
                }
                if let Some((other, ..)) = parts.iter().find(|(_, _, other)| other.index == seal.index) {
                    let message =
                        format!("shard {}/{} is there twice: also in {}", seal.index, seal.count, other.display());
                    return Err(at(format!("{message}; leave one out")));
                }
            }
            parts.push((directory.clone(), manifest, seal));
        }
        let Some((_, _, ShardSeal { count, .. })) = parts.first() else {
            return Err(Error::plan("merge", "needs the directories of all shards; give them"));
        };
        let missing: Vec<String> = (1..=*count)
            .filter(|index| !parts.iter().any(|(_, _, seal)| seal.index == *index))
            .map(|index| format!("{index}/{count}"))
            .collect();
        if !missing.is_empty() {
            let message =
                format!("shard {} is missing; run it with --shard, or give its directory", missing.join(", "));
            return Err(Error::plan("merge", message));
        }
        parts.sort_by_key(|(_, _, seal)| seal.index);
        Ok(Shards { parts })
    }

    /// The program that ran them.
    pub(crate) fn program(&self) -> &str {
        &self.parts[0].2.program
    }

    /// What one run would have written of itself.
    pub(crate) fn manifest(&self) -> Manifest {
        let first = &self.parts[0].1;
        let mut processors: Vec<&str> = self.parts.iter().map(|(_, manifest, _)| manifest.processor.as_str()).collect();
        processors.sort_unstable();
        processors.dedup();
        Manifest { shard: None, rows: BTreeMap::new(), processor: processors.join("; "), ..first.clone() }
    }

    /// The rows of a study in the order of one run.
    ///
    /// # Errors
    /// A file that is missing, truncated or another than was written, with its name.
    pub(crate) fn rows_of<S: Study>(&self) -> Result<Vec<S::Row>, Error> {
        let name = file_of(S::ID);
        let mut all = Vec::new();
        for (directory, manifest, seal) in &self.parts {
            let path = directory.join(&name);
            let place = path.display().to_string();
            let known = manifest.rows.get(&name).zip(seal.studies.get(S::ID));
            let Some((file, part)) = known else {
                let message = format!("{MANIFEST} of schema {SCHEMA} does not list it; run this shard again");
                return Err(Error::plan(place, message));
            };
            let text = unbroken(&path, file)?;
            let rows: Vec<S::Row> = reports::read_csv(&text, &place)?;
            for (line, row) in (2..).zip(&rows) {
                S::check(row).map_err(|message| Error::plan(format!("{place}:{line}"), message))?;
            }
            all.push((part.clone(), rows));
        }
        shard::in_order(all)
            .map_err(|message| Error::plan(S::ID, format!("{message}: the shards were given out otherwise")))
    }
}

/// Whether a directory holds the run of this manifest whole: the same plan, build and part, and every file of rows as it was written.
pub(crate) fn is_whole(directory: &Path, wanted: &Manifest, shard: Option<(usize, usize)>, program: &str) -> bool {
    let Ok(found) = Manifest::read(directory) else { return false };
    let same_part = match (&found.shard, shard) {
        (None, None) => true,
        (Some(seal), Some((index, count))) => {
            (seal.program.as_str(), seal.index, seal.count) == (program, index, count)
        }
        _ => false,
    };
    let same =
        |m: &Manifest| (m.plan.clone(), m.version.clone(), m.commit.clone(), m.compiler.clone(), m.target.clone());
    same_part
        && same(&found) == same(wanted)
        && !found.rows.is_empty()
        && found.rows.iter().all(|(name, seal)| unbroken(&directory.join(name), seal).is_ok())
}
