//! What one step does to a free body: T, |L|^2, and the nutation of a symmetric top, against theory.
//!
//! With v = l x omega in the body frame and J = I^-1, a step changes T by c_T h^2 / 2 and |L|^2 by c_L h^2. The changes are
//! measured in double-double, where a step of 2^-20 s still leaves 18 digits of them.

use faer::fx128;
use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::Formulation;
use integrator::rotation::cross;
use integrator::{Real, Single};
use nalgebra::Matrix2;

use super::free::{Free, dot, run};
use super::row::{Experiment, Row};
use scenes::TorqueFreeSpin;
use scenes::scheme::{Rule, Scheme};

/// How far a law goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// The identity holds for every step.
    Exact,
    /// It is the limit for small steps.
    Leading,
}

/// lim 2 dT / h^2 and lim d|L|^2 / h^2 of a scheme, where theory states them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLaw {
    /// 2 dT / h^2, W/s.
    pub energy: (f64, Reach),
    /// d|L|^2 / h^2, (N m)^2.
    pub momentum: (f64, Reach),
}

/// The per-step law of a scheme on a free body.
pub fn step_law(scheme: Scheme, at: &Free) -> Option<StepLaw> {
    use MethodId::{ExplicitEuler, ImplicitMidpoint, SemiImplicitEuler};
    use Reach::{Exact, Leading};
    let (l, w) = (at.momentum(), at.omega);
    let v = cross(l, w);
    let jv = v.component_div(&at.inertia);
    let (power, square) = (dot(v, jv).to_f64(), dot(v, v).to_f64());
    let law = |energy, momentum| Some(StepLaw { energy, momentum });
    match (scheme.rule, scheme.storage) {
        (Rule::General(SemiImplicitEuler), Formulation::WorldOmega | Formulation::BodyOmega)
        | (Rule::General(ExplicitEuler), Formulation::BodyOmega) => law((power, Exact), (square, Exact)),
        (Rule::General(ExplicitEuler), Formulation::WorldOmega) => {
            let turned = dot(l, at.inertia.component_mul(&cross(w, jv))).to_f64();
            law((-power, Leading), (square - 2.0 * turned, Leading))
        }
        (Rule::General(ExplicitEuler | SemiImplicitEuler), Formulation::WorldMomentum) => {
            law((power, Leading), (0.0, Exact))
        }
        (Rule::Rigid(RigidStep::ImplicitGyroscopic), _) => law((-power, Leading), (-square, Leading)),
        (Rule::Rigid(RigidStep::RestoredMomentum), _) => {
            let restored = (at.twice_energy() / at.momentum_squared()).to_f64() * square;
            law((power - restored, Leading), (0.0, Exact))
        }
        (Rule::Rigid(RigidStep::MomentumMidpoint | RigidStep::FreeSplitting), _)
        | (Rule::General(MethodId::VelocityVerlet), Formulation::WorldMomentum) => law((0.0, Leading), (0.0, Exact)),
        (Rule::General(ImplicitMidpoint), Formulation::BodyOmega) => law((0.0, Exact), (0.0, Exact)),
        // The world frame turns with the step: the midpoint rule is no longer that of a quadratic vector field.
        (Rule::General(ImplicitMidpoint), Formulation::WorldMomentum) => law((0.0, Leading), (0.0, Exact)),
        (Rule::General(_), Formulation::WithoutGyroscopicTerm) => law((0.0, Exact), (0.0, Exact)),
        _ => None,
    }
}

/// Whether the leading change of T in a step is a multiple of v . J v, which is positive unless the body spins about an axis.
pub fn energy_changes_with_one_sign(scheme: Scheme) -> bool {
    use MethodId::{ExplicitEuler, SemiImplicitEuler};
    match scheme.rule {
        Rule::General(ExplicitEuler | SemiImplicitEuler) => !scheme.lacks_gyroscopic_term(),
        Rule::Rigid(step) => step == RigidStep::ImplicitGyroscopic,
        Rule::General(_) => false,
    }
}

/// The step of an exact law, and of a leading one, s.
const EXACT_STEP_S: f64 = 1.0 / 64.0;
const LEADING_STEP_S: f64 = 1.0 / 1_048_576.0;

/// Both laws of every scheme on one body.
pub fn step_laws(body: &TorqueFreeSpin, schemes: &[Scheme]) -> Vec<Row> {
    schemes.iter().flat_map(|&scheme| step_laws_of(scheme, body)).collect()
}

fn step_laws_of(scheme: Scheme, body: &TorqueFreeSpin) -> Vec<Row> {
    let exact = run::<fx128>(scheme, body, EXACT_STEP_S, 1, 1);
    let Some(start) = exact.seen.first().and_then(|(_, seen)| Free::of(body.inertia, seen)) else { return Vec::new() };
    let change = |h: f64| -> Option<[f64; 2]> {
        let end = Free::of(body.inertia, run::<fx128>(scheme, body, h, 1, 1).end()?)?;
        let h2 = fx128::lit(h * h);
        let momentum = (end.momentum_squared() - start.momentum_squared()) / h2;
        Some([((end.twice_energy() - start.twice_energy()) / h2).to_f64(), momentum.to_f64()])
    };
    // T and |L|^2 are sums of a few products of rounded numbers: 64 units in the last place, divided by h^2.
    let scale = [start.twice_energy().to_f64(), start.momentum_squared().to_f64()];
    let rounding = |i: usize, h: f64| 64.0 * <fx128 as Single>::EPSILON * scale[i] / (h * h);
    let law = step_law(scheme, &start);
    let row = Row::new(Experiment::StepLaw, "asymmetric body", scheme, EXACT_STEP_S, &exact);
    [("2 dT / h^2", "W/s"), ("d|L|^2 / h^2", "(N m)^2")]
        .into_iter()
        .enumerate()
        .map(|(i, (name, unit))| {
            let theory = law.map(|law| [law.energy, law.momentum][i]);
            if let Some((theory, Reach::Exact)) = theory {
                // Theory is rounded to f64 once.
                let tolerance = rounding(i, EXACT_STEP_S) + 4.0 * f64::EPSILON * theory.abs();
                return row.measured(name, unit, change(EXACT_STEP_S).map(|c| c[i])).against(theory, tolerance);
            }
            let Some((value, error)) = limit(|h| change(h).map(|c| c[i])) else {
                return row.measured(name, unit, None);
            };
            let row = Row { h_s: LEADING_STEP_S, ..row.measured(name, unit, Some(value)) };
            let tolerance = error + 8.0 * rounding(i, LEADING_STEP_S / 4.0);
            theory.map_or(row.clone(), |(theory, _)| row.against(theory, tolerance + 4.0 * f64::EPSILON * theory.abs()))
        })
        .collect()
}

/// The limit for h -> 0 of r(h) = r + c h + d h^2 + ...: E(h) = 2 r(h/2) - r(h) is wrong by -d h^2 / 2, E(h/2) by a quarter
/// of that; their difference is three times the error of the better one.
fn limit(r: impl Fn(f64) -> Option<f64>) -> Option<(f64, f64)> {
    let h = LEADING_STEP_S;
    let (r0, r1, r2) = (r(h)?, r(h / 2.0)?, r(h / 4.0)?);
    let (coarse, fine) = (2.0 * r1 - r0, 2.0 * r2 - r1);
    // The numbers are rounded to f64 before the subtraction.
    Some((fine, (coarse - fine).abs() + 8.0 * f64::EPSILON * (r0.abs() + r1.abs() + r2.abs())))
}

/// The factor of theory for the nutation of a symmetric top in one step: rho = I3 / I1, theta = omega3 h,
/// x = (rho - 1) theta.
pub fn nutation_factor(scheme: Scheme, rho: f64, theta: f64) -> Option<f64> {
    use MethodId::{ExplicitEuler, ImplicitMidpoint, SemiImplicitEuler};
    let x = (rho - 1.0) * theta;
    // The linear update turns by 2 atan(theta / 2) where the exponential map turns by theta.
    let turned = match scheme.update {
        integrator::rigid_body::AttitudeUpdate::Exponential => theta,
        integrator::rigid_body::AttitudeUpdate::Linear => 2.0 * (theta / 2.0).atan(),
    };
    match (scheme.rule, scheme.storage) {
        (Rule::General(SemiImplicitEuler), Formulation::WorldOmega | Formulation::BodyOmega)
        | (Rule::General(ExplicitEuler), Formulation::BodyOmega)
        | (Rule::Rigid(RigidStep::RestoredMomentum), _) => Some(x.hypot(1.0)),
        (Rule::General(ExplicitEuler), Formulation::WorldOmega) => Some((1.0 + 2.0 * x * turned.sin() + x * x).sqrt()),
        (Rule::General(ExplicitEuler | SemiImplicitEuler), Formulation::WorldMomentum)
            if scheme.update == integrator::rigid_body::AttitudeUpdate::Exponential =>
        {
            Some((1.0 + 4.0 * rho * (rho - 1.0) * (theta / 2.0).sin().powi(2)).sqrt())
        }
        (Rule::Rigid(RigidStep::ImplicitGyroscopic), _) => Some(1.0 / x.hypot(1.0)),
        (Rule::General(ImplicitMidpoint), Formulation::BodyOmega)
        | (Rule::General(_), Formulation::WithoutGyroscopicTerm) => Some(1.0),
        _ => None,
    }
}

/// Tops whose nutation is measured: name, (I1, I3) in kg m^2, spin in rad/s.
pub const TOPS: [(&str, [f64; 2], f64); 2] = [("disc", [0.25, 0.5], DISC_SPIN), ("rod", [0.5, 0.125], 30.0)];
/// Spin of the disc, rad/s.
pub const DISC_SPIN: f64 = 60.0;
/// Steps at which the nutation is measured, s: omega3 h from 1/4 to 2 for the disc.
pub const NUTATION_STEPS_S: [f64; 5] = [1.0 / 240.0, 1.0 / 120.0, 1.0 / 60.0, 1.0 / 40.0, 1.0 / 30.0];

/// Angular velocity across the axis in rad/s, so small that its square is lost: the step is linear in it.
const ACROSS: f64 = 1.0 / (1_u64 << 40) as f64;

/// The nutation factors of every scheme on a body (I1, I1, I3) that spins at `omega3` with the step `h_s`.
pub fn nutation(name: &str, [inertia_1, inertia_3]: [f64; 2], omega3: f64, h_s: f64, schemes: &[Scheme]) -> Vec<Row> {
    let factor = |scheme: Scheme| -> Option<f64> {
        let column = |x: f64, y: f64| -> Option<[f64; 2]> {
            let body = symmetric(inertia_1, inertia_3, [x, y, omega3]);
            let end = Free::of(body.inertia, run::<fx128>(scheme, &body, h_s, 1, 1).end()?)?;
            let part = |i: usize| (end.omega[i] / fx128::lit(ACROSS)).to_f64();
            Some([part(0), part(1)])
        };
        let (a, b) = (column(ACROSS, 0.0)?, column(0.0, ACROSS)?);
        Some(spectral_radius(Matrix2::new(a[0], b[0], a[1], b[1])))
    };
    schemes
        .iter()
        .map(|&scheme| {
            let seen = run::<fx128>(scheme, &symmetric(inertia_1, inertia_3, [ACROSS, 0.0, omega3]), h_s, 1, 1);
            let row =
                Row::new(Experiment::Nutation, name, scheme, h_s, &seen).measured("factor a step", "1", factor(scheme));
            // A few operations in f64 on both sides; what the square of ACROSS leaves is below 1e-23.
            let theory = nutation_factor(scheme, inertia_3 / inertia_1, omega3 * h_s);
            theory.map_or(row.clone(), |theory| row.against(theory, 32.0 * f64::EPSILON * theory))
        })
        .collect()
}

/// A body (I1, I1, I3) at the identity.
pub fn symmetric(inertia_1: f64, inertia_3: f64, omega: [f64; 3]) -> TorqueFreeSpin {
    TorqueFreeSpin { inertia: [inertia_1, inertia_1, inertia_3], attitude: [1.0, 0.0, 0.0, 0.0], omega }
}

/// The largest |eigenvalue| of a 2 x 2 matrix.
fn spectral_radius(m: Matrix2<f64>) -> f64 {
    let (half_trace, determinant) = (m.trace() / 2.0, m.determinant());
    let discriminant = half_trace * half_trace - determinant;
    // Rounding must not turn a double eigenvalue into two.
    if discriminant <= 16.0 * f64::EPSILON * half_trace * half_trace {
        determinant.abs().sqrt()
    } else {
        half_trace.abs() + discriminant.sqrt()
    }
}

/// The body on which the laws are measured: unequal unsorted moments, no component zero.
pub fn generic_body() -> TorqueFreeSpin {
    TorqueFreeSpin::default()
}
