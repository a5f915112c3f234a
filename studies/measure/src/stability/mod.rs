//! Where do methods fail? Largest stable steps, measured and held against theory; what happens beyond them.

pub mod amplification;
pub mod answer;
pub mod bisect;
pub mod claims;
pub use scenes::displaced;
pub mod failure;
mod figures;
pub mod frames;
pub mod limits;
pub mod maps;
pub mod models;
mod nonlinear;
mod pictures;
pub mod spin;
mod tables;
pub mod trend;

pub use nonlinear::UNCONDITIONAL;

use reports::{Claim, Figure};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::study::{Derived, Kind, Selection, Study};
use failure::Failure;
use maps::{Grid, MapRow};
use models::Scheme;
use scenes::any::AnyScene;
use scenes::run::Precision;
use scenes::stepping::Stepping;
use spin::SpinScheme;

/// The columns that every kind of row has.
macro_rules! columns {
    ($part:literal: $own:literal) => {
        Kind { part: $part, columns: concat!("scene,method,precision,quantity,unit,", $own) }
    };
}

/// What a row belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// The largest stable step of a method on a linear scene.
    Limit,
    /// Growth in one step of a method without a stable step.
    GrowthRate,
    /// What the methods without a limit do at large steps.
    Unconditional,
    /// A cell of the damped oscillator's map: 1 bounded, 0 not.
    DampedMap,
    /// A cell of the spinning body's map: the nutation factor of one step.
    SpinMap,
    /// A cell of the complex plane: |R(h lambda)|.
    Region,
    /// A cell of Kepler's map: orbits survived.
    KeplerMap,
    /// Limits of quadratic drag.
    QuadraticDrag,
    /// The largest step of a pendulum against its amplitude.
    PendulumAmplitude,
    /// When a free body blows up.
    BlowUp,
    /// The energy of a bouncing ball.
    Ball,
    /// A point of a picture of a failure.
    Picture,
}

impl Part {
    /// Its name, as in a file's name.
    pub fn id(self) -> &'static str {
        match self {
            Part::Limit => "limit",
            Part::GrowthRate => "growth-rate",
            Part::Unconditional => "unconditional",
            Part::DampedMap => "damped-map",
            Part::SpinMap => "spin-map",
            Part::Region => "region",
            Part::KeplerMap => "kepler-map",
            Part::QuadraticDrag => "quadratic-drag",
            Part::PendulumAmplitude => "pendulum-amplitude",
            Part::BlowUp => "blow-up",
            Part::Ball => "ball",
            Part::Picture => "picture",
        }
    }
}

/// One measurement. What is measured, and its unit, stand in `quantity` and `unit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What the row belongs to.
    pub part: Part,
    /// Scene, or what is looked at in its place.
    pub scene: String,
    /// Method, or scheme.
    pub method: String,
    /// Arithmetic.
    pub precision: Precision,
    /// Step, s.
    #[serde(default)]
    pub h_s: Option<f64>,
    /// Step over the natural time scale of the scene: h omega, k h.
    #[serde(default)]
    pub h_omega: Option<f64>,
    /// What else was varied, with its unit; empty for nothing.
    #[serde(default)]
    pub parameter: String,
    /// Its value.
    #[serde(default)]
    pub value: Option<f64>,
    /// What was measured.
    pub quantity: String,
    /// Unit of the measured numbers.
    pub unit: String,
    /// Low end of a bracket: the largest step that held.
    #[serde(default)]
    pub low: Option<f64>,
    /// High end of a bracket: the smallest step that failed.
    #[serde(default)]
    pub high: Option<f64>,
    /// What was measured, where it is one number.
    #[serde(default)]
    pub measured: Option<f64>,
    /// What theory says (0: no step is stable; inf: every step is).
    #[serde(default)]
    pub theory: Option<f64>,
    /// The same by a closed form, where there is one.
    #[serde(default)]
    pub closed_form: Option<f64>,
    /// What goes wrong: beyond the limit, or at this point.
    #[serde(default)]
    pub failure: Failure,
    /// Steps taken.
    #[serde(default)]
    pub steps: u64,
    /// Where the theory comes from.
    #[serde(default)]
    pub note: String,
}

impl Row {
    fn new(part: Part, scene: &str, method: &str, precision: Precision, quantity: &str, unit: &str) -> Self {
        Row {
            part,
            scene: scene.to_owned(),
            method: method.to_owned(),
            precision,
            h_s: None,
            h_omega: None,
            parameter: String::new(),
            value: None,
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            low: None,
            high: None,
            measured: None,
            theory: None,
            closed_form: None,
            failure: Failure::None,
            steps: 0,
            note: String::new(),
        }
    }
}

/// The study.
pub struct Stability;

impl Study for Stability {
    type Row = Row;
    const ID: &'static str = "stability";
    const HEEDS: &'static [&'static str] = &["precision"];
    const ABOUT: &'static str = "Measures the largest stable step of methods on scenes and compares it with theory. Given --step or --rate, or both \
        --scene and --method, it prints an answer for these and writes no files";
    const EXAMPLES: &'static str =
        "stability                                                      the whole study, into target/stability/
        stability --scene damped-oscillator --method semi-implicit-euler --set zeta=0.1
        stability --scene oscillator --method velocity-verlet --step 0.01 --rate 60
        stability --scene oscillator --method semi-implicit-euler --frames 0.05,0.13";
    const TITLE: &'static str = "Where does it break? Stability limits";
    const INTRO: &'static str = "The largest stable step of every method on every linear scene, found by bisection on the \
        running scene and held against the amplification matrix and the closed forms; maps of where a method holds; and one \
        picture for each way in which it can fail.";

    const KINDS: &'static [Kind] = &[
        columns!("limit": "low,high,theory,closed_form,failure,steps,note"),
        columns!("growth-rate": "h_s,h_omega,measured,theory,failure,steps,note"),
        columns!("unconditional": "h_s,h_omega,measured,theory,failure,steps"),
        columns!("damped-map": "h_omega,parameter,value,measured,theory,failure"),
        columns!("spin-map": "h_omega,parameter,value,measured,theory,failure"),
        columns!("region": "h_omega,parameter,value,measured,theory"),
        columns!("kepler-map": "h_omega,parameter,value,measured,failure"),
        columns!("quadratic-drag": "low,high,theory,failure,steps,note"),
        columns!("pendulum-amplitude": "parameter,value,low,high,theory,failure,steps,note"),
        columns!("blow-up": "h_s,measured,theory,failure,steps,note"),
        columns!("ball": "h_s,measured,failure,steps"),
        columns!("picture": "parameter,value,measured,failure"),
    ];

    fn part(row: &Row) -> &'static str {
        row.part.id()
    }

    fn measure(selection: &Selection) -> Vec<Row> {
        let jobs = jobs(selection);
        selection.rows(&jobs, 2.8e-3, Job::cost, Job::rows)
    }
    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        tables::all(rows)
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        figures::all(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        claims::all(rows)
    }
}

/// The part of a scene's name before its preset.
fn base(id: &str) -> &str {
    id.split('/').next().unwrap_or(id)
}

enum Job<'a> {
    Limit(Stepping<'a>),
    Map(MapRow, Grid, usize),
    Unconditional,
    Nonlinear(Vec<&'static str>),
    Pictures(Vec<&'static str>),
}

fn jobs(selection: &Selection) -> Vec<Job<'_>> {
    let mut jobs = Vec::new();
    for scene in &selection.scenes {
        for &method in &selection.methods {
            for &precision in selection.precisions.iter().filter(|p| **p != Precision::DoubleDouble) {
                if !selection.quick || precision == Precision::F64 {
                    jobs.push(Job::Limit(Stepping { scene: scene.as_ref(), method, precision }));
                }
            }
        }
    }
    let bases: Vec<&'static str> = selection.scenes.iter().map(|scene| base(scene.id())).collect();
    for map in maps_of(&bases) {
        let grid = if selection.quick { map.grid().coarse() } else { map.grid() };
        jobs.extend((0..grid.ny).map(|j| Job::Map(map, grid, j)));
    }
    if bases.contains(&"oscillator") {
        jobs.push(Job::Unconditional);
    }
    jobs.extend(
        bases_once(&bases).into_iter().flat_map(|base| [Job::Nonlinear(vec![base]), Job::Pictures(vec![base])]),
    );
    jobs
}

fn bases_once(bases: &[&'static str]) -> Vec<&'static str> {
    crate::study::distinct(bases.iter().copied())
}

/// The maps that belong to the chosen scenes.
fn maps_of(bases: &[&str]) -> Vec<MapRow> {
    let mut maps = Vec::new();
    if bases.contains(&"damped-oscillator") {
        maps.extend(Scheme::ALL.map(MapRow::Damped));
    }
    if bases.contains(&"oscillator") {
        maps.extend(maps::ONE_STEP.map(MapRow::Region));
    }
    if bases.contains(&"torque-free-spin") || bases.contains(&"symmetric-top") {
        maps.extend(SpinScheme::ALL.map(MapRow::Spin));
    }
    if bases.contains(&"kepler") {
        maps.extend(maps::ORBITING.map(MapRow::Kepler));
    }
    maps
}

impl Job<'_> {
    fn cost(&self) -> u64 {
        match self {
            Job::Nonlinear(_) | Job::Pictures(_) => 10,
            Job::Limit(stepping) => 1 + dimension_cost(stepping.scene),
            Job::Map(MapRow::Kepler(_), ..) => 5,
            _ => 1,
        }
    }

    fn rows(&self) -> Vec<Row> {
        match self {
            Job::Limit(stepping) => limits::rows(stepping),
            Job::Map(map, grid, j) => map.rows(grid, *j),
            Job::Unconditional => nonlinear::unconditional_rows(),
            Job::Nonlinear(bases) => nonlinear::rows(|base| bases.contains(&base)),
            Job::Pictures(bases) => pictures::rows(|base| bases.contains(&base)),
        }
    }
}

fn dimension_cost(scene: &dyn AnyScene) -> u64 {
    scenes::stepping::dimension(scene) as u64
}
