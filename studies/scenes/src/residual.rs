//! Whether an exact motion satisfies its own equation of motion, by differences in double-double.

use faer::fx128;
use integrator::{Real, Rotation, Single, Vector};

use crate::motion::Motion;
use crate::observation::{Observation, Quantity, Value, norm};

/// What an exact motion lacks of solving its equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// |dq/dt - velocity|: m/s, rad/s, or 1/s for a quaternion; the larger of them.
    pub velocity: f64,
    /// |dv/dt - rate|, in what the model stores.
    pub rate: f64,
    /// Size of q, v and rate, for comparison.
    pub size: [f64; 3],
}

/// Weights of the central difference of order eight, f(t + k h) - f(t - k h) for k = 1..4, times h.
fn difference(at: impl Fn(i32) -> fx128, h: fx128) -> fx128 {
    let term = |k: i32, a: f64, b: f64| (at(k) - at(-k)) * fx128::lit(a) / fx128::lit(b);
    (term(1, 4.0, 5.0) + term(2, -1.0, 5.0) + term(3, 4.0, 105.0) + term(4, -1.0, 280.0)) / h
}

/// The residual at the time `t`, by differences over t - 4 h ... t + 4 h. Their own error is f^(9) h^8 / 630 and
/// rounding, 1e-32 |f| / h; the motion must be smooth there.
pub fn residual<M: Motion<fx128>>(model: &M, t: fx128, h_s: f64) -> Residual {
    let h = fx128::lit(h_s);
    let states: Vec<_> = (-4..=4).map(|k| model.exact(t + fx128::lit(f64::from(k)) * h)).collect();
    let seen: Vec<Observation> = states.iter().map(|s| model.observe(s)).collect();
    let (here, now) = (&states[4], &seen[4]);
    let rate = model.rate(t, here);
    let of_rate = (0..<M::Config as integrator::Space>::Tangent::DIM)
        .map(|i| difference(|k| states[(4 + k) as usize].v.component(i), h) - rate.component(i));
    let components = |v: &integrator::Tangent<M, fx128>| {
        let v = *v;
        (0..<M::Config as integrator::Space>::Tangent::DIM).map(move |i| v.component(i))
    };
    let size = now.values.iter().map(|(quantity, _)| *quantity);
    let positions = size.filter(|q| matches!(q, Quantity::Position | Quantity::Attitude)).map(|q| now.scale(q));
    Residual {
        velocity: [Quantity::Position, Quantity::Attitude]
            .map(|q| of_velocity(q, &seen, h))
            .into_iter()
            .fold(0.0, worse),
        rate: norm(of_rate.collect::<Vec<_>>().into_iter()).to_f64(),
        size: [positions.fold(0.0, f64::max), norm(components(&here.v)).to_f64(), norm(components(&rate)).to_f64()],
    }
}

/// |d/dt of the position - the velocity|, both as observed.
fn of_velocity(quantity: Quantity, seen: &[Observation], h: fx128) -> f64 {
    let now = &seen[4];
    let rate = if quantity == Quantity::Position { Quantity::Velocity } else { Quantity::AngularVelocity };
    let errors: Vec<fx128> = match now.get(quantity) {
        None => return 0.0,
        Some(Value::Vector(v)) => (0..v.len())
            .map(|i| difference(|k| seen[(4 + k) as usize].vector(quantity)[i], h) - now.vector(rate)[i])
            .collect(),
        Some(Value::Rotation(q)) => {
            let spin = nalgebra::Vector3::from_column_slice(now.vector(rate));
            let half = fx128::lit(0.5);
            // q' = (0, omega_world) q / 2; the sign of each neighbour is that of q.
            let expected = (Rotation { w: fx128::ZERO, v: spin } * *q).wxyz().map(|c| c * half);
            let near = |k: i32| {
                let other = seen[(4 + k) as usize].rotation().map_or([fx128::NAN; 4], Rotation::wxyz);
                let overlap = other.iter().zip(q.wxyz()).fold(fx128::ZERO, |sum, (&a, b)| sum + a * b);
                if overlap.0 < 0.0 { other.map(|c| -c) } else { other }
            };
            (0..4).map(|i| difference(|k| near(k)[i], h) - expected[i]).collect()
        }
    };
    norm(errors.into_iter()).to_f64()
}

/// The larger number; NaN if either is.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
