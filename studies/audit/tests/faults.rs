//! Faults put into exact motions, one at a time, and steps of known methods: each fault is named, no other is, and fewer digits
//! make a verdict weaker, never wrong.

use std::fmt::Write;
use std::path::PathBuf;

use audit::step::StepVerdict;
use audit::subject::Settings;
use audit::{Args, FileReport, judge};
use integrator::methods::{
    FreeSplitting, ImplicitGyroscopic, ImplicitMidpoint, MomentumMidpoint, RestoredMomentum, Rk4, SemiImplicitEuler,
};
use integrator::rigid_body::{BodyOmega, RigidModel, WorldMomentum, WorldOmega};
use integrator::{Method, Rotation, drive};
use nalgebra::Vector3;
use scenes::TorqueFreeSpin;
use scenes::motion::{Motion, RigidMotion};

const ROWS: usize = 400;
const H: f64 = 0.015625;

/// One row of a body in free space: time, attitude, angular velocity in the body.
#[derive(Clone, Copy)]
struct Row {
    t: f64,
    q: Rotation<f64>,
    w: Vector3<f64>,
}

fn body() -> TorqueFreeSpin {
    TorqueFreeSpin::default()
}

/// The exact motion of a body whose angular velocity is damped by c omega.
fn exact(body: &TorqueFreeSpin, c: f64, pose_late: f64) -> Vec<Row> {
    let slowed = |t: f64| if c == 0.0 { t } else { -(-c * t).exp_m1() / c };
    let row = |i: usize| {
        let t = i as f64 * H;
        let pose = RigidMotion::<f64>::exact(body, slowed(t - pose_late));
        let rate = RigidMotion::<f64>::exact(body, slowed(t));
        Row { t, q: pose.attitude, w: rate.omega_body * (-c * t).exp() }
    };
    (0..ROWS).map(row).collect()
}

const HEADER: &str = "t,qw,qx,qy,qz,wx,wy,wz";

/// A number with so many significant digits; 17 are all.
fn show(x: f64, digits: usize) -> String {
    if digits >= 17 { format!("{x:?}") } else { format!("{x:.*e}", digits - 1) }
}

fn table(header: &str, rows: impl IntoIterator<Item = Vec<f64>>, digits: usize) -> String {
    let mut text = format!("{header}\n");
    for row in rows {
        let cells: Vec<String> =
            row.iter().enumerate().map(|(i, x)| show(*x, if i == 0 { 17 } else { digits })).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

fn cells(r: &Row) -> Vec<f64> {
    let q = r.q.wxyz();
    vec![r.t, q[0], q[1], q[2], q[3], r.w.x, r.w.y, r.w.z]
}

struct File(tempfile::TempDir);

impl File {
    fn new(text: &str) -> Self {
        let dir = tempfile::tempdir().expect("a temporary directory");
        std::fs::write(dir.path().join("run.csv"), text).expect("written");
        File(dir)
    }
    fn judged(&self, settings: Settings) -> FileReport {
        let path: PathBuf = self.0.path().join("run.csv");
        judge(&path, &Args { settings, record_every: Some(1), ..Args::default() }).unwrap_or_else(|e| panic!("{e}"))
    }
}

fn free() -> Settings {
    Settings { scene: Some("torque-free-spin".to_owned()), set: vec![], inertia: Some(body().inertia.into()) }
}

fn spring() -> Settings {
    let set = [("stiffness", "6"), ("mass", "1.5")].map(|(a, b)| (a.to_owned(), b.to_owned())).to_vec();
    Settings { scene: Some("spring-3d".to_owned()), set, inertia: None }
}

fn ids(report: &FileReport) -> Vec<&'static str> {
    let mut ids: Vec<&str> = report.faults().map(|f| f.id).collect();
    ids.sort_unstable();
    ids
}

fn value(report: &FileReport, id: &str) -> f64 {
    report.faults().find(|f| f.id == id).unwrap_or_else(|| panic!("no {id}")).value
}

/// Judges rows of the free body.
fn judged(header: &str, rows: impl IntoIterator<Item = Vec<f64>>, digits: usize) -> FileReport {
    File::new(&table(header, rows, digits)).judged(free())
}

/// A mass on a spring in three dimensions, k/m = 4 `factor`: time, position, velocity.
fn oscillation(factor: f64, pose_late: f64) -> Vec<Vec<f64>> {
    let (x0, v0) = (Vector3::new(0.75, -0.5, 0.25), Vector3::new(-1.25, 0.5, 1.0));
    let w = (4.0 * factor).sqrt();
    let at = |t: f64| (x0 * (w * t).cos() + v0 * ((w * t).sin() / w), v0 * (w * t).cos() - x0 * (w * (w * t).sin()));
    let row = |i: usize| {
        let t = i as f64 * H;
        let (x, v) = (at(t - pose_late).0, at(t).1);
        vec![t, x.x, x.y, x.z, v.x, v.y, v.z]
    };
    (0..ROWS).map(row).collect()
}

const SPRING: &str = "t,x,y,z,vx,vy,vz";

// Fails if a check is switched off, or takes one fault for another.
#[test]
fn faults_of_a_free_body_are_named_alone() {
    for digits in [17, 9] {
        let clean = || exact(&body(), 0.0, 0.0);
        let changed = |change: &dyn Fn(&Row) -> Vec<f64>| judged(HEADER, clean().iter().map(change), digits);
        assert_eq!(ids(&changed(&cells)), [""; 0], "clean, {digits} digits");
        let late = judged(HEADER, exact(&body(), 0.0, H).iter().map(cells), digits);
        assert_eq!(ids(&late), ["attitude-lags"], "a row late, {digits}");
        assert!((value(&late, "attitude-lags") / H - 1.0).abs() < 0.02, "{}", value(&late, "attitude-lags"));
        let half = judged(HEADER, exact(&body(), 0.0, H / 2.0).iter().map(cells), digits);
        assert_eq!(ids(&half), ["attitude-lags"], "half a row late, {digits}");
        assert!((value(&half, "attitude-lags") / H - 0.5).abs() < 0.02);
        let order = changed(&|r| {
            let [w, x, y, z] = r.q.wxyz();
            vec![r.t, x, y, z, w, r.w.x, r.w.y, r.w.z]
        });
        assert_eq!(ids(&order), ["quaternion-order-not-as-named"], "{digits}");
        let conjugate = changed(&|r| cells(&Row { q: r.q.conjugate(), ..*r }));
        assert_eq!(ids(&conjugate), ["attitude-is-inverse"], "{digits}");
        let doubled = changed(&|r| cells(&Row { w: r.w * 2.0, ..*r }));
        assert!(ids(&doubled).contains(&"angular-velocity-factor"), "{digits}: {:?}", ids(&doubled));
        assert!((value(&doubled, "angular-velocity-factor") - 0.5).abs() < 1e-3);
        let negative = changed(&|r| cells(&Row { w: -r.w, ..*r }));
        // -omega of the body and the inverse attitude with omega of the world are one and the same motion.
        let names = ids(&negative);
        assert!(
            ["angular-velocity-factor", "attitude-is-inverse"].iter().any(|name| names.contains(name)),
            "{names:?}"
        );
    }
}

// Fails if the frame of a name is believed against the numbers, or degrees are not recognised.
#[test]
fn frames_and_units_are_decided_by_the_numbers() {
    let rows = exact(&body(), 0.0, 0.0);
    let world = |r: &Row| cells(&Row { w: r.q.rotate(r.w), ..*r });
    let named = "t,qw,qx,qy,qz,omega_body_x,omega_body_y,omega_body_z";
    assert_eq!(ids(&judged(named, rows.iter().map(world), 17)), ["frame-not-as-named"]);
    assert_eq!(ids(&judged(HEADER, rows.iter().map(world), 17)), [""; 0]);
    let degrees = |r: &Row| cells(&Row { w: r.w * 180.0 / std::f64::consts::PI, ..*r });
    let report = judged(HEADER, rows.iter().map(degrees), 17);
    assert_eq!(ids(&report), [""; 0]);
    assert!(report.columns.iter().any(|c| c.reading.contains("deg/s")), "{:?}", report.columns);
}

// Fails if the clock is not looked at, or if a fault of it is taken for one of the motion.
#[test]
fn faults_of_the_clock_are_named_alone() {
    let rows = exact(&body(), 0.0, 0.0);
    let mut repeated = rows.clone();
    repeated.insert(100, rows[99]);
    assert_eq!(ids(&judged(HEADER, repeated.iter().map(cells), 17)), ["repeated-row"]);
    let gap = rows.iter().enumerate().filter(|(i, _)| *i != 57).map(|(_, r)| cells(r));
    assert_eq!(ids(&judged(HEADER, gap, 17)), ["gap"]);
    let reset =
        rows.iter().enumerate().map(|(i, r)| cells(&Row { t: if i < 300 { r.t } else { r.t - 300.0 * H }, ..*r }));
    assert_eq!(value(&judged(HEADER, reset, 17), "clock-reset"), 1.0);
    // Stamps 3 % of a step off, in a fixed pattern without a drift.
    let jitter = rows.iter().enumerate().map(|(i, r)| cells(&Row { t: r.t + 0.03 * H * (i as f64 * 2.4).sin(), ..*r }));
    assert!(ids(&judged(HEADER, jitter, 17)).contains(&"jitter"));
    // Sixty steps a second, added up in single precision.
    let step = 1.0_f32 / 60.0;
    let mut clock = 0.0_f32;
    let single = (0..ROWS).map(|i| {
        let at = RigidMotion::<f64>::exact(&body(), i as f64 / 60.0);
        let row = cells(&Row { t: f64::from(clock), q: at.attitude, w: at.omega_body });
        clock += step;
        row
    });
    assert_eq!(ids(&judged(HEADER, single.collect::<Vec<_>>(), 17)), ["f32-clock"]);
}

// Fails if the regression loses a term, or gives it to another.
#[test]
fn terms_of_the_equation_of_motion_are_told_apart() {
    let swapped = TorqueFreeSpin { inertia: [0.75, 1.25, 1.75], ..body() };
    assert_eq!(ids(&judged(HEADER, exact(&swapped, 0.0, 0.0).iter().map(cells), 17)), ["gyroscopic-term-wrong"]);
    let damped = judged(HEADER, exact(&body(), 0.05, 0.0).iter().map(cells), 17);
    assert_eq!(ids(&damped), ["angular-damping"]);
    assert!((value(&damped, "angular-damping") / 0.05 - 1.0).abs() < 0.01, "{}", value(&damped, "angular-damping"));
    let (q, w) = (Rotation::from_wxyz(body().attitude), Vector3::from(body().omega));
    let still = (0..ROWS).map(|i| cells(&Row { t: i as f64 * H, q: q * Rotation::exp(w * (i as f64 * H)), w }));
    assert_eq!(ids(&judged(HEADER, still, 17)), ["gyroscopic-term-missing"]);
}

// Fails if a force that is 0.2 % too large, a lag or a clamp passes.
#[test]
fn faults_of_a_spring_are_named_alone() {
    let judged = |rows: Vec<Vec<f64>>| File::new(&table(SPRING, rows, 17)).judged(spring());
    assert_eq!(ids(&judged(oscillation(1.0, 0.0))), [""; 0]);
    let stiff = judged(oscillation(1.002, 0.0));
    assert_eq!(ids(&stiff), ["force-factor"]);
    assert!((value(&stiff, "force-factor") - 1.002).abs() < 1e-4, "{}", value(&stiff, "force-factor"));
    let late = judged(oscillation(1.0, H));
    assert!(ids(&late).contains(&"position-lags"));
    assert!((value(&late, "position-lags") / H - 1.0).abs() < 0.02);
    let mut clamped = oscillation(1.0, 0.0);
    clamped.iter_mut().for_each(|r| r[4] = r[4].clamp(-1.25, 1.25));
    assert_eq!(value(&judged(clamped), "velocity-clamped"), 1.25);
}

/// Rows of a run.
fn run<'a, M: RigidModel<f64, Body = &'a TorqueFreeSpin>, A: Method<f64, M>>(
    method: &A,
    model: &M,
    h: f64,
) -> Vec<Vec<f64>>
where
    M::Config: Copy,
{
    let start = model.state(&RigidMotion::<f64>::exact(&body(), 0.0));
    let mut rows = Vec::new();
    let end = drive::integrate(method, model, start, h, 200, |i, s| {
        let at = model.kinematics(s);
        rows.push(cells(&Row { t: i as f64 * h, q: at.attitude, w: at.omega_body }));
    });
    assert!(end.is_ok());
    rows
}

// Fails if a candidate steps differently from the method of the same name, or a verdict is wrong where digits are few.
#[test]
fn methods_are_identified_and_fewer_digits_never_name_another() {
    let body = body();
    for h in [0.0078125, 0.015625, 0.03125] {
        let runs: [(&str, Vec<Vec<f64>>); 7] = [
            ("semi-implicit-euler/body-omega/exponential", run(&SemiImplicitEuler, &BodyOmega::<_>::new(&body), h)),
            ("rk4/world-omega/exponential", run(&Rk4, &WorldOmega::<_>::new(&body), h)),
            ("implicit-midpoint/body-omega/exponential", run(&ImplicitMidpoint, &BodyOmega::<_>::new(&body), h)),
            ("implicit-gyroscopic/exponential", run(&ImplicitGyroscopic, &BodyOmega::<_>::new(&body), h)),
            ("restored-momentum/exponential", run(&RestoredMomentum, &BodyOmega::<_>::new(&body), h)),
            ("momentum-midpoint/exponential", run(&MomentumMidpoint, &WorldMomentum::<_>::new(&body), h)),
            ("free-splitting/exponential", run(&FreeSplitting, &BodyOmega::<_>::new(&body), h)),
        ];
        for (id, rows) in runs {
            for digits in [17, 9, 6] {
                let report = judged(HEADER, rows.clone(), digits);
                assert_eq!(ids(&report), [""; 0], "{id}, h = {h}, {digits} digits");
                let step = &report.step[0];
                let named = |c: &audit::step::Tried| c.id == id || c.same_as.iter().any(|s| s == id);
                match step.verdict {
                    StepVerdict::Identified | StepVerdict::OneOf => {
                        assert!(step.candidates.iter().any(named), "{id}, h = {h}, {digits}: {:?}", step.candidates);
                    }
                    // Few digits may hide the step behind the exact motion; all digits may not.
                    StepVerdict::Exact => assert!(digits < 17, "{id}, h = {h}"),
                    StepVerdict::NoneOf => {
                        panic!("{id}, h = {h}, {digits}: none of, nearest {}", step.candidates[0].id)
                    }
                }
            }
        }
    }
}

// Fails if an exact motion is given a method, or a wrapped angle is taken for a jump.
#[test]
fn an_exact_motion_has_no_step() {
    let report = judged(HEADER, exact(&body(), 0.0, 0.0).iter().map(cells), 17);
    assert_eq!(report.step[0].verdict, StepVerdict::Exact);
    let pendulum = scenes::Pendulum::rotation();
    let row = |i: usize| {
        let s = Motion::<f64>::exact(&pendulum, i as f64 * H);
        let turn = std::f64::consts::TAU;
        vec![i as f64 * H, s.q.x - turn * (s.q.x / turn).round(), s.v.x]
    };
    let set = [("length", pendulum.length), ("gravity", pendulum.gravity)].map(|(a, b)| (a.to_owned(), b.to_string()));
    let settings = Settings { scene: Some("pendulum".to_owned()), set: set.to_vec(), inertia: None };
    let report = File::new(&table("t,theta,theta_dot", (0..ROWS).map(row), 17)).judged(settings);
    assert_eq!(ids(&report), [""; 0]);
    assert!(report.findings.iter().any(|f| f.id == "wrapped-angle"));
    assert_eq!(report.step[0].verdict, StepVerdict::Exact);
}
