//! A charge in a constant electric and magnetic field: m v' = q (E + v x B).
//!
//! With W = (q / m) B, b = W / |W|, a = (q / m) E, drift u = a x W / W^2 and w = v0_perp - u:
//! v = (v_par + a_par t) b + u + w cos|W|t + (w x b) sin|W|t and
//! x = x0 + (v_par t + a_par t^2 / 2) b + u t + w sin(|W|t) / |W| + (w x b)(1 - cos|W|t) / |W|.
//! Source: J. D. Jackson, Classical Electrodynamics (1999), 12.2 and 12.3 (non-relativistic).

use faer::fx128;
use integrator::methods::MethodId;
use integrator::rotation::{cross, dot};
use integrator::{Model, Real, Single, State};
use nalgebra::{DMatrix, Vector3};

use crate::catalogue::constant_force::lit;
use crate::catalogue::linear::{Linear, Parts};
use crate::error::Error;
use crate::invariants::{Balance, Entry};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Scene};
use crate::theory::Law;
use crate::theory::{ExpectedGrowth, StabilityLimit, Theory};

scene_parameters! {
    /// A charged particle in constant fields.
    pub struct ChargedParticle {
        /// Mass.
        mass: f64 = 0.75, "kg", Positive;
        /// Charge.
        charge: f64 = -0.9375, "C", Finite;
        /// Electric field.
        electric: [f64; 3] = [0.375, -0.25, 0.625], "V/m", Finite;
        /// Magnetic field.
        magnetic: [f64; 3] = [0.5, 1.0, -1.25], "T", Finite;
        /// Position at the start.
        x0: [f64; 3] = [0.5, -1.25, 2.0], "m", Finite;
        /// Velocity at the start.
        v0: [f64; 3] = [1.5, 0.75, -0.5], "m/s", Finite;
    }
}

impl ChargedParticle {
    /// A magnetic field alone, and a velocity across it: a circle.
    pub fn magnetic() -> Self {
        ChargedParticle { electric: [0.0; 3], v0: [1.75, 0.375, 1.0], ..Self::default() }
    }

    /// |W| = |q| |B| / m, rad/s.
    pub fn gyration(&self) -> f64 {
        self.charge.abs() / self.mass * Vector3::from(self.magnetic).norm()
    }

    fn is_a_circle(&self) -> bool {
        self.electric == [0.0; 3] && Vector3::from(self.magnetic).dot(&Vector3::from(self.v0)) == 0.0
    }

    fn linear(&self) -> Linear {
        let ratio = self.charge / self.mass;
        let [x, y, z] = self.magnetic.map(|b| b * ratio);
        Linear::new(&Parts {
            stiffness: DMatrix::zeros(3, 3),
            // v x W
            damping: DMatrix::from_row_slice(3, 3, &[0.0, z, -y, -z, 0.0, x, y, -x, 0.0]),
            forcing: &self.electric.map(|e| e * ratio),
            drive: 0.0,
            q0: &self.x0,
            v0: &self.v0,
        })
    }
}

impl<T: Real> Model<T> for ChargedParticle {
    type Config = Vector3<T>;

    #[inline(always)]
    fn rate(&self, _t: T, s: &State<Vector3<T>>) -> Vector3<T> {
        let field = lit::<T>(self.electric) + cross(s.v, lit(self.magnetic));
        field * (T::lit(self.charge) / T::lit(self.mass))
    }
}

impl<T: Single> Motion<T> for ChargedParticle {
    fn exact(&self, t: T) -> State<Vector3<T>> {
        let t = t.widen();
        let ratio = fx128::lit(self.charge) / fx128::lit(self.mass);
        let rate = lit::<fx128>(self.magnetic) * ratio;
        let push = lit::<fx128>(self.electric) * ratio;
        let square = dot(rate, rate);
        let size = square.sqrt();
        let (b, v0) = (rate / size, lit::<fx128>(self.v0));
        let drift = cross(push, rate) / square;
        let (along, push_along) = (dot(v0, b), dot(push, b));
        let w = v0 - b * along - drift;
        let (sine, cosine) = (size * t).sin_cos();
        // 1 - cos without cancellation
        let half_sine = (size * t * fx128::lit(0.5)).sin_cos().0;
        let versine = fx128::lit(2.0) * half_sine * half_sine;
        let sideways = cross(w, b);
        let travel = along * t + push_along * t * t * fx128::lit(0.5);
        rounded(
            lit::<fx128>(self.x0) + b * travel + drift * t + (w * sine + sideways * versine) / size,
            b * (along + push_along * t) + drift + w * cosine + sideways * sine,
        )
    }
    fn observe(&self, s: &State<Vector3<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for ChargedParticle {
    fn info(&self) -> Info {
        Info {
            about: "a charge in crossed fields: the force depends on the velocity, and both Eulers gain energy alike",
            equation: r"m\,\dot{\mathbf v} = q\,(\mathbf E + \mathbf v\times\mathbf B)",
            source: "J. D. Jackson, Classical Electrodynamics (1999), 12.2 and 12.3",
            horizon_s: 2.25,
            time_scale_s: 1.0 / self.gyration(),
            coarsest_steps: 8,
        }
    }

    fn check(&self) -> Result<(), Error> {
        if self.gyration() > 0.0 {
            return Ok(());
        }
        Err(Error::Parameter {
            scene: "charged-particle".to_owned(),
            parameter: "magnetic".to_owned(),
            value: format!("{:?} with charge {}", self.magnetic, self.charge),
            expected: "a charge and a magnetic field that are not zero; without them it is the scene constant-force"
                .to_owned(),
        })
    }

    fn account(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let mass = fx128::lit(self.mass);
        let kinetic = v.iter().fold(fx128::ZERO, |sum, &c| sum + c * c) * mass * fx128::lit(0.5);
        let field = x.iter().zip(self.electric).fold(fx128::ZERO, |sum, (&c, e)| sum + c * fx128::lit(e));
        let energy = kinetic - field * fx128::lit(self.charge);
        vec![
            Entry { balance: Balance::Energy, value: vec![energy], conserved: true },
            Entry { balance: Balance::Momentum, value: v.iter().map(|&c| c * mass).collect(), conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity) -> Theory {
        self.linear().theory(method, quantity, self.info().horizon_s)
    }

    fn growth(&self, method: MethodId, balance: Balance, h_s: f64) -> Option<ExpectedGrowth> {
        let z = self.gyration() * h_s;
        let rate = |excess: f64, reason| ExpectedGrowth {
            law: Law::Exponential,
            bounds: Some([excess.ln_1p() / h_s; 2]),
            reason,
        };
        let growth = match method {
            MethodId::ExplicitEuler | MethodId::SemiImplicitEuler => {
                rate(z * z, "v^2 grows by 1 + z^2 a step, z = |W| h: the force depends on the velocity alone")
            }
            MethodId::VelocityVerlet => rate(z.powi(4) / 4.0, "v^2 grows by 1 + z^4/4 a step: Heun's method for v"),
            MethodId::Rk4 => {
                rate(-z.powi(6) / 72.0 + z.powi(8) / 576.0, "v^2 shrinks by 1 - z^6/72 + z^8/576 a step, z = |W| h")
            }
            MethodId::ImplicitEuler => {
                rate(1.0 / (1.0 + z * z) - 1.0, "v^2 shrinks by 1 / (1 + z^2) a step, z = |W| h")
            }
            MethodId::ImplicitMidpoint => ExpectedGrowth {
                law: Law::AtTheFloor,
                bounds: None,
                reason: "v^2 is a quadratic invariant, conserved exactly",
            },
        };
        (balance == Balance::Energy && self.is_a_circle()).then_some(growth)
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        Some(match method {
            MethodId::ExplicitEuler | MethodId::SemiImplicitEuler => (StabilityLimit::NoStep, "|R(i z)|^2 = 1 + z^2"),
            MethodId::VelocityVerlet => (StabilityLimit::NoStep, "|R(i z)|^2 = 1 + z^4/4: Heun's method for v"),
            MethodId::Rk4 => {
                (StabilityLimit::Below(8.0_f64.sqrt() / self.gyration()), "|R(i z)|^2 = 1 - z^6/72 + z^8/576")
            }
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
        })
    }
}
