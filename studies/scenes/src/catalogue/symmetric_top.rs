//! A free body with two equal moments of inertia (I1, I1, I3), in elementary functions: see [`Exact`].
//!
//! Semi-implicit Euler that stores omega in the world frame multiplies omega_1 + i omega_2 by 1 + i x a step,
//! x = (I3 / I1 - 1) omega_3 h, and keeps omega_3: R^T omega of the new attitude is that of the old one plus h I^-1 (l x omega).

use faer::fx128;
use integrator::methods::MethodId;
use integrator::pose::Fixed;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Real, Single};
use nalgebra::Vector3;

use crate::catalogue::answerable;
use crate::catalogue::constant_force::lit;
use crate::catalogue::rigid;
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::RigidMotion;
use crate::observation::Observation;
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, period, time_scale};
use crate::special::symmetric_top::SymmetricTop as Exact;
use crate::theory::Law;
use crate::theory::{ExpectedGrowth, StabilityLimit};

scene_parameters! {
    /// A free rigid body with an axis of symmetry.
    pub struct SymmetricTop {
        /// Moment of inertia across the axis of symmetry.
        inertia_1: f64 = 1.25, "kg m^2", Positive;
        /// Moment of inertia about the axis of symmetry, the third of the body.
        inertia_3: f64 = 2.25, "kg m^2", Positive;
        /// Attitude at the start as a quaternion (w, x, y, z), normalised before use.
        attitude: [f64; 4] = [0.5, -0.75, 1.0, 0.25], "1", Finite;
        /// Angular velocity at the start, in the body frame.
        omega: [f64; 3] = [0.5, -0.25, 1.5], "rad/s", Finite;
    }
}

impl SymmetricTop {
    /// Oblate: I3 > I1.
    pub fn disc() -> Self {
        Self::default()
    }

    /// Prolate: I3 < I1.
    pub fn rod() -> Self {
        Self { inertia_1: 1.75, inertia_3: 0.375, omega: [0.75, -0.5, 2.25], ..Self::default() }
    }

    fn inertia(&self) -> [f64; 3] {
        [self.inertia_1, self.inertia_1, self.inertia_3]
    }

    /// Whether the axis of symmetry is not the axis of rotation, and the moments are not equal.
    fn nutates(&self) -> bool {
        let [x, y, z] = self.omega;
        self.inertia_1 != self.inertia_3 && z != 0.0 && (x != 0.0 || y != 0.0)
    }
}

impl<T: Real> RigidBody<T> for SymmetricTop {
    type Position = Fixed<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        lit(self.inertia())
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

impl<T: Single> RigidMotion<T> for SymmetricTop {
    fn exact(&self, t: T) -> Kinematics<T, Fixed<T>> {
        let (attitude, omega_body) = Exact::new(self.inertia_1, self.inertia_3, self.attitude, self.omega).at(t);
        rigid::fixed_point(attitude, omega_body)
    }
}

impl Scene for SymmetricTop {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.25, coarsest_steps: 8 }.at(Vector3::from(self.omega).norm() / 1.6);
        Info {
            kind: Kind::FreeBody,
            about: "a free body with an axis of symmetry: it precesses about the momentum at a constant rate",
            equation: r"I\,\dot{\omega} = I\omega\times\omega,\quad \dot q = \tfrac12\,q\,\omega,\quad I = \mathrm{diag}(I_1, I_1, I_3)",
            source: "elementary (Landau and Lifshitz, Mechanics, section 35)",
            horizon_s: pace.horizon_s,
            time_scale_s: time_scale(Vector3::from(self.omega).norm()),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        rigid::check("symmetric-top", self.inertia(), self.attitude)?;
        let [x, y, z] = self.omega;
        let end_s = self.info().horizon_s;
        let phase = x.hypot(y).hypot(2.0 * z) * end_s;
        answerable::phase("symmetric-top", ("omega", &self.omega), phase, end_s)
    }

    fn period_s(&self) -> Option<f64> {
        period(Vector3::from(self.omega).norm())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        rigid::invariants(self.inertia(), seen, fx128::ZERO, true, true)
    }

    fn growth(&self, method: MethodId, invariant: Invariant, h_s: f64) -> Option<ExpectedGrowth> {
        let known = method == MethodId::SemiImplicitEuler && invariant == Invariant::Energy && self.nutates();
        let x = (self.inertia_3 / self.inertia_1 - 1.0) * self.omega[2] * h_s;
        known.then_some(ExpectedGrowth {
            law: Law::Exponential,
            bounds: None, // Before that exp(r t) - 1 is r t.
            seen_after_s: 8.0 * h_s / (x * x).ln_1p(),
            reason: "omega_3 stays, omega_1^2 + omega_2^2 grows by 1 + x^2 a step, x = (I3/I1 - 1) omega_3 h",
        })
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        let known = method == MethodId::SemiImplicitEuler && self.nutates();
        known.then_some((
            StabilityLimit::NoStep,
            "the nutation grows by sqrt(1 + x^2) a step, x = (I3/I1 - 1) omega_3 h",
        ))
    }
}
