//! One measurement as a row of the table.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use crate::timing::Timing;

/// One measurement. An empty cell: does not apply.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// UTC, year-month-day.
    pub date: String,
    /// The name that the processor gives itself.
    pub processor: String,
    /// What is compared.
    pub comparison: &'static str,
    /// The scene.
    pub scene: &'static str,
    /// The library.
    pub system: &'static str,
    /// Its method.
    pub method: String,
    /// Step, number of steps or tolerance.
    pub setting: String,
    /// Length of the run, s.
    pub horizon_s: f64,
    /// The error that was asked for: largest of the measured quantities, in m, m/s, rad and rad/s, at the horizon.
    pub asked_error: Option<f64>,
    /// The error that was had.
    pub error: f64,
    /// Evaluations of the force law in the run.
    pub evaluations: Option<u64>,
    /// Least over the rounds.
    pub ns_per_simulated_second: f64,
    /// Median over the rounds.
    pub median_ns_per_simulated_second: f64,
    /// Least time over ours: above 1 where we lead.
    pub ratio_to_ours: f64,
    /// What to know of it.
    pub note: String,
}

impl Row {
    /// A row without its measurement.
    pub fn new(comparison: &'static str, scene: &'static str, system: &'static str, method: String) -> Self {
        Row {
            date: today(),
            processor: processor(),
            comparison,
            scene,
            system,
            method,
            setting: String::new(),
            horizon_s: f64::NAN,
            asked_error: None,
            error: f64::NAN,
            evaluations: None,
            ns_per_simulated_second: f64::NAN,
            median_ns_per_simulated_second: f64::NAN,
            ratio_to_ours: f64::NAN,
            note: String::new(),
        }
    }

    /// With the time of a run of `horizon_s`, beside ours of the same.
    pub fn timed(mut self, horizon_s: f64, timing: &Timing, ours: &Timing) -> Self {
        self.horizon_s = horizon_s;
        self.ns_per_simulated_second = round(timing.least_ns / horizon_s);
        self.median_ns_per_simulated_second = round(timing.median_ns / horizon_s);
        self.ratio_to_ours = round(timing.least_ns / ours.least_ns);
        self
    }
}

/// Four digits: more than a time is worth.
fn round(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// Writes the rows beside the file and moves them there: whole or not at all.
pub fn write(rows: &[Row], file: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let beside = file.with_extension("csv.new");
    let mut writer = csv::Writer::from_path(&beside)?;
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()?;
    Ok(std::fs::rename(&beside, file)?)
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

/// The civil date of a count of days (H. Hinnant, chrono-compatible low-level date algorithms, 2021).
fn today() -> String {
    let days = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |t| t.as_secs() / 86_400) + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}
