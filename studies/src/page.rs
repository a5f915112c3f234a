//! The report's page: what each study found, put together by scene; the findings; methods and scenes with their formulas.
//!
//! It follows from the products of the studies and from the scenes' own statements. Nothing is run here.

use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::Storage;
use reports::{Block, Claim, Page, Section, Table};

use crate::error::Error;
use crate::findings::findings;
use crate::formulas;
use crate::scene::{AnyScene, ExpectedOrder, StabilityLimit};
use crate::scenes;
use crate::study::{Study, short};
use crate::teach;

/// The name of a scene or preset in a sentence: `forced-oscillator/resonance` is 'Forced oscillator, resonance'.
pub fn scene_title(id: &str) -> String {
    let words = id.replace('/', ", ").replace('-', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The whole page: the studies, what matters most in them, methods and scenes, and where the numbers come from.
///
/// # Errors
/// A page that contradicts itself, or a formula that cannot be typeset.
pub fn html(
    mut sections: Vec<Section>,
    scenes: &[Box<dyn AnyScene>],
    footer: Vec<(String, String)>,
) -> Result<String, Error> {
    let findings = findings(&sections);
    sections.push(methods_and_scenes(scenes, &sections));
    let links = vec![("Drag the step and watch".to_owned(), teach::FILE.to_owned())];
    let page = Page {
        title: "How accurate is a fixed step?".to_owned(),
        lead: "Explicit and semi-implicit Euler, with four yardsticks, on scenes whose exact motion is known: how wrong is \
               it, what does it cost, and where does it break?"
            .to_owned(),
        links,
        findings,
        sections,
        footer,
    };
    Ok(page.html()?)
}

/// The section of a study: what belongs to one scene together, and the CSV of its rows and verdicts.
pub(crate) fn section<S: Study>(mut blocks: Vec<Block>) -> Section {
    let files = ["", "-claims"].map(|kind| format!("{}{kind}.csv", S::ID)).map(|name| (name.clone(), name)).to_vec();
    blocks.insert(0, Block::Links { caption: "All rows and all claims".to_owned(), files });
    let blocks = by_scene(S::ID, blocks);
    Section { id: S::ID.to_owned(), title: S::TITLE.to_owned(), intro: S::INTRO.to_owned(), blocks }
}

/// The scene or preset that a part of a claim's or figure's name stands for: `kepler/circular`, `kepler-circular`,
/// `box-tumbling-position` (the scene with a quantity) or `symmetric-top` (all presets together).
fn scene_named(name: &str) -> Option<&'static str> {
    let dashed = name.replace('/', "-");
    let base = |id: &'static str| id.split('/').next().unwrap_or(id);
    let fits = |id: &str| {
        dashed.strip_prefix(&id.replace('/', "-")).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
    };
    let known = scenes::IDS.iter().copied().chain(scenes::IDS.iter().copied().map(base));
    known.filter(|id| fits(id)).max_by_key(|id| id.len())
}

/// The scene that a claim is about: named by the second or third part of its id.
fn scene_of_claim(claim: &Claim) -> Option<&'static str> {
    claim.id.split('.').skip(1).take(2).find_map(scene_named)
}

/// The scene that a figure is about: its id is `study-scene-quantity`, or `study-kind-scene`.
fn scene_of_figure(id: &str) -> Option<&'static str> {
    let starts = id.match_indices('-').map(|(at, _)| &id[at + 1..]);
    starts.filter_map(scene_named).max_by_key(|scene| scene.len())
}

/// Puts together what belongs to one scene, each in a group of its own, after what belongs to none.
pub(crate) fn by_scene(study: &str, blocks: Vec<Block>) -> Vec<Block> {
    let mut common = Vec::new();
    let mut of_scenes: Vec<(&'static str, Vec<Block>)> = Vec::new();
    let mut give = |scene: &'static str, block: Block| match of_scenes.iter_mut().find(|(known, _)| *known == scene) {
        Some((_, blocks)) => blocks.push(block),
        None => of_scenes.push((scene, vec![block])),
    };
    for block in blocks {
        match block {
            Block::Claims(claims) => {
                let rest = split(claims, scene_of_claim, |scene, part| give(scene, Block::Claims(part)));
                common.extend((!rest.is_empty()).then_some(Block::Claims(rest)));
            }
            Block::Table { caption, table, csv } if table.headers.first().is_some_and(|head| head == "scene") => {
                let Table { headers, align, rows } = table;
                let rest = split(
                    rows,
                    |row| row.first().and_then(|cell| scene_named(cell)),
                    |scene, rows| {
                        let table =
                            without_scene(Table { headers: headers.clone(), align: align.clone(), rows }, scene);
                        give(scene, Block::Table { caption: caption.clone(), table, csv: csv.clone() });
                    },
                );
                let table = Table { headers: headers.clone(), align: align.clone(), rows: rest };
                common.extend((!table.rows.is_empty()).then_some(Block::Table { caption, table, csv }));
            }
            Block::Figure { figure, svg } => match scene_of_figure(&figure.id) {
                Some(scene) => give(scene, Block::Figure { figure, svg }),
                None => common.push(Block::Figure { figure, svg }),
            },
            Block::Links { caption, files } => {
                let scene = |(_, file): &(String, String)| {
                    scene_of_figure(file.trim_end_matches(".svg").trim_end_matches(".png"))
                };
                let rest =
                    split(files, scene, |scene, files| give(scene, Block::Links { caption: caption.clone(), files }));
                common.extend((!rest.is_empty()).then_some(Block::Links { caption, files: rest }));
            }
            other => common.push(other),
        }
    }
    let place = |id: &str| scenes::IDS.iter().position(|known| *known == id || known.split('/').next() == Some(id));
    of_scenes.sort_by_key(|(scene, _)| place(scene));
    common.extend(of_scenes.into_iter().map(|(scene, blocks)| group(study, scene, blocks)));
    common
}

/// The table without its first column where that says nothing but the scene.
fn without_scene(mut table: Table, scene: &str) -> Table {
    if table.rows.iter().all(|row| row.first().is_some_and(|cell| cell == scene)) {
        table.headers.remove(0);
        table.align.remove(0);
        table.rows.iter_mut().for_each(|row| drop(row.remove(0)));
    }
    table
}

/// Hands the parts that belong to a scene to `give`, together for each scene, and gives back the others.
fn split<T>(
    all: Vec<T>,
    scene: impl Fn(&T) -> Option<&'static str>,
    mut give: impl FnMut(&'static str, Vec<T>),
) -> Vec<T> {
    let mut rest = Vec::new();
    let mut parts: Vec<(&'static str, Vec<T>)> = Vec::new();
    for one in all {
        match scene(&one) {
            None => rest.push(one),
            Some(scene) => match parts.iter_mut().find(|(known, _)| *known == scene) {
                Some((_, part)) => part.push(one),
                None => parts.push((scene, vec![one])),
            },
        }
    }
    parts.into_iter().for_each(|(scene, part)| give(scene, part));
    rest
}

fn group(study: &str, scene: &str, blocks: Vec<Block>) -> Block {
    let claims: Vec<&Claim> =
        blocks.iter().flat_map(|b| if let Block::Claims(claims) = b { &claims[..] } else { &[] }).collect();
    let charts = blocks.iter().filter(|block| matches!(block, Block::Figure { .. })).count();
    let counts = reports::claim::counts(claims);
    let parts = [(counts.broken, "broken"), (counts.holds, "hold"), (counts.not_tested, "not tested")];
    let mut words: Vec<String> = parts.iter().filter(|(n, _)| *n > 0).map(|(n, word)| format!("{n} {word}")).collect();
    if charts > 0 {
        words.push(format!("{charts} chart{}", if charts == 1 { "" } else { "s" }));
    }
    Block::Group { id: anchor(study, scene), title: scene_title(scene), note: words.join(", "), blocks }
}

fn anchor(section: &str, name: &str) -> String {
    format!("{section}-{}", name.replace('/', "-"))
}

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
    let mut blocks: Vec<Block> = formulas(formulas::of_method(method)).collect();
    blocks.push(facts(&[("source", formulas::source_of_method(method).to_owned()), ("name", method.id().to_owned())]));
    let note = format!("order {}{implicit}", method.order());
    Block::Group { id: anchor("method", method.id()), title: method.title().to_owned(), note, blocks }
}

fn step_group(step: RigidStep) -> Block {
    let mut blocks: Vec<Block> = formulas(formulas::of_rigid_step(step)).collect();
    blocks.push(facts(&[("source", step.source().to_owned()), ("name", step.id().to_owned())]));
    let note = format!("order {}, rigid bodies only", step.order());
    Block::Group { id: anchor("method", step.id()), title: step.title().to_owned(), note, blocks }
}

fn stored() -> Block {
    let one = |storage: Storage| {
        [
            Block::Text(format!("{}:", scene_title(storage.id()).replace("omega", "ω"))),
            Block::Formula(formulas::of_storage(storage).to_owned()),
        ]
    };
    Block::Group {
        id: "method-storage".to_owned(),
        title: "What a rigid body stores".to_owned(),
        note: "four models of the same motion, one of them wrong".to_owned(),
        blocks: Storage::ALL.into_iter().flat_map(one).collect(),
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
    Block::Group { id: anchor("scene", id), title: scene_title(id), note: info.about.to_owned(), blocks }
}

fn theory(any: &dyn AnyScene) -> Table {
    let mut table = Table::new(&["method", "quantity", "order", "constant", "why"], &["order", "constant"]);
    let start = any.exact(faer::fx128::ZERO);
    for &method in MethodId::ALL {
        for (quantity, _) in start.distances(&start) {
            let theory = any.scene().theory(method, quantity);
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
        if let Some((limit, reason)) = any.scene().stability_limit(method) {
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
