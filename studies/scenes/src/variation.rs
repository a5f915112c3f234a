//! The leading error of a method along any exact motion, by the equation of first variation.
//!
//! The error of a method of order p is h^p e(t) + O(h^(p+1)), where e = (delta, eta) is an error of the configuration and one
//! of the velocity, e(0) = 0, and h^(p+1) (d_q, d_v) is the method's local error on the exact motion:
//!
//! delta' = eta + [v, delta] + d_q, eta' = (d rate / d q) delta + (d rate / d v) eta + d_v,
//!
//! with the Lie bracket of the space (none where it is flat). With a = v', and its derivatives along the motion:
//!
//! | method | d_q | d_v |
//! |---|---|---|
//! | explicit Euler | -a/2 | -a'/2 |
//! | implicit Euler | a/2 | a'/2 |
//! | semi-implicit Euler | a/2 | -a'/2 |
//! | velocity Verlet | -a'/6 + [v, a]/12 | a''/12 - (d rate / d v) a'/4 |
//! | implicit midpoint | a'/12 + [v, a]/12 | -a''/24 + (d rate / d q) a/8 + (d rate / d v) a'/8 |
//!
//! The brackets are those of Magnus' expansion of the exact rotation over a step. Derivatives are central differences in
//! double-double. Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (1993), II.3 and
//! II.8; A. Iserles et al., Acta Numerica 9 (2000) 215, section 4.

use faer::fx128;
use integrator::methods::MethodId;
use integrator::{Real, Single, Space, State, Vector};

use crate::motion::Motion;
use crate::observation::Quantity;
use crate::run::CHECKPOINTS;

/// What theory says of the leading error of one method in one quantity, in the quantity's unit / s^order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leading {
    /// The method.
    pub method: MethodId,
    /// The quantity.
    pub quantity: Quantity,
    /// lim error / h^order at the end.
    pub end: f64,
    /// The largest such limit at the checkpoints.
    pub max: f64,
    /// How far both may be off.
    pub doubt: f64,
}

/// The methods whose local error is in the table.
pub const METHODS: [MethodId; 5] = [
    MethodId::ExplicitEuler,
    MethodId::ImplicitEuler,
    MethodId::SemiImplicitEuler,
    MethodId::VelocityVerlet,
    MethodId::ImplicitMidpoint,
];

/// An error of configuration and velocity.
type Pair<V> = [V; 2];

/// A motion of which only the space is known: nothing here is timed.
type AnyMotion<'a, Q> = &'a dyn Motion<fx128, Config = Q>;

/// The exact motion at one time, and the local errors of [`METHODS`] there.
struct Node<Q: Space> {
    t: fx128,
    at: State<Q>,
    local: [Pair<Q::Tangent>; METHODS.len()],
}

/// The time of a difference quotient as a part of the time scale: the quotient is off by its square, and by the rounding of
/// double-double over its square.
const TIME_STEP: f64 = 1e-6;
/// The length of a displacement as a part of the state: its derivative is off by the square.
const DISPLACEMENT: f64 = 1e-9;
/// Roundings in a rate on the exact motion.
const ROUNDINGS: f64 = 1024.0;
/// Steps of the coarser propagation between two checkpoints, at least, and of the finer one in one time scale.
const LEAST: f64 = 2.0;
const IN_A_TIME_SCALE: f64 = 8.0;

/// The leading errors up to `end_s` of a model whose velocity is what it stores; none where the
/// motion is too long, or a number is not finite.
pub fn leading<Q: Space<Scalar = fx128>>(
    motion: &dyn Motion<fx128, Config = Q>,
    end_s: f64,
    time_scale_s: f64,
) -> Vec<Leading> {
    let Some(steps) = steps(end_s, time_scale_s) else { return Vec::new() };
    let space = fx128::lit(end_s / (2 * steps) as f64);
    let scale_s = time_scale_s.min(end_s);
    let nodes = nodes(motion, space, steps, scale_s);
    let size = |pick: fn(&Node<Q>) -> Q::Tangent| nodes.iter().map(|node| size(pick(node))).fold(0.0, f64::max);
    // The Eulers' local errors hold the acceleration twice over.
    let speed = size(|node| node.at.v).max(size(|node| node.local[0][0]) * 2.0 * scale_s);
    let sizes = [speed * scale_s, speed];
    let mut all = Vec::new();
    for (m, &method) in METHODS.iter().enumerate() {
        let slope = |node: &Node<Q>, e: Pair<Q::Tangent>| {
            let [d_q, d_v] = node.local[m];
            let drift = Q::plus_bracket(e[1] + d_q, fx128::ONE, node.at.v, e[0]);
            [drift, derivative(motion, node.t, &node.at, e, sizes) + d_v]
        };
        let [fine, coarse] = [1, 2].map(|stride| propagate(&nodes, stride, space, slope));
        let mut of_method = compare(motion, method, &nodes, [&fine, &coarse], sizes);
        // What rounding of the quotients leaves of a local error, gathered over the run.
        let noise = ROUNDINGS * <fx128 as Single>::EPSILON / TIME_STEP.powi(method.order() as i32);
        let gathered = noise * end_s / scale_s / scale_s.powi(method.order() as i32);
        for one in &mut of_method {
            let is_rate = matches!(one.quantity, Quantity::Velocity | Quantity::AngularVelocity);
            one.doubt += gathered * if is_rate { speed } else { speed * end_s.max(scale_s) };
        }
        all.extend(of_method);
    }
    all
}

/// A number of steps that is a multiple of the checkpoints and twice that; none beyond what is worth its time.
fn steps(end_s: f64, time_scale_s: f64) -> Option<usize> {
    let between = (IN_A_TIME_SCALE * end_s / time_scale_s / CHECKPOINTS as f64).max(2.0 * LEAST).log2().ceil().exp2();
    (between <= 256.0).then_some(CHECKPOINTS as usize * between as usize)
}

/// The exact motion at every half step.
fn nodes<Q: Space<Scalar = fx128>>(motion: AnyMotion<'_, Q>, space: fx128, steps: usize, scale_s: f64) -> Vec<Node<Q>> {
    let lit = fx128::lit;
    let eps = lit((scale_s * TIME_STEP).log2().round().exp2());
    let rate = |t: fx128| motion.rate(t, &motion.exact(t));
    let node = |i: usize| {
        let t = space * lit(i as f64);
        let at = motion.exact(t);
        let (a, after) = (motion.rate(t, &at), rate(t + eps));
        let [jerk, snap] = if i == 0 {
            // What was before the start may be another motion: the drag of a body at rest has a kink there.
            let [two, three] = [2.0, 3.0].map(|n| rate(t + eps * lit(n)));
            [
                after * lit(4.0) - a * lit(3.0) - two,
                (a - two * lit(-2.0) - after * lit(2.5) - three * lit(0.5)) * lit(2.0),
            ]
        } else {
            let before = rate(t - eps);
            [after - before, after + before - a * lit(2.0)]
        };
        let (jerk, snap) = (jerk * (lit(0.5) / eps), snap * (fx128::ONE / (eps * eps)));
        let (half, part) = (lit(0.5), |n: f64| fx128::ONE / lit(n));
        let zero = Q::Tangent::zero();
        let sizes = [size(at.v).max(size(a) * scale_s) * scale_s, size(at.v).max(size(a) * scale_s)];
        let along = |by| derivative(motion, t, &at, by, sizes);
        let bracket = Q::plus_bracket(zero, part(12.0), at.v, a);
        let local = [
            [a * -half, jerk * -half],
            [a * half, jerk * half],
            [a * half, jerk * -half],
            [bracket - jerk * part(6.0), snap * part(12.0) - along([zero, jerk]) * part(4.0)],
            [bracket + jerk * part(12.0), along([a, jerk]) * part(8.0) - snap * part(24.0)],
        ];
        Node { t, at, local }
    };
    (0..=2 * steps).map(node).collect()
}

/// The largest component.
fn size<V: Vector<fx128>>(v: V) -> f64 {
    (0..V::DIM).map(|i| v.component(i).to_f64().abs()).fold(0.0, |a, b| if b.is_nan() { b } else { a.max(b) })
}

/// What part of `sizes` an error is.
fn part_of<V: Vector<fx128>>([q, v]: Pair<V>, sizes: [f64; 2]) -> f64 {
    let over = |x: f64, y: f64| if x == 0.0 { 0.0 } else { x / y };
    over(size(q), sizes[0]).max(over(size(v), sizes[1]))
}

/// (d rate / d q) e_q + (d rate / d v) e_v, by a displacement that is small beside `sizes`.
fn derivative<Q: Space<Scalar = fx128>>(
    motion: AnyMotion<'_, Q>,
    t: fx128,
    at: &State<Q>,
    e: Pair<Q::Tangent>,
    sizes: [f64; 2],
) -> Q::Tangent {
    let part = part_of(e, sizes);
    if part == 0.0 {
        return Q::Tangent::zero();
    }
    let h = fx128::lit((DISPLACEMENT / part).log2().round().exp2());
    let rate = |h: fx128| motion.rate(t, &State { q: at.q.retract(e[0], h), v: at.v.add_scaled(e[1], h) });
    (rate(h) - rate(-h)) * (fx128::lit(0.5) / h)
}

/// e at the checkpoints after the start, by the classical method of order 4 with steps of 2 `stride` nodes.
fn propagate<Q: Space<Scalar = fx128>>(
    nodes: &[Node<Q>],
    stride: usize,
    space: fx128,
    slope: impl Fn(&Node<Q>, Pair<Q::Tangent>) -> Pair<Q::Tangent>,
) -> Vec<Pair<Q::Tangent>> {
    let lit = fx128::lit;
    let h = space * lit(2.0 * stride as f64);
    let plus = |[q, v]: Pair<Q::Tangent>, k: Pair<Q::Tangent>, h: fx128| [q.add_scaled(k[0], h), v.add_scaled(k[1], h)];
    let every = (nodes.len() - 1) / CHECKPOINTS as usize;
    let mut e = [Q::Tangent::zero(); 2];
    let mut seen = Vec::new();
    for i in (0..nodes.len() - 1).step_by(2 * stride) {
        let (from, middle, to) = (&nodes[i], &nodes[i + stride], &nodes[i + 2 * stride]);
        let k1 = slope(from, e);
        let k2 = slope(middle, plus(e, k1, h * lit(0.5)));
        let k3 = slope(middle, plus(e, k2, h * lit(0.5)));
        let k4 = slope(to, plus(e, k3, h));
        let inner = plus(plus(e, k1, h / lit(6.0)), k4, h / lit(6.0));
        e = plus(plus(inner, k2, h / lit(3.0)), k3, h / lit(3.0));
        if (i + 2 * stride).is_multiple_of(every) {
            seen.push(e);
        }
    }
    seen
}

/// From both propagations to the sizes of the errors in every quantity: extrapolated, the coarser being sixteen times as wrong.
fn compare<Q: Space<Scalar = fx128>>(
    motion: AnyMotion<'_, Q>,
    method: MethodId,
    nodes: &[Node<Q>],
    [fine, coarse]: [&[Pair<Q::Tangent>]; 2],
    sizes: [f64; 2],
) -> Vec<Leading> {
    let every = (nodes.len() - 1) / CHECKPOINTS as usize;
    let length = |k: usize, e: Pair<Q::Tangent>| -> Vec<(Quantity, f64)> {
        let at = &nodes[(k + 1) * every].at;
        let part = part_of(e, sizes);
        let h = if part == 0.0 { 1.0 } else { (DISPLACEMENT / part).log2().round().exp2() };
        let step = fx128::lit(h);
        let moved = State { q: at.q.retract(e[0], step), v: at.v.add_scaled(e[1], step) };
        motion.observe(&moved).distances(&motion.observe(at)).into_iter().map(|(q, d)| (q, d / h)).collect()
    };
    let mut all: Vec<Leading> = Vec::new();
    for (k, (&a, &b)) in fine.iter().zip(coarse).enumerate() {
        let difference = [0, 1].map(|c| (a[c] - b[c]) * (fx128::ONE / fx128::lit(15.0)));
        let best = [0, 1].map(|c| a[c] + difference[c]);
        for ((quantity, end), (_, doubt)) in length(k, best).into_iter().zip(length(k, difference)) {
            match all.iter_mut().find(|one| one.quantity == quantity) {
                Some(one) => {
                    *one = Leading { end, max: one.max.max(end), doubt: one.doubt.max(doubt), ..*one };
                }
                None => all.push(Leading { method, quantity, end, max: end, doubt }),
            }
        }
    }
    all.retain(|one| one.end.is_finite() && one.max.is_finite() && one.doubt.is_finite());
    all
}
