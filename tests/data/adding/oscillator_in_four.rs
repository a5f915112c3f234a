//! A mass on a spring in four dimensions: x = x0 cos(w t) + v0 sin(w t) / w, w = sqrt(k / m).

use faer::fx128;
use integrator::{Model, Real, Single, State};
use nalgebra::{SVector, Vector4};

use crate::invariants::{Invariant, Entry};
use crate::motion::{Motion, rounded};
use crate::observation::{Observation, Quantity};
use crate::parameters::scene_parameters;
use crate::scene::{Info, Scene};

scene_parameters! {
    /// A mass on a spring that pulls alike in four directions.
    pub struct OscillatorInFour {
        /// Mass.
        mass: f64 = 1.75, "kg", Positive;
        /// Stiffness.
        stiffness: f64 = 6.5, "N/m", Positive;
        /// Position at the start.
        x0: [f64; 4] = [0.75, -0.5, 1.25, 0.25], "m", Finite;
        /// Velocity at the start.
        v0: [f64; 4] = [-0.5, 1.0, 0.375, -1.5], "m/s", Finite;
    }
}

impl<T: Real> Model<T> for OscillatorInFour {
    type Config = SVector<T, 4>;

    fn rate(&self, _t: T, s: &State<Self::Config>) -> SVector<T, 4> {
        s.q * (-T::lit(self.stiffness) / T::lit(self.mass))
    }
}

impl<T: Single> Motion<T> for OscillatorInFour {
    fn exact(&self, t: T) -> State<Self::Config> {
        let w = (fx128::lit(self.stiffness) / fx128::lit(self.mass)).sqrt();
        let (sine, cosine) = (w * t.widen()).sin_cos();
        let (x0, v0) = (Vector4::from(self.x0).map(fx128::lit), Vector4::from(self.v0).map(fx128::lit));
        rounded(x0 * cosine + v0 * (sine / w), v0 * cosine - x0 * (w * sine))
    }
    fn observe(&self, s: &State<Self::Config>) -> Observation {
        Observation::particles(s)
    }
}

impl Scene for OscillatorInFour {
    fn info(&self) -> Info {
        Info {
            about: "a mass on a spring in four dimensions",
            equation: r"m\,\ddot{\mathbf x} = -k\,\mathbf x,\quad \mathbf x\in\mathbb R^4",
            source: "elementary",
            horizon_s: 2.75,
            time_scale_s: (self.mass / self.stiffness).sqrt(),
            coarsest_steps: 16,
        }
    }

    fn invariants(&self, _t: fx128, seen: &Observation) -> Vec<Entry> {
        let square = |q| seen.vector(q).iter().fold(fx128::ZERO, |sum, &x| sum + x * x);
        let (m, k) = (fx128::lit(self.mass), fx128::lit(self.stiffness));
        let twice = m * square(Quantity::Velocity) + k * square(Quantity::Position);
        vec![Entry { invariant: Invariant::Energy, value: vec![twice * fx128::lit(0.5)], conserved: true }]
    }
}
