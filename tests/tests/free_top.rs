//! Exact motions of rigid bodies against 30-digit reference solutions, and against their own equations.

use faer::fx128;
use integrator::real::Single;
use integrator::rotation::Rotation;
use nalgebra::Vector3;
use scenes::special::free_top::FreeTop;
use scenes::special::lagrange_top::LagrangeTop;
use scenes::special::sphere_torque::SphereTop;
use scenes::special::symmetric_top::SymmetricTop;
use verification::reference::{self, Reference, Row};

type Motion<T> = (Rotation<T>, Vector3<T>);

/// Largest component of the error of the attitude (the table's sign is the continuous lift from q0, and so is ours) and
/// of omega, relative to |omega|.
fn errors<T: Single>((attitude, omega): Motion<T>, truth: [fx128; 4], omega_truth: [fx128; 3]) -> (f64, f64) {
    let found = attitude.wxyz().map(Single::widen);
    let apart = (0..4).map(|i| (found[i] - truth[i]).0.abs()).fold(0.0, worse);
    let size = Vector3::from(omega_truth.map(|c| c.0)).norm();
    let omega_apart = (0..3).map(|i| (omega[i].widen() - omega_truth[i]).0.abs()).fold(0.0, worse);
    (apart, omega_apart / size)
}

/// The larger number; NaN if either is.
fn worse(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

fn worst_over<T: Single>(case: &Reference, omega: &str, motion: impl Fn(T) -> Motion<T>, bound: impl Fn(f64) -> f64) {
    let mut worst = (0.0, 0.0);
    for row in &case.rows {
        let (q, w) = at_row(case, row, omega, &motion);
        assert!(
            q <= bound(row.t) && w <= bound(row.t),
            "t = {}: attitude {q:e}, omega {w:e}, bound {:e}",
            row.t,
            bound(row.t)
        );
        worst = (worse(worst.0, q), worse(worst.1, w));
    }
    println!("  attitude {:.2e}, omega {:.2e} (eps {:.2e})", worst.0, worst.1, T::EPSILON);
}

fn at_row<T: Single>(case: &Reference, row: &Row, omega: &str, motion: impl Fn(T) -> Motion<T>) -> (f64, f64) {
    errors(motion(T::lit(row.t)), case.values(row, "qw"), case.values(row, omega))
}

/// 30 digits of the table, and the rounding of the double-double phase of up to 2 T t / L rad.
fn double_double(rate: f64) -> impl Fn(f64) -> f64 {
    move |t| 1e-29 + 8.0 * fx128::EPSILON.0 * (4.0 + rate * t)
}

#[test]
fn free_tops_agree_with_the_reference() {
    for set in reference::sets("free_top") {
        let case = reference::load("free_top", &set);
        let (inertia, omega) = (case.vector("I"), case.vector("wb0"));
        let top = FreeTop::new(inertia, case.vector("q0"), omega);
        println!("free_top {set}");
        // The last operations are three products of quaternions and a normalisation: about 4 eps a component.
        worst_over::<f64>(&case, "wbx", |t| top.at(t), |_| 4.0 * f64::EPSILON);
        worst_over::<fx128>(&case, "wbx", |t| top.at(t), double_double(Vector3::from(omega).norm()));
    }
}

#[test]
fn symmetric_tops_agree_with_the_reference_in_both_forms() {
    for set in reference::sets("symmetric_free") {
        let case = reference::load("symmetric_free", &set);
        let (i1, i3, q0, omega) = (case.number("I1"), case.number("I3"), case.vector("q0"), case.vector("wb0"));
        let rate = double_double(Vector3::from(omega).norm());
        println!("symmetric_free {set}");
        let top = SymmetricTop::new(i1, i3, q0, omega);
        worst_over::<f64>(&case, "wbx", |t| top.at(t), |_| 4.0 * f64::EPSILON);
        worst_over::<fx128>(&case, "wbx", |t| top.at(t), &rate);
        let general = FreeTop::new([i1, i1, i3], q0, omega);
        worst_over::<f64>(&case, "wbx", |t| general.at(t), |_| 4.0 * f64::EPSILON);
        worst_over::<fx128>(&case, "wbx", |t| general.at(t), &rate);
    }
}

#[test]
fn spheres_under_a_constant_torque_agree_with_the_reference() {
    for set in reference::sets("sphere_torque") {
        let case = reference::load("sphere_torque", &set);
        let sphere = SphereTop::new(case.number("I"), case.vector("q0"), case.vector("w0"), case.vector("tau"));
        println!("sphere_torque {set}");
        worst_over::<f64>(&case, "wwx", |t| sphere.at(t), |_| 2.0 * f64::EPSILON);
        // The series in segments lose 1e-30 (1 + |Z|), Z = |tau| t^2 / (2 I) <= 256.
        worst_over::<fx128>(&case, "wwx", |t| sphere.at(t), |t| 1e-29 * (1.0 + t * t / 4.0));
    }
}

#[test]
fn heavy_tops_agree_with_the_reference() {
    for set in reference::sets("lagrange_top") {
        let case = reference::load("lagrange_top", &set);
        let omega = case.vector("wb0");
        let [i1, i3, mgl] = ["I1", "I3", "mgl"].map(|name| case.number(name));
        let top = LagrangeTop::new(i1, i3, mgl, case.vector("q0"), omega);
        println!("lagrange_top {set}");
        worst_over::<f64>(&case, "wbx", |t| top.at(t), |_| 2.0 * f64::EPSILON);
        worst_over::<fx128>(&case, "wbx", |t| top.at(t), double_double(Vector3::from(omega).norm()));
    }
}
