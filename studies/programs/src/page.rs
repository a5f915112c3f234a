//! The report's page: what each study found, put together by scene, with what matters first.
//!
//! It follows from the products of the studies and from the scenes' own statements. Nothing is run here.

use reports::{Block, Claim, Page, Section, Table, Verdict};

use crate::findings::findings;
use crate::reference::methods_and_scenes;
use measure::error::Error;
use measure::names::{anchor, scene_title};
use scenes::any::AnyScene;

use crate::{engines, teach};
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
    let answer = answer(&mut sections);
    sections.push(engines::section()?);
    sections.push(methods_and_scenes(scenes, &sections));
    let links = vec![("Drag the step and watch".to_owned(), teach::FILE.to_owned())];
    let page = Page {
        title: "How accurate is a fixed step?".to_owned(),
        lead: "Explicit and semi-implicit Euler, with four yardsticks, on scenes whose exact motion is known: how wrong is \
               it, what does it cost, and where does it break?"
            .to_owned(),
        links,
        answer,
        findings,
        sections,
        footer,
    };
    Ok(page.html()?)
}

/// What tells which method to take, out of the section of its study, in the order of [`ANSWERS`].
fn answer(sections: &mut [Section]) -> Vec<Block> {
    let place = |block: &Block| {
        let name = match block {
            Block::Table { csv: Some(csv), .. } => csv.trim_end_matches(".csv"),
            Block::Figure(figure) => figure.id.as_str(),
            _ => return None,
        };
        ANSWERS.iter().position(|answer| *answer == name)
    };
    let all = sections.iter_mut().flat_map(|section| section.blocks.extract_if(.., |block| place(block).is_some()));
    let mut answers: Vec<Block> = all.collect();
    answers.sort_by_key(place);
    answers
}

/// The tables, by the name of their CSV, and the chart that answer 'which method when'.
const ANSWERS: [&str; 3] = ["tradeoff-which-method", "tradeoff-60-hz", "work-all-scenes"];

/// More claims than this that all hold are folded.
const UNFOLDED: usize = 12;

/// A long list of claims about no one scene, under a heading that counts them where all hold; where one does not it stays open.
fn folded(study: &str, block: Block) -> Block {
    match block {
        Block::Claims(claims) if claims.len() > UNFOLDED && claims.iter().all(|c| c.verdict == Verdict::Holds) => {
            let note = format!("{} hold", claims.len());
            let title = "Claims about several scenes".to_owned();
            Block::Group { id: anchor(study, "claims"), title, note, blocks: vec![Block::Claims(claims)] }
        }
        other => other,
    }
}

/// A file that the page links to, with the scene it is about: title and name.
pub(crate) type Linked = (Option<String>, (String, String));

/// The section of a study: what belongs to one scene together, and the CSV of its rows and verdicts.
pub(crate) fn section<S: Study>(mut rows: Vec<String>, blocks: Vec<Block>, linked: Vec<Linked>) -> Section {
    rows.push(format!("{}-claims.csv", S::ID));
    let files = rows.into_iter().map(|name| (name.clone(), name)).collect();
    let rows = Block::Links { caption: "All rows and all claims".to_owned(), files };
    let blocks =
        std::iter::once(rows).chain(by_scene(S::ID, blocks, linked)).map(|block| folded(S::ID, block)).collect();
    Section { id: S::ID.to_owned(), title: S::TITLE.to_owned(), intro: S::INTRO.to_owned(), blocks }
}

/// The scene or preset of that name, or the base name of a scene with presets.
fn known(name: &str) -> Option<&'static str> {
    let base = |id: &'static str| id.split('/').next().unwrap_or(id);
    scenes::IDS.iter().copied().chain(scenes::IDS.iter().copied().map(base)).find(|id| *id == name)
}

/// Puts together what is about one scene, each in a group of its own, after what is about none.
pub(crate) fn by_scene(study: &str, blocks: Vec<Block>, linked: Vec<Linked>) -> Vec<Block> {
    let mut common = Vec::new();
    let mut of_scenes: Vec<(&'static str, Vec<Block>)> = Vec::new();
    let mut give = |scene: &'static str, block: Block| match of_scenes.iter_mut().find(|(known, _)| *known == scene) {
        Some((_, blocks)) => blocks.push(block),
        None => of_scenes.push((scene, vec![block])),
    };
    for block in blocks {
        match block {
            Block::Claims(claims) => {
                let scene = |claim: &Claim| claim.scene.as_deref().and_then(known);
                let rest = split(claims, scene, |scene, part| give(scene, Block::Claims(part)));
                common.extend((!rest.is_empty()).then_some(Block::Claims(rest)));
            }
            Block::Table { caption, table, csv } if table.headers.first().is_some_and(|head| head == "scene") => {
                let Table { headers, align, rows } = table;
                let rest = split(
                    rows,
                    |row| row.first().and_then(|cell| known(cell)),
                    |scene, rows| {
                        let table =
                            without_scene(Table { headers: headers.clone(), align: align.clone(), rows }, scene);
                        give(scene, Block::Table { caption: caption.clone(), table, csv: csv.clone() });
                    },
                );
                let table = Table { headers: headers.clone(), align: align.clone(), rows: rest };
                common.extend((!table.rows.is_empty()).then_some(Block::Table { caption, table, csv }));
            }
            Block::Figure(figure) => match figure.scene.as_deref().and_then(known) {
                Some(scene) => give(scene, Block::Figure(figure)),
                None => common.push(Block::Figure(figure)),
            },
            other => common.push(other),
        }
    }
    let links = |files: Vec<Linked>| Block::Links {
        caption: "More charts".to_owned(),
        files: files.into_iter().map(|(_, file)| file).collect(),
    };
    let scene = |(scene, _): &Linked| scene.as_deref().and_then(known);
    let rest = split(linked, scene, |scene, part| give(scene, links(part)));
    common.extend((!rest.is_empty()).then(|| links(rest)));
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

    // Fails if: a name is looked for inside another.
    #[test]
    fn a_scene_is_known_by_its_whole_name_or_its_base_name() {
        assert_eq!(known("forced-oscillator/near-resonance"), Some("forced-oscillator/near-resonance"));
        assert_eq!(known("symmetric-top"), Some("symmetric-top"));
        assert_eq!(known("box-tumbling-position"), None);
        assert_eq!(known("top"), None);
    }

    fn claim(scene: Option<&str>) -> Claim {
        let claim = Claim::new("drift", String::new(), Default::default(), Verdict::Holds);
        Claim { scene: scene.map(str::to_owned), ..claim }
    }

    // Fails if: an answer stays in its section or comes twice, their order changes, or a list with a broken claim is folded.
    #[test]
    fn the_answer_leaves_its_section_and_only_what_holds_is_folded() {
        let table = |name: &str| Block::Table {
            caption: String::new(),
            table: Table::new(&["kind"], &[]),
            csv: Some(format!("{name}.csv")),
        };
        let blocks = vec![table("tradeoff-60-hz"), table("tradeoff-costs"), table("tradeoff-which-method")];
        let mut sections = [Section { blocks, ..Section::default() }];
        let found = answer(&mut sections);
        assert_eq!(found, [table("tradeoff-which-method"), table("tradeoff-60-hz")]);
        assert_eq!(sections[0].blocks, [table("tradeoff-costs")]);

        let many = |broken: usize| {
            let mut claims = vec![claim(None); UNFOLDED + 1];
            claims.iter_mut().take(broken).for_each(|claim| claim.verdict = Verdict::Broken);
            folded("drift", Block::Claims(claims))
        };
        assert!(matches!(many(0), Block::Group { note, .. } if note == "13 hold"));
        assert!(matches!(many(1), Block::Claims(claims) if claims.len() == 13));
        assert!(matches!(folded("drift", Block::Claims(vec![claim(None); UNFOLDED])), Block::Claims(_)));
    }

    #[test]
    fn what_belongs_to_one_scene_comes_together_and_nothing_is_lost() {
        let mut table = Table::new(&["scene", "order"], &["order"]);
        for row in [["kepler", "1"], ["oscillator", "2"], ["kepler", "4"]] {
            table.push(row);
        }
        let claims = vec![claim(Some("kepler")), claim(None), claim(Some("oscillator")), claim(Some("kepler"))];
        let blocks = vec![Block::Claims(claims), Block::Table { caption: String::new(), table, csv: None }];
        let sorted = by_scene("drift", blocks, Vec::new());
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
