//! What does the loop around a step do to its order, its energy and its stability?
//!
//! A user runs a step inside a loop: frames of unequal length, substeps, an accumulator, damping, a velocity that lives half a step
//! away, a clock that is a sum. Each choice is measured against its theory.

pub mod answer;
mod claims;
pub mod clocks;
pub mod contacts;
pub mod growth;
pub mod laws;
pub mod orders;
pub mod published;
mod row;
mod show;

use reports::{Claim, Figure};

pub use row::{Experiment, Row};

use crate::error::Error;
use crate::game_loop::Loop;
use crate::study::{Derived, Selection, Study, check_method, check_steps};
use integrator::methods::MethodId;
use orders::{CHOICES, Choice, METHODS, SCENES, Sweep};
use scenes::any::AnyScene;
use scenes::run::method_from_id;

/// The study.
pub struct Loops;

impl Study for Loops {
    type Row = Row;
    const ID: &'static str = "loops";
    const HEEDS: &'static [&'static str] = &["steps", "for", "loop"];
    const ABOUT: &'static str =
        "Measures what the loop around a step does: uneven frames, substeps, damping, clocks, contacts, half kicks";
    const EXAMPLES: &'static str = "loops
        loops --scene pendulum --method rk4 --loop substeps=4 --loop force=frozen
        loops --scene oscillator --method semi-implicit-euler --loop start=half-kick --loop read=synchronised";
    const TITLE: &'static str = "What does the loop around a step do?";
    const INTRO: &'static str = "A step is used inside a loop, and the loop has errors of its own. Each choice of a loop is run on cases \
        of which theory knows the number, and on scenes with an exact motion, where the order is measured. A force held over a \
        frame makes every method of order 1. An interpolated picture is of order 2 and one step late. A clamp loses time and \
        nothing else. Half a kick at the start makes semi-implicit Euler leapfrog. The rule by which a ball bounces decides \
        whether it gains or loses energy.";

    fn check_selection(selection: &Selection) -> Result<(), Error> {
        let Some(plan) = &selection.looped else { return Ok(()) };
        let runs = selection.scenes.iter().any(|scene| !scene.is_rigid());
        if !runs {
            let message =
                "a loop runs on particles; every scene chosen is a rigid body; give --scene oscillator, or another";
            return Err(Error::plan("--scene", message));
        }
        // Without a step the lengths of time are parts of a frame.
        plan.fits(1.0)?;
        selection.methods.iter().try_for_each(|method| plan.suits(*method))
    }

    fn measure(selection: &Selection) -> Vec<Row> {
        let sweeps = Sweeps::of(selection);
        let jobs = sweeps.jobs(selection);
        let mut rows = selection.rows(&jobs, 2.2e-7, |(_, frames)| *frames, |(sweep, frames)| sweep.rows(&[*frames]));
        if selection.looped.is_none() {
            rows.extend(selection.rows(&[()], 6e-3, |()| 1, |()| laws()));
            rows.extend(growth::rows(selection));
            // The table is part of the program and is read by its tests: a line that cannot be read leaves the claim untested.
            rows.extend(selection.rows(&[()], 9e-3, |()| 1, |()| published::built_in().unwrap_or_default()));
        }
        rows
    }

    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        show::tables(rows)
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        show::figures(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        claims::claims(rows)
    }
    fn check(row: &Row) -> Result<(), String> {
        check_method(&row.method, method_from_id(&row.method).is_ok())?;
        check_steps(row.frames, row.h_s)
    }
}

/// Halvings of the sweeps, from four times the coarsest number of steps of a scene.
const HALVINGS: u32 = 8;

/// The loops that are swept.
struct Sweeps(Vec<Swept>);

/// The name of a loop, its settings, the method if it is for one only, and the orders for a method of order p.
type Swept = (String, Loop, Option<MethodId>, fn(f64) -> [f64; 2]);

impl Sweeps {
    /// The plain loop, and the chosen one or every choice of this study.
    fn of(selection: &Selection) -> Self {
        let built_in = |c: &Choice| (c.name.to_owned(), laws::settings(c.settings), c.only, c.orders);
        Sweeps(match &selection.looped {
            None => CHOICES.iter().map(built_in).collect(),
            Some(plan) => {
                let mut both = vec![built_in(&CHOICES[0])];
                both.push(("yours".to_owned(), plan.clone(), None, |_| [f64::NAN; 2]));
                both
            }
        })
    }

    fn jobs<'a>(&'a self, selection: &'a Selection) -> Vec<(Sweep<'a>, u64)> {
        let mut jobs = Vec::new();
        for scene in selection.scenes.iter().map(AsRef::as_ref).filter(|scene| is_swept(*scene, selection)) {
            let end_s = selection.end_s(scene);
            for method in
                selection.methods.iter().copied().filter(|m| selection.looped.is_some() || METHODS.contains(m))
            {
                for (choice, plan, only, orders) in &self.0 {
                    if only.is_some_and(|only| only != method) {
                        continue;
                    }
                    // The theory of orders is that of smooth scenes of which nothing is special.
                    let orders = orders(f64::from(method.facts().order));
                    let orders = (SCENES.contains(&scene.id()) && orders[0].is_finite()).then_some(orders);
                    let sweep = Sweep { scene, method, choice, plan, orders, end_s };
                    jobs.extend(counts(selection, scene).into_iter().map(|frames| (sweep, frames)));
                }
            }
        }
        jobs
    }
}

fn is_swept(scene: &dyn AnyScene, selection: &Selection) -> bool {
    !scene.is_rigid() && (selection.looped.is_some() || SCENES.contains(&scene.id()))
}

fn counts(selection: &Selection, scene: &dyn AnyScene) -> Vec<u64> {
    if selection.steps.is_empty() {
        (2..=2 + HALVINGS).map(|k| selection.coarsest_steps(scene) << k).collect()
    } else {
        selection.steps.clone()
    }
}

/// Every law on its cases.
fn laws() -> Vec<Row> {
    let (tick, earth) = (1.0 / 60.0, 9.81);
    let mut rows = laws::falls(earth, tick, 60);
    rows.extend(laws::jumps(earth, (2.0 * earth * 0.941_f64).sqrt(), 0.02));
    rows.extend(laws::half_kick());
    rows.extend(laws::leapfrog_energy(1.0, 0.1, 4096));
    for (h_s, substeps) in [(0.1, 1), (0.1, 4), (0.5, 16)] {
        rows.extend(laws::frozen(1.0, h_s, substeps));
    }
    rows.extend([0.2, 0.8].map(|part| laws::jitter(earth, tick, part, 4096)));
    rows.extend(laws::clamp(0.05, 0.032, 200));
    rows.extend(laws::drawn(10.0, earth, tick));
    // A ball that loses energy is watched while a flight lasts for many steps.
    for (gravity, restitution, frames) in [(9.8125, 1.0, 960), (98.1, 1.0, 200), (98.1, 0.9, 100)] {
        rows.extend(contacts::contacts(gravity, restitution, 1.0 / 120.0, frames));
    }
    for h_s in [1.0 / 30.0, tick, 1.0 / 200.0] {
        rows.extend(laws::terminal_speeds(800.0, 30.0, h_s));
    }
    rows.extend(laws::glides(3.0, 2.0, tick));
    rows.extend([(0.3, 21_600.0), (1.0 / 60.0, 3600.0)].map(|(h_s, end_s)| clocks::f32_clock(h_s, end_s)));
    rows.extend([0.4, 0.6, 1.4].map(|part| clocks::f32_position(16_384.0, part)));
    rows.extend([(14.5, 0.05, 0.13), (10.0, 0.05, 0.06)].map(|(omega, a, b)| clocks::in_turn(omega, a, b)));
    rows
}
