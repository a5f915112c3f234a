//! Runs as a loop makes them: with steps that vary, or with half a kick before the first step and after the last.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Real, Single};
use scenes::any::AnyScene;
use scenes::error::Error;
use scenes::observation::{Observation, Value};
use scenes::run::{Outcome, Trajectory};
use scenes::scheme::Rule;
use scenes::stepping::{Stepping, coordinates};

use crate::question::Question;

/// The times of the steps, s: evenly spaced, or with lengths h (1 + `jitter` u), u uniform in [-1, 1), scaled to the same end.
pub(crate) fn times(question: &Question) -> Vec<f64> {
    let length = |i: u64| 1.0 + question.jitter * uniform(i);
    let sum: f64 = (0..question.steps).map(length).sum();
    let mut at = 0.0;
    let mut times = vec![0.0];
    for i in 0..question.steps {
        at += length(i);
        times.push(question.end_s * (at / sum));
    }
    times
}

/// A number in [-1, 1) for each step, always the same (the finalizer of SplitMix64: G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014).
fn uniform(step: u64) -> f64 {
    let mut z = (step + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 * (-52.0_f64).exp2() - 1.0
}

fn stepping<'a>(scene: &'a dyn AnyScene, question: &Question, key: &str) -> Result<Stepping<'a>, Error> {
    let Rule::General(method) = question.rule else { return Err(Error::plan(key, "ask with a 'method'")) };
    if question.half_kick && method != MethodId::SemiImplicitEuler {
        return Err(Error::plan(key, "half a kick makes another method of semi-implicit Euler alone"));
    }
    if !scene.scene().nonsmooth_times_s(question.end_s).is_empty() {
        return Err(Error::plan(key, "the motion has kinks; ask about another scene"));
    }
    Ok(Stepping { scene, method, precision: question.precision })
}

fn curved(key: &str) -> Error {
    Error::plan(key, "runs on flat scenes; ask about another scene")
}

/// Steps between which something is seen.
fn seen_steps(question: &Question) -> Vec<u64> {
    let mut steps: Vec<u64> = (0..=question.steps).step_by(question.stride as usize).collect();
    if !question.steps.is_multiple_of(question.stride) {
        steps.push(question.steps);
    }
    steps
}

/// v'0 = v0 - h a0 / 2; v'n+1 = v'n + h an, qn+1 = qn + h v'n+1; vn = (v'n + v'n+1) / 2. Without forces that depend on the
/// velocity it is velocity Verlet.
pub(crate) fn half_kick(scene: &dyn AnyScene, question: &Question) -> Result<Trajectory, Error> {
    let (key, steps) = ("half_kick", question.steps);
    let stepping = stepping(scene, question, key)?;
    let h_s = question.end_s / steps as f64;
    let first = stepping.walk(h_s, 1, &[], &[0, 1]).ok_or_else(|| curved(key))?;
    let [before, after] = match &first.seen[..] {
        [(_, before), (_, after)] => [before, after].map(coordinates),
        // Not even one step.
        _ => return Ok(first),
    };
    let half = before.len() / 2;
    let kick = |i: usize| (after[i] - before[i]).to_f64();
    let displacement: Vec<f64> = (0..2 * half).map(|i| if i < half { 0.0 } else { -0.5 * kick(i) }).collect();
    let wanted = seen_steps(question);
    let mut samples: Vec<u64> = wanted.iter().flat_map(|&step| [step, step + 1]).collect();
    samples.dedup();
    let run = stepping.walk(h_s, steps + 1, &displacement, &samples);
    let run = run.ok_or_else(|| curved(key))?;
    let pairs = run.seen.windows(2).filter(|pair| wanted.binary_search(&pair[0].0).is_ok());
    let seen = pairs.map(|pair| (pair[0].0, read_back(&pair[0].1, &pair[1].1))).collect();
    Ok(Trajectory { seen, evaluations: steps + 1, ..run })
}

/// What is seen now, with the mean of the velocities now and after the next kick.
fn read_back(now: &Observation, next: &Observation) -> Observation {
    let mut read = now.clone();
    if let (Some((_, Value::Vector(v))), Some((_, Value::Vector(after)))) = (read.values.get_mut(1), next.values.get(1))
    {
        for (x, y) in v.iter_mut().zip(after) {
            *x = (*x + *y) * fx128::lit(0.5);
        }
    }
    read
}

/// Steps of the lengths of [`times`], one after another. The evaluations of an implicit method are not counted.
pub(crate) fn jittered(scene: &dyn AnyScene, question: &Question) -> Result<Trajectory, Error> {
    let key = "jitter";
    let stepping = stepping(scene, question, key)?;
    let times = times(question);
    let wanted = seen_steps(question);
    let start = stepping.walk(question.end_s, 1, &[], &[0]).ok_or_else(|| curved(key))?;
    let Some((_, first)) = start.seen.into_iter().next() else { return Err(curved(key)) };
    let origin = coordinates(&first);
    let mut run = Trajectory { outcome: Outcome::Finished, failed_step: None, seen: vec![(0, first)], evaluations: 0 };
    let mut displacement: Vec<f64> = vec![0.0; origin.len()];
    for step in 1..=question.steps {
        let h_s = times[step as usize] - times[step as usize - 1];
        let one = stepping.walk(h_s, 1, &displacement, &[1]).ok_or_else(|| curved(key))?;
        let Some((_, seen)) = one.seen.into_iter().next().filter(|_| one.outcome == Outcome::Finished) else {
            return Ok(Trajectory { outcome: one.outcome, failed_step: Some(step), ..run });
        };
        run.evaluations += stepping.method.facts().evaluations.unwrap_or(0);
        displacement = coordinates(&seen).iter().zip(&origin).map(|(a, b)| (*a - *b).to_f64()).collect();
        if wanted.binary_search(&step).is_ok() {
            run.seen.push((step, seen));
        }
    }
    Ok(run)
}
