//! One self-contained page: verdicts, findings, tables, claims, figures. No script or style comes from elsewhere.

use crate::{Claim, Error, Figure, Table, Verdict, claim};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::collections::HashSet;

const STYLE: &str = include_str!("page/style.css");
const SORT: &str = include_str!("page/sort.js");

/// A report as one page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Title of the page.
    pub title: String,
    /// Opening paragraph.
    pub lead: String,
    /// What was found, most important first.
    pub findings: Vec<Finding>,
    /// The studies.
    pub sections: Vec<Section>,
    /// Provenance: name and value (version, toolchain, plan), in this order.
    pub footer: Vec<(String, String)>,
}

impl Page {
    /// The page as one HTML document. It loads nothing: style, script and drawings are inside.
    ///
    /// # Errors
    /// [`Error::Page`] when two sections, figures or claims share an id, or a finding names a figure the page lacks.
    pub fn html(&self) -> Result<String, Error> {
        self.check()?;
        let document = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    a.skip href="#main" { "Skip to the content" }
                    header { h1 { (self.title) } p { (self.lead) } (self.verdicts()) }
                    nav aria-label="Sections" { ul { @for s in &self.sections { li { a href={ "#" (s.id) } { (s.title) } } } } }
                    main #main { (self.summary()) @for section in &self.sections { (section.markup()) } }
                    footer { dl { @for (name, value) in &self.footer { dt { (name) } dd { (value) } } } }
                    script { (PreEscaped(SORT)) }
                }
            }
        };
        Ok(document.into_string())
    }

    fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.sections.iter().flat_map(|section| &section.blocks)
    }

    fn claims(&self) -> impl Iterator<Item = &Claim> {
        self.blocks().flat_map(|block| if let Block::Claims(claims) = block { &claims[..] } else { &[] })
    }

    fn check(&self) -> Result<(), Error> {
        let figures =
            || self.blocks().filter_map(|b| if let Block::Figure { figure, .. } = b { Some(&figure.id) } else { None });
        let figure_ids = unique("figure", figures())?;
        unique("section", self.sections.iter().map(|section| &section.id))?;
        unique("claim", self.claims().map(|claim| &claim.id))?;
        let lost = self
            .findings
            .iter()
            .find_map(|f| f.figure.as_ref().filter(|id| !figure_ids.contains(id)).map(|id| (f, id)));
        lost.map_or(Ok(()), |(finding, id)| {
            let place = format!("finding '{}'", finding.title);
            Err(Error::Page { place, message: format!("figure '{id}' is not on the page") })
        })
    }

    fn verdicts(&self) -> Markup {
        let counts = claim::counts(self.claims());
        let all =
            [(counts.holds, Verdict::Holds), (counts.broken, Verdict::Broken), (counts.not_tested, Verdict::NotTested)];
        html! {
            ul.counts aria-label="Verdicts of all claims" {
                @for (count, verdict) in all { li { strong { (count) } " " (mark(verdict)) } }
            }
        }
    }

    fn summary(&self) -> Markup {
        let broken: Vec<&Claim> = self.claims().filter(|claim| claim.verdict == Verdict::Broken).collect();
        html! {
            @if !broken.is_empty() {
                h2 #broken { "Broken claims" }
                ul {
                    @for claim in broken {
                        li { a href={ "#claim-" (claim.id) } { (claim.statement) } ": measured " (claim.measured) ", bound " (claim.bound) }
                    }
                }
            }
            @if !self.findings.is_empty() {
                h2 #findings { "Findings" }
                ul.findings {
                    @for finding in &self.findings {
                        li {
                            h3 { (finding.title) }
                            p { (finding.text) }
                            @if let Some(id) = &finding.figure { a href={ "#figure-" (id) } { "See the chart" } }
                        }
                    }
                }
            }
        }
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

/// One finding of the summary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finding {
    /// The finding in a few words.
    pub title: String,
    /// What was measured, in one or two sentences.
    pub text: String,
    /// Id of the figure that shows it.
    pub figure: Option<String>,
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

/// One part of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table.
    Table {
        /// What the table shows.
        caption: String,
        /// Its rows.
        table: Table,
        /// Link to the CSV file with the same numbers.
        csv: Option<String>,
    },
    /// Claims with their verdicts.
    Claims(Vec<Claim>),
    /// Files beside the page: what each is, and its name.
    Links {
        /// What the files are.
        caption: String,
        /// Text and file name of each.
        files: Vec<(String, String)>,
    },
    /// A figure with its drawing, as [`crate::plot::svg`] gives it.
    Figure {
        /// The figure: id, caption, command, data.
        figure: Figure,
        /// The drawing.
        svg: String,
    },
}

impl Section {
    fn markup(&self) -> Markup {
        html! {
            section #(self.id) aria-labelledby={ (self.id) "-title" } {
                h2 id={ (self.id) "-title" } { (self.title) }
                p { (self.intro) }
                @for block in &self.blocks { (block.markup()) }
            }
        }
    }
}

impl Block {
    fn markup(&self) -> Markup {
        match self {
            Self::Text(text) => html! { p { (text) } },
            Self::Table { caption, table, csv } => html! {
                (scroll(caption, &table.markup(caption)))
                @if let Some(csv) = csv { p.source { "Data: " a href=(csv) { (csv) } } }
            },
            Self::Claims(claims) => scroll("Claims", &claims_table(claims)),
            Self::Links { caption, files } => html! {
                details {
                    summary { (caption) " (" (files.len()) ")" }
                    ul { @for (text, file) in files { li { a href=(file) { (text) } } } }
                }
            },
            Self::Figure { figure, svg } => html! {
                figure id={ "figure-" (figure.id) } {
                    (scroll(&figure.title, &PreEscaped(svg.clone())))
                    figcaption { (figure.caption) }
                    p.source {
                        @if !figure.data.is_empty() { "Data: " a href=(figure.data) { (figure.data) } ". " }
                        @if !figure.command.is_empty() { "Made by " code { (figure.command) } }
                    }
                }
            },
        }
    }
}

/// A box that scrolls by itself, so that the page never does sideways; reachable by the keyboard.
fn scroll(label: &str, inside: &Markup) -> Markup {
    html! { div.scroll tabindex="0" role="region" aria-label=(label) { (inside) } }
}

fn claims_table(claims: &[Claim]) -> Markup {
    html! {
        table.sortable.claims {
            thead { tr { @for head in ["Claim", "Theory", "Measured", "Bound", "Verdict"] { th scope="col" { (head) } } } }
            tbody {
                @for claim in claims {
                    tr id={ "claim-" (claim.id) } {
                        td { (claim.statement) }
                        td { (claim.theory) }
                        td { (claim.measured) }
                        td { (claim.bound) }
                        td { (mark(claim.verdict)) }
                    }
                }
            }
        }
    }
}
