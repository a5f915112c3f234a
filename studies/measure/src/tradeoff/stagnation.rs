//! Where a fixed step is too short for its arithmetic: a body at rest at x under a force g moves by g h^2 in its first step of
//! semi-implicit Euler, and not at all where that is less than half the distance from x to the next number.
//!
//! x + d rounds to x for d < ulp(x) / 2, and for d = ulp(x) / 2 if the last bit of x is zero (IEEE 754-2019, 4.3.1), so that
//! the step below which nothing moves is sqrt(ulp(x) / (2 g)).

use integrator::methods::MethodId;

use super::{Part, Row};
use crate::study::Selection;
use scenes::ConstantForce;

use scenes::observation::Quantity;
use scenes::run::{Precision, Run};

/// Heights at which the body is let go, m: 1.5, 1.5 km or so, and far beyond. In the middle of a binade, where the distance to the
/// next number is the same on both sides; the last bit is zero.
pub const HEIGHTS_M: [f64; 3] = [1.5, 1536.0, 1_572_864.0];
/// The force divided by the mass, m/s^2: dyadic, so that every arithmetic has the same.
pub const GRAVITY: f64 = 9.75;

/// One row for each height and arithmetic that has a half of an ulp to speak of.
pub fn rows(selection: &Selection) -> Vec<Row> {
    let chosen = selection.scenes.iter().any(|scene| scene.id() == "constant-force")
        && selection.methods.contains(&MethodId::SemiImplicitEuler);
    if !chosen {
        return Vec::new();
    }
    let precisions = selection.precisions.iter().filter(|p| **p != Precision::DoubleDouble);
    precisions.flat_map(|&precision| HEIGHTS_M.map(|height| row(precision, height))).collect()
}

fn row(precision: Precision, height_m: f64) -> Row {
    let theory = predicted_s(precision, height_m);
    let (at_rest, moving) = bracket(precision, height_m, theory);
    Row {
        unit: "s".to_owned(),
        evaluations: 1,
        position_m: Some(height_m),
        at_rest_h_s: Some(at_rest),
        moving_h_s: Some(moving),
        theory_h_s: Some(theory),
        ..Row::new(
            Part::Stagnation,
            "constant-force",
            MethodId::SemiImplicitEuler.id().to_owned(),
            precision,
            1,
            moving,
        )
    }
}

/// sqrt(ulp(x) / (2 g)).
pub fn predicted_s(precision: Precision, height_m: f64) -> f64 {
    let ulp = precision.epsilon() * 2.0_f64.powi(height_m.log2().floor() as i32);
    (0.5 * ulp / GRAVITY).sqrt()
}

/// The largest step found after which the body stands and the smallest after which it has moved, by bisection from a quarter and
/// four times the prediction until no number of the arithmetic lies between.
fn bracket(precision: Precision, height_m: f64, near_s: f64) -> (f64, f64) {
    let (mut at_rest, mut moving) = (near_s / 4.0, near_s * 4.0);
    while moving - at_rest > precision.epsilon() * moving {
        let middle = 0.5 * (at_rest + moving);
        if moves(precision, height_m, middle) {
            moving = middle;
        } else {
            at_rest = middle;
        }
    }
    (at_rest, moving)
}

/// Whether a body let go at this height has moved after one step of semi-implicit Euler.
pub fn moves(precision: Precision, height_m: f64, h_s: f64) -> bool {
    let scene = ConstantForce { mass: 1.0, force: [0.0, 0.0, -GRAVITY], x0: [0.0, 0.0, height_m], v0: [0.0; 3] };
    let scene = scenes::boxed("constant-force", scene);
    let run = scene.run(&Run::new(MethodId::SemiImplicitEuler, precision, h_s, 1), 1);
    let height = |i: usize| run.as_ref()?.seen.get(i).map(|(_, seen)| seen.vector(Quantity::Position)[2]);
    height(0) != height(1)
}
