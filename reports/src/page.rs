//! One self-contained page: verdicts, findings, tables, claims, figures, formulas. Nothing comes from elsewhere.

mod block;
mod opening;
mod table;

pub use block::Block;

use crate::{Claim, Error, Figure, Verdict, plot};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::collections::HashSet;

const STYLE: &str = include_str!("page/style.css");
const SCRIPT: &str = concat!(include_str!("page/sort.js"), include_str!("page/find.js"), include_str!("page/open.js"));

/// A report as one page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Title of the page.
    pub title: String,
    /// Opening paragraph.
    pub lead: String,
    /// Pages beside this one that a reader should know of at once: what each is, and its name.
    pub links: Vec<(String, String)>,
    /// What answers the reader's question before anything else; its ids are as unique as those of the sections.
    pub answer: Vec<Block>,
    /// What was found, most important first.
    pub findings: Vec<Finding>,
    /// The studies.
    pub sections: Vec<Section>,
    /// Provenance: name and value (version, toolchain, plan), in this order.
    pub footer: Vec<(String, String)>,
}

/// One finding of the summary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finding {
    /// The finding in a few words.
    pub title: String,
    /// The number that carries it, with its unit; set large.
    pub number: String,
    /// What was measured, in one or two sentences.
    pub text: String,
    /// Id of the figure that shows it.
    pub figure: Option<String>,
    /// Id of the claim that it rests on.
    pub claim: Option<String>,
}

/// One study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Anchor, unique within the page.
    pub id: String,
    /// Heading.
    pub title: String,
    /// Opening paragraph: the question and how it is answered.
    pub intro: String,
    /// What follows, in order.
    pub blocks: Vec<Block>,
}

impl Page {
    /// The page as one HTML document. It loads nothing: style, script and drawings are inside.
    ///
    /// # Errors
    /// [`Error::Page`] when two sections, figures, groups or claims share an id, or a finding names a figure or a claim that
    /// the page lacks; [`Error::Formula`] for a formula that cannot be typeset, [`Error::Figure`] for
    /// a figure that cannot be drawn.
    pub fn html(&self) -> Result<String, Error> {
        self.check()?;
        let sections = self.sections.iter().map(Section::markup).collect::<Result<Vec<_>, _>>()?;
        let document = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(plot::of_page())) (PreEscaped(STYLE)) }
                }
                body {
                    a.skip href="#main" { "Skip to the content" }
                    (self.navigation())
                    div.column {
                        main #main { (self.opening()?) @for section in &sections { (section) } }
                        footer {
                            h2 { "Where these numbers come from" }
                            dl { @for (name, value) in &self.footer { dt { (name) } dd { (value) } } }
                        }
                    }
                    script { (PreEscaped(SCRIPT)) }
                }
            }
        };
        // HTML lets a cell and a row end where the next begins, and there are tens of thousands. Words are escaped, and so
        // are never taken for a tag.
        Ok(document.into_string().replace("</td>", "").replace("</tr>", ""))
    }

    fn navigation(&self) -> Markup {
        html! {
            nav aria-label="Sections" {
                a.home href="#main" { (self.title) }
                ul {
                    @for (text, file) in &self.links { li.strong { a href=(file) { (text) } } }
                    @for section in &self.sections { li { a href={ "#" (section.id) } { (section.title) } } }
                }
                form #find hidden role="search" {
                    label for="find-text" { "Find claims" }
                    input #find-text type="search" placeholder="rk4 kepler energy" autocomplete="off";
                    label for="find-verdict" { "Verdict" }
                    select #find-verdict {
                        option value="" { "any" }
                        @for verdict in Verdict::ALL { option value=(verdict) { (verdict) } }
                    }
                    output #find-count aria-live="polite" {}
                }
                button #theme type="button" hidden { "Light or dark" }
            }
        }
    }

    fn blocks(&self) -> Vec<&Block> {
        self.answer
            .iter()
            .flat_map(Block::and_inner)
            .chain(self.sections.iter().flat_map(Section::all_blocks))
            .collect()
    }

    fn claims(&self) -> Vec<&Claim> {
        self.sections.iter().flat_map(Section::claims).collect()
    }

    fn figure(&self, id: &str) -> Option<&Figure> {
        self.figures().find(|figure| figure.id == id)
    }

    fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.blocks()
            .into_iter()
            .filter_map(|block| if let Block::Figure(figure) = block { Some(figure) } else { None })
    }

    fn check(&self) -> Result<(), Error> {
        let blocks = self.blocks();
        let figures = unique("figure", self.figures().map(|figure| &figure.id))?;
        let groups = blocks.iter().filter_map(|b| if let Block::Group { id, .. } = b { Some(id) } else { None });
        unique("section", self.sections.iter().map(|section| &section.id).chain(groups))?;
        let claims = unique("claim", self.claims().into_iter().map(|claim| &claim.id))?;
        for finding in &self.findings {
            for (kind, id, known) in [("figure", &finding.figure, &figures), ("claim", &finding.claim, &claims)] {
                if let Some(id) = id.as_ref().filter(|id| !known.contains(id)) {
                    let place = format!("finding '{}'", finding.title);
                    return Err(Error::Page { place, message: format!("{kind} '{id}' is not on the page") });
                }
            }
        }
        Ok(())
    }
}

/// The ids as a set, or an error for the first that comes twice.
fn unique<'a>(kind: &str, ids: impl Iterator<Item = &'a String>) -> Result<HashSet<&'a String>, Error> {
    let mut seen = HashSet::new();
    for id in ids {
        if !seen.insert(id) {
            return Err(Error::Page {
                place: format!("{kind} '{id}'"),
                message: "comes twice: ids must differ".to_owned(),
            });
        }
    }
    Ok(seen)
}

/// A verdict as sign, word and colour.
fn mark(verdict: Verdict) -> Markup {
    let class = match verdict {
        Verdict::Holds => "holds",
        Verdict::Broken => "broken",
        Verdict::NotTested => "not-tested",
    };
    html! { span class={ "verdict " (class) } { span aria-hidden="true" { (verdict.sign()) " " } (verdict) } }
}

impl Section {
    /// Its blocks and those of its groups.
    fn all_blocks(&self) -> Vec<&Block> {
        self.blocks.iter().flat_map(Block::and_inner).collect()
    }

    fn claims(&self) -> Vec<&Claim> {
        let claims = self
            .all_blocks()
            .into_iter()
            .filter_map(|b| if let Block::Claims(claims) = b { Some(claims) } else { None });
        claims.flatten().collect()
    }

    fn markup(&self) -> Result<Markup, Error> {
        let blocks = self.blocks.iter().map(Block::markup).collect::<Result<Vec<_>, _>>()?;
        Ok(html! {
            section #(self.id) aria-labelledby={ (self.id) "-title" } {
                h2 id={ (self.id) "-title" } { (self.title) }
                p { (self.intro) }
                @for block in &blocks { (block) }
            }
        })
    }
}
