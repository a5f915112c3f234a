//! Polynomial motions x(t) of a degree up to a method's order are found exactly, and no others.
//!
//! The force is a function of the time alone, so that only weights and stage times are seen here, not stages' states.

use faer::fx128;
use integrator::methods::{MethodId, Visitor};
use integrator::{Method, Model, Single, State, drive};
use nalgebra::Vector1;

/// x = sum c_k t^k with c_k below: dyadic, and none zero.
struct Polynomial {
    degree: u32,
}

const COEFFICIENTS: [f64; 6] = [0.75, -1.25, 0.5, -0.375, 0.625, 1.5];

impl Polynomial {
    /// The `order`-th derivative at t.
    fn derivative<T: Single>(&self, order: u32, t: T) -> T {
        (order..=self.degree).rev().fold(T::lit(0.0), |sum, k| {
            let factor: f64 = (k - order + 1..=k).map(f64::from).product();
            sum * t + T::lit(COEFFICIENTS[k as usize] * factor)
        })
    }
    fn exact<T: Single>(&self, t: T) -> State<Vector1<T>> {
        State { q: Vector1::new(self.derivative(0, t)), v: Vector1::new(self.derivative(1, t)) }
    }
}

impl<T: Single> Model<T> for Polynomial {
    type Config = Vector1<T>;
    fn rate(&self, t: T, _s: &State<Vector1<T>>) -> Vector1<T> {
        Vector1::new(self.derivative(2, t))
    }
}

const STEPS: u64 = 24;

/// The errors of position and velocity after 24 steps of 1/8.
struct ErrorAtTheEnd<'a>(&'a Polynomial);

impl<T: Single> Visitor<T, Polynomial> for ErrorAtTheEnd<'_> {
    type Output = [f64; 2];
    fn visit<A: Method<T, Polynomial>>(self, method: &A) -> [f64; 2] {
        let end = drive::advance(method, self.0, self.0.exact(T::lit(0.0)), T::lit(0.125), STEPS).expect("finite");
        let truth = self.0.exact(T::lit(3.0));
        [end.q.x - truth.q.x, end.v.x - truth.v.x].map(|d| d.to_f64().abs())
    }
}

/// Numbers of size 600 at most (t = 3, 1.5 t^5 and its derivative), a rounding of half an eps for each of the two updates of a
/// step and a handful within it.
fn rounding<T: Single>() -> f64 {
    600.0 * 4.0 * STEPS as f64 * T::EPSILON
}

fn exact_up_to_the_order<T: Single>() {
    for &method in MethodId::ALL {
        for degree in 0..=5 {
            let polynomial = Polynomial { degree };
            let [x, v] = method.visit::<T, _, _>(ErrorAtTheEnd(&polynomial));
            if degree <= method.order() {
                assert!(x.max(v) <= rounding::<T>(), "{} degree {degree}: {x:e} {v:e}", method.id());
            } else {
                // The first term that is missed: c_5 h^5 / (a few dozen) a step at least.
                assert!(x > 1e-4, "{} should not find degree {degree}: {x:e}", method.id());
            }
        }
    }
}

// Fails if: the stage times of any method move (RK4's middle stages to t + h, Verlet's second force to t, ...), or a weight of RK4
// (h / 6 instead of 2 h / 6 for a middle stage).
#[test]
fn every_method_finds_polynomials_up_to_its_order_and_no_higher() {
    exact_up_to_the_order::<f64>();
    exact_up_to_the_order::<fx128>();
}
