//! A charge in a constant electric and magnetic field: m v' = q (E + v x B).
//!
//! With W = (q / m) B, b = W / |W|, a = (q / m) E, z = |W| t: v = R(t) v0 + R1 a and x = x0 + R1 v0 + R2 a, where for any u
//! R u = u_par + u_perp cos z + (u x b) sin z, and its integrals over the time are
//! R1 u = t (u_par + u_perp sin z / z + (u x b)(1 - cos z) / z), R2 u = t^2 (u_par / 2 + u_perp (1 - cos z) / z^2 + (u x b)(z - sin z) / z^2).
//! The drift a x W / W^2 is their limit, and nothing is divided by a field that is nearly zero.
//! Source: J. D. Jackson, Classical Electrodynamics (1999), 12.2 and 12.3 (non-relativistic).

use faer::fx128;
use integrator::methods::MethodId;
use integrator::rotation::{cross, dot};
use integrator::{Model, Real, Single, State};
use nalgebra::{DMatrix, Vector3};

use crate::catalogue::answerable;
use crate::catalogue::constant_force::lit;
use crate::catalogue::linear::{Linear, Parts};
use crate::error::Error;
use crate::invariants::{Entry, Invariant};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Kind, Pace, Scene, period};
use crate::special::elementary::{sinc, versine_over_square, x_minus_sin};
use crate::special::scaled::{Scaled, exponent_of_largest, sum_of_vectors, times_two_to};
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

    /// b = W / |W| (zero without a field) and |W| t, from q t / m.
    fn axis_and_phase(&self, gain: Scaled) -> (Vector3<fx128>, fx128) {
        let unit = exponent_of_largest(&self.magnetic);
        let field = lit::<fx128>(self.magnetic).map(|c| times_two_to(c, -unit));
        let size = dot(field, field).sqrt();
        let turn = gain.shifted(unit).times(Scaled::of_wide(size)).value();
        if size.0 == 0.0 || turn.0 == 0.0 {
            return (Vector3::repeat(fx128::ZERO), fx128::ZERO);
        }
        let sense = if turn.0 < 0.0 { -fx128::ONE } else { fx128::ONE };
        (field * (sense / size), Real::abs(turn))
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
        let (time, one) = (Scaled::of_wide(t.widen()), Scaled::of(1.0));
        let gain = Scaled::of(self.charge).over(Scaled::of(self.mass)).times(time);
        let (b, phase) = self.axis_and_phase(gain);
        let [x0, v0, electric] = [self.x0, self.v0, self.electric].map(lit::<fx128>);
        let (sine, cosine) = phase.sin_cos();
        let (first, second) = (sinc(phase), versine_over_square(phase) * phase);
        let third = if phase.0 < 1e-40 { fx128::ZERO } else { x_minus_sin(phase) / (phase * phase) };
        // What becomes of a velocity, its integral over the time, and the integral of that one, for a vector u.
        let parts = |u: Vector3<fx128>| {
            let along = b * dot(u, b);
            (along, u - along, cross(u, b))
        };
        let unit = exponent_of_largest(&self.v0.map(f64::abs));
        let (along, across, sideways) = parts(v0.map(|c| times_two_to(c, -unit)));
        let turned = along + across * cosine + sideways * sine;
        let moved = along + across * first + sideways * second;
        let push_unit = exponent_of_largest(&self.electric);
        let (along, across, sideways) = parts(electric.map(|c| times_two_to(c, -push_unit)));
        let pushed = along + across * first + sideways * second;
        let carried = along * fx128::lit(0.5) + across * versine_over_square(phase) + sideways * third;
        let (v, a) = (one.shifted(unit), gain.shifted(push_unit));
        rounded(
            sum_of_vectors([(one, x0), (v.times(time), moved), (a.times(time), carried)]),
            sum_of_vectors([(v, turned), (a, pushed)]),
        )
    }
    fn observe(&self, s: &State<Vector3<T>>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for ChargedParticle {
    fn info(&self) -> Info {
        let pace = Pace { horizon_s: 2.25, coarsest_steps: 8 }.at(self.gyration() / 2.0);
        Info {
            kind: Kind::Orbit,
            about: "a charge in crossed fields: the force depends on the velocity, and both Eulers gain energy alike",
            equation: r"m\,\dot{\mathbf v} = q\,(\mathbf E + \mathbf v\times\mathbf B)",
            source: "J. D. Jackson, Classical Electrodynamics (1999), 12.2 and 12.3",
            horizon_s: pace.horizon_s,
            time_scale_s: 1.0 / self.gyration(),
            coarsest_steps: pace.coarsest_steps,
        }
    }

    fn check(&self) -> Result<(), Error> {
        if self.gyration() > 0.0 {
            let end_s = self.info().horizon_s;
            let phase = self.gyration() * end_s;
            answerable::phase("charged-particle", ("magnetic", &self.magnetic), phase, end_s)?;
            let seen = Motion::<f64>::observe(self, &self.exact(end_s));
            return answerable::range("charged-particle", self, &seen, end_s);
        }
        Err(Error::Parameter {
            scene: "charged-particle".to_owned(),
            parameter: "magnetic".to_owned(),
            value: format!("{:?} with charge {}", self.magnetic, self.charge),
            expected: "a charge and a magnetic field that are not zero; without them it is the scene constant-force"
                .to_owned(),
        })
    }

    fn period_s(&self) -> Option<f64> {
        period(self.gyration())
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let (x, v) = (seen.vector(Quantity::Position), seen.vector(Quantity::Velocity));
        let mass = fx128::lit(self.mass);
        let kinetic = v.iter().fold(fx128::ZERO, |sum, &c| sum + c * c) * mass * fx128::lit(0.5);
        let field = x.iter().zip(self.electric).fold(fx128::ZERO, |sum, (&c, e)| sum + c * fx128::lit(e));
        let energy = kinetic - field * fx128::lit(self.charge);
        vec![
            Entry { invariant: Invariant::Energy, value: vec![energy], conserved: true },
            Entry { invariant: Invariant::Momentum, value: v.iter().map(|&c| c * mass).collect(), conserved: false },
        ]
    }

    fn theory(&self, method: MethodId, quantity: Quantity, end_s: f64) -> Theory {
        self.linear().theory(method, quantity, end_s)
    }

    fn growth(&self, method: MethodId, invariant: Invariant, h_s: f64) -> Option<ExpectedGrowth> {
        let z = self.gyration() * h_s;
        let rate = |excess: f64, reason| ExpectedGrowth {
            law: Law::Exponential,
            bounds: Some([excess.ln_1p() / h_s; 2]),
            seen_after_s: 0.0,
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
                seen_after_s: 0.0,
                reason: "v^2 is a quadratic invariant, conserved exactly",
            },
            _ => return None,
        };
        (invariant == Invariant::Energy && self.is_a_circle()).then_some(growth)
    }

    fn stability_limit(&self, method: MethodId) -> Option<(StabilityLimit, &'static str)> {
        Some(match method {
            MethodId::ExplicitEuler | MethodId::SemiImplicitEuler => (StabilityLimit::NoStep, "|R(i z)|^2 = 1 + z^2"),
            MethodId::VelocityVerlet => (StabilityLimit::NoStep, "|R(i z)|^2 = 1 + z^4/4: Heun's method for v"),
            MethodId::Rk4 => {
                (StabilityLimit::Below(8.0_f64.sqrt() / self.gyration()), "|R(i z)|^2 = 1 - z^6/72 + z^8/576")
            }
            MethodId::ImplicitEuler | MethodId::ImplicitMidpoint => (StabilityLimit::Unlimited, "A-stable"),
            _ => return None,
        })
    }
}
