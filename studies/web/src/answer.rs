//! Answers: runs of `studies`' scenes as rows of numbers.

use std::fmt::Write;

use faer::fx128;
use integrator::{Real, Single};
use scenes::any::AnyScene;
use scenes::error::Error;
use scenes::errors;
use scenes::errors::ExactSamples;
use scenes::observation::{Observation, Value};
use scenes::run::{Outcome, Precision, Trajectory};
use scenes::scheme::Rule;
use scenes::stepping::{Stepping, spectral_radius};

use crate::loops;
use crate::question::{Command, Question};

/// The numbers before the rows of a run: outcome (0 finished, 1 diverged, 2 not converged), the step that failed (0 for
/// none), evaluations, numbers in a row.
pub const HEAD: usize = 4;

/// Answers questions, and keeps the scene of the last one with its exact motion.
#[derive(Default)]
pub struct Desk {
    loaded: Option<Loaded>,
}

struct Loaded {
    id: String,
    set: Vec<(String, String)>,
    scene: Box<dyn AnyScene>,
    truth: Option<ExactSamples>,
}

impl Desk {
    /// Answers a question with numbers; what they are is written to `message` where it is asked for.
    ///
    /// # Errors
    /// A question that cannot be read, or does not fit the scene.
    pub fn answer(&mut self, text: &str, message: &mut String) -> Result<Vec<f64>, Error> {
        let question = Question::read(text)?;
        let loaded = self.load(&question)?;
        let scene = loaded.scene.as_ref();
        match question.command {
            Command::Describe => {
                *message = describe(scene);
                Ok(Vec::new())
            }
            Command::Run => Ok(rows(scene, &question, &trajectory(scene, &question)?)),
            Command::Exact => Ok(exact(scene, &question)),
            Command::Errors => loaded.errors(&question),
            Command::Amplification => amplification(scene, &question),
        }
    }

    fn load(&mut self, question: &Question) -> Result<&mut Loaded, Error> {
        let kept = self.loaded.take().filter(|kept| kept.id == question.scene && kept.set == question.set);
        let loaded = match kept {
            Some(kept) => kept,
            None => {
                let mut all = scenes::taught();
                let place = all.iter().position(|scene| scene.id() == question.scene).ok_or_else(|| {
                    Error::unknown("scene", &question.scene, all.iter().map(|scene| scene.id().to_owned()))
                })?;
                let mut scene = all.swap_remove(place);
                for (name, value) in &question.set {
                    scene.scene_mut().set(&question.scene, name, value)?;
                }
                scene.scene().check()?;
                Loaded { id: question.scene.clone(), set: question.set.clone(), scene, truth: None }
            }
        };
        Ok(self.loaded.insert(loaded))
    }
}

fn trajectory(scene: &dyn AnyScene, question: &Question) -> Result<Trajectory, Error> {
    if question.half_kick {
        return loops::half_kick(scene, question);
    }
    if question.jitter > 0.0 {
        return loops::jittered(scene, question);
    }
    scene
        .run(&question.run(), question.stride)
        .ok_or_else(|| Error::plan("step", "exists for rigid bodies only; ask with 'method'"))
}

/// Head, then a row of step, time and what [`observed`] gives.
fn rows(scene: &dyn AnyScene, question: &Question, run: &Trajectory) -> Vec<f64> {
    let mut numbers = head(run);
    let h_s = question.end_s / question.steps as f64;
    let times = if question.jitter > 0.0 { loops::times(question) } else { Vec::new() };
    for (step, seen) in &run.seen {
        let first = numbers.len();
        let t_s = times.get(*step as usize).copied().unwrap_or(*step as f64 * h_s);
        numbers.extend([*step as f64, t_s]);
        observed(scene, fx128::lit(t_s), seen, &mut numbers);
        numbers[HEAD - 1] = (numbers.len() - first) as f64;
    }
    numbers
}

fn head(run: &Trajectory) -> Vec<f64> {
    let outcome = match run.outcome {
        Outcome::Finished => 0.0,
        Outcome::Diverged => 1.0,
        Outcome::NotConverged => 2.0,
    };
    vec![outcome, run.failed_step.unwrap_or(0) as f64, run.evaluations as f64, 0.0]
}

/// Every component of every quantity (an attitude as w, x, y, z), then of every invariant.
fn observed(scene: &dyn AnyScene, t: fx128, seen: &Observation, numbers: &mut Vec<f64>) {
    for (_, value) in &seen.values {
        match value {
            Value::Vector(components) => numbers.extend(components.iter().map(|x| x.to_f64())),
            Value::Rotation(q) => numbers.extend([q.w, q.v.x, q.v.y, q.v.z].map(Single::to_f64)),
        }
    }
    for entry in scene.scene().invariants(t, seen) {
        numbers.extend(entry.value.iter().map(|x| x.to_f64()));
    }
}

fn exact(scene: &dyn AnyScene, question: &Question) -> Vec<f64> {
    let mut numbers = vec![0.0; HEAD];
    for k in 0..=question.steps {
        let first = numbers.len();
        let t = fx128::lit(question.end_s) * fx128::lit(k as f64) / fx128::lit(question.steps as f64);
        numbers.extend([k as f64, t.to_f64()]);
        observed(scene, t, &scene.exact(t), &mut numbers);
        numbers[HEAD - 1] = (numbers.len() - first) as f64;
    }
    numbers
}

impl Loaded {
    /// Head, then for each quantity the error at the end and the largest at the checkpoints, and the same of rounding; NaN
    /// where there is none, or where it was not asked for.
    fn errors(&mut self, question: &Question) -> Result<Vec<f64>, Error> {
        let scene = self.scene.as_ref();
        let truth = self.truth.get_or_insert_with(|| ExactSamples::of(scene, scene.scene().info().horizon_s));
        let stride = if question.checkpoints { errors::stride(question.steps) } else { question.steps };
        let end_s = scene.scene().info().horizon_s;
        let run = |precision| trajectory(scene, &Question { end_s, stride, precision, ..question.clone() });
        let own = run(question.precision)?;
        let exact = if question.rounding { Some(run(Precision::DoubleDouble)?) } else { None };
        let compared = truth.compare(scene, question.steps, &own, exact.as_ref().unwrap_or(&own));
        let mut numbers = head(&own);
        numbers[HEAD - 1] = 4.0;
        let asked = |x: Option<f64>, wanted: bool| x.filter(|_| wanted).unwrap_or(f64::NAN);
        for e in compared {
            numbers.extend([asked(e.end, true), asked(e.max, question.checkpoints)]);
            numbers.extend([asked(e.rounding_end, question.rounding)]);
            numbers.extend([asked(e.rounding_max, question.rounding && question.checkpoints)]);
        }
        Ok(numbers)
    }
}

/// Head, then step length and spectral radius.
fn amplification(scene: &dyn AnyScene, question: &Question) -> Result<Vec<f64>, Error> {
    let Rule::General(method) = question.rule else { return Err(Error::plan("step", "ask with a 'method'")) };
    let stepping = Stepping { scene, method, precision: question.precision };
    let mut numbers = vec![0.0, 0.0, 0.0, 2.0];
    for k in 1..=question.steps {
        let h_s = question.end_s * k as f64 / question.steps as f64;
        let radius = spectral_radius(&stepping, h_s)
            .ok_or_else(|| Error::plan("scene", "has no two-by-two amplification matrix; ask about an oscillator"))?;
        numbers.extend([h_s, radius]);
    }
    Ok(numbers)
}

/// Lines of tab-separated fields: the scene, its parameters, quantities and invariants.
fn describe(scene: &dyn AnyScene) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |fields: &[&str]| writeln!(text, "{}", fields.join("\t")).unwrap_or_default();
    let stated = scene.scene();
    let info = stated.info();
    line(&["about", info.about]);
    line(&["source", info.source]);
    line(&["horizon_s", &info.horizon_s.to_string()]);
    line(&["time_scale_s", &info.time_scale_s.to_string()]);
    for p in stated.parameters() {
        line(&["parameter", p.name, p.unit, p.about, &p.value, &p.range.to_string()]);
    }
    let start = scene.exact(fx128::ZERO);
    for (quantity, value) in &start.values {
        let width = match value {
            Value::Vector(components) => components.len(),
            Value::Rotation(_) => 4,
        };
        line(&["quantity", quantity.id(), quantity.unit(), &width.to_string()]);
    }
    for entry in stated.invariants(fx128::ZERO, &start) {
        let conserved = if entry.conserved { "conserved" } else { "changing" };
        line(&["balance", entry.invariant.id(), entry.invariant.unit(), &entry.value.len().to_string(), conserved]);
    }
    text
}
