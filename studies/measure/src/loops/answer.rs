//! The answer to a user's question: what does my loop do to this method on this scene?

use std::fmt::Write;

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Real, Single, State};
use nalgebra::SVector;

use super::orders::{Sweep, order_of};
use super::row::Row;
use crate::error::Error;
use crate::game_loop::description::{Damping, Frames, Loop};
use crate::game_loop::drive::{Job, Seen, Until};
use crate::stability::amplification::Amplification;
use crate::study::{Selection, short};
use scenes::any::AnyScene;
use scenes::erased::{AnyMotion, FlatMotion};
use scenes::invariants::Invariant;

/// Frames that one answer runs, at most.
const MOST_FRAMES: f64 = 1e8;

/// Relative error of the entries of a map that was run in f64: the roundings of some steps. At h omega = 2 its eigenvalues are a
/// defective pair and wrong by the square root of that, which Jury's conditions on the entries are not.
const OF_ENTRIES: f64 = 16.0 * f64::EPSILON;
/// Error of the moduli of larger maps.
const OF_MODULI: f64 = 1e-9;

/// The text of an answer, and whether no loop asked about diverges or lets errors grow.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// For the user to read.
    pub text: String,
    /// False if a run failed or is known to be unstable.
    pub good: bool,
}

/// Answers for every chosen scene of particles and every chosen method, with frames of `step_s`.
///
/// # Errors
/// A loop without a step, or one that a chosen method cannot be used in.
pub fn answer(selection: &Selection, step_s: f64) -> Result<Answer, Error> {
    let plan = selection.looped.clone().unwrap_or_default();
    plan.fits(step_s)?;
    let mut answer = Answer { text: String::new(), good: true };
    for scene in selection.scenes.iter().map(AsRef::as_ref).filter(|scene| !scene.is_rigid()) {
        let end_s = selection.end_s(scene);
        if end_s / plan.mean_s(step_s) > MOST_FRAMES {
            let message =
                format!("{end_s} s hold more than {MOST_FRAMES:e} frames; give a longer step or a shorter --for");
            return Err(Error::plan("--step", message));
        }
        for &method in &selection.methods {
            plan.suits(method)?;
            let (text, good) = match scene.any_motion() {
                AnyMotion::Few(flat) => {
                    Asked { scene, method, plan: &plan, step_s, end_s, n: flat.dimension }.on(flat.motion())
                }
                AnyMotion::Many(flat) => {
                    Asked { scene, method, plan: &plan, step_s, end_s, n: flat.dimension }.on(flat.motion())
                }
                AnyMotion::Pivoted(_) | AnyMotion::Flying(_) => continue,
            };
            answer.text += &text;
            answer.good &= good;
        }
    }
    Ok(answer)
}

struct Asked<'a> {
    scene: &'a dyn AnyScene,
    method: MethodId,
    plan: &'a Loop,
    step_s: f64,
    end_s: f64,
    /// Coordinates of the scene.
    n: usize,
}

/// What a run showed.
struct Shown {
    errors: [f64; 2],
    energy: Option<f64>,
    wall_s: f64,
    simulated_s: f64,
    drawn_s: f64,
}

impl Asked<'_> {
    fn on<const N: usize>(&self, motion: FlatMotion<'_, N>) -> (String, bool) {
        let mut text = String::new();
        let mut line = |said: String| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{said}");
        };
        line(format!("{} with {}, loop: {}", self.scene.id(), self.method.title(), self.plan));
        line(format!(
            "  mean frame {} s, for {} s",
            short(Some(self.plan.mean_s(self.step_s))),
            short(Some(self.end_s))
        ));
        let plain = Loop::default();
        let (ours, theirs) = (self.shown(motion, self.plan), self.shown(motion, &plain));
        let mut good = true;
        match &ours {
            Ok(seen) => {
                for (i, name) in ["configuration", "velocity"].into_iter().enumerate() {
                    let beside = theirs
                        .as_ref()
                        .map_or_else(|step| format!("fails at step {step}"), |s| short(Some(s.errors[i])));
                    line(format!(
                        "  error of the {name} at the end: {} (plain loop: {beside})",
                        short(Some(seen.errors[i]))
                    ));
                }
                if let Some(energy) = seen.energy {
                    let beside = theirs.as_ref().ok().and_then(|s| s.energy);
                    line(format!(
                        "  energy at the end - exact: {} J (plain loop: {})",
                        short(Some(energy)),
                        short(beside)
                    ));
                }
                let lost = seen.wall_s - seen.simulated_s;
                if lost > 1e-9 * seen.wall_s {
                    line(format!(
                        "  time: the simulation is {} s behind, {} % of {} s",
                        short(Some(lost)),
                        short(Some(100.0 * lost / seen.wall_s)),
                        short(Some(seen.wall_s))
                    ));
                }
                if seen.drawn_s != seen.simulated_s {
                    let ahead = seen.drawn_s - seen.simulated_s;
                    line(format!(
                        "  drawn: {} s {} the last step; the error is that at the drawn time",
                        short(Some(ahead.abs())),
                        if ahead < 0.0 { "before" } else { "after" }
                    ));
                }
            }
            Err(step) => {
                good = false;
                line(format!("  DIVERGED at step {step}"));
            }
        }
        line(format!("  order, by halving every length of time: {}", self.orders(motion)));
        if self.plan.damping != Damping::None {
            line(
                "  the exact motion has no damping of the loop: the error holds what the damping is meant to do"
                    .to_owned(),
            );
        }
        match self.factor(motion) {
            Some((factor, false, frames)) => {
                good = false;
                line(format!(
                    "  NOT stable: an error grows by a factor of {factor:.6} per {frames} frame{}",
                    if frames == 1 { "" } else { "s" }
                ));
            }
            Some((factor, true, frames)) => line(format!(
                "  stable: an error changes by a factor of {factor:.6} per {frames} frame{}",
                if frames == 1 { "" } else { "s" }
            )),
            None => line(
                "  stability: not known for this loop on this scene (not linear, or no repeating pattern)".to_owned(),
            ),
        }
        (text, good)
    }

    fn job<'a, const N: usize>(
        &self,
        motion: &'a FlatMotion<'a, N>,
        plan: &'a Loop,
        start: State<SVector<f64, N>>,
    ) -> Job<'a, FlatMotion<'a, N>, N> {
        Job { model: motion, method: self.method, plan, h_s: self.step_s, start }
    }

    fn shown<const N: usize>(&self, motion: FlatMotion<'_, N>, plan: &Loop) -> Result<Shown, u64> {
        let mean = plan.mean_s(self.step_s);
        let frames = (self.end_s / mean).round().max(1.0) as u64;
        let seen: Seen<N> = self
            .job(&motion, plan, motion.exact(0.0))
            .run(Until::Frames(frames), |_| {})
            .map_err(|diverged| diverged.step)?;
        let exact = motion.exact(seen.drawn_s);
        let energy = |s: &State<SVector<f64, N>>| {
            let entries = self.scene.scene().invariants(fx128::lit(seen.drawn_s), &motion.observe(s));
            let found = entries.iter().find(|entry| entry.invariant == Invariant::Energy)?;
            Some(found.value.first()?.to_f64())
        };
        Ok(Shown {
            errors: [(seen.state.q - exact.q).norm(), (seen.state.v - exact.v).norm()],
            energy: energy(&seen.state).zip(energy(&exact)).map(|(a, b)| a - b),
            wall_s: seen.wall_s,
            simulated_s: seen.simulated_s,
            drawn_s: seen.drawn_s,
        })
    }

    /// The orders that runs with every length of time halved again and again show.
    fn orders<const N: usize>(&self, motion: FlatMotion<'_, N>) -> String {
        // An error as large as the motion says nothing about the step.
        let seen: Vec<State<SVector<f64, N>>> =
            (0..16).map(|i| motion.exact(self.end_s * f64::from(i) / 15.0)).collect();
        let largest =
            |size: fn(&State<SVector<f64, N>>) -> f64| seen.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
        let unit = self.plan.scaled(1.0 / self.step_s);
        let sweep = Sweep {
            scene: self.scene,
            method: self.method,
            choice: "yours",
            plan: &unit,
            orders: None,
            end_s: self.end_s,
        };
        let first = (self.end_s / self.plan.mean_s(self.step_s)).round().max(1.0);
        let counts: Vec<u64> = (0..8).map(|k| (first as u64) << k).filter(|n| *n <= 1 << 22).collect();
        let rows = sweep.rows(&counts);
        let of = |quantity: &str, scale: f64| {
            let own: Vec<&Row> = rows.iter().filter(|row| row.quantity == quantity).collect();
            let order = order_of(&own, scale);
            order.slope.map_or_else(|| "not seen".to_owned(), |slope| format!("{slope:.2}"))
        };
        let (q, v) = (largest(|s| s.q.norm()), largest(|s| s.v.norm()));
        format!("configuration {}, velocity {}", of("configuration", q), of("velocity", v))
    }

    /// The spectral radius of the frames of one pattern, whether they are stable, and how many they are; `None` where they are no linear map, or repeat nothing.
    fn factor<const N: usize>(&self, motion: FlatMotion<'_, N>) -> Option<(f64, bool, u64)> {
        let frames = match &self.plan.frames {
            Frames::Uniform => 1,
            Frames::Pattern(lengths) => lengths.len() as u64,
            Frames::Jitter { .. } => return None,
        };
        let is_smooth = self.scene.scene().nonsmooth_times_s(self.end_s).is_empty();
        if self.plan.inner_s.is_some() || !is_smooth {
            return None;
        }
        let start = motion.exact(0.0);
        let n = self.n;
        let moved = |j: usize, by: f64| -> Option<Vec<f64>> {
            let mut s = start;
            if j < n {
                s.q[j] += by;
            } else {
                s.v[j - n] += by;
            }
            let end = self.job(&motion, self.plan, s).run(Until::Frames(frames), |_| {}).ok()?.state;
            Some((0..n).map(|i| end.q[i]).chain((0..n).map(|i| end.v[i])).collect())
        };
        let origin = moved(0, 0.0)?;
        let mut columns = Vec::new();
        for j in 0..2 * n {
            let column = |by: f64| Some(moved(j, by)?.iter().zip(&origin).map(|(a, b)| a - b).collect::<Vec<f64>>());
            let (one, far) = (column(1.0)?, column(-64.0)?);
            let size = one.iter().chain(&origin).fold(1.0_f64, |sum, x| sum.max(x.abs()));
            if one.iter().zip(&far).any(|(a, b)| (b + 64.0 * a).abs() > 1e-9 * 64.0 * size) {
                return None;
            }
            columns.push(one);
        }
        let entries = (0..4 * n * n).map(|at| fx128::lit(columns[at % (2 * n)][at / (2 * n)])).collect();
        let map = Amplification { n: 2 * n, entries };
        Some((map.spectral_radius()?, map.is_stable_to(OF_ENTRIES, OF_MODULI)?, frames))
    }
}
