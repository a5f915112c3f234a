//! Methods and scenes as the report explains them: formula, source, parameters, and what theory says beforehand.

use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::Formulation;
use reports::{Block, Section, Table};

use measure::names::{anchor, scene_title};
use measure::study::short;
use scenes::any::AnyScene;
use scenes::run::Precision;
use scenes::theory::{ExpectedOrder, StabilityLimit};

/// The section on how each method steps, what a rigid body stores and what each scene is.
pub(crate) fn methods_and_scenes(chosen: &[Box<dyn AnyScene>], studies: &[Section]) -> Section {
    let mut blocks = vec![Block::Text(
        "A step goes from the time t₀ to t₁ = t₀ + h; a is the rate of the velocity v. On a rotation 'q + h v' is q turned \
         by the constant angular velocity v for the time h, and [u, w] = u × w; on a flat space the brackets vanish."
            .to_owned(),
    )];
    blocks.extend(MethodId::ALL.iter().map(|&method| method_group(method)));
    blocks.extend(RigidStep::ALL.iter().map(|&step| step_group(step)));
    blocks.extend(std::iter::once(stored()));
    blocks.extend(chosen.iter().map(|scene| scene_group(scene.as_ref(), studies)));
    Section {
        id: "reference".to_owned(),
        title: "Methods and scenes".to_owned(),
        intro: "Every step and every scene with its formula, its source, its parameters and what theory says of it beforehand."
            .to_owned(),
        blocks,
    }
}

fn formulas(latex: &[&str]) -> impl Iterator<Item = Block> {
    latex.iter().map(|&line| Block::Formula(line.to_owned()))
}

fn facts(facts: &[(&str, String)]) -> Block {
    Block::Facts(facts.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect())
}

fn method_group(method: MethodId) -> Block {
    let implicit = if method.is_implicit() { ", implicit: Newton's iteration" } else { "" };
    let mut blocks: Vec<Block> = formulas(method.facts().latex).collect();
    blocks.push(facts(&[("source", method.facts().source.to_owned()), ("name", method.id().to_owned())]));
    let note = format!("order {}{implicit}", method.order());
    Block::Group { id: anchor("method", method.id()), title: method.title().to_owned(), note, blocks }
}

fn step_group(step: RigidStep) -> Block {
    let mut blocks: Vec<Block> = formulas(step.facts().latex).collect();
    blocks.push(facts(&[("source", step.source().to_owned()), ("name", step.id().to_owned())]));
    let note = format!("order {}, rigid bodies only", step.order());
    Block::Group { id: anchor("method", step.id()), title: step.title().to_owned(), note, blocks }
}

fn stored() -> Block {
    let one = |storage: Formulation| {
        [
            Block::Text(format!("{}:", scene_title(storage.id()).replace("omega", "ω"))),
            Block::Formula(equation(storage).to_owned()),
        ]
    };
    Block::Group {
        id: "method-storage".to_owned(),
        title: "What a rigid body stores".to_owned(),
        note: "four models of the same motion, one of them wrong".to_owned(),
        blocks: Formulation::ALL.into_iter().flat_map(one).collect(),
    }
}

/// The equation of motion that a model of a rigid body integrates.
fn equation(storage: Formulation) -> &'static str {
    match storage {
        Formulation::WorldOmega => {
            r"I_w\,\dot\omega = \tau - \omega\times I_w\omega,\quad I_w = R\,I R^{T},\quad \dot q = \tfrac12\,\omega\,q"
        }
        Formulation::BodyOmega => r"I\,\dot\omega = \tau + I\omega\times\omega,\quad \dot q = \tfrac12\,q\,\omega",
        Formulation::WorldMomentum => {
            r"\dot L = \tau,\quad \omega = R\,I^{-1} R^{T} L,\quad \dot q = \tfrac12\,\omega\,q"
        }
        Formulation::WithoutGyroscopicTerm => {
            r"I_w\,\dot\omega = \tau,\quad I_w = R\,I R^{T},\quad \dot q = \tfrac12\,\omega\,q"
        }
    }
}

fn scene_group(any: &dyn AnyScene, studies: &[Section]) -> Block {
    let (scene, id) = (any.scene(), any.id());
    let info = scene.info();
    let mut parameters = Table::new(&["parameter", "value", "unit", "what it is", "allowed"], &["value"]);
    for p in scene.parameters() {
        parameters.push([p.name.to_owned(), p.value, p.unit.to_owned(), p.about.to_owned(), p.range.to_string()]);
    }
    let table = |caption: &str, table: Table| Block::Table { caption: caption.to_owned(), table, csv: None };
    let mut blocks = vec![
        Block::Formula(info.equation.to_owned()),
        facts(&[
            ("exact motion", info.source.to_owned()),
            ("horizon", format!("{} s", info.horizon_s)),
            ("time scale", format!("{} s", short(Some(info.time_scale_s)))),
            ("name", id.to_owned()),
        ]),
        table("Parameters", parameters),
        table("Error at the horizon beforehand: error = constant × h^order, to leading order", theory(any)),
    ];
    let limits = limits(any);
    if !limits.rows.is_empty() {
        blocks.push(table("Largest stable step, by theory", limits));
    }
    let groups = studies.iter().flat_map(|section| section.blocks.iter().map(move |block| (section, block)));
    let seen = groups.filter_map(|(section, block)| match block {
        Block::Group { id: group, .. } if *group == anchor(&section.id, id) => {
            Some((section.title.clone(), format!("#{group}")))
        }
        _ => None,
    });
    let files: Vec<_> = seen.collect();
    if !files.is_empty() {
        blocks.push(Block::Links { caption: "In the studies".to_owned(), files });
    }
    Block::Group { id: anchor("scene", id), title: scene_title(id), note: scenes::about(any).to_owned(), blocks }
}

fn theory(any: &dyn AnyScene) -> Table {
    let mut table = Table::new(&["method", "quantity", "order", "constant", "why"], &["order", "constant"]);
    let start = any.exact_in(Precision::F64, 0.0);
    for &method in MethodId::ALL {
        for (quantity, _) in start.distances(&start) {
            let theory = any.scene().expected_error(method, quantity, any.scene().info().horizon_s);
            let order = match theory.order {
                ExpectedOrder::Exact => "exact".to_owned(),
                ExpectedOrder::Of(order) => order.to_string(),
                ExpectedOrder::Envelope(order) => format!("at least {order}"),
            };
            let constant = theory.constant.map_or_else(String::new, |constant| short(Some(constant)));
            table.push([method.title(), quantity.id(), &order, &constant, theory.reason]);
        }
    }
    table
}

fn limits(any: &dyn AnyScene) -> Table {
    let mut table = Table::new(&["method", "largest step (s)", "why"], &["largest step (s)"]);
    for &method in MethodId::ALL {
        if let Some((limit, reason)) = any.scene().expected_limit(method) {
            let step = match limit {
                StabilityLimit::NoStep => "none is stable".to_owned(),
                StabilityLimit::Below(h_s) => short(Some(h_s)),
                StabilityLimit::Unlimited => "unlimited".to_owned(),
            };
            table.push([method.title(), &step, reason]);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_formula_can_be_typeset() {
        let methods = MethodId::ALL.iter().flat_map(|&m| m.facts().latex).copied();
        let steps = RigidStep::ALL.iter().flat_map(|&s| s.facts().latex).copied();
        let stored = Formulation::ALL.into_iter().map(equation);
        let motions: Vec<_> = scenes::all().iter().map(|scene| scene.scene().info().equation).collect();
        for latex in methods.chain(steps).chain(stored).chain(motions) {
            let mathml = reports::mathml(latex).unwrap_or_else(|error| panic!("{error}"));
            assert!(mathml.contains("<mi>") && mathml.contains("</math>"), "{latex}: {mathml}");
        }
    }
}
