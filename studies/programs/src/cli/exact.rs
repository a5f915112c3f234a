//! `exact`: the exact motion of a scene, for another program.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Ending, ProgramInfo};
use crate::exact;
use crate::options::{threads, use_threads};
use crate::units;
use measure::error::Error;
use measure::study::Length;

/// What the binary says of itself.
pub const WORDS: ProgramInfo = ProgramInfo {
    name: "exact",
    about: "Prints the exact motion of a scene as CSV, or with --case as JSON what sets the same case up in another program",
    examples: "exact --scene tennis-racket --rate 60 --for 2
        exact --scene pendulum --at 0,0.5,1 --set angle=2.5
        exact --scene kepler --times my_run.csv --out exact.csv
        exact --scene heavy-top --case
        exact list                                         scenes",
};

/// Of what, and when.
#[derive(Args, Clone, Debug)]
pub struct Flags {
    /// Scene, or scene/preset
    #[arg(long, value_name = "ID", required = true)]
    scene: Vec<String>,

    /// A parameter of the scene; may be given again
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// Times in a second [default: 60]
    #[arg(long, value_name = "HZ", value_parser = positive, help_heading = "When")]
    rate: Option<f64>,

    /// Last time: seconds, 2min, or 10rev of the scene's own period [default: the horizon of the scene]
    #[arg(long = "for", value_name = "TIME", value_parser = length, help_heading = "When")]
    length: Option<Length>,

    /// These times, s
    #[arg(long, value_name = "T1,T2,...", help_heading = "When", conflicts_with_all = ["rate", "length", "times"])]
    at: Option<String>,

    /// The times in the first column of FILE
    #[arg(long, value_name = "FILE", help_heading = "When", conflicts_with_all = ["rate", "length"])]
    times: Option<PathBuf>,

    /// Print the case instead: parameters, start, units, frames, columns
    #[arg(long, conflicts_with_all = ["rate", "length", "at", "times"])]
    case: bool,

    /// Write to FILE instead of the terminal
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Threads to run on [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads, allow_hyphen_values = true)]
    threads: Option<usize>,
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
    number.ok_or_else(|| "not a finite number above zero".to_owned())
}

fn length(text: &str) -> Result<Length, String> {
    units::length(text, "seconds, such as 2.5, or 2min, or 10rev")
}

/// More records than a reader of CSV takes.
const MOST: f64 = 2e7;

/// Does what the flags ask for.
///
/// # Errors
/// An unknown scene or parameter; times that are none, or at which the motion is not known; a file that cannot be read or written.
pub fn run(flags: &Flags) -> Result<Ending, Error> {
    use_threads(flags.threads)?;
    let [id] = &flags.scene[..] else {
        return Err(Error::plan("--scene", "several are given; give one"));
    };
    let plan = crate::plan::Plan { scene: vec![id.clone()], set: flags.set.clone(), ..Default::default() };
    let scene = plan.selection()?.scenes.remove(0);
    let text = if flags.case {
        format!("{:#}\n", exact::case(scene.as_ref()))
    } else {
        let times = match (&flags.at, &flags.times) {
            (Some(list), _) => at(list)?,
            (None, Some(path)) => in_file(path)?,
            (None, None) => {
                let length = flags.length.unwrap_or(Length::Seconds(scene.scene().info().horizon_s));
                evenly(flags.rate.unwrap_or(60.0), length.end_s(scene.as_ref())?)?
            }
        };
        exact::csv(scene.as_ref(), &times)?
    };
    let Some(path) = &flags.out else { return Ok(Ending { text, note: None, code: 0 }) };
    std::fs::write(path, text).map_err(|error| {
        Error::plan(path.display().to_string(), format!("cannot be written: {error}; give another path"))
    })?;
    Ok(Ending { text: String::new(), note: Some(format!("exact: {}", path.display())), code: 0 })
}

fn evenly(rate: f64, end_s: f64) -> Result<Vec<f64>, Error> {
    let last = (rate * end_s * (1.0 + 1e-12)).floor();
    if last > MOST {
        return Err(Error::plan("--rate", format!("{last:e} records are too many; give a smaller --rate or --for")));
    }
    Ok((0..=last as u64).map(|i| i as f64 / rate).collect())
}

fn time(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|t: &f64| t.is_finite() && *t >= 0.0)
}

fn at(list: &str) -> Result<Vec<f64>, Error> {
    let parse = |text: &str| {
        time(text)
            .ok_or_else(|| Error::plan("--at", format!("'{text}' is no time; give seconds from 0 on, as 0,0.5,1")))
    };
    list.split(',').map(parse).collect()
}

/// The first field of every line, after a header and comments.
fn in_file(path: &Path) -> Result<Vec<f64>, Error> {
    let place = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| {
        Error::plan(&place, format!("cannot be read: {error}; give a text with a time at the start of each line"))
    })?;
    let lines = (1..).zip(text.lines()).map(|(number, line)| (number, line.trim().trim_start_matches('\u{feff}')));
    let mut times = Vec::new();
    let mut first = true;
    for (number, line) in lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')) {
        let field = line.split([',', ';', '\t', ' ']).next().unwrap_or_default().trim_matches('"');
        let is_header = std::mem::take(&mut first) && field.parse::<f64>().is_err();
        match time(field) {
            Some(t) => times.push(t),
            None if is_header => {}
            None => {
                let message = format!("'{field}' is no time; the first column has seconds from 0 on");
                return Err(Error::plan(format!("{place}:{number}:1"), message));
            }
        }
    }
    if times.is_empty() {
        return Err(Error::plan(place, "no times; the first column has seconds, one time a line"));
    }
    Ok(times)
}
