//! The solver the implicit methods share: Newton's iteration in the tangent space.
//!
//! The direction is found in `f64`, only the residual is in `T`: an approximate Jacobian costs iterations, not accuracy.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::real::Single;
use crate::space::Vector;

/// Newton steps before the iteration is given up.
const MOST_ITERATIONS: usize = 50;
/// The Jacobian is computed anew when an iteration shrinks the correction by less than this factor.
const SLOW: f64 = 0.1;

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
        (0..2 * V::DIM).map(|i| self.get::<T>(i).to_f64().powi(2)).sum::<f64>().sqrt()
    }
}

/// A zero of `residual` near `guess`, to rounding; `None` where the iteration does not converge.
///
/// The residual comes as a pointer: the iteration is compiled once for each kind of vector, not for each model.
pub(crate) fn solve<T: Single, V: Vector<T>>(
    guess: Pair<V>,
    residual: &dyn Fn(&Pair<V>) -> Pair<V>,
) -> Option<Pair<V>> {
    let mut z = guess;
    // z - g(z) with g of the size of h: the identity is the Jacobian of a small step, and costs no evaluation.
    let mut jacobian: Option<LU<f64, Dyn, Dyn>> = None;
    let mut renew = false;
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
            jacobian = Some(decompose(&z, &r, largest, residual)?);
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
        if size <= 0.25 * T::EPSILON * norm
            || (size <= 16.0 * T::EPSILON * largest && (size >= 0.5 * last || fresh))
            || (size <= T::EPSILON.sqrt() * largest && size >= 0.5 * last && fresh)
            || size == 0.0
        {
            return Some(z);
        }
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

/// What is smaller counts as zero: far enough above where `T`, or a square in `f64`, underflows.
fn tiny<T: Single>() -> f64 {
    if T::lit(1e-150).to_f64() > 0.0 { 1e-150 } else { 1e-30 }
}

/// A vector that says 'no solution' in the one way the driver understands.
pub(crate) fn no_solution<T: Single, V: Vector<T>>() -> V {
    V::from_fn(|_| T::lit(f64::NAN))
}
