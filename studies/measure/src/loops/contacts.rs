//! What a rule of contact does to the energy of a ball.

use integrator::State;
use nalgebra::SVector;

use super::laws::{Case, EULER, Fall, at, settings};
use super::row::Row;
use crate::game_loop::description::{Contact, Loop};

/// The part of the energy-like quantity E - g h v / 2, which every step of semi-implicit Euler without a contact keeps, that a
/// bounce takes or gives, in units of g h |w| with w the velocity that is turned. With a restitution e it is
/// -(1 - e^2) w^2 / 2 and: at the end of a step or before the kick -g h (1 + e) |w| / 2, after the kick the opposite, without
/// a move +g h (1 - e) |w| / 2; at the time tau of impact also g^2 (h^2 - tau^2 - (h - tau)^2) / 2.
pub fn contacts(gravity: f64, restitution: f64, h_s: f64, frames: u64) -> Vec<Row> {
    let rules = ["end", "before-kick", "after-kick", "no-move", "impact"];
    rules
        .into_iter()
        .map(|rule| {
            let settings = settings(&[&format!("contact={rule}")]);
            let subject = format!("ball under {gravity} m/s^2, restitution {restitution}");
            let case = Case { law: "contact", subject, settings: &settings, method: EULER, h_s, frames };
            let model = Fall { gravity, restitution: Some(restitution) };
            let start = at(1.25, 0.0);
            let (mut before, mut jumps, mut theory, mut sizes) = (start, 0.0, 0.0, 0.0);
            let run = case.run(&model, start, |seen| {
                let kept =
                    |s: &State<SVector<f64, 1>>| 0.5 * s.v.x * s.v.x + gravity * s.q.x - 0.5 * gravity * h_s * s.v.x;
                if seen.state.v.x > before.v.x {
                    let (law, size) = bounce(&settings, (gravity, restitution, h_s), (before.q.x, before.v.x));
                    jumps += kept(&seen.state) - kept(&before);
                    theory += law;
                    sizes += gravity * h_s * size;
                }
                before = seen.state;
            });
            let energy = gravity * 1.25;
            let tolerance = 32.0 * frames as f64 * f64::EPSILON * energy / sizes;
            case.row("gained per bounce / g h |w|", "1", run.map(|_| jumps / sizes), theory / sizes, tolerance)
        })
        .collect()
}

/// What a bounce does by theory, and the speed that it turns, from the state before its step.
fn bounce(settings: &Loop, (g, e, h): (f64, f64, f64), (y, v): (f64, f64)) -> (f64, f64) {
    let kicked = (v - g * h).abs();
    let lost = |w: f64| -0.5 * (1.0 - e * e) * w * w;
    let half = |w: f64| 0.5 * g * h * w;
    match settings.contact {
        Contact::End => (lost(kicked) - half(kicked) * (1.0 + e), kicked),
        Contact::BeforeKick => (lost(v) - half(v.abs()) * (1.0 + e), v.abs()),
        Contact::AfterKick => (lost(kicked) + half(kicked) * (1.0 + e), kicked),
        Contact::NoMove => (lost(kicked) + half(kicked) * (1.0 - e), kicked),
        Contact::Impact => {
            let tau = 2.0 * y / ((v * v + 4.0 * g * y).sqrt() - v);
            let w = (v - g * tau).abs();
            let pieces = 0.5 * g * g * (h * h - tau * tau - (h - tau).powi(2));
            (lost(w) - half(w) * (1.0 + e) + pieces, w)
        }
    }
}
