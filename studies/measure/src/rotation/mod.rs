//! What do engines store and how do they step? Every scheme in use for the rotation of a rigid body, on exact motions.

pub mod claims;
pub mod free;
pub mod laws;
pub mod long;
pub mod orders;
pub mod published;
pub mod row;
mod show;
mod tables;

use integrator::methods::MethodId;
use integrator::rigid_body::{AttitudeUpdate, Formulation};
use reports::{Claim, Figure};

pub use row::{Experiment, Row};
pub use scenes::scheme::{Rule, Scheme};

use crate::error::Error;
use crate::study::{Derived, Selection, Study, check_method, check_steps};
use scenes::any::AnyScene;
use scenes::run::{Outcome, Trajectory};

/// The study.
pub struct Rotation;

impl Study for Rotation {
    type Row = Row;
    const ID: &'static str = "rotation";
    const HEEDS: &'static [&'static str] = &["steps", "for"];
    const TAKES_SCHEMES: bool = true;
    const ABOUT: &'static str =
        "Compares every scheme in use for rigid bodies: error, order, drift, nutation, where the body ends up";
    const EXAMPLES: &'static str = "rotation --scene torque-free-spin --scene heavy-top
        rotation --method semi-implicit-euler --out /tmp/rotation";
    const TITLE: &'static str = "What should a rigid body store, and how should it step?";
    const INTRO: &'static str = "Engines store the angular velocity in the world or in the body frame, or the angular \
        momentum; they advance the attitude by the exponential map or by a normalised linear step; and they treat the \
        gyroscopic term explicitly, implicitly, with the length of L restored, or not at all. Every such scheme is run on \
        exact motions. What a scheme does to the energy T and to |L| in one step is a formula, and so is the factor by which \
        it multiplies the nutation of a spinning disc: both are measured against it.";

    fn measure(selection: &Selection) -> Vec<Row> {
        let schemes: Vec<Scheme> = Scheme::all().into_iter().filter(|s| asked_for(selection, *s)).collect();
        let mut rows = orders::measure(selection, &schemes);
        rows.extend(on_free_bodies(selection, &schemes));
        let scenes: Vec<&dyn AnyScene> =
            selection.scenes.iter().map(AsRef::as_ref).filter(|scene| scene.is_rigid()).collect();
        rows.extend(selection.rows(&scenes, 7e-3, |_| 1, |scene| same_motions(*scene, selection.end_s(*scene))));
        rows.extend(selection.rows(&[()], 0.04, |()| 1, |()| printed()));
        rows
    }
    fn tables(rows: &[Row]) -> Result<Vec<Derived>, Error> {
        tables::tables(rows)
    }
    fn figures(rows: &[Row]) -> Vec<Figure> {
        show::figures(rows)
    }
    fn claims(rows: &[Row]) -> Vec<Claim> {
        claims::claims(rows)
    }
    fn check(row: &Row) -> Result<(), String> {
        check_method(&row.scheme, Scheme::is_known(&row.scheme))?;
        check_steps(1, row.h_s)
    }
}

/// A method that was not chosen is left out; steps that exist for rigid bodies only are compared unless schemes are chosen by name.
fn asked_for(selection: &Selection, scheme: Scheme) -> bool {
    match scheme.rule {
        _ if selection.schemes.contains(&scheme) => true,
        Rule::General(method) => selection.methods.contains(&method),
        Rule::Rigid(_) => selection.schemes.is_empty(),
    }
}

/// End of the long runs, s: they are cheap, and where a body ends up is not seen in shorter ones.
const LONG_S: f64 = 400.0;

/// One step, one minute and one long run of free bodies: which scene was chosen does not matter.
fn on_free_bodies(selection: &Selection, schemes: &[Scheme]) -> Vec<Row> {
    let body = laws::generic_body();
    let jobs: Vec<Scheme> = schemes.to_vec();
    let cost = |scheme: &Scheme| if scheme.is_implicit() { 50 } else { 1 };
    selection.rows(&jobs, 2.3e-3, cost, |&scheme| {
        let one = [scheme];
        let mut rows = laws::step_laws(&body, &one);
        for (name, inertia, omega3) in laws::TOPS {
            for h_s in laws::NUTATION_STEPS_S {
                rows.extend(laws::nutation(name, inertia, omega3, h_s, &one));
            }
        }
        rows.extend(long::disc_runs(&one));
        for (name, start) in long::long_starts() {
            // An implicit step costs fifty explicit ones, and its long run shows nothing but that nothing happens.
            rows.extend(long::long_run(name, &start, if scheme.is_implicit() { LONG_S / 10.0 } else { LONG_S }, &one));
        }
        rows.extend(long::drift(&body, &one));
        rows
    })
}

/// The two forms of semi-implicit Euler, which are one motion, and of explicit Euler, which are not.
fn same_motions(scene: &dyn AnyScene, end_s: f64) -> Vec<Row> {
    let pair = |method| {
        [Formulation::WorldOmega, Formulation::BodyOmega]
            .map(|storage| Scheme::general(method, storage, AttitudeUpdate::Exponential))
    };
    [MethodId::SemiImplicitEuler, MethodId::ExplicitEuler]
        .into_iter()
        .flat_map(|method| long::same_motion(scene, pair(method), end_s, 256))
        .collect()
}

/// The numbers of other projects and ours.
fn printed() -> Vec<Row> {
    // The data are part of the program and are read by its tests: a line that cannot be read leaves the claims untested.
    let all = published::comparisons().unwrap_or_default();
    let none = Trajectory { outcome: Outcome::Finished, failed_step: None, seen: Vec::new(), evaluations: 0 };
    all.iter()
        .map(|comparison| {
            let printed = &comparison.published;
            let row =
                Row::new(Experiment::Published, &printed.id, comparison.scheme(), printed.step_s.unwrap_or(0.0), &none);
            let tolerance = 1.000_001 * comparison.tolerance();
            row.measured(&printed.quantity, "1", Some(comparison.ours)).against(printed.value, tolerance)
        })
        .collect()
}
