//! The command line of `audit`.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, ValueEnum};

use crate::subject::Settings;
use crate::trajectory::readings::OmegaFrame;
use crate::{Args, Choices, Error, Report};

/// Judges trajectories that another program computed, from their files
#[derive(Parser)]
#[command(
    name = "audit",
    version,
    after_help = "\
Examples:
  audit run.csv                                              clock and kinematics
  audit run.csv --inertia 1.25,0.75,1.75                     and conservation
  audit run.csv --scene torque-free-spin --inertia 1.25,0.75,1.75
  audit h60.csv h120.csv --scene spring-3d --set stiffness=12.5 --set mass=3

Exit codes: 0 no fault, 1 a fault or a broken bound, 2 wrong input."
)]
struct Flags {
    /// Files: text tables with one row for each time; several are one motion with different steps
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// What moves
    #[arg(long, value_name = "NAME", help_heading = "The body")]
    scene: Option<String>,
    /// A parameter of the scene; the start is the first row
    #[arg(long, value_name = "NAME=VALUE", help_heading = "The body")]
    set: Vec<String>,
    /// Principal moments of inertia, kg m^2
    #[arg(long, value_name = "A,B,C", help_heading = "The body")]
    inertia: Option<String>,
    /// Steps of the engine between two rows [default: found]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..), help_heading = "The file")]
    record_every: Option<u64>,
    /// Names of the columns in order, as t,x,y,z,qw,qx,qy,qz; - leaves one out
    #[arg(long, value_name = "NAMES", allow_hyphen_values = true, help_heading = "The file")]
    columns: Option<String>,
    /// The unit of a column or a quantity, as t=ms or angular-velocity=deg/s
    #[arg(long, value_name = "COLUMN=UNIT", help_heading = "The file")]
    unit: Vec<String>,
    /// The axes of the angular velocity
    #[arg(long, value_enum, help_heading = "The file")]
    frame: Option<Frame>,
    /// Read the first N rows only
    #[arg(long, value_name = "N", help_heading = "The file")]
    rows: Option<usize>,
    /// The largest error of a position (m) or an attitude (rad)
    #[arg(long, value_name = "X")]
    max_error: Option<f64>,
    /// Write JSON to FILE; - is the terminal
    #[arg(long, value_name = "FILE", help_heading = "What to write")]
    json: Option<PathBuf>,
    /// Write Markdown to FILE; - is the terminal
    #[arg(long, value_name = "FILE", help_heading = "What to write")]
    markdown: Option<PathBuf>,
    /// Write JUnit XML to FILE; - is the terminal
    #[arg(long, value_name = "FILE", help_heading = "What to write")]
    junit: Option<PathBuf>,
    /// Write audit.csv and audit.json to DIR
    #[arg(long, value_name = "DIR", help_heading = "What to write")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Frame {
    World,
    Body,
}

/// Judges the files that the arguments name; the first argument is the name of the program.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let flags = match Flags::try_parse_from(arguments) {
        Ok(flags) => flags,
        Err(error) => {
            let code = u8::try_from(error.exit_code()).unwrap_or(2);
            // A closed terminal is no reason to fail twice.
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    match perform(&flags) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "audit: {error}");
            ExitCode::from(2)
        }
    }
}

/// A report as text.
type Form = fn(&Report) -> String;

fn perform(flags: &Flags) -> Result<u8, Error> {
    let report = crate::run(&args(flags)?)?;
    let forms: [(&Option<PathBuf>, Form); 3] =
        [(&flags.json, Report::json), (&flags.markdown, Report::markdown), (&flags.junit, Report::junit)];
    let mut printed = false;
    for (path, form) in forms {
        match path {
            Some(path) if path.as_os_str() == "-" => {
                say(&form(&report));
                printed = true;
            }
            Some(path) => write(path, &form(&report))?,
            None => {}
        }
    }
    if let Some(out) = &flags.out {
        std::fs::create_dir_all(out).map_err(|source| Error::File { path: out.clone(), source })?;
        write(&out.join("audit.csv"), &report.csv())?;
        write(&out.join("audit.json"), &report.json())?;
    }
    if !printed {
        say(&report.text());
    }
    Ok(report.exit_code())
}

fn say(text: &str) {
    // A reader that closes the pipe has seen enough.
    let _ = std::io::stdout().write_all(text.as_bytes());
}

fn write(path: &std::path::Path, text: &str) -> Result<(), Error> {
    std::fs::write(path, text).map_err(|source| Error::File { path: path.to_owned(), source })
}

fn args(flags: &Flags) -> Result<Args, Error> {
    let inertia = flags.inertia.as_deref().map(crate::subject::inertia).transpose()?;
    let columns = flags.columns.as_ref().map(|c| c.split(',').map(|name| name.trim().to_owned()).collect());
    let frame = flags.frame.map(|f| match f {
        Frame::World => OmegaFrame::World,
        Frame::Body => OmegaFrame::Body,
    });
    Ok(Args {
        files: flags.files.clone(),
        choices: Choices { columns, units: pairs("--unit", &flags.unit)?, omega_frame: frame, rows: flags.rows },
        settings: Settings { scene: flags.scene.clone(), set: pairs("--set", &flags.set)?, inertia },
        record_every: flags.record_every,
        max_error: flags.max_error,
    })
}

fn pairs(flag: &'static str, texts: &[String]) -> Result<Vec<(String, String)>, Error> {
    let pair = |text: &String| {
        let parts = text.split_once('=').map(|(a, b)| (a.trim().to_owned(), b.trim().to_owned()));
        parts.ok_or_else(|| Error::Flag { flag, message: format!("'{text}' is not of the form NAME=VALUE") })
    };
    texts.iter().map(pair).collect()
}
