//! The solver the implicit methods share: Newton's iteration in the tangent space.
//!
//! The direction is found in `f64`, only the residual is in `T`: an approximate Jacobian costs iterations, not accuracy.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::real::Single;
use crate::space::{Space, Vector};

/// Newton steps before the iteration is given up.
const MOST_ITERATIONS: usize = 50;
/// The Jacobian is computed anew when an iteration shrinks the correction by less than this factor.
const SLOW: f64 = 0.1;
/// Roundings of the configuration that a correction at rest may amount to: of its terms, of the forces that it sets, and of the
/// products and quotients on their way.
const RESTING: f64 = 64.0;
/// A sum of squares below the square of this has lost digits to underflow.
const SQUARES_VANISH: f64 = 1e-140;

/// The pair (velocity of the configuration, stored velocity) at the end or in the middle of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<V> {
    pub(crate) w: V,
    pub(crate) v: V,
}

impl<V> Pair<V> {
    fn get<T: Single>(&self, i: usize) -> T
    where
        V: Vector<T>,
    {
        if i < V::DIM { self.w.component(i) } else { self.v.component(i - V::DIM) }
    }

    fn from_fn<T: Single>(mut f: impl FnMut(usize) -> T) -> Self
    where
        V: Vector<T>,
    {
        let w = V::from_fn(&mut f);
        Pair { w, v: V::from_fn(|i| f(V::DIM + i)) }
    }

    fn norm<T: Single>(&self) -> f64
    where
        V: Vector<T>,
    {
        let components = || (0..2 * V::DIM).map(|i| self.get::<T>(i).to_f64());
        let norm = components().map(|x| x.powi(2)).sum::<f64>().sqrt();
        // Squares of small numbers vanish, the numbers do not.
        if norm < SQUARES_VANISH { components().fold(0.0, f64::hypot) } else { norm }
    }
}

/// The velocity that moves `q` by its own size within the time `h`: a velocity rounds to no less than epsilon times this where
/// only its effect on the configuration matters. 0 for h = 0.
pub(crate) fn crossing_speed<Q: Space<Scalar: Single>>(q: &Q, h: Q::Scalar) -> f64 {
    let speed = q.size().to_f64() / h.to_f64().abs();
    if speed.is_finite() { speed } else { 0.0 }
}

/// A zero of `residual` near `guess`, to rounding; `None` where the iteration does not converge.
///
/// At rest under a load the forces cancel, and the residual is the rounding of forces that the configuration sets: large beside the
/// unknowns, which are next to nothing. There a correction is rounding if it moves the configuration by no more than its rounding
/// within the step, `RESTING` epsilon `crossing_speed`. The residual comes as a pointer: the iteration is compiled once for each
/// kind of vector, not for each model.
pub(crate) fn solve<T: Single, V: Vector<T>>(
    guess: Pair<V>,
    crossing_speed: f64,
    residual: &dyn Fn(&Pair<V>) -> Pair<V>,
) -> Option<Pair<V>> {
    let mut z = guess;
    // z - g(z) with g of the size of h: the identity is the Jacobian of a small step, and costs no evaluation.
    let mut jacobian: Option<LU<f64, Dyn, Dyn>> = None;
    let (mut renew, mut at_rest) = (false, false);
    let mut last = f64::INFINITY;
    let mut largest = z.norm::<T>();
    let at_guess = residual(&guess);
    for iteration in 0..MOST_ITERATIONS {
        let mut r = if iteration == 0 { at_guess } else { residual(&z) };
        let fresh = renew;
        if renew {
            if jacobian.is_none() {
                // The identity is slow at this step, or leads away: back to the guess.
                (z, r, largest, last) = (guess, at_guess, guess.norm::<T>(), f64::INFINITY);
            }
            let of_terms = if at_rest { largest.max(crossing_speed) } else { largest };
            jacobian = Some(decompose(&z, &r, of_terms, residual)?);
        }
        let correction = match &jacobian {
            None => r,
            Some(lu) => {
                let right = DVector::from_fn(2 * V::DIM, |i, _| r.get::<T>(i).to_f64());
                let solution = lu.solve(&right)?;
                Pair::from_fn(|i| T::lit(solution[i]))
            }
        };
        let size = correction.norm::<T>();
        let moves = Pair { v: V::zero(), ..correction }.norm::<T>();
        if !size.is_finite() {
            return None;
        }
        z = Pair { w: z.w - correction.w, v: z.v - correction.v };
        // The last correction was applied: what remains is its square, or `SLOW` of it.
        let norm = z.norm::<T>().max(tiny::<T>());
        // The residual rounds as the terms it is the difference of, of which the guess and the iterates are made: where they
        // cancel (a velocity passing through zero), corrections stop shrinking above the rounding of z itself; by how much
        // more in a stiff system its stiffness decides. A correction that a Jacobian of this very place does not shrink is
        // rounding, if it is small at all.
        largest = largest.max(norm);
        if at_rest && fresh && moves <= RESTING * T::EPSILON * crossing_speed {
            return Some(z);
        }
        if size <= 0.25 * T::EPSILON * norm
            || (size <= 16.0 * T::EPSILON * largest && (size >= 0.5 * last || fresh))
            || (size <= T::EPSILON.sqrt() * largest && size >= 0.5 * last && fresh)
            || size == 0.0
        {
            return Some(z);
        }
        // A new Jacobian that does not shrink a correction which hardly moves the configuration was lost in the configuration's
        // rounding: the next one takes larger differences.
        at_rest |= fresh && size > SLOW * last && moves <= T::EPSILON.sqrt() * crossing_speed;
        renew = size > SLOW * last;
        last = size;
    }
    None
}

/// LU decomposition of the Jacobian by forward differences; the residual's own unknowns come first in every row.
fn decompose<T: Single, V: Vector<T>>(
    z: &Pair<V>,
    r: &Pair<V>,
    largest: f64,
    residual: &dyn Fn(&Pair<V>) -> Pair<V>,
) -> Option<LU<f64, Dyn, Dyn>> {
    let n = 2 * V::DIM;
    // Where the terms of the residual are larger than the unknowns, a difference scaled to these would be lost in them.
    let scale = largest.max(r.norm::<T>()).max(tiny::<T>());
    if !scale.is_finite() {
        return None;
    }
    let root = T::EPSILON.sqrt();
    let mut jacobian = DMatrix::zeros(n, n);
    for j in 0..n {
        let delta = T::lit(root * (z.get::<T>(j).to_f64().abs() + scale));
        let moved = Pair::from_fn(|i| if i == j { z.get::<T>(i) + delta } else { z.get(i) });
        let change = residual(&moved);
        for i in 0..n {
            jacobian[(i, j)] = ((change.get::<T>(i) - r.get(i)) / delta).to_f64();
        }
    }
    jacobian.iter().all(|x: &f64| x.is_finite()).then(|| jacobian.lu())
}

/// The number of which epsilon is the distance between denormal numbers: below it, all numbers round alike.
fn tiny<T: Single>() -> f64 {
    let is_single = T::lit(f64::MIN_POSITIVE).to_f64() == 0.0;
    let denormal = if is_single { f64::from(f32::from_bits(1)) } else { f64::from_bits(1) };
    denormal / T::EPSILON
}

/// A vector that says 'no solution' in the one way the driver understands.
pub(crate) fn no_solution<T: Single, V: Vector<T>>() -> V {
    V::from_fn(|_| T::lit(f64::NAN))
}
