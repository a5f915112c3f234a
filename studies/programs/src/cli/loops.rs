//! The flags that ask what a loop does.

use std::path::{Path, PathBuf};

use clap::Args;
use measure::claim::Evidence;
use measure::error::Error;
use measure::loops::answer::{Answer, answer};
use measure::loops::published;
use reports::Table;

use super::Ending;
use crate::options::Common;
use crate::units;

/// A step, for an answer beside the study.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "What to ask")]
pub struct Flags {
    /// The length of a frame, s: an answer about the loop, and no files. Without it the study sweeps the frame, and lengths of time
    /// in --loop are parts of a frame
    #[arg(long = "step", value_name = "S", value_parser = units::seconds, allow_hyphen_values = true)]
    pub step_s: Option<f64>,
    /// Printed numbers in this CSV: does this project reproduce them? Columns as in studies/measure/data/published-loops.csv
    #[arg(long, value_name = "FILE", conflicts_with = "step_s")]
    pub published: Option<PathBuf>,
}

fn printed(path: &Path) -> Result<Ending, Error> {
    let place = path.display().to_string();
    let text = std::fs::read_to_string(path)
        .map_err(|error| Error::plan(&place, format!("cannot be read: {error}; give a table of printed numbers")))?;
    let rows = published::rows(&text, &place)?;
    if rows.is_empty() {
        return Err(Error::plan(place, "holds no printed number; give a line for each"));
    }
    let mut table = Table::new(&["name", "quantity", "printed", "ours", "agrees"], &["printed", "ours"]);
    let mut agree = true;
    for row in &rows {
        let is_same = row.evidence() == Evidence::Inside;
        agree &= is_same;
        let number = |x: Option<f64>| x.map_or_else(|| "diverged".to_owned(), |x| format!("{x:.12}"));
        let verdict = if is_same { "yes" } else { "NO" };
        table.push([
            row.choice.clone(),
            row.quantity.clone(),
            number(row.theory),
            number(row.value),
            verdict.to_owned(),
        ]);
    }
    Ok(Ending { text: table.to_text(), note: None, code: u8::from(!agree) })
}

/// The answer, where a step or a table is given.
pub fn ask(common: &Common, flags: &Flags) -> Option<Result<Ending, Error>> {
    if let Some(path) = &flags.published {
        return Some(common.answers().and_then(|()| printed(path)));
    }
    flags.step_s.map(|step_s| {
        common.answers()?;
        if common.plan.scene.is_empty() {
            return Err(Error::plan(
                "--step",
                "asks about a loop on a scene; give --scene, such as --scene oscillator",
            ));
        }
        let selection = common.selection()?;
        if selection.scenes.iter().all(|scene| scene.is_rigid()) {
            let message =
                "a loop runs on particles; every scene chosen is a rigid body; give --scene oscillator, or another";
            return Err(Error::plan("--scene", message));
        }
        let Answer { text, good } = answer(&selection, step_s)?;
        Ok(Ending { text, note: None, code: u8::from(!good) })
    })
}
