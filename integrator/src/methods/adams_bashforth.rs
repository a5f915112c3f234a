use crate::methods::facts::Facts;
use crate::methods::rk4::Rk4;
use crate::model::{Method, Model, State, Steps, Tangent};
use crate::real::Real;
use crate::space::{Space, Vector};

/// Slopes (velocity of the configuration, rate of what is stored) at the last N starts of a step, the newest first.
#[derive(Clone, Copy)]
struct History<V, const N: usize> {
    slopes: [(V, V); N],
    known: usize,
}

/// How the history comes to be.
#[derive(Clone, Copy, PartialEq)]
enum StartUp {
    /// The first slope stands in for all earlier ones: the first step is explicit Euler's.
    Filled,
    /// The first steps are RK4's.
    RunIn,
}

/// q1 = q0 + (h/d) sum c_i w_i, v1 = v0 + (h/d) sum c_i a_i over the last N starts of a step.
#[derive(Clone, Copy)]
struct Formula<const N: usize> {
    weights: [f64; N],
    denominator: f64,
    start_up: StartUp,
}

impl<const N: usize> Formula<N> {
    #[inline(always)]
    fn step<T: Real, M: Model<T>>(
        &self,
        history: &mut History<Tangent<M, T>, N>,
        m: &M,
        (t, h): (T, T),
        s: State<M::Config>,
    ) -> State<M::Config> {
        let now = (m.velocity(s.q, s.v), m.rate(t, &s));
        if history.known == 0 && self.start_up == StartUp::Filled {
            *history = History { slopes: [now; N], known: N };
        }
        history.slopes.copy_within(0..N - 1, 1);
        history.slopes[0] = now;
        history.known = N.min(history.known + 1);
        if history.known < N {
            return Rk4.step(m, t, h, s);
        }
        let (mut w, mut a): (Tangent<M, T>, Tangent<M, T>) = (Vector::zero(), Vector::zero());
        for ((w_i, a_i), weight) in history.slopes.into_iter().zip(self.weights) {
            (w, a) = (w.add_scaled(w_i, T::lit(weight)), a.add_scaled(a_i, T::lit(weight)));
        }
        if N > 2 {
            // The second term of Magnus's series, -(h^3/12) [w, w'] in the middle of the step, by backward differences.
            let [(newest, _), (before, _), (oldest, _), ..] = history.slopes[..] else { return s };
            let difference = oldest.add_scaled(before, T::lit(-3.0));
            w = M::Config::plus_bracket(w, h * T::lit(-self.denominator / 12.0), newest, difference);
        }
        let scaled = h / T::lit(self.denominator);
        State { q: s.q.retract(w, scaled), v: s.v.add_scaled(a, scaled) }
    }
}

/// A run under way.
struct Run<'a, M, V, const N: usize> {
    formula: Formula<N>,
    model: &'a M,
    history: History<V, N>,
}

impl<M, V: Copy, const N: usize> Clone for Run<'_, M, V, N> {
    fn clone(&self) -> Self {
        Run { ..*self }
    }
}

impl<T: Real, M: Model<T>, const N: usize> Steps<T, M> for Run<'_, M, Tangent<M, T>, N> {
    #[inline(always)]
    fn next(&mut self, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
        self.formula.step(&mut self.history, self.model, (t, h), s)
    }
}

macro_rules! adams_bashforth {
    ($($(#[$doc:meta])* $method:ident: $weights:expr, $denominator:literal, $start_up:ident, $facts:expr;)*) => {$(
        $(#[$doc])*
        ///
        /// q1 = q0 + h sum c_i w_i, v1 = v0 + h sum c_i a_i over the slopes at the last starts of a step. On a rotation the
        /// second term of Magnus's series is added where the order needs it. The history outlasts a contact. One evaluation in
        /// a step.
        /// Source: F. Bashforth, J. C. Adams, An Attempt to Test the Theories of Capillary Action (1883); E. Hairer,
        /// S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (1993), III.1 (1.5).
        #[derive(Clone, Copy, Debug, Default)]
        pub struct $method;

        impl $method {
            /// What is known of it.
            pub const FACTS: Facts = Facts {
                evaluations: Some(1),
                source: "F. Bashforth, J. C. Adams, An Attempt to Test the Theories of Capillary Action (1883)",
                ..$facts
            };
        }

        impl<T: Real, M: Model<T>> Method<T, M> for $method {
            #[inline(always)]
            fn step(&self, m: &M, t: T, h: T, s: State<M::Config>) -> State<M::Config> {
                self.stepper(m).next(t, h, s)
            }

            #[inline(always)]
            fn stepper<'a>(&'a self, m: &'a M) -> impl Steps<T, M> + 'a
            where
                T: 'a,
            {
                let formula = Formula { weights: $weights, denominator: $denominator, start_up: StartUp::$start_up };
                Run { formula, model: m, history: History { slopes: [(Vector::zero(), Vector::zero()); _], known: 0 } }
            }
        }
    )*};
}

adams_bashforth! {
    /// Adams-Bashforth of 2 slopes, run in by RK4. Order 2.
    AdamsBashforth2: [3.0, -1.0], 2.0, RunIn, Facts {
        id: "adams-bashforth-2",
        title: "Adams-Bashforth 2",
        order: 2,
        formula: "z1 = z0 + h (3 f0 - f-1) / 2, f = (w, a); the first 1 step by RK4",
        latex: &[r"z_1 = z_0 + \tfrac{h}{2}\,(3 f_0 - f_{-1}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// Adams-Bashforth of 3 slopes, run in by RK4. Order 3.
    AdamsBashforth3: [23.0, -16.0, 5.0], 12.0, RunIn, Facts {
        id: "adams-bashforth-3",
        title: "Adams-Bashforth 3",
        order: 3,
        formula: "z1 = z0 + h (23 f0 - 16 f-1 + 5 f-2) / 12, f = (w, a); the first 2 steps by RK4",
        latex: &[r"z_1 = z_0 + \tfrac{h}{12}\,(23 f_0 - 16 f_{-1} + 5 f_{-2}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// Adams-Bashforth of 4 slopes, run in by RK4. Order 4.
    AdamsBashforth4: [55.0, -59.0, 37.0, -9.0], 24.0, RunIn, Facts {
        id: "adams-bashforth-4",
        title: "Adams-Bashforth 4",
        order: 4,
        formula: "z1 = z0 + h (55 f0 - 59 f-1 + 37 f-2 - 9 f-3) / 24, f = (w, a); the first 3 steps by RK4",
        latex: &[r"z_1 = z_0 + \tfrac{h}{24}\,(55 f_0 - 59 f_{-1} + 37 f_{-2} - 9 f_{-3}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// Adams-Bashforth of 5 slopes, run in by RK4. Order 5 (4 on rotations).
    AdamsBashforth5: [1901.0, -2774.0, 2616.0, -1274.0, 251.0], 720.0, RunIn, Facts {
        id: "adams-bashforth-5",
        title: "Adams-Bashforth 5",
        order: 5,
        order_on_rotations: Some(4),
        formula: "z1 = z0 + h (1901 f0 - 2774 f-1 + 2616 f-2 - 1274 f-3 + 251 f-4) / 720, f = (w, a); the first 4 steps by RK4",
        latex: &[r"z_1 = z_0 + \tfrac{h}{720}\,(1901 f_0 - 2774 f_{-1} + 2616 f_{-2} - 1274 f_{-3} + 251 f_{-4}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// Adams-Bashforth of 2 slopes, its history filled with the first slope, as flight simulators do. Order 2: the start costs h^2.
    AdamsBashforth2Filled: [3.0, -1.0], 2.0, Filled, Facts {
        id: "adams-bashforth-2-filled",
        title: "Adams-Bashforth 2, history filled",
        order: 2,
        formula: "z1 = z0 + h (3 f0 - f-1) / 2, f = (w, a); before the start f = f0",
        latex: &[r"z_1 = z_0 + \tfrac{h}{2}\,(3 f_0 - f_{-1}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// Adams-Bashforth of 3 slopes, its history filled with the first slope, as flight simulators do. Order 2: the start costs h^2.
    AdamsBashforth3Filled: [23.0, -16.0, 5.0], 12.0, Filled, Facts {
        id: "adams-bashforth-3-filled",
        title: "Adams-Bashforth 3, history filled",
        order: 2,
        formula: "z1 = z0 + h (23 f0 - 16 f-1 + 5 f-2) / 12, f = (w, a); before the start f = f0",
        latex: &[r"z_1 = z_0 + \tfrac{h}{12}\,(23 f_0 - 16 f_{-1} + 5 f_{-2}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// Adams-Bashforth of 4 slopes, its history filled with the first slope, as flight simulators do. Order 2: the start costs h^2.
    AdamsBashforth4Filled: [55.0, -59.0, 37.0, -9.0], 24.0, Filled, Facts {
        id: "adams-bashforth-4-filled",
        title: "Adams-Bashforth 4, history filled",
        order: 2,
        formula: "z1 = z0 + h (55 f0 - 59 f-1 + 37 f-2 - 9 f-3) / 24, f = (w, a); before the start f = f0",
        latex: &[r"z_1 = z_0 + \tfrac{h}{24}\,(55 f_0 - 59 f_{-1} + 37 f_{-2} - 9 f_{-3}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// Adams-Bashforth of 5 slopes, its history filled with the first slope, as flight simulators do. Order 2: the start costs h^2.
    AdamsBashforth5Filled: [1901.0, -2774.0, 2616.0, -1274.0, 251.0], 720.0, Filled, Facts {
        id: "adams-bashforth-5-filled",
        title: "Adams-Bashforth 5, history filled",
        order: 2,
        formula: "z1 = z0 + h (1901 f0 - 2774 f-1 + 2616 f-2 - 1274 f-3 + 251 f-4) / 720, f = (w, a); before the start f = f0",
        latex: &[r"z_1 = z_0 + \tfrac{h}{720}\,(1901 f_0 - 2774 f_{-1} + 2616 f_{-2} - 1274 f_{-3} + 251 f_{-4}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
    /// The mean of this slope and the last one, called trapezoidal in flight simulators. Order 1, with twice Euler's error.
    MeanOfTwoSlopes: [1.0, 1.0], 2.0, Filled, Facts {
        id: "mean-of-two-slopes",
        title: "Mean of the last two slopes",
        order: 1,
        formula: "z1 = z0 + h (f0 + f-1) / 2, f = (w, a); before the start f = f0",
        latex: &[r"z_1 = z_0 + \tfrac{h}{2}\,(f_0 + f_{-1}),\quad z = (q, v),\ f = (w, a)"],
        ..Facts::NOTHING_KNOWN
    };
}
