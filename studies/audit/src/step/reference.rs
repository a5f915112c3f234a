//! The motion of a body for which there is no closed form: a run of order 4 at so small a step that half of it changes nothing.

use integrator::{Rotation, State};
use nalgebra::{Vector3, Vector4};

use super::rotation::bare::{Bare, munthe_kaas};
use crate::physics::Moment;

/// Largest turn in a step, rad: the error of a step is below (1/256)^5, that of a run of 10^4 rad below 1e-9.
const TURN: f64 = 1.0 / 256.0;

/// Attitude and angular velocity (world) at the times; None where a time runs backwards.
pub(crate) fn top(
    inertia: Vector3<f64>,
    moment: Moment,
    q0: Rotation<f64>,
    omega0: Vector3<f64>,
    times: &[[f64; 2]],
) -> Option<Vec<(Rotation<f64>, Vector3<f64>)>> {
    let model = Bare::free(inertia, moment);
    let mut wanted: Vec<f64> = times.iter().flatten().copied().collect();
    wanted.sort_by(f64::total_cmp);
    wanted.dedup();
    let mut s =
        State { q: Vector4::new(q0.w, q0.v.x, q0.v.y, q0.v.z), v: Vector4::new(0.0, omega0.x, omega0.y, omega0.z) };
    let mut states = Vec::with_capacity(wanted.len());
    let mut now = wanted.first().copied()?.min(0.0);
    for &time in &wanted {
        let span = time - now;
        let rate = s.v.norm().max(omega0.norm()).max(1.0);
        let steps = (span * rate / TURN).ceil().max(1.0);
        if steps > 1e8 {
            return None;
        }
        let h = span / steps;
        for _ in 0..steps as u64 {
            s = munthe_kaas(&model, h, s);
        }
        s.q /= s.q.norm();
        now = time;
        states.push(s);
    }
    let at = |time: f64| {
        let i = wanted.partition_point(|w| *w < time);
        let s = states[i];
        let q = Rotation { w: s.q.x, v: Vector3::new(s.q.y, s.q.z, s.q.w) };
        (q, q.rotate(Vector3::new(s.v.y, s.v.z, s.v.w)))
    };
    Some(times.iter().map(|[pose, rate]| (at(*pose).0, at(*rate).1)).collect())
}
