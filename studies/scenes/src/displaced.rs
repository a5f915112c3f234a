//! A run from the scene's own start, displaced: what a growth is the growth of.

use integrator::methods::Visitor;
use integrator::{Method, Single, Space, State, Vector, drive};

use crate::motion::Motion;
use crate::run::{Outcome, Run, Trajectory};

/// Runs a model from its start moved by `displacement` (configuration, then velocity; what is missing is zero) and observes
/// it at the steps `looks`, in increasing order.
pub(crate) fn run_displaced<T: Single, M: Motion<T>>(
    model: &M,
    run: &Run,
    displacement: &[f64],
    looks: &[u64],
) -> Trajectory {
    run.method.visit(Displaced { model, run, displacement, looks })
}

struct Displaced<'a, M> {
    model: &'a M,
    run: &'a Run,
    displacement: &'a [f64],
    looks: &'a [u64],
}

impl<T: Single, M: Motion<T>> Visitor<T, M> for Displaced<'_, M> {
    type Output = Trajectory;

    fn visit<A: Method<T, M>>(self, method: &A) -> Trajectory {
        let Run { steps, end_s, .. } = *self.run;
        let h = T::lit(end_s) / T::lit(steps as f64);
        let dim = <<M::Config as Space>::Tangent as Vector<T>>::DIM;
        let move_of = |first: usize| {
            <M::Config as Space>::Tangent::from_fn(|i| T::lit(self.displacement.get(first + i).copied().unwrap_or(0.0)))
        };
        let own = self.model.exact(T::lit(0.0));
        let start = State { q: own.q.retract(move_of(0), T::lit(1.0)), v: own.v + move_of(dim) };
        let mut looks = self.looks.iter().copied().peekable();
        let mut seen = Vec::with_capacity(self.looks.len());
        let result = drive::integrate(method, self.model, start, h, steps, |i, s| {
            if looks.next_if_eq(&i).is_some() {
                seen.push((i, self.model.observe(s)));
            }
        });
        let outcome = match result {
            Ok(_) => Outcome::Finished,
            Err(_) if self.run.method.is_implicit() => Outcome::NotConverged,
            Err(_) => Outcome::Diverged,
        };
        Trajectory { outcome, failed_step: result.err().map(|failure| failure.step), seen, evaluations: 0 }
    }
}
