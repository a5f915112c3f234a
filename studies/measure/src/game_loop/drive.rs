//! Runs a loop. The step is the method's own; what is done around it is done here.

use std::cell::Cell;

use faer::fx128;
use integrator::drive::Diverged;
use integrator::methods::{MethodId, Visitor};
use integrator::{Method, Model, Real, Single, Space, State, Steps, Vector};
use nalgebra::SVector;

use super::description::{Clock, Contact, Damped, Drawn, Force, Loop, Read, Start};
use super::frames::Lengths;

/// A model of `N` coordinates.
pub trait Flat<const N: usize>: Model<f64, Config = SVector<f64, N>> {}

impl<const N: usize, M: Model<f64, Config = SVector<f64, N>>> Flat<N> for M {}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// After so many frames.
    Frames(u64),
    /// With the first frame after which the loop's own clock has reached this time, s; after at most so many frames.
    Clock(f64, u64),
}

/// What is seen at the end of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen<const N: usize> {
    /// Frames so far.
    pub frame: u64,
    /// Steps so far, substeps counted.
    pub steps: u64,
    /// The sum of the frames' lengths, s.
    pub wall_s: f64,
    /// The sum of the steps' lengths, s.
    pub simulated_s: f64,
    /// The time that what is drawn belongs to, s: for an interpolated state one step behind the clock.
    pub drawn_s: f64,
    /// Time that the accumulator keeps for the next frame, s.
    pub left_s: f64,
    /// What is drawn; its velocity is the one that is read.
    pub state: State<SVector<f64, N>>,
}

/// What is run.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a, M, const N: usize> {
    /// The law of motion, with its contact.
    pub model: &'a M,
    /// The rule of a step.
    pub method: MethodId,
    /// What is done around it.
    pub plan: &'a Loop,
    /// The length of a frame, s, where the loop gives none.
    pub h_s: f64,
    /// The state at t = 0.
    pub start: State<SVector<f64, N>>,
}

impl<M: Flat<N>, const N: usize> Job<'_, M, N> {
    /// Runs it and shows every frame; gives what was seen last.
    ///
    /// # Errors
    /// [`Diverged`] with the step whose result was not finite.
    pub fn run(&self, until: Until, see: impl FnMut(&Seen<N>)) -> Result<Seen<N>, Diverged> {
        let held = Held { model: self.model, force: Cell::new(None) };
        self.method.visit(Visit { job: self, held: &held, until, see })
    }
}

/// A model whose force may be held.
struct Held<'a, M, V> {
    model: &'a M,
    force: Cell<Option<V>>,
}

impl<M: Flat<N>, const N: usize> Model<f64> for Held<'_, M, SVector<f64, N>> {
    type Config = SVector<f64, N>;

    fn rate(&self, t: f64, s: &State<Self::Config>) -> SVector<f64, N> {
        self.force.get().unwrap_or_else(|| self.model.rate(t, s))
    }
    fn kick(&self, t: f64, h: f64, s: &State<Self::Config>) -> SVector<f64, N> {
        self.force.get().map_or_else(|| self.model.kick(t, h, s), |rate| s.v.add_scaled(rate, h))
    }
    fn velocity(&self, q: Self::Config, v: SVector<f64, N>) -> SVector<f64, N> {
        self.model.velocity(q, v)
    }
    fn contact(&self, before: &State<Self::Config>, after: State<Self::Config>) -> State<Self::Config> {
        self.model.contact(before, after)
    }
}

struct Visit<'a, M, F, const N: usize> {
    job: &'a Job<'a, M, N>,
    held: &'a Held<'a, M, SVector<f64, N>>,
    until: Until,
    see: F,
}

impl<'a, M: Flat<N>, F: FnMut(&Seen<N>), const N: usize> Visitor<f64, Held<'a, M, SVector<f64, N>>>
    for Visit<'_, M, F, N>
where
    Self: 'a,
{
    type Output = Result<Seen<N>, Diverged>;

    fn visit<A: Method<f64, Held<'a, M, SVector<f64, N>>>>(mut self, method: &A) -> Self::Output {
        let plan = self.job.plan;
        let mut lengths = Lengths::new(&plan.frames, self.job.h_s);
        let mut run = Run::new(self.job, self.held, method.stepper(self.held));
        let (mut wall, mut left) = (fx128::ZERO, 0.0);
        for frame in 1.. {
            let length = lengths.next();
            wall += fx128::lit(length);
            let taken = plan.clamp_s.map_or(length, |most| length.min(most));
            match plan.inner_s {
                None => run.span(taken)?,
                Some(inner) => {
                    left += taken;
                    while left >= inner {
                        run.span(inner)?;
                        left -= inner;
                    }
                }
            }
            let seen = run.seen(frame, wall.to_f64(), left);
            (self.see)(&seen);
            let is_over = match self.until {
                Until::Frames(frames) => frame >= frames,
                Until::Clock(end_s, most) => run.clock() >= end_s || frame >= most,
            };
            if is_over {
                return Ok(seen);
            }
        }
        unreachable!("the frames are endless")
    }
}

/// A run under way.
struct Run<'a, M, S, const N: usize> {
    plan: &'a Loop,
    held: &'a Held<'a, M, SVector<f64, N>>,
    steps_of: S,
    state: State<SVector<f64, N>>,
    previous: State<SVector<f64, N>>,
    /// The lengths of the last step and of the last span.
    step_s: f64,
    span_s: f64,
    steps: u64,
    /// Simulated time: a sum, and equal steps since, which are not summed.
    base: fx128,
    equal: u64,
    sum: f64,
}

impl<'a, M: Flat<N>, S: Steps<f64, Held<'a, M, SVector<f64, N>>>, const N: usize> Run<'a, M, S, N> {
    fn new(job: &Job<'a, M, N>, held: &'a Held<'a, M, SVector<f64, N>>, steps_of: S) -> Self {
        let (plan, mut state) = (job.plan, job.start);
        if plan.start == Start::HalfKick {
            let first = Lengths::new(&plan.frames, job.h_s).next();
            let first = plan.clamp_s.map_or(first, |most| first.min(most));
            let step = plan.inner_s.unwrap_or(first) / f64::from(plan.substeps.max(1));
            state.v = state.v.add_scaled(held.model.rate(0.0, &state), -0.5 * step);
        }
        Run {
            plan,
            held,
            steps_of,
            state,
            previous: state,
            step_s: 0.0,
            span_s: plan.inner_s.unwrap_or(1.0),
            steps: 0,
            base: fx128::ZERO,
            equal: 0,
            sum: 0.0,
        }
    }

    fn simulated(&self) -> fx128 {
        self.base + fx128::lit(self.equal as f64) * fx128::lit(self.step_s)
    }

    /// The time that the force sees, s.
    fn clock(&self) -> f64 {
        match self.plan.clock {
            // One product, rounded once, for equal steps: the time of the plain loop.
            Clock::Exact if self.base.0 == 0.0 => self.equal as f64 * self.step_s,
            Clock::Exact => self.simulated().to_f64(),
            Clock::SumF64 | Clock::SumF32 => self.sum,
        }
    }

    /// A frame, or an inner step of one: substeps with a fresh or a held force.
    fn span(&mut self, length: f64) -> Result<(), Diverged> {
        let substeps = self.plan.substeps.max(1);
        let h = length / f64::from(substeps);
        if h != self.step_s {
            (self.base, self.equal, self.step_s) = (self.simulated(), 0, h);
        }
        (self.previous, self.span_s) = (self.state, length);
        if self.plan.force == Force::Frozen {
            self.held.force.set(Some(self.held.model.rate(self.clock(), &self.state)));
        }
        for _ in 0..substeps {
            let mut next = self.step(h);
            next.q = next.q.map(|x| self.plan.position.round(x));
            next.v = next.v.map(|x| self.plan.velocity.round(x));
            self.state = next;
            self.steps += 1;
            if !next.is_finite() {
                return Err(Diverged { step: self.steps });
            }
            self.equal += 1;
            self.sum = match self.plan.clock {
                Clock::SumF32 => f64::from(self.sum as f32 + h as f32),
                Clock::Exact | Clock::SumF64 => self.sum + h,
            };
        }
        self.held.force.set(None);
        Ok(())
    }

    fn step(&mut self, h: f64) -> State<SVector<f64, N>> {
        let (plan, held, t) = (self.plan, self.held, self.clock());
        let mut s = self.state;
        if plan.contact == Contact::BeforeKick {
            s = held.contact(&s, s);
        }
        let mut after = if plan.needs_the_kick() {
            let mut v = held.kick(t, h, &s);
            if plan.damped == Damped::BeforeMove {
                v *= plan.damping.factor(h);
            }
            let mut moves = true;
            if matches!(plan.contact, Contact::AfterKick | Contact::NoMove) {
                let kicked = State { q: s.q, v };
                let bounced = held.contact(&kicked, kicked);
                moves = plan.contact == Contact::AfterKick || bounced == kicked;
                v = bounced.v;
            }
            State { q: if moves { s.q.retract(held.velocity(s.q, v), h) } else { s.q }, v }
        } else if plan.contact == Contact::Impact {
            self.through_impacts(t, h, s)
        } else {
            self.steps_of.next(t, h, s)
        };
        if plan.damped == Damped::AfterMove {
            after.v *= plan.damping.factor(h);
        }
        if plan.contact == Contact::End { held.contact(&s, after) } else { after }
    }

    /// Bounces in one step, at most: a ball that comes to rest has infinitely many.
    const MOST_BOUNCES: usize = 64;

    fn through_impacts(&mut self, t: f64, h: f64, mut s: State<SVector<f64, N>>) -> State<SVector<f64, N>> {
        let held = self.held;
        let bounced = |s: State<SVector<f64, N>>| Some(held.contact(&s, s)).filter(|b| *b != s);
        let (mut done, mut run) = (0.0, self.steps_of.clone());
        for _ in 0..Self::MOST_BOUNCES {
            let rest = h - done;
            let at = |part: f64| run.clone().next(t + done, part, s);
            if bounced(at(rest)).is_none() {
                break;
            }
            let (mut before, mut after) = (0.0, rest);
            loop {
                let middle = 0.5 * (before + after);
                if middle <= before || middle >= after {
                    break;
                }
                if bounced(at(middle)).is_some() { after = middle } else { before = middle }
            }
            let hit = run.next(t + done, after, s);
            s = bounced(hit).unwrap_or(hit);
            done += after;
        }
        let end = run.next(t + done, h - done, s);
        self.steps_of = run;
        // A ball at rest bounces for ever: what is left of the step ends as the plain rule ends it.
        held.contact(&s, end)
    }

    fn seen(&self, frame: u64, wall_s: f64, left_s: f64) -> Seen<N> {
        let simulated_s = self.simulated().to_f64();
        let mut state = self.state;
        let mut drawn_s = simulated_s;
        match self.plan.drawn {
            Drawn::Last => {}
            // Before the first step there is one state only.
            Drawn::Interpolated if self.steps == 0 => {}
            Drawn::Interpolated => {
                let part = if self.plan.inner_s.is_some() { left_s / self.span_s } else { 0.0 };
                let between =
                    |a: SVector<f64, N>, b: SVector<f64, N>| if part > 0.0 { a.add_scaled(b - a, part) } else { a };
                state = State { q: between(self.previous.q, state.q), v: between(self.previous.v, state.v) };
                drawn_s = simulated_s + left_s - self.span_s;
            }
            Drawn::Extrapolated => {
                state.q = state.q.retract(self.held.velocity(state.q, state.v), left_s);
                drawn_s = simulated_s + left_s;
            }
        }
        if self.plan.read == Read::Synchronised {
            state.v = state.v.add_scaled(self.held.model.rate(self.clock(), &self.state), 0.5 * self.step_s);
        }
        Seen { frame, steps: self.steps, wall_s, simulated_s, drawn_s, left_s, state }
    }
}
