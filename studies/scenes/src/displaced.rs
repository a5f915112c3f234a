//! A run from the scene's own start, displaced: what a growth is the growth of.

use integrator::methods::Visitor;
use integrator::{Method, Single, Space, State, Vector, drive};

use crate::run::{AnyFlat, Outcome, Run, Trajectory};
use crate::scheme::Rule;

/// Runs a model from its start moved by `displacement` (configuration, then velocity; what is missing is zero) and observes
/// it at the steps `samples`, in increasing order.
pub(crate) fn run_displaced<T: Single, Q: Space<Scalar = T>>(
    model: AnyFlat<'_, T, Q>,
    run: &Run,
    displacement: &[f64],
    samples: &[u64],
) -> Option<Trajectory> {
    let Rule::General(method) = run.scheme.rule else { return None };
    Some(method.visit(Displaced { model, run, displacement, samples }))
}

struct Displaced<'a, T: Single, Q: Space<Scalar = T>> {
    model: AnyFlat<'a, T, Q>,
    run: &'a Run,
    displacement: &'a [f64],
    samples: &'a [u64],
}

impl<'a, T: Single, Q: Space<Scalar = T>> Visitor<T, AnyFlat<'a, T, Q>> for Displaced<'a, T, Q> {
    type Output = Trajectory;

    fn visit<A: Method<T, AnyFlat<'a, T, Q>>>(self, method: &A) -> Trajectory {
        let Run { steps, end_s, .. } = *self.run;
        let h = T::lit(end_s) / T::lit(steps as f64);
        let dim = <Q::Tangent as Vector<T>>::DIM;
        let move_of =
            |first: usize| Q::Tangent::from_fn(|i| T::lit(self.displacement.get(first + i).copied().unwrap_or(0.0)));
        let own = self.model.exact(T::lit(0.0));
        let start = State { q: own.q.retract(move_of(0), T::lit(1.0)), v: own.v + move_of(dim) };
        let mut samples = self.samples.iter().copied().peekable();
        let mut seen = Vec::with_capacity(self.samples.len());
        let result = drive::integrate(method, &self.model, start, h, steps, |i, s| {
            if samples.next_if_eq(&i).is_some() {
                seen.push((i, self.model.observe(s)));
            }
        });
        let outcome = match result {
            Ok(_) => Outcome::Finished,
            Err(_) if self.run.scheme.is_implicit() => Outcome::NotConverged,
            Err(_) => Outcome::Diverged,
        };
        Trajectory { outcome, failed_step: result.err().map(|failure| failure.step), seen, evaluations: 0 }
    }
}
