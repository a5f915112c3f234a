//! What there is: scenes with their parameters, methods, precisions.

use integrator::methods::{MethodId, RigidStep};
use reports::Table;

use measure::error::Error;
use scenes::any::AnyScene;
use scenes::run::Precision;

/// Everything with one line each; or, of the scenes named, what a user may set.
///
/// # Errors
/// An unknown scene.
pub(super) fn of(names: &[String]) -> Result<String, Error> {
    if names.is_empty() {
        return Ok([scenes(), methods(), rigid_steps(), precisions()].join("\n"));
    }
    let chosen = names.iter().map(|name| scenes::by_id(name)).collect::<Result<Vec<_>, _>>()?;
    Ok(chosen.iter().map(|scene| one(scene.as_ref())).collect::<Vec<_>>().join("\n"))
}

fn scenes() -> String {
    let mut table = Table::new(&["scene (--scene)", "what moves; its parameters (--set): list SCENE"], &[]);
    for scene in scenes::all() {
        table.push([scene.id(), scenes::about(scene.as_ref())]);
    }
    table.to_text()
}

fn one(scene: &dyn AnyScene) -> String {
    let (id, info) = (scene.id(), scene.scene().info());
    let mut table = Table::new(&["parameter", "value", "unit", "allowed", "what it is"], &["value"]);
    for p in scene.scene().parameters() {
        table.push([p.name, &p.value, p.unit, &p.range.to_string(), p.about]);
    }
    for s in scene.scene().substitutes() {
        let about = format!("in the place of {}: {}", s.of, s.about);
        table.push([s.name, "", s.unit, "", &about]);
    }
    let period = scene.scene().period_s();
    let period = period.map_or("no period".to_owned(), |s| format!("period (--for 10rev) {s:.4} s"));
    let times = format!("runs to {} s; natural time scale {:.4} s; {period}", info.horizon_s, info.time_scale_s);
    let about = scenes::about(scene);
    format!("{id}: {about}\n  exact motion: {}\n  {times}\n\n{}", info.source, table.to_text())
}

fn methods() -> String {
    let mut table = Table::new(&["method (--method)", "name", "order", "solves equations"], &["order"]);
    for method in MethodId::ALL {
        let implicit = if method.is_implicit() { "yes" } else { "no" };
        table.push([method.id(), method.title(), &method.order().to_string(), implicit]);
    }
    table.to_text()
}

fn rigid_steps() -> String {
    let mut table = Table::new(&["step for rigid bodies only", "name", "order", "formula"], &["order"]);
    for step in RigidStep::ALL {
        table.push([step.id(), step.title(), &step.order().to_string(), step.formula()]);
    }
    table.to_text()
}

fn precisions() -> String {
    let mut table = Table::new(&["precision (--precision)", "from 1 to the next number"], &[]);
    for precision in Precision::ALL {
        table.push([precision.id().to_owned(), format!("{:.1e}", precision.epsilon())]);
    }
    table.to_text()
}
