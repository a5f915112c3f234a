//! Methods with every coefficient in sight, each of which can be planted wrong.

use integrator::{Method, Model, Space, State, Tangent, Vector};

/// The coefficients of a step.
#[derive(Clone, Copy)]
pub(crate) enum Steps {
    /// RK4 with Munthe-Kaas' brackets.
    Rk4 { a: [f64; 3], c: [f64; 3], b: [f64; 4], brackets: [f64; 2] },
    /// Kick, drift, kick: u = v0 + kick0 h a(t0), q1 = q0 + drift h velocity(q at the half, mix u + (1 - mix) v0),
    /// v1 = u + kick1 h a(t1), with the times t + times h, and the second force at v0 + `ahead` h a0; the half by `half` h.
    Kdk { kicks: [f64; 2], drift: f64, half: f64, mix: f64, times: [f64; 2], ahead: f64, stale: bool },
    /// The theta method, its equations solved by so many fixed-point iterations: theta = 1/2 is the midpoint rule, 1 implicit Euler.
    Theta { theta: f64, time: f64, iterations: u32 },
}

pub(crate) const RK4: Steps = Steps::Rk4 {
    a: [0.5, 0.5, 1.0],
    c: [0.5, 0.5, 1.0],
    b: [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
    brackets: [-0.25, -0.5],
};
pub(crate) const EXPLICIT: Steps =
    Steps::Kdk { kicks: [1.0, 0.0], drift: 1.0, half: 0.0, mix: 0.0, times: [0.0, 1.0], ahead: 1.0, stale: false };
pub(crate) const SEMI_IMPLICIT: Steps =
    Steps::Kdk { kicks: [1.0, 0.0], drift: 1.0, half: 0.0, mix: 1.0, times: [0.0, 1.0], ahead: 1.0, stale: false };
pub(crate) const VERLET: Steps =
    Steps::Kdk { kicks: [0.5, 0.5], drift: 1.0, half: 0.5, mix: 1.0, times: [0.0, 1.0], ahead: 1.0, stale: false };
pub(crate) const MIDPOINT: Steps = Steps::Theta { theta: 0.5, time: 0.5, iterations: 64 };
pub(crate) const IMPLICIT: Steps = Steps::Theta { theta: 1.0, time: 1.0, iterations: 64 };

impl<M: Model<f64>> Method<f64, M> for Steps {
    fn step(&self, m: &M, t: f64, h: f64, s: State<M::Config>) -> State<M::Config> {
        match *self {
            Steps::Rk4 { a, c, b, brackets } => rk4(m, t, h, s, (a, c, b, brackets)),
            Steps::Kdk { kicks, drift, half, mix, times, ahead, stale } => {
                let a0 = m.rate(t + times[0] * h, &s);
                let u = s.v.add_scaled(a0, kicks[0] * h);
                let v = (u * mix).add_scaled(s.v, 1.0 - mix);
                let between = s.q.retract(m.velocity(s.q, v), half * h);
                let q = s.q.retract(m.velocity(between, v), drift * h);
                if kicks[1] == 0.0 {
                    return State { q, v: u };
                }
                let a1 =
                    if stale { a0 } else { m.rate(t + times[1] * h, &State { q, v: s.v.add_scaled(a0, ahead * h) }) };
                State { q, v: u.add_scaled(a1, kicks[1] * h) }
            }
            Steps::Theta { theta, time, iterations } => {
                let (mut w, mut v) = (m.velocity(s.q, s.v), s.v);
                for _ in 0..iterations {
                    let at = State { q: s.q.retract(w, theta * h), v };
                    (w, v) = (m.velocity(at.q, at.v), s.v.add_scaled(m.rate(t + time * h, &at), theta * h));
                }
                State { q: s.q.retract(w, h), v: s.v.add_scaled(v - s.v, 1.0 / theta) }
            }
        }
    }
}

type Tableau = ([f64; 3], [f64; 3], [f64; 4], [f64; 2]);

fn rk4<M: Model<f64>>(m: &M, t: f64, h: f64, s: State<M::Config>, (a, c, b, brackets): Tableau) -> State<M::Config> {
    let bracket = |k, c: f64, x, y| M::Config::plus_bracket(k, c * h, x, y);
    let stage = |w, k, part: f64| State { q: s.q.retract(w, part * h), v: s.v.add_scaled(k, part * h) };
    let (w1, k1) = (m.velocity(s.q, s.v), m.rate(t, &s));
    let s2 = stage(w1, k1, a[0]);
    let (w2, k2) = (m.velocity(s2.q, s2.v), m.rate(t + c[0] * h, &s2));
    let s3 = stage(bracket(w2, brackets[0], w1, w2), k2, a[1]);
    let (w3, k3) = (m.velocity(s3.q, s3.v), m.rate(t + c[1] * h, &s3));
    let s4 = stage(w3, k3, a[2]);
    let (w4, k4) = (m.velocity(s4.q, s4.v), m.rate(t + c[2] * h, &s4));
    let sum =
        |k: [Tangent<M, f64>; 4]| (k[0] * b[0]).add_scaled(k[1], b[1]).add_scaled(k[2], b[2]).add_scaled(k[3], b[3]);
    let w = bracket(sum([w1, w2, w3, w4]), brackets[1] / 6.0, w1, w4);
    State { q: s.q.retract(w, h), v: s.v.add_scaled(sum([k1, k2, k3, k4]), h) }
}

/// Every coefficient of a method 1 % off, and with the wrong sign: name and step.
pub(crate) fn faults(of: Steps) -> Vec<(String, Steps)> {
    let mut all = Vec::new();
    for (how, factor) in [("1 % off", 1.01), ("negative", -1.0)] {
        for (name, change) in coefficients(of) {
            let mut wrong = of;
            change(&mut wrong, factor);
            all.push((format!("{name} {how}"), wrong));
        }
    }
    all
}

type Change = Box<dyn Fn(&mut Steps, f64)>;

fn coefficients(of: Steps) -> Vec<(String, Change)> {
    let mut all: Vec<(String, Change)> = Vec::new();
    let mut add = |name: String, change: Change| all.push((name, change));
    match of {
        Steps::Rk4 { .. } => {
            for i in 0..3 {
                add(
                    format!("a{}", i + 2),
                    Box::new(move |s: &mut Steps, x: f64| {
                        if let Steps::Rk4 { a, .. } = s {
                            a[i] *= x;
                        }
                    }),
                );
                add(
                    format!("c{}", i + 2),
                    Box::new(move |s: &mut Steps, x: f64| {
                        if let Steps::Rk4 { c, .. } = s {
                            c[i] *= x;
                        }
                    }),
                );
            }
            for i in 0..4 {
                add(
                    format!("b{}", i + 1),
                    Box::new(move |s: &mut Steps, x: f64| {
                        if let Steps::Rk4 { b, .. } = s {
                            b[i] *= x;
                        }
                    }),
                );
            }
        }
        Steps::Kdk { kicks, .. } => {
            for i in 0..kicks.iter().filter(|k| **k != 0.0).count() {
                add(
                    format!("kick {i}"),
                    Box::new(move |s: &mut Steps, x: f64| {
                        if let Steps::Kdk { kicks, .. } = s {
                            kicks[i] *= x;
                        }
                    }),
                );
            }
            add(
                "drift".to_owned(),
                Box::new(|s: &mut Steps, x: f64| {
                    if let Steps::Kdk { drift, .. } = s {
                        *drift *= x;
                    }
                }),
            );
        }
        Steps::Theta { .. } => {
            add(
                "theta".to_owned(),
                Box::new(|s: &mut Steps, x: f64| {
                    if let Steps::Theta { theta, .. } = s {
                        *theta *= x;
                    }
                }),
            );
            add(
                "time".to_owned(),
                Box::new(|s: &mut Steps, x: f64| {
                    if let Steps::Theta { time, .. } = s {
                        *time *= x;
                    }
                }),
            );
        }
    }
    all
}
