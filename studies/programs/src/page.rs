//! The report's page: what each study found, put together by scene, with what matters first.
//!
//! It follows from the products of the studies and from the scenes' own statements. Nothing is run here.

use reports::{Block, Claim, Page, Section, Table};

use crate::findings::findings;
use crate::reference::methods_and_scenes;
use measure::error::Error;
use measure::names::{anchor, scene_title};
use scenes::any::AnyScene;

use crate::teach;
use measure::study::Study;

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

#[cfg(test)]
mod tests {
    use super::*;
    use reports::Verdict;

    #[test]
    fn a_figure_or_a_claim_is_put_with_the_scene_that_its_name_holds() {
        for (id, scene) in [
            ("convergence-forced-oscillator-near-resonance-position", Some("forced-oscillator/near-resonance")),
            ("precision-kepler-position", Some("kepler")),
            ("adequacy-pendulum-1-mrad", Some("pendulum")),
            ("stability-map-kepler-rk4", Some("kepler")),
            ("rotation-error-torque-free-spin", Some("torque-free-spin")),
            ("stability-map-damped-rk4", None),
            ("rotation-axis-start-far-from-all-axes", None),
        ] {
            assert_eq!(scene_of_figure(id), scene, "{id}");
        }
        for (id, scene) in [
            ("drift.charged-particle/magnetic.rk4.energy", Some("charged-particle/magnetic")),
            ("stability.limit.oscillator.rk4.f64", Some("oscillator")),
            ("adequacy.box-tumbling-position.rk4", Some("box-tumbling")),
            ("adequacy.quadratic-drag.sphere", Some("quadratic-drag")),
            ("rotation.step-law.energy.asymmetric-body.rk4", None),
        ] {
            assert_eq!(scene_of_claim(&claim(id)), scene, "{id}");
        }
    }

    fn claim(id: &str) -> Claim {
        let text = String::new;
        Claim {
            id: id.to_owned(),
            study: text(),
            statement: text(),
            theory: text(),
            measured: text(),
            bound: text(),
            verdict: Verdict::Holds,
        }
    }

    #[test]
    fn what_belongs_to_one_scene_comes_together_and_nothing_is_lost() {
        let mut table = Table::new(&["scene", "order"], &["order"]);
        for row in [["kepler", "1"], ["oscillator", "2"], ["kepler", "4"]] {
            table.push(row);
        }
        let claims = vec![
            claim("drift.kepler.a"),
            claim("drift.step-law.b"),
            claim("drift.oscillator.c"),
            claim("drift.kepler.d"),
        ];
        let blocks = vec![Block::Claims(claims), Block::Table { caption: String::new(), table, csv: None }];
        let sorted = by_scene("drift", blocks);
        let [Block::Claims(common), Block::Group { id: first, .. }, Block::Group { id: second, note, blocks, .. }] =
            &sorted[..]
        else {
            panic!("{sorted:?}");
        };
        assert_eq!(
            (common.len(), first.as_str(), second.as_str(), note.as_str()),
            (1, "drift-oscillator", "drift-kepler", "2 hold")
        );
        let [Block::Claims(claims), Block::Table { table, .. }] = &blocks[..] else { panic!("{blocks:?}") };
        assert_eq!(
            (claims.len(), &table.headers[..], &table.rows[..]),
            (2, &["order".to_owned()][..], &[vec!["1".to_owned()], vec!["4".to_owned()]][..])
        );
    }
}
