//! Cases of which theory knows the number: what a loop does to a fall, a spring, a flight and a clock.
//!
//! One formula each, derived in its doc comment; the tolerances are bounds of rounding, or of the next term.

use integrator::methods::MethodId;
use integrator::{Model, State};
use nalgebra::{SVector, Vector1};

use super::row::{Experiment, Row};
use crate::game_loop::description::{Damped, Damping, Loop};
use crate::game_loop::drive::{Job, Seen, Until};
use scenes::run::Outcome;

const EPS: f64 = f64::EPSILON;

/// x'' = -g, and a floor at 0 that leaves the part `restitution` of the speed where there is one.
#[derive(Clone, Copy, Debug)]
pub struct Fall {
    /// g, m/s^2.
    pub gravity: f64,
    /// The part of the speed that a bounce leaves; no floor without it.
    pub restitution: Option<f64>,
}

impl Model<f64> for Fall {
    type Config = Vector1<f64>;

    fn rate(&self, _t: f64, _s: &State<Self::Config>) -> Vector1<f64> {
        Vector1::new(-self.gravity)
    }
    fn contact(&self, _before: &State<Self::Config>, after: State<Self::Config>) -> State<Self::Config> {
        match self.restitution {
            Some(e) if after.q.x < 0.0 && after.v.x < 0.0 => State { q: after.q, v: after.v * -e },
            _ => after,
        }
    }
}

/// x'' = -omega^2 x.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// omega, rad/s.
    pub omega: f64,
}

impl Model<f64> for Spring {
    type Config = Vector1<f64>;

    fn rate(&self, _t: f64, s: &State<Self::Config>) -> Vector1<f64> {
        s.q * (-self.omega * self.omega)
    }
}

/// A state of one coordinate.
pub fn at(x: f64, v: f64) -> State<SVector<f64, 1>> {
    State { q: Vector1::new(x), v: Vector1::new(v) }
}

/// A law on one case, as yet without its number.
pub(super) struct Case<'a> {
    pub law: &'a str,
    pub subject: String,
    pub settings: &'a Loop,
    pub method: MethodId,
    pub h_s: f64,
    pub frames: u64,
}

impl Case<'_> {
    pub(super) fn row(&self, quantity: &str, unit: &str, value: Option<f64>, theory: f64, tolerance: f64) -> Row {
        Row {
            experiment: Experiment::Law,
            choice: self.law.to_owned(),
            settings: self.settings.to_string(),
            subject: self.subject.clone(),
            method: self.method.id().to_owned(),
            h_s: self.h_s,
            frames: self.frames,
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            value,
            theory: Some(theory),
            tolerance: Some(tolerance),
            theory_order: None,
            outcome: if value.is_some() { Outcome::Finished } else { Outcome::Diverged },
        }
    }

    pub(super) fn run<M: crate::game_loop::drive::Flat<1>>(
        &self,
        model: &M,
        start: State<SVector<f64, 1>>,
        see: impl FnMut(&Seen<1>),
    ) -> Option<Seen<1>> {
        let job = Job { model, method: self.method, plan: self.settings, h_s: self.h_s, start };
        job.run(Until::Frames(self.frames), see).ok()
    }
}

/// The loop of these settings: they stand in this file and are right.
pub(super) fn settings(text: &[&str]) -> Loop {
    Loop::read(text).unwrap_or_default()
}

pub(super) const EULER: MethodId = MethodId::SemiImplicitEuler;

/// A fall of n frames from rest under -g: the Eulers are wrong by -+ g h T / 2, a method of order 2 by rounding.
pub fn falls(gravity: f64, h_s: f64, frames: u64) -> Vec<Row> {
    let (plain, t) = (Loop::default(), h_s * frames as f64);
    [(MethodId::ExplicitEuler, 0.5), (EULER, -0.5), (MethodId::VelocityVerlet, 0.0)]
        .into_iter()
        .map(|(method, part)| {
            let subject = format!("fall under {gravity} m/s^2");
            let case = Case { law: "fall", subject, settings: &plain, method, h_s, frames };
            let end = case.run(&Fall { gravity, restitution: None }, at(0.0, 0.0), |_| {});
            let error = end.map(|seen| seen.state.q.x + 0.5 * gravity * t * t);
            case.row(
                "height - exact",
                "m",
                error,
                part * gravity * h_s * t,
                4.0 * frames as f64 * EPS * gravity * t * t,
            )
        })
        .collect()
}

/// A jump with v0: the peak of semi-implicit Euler is that of n h v0 - g h^2 n (n + 1) / 2, with half a kick back at the start
/// that of n h v0 - g h^2 n^2 / 2, over whole n.
pub fn jumps(gravity: f64, v0: f64, h_s: f64) -> Vec<Row> {
    let frames = (2.0 * v0 / (gravity * h_s)).ceil() as u64;
    let best = |extra: f64| {
        let n = (v0 / (gravity * h_s) - 0.5 * extra).round();
        n * h_s * v0 - 0.5 * gravity * h_s * h_s * n * (n + extra)
    };
    [("start=plain", 1.0), ("start=half-kick", 0.0)]
        .into_iter()
        .map(|(start, extra)| {
            let settings = settings(&[start]);
            let subject = format!("jump with {v0:.4} m/s under {gravity} m/s^2");
            let case = Case { law: "jump", subject, settings: &settings, method: EULER, h_s, frames };
            let mut peak = 0.0_f64;
            let run =
                case.run(&Fall { gravity, restitution: None }, at(0.0, v0), |seen| peak = peak.max(seen.state.q.x));
            let tolerance = 8.0 * frames as f64 * EPS * v0 * v0 / gravity;
            case.row("peak height", "m", run.map(|_| peak), best(extra), tolerance)
        })
        .collect()
}

/// With half a kick back at the start and read half a kick on, semi-implicit Euler is velocity Verlet: the largest distance of
/// the two runs is rounding, and nothing where every number of the run is exact.
pub fn half_kick() -> Vec<Row> {
    let leapfrog = settings(&["start=half-kick", "read=synchronised"]);
    let plain = Loop::default();
    let distance = |a: &[State<SVector<f64, 1>>], b: &[State<SVector<f64, 1>>]| {
        let apart = a.iter().zip(b).map(|(a, b)| (a.q.x - b.q.x).abs().max((a.v.x - b.v.x).abs()));
        apart.fold(0.0_f64, f64::max)
    };
    let pair = |subject: &str, h_s: f64, frames: u64, tolerance: f64, run: &dyn Fn(&Case<'_>) -> Option<Vec<_>>| {
        let case =
            |settings, method| Case { law: "half-kick", subject: subject.to_owned(), settings, method, h_s, frames };
        let (ours, verlet) = (case(&leapfrog, EULER), case(&plain, MethodId::VelocityVerlet));
        let apart = run(&ours).zip(run(&verlet)).map(|(a, b)| distance(&a, &b));
        ours.row("distance from velocity Verlet", "m", apart, 0.0, tolerance)
    };
    let states = |case: &Case<'_>, spring: Option<f64>| {
        let mut seen = Vec::new();
        let see = |s: &Seen<1>| seen.push(s.state);
        match spring {
            Some(omega) => case.run(&Spring { omega }, at(1.0, 0.0), see),
            None => case.run(&Fall { gravity: 9.8125, restitution: None }, at(0.0, 4.5), see),
        }
        .map(|_| seen)
    };
    vec![
        pair("spring, h omega = 0.1", 0.1, 1000, 8.0 * 1000.0 * EPS, &|case| states(case, Some(1.0))),
        pair("fall in exact numbers", 0.015_625, 64, 0.0, &|case| states(case, None)),
    ]
}

/// Leapfrog on a spring, x = cos(n phi) with sin(phi / 2) = h omega / 2: the energy with the stored velocity is wrong by the part
/// -sin(phi / 2) sin((2 n - 1) phi / 2 ...) of itself, with the synchronised one by -(h omega)^2 / 4 sin^2(n phi).
pub fn leapfrog_energy(omega: f64, h_s: f64, frames: u64) -> Vec<Row> {
    let half = libm::asin(0.5 * h_s * omega);
    let phase = |n: u64| 2.0 * half * n as f64;
    let stored = |n: u64| -libm::sin(half) * libm::sin(2.0 * phase(n) - half);
    let synchronised = |n: u64| -(0.5 * h_s * omega * libm::sin(phase(n))).powi(2);
    let theories: [(&str, &dyn Fn(u64) -> f64); 2] = [("read=stored", &stored), ("read=synchronised", &synchronised)];
    let mut rows = Vec::new();
    for (read, theory) in theories {
        let settings = settings(&["start=half-kick", read]);
        let subject = format!("spring, h omega = {}", h_s * omega);
        let case = Case { law: "leapfrog-energy", subject, settings: &settings, method: EULER, h_s, frames };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let run = case.run(&Spring { omega }, at(1.0, 0.0), |seen| {
            let (x, v) = (seen.state.q.x, seen.state.v.x / omega);
            let error = x * x + v * v - 1.0;
            (low, high) = (low.min(error), high.max(error));
        });
        let expected = |pick: fn(f64, f64) -> f64, start| (1..=frames).map(theory).fold(start, pick);
        let tolerance = 16.0 * frames as f64 * EPS;
        for (name, value, theory) in [
            ("least energy error", low, expected(f64::min, f64::INFINITY)),
            ("largest energy error", high, expected(f64::max, f64::NEG_INFINITY)),
        ] {
            rows.push(case.row(name, "1", run.map(|_| value), theory, tolerance));
        }
    }
    rows
}

/// One frame H of n substeps with the force held is x' = x + H v + a H^2 alpha, v' = v + a H. On a spring its determinant, by which
/// the energy grows in a frame, is 1 + (1 - alpha) (H omega)^2, with alpha = (n + 1) / (2 n) for semi-implicit Euler,
/// (n - 1) / (2 n) for explicit Euler and 1 / 2 for a method of order 2 and more.
pub fn frozen(omega: f64, h_s: f64, substeps: u32) -> Vec<Row> {
    let n = f64::from(substeps);
    let settings = settings(&["force=frozen", &format!("substeps={substeps}")]);
    let alphas = [
        (MethodId::ExplicitEuler, (n - 1.0) / (2.0 * n)),
        (EULER, (n + 1.0) / (2.0 * n)),
        (MethodId::VelocityVerlet, 0.5),
        (MethodId::Rk4, 0.5),
    ];
    let z = h_s * omega;
    alphas
        .into_iter()
        .map(|(method, alpha)| {
            let subject = format!("spring, H omega = {z}");
            let case = Case { law: "frozen-force", subject, settings: &settings, method, h_s, frames: 1 };
            let frame = |x, v| Some(case.run(&Spring { omega }, at(x, v), |_| {})?.state);
            let determinant =
                frame(1.0, 0.0).zip(frame(0.0, 1.0)).map(|(q, v)| libm::fma(q.q.x, v.v.x, -v.q.x * q.v.x));
            case.row(
                "energy factor of a frame",
                "1",
                determinant,
                1.0 + (1.0 - alpha) * z * z,
                16.0 * n * EPS * (1.0 + z * z),
            )
        })
        .collect()
}

/// Frames h (1 + s u), u uniform: semi-implicit Euler falls too low by g sum(h_i^2) / 2, in the mean g h T (1 + s^2 / 3) / 2. The sum has
/// the variance n h^4 (4 s^2 / 3 + 4 s^4 / 45); five standard deviations are allowed.
pub fn jitter(gravity: f64, h_s: f64, part: f64, frames: u64) -> Row {
    let settings = settings(&[&format!("jitter={part}:1")]);
    let subject = format!("fall under {gravity} m/s^2");
    let case = Case { law: "jitter", subject, settings: &settings, method: EULER, h_s, frames };
    let end = case.run(&Fall { gravity, restitution: None }, at(0.0, 0.0), |_| {});
    let low = end.map(|seen| -seen.state.q.x - 0.5 * gravity * seen.simulated_s * seen.simulated_s);
    let n = frames as f64;
    let deviation = h_s * h_s * (n * (4.0 / 3.0 * part * part + 4.0 / 45.0 * part.powi(4))).sqrt();
    let theory = 0.5 * gravity * n * h_s * h_s * (1.0 + part * part / 3.0);
    case.row("exact - height", "m", low, theory, 0.5 * gravity * 5.0 * deviation)
}

/// A frame of f cut to c: n frames lose n (f - c), and the motion is that of frames of c to the last bit.
pub fn clamp(frame_s: f64, clamp_s: f64, frames: u64) -> Vec<Row> {
    let cut = settings(&[&format!("clamp={clamp_s}")]);
    let plain = Loop::default();
    let subject = format!("spring, frames of {frame_s} s");
    let omega = (10.0_f64 / 0.3).sqrt();
    let case = Case { law: "clamp", subject: subject.clone(), settings: &cut, method: EULER, h_s: frame_s, frames };
    let short = Case { law: "clamp", subject, settings: &plain, method: EULER, h_s: clamp_s, frames };
    let [ours, theirs] = [&case, &short].map(|case| case.run(&Spring { omega }, at(1.0, 0.0), |_| {}));
    let lost = ours.map(|seen| seen.wall_s - seen.simulated_s);
    let apart = ours.zip(theirs).map(|(a, b)| (a.state.q.x - b.state.q.x).abs() + (a.state.v.x - b.state.v.x).abs());
    let n = frames as f64;
    vec![
        case.row("time lost", "s", lost, n * (frame_s - clamp_s), 4.0 * EPS * n * frame_s),
        case.row("distance from short frames", "m", apart, 0.0, 0.0),
    ]
}

/// A step h drawn by frames of h / 16. Interpolated: at a constant velocity it is drawn h v behind; under a constant acceleration it is
/// off by a h^2 / 8 at most from the motion one step behind. Extrapolated: by a (15 h / 16)^2 / 2. Velocity Verlet keeps the states exact.
pub fn drawn(speed: f64, gravity: f64, h_s: f64) -> Vec<Row> {
    let frame = h_s / 16.0;
    let method = MethodId::VelocityVerlet;
    let exact = |t: f64| speed * t - 0.5 * gravity * t * t;
    let mut rows = Vec::new();
    for (drawn, theory) in [("interpolated", 1.0 / 8.0), ("extrapolated", 0.5 * (15.0 / 16.0_f64).powi(2))] {
        let settings = settings(&[&format!("inner={h_s}"), &format!("drawn={drawn}")]);
        let subject = format!("flight with {speed} m/s under {gravity} m/s^2");
        let case = Case { law: "drawn", subject, settings: &settings, method, h_s: frame, frames: 1024 };
        let mut worst = 0.0_f64;
        let run = case.run(&Fall { gravity, restitution: None }, at(0.0, speed), |seen| {
            if seen.steps > 0 {
                worst = worst.max((seen.state.q.x - exact(seen.drawn_s)).abs());
            }
        });
        let tolerance = 64.0 * 64.0 * EPS * (speed * 64.0 * h_s + gravity * (64.0 * h_s).powi(2));
        rows.push(case.row(
            "largest error of what is drawn",
            "m",
            run.map(|_| worst),
            theory * gravity * h_s * h_s,
            tolerance,
        ));
    }
    let settings = settings(&[&format!("inner={h_s}"), "drawn=interpolated"]);
    let subject = format!("{speed} m/s");
    let case = Case { law: "drawn", subject, settings: &settings, method, h_s, frames: 60 };
    let seen = case.run(&Fall { gravity: 0.0, restitution: None }, at(0.0, speed), |_| {});
    let lag = seen.map(|seen| speed * seen.wall_s - seen.state.q.x);
    rows.push(case.row("distance behind the clock", "m", lag, speed * h_s, 240.0 * EPS * speed * 60.0 * h_s));
    rows
}

/// A force a and a damping of c: kicked and then damped by d, the speed tends to a h d / (1 - d), where the motion tends to a / c.
pub fn terminal_speeds(acceleration: f64, rate: f64, h_s: f64) -> Vec<Row> {
    let rules = [Damping::Linear(rate), Damping::Implicit(rate), Damping::Exponential(rate)];
    rules
        .into_iter()
        .map(|damping| {
            let settings = Loop { damping, damped: Damped::BeforeMove, ..Loop::default() };
            let d = damping.factor(h_s);
            let frames = if d <= 0.0 { 8 } else { (40.0 / -d.ln()).ceil() as u64 + 1 };
            let subject = format!("{acceleration} m/s^2, damping {rate} per s");
            let case = Case { law: "terminal-speed", subject, settings: &settings, method: EULER, h_s, frames };
            let end = case.run(&Fall { gravity: -acceleration, restitution: None }, at(0.0, 0.0), |_| {});
            let x = rate * h_s;
            let part = match damping {
                Damping::Linear(_) => 1.0 - x,
                Damping::Implicit(_) => 1.0,
                _ => x / libm::expm1(x),
            };
            let limit = acceleration / rate;
            case.row("speed", "m/s", end.map(|s| s.state.v.x), limit * part, 64.0 * EPS * limit * (1.0 + 1.0 / x))
        })
        .collect()
}

/// A glide from v0 under damping c alone: damped before it moves, h v0 d / (1 - d), after it, h v0 / (1 - d), where the motion comes
/// to rest after v0 / c. The linear rule after the move is exact.
pub fn glides(v0: f64, rate: f64, h_s: f64) -> Vec<Row> {
    let mut rows = Vec::new();
    for damping in [Damping::Linear(rate), Damping::Implicit(rate), Damping::Exponential(rate)] {
        for damped in [Damped::BeforeMove, Damped::AfterMove] {
            let settings = Loop { damping, damped, ..Loop::default() };
            let x = rate * h_s;
            let after = match damping {
                Damping::Linear(_) => 1.0,
                Damping::Implicit(_) => 1.0 + x,
                _ => x / -libm::expm1(-x),
            };
            let shift = if damped == Damped::BeforeMove { x } else { 0.0 };
            let frames = (40.0 / x).ceil() as u64;
            let subject = format!("glide from {v0} m/s, damping {rate} per s");
            let case = Case { law: "glide", subject, settings: &settings, method: EULER, h_s, frames };
            let end = case.run(&Fall { gravity: 0.0, restitution: None }, at(0.0, v0), |_| {});
            let tolerance = 8.0 * frames as f64 * EPS * v0 / rate + v0 / rate * libm::exp(-38.0);
            rows.push(case.row("distance", "m", end.map(|s| s.state.q.x), v0 / rate * (after - shift), tolerance));
        }
    }
    rows
}
