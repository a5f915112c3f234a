//! Laws of clocks, of stored numbers, and of steps that follow one another.

use super::laws::{Case, EULER, Fall, Spring, at, settings};
use super::row::Row;
use crate::game_loop::drive::{Job, Until};

/// The steps that `t += h` in f32 takes until t >= end, by theory.
///
/// Between 2^k and 2^(k+1) numbers are u = 2^(k - 23) apart, and a step advances by h rounded to a multiple of u. A tie goes to
/// the even neighbour, so that two steps advance by 2 h.
pub fn steps_of_f32_clock(h_s: f64, end_s: f64) -> f64 {
    let h = f64::from(h_s as f32);
    let (mut from, mut steps) = (0.0, 0.0);
    let mut k = libm::ilogb(h) + 1;
    while from < end_s {
        let to = libm::ldexp(1.0, k).min(end_s);
        let unit = libm::ldexp(1.0, k - 24);
        let part = h / unit;
        let advance = if part.fract() == 0.5 { h } else { unit * part.round() };
        if advance == 0.0 {
            return f64::INFINITY;
        }
        let taken = ((to - from) / advance).ceil();
        steps += taken;
        from += taken * advance;
        k += 1;
    }
    steps
}

/// A clock that sums h in f32 reaches the end after another number of steps than end / h: [`steps_of_f32_clock`], within the one
/// step of each doubling of the time in which the sum changes its grid.
pub fn f32_clock(h_s: f64, end_s: f64) -> Row {
    let settings = settings(&["clock=sum-f32"]);
    let (theory, most) = (steps_of_f32_clock(h_s, end_s), 4 * (end_s / h_s) as u64);
    let model = Fall { gravity: 0.0, restitution: None };
    let job = Job { model: &model, method: EULER, plan: &settings, h_s, start: at(0.0, 0.0) };
    let seen = job.run(Until::Clock(end_s, most), |_| {}).ok();
    let subject = format!("t += {h_s} up to {end_s} s");
    let frames = seen.map_or(0, |s| s.frame);
    let case = Case { law: "clock", subject, settings: &settings, method: EULER, h_s, frames };
    case.row("steps", "1", seen.map(|s| s.steps as f64), theory, 1.0)
}

/// A position that is stored in f32 at X moves by whole multiples of its unit u in the last place: with h v below u / 2 it stands still, with
/// h v from u / 2 to 3 u / 2 it moves by u.
pub fn f32_position(x: f64, part: f64) -> Row {
    let unit = f64::from((x as f32).next_up()) - f64::from(x as f32);
    let (h_s, frames) = (1.0 / 64.0, 64);
    let speed = part * unit / h_s;
    let settings = settings(&["position=f32"]);
    let subject = format!("h v = {part} units in the last place at {x} m");
    let case = Case { law: "stored-position", subject, settings: &settings, method: EULER, h_s, frames };
    let end = case.run(&Fall { gravity: 0.0, restitution: None }, at(x, speed), |_| {});
    case.row("distance", "m", end.map(|s| s.state.q.x - x), (part + 0.5).floor() * unit * frames as f64, 0.0)
}

/// Two steps in turn on a spring multiply its state by a matrix of determinant 1 and trace 2 - (z1 + z2)^2 + (z1 z2)^2, z = h omega: for
/// semi-implicit Euler the error grows by the larger root of r + 1 / r = |trace| in two frames, although each step may be stable alone.
pub fn in_turn(omega: f64, first_s: f64, second_s: f64) -> Row {
    let settings = settings(&[&format!("frames={first_s},{second_s}")]);
    let mean = 0.5 * (first_s + second_s);
    let subject = format!("spring, omega = {omega} rad/s");
    let case = Case { law: "in-turn", subject, settings: &settings, method: EULER, h_s: mean, frames: 2 };
    let frame = |x, v| Some(case.run(&Spring { omega }, at(x, v), |_| {})?.state);
    let factor = |trace: f64| {
        let half = 0.5 * trace.abs();
        if half <= 1.0 { 1.0 } else { half + (half * half - 1.0).sqrt() }
    };
    let measured = frame(1.0, 0.0).zip(frame(0.0, 1.0)).map(|(q, v)| factor(q.q.x + v.v.x));
    let (z1, z2) = (first_s * omega, second_s * omega);
    let theory = factor(2.0 - (z1 + z2).powi(2) + (z1 * z2).powi(2));
    // The root moves by 1 / (1 - 1 / r^2) for each unit of the trace, whose rounding is a few of its largest term.
    let slope = if theory > 1.0 { 1.0 / (1.0 - theory.powi(-2)) } else { 0.0 };
    let rounding = 16.0 * f64::EPSILON * (2.0 + (z1 + z2).powi(2) + (z1 * z2).powi(2));
    case.row("factor of two frames", "1", measured, theory, slope * rounding)
}
