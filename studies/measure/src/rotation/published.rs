//! Numbers that other projects printed, by our own integrator.

use integrator::methods::{ExplicitEuler, ImplicitGyroscopic, MethodId, RigidStep, SemiImplicitEuler};
use integrator::pose::{Body, Exponential, Linear, World};
use integrator::rigid_body::{AttitudeUpdate, BodyOmega, Formulation, RigidModel, WorldOmega};
use integrator::rotation::dot;
use integrator::{Method, drive};
use nalgebra::Vector3;
use serde::Deserialize;

use scenes::BoxTumbling;
use scenes::motion::RigidMotion;
use scenes::scheme::Scheme;

const CSV: &str = include_str!("../../data/published.csv");

/// One printed number.
#[derive(Clone, Debug, Deserialize)]
pub struct Published {
    /// Who: `gazebo-boxes`.
    pub id: String,
    /// Where it stands.
    pub source: String,
    /// What moves.
    pub scene: String,
    /// How it was integrated, in words.
    pub method: String,
    /// Step, s.
    pub step_s: Option<f64>,
    /// What was printed.
    pub quantity: String,
    /// The number.
    pub value: f64,
    /// How many significant digits of it are printed, trailing zeros dropped.
    pub printed_digits: usize,
}

/// A printed number and ours.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What was printed.
    pub published: Published,
    /// What this project computes.
    pub ours: f64,
}

impl Comparison {
    /// The scheme that the words describe.
    pub fn scheme(&self) -> Scheme {
        let method = &self.published.method;
        if method.contains("Newton") {
            Scheme::rigid(RigidStep::ImplicitGyroscopic, AttitudeUpdate::Exponential)
        } else if method.contains("world omega") {
            Scheme::general(MethodId::SemiImplicitEuler, Formulation::WorldOmega, AttitudeUpdate::Linear)
        } else {
            Scheme::general(MethodId::ExplicitEuler, Formulation::BodyOmega, AttitudeUpdate::Exponential)
        }
    }

    /// Half a unit of the last printed digit.
    pub fn tolerance(&self) -> f64 {
        let magnitude = self.published.value.abs().log10().floor();
        0.5 * 10.0_f64.powf(magnitude + 1.0 - self.published.printed_digits as f64)
    }

    /// Whether ours rounds to what was printed. A number that lies on the border of two digits may round either way in f64:
    /// a millionth of the last digit is granted.
    pub fn agrees(&self) -> bool {
        (self.ours - self.published.value).abs() <= 1.000_001 * self.tolerance()
    }
}

/// Every printed number.
///
/// # Errors
/// A line of the data that cannot be read.
pub fn published() -> Result<Vec<Published>, reports::Error> {
    reports::read_csv(CSV, "data/published.csv")
}

/// Every printed number about a rigid body, with ours beside it.
///
/// # Errors
/// A line of the data that cannot be read.
pub fn comparisons() -> Result<Vec<Comparison>, reports::Error> {
    let mut known: Vec<((String, u64), [f64; 3])> = Vec::new();
    let mut all = Vec::new();
    for published in published()? {
        let ours = match published.id.as_str() {
            "gazebo-boxes" => {
                let key = (published.method.clone(), published.step_s.unwrap_or(f64::NAN).to_bits());
                let maxima = match known.iter().find(|(k, _)| *k == key) {
                    Some((_, maxima)) => *maxima,
                    None => {
                        let maxima = tumbling(&published.method, f64::from_bits(key.1));
                        known.push((key, maxima));
                        maxima
                    }
                };
                maxima[if published.quantity.contains("|L-L0|") {
                    0
                } else if published.quantity.contains("|E-E0|") {
                    1
                } else {
                    2
                }]
            }
            "mujoco-box" => spin(&published.method, published.step_s.unwrap_or(f64::NAN)),
            _ => continue,
        };
        all.push(Comparison { published, ours });
    }
    Ok(all)
}

/// Largest |L - L0| / |L0|, |E - E0| / E0 and |p - p_exact| of the box in flight for 10 s.
fn tumbling(method: &str, h: f64) -> [f64; 3] {
    let body = BoxTumbling::default();
    if method.contains("Newton") {
        maxima(&ImplicitGyroscopic, &BodyOmega::<_, Exponential<Body>>::new(&body), &body, h)
    } else {
        maxima(&SemiImplicitEuler, &WorldOmega::<_, Linear<World>>::new(&body), &body, h)
    }
}

fn maxima<'a, M: RigidModel<f64, Body = &'a BoxTumbling>, A: Method<f64, M>>(
    method: &A,
    model: &M,
    body: &BoxTumbling,
    h: f64,
) -> [f64; 3] {
    let start = model.state(&RigidMotion::<f64>::exact(body, 0.0));
    let steps = (10.0 / h).ceil() as u64;
    let (x0, v0, g) = (Vector3::from(body.x0), Vector3::from(body.v0), Vector3::from(body.gravity));
    let inertia = Vector3::from(body.inertia);
    let invariants = |s: &_| {
        let at = model.kinematics(s);
        let momentum = inertia.component_mul(&at.omega_body);
        let translation = body.mass * (0.5 * dot(at.velocity, at.velocity) - dot(g, at.position));
        (translation + 0.5 * dot(at.omega_body, momentum), at.attitude.rotate(momentum))
    };
    let (energy, momentum) = invariants(&start);
    let mut largest = [0.0_f64; 3];
    // A state that is not finite leaves the maxima behind; they are then compared with the printed ones and fail.
    let _ = drive::integrate(method, model, start, h, steps, |i, s| {
        let t = i as f64 * h;
        let (e, l) = invariants(s);
        let exact = x0 + v0 * t + g * (0.5 * t * t);
        let errors = [
            (l - momentum).norm() / momentum.norm(),
            (e - energy).abs() / energy,
            (model.kinematics(s).position - exact).norm(),
        ];
        largest = std::array::from_fn(|k| largest[k].max(errors[k]));
    });
    largest
}

/// E / E0 of the spinning box after 500 steps.
fn spin(method: &str, h: f64) -> f64 {
    // m/3 (b^2 + c^2) with half sizes 0.1, 0.2, 0.3 m and m = 1 kg.
    let inertia = [0.04 + 0.09, 0.01 + 0.09, 0.01 + 0.04].map(|sum| sum / 3.0);
    let body = BoxTumbling {
        mass: 1.0,
        inertia,
        v0: [0.0; 3],
        omega: [1.0, 2.0, 3.0],
        gravity: [0.0; 3],
        ..BoxTumbling::default()
    };
    let model = BodyOmega::<_, Exponential<Body>>::new(&body);
    let start = model.state(&RigidMotion::<f64>::exact(&body, 0.0));
    let end = if method.contains("Newton") {
        drive::advance(&ImplicitGyroscopic, &model, start, h, 500)
    } else {
        drive::advance(&ExplicitEuler, &model, start, h, 500)
    };
    let twice_energy = |omega: Vector3<f64>| dot(omega, Vector3::from(inertia).component_mul(&omega));
    end.map_or(f64::NAN, |end| twice_energy(end.v.angular) / twice_energy(start.v.angular))
}
