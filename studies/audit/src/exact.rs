//! The exact motion of a subject from the first row of a file, at the times of all its rows.

use integrator::Rotation;
use nalgebra::Vector3;
use scenes::special::free_top::FreeTop;

use crate::physics::{Force, Moment};
use crate::step::reference;
use crate::subject::{Ball, Subject};
use crate::trajectory::Trajectory;

/// An exact motion.
#[derive(Clone, Debug, Default)]
pub struct Exact {
    /// Position and velocity, m and m/s.
    pub point: Option<Vec<[Vector3<f64>; 2]>>,
    /// Attitude, and angular velocity in the world, rad/s.
    pub body: Option<Vec<(Rotation<f64>, Vector3<f64>)>>,
    /// Angle and rate.
    pub angle: Option<Vec<[f64; 2]>>,
    /// Where it comes from.
    pub source: Vec<&'static str>,
}

/// Position and velocity at a time.
type PointAt = Box<dyn Fn(f64) -> [Vector3<f64>; 2]>;

/// The exact motion, shifted: the pose at t - `pose_late`, rates at t.
pub fn exact(subject: &Subject, t: &Trajectory, pose_late: f64) -> Exact {
    let mut out = Exact::default();
    let p = &subject.physics;
    let start = t.time[0];
    let times: Vec<[f64; 2]> = t.time.iter().map(|time| [time - start - pose_late, time - start]).collect();
    if let (Some(force), Some(x), Some(v)) = (p.force, &t.position, &t.velocity) {
        let (x0, v0) = (x.values[0], v.values[0]);
        out.point = point(force, p.linear_damping.unwrap_or(0.0), subject.ball, x0, v0, &times);
        if out.point.is_some() {
            out.source.push(if matches!(force, Force::Kepler { .. }) { "Kepler's equation" } else { "closed form" });
        }
    }
    if let (Some(inertia), Some(moment), Some(attitude), Some(omega)) =
        (p.inertia, p.moment, &t.attitude, t.omega_body(0))
    {
        let q0 = attitude.at(0);
        let c = p.angular_damping.unwrap_or(0.0);
        match moment {
            Moment::None => {
                let top = FreeTop::new(inertia.into(), q0.wxyz(), omega.into());
                out.body = Some(times.iter().map(|t| free(&top, c, *t)).collect());
                out.source.push("Jacobi's elliptic functions");
            }
            // A symmetric top has a closed form.
            Moment::Weight { arm, gravity } if inertia.x == inertia.y && arm.xy().norm() == 0.0 => {
                let top = scenes::HeavyTop {
                    inertia_1: inertia.x,
                    inertia_3: inertia.z,
                    mgl: arm.z * gravity.norm(),
                    attitude: q0.wxyz(),
                    omega: omega.into(),
                };
                let at = |t: f64| scenes::motion::RigidMotion::<f64>::exact(&top, t);
                let pose_and_rate = |[pose, rate]: &[f64; 2]| {
                    let late = at(*rate);
                    (at(*pose).attitude, late.attitude.rotate(late.omega_body))
                };
                out.body = Some(times.iter().map(pose_and_rate).collect());
                out.source.push("elliptic integrals");
            }
            Moment::Weight { .. } => {
                out.body = reference::top(inertia, moment, q0, omega, &times);
                out.source.push("converged run of order 4");
            }
        }
    }
    if let (Some(square), Some(a), Some(r)) = (p.pendulum, &t.angle, &t.angle_rate) {
        let pendulum =
            scenes::Pendulum { mass: 1.0, length: 1.0, gravity: square, angle: a.values[0], omega: r.values[0] };
        let at = |t: f64| {
            let s = scenes::motion::Motion::<f64>::exact(&pendulum, t);
            [s.q.x, s.v.x]
        };
        out.angle = Some(times.iter().map(|[pose, rate]| [at(*pose)[0], at(*rate)[1]]).collect());
        out.source.push("Jacobi's elliptic functions");
    }
    out
}

/// A free body whose angular velocity is damped by c omega: omega = exp(-c t) Omega(tau), q = Q(tau),
/// tau = (1 - exp(-c t)) / c, where Q and Omega are the motion without damping.
fn free(top: &FreeTop, c: f64, [pose, rate]: [f64; 2]) -> (Rotation<f64>, Vector3<f64>) {
    let slowed = |t: f64| if c == 0.0 { t } else { -(-c * t).exp_m1() / c };
    let (q, _) = top.at(slowed(pose));
    let (at_rate, omega) = top.at(slowed(rate));
    (q, at_rate.rotate(omega) * (-c * rate).exp())
}

fn point(
    force: Force,
    c: f64,
    ball: Option<Ball>,
    x0: Vector3<f64>,
    v0: Vector3<f64>,
    times: &[[f64; 2]],
) -> Option<Vec<[Vector3<f64>; 2]>> {
    let at: PointAt = match (force, ball) {
        (Force::Constant(g), Some(ball)) => Box::new(move |t| bounced(ball, g, x0, v0, t)),
        (Force::None, _) if c == 0.0 => Box::new(move |t| [x0 + v0 * t, v0]),
        (Force::None, _) => Box::new(move |t| [x0 + v0 * (-(-c * t).exp_m1() / c), v0 * (-c * t).exp()]),
        (Force::Constant(g), _) if c == 0.0 => Box::new(move |t| [x0 + v0 * t + g * (t * t / 2.0), v0 + g * t]),
        (Force::Constant(g), _) => Box::new(move |t| {
            let (left, end) = (-(-c * t).exp_m1() / c, g / c);
            [x0 + end * t + (v0 - end) * left, end + (v0 - end) * (-c * t).exp()]
        }),
        (Force::Spring { rate, anchor }, _) if c == 0.0 => {
            let w = rate.sqrt();
            Box::new(move |t| {
                let (sine, cosine) = (w * t).sin_cos();
                let r = x0 - anchor;
                [anchor + r * cosine + v0 * (sine / w), v0 * cosine - r * (w * sine)]
            })
        }
        (Force::Kepler { mu, centre }, _) if c == 0.0 => orbit(mu, centre, x0, v0)?,
        _ => return None,
    };
    Some(times.iter().map(|[pose, rate]| [at(*pose)[0], at(*rate)[1]]).collect())
}

/// An ellipse from one state: its plane and pericentre, then Kepler's equation in double-double.
fn orbit(mu: f64, centre: Vector3<f64>, x0: Vector3<f64>, v0: Vector3<f64>) -> Option<PointAt> {
    let r = x0 - centre;
    let spin = r.cross(&v0);
    let semi_major = 1.0 / (2.0 / r.norm() - v0.norm_squared() / mu);
    let pointing = v0.cross(&spin) / mu - r / r.norm();
    let eccentricity = pointing.norm();
    if !(semi_major > 0.0 && eccentricity < 1.0 && spin.norm() > 0.0) {
        return None;
    }
    let along = if eccentricity > 1e-14 { pointing / eccentricity } else { r / r.norm() };
    let across = spin.normalize().cross(&along);
    // r = a (1 - e cos E), r . v = sqrt(mu a) e sin E; of a circle the anomaly counts from the start.
    let sine = r.dot(&across) / (semi_major * (1.0 - eccentricity * eccentricity).sqrt());
    let cosine = r.dot(&along) / semi_major + eccentricity;
    let angle = sine.atan2(cosine);
    let kepler =
        scenes::Kepler { mass: 1.0, mu, semi_major, eccentricity, anomaly: angle - eccentricity * angle.sin() };
    Some(Box::new(move |t| {
        let s = scenes::motion::Motion::<f64>::exact(&kepler, t);
        let space = |p: nalgebra::Vector2<f64>| along * p.x + across * p.y;
        [centre + space(s.q), space(s.v)]
    }))
}

/// Bounces on the plane where the centre is `radius` above the floor, along the direction of g.
fn bounced(ball: Ball, g: Vector3<f64>, x0: Vector3<f64>, v0: Vector3<f64>, t: f64) -> [Vector3<f64>; 2] {
    let up = -g.normalize();
    let strength = g.norm();
    let (mut height, mut speed, mut left) = (x0.dot(&up) - ball.radius, v0.dot(&up), t);
    for _ in 0..100_000 {
        let root = (speed * speed + 2.0 * strength * height).max(0.0).sqrt();
        let fall = (speed + root) / strength;
        if fall > left || left <= 0.0 {
            break;
        }
        left -= fall;
        height = 0.0;
        speed = root * ball.restitution;
        if speed < 1e-9 {
            speed = 0.0;
            break;
        }
    }
    let resting = height == 0.0 && speed == 0.0;
    let (h, v) = if resting {
        (0.0, 0.0)
    } else {
        (height + speed * left - strength * left * left / 2.0, speed - strength * left)
    };
    let flat = |p: Vector3<f64>| p - up * p.dot(&up);
    [flat(x0) + flat(v0) * t + up * (h + ball.radius), flat(v0) + up * v]
}
