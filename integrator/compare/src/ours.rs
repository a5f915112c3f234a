//! The integrator on the problems: every method, in plain and in fused arithmetic.

use std::hint::black_box;

use integrator::counted::Counted;
use integrator::lanes::Fused;
use integrator::methods::{
    ExplicitEuler, FreeSplitting, ImplicitEuler, ImplicitGyroscopic, ImplicitMidpoint, MomentumMidpoint,
    RestoredMomentum, Rk4, SemiImplicitEuler, VelocityVerlet,
};
use integrator::pose::Fixed;
use integrator::rigid_body::{BodyOmega, Kinematics, RigidBody, RigidModel, WorldMomentum, WorldOmega};
use integrator::{Method, Model, Real, Rotation, State, Vector, drive};
use nalgebra::{SVector, Vector3};

use crate::problem::Spin;

/// One number, out of its arithmetic.
pub trait Plain: Real {
    /// Its value.
    fn plain(self) -> f64;
}

impl Plain for f64 {
    #[inline(always)]
    fn plain(self) -> f64 {
        self
    }
}

impl Plain for Fused<f64> {
    #[inline(always)]
    fn plain(self) -> f64 {
        self.0
    }
}

/// A fixed-step method in an arithmetic, ready to run to a horizon in so many steps.
pub struct Solver<'a, const N: usize> {
    /// The method, and what is stored where that is a choice.
    pub method: String,
    /// `f64` or `fused f64`.
    pub arithmetic: &'static str,
    /// y(T) after so many steps from the start; NaN where the run diverged.
    pub run: Box<dyn Fn(u64) -> [f64; N] + 'a>,
    /// Evaluations of the force law in a run of so many steps.
    pub evaluations: Box<dyn Fn(u64) -> u64 + 'a>,
}

/// Particles: the first half of y is the configuration, the second the velocity.
pub fn flat<T: Plain, M: Model<T, Config = SVector<T, D>>, A: Method<T, M>, const D: usize, const N: usize>(
    (method, model): (&A, &M),
    y0: [f64; N],
    end_s: f64,
    steps: u64,
) -> [f64; N] {
    let y0 = black_box(y0);
    let start = State { q: SVector::from_fn(|i, _| T::lit(y0[i])), v: SVector::from_fn(|i, _| T::lit(y0[D + i])) };
    let h = T::lit(black_box(end_s) / steps as f64);
    match drive::advance(method, model, start, h, steps) {
        Ok(s) => std::array::from_fn(|i| if i < D { s.q[i].plain() } else { s.v[i - D].plain() }),
        Err(_) => [f64::NAN; N],
    }
}

/// The same, handing out every state as the libraries do.
pub fn flat_stored<M: Model<f64, Config = SVector<f64, D>>, A: Method<f64, M>, const D: usize, const N: usize>(
    (method, model): (&A, &M),
    y0: [f64; N],
    end_s: f64,
    steps: u64,
) -> [f64; N] {
    let y0 = black_box(y0);
    let start = State { q: SVector::from_fn(|i, _| y0[i]), v: SVector::from_fn(|i, _| y0[D + i]) };
    let h = black_box(end_s) / steps as f64;
    let mut stored = Vec::with_capacity(steps as usize + 1);
    let end = drive::integrate(method, model, start, h, steps, |i, s| stored.push((i as f64 * h, *s)));
    black_box(stored);
    end.map_or([f64::NAN; N], |s| std::array::from_fn(|i| if i < D { s.q[i] } else { s.v[i - D] }))
}

/// A body without a position: y is its quaternion and its angular velocity in the body frame.
pub fn spin<T: Plain, M: RigidModel<T>, A: Method<T, M>>(
    (method, model): (&A, &M),
    y0: [f64; 7],
    end_s: f64,
    steps: u64,
) -> [f64; 7]
where
    M::Body: RigidBody<T, Position = Fixed<T>>,
{
    let y0 = black_box(y0).map(T::lit);
    let at = Kinematics {
        position: Vector::zero(),
        velocity: Vector::zero(),
        attitude: Rotation { w: y0[0], v: Vector3::new(y0[1], y0[2], y0[3]) },
        omega_body: Vector3::new(y0[4], y0[5], y0[6]),
    };
    let h = T::lit(black_box(end_s) / steps as f64);
    match drive::advance(method, model, model.state(&at), h, steps) {
        Ok(s) => {
            let at = model.kinematics(&s);
            let ([w, x, y, z], omega) = (at.attitude.wxyz(), at.omega_body);
            [w, x, y, z, omega.x, omega.y, omega.z].map(T::plain)
        }
        Err(_) => [f64::NAN; 7],
    }
}

macro_rules! flat_solvers {
    ($scene:ident, $y0:ident, $end_s:ident; $($arithmetic:ty, $name:literal: $($method:ident),*;)*) => {
        vec![$($(Solver {
            method: stringify!($method).to_owned(),
            arithmetic: $name,
            run: Box::new(move |n| flat::<$arithmetic, _, _, D, N>((&$method, &*black_box($scene)), $y0, $end_s, n)),
            evaluations: Box::new(move |n| {
                let counted = Counted::new($scene);
                flat::<$arithmetic, _, _, D, N>((&$method, &counted), $y0, $end_s, n);
                counted.evaluations()
            }),
        }),*),*]
    };
}

/// Every method on a scene of particles.
pub fn flat_solvers<'a, S, const D: usize, const N: usize>(scene: &'a S, y0: [f64; N], end_s: f64) -> Vec<Solver<'a, N>>
where
    S: Model<f64, Config = SVector<f64, D>> + Model<Fused<f64>, Config = SVector<Fused<f64>, D>>,
{
    flat_solvers! { scene, y0, end_s;
        f64, "f64": ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4, ImplicitEuler, ImplicitMidpoint;
        Fused<f64>, "fused f64": ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4;
    }
}

macro_rules! spin_solvers {
    ($scene:ident, $y0:ident, $end_s:ident; $($arithmetic:ty, $name:literal, $model:ident: $($method:ident),*;)*) => {
        vec![$($(Solver {
            method: concat!(stringify!($method), ", ", stringify!($model)).to_owned(),
            arithmetic: $name,
            run: Box::new(move |n| {
                let model = $model::<_>::new(&*black_box($scene));
                spin::<$arithmetic, _, _>((&$method, &model), $y0, $end_s, n)
            }),
            evaluations: Box::new(move |n| {
                let model = $model::<_>::new(Counted::new($scene));
                spin::<$arithmetic, _, _>((&$method, &model), $y0, $end_s, n);
                model.0.evaluations()
            }),
        }),*),*]
    };
}

/// Every method on the free body, for what each may store.
pub fn spin_solvers(scene: &Spin, y0: [f64; 7], end_s: f64) -> Vec<Solver<'_, 7>> {
    spin_solvers! { scene, y0, end_s;
        f64, "f64", BodyOmega: ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4, ImplicitEuler, ImplicitMidpoint,
            ImplicitGyroscopic, RestoredMomentum, FreeSplitting;
        Fused<f64>, "fused f64", BodyOmega: ExplicitEuler, SemiImplicitEuler, VelocityVerlet, Rk4, FreeSplitting;
        f64, "f64", WorldOmega: SemiImplicitEuler, VelocityVerlet, Rk4;
        Fused<f64>, "fused f64", WorldOmega: SemiImplicitEuler, VelocityVerlet, Rk4;
        f64, "f64", WorldMomentum: SemiImplicitEuler, VelocityVerlet, Rk4, MomentumMidpoint;
        Fused<f64>, "fused f64", WorldMomentum: SemiImplicitEuler, VelocityVerlet, Rk4, MomentumMidpoint;
    }
}
