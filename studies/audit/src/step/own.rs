//! Steps that engines use and that are no methods of `integrator`: two Runge-Kutta methods on a flat space, and methods with
//! a memory.

use integrator::{Model, Real, Space, State, Tangent, Vector};

/// A flat space: velocities add to configurations.
pub(super) trait Flat: Space<Tangent = Self> + Vector<Self::Scalar> {}
impl<Q: Space<Tangent = Q> + Vector<Q::Scalar>> Flat for Q {}

/// (q', v') of a model.
fn derivative<T: Real, M: Model<T>>(m: &M, t: T, s: &State<M::Config>) -> (Tangent<M, T>, Tangent<M, T>) {
    (m.velocity(s.q, s.v), m.rate(t, s))
}

fn moved<T: Real, Q: Flat + Space<Scalar = T>>(s: State<Q>, h: T, (dq, dv): (Q, Q)) -> State<Q> {
    State { q: s.q.add_scaled(dq, h), v: s.v.add_scaled(dv, h) }
}

/// An explicit Runge-Kutta method on a flat space by its tableau.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Tableau {
    /// Heun: (f(y0) + f(y0 + h f0)) / 2. Order 2.
    Heun,
    /// Explicit midpoint. Order 2.
    Midpoint,
    /// Kutta's third order: weights 1/6, 2/3, 1/6. Order 3.
    Kutta3,
    /// The classical one, without brackets. Order 4.
    Classical,
}

impl Tableau {
    /// Every one.
    pub(super) const ALL: [Tableau; 4] = [Tableau::Heun, Tableau::Midpoint, Tableau::Kutta3, Tableau::Classical];

    /// The name.
    pub(super) fn id(self) -> &'static str {
        match self {
            Tableau::Heun => "heun",
            Tableau::Midpoint => "explicit-midpoint",
            Tableau::Kutta3 => "kutta3",
            Tableau::Classical => "rk4-flat",
        }
    }

    /// One step.
    pub(super) fn step<T: Real, M: Model<T>>(self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config>
    where
        M::Config: Flat + Space<Scalar = T>,
    {
        let half = h * T::lit(0.5);
        let k1 = derivative(m, t, &s);
        match self {
            Tableau::Heun => {
                let k2 = derivative(m, t + h, &moved(s, h, k1));
                moved(s, half, (k1.0 + k2.0, k1.1 + k2.1))
            }
            Tableau::Midpoint => moved(s, h, derivative(m, t + half, &moved(s, half, k1))),
            Tableau::Kutta3 => {
                let k2 = derivative(m, t + half, &moved(s, half, k1));
                let two = T::lit(2.0);
                let k3 = derivative(m, t + h, &moved(s, h, (k2.0 * two - k1.0, k2.1 * two - k1.1)));
                let four = T::lit(4.0);
                moved(s, h / T::lit(6.0), ((k1.0 + k3.0).add_scaled(k2.0, four), (k1.1 + k3.1).add_scaled(k2.1, four)))
            }
            Tableau::Classical => {
                let k2 = derivative(m, t + half, &moved(s, half, k1));
                let k3 = derivative(m, t + half, &moved(s, half, k2));
                let k4 = derivative(m, t + h, &moved(s, h, k3));
                let two = T::lit(2.0);
                let sum = ((k1.0 + k4.0).add_scaled(k2.0 + k3.0, two), (k1.1 + k4.1).add_scaled(k2.1 + k3.1, two));
                moved(s, h / T::lit(6.0), sum)
            }
        }
    }
}

/// A method that remembers derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Memory {
    /// Adams-Bashforth of order 2 to 5.
    AdamsBashforth(usize),
    /// h/2 (f_n + f_(n-1)): of order 1, with twice the error of Euler.
    MeanOfTwo,
}

impl Memory {
    /// Every one.
    pub(super) const ALL: [Memory; 5] = [
        Memory::AdamsBashforth(2),
        Memory::AdamsBashforth(3),
        Memory::AdamsBashforth(4),
        Memory::AdamsBashforth(5),
        Memory::MeanOfTwo,
    ];

    /// The name.
    pub(super) fn id(self) -> &'static str {
        match self {
            Memory::AdamsBashforth(2) => "adams-bashforth-2",
            Memory::AdamsBashforth(3) => "adams-bashforth-3",
            Memory::AdamsBashforth(4) => "adams-bashforth-4",
            Memory::AdamsBashforth(_) => "adams-bashforth-5",
            Memory::MeanOfTwo => "mean-of-two-derivatives",
        }
    }

    /// The weights of f_n, f_(n-1), ...
    fn weights(self) -> (&'static [f64], f64) {
        match self {
            Memory::AdamsBashforth(2) => (&[3.0, -1.0], 2.0),
            Memory::AdamsBashforth(3) => (&[23.0, -16.0, 5.0], 12.0),
            Memory::AdamsBashforth(4) => (&[55.0, -59.0, 37.0, -9.0], 24.0),
            Memory::AdamsBashforth(_) => (&[1901.0, -2774.0, 2616.0, -1274.0, 251.0], 720.0),
            Memory::MeanOfTwo => (&[1.0, 1.0], 2.0),
        }
    }

    /// Runs from the start, the history filled with the first derivative; shows every state.
    pub(super) fn run<T: Real, M: Model<T>>(
        self,
        m: &M,
        h: T,
        start: State<M::Config>,
        steps: u64,
        mut show: impl FnMut(&State<M::Config>),
    ) where
        M::Config: Flat + Space<Scalar = T>,
    {
        let (weights, below) = self.weights();
        let mut s = start;
        let first = derivative(m, T::lit(0.0), &s);
        let mut history = vec![first; weights.len()];
        for n in 0..steps {
            history.rotate_right(1);
            history[0] = derivative(m, T::lit(n as f64) * h, &s);
            let zero = (M::Config::zero(), M::Config::zero());
            let sum = weights.iter().zip(&history).fold(zero, |sum, (w, f)| {
                let w = T::lit(*w);
                (sum.0.add_scaled(f.0, w), sum.1.add_scaled(f.1, w))
            });
            let before = s;
            s = m.contact(&before, moved(s, h / T::lit(below), sum));
            show(&s);
        }
    }
}
