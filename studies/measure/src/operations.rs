//! Counting arithmetic operations exactly: a number that remembers how many were done.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use integrator::pose::{Pose, Twist};
use integrator::{Method, Model, Real, Rotation, State};
use nalgebra::SMatrix;

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
}

/// A number whose operations are counted: one each for + - * / and the square root, [`TRANSCENDENTAL`] for a sine, a
/// cosine or both parts of a small rotation. Negation and absolute value are free: they move a bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counting(f64);

/// Operations of a sine and a cosine together: two polynomials of eight terms.
pub const TRANSCENDENTAL: u64 = 32;

fn count(operations: u64) {
    OPERATIONS.with(|total| total.set(total.get() + operations));
}

macro_rules! operator {
    ($($operator:ident $function:ident $assigning:ident $assign:ident;)*) => {$(
        impl $operator for Counting {
            type Output = Counting;
            fn $function(self, other: Counting) -> Counting {
                count(1);
                Counting(self.0.$function(other.0))
            }
        }
        impl $assigning for Counting {
            fn $assign(&mut self, other: Counting) {
                *self = self.$function(other);
            }
        }
    )*};
}
operator! {
    Add add AddAssign add_assign;
    Sub sub SubAssign sub_assign;
    Mul mul MulAssign mul_assign;
    Div div DivAssign div_assign;
}

impl Neg for Counting {
    type Output = Counting;
    fn neg(self) -> Counting {
        Counting(-self.0)
    }
}

impl Real for Counting {
    fn lit(x: f64) -> Self {
        Counting(x)
    }
    fn sqrt(self) -> Self {
        count(1);
        Counting(self.0.sqrt())
    }
    fn abs(self) -> Self {
        Counting(self.0.abs())
    }
    fn sin_cos(self) -> (Self, Self) {
        count(TRANSCENDENTAL);
        let (sine, cosine) = self.0.sin_cos();
        (Counting(sine), Counting(cosine))
    }
    fn cos_sinc(x_squared: Self) -> (Self, Self) {
        count(TRANSCENDENTAL);
        let (cosine, sinc) = f64::cos_sinc(x_squared.0);
        (Counting(cosine), Counting(sinc))
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

/// The same state in numbers that count.
pub trait Lift {
    /// The state.
    type Lifted;
    /// Lifts it, without an operation.
    fn lift(&self) -> Self::Lifted;
}

impl<const R: usize, const C: usize> Lift for State<SMatrix<f64, R, C>> {
    type Lifted = State<SMatrix<Counting, R, C>>;
    fn lift(&self) -> Self::Lifted {
        State { q: self.q.map(Counting), v: self.v.map(Counting) }
    }
}

impl<U: integrator::pose::Update, const R: usize> Lift for State<Pose<f64, U, SMatrix<f64, R, 1>>> {
    type Lifted = State<Pose<Counting, U, SMatrix<Counting, R, 1>>>;
    fn lift(&self) -> Self::Lifted {
        let attitude = Rotation { w: Counting(self.q.attitude.w), v: self.q.attitude.v.map(Counting) };
        State {
            q: Pose::new(self.q.position.map(Counting), attitude),
            v: Twist { linear: self.v.linear.map(Counting), angular: self.v.angular.map(Counting) },
        }
    }
}

/// Operations of one step from this state.
pub fn of_step<M: Model<Counting>, A: Method<Counting, M>>(method: &A, model: &M, start: State<M::Config>) -> u64 {
    OPERATIONS.with(|total| total.set(0));
    // A hundredth of a second: no small angle of a step leaves the polynomials.
    let end = method.step(model, Counting(0.0), Counting(0.01), start);
    let _ = end;
    OPERATIONS.with(Cell::get)
}

#[cfg(test)]
mod tests {
    use super::*;
    use integrator::methods::{Rk4, SemiImplicitEuler};
    use nalgebra::Vector1;

    /// x'' = -x: one negation, which is free.
    struct Spring;
    impl<T: Real> Model<T> for Spring {
        type Config = Vector1<T>;
        fn rate(&self, _t: T, s: &State<Vector1<T>>) -> Vector1<T> {
            -s.q
        }
    }

    #[test]
    fn semi_implicit_euler_takes_two_multiplications_and_two_additions() {
        let start = State { q: Vector1::new(1.0), v: Vector1::new(0.5) }.lift();
        assert_eq!(of_step(&SemiImplicitEuler, &Spring, start), 4);
        assert!(of_step(&Rk4, &Spring, start) > 16);
    }
}
