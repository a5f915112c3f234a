//! n fixed steps from t = 0, at the times t = i h with i an integer: never a sum of steps.
//! After every step the model's [`Model::contact`] may change the state at once: a bounce.

use crate::model::{Method, Model, State, Steps};
use crate::real::Real;

/// A constraint's rounding (the quaternion's norm) is removed after every so many steps: it costs nothing then, and a
/// norm drifts by about sqrt(64) ulp in between.
pub const SETTLE_EVERY: u64 = 64;

/// The run met a non-finite state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Diverged {
    /// The first step whose result was not finite, counted from 1; its time is step * h.
    pub step: u64,
}

/// Takes `steps` steps of length `h` and returns the last state, or where the run first left the finite numbers.
///
/// # Errors
/// [`Diverged`], with the step.
pub fn advance<T: Real, M: Model<T>, A: Method<T, M>>(
    method: &A,
    model: &M,
    start: State<M::Config>,
    h: T,
    steps: u64,
) -> Result<State<M::Config>, Diverged> {
    let mut s = start;
    let mut run = method.stepper(model);
    let mut done = 0;
    while done < steps {
        let block = SETTLE_EVERY.min(steps - done);
        let (before, run_before) = (s, run.clone());
        for i in done..done + block {
            s = model.contact(&s, run.next(T::lit(i as f64) * h, h, s));
        }
        if !s.is_finite() {
            return Err(first_non_finite(run_before, model, before, h, done));
        }
        done += block;
        if block == SETTLE_EVERY {
            s = s.settled();
        }
    }
    Ok(s)
}

/// As [`advance`], showing every finite state to `observe` with its number (0 is the start).
///
/// # Errors
/// [`Diverged`], with the step.
pub fn integrate<T: Real, M: Model<T>, A: Method<T, M>>(
    method: &A,
    model: &M,
    start: State<M::Config>,
    h: T,
    steps: u64,
    mut observe: impl FnMut(u64, &State<M::Config>),
) -> Result<State<M::Config>, Diverged> {
    let mut s = start;
    let mut run = method.stepper(model);
    observe(0, &s);
    for i in 0..steps {
        s = model.contact(&s, run.next(T::lit(i as f64) * h, h, s));
        if !s.is_finite() {
            return Err(Diverged { step: i + 1 });
        }
        if (i + 1) % SETTLE_EVERY == 0 {
            s = s.settled();
        }
        observe(i + 1, &s);
    }
    Ok(s)
}

#[cold]
fn first_non_finite<T: Real, M: Model<T>>(
    mut run: impl Steps<T, M>,
    model: &M,
    before: State<M::Config>,
    h: T,
    done: u64,
) -> Diverged {
    let mut s = before;
    let mut taken = done;
    // The step first: a start that is not finite fails in step 1, as it does in `integrate`.
    loop {
        s = model.contact(&s, run.next(T::lit(taken as f64) * h, h, s));
        taken += 1;
        if !s.is_finite() {
            return Diverged { step: taken };
        }
    }
}
