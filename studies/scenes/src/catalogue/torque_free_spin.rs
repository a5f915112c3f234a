//! A free asymmetric rigid body: I omega' = -omega x I omega in the body frame, q' = q (0, omega) / 2.
//!
//! The angular velocity is Jacobi's, the attitude needs a third elliptic integral: see [`FreeTop`].

use faer::fx128;
use integrator::pose::Fixed;
use integrator::rigid_body::{Kinematics, RigidBody, Torque};
use integrator::{Real, Single};
use nalgebra::Vector3;

use crate::catalogue::constant_force::lit;
use crate::catalogue::rigid;
use crate::error::Error;
use crate::invariants::Entry;
use crate::motion::RigidMotion;
use crate::observation::Observation;
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, period, time_scale};
use crate::special::free_top::FreeTop;

scene_parameters! {
    /// A free rigid body with three unequal moments of inertia.
    pub struct TorqueFreeSpin {
        /// Principal moments of inertia.
        inertia: [f64; 3] = [1.25, 0.75, 1.75], "kg m^2", Positive;
        /// Attitude at the start as a quaternion (w, x, y, z), normalised before use.
        attitude: [f64; 4] = [0.5, -0.75, 1.0, 0.25], "1", Finite;
        /// Angular velocity at the start, in the body frame.
        omega: [f64; 3] = [1.5, -0.75, 1.0], "rad/s", Finite;
    }
}

impl TorqueFreeSpin {
    /// Started near the unstable axis of the intermediate moment, about which it tumbles.
    pub fn tennis_racket() -> Self {
        Self { inertia: [0.75, 1.0, 1.5], omega: [0.0625, 2.5, -0.125], ..Self::default() }
    }
}

impl<T: Real> RigidBody<T> for TorqueFreeSpin {
    type Position = Fixed<T>;

    #[inline(always)]
    fn inertia(&self) -> Vector3<T> {
        lit(self.inertia)
    }
    #[inline(always)]
    fn torque(&self, _t: T, _at: &Kinematics<T, Fixed<T>>) -> Torque<T> {
        Torque::None
    }
}

impl<T: Single> RigidMotion<T> for TorqueFreeSpin {
    fn exact(&self, t: T) -> Kinematics<T, Fixed<T>> {
        let (attitude, omega_body) = FreeTop::new(self.inertia, self.attitude, self.omega).at(t);
        rigid::fixed_point(attitude, omega_body)
    }
}

impl Scene for TorqueFreeSpin {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.25, coarsest_steps: 8 }.at(Vector3::from(self.omega).norm() / 1.95);
        Info {
            kind: Kind::FreeBody,
            about: "a free body with three unequal moments of inertia: only the gyroscopic term acts",
            equation: r"I\,\dot{\omega} = I\omega\times\omega,\quad \dot q = \tfrac12\,q\,\omega,\quad I = \mathrm{diag}(I_1, I_2, I_3)",
            source: "Jacobi 1849; attitude by Legendre's third integral (E. Celledoni et al., SIAM J. Sci. Comput. 30 (2008))",
            horizon_s: pace.horizon_s,
            time_scale_s: time_scale(Vector3::from(self.omega).norm()),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        rigid::check("torque-free-spin", self.inertia, self.attitude)?;
        rigid::check_free("torque-free-spin", &self.info(), &self.omega)
    }

    fn amplification(&self, end_s: f64) -> f64 {
        rigid::free_amplification(self.inertia, self.omega, end_s)
    }

    fn period_s(&self) -> Option<f64> {
        period(Vector3::from(self.omega).norm())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        rigid::invariants(self.inertia, seen, fx128::ZERO, true, true)
    }
}
