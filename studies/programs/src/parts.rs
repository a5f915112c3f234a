//! A part of a run, and what a run would be: the work without its pages.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

use integrator::methods::MethodId;
use measure::adequacy::Adequacy;
use measure::convergence::Convergence;
use measure::drift::DriftStudy;
use measure::ensemble::Ensemble;
use measure::error::Error;
use measure::loops::Loops;
use measure::rotation::Rotation;
use measure::shard::Shard;
use measure::stability::Stability;
use measure::study::{Selection, Study};
use measure::tradeoff::Tradeoff;
use reports::OutputDir;
use scenes::run::{Precision, Run};

use crate::options::Common;
use crate::provenance::{MANIFEST, Manifest, PLAN, ShardSeal};
use crate::shards::file_of;

/// The program of the whole report, and its directory below `target/`.
pub const REPORT: &str = "report";

/// Something to be done with every study of a program.
pub(crate) trait Each {
    /// Does it with one.
    fn on<S: Study>(&mut self) -> Result<(), Error>;
}

/// Goes through the studies of a program: of the report those of its page.
///
/// # Errors
/// The first of `on`, or a program without studies.
pub(crate) fn each(program: &str, on: &mut impl Each) -> Result<(), Error> {
    let mut any = false;
    macro_rules! go {
        ($is_in_report:expr, $($study:ty),*) => {$(
            if program == <$study>::ID || ($is_in_report && program == REPORT) {
                any = true;
                on.on::<$study>()?;
            }
        )*};
    }
    go!(true, Convergence, DriftStudy, Rotation, Adequacy, Stability, Loops, Tradeoff);
    go!(false, Ensemble);
    if any { Ok(()) } else { Err(Error::plan("program", format!("'{program}' runs no study"))) }
}

/// A selection that takes part `index` of `count`.
fn part_of(common: &Common, index: usize, count: usize) -> Result<(Selection, Arc<Shard>), Error> {
    let shard = Arc::new(Shard::new(index, count));
    Ok((Selection { shard: Some(Arc::clone(&shard)), ..common.selection()? }, shard))
}

struct Measured {
    selection: Selection,
    shard: Arc<Shard>,
    files: Vec<(String, Vec<u8>)>,
    seal: ShardSeal,
}

impl Each for Measured {
    fn on<S: Study>(&mut self) -> Result<(), Error> {
        S::check_selection(&self.selection)?;
        self.selection.progress.name(S::ID);
        let rows = S::measure(&self.selection);
        let (part, _) = self.shard.finish();
        self.files.push((file_of(S::ID), reports::write_csv(&rows)?.into_bytes()));
        self.seal.studies.insert(S::ID.to_owned(), part);
        Ok(())
    }
}

/// Does a part of the work of a program and writes its rows with plan and manifest; says what it wrote.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub(crate) fn shard(common: &Common, program: &str, (index, count): (usize, usize)) -> Result<String, Error> {
    let (selection, shard) = part_of(common, index, count)?;
    let out = OutputDir::create(common.out(program))?;
    let seal = ShardSeal { program: program.to_owned(), index, count, studies: BTreeMap::new() };
    let mut measured = Measured { selection, shard, files: Vec::new(), seal };
    each(program, &mut measured)?;
    let Measured { mut files, seal, .. } = measured;
    let rows: usize = seal.studies.values().flat_map(|part| &part.taken).map(|taken| taken.rows).sum();
    let manifest = Manifest { shard: Some(seal), ..Manifest::of(&common.plan).sealed(&files)? };
    files.push((PLAN.to_owned(), manifest.plan.to_toml()?.into_bytes()));
    files.push((MANIFEST.to_owned(), manifest.to_json()?.into_bytes()));
    out.replace_all(program, &files)?;
    Ok(format!("shard {index}/{count}: {rows} rows in {}\n", out.path().display()))
}

struct Counted {
    selection: Selection,
    shard: Arc<Shard>,
    lines: Vec<(&'static str, usize, f64)>,
}

impl Each for Counted {
    fn on<S: Study>(&mut self) -> Result<(), Error> {
        S::check_selection(&self.selection)?;
        // No group of work belongs to the shard 0: the work is listed and not done.
        let _ = S::measure(&self.selection);
        let (part, seconds) = self.shard.finish();
        self.lines.push((S::ID, part.groups, seconds));
        Ok(())
    }
}

/// A shard that takes less than this, s, is not worth its start.
const SHARD_S: f64 = 120.0;
/// Steps of the run by which this machine is compared, and the time that it took where the costs were measured, s.
const TRIAL: (u64, f64) = (400_000, TRIAL_S);
const TRIAL_S: f64 = 0.0265;

/// How much work a program would do: groups, seconds of one core, time on this machine, a number of shards.
///
/// # Errors
/// Bad input.
pub(crate) fn forecast(common: &Common, program: &str) -> Result<String, Error> {
    let (selection, shard) = part_of(common, 0, 1)?;
    let mut counted = Counted { selection, shard, lines: Vec::new() };
    each(program, &mut counted)?;
    let slowness = slowness();
    let threads = rayon::current_num_threads();
    let mut text = String::from("study          groups of work   seconds of one core\n");
    let (mut groups, mut seconds) = (0, 0.0);
    for (study, its_groups, its_seconds) in counted.lines {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{study:<14} {its_groups:>14}   {:>19.1}", its_seconds * slowness);
        groups += its_groups;
        seconds += its_seconds * slowness;
    }
    let _ = writeln!(text, "{:<14} {groups:>14}   {seconds:>19.1}", "all");
    let shards = ((seconds / threads as f64 / SHARD_S).ceil() as usize).clamp(1, groups.max(1));
    let _ = writeln!(
        text,
        "\nabout {:.0} s on {threads} threads of this machine, the timing of steps not counted; suggested: {shards} shard{}",
        seconds / threads as f64,
        if shards == 1 { "" } else { "s" }
    );
    Ok(text)
}

/// By what factor this machine is slower than the one on which the costs were measured: the least of three runs.
fn slowness() -> f64 {
    let Ok(scene) = scenes::by_id("pendulum") else { return 1.0 };
    let run = Run::new(MethodId::Rk4, Precision::F64, 100.0, TRIAL.0);
    let time = || {
        let start = Instant::now();
        let _ = scene.run(&run, TRIAL.0);
        start.elapsed().as_secs_f64()
    };
    (0..3).map(|_| time()).fold(f64::INFINITY, f64::min) / TRIAL.1
}

/// Refuses what a single study has no use for.
///
/// # Errors
/// As [`crate::plan::Plan::heeded`], and schemes for rigid bodies.
pub(crate) fn heeds<S: Study>(common: &Common) -> Result<(), Error> {
    common.plan.heeded(S::ID, S::HEEDS)?;
    refuse_schemes::<S>(&common.plan.selection()?)
}

/// Refuses a scheme for rigid bodies where the study has no use for one.
///
/// # Errors
/// The scheme, with the studies that take it.
pub(crate) fn refuse_schemes<S: Study>(selection: &Selection) -> Result<(), Error> {
    let refused = selection.schemes.first().filter(|_| !S::TAKES_SCHEMES);
    refused.map_or(Ok(()), |scheme| {
        let (id, study) = (scheme.id(), S::ID);
        let message = format!("{id} moves rigid bodies only; `rotation` and `tradeoff` take it, `{study}` does not");
        Err(Error::plan("--method", message))
    })
}
