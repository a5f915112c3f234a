//! What a choice does to the order: a sweep of the frame on scenes with an exact motion.

use integrator::methods::MethodId;
use integrator::{State, Vector};
use nalgebra::SVector;

use super::row::{Experiment, Row};
use crate::game_loop::description::Loop;
use crate::game_loop::drive::{Job, Until};
use crate::order::{Expected, Limits, Order, Sample, observe};
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, FlatMotion};
use scenes::run::Outcome;

/// A choice, the settings that make it where a frame lasts 1 s, and the orders of configuration and velocity for a method of order p.
pub struct Choice {
    /// Its name.
    pub name: &'static str,
    /// The settings for frames of 1 s.
    pub settings: &'static [&'static str],
    /// The method, where it makes sense for one only.
    pub only: Option<MethodId>,
    /// The two orders.
    pub orders: fn(f64) -> [f64; 2],
}

/// Every choice of the sweeps.
pub const CHOICES: [Choice; 7] = [
    Choice { name: "plain", settings: &[], only: None, orders: |p| [p, p] },
    Choice { name: "four fresh substeps", settings: &["substeps=4"], only: None, orders: |p| [p, p] },
    Choice {
        name: "four substeps, force frozen",
        settings: &["substeps=4", "force=frozen"],
        only: None,
        orders: |_| [1.0, 1.0],
    },
    Choice { name: "uneven frames", settings: &["frames=0.5,1.5"], only: None, orders: |p| [p, p] },
    Choice {
        name: "interpolated",
        settings: &["inner=0.75", "drawn=interpolated"],
        only: None,
        orders: |p| [p.min(2.0), p.min(2.0)],
    },
    Choice {
        name: "half a kick at the start",
        settings: &["start=half-kick"],
        only: Some(MethodId::SemiImplicitEuler),
        orders: |_| [2.0, 1.0],
    },
    Choice {
        name: "half a kick at the start and when read",
        settings: &["start=half-kick", "read=synchronised"],
        only: Some(MethodId::SemiImplicitEuler),
        orders: |_| [2.0, 2.0],
    },
];

/// The methods of the sweeps.
pub const METHODS: [MethodId; 4] =
    [MethodId::ExplicitEuler, MethodId::SemiImplicitEuler, MethodId::VelocityVerlet, MethodId::Rk4];

/// The scenes whose orders are those of the methods: nothing is special about them.
pub const SCENES: [&str; 3] = ["oscillator", "pendulum", "kepler"];

/// One sweep.
#[derive(Clone, Copy)]
pub struct Sweep<'a> {
    /// The scene.
    pub scene: &'a dyn AnyScene,
    /// The method.
    pub method: MethodId,
    /// The name of the choice.
    pub choice: &'a str,
    /// The settings for frames of 1 s.
    pub plan: &'a Loop,
    /// The orders that theory predicts, of configuration and velocity.
    pub orders: Option<[f64; 2]>,
    /// The length of the runs, s.
    pub end_s: f64,
}

impl Sweep<'_> {
    /// The errors at the end of runs of so many frames, against the exact motion at the time that what is drawn belongs to.
    pub fn rows(&self, frames: &[u64]) -> Vec<Row> {
        frames.iter().flat_map(|&n| self.run(n)).collect()
    }

    fn run(&self, frames: u64) -> Vec<Row> {
        match self.scene.any_motion() {
            AnyMotion::Few(flat) => self.on(flat.motion(), frames),
            AnyMotion::Many(flat) => self.on(flat.motion(), frames),
            AnyMotion::Pivoted(_) | AnyMotion::Flying(_) => Vec::new(),
        }
    }

    fn on<const N: usize>(&self, motion: FlatMotion<'_, N>, frames: u64) -> Vec<Row>
    where
        SVector<f64, N>: Vector<f64>,
    {
        let h_s = self.end_s / frames as f64;
        let plan = self.plan.scaled(h_s);
        let start: State<SVector<f64, N>> = motion.exact(0.0);
        let job = Job { model: &motion, method: self.method, plan: &plan, h_s, start };
        let end = job.run(Until::Frames(frames), |_| {}).ok();
        let errors = end.map(|seen| {
            let exact = motion.exact(seen.drawn_s);
            [(seen.state.q - exact.q).norm(), (seen.state.v - exact.v).norm()]
        });
        let outcome = if errors.is_some() { Outcome::Finished } else { Outcome::Diverged };
        let quantities = [("configuration", 0), ("velocity", 1)];
        let row = |(quantity, i): (&str, usize)| Row {
            experiment: Experiment::Error,
            choice: self.choice.to_owned(),
            settings: self.plan.to_string(),
            subject: self.scene.id().to_owned(),
            method: self.method.id().to_owned(),
            h_s,
            frames,
            quantity: quantity.to_owned(),
            unit: String::new(),
            value: errors.map(|e| e[i]),
            theory: None,
            tolerance: None,
            theory_order: self.orders.map(|orders| orders[i]),
            outcome,
        };
        quantities.map(row).to_vec()
    }
}

/// The order that the rows of one sweep and quantity show; an error of the size `saturation` says nothing about the step.
pub fn order_of(rows: &[&Row], saturation: f64) -> Order {
    let mut samples: Vec<Sample> =
        rows.iter().map(|row| Sample { h_s: row.h_s, error: row.value, floor: 0.0 }).collect();
    samples.sort_by(|a, b| b.h_s.total_cmp(&a.h_s));
    let expected = rows.first().and_then(|row| row.theory_order).unwrap_or(1.0);
    // A quarter: a neighbouring order is 1 away, and the drift of the window's slope is in the interval.
    observe(
        &samples,
        Expected::Order { order: expected, tolerance: 0.25 },
        Limits { rounding_unit: f64::EPSILON * saturation, saturation },
    )
}
