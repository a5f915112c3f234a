//! The parts of a section.

use super::mark;
use crate::{Claim, Error, Figure, Table, formula, plot};
use maud::{Markup, PreEscaped, html};

/// One part of a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A formula in LaTeX, on a line of its own.
    Formula(String),
    /// Names and values.
    Facts(Vec<(String, String)>),
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
    /// Files beside the page, or places in it: what each is, and its name.
    Links {
        /// What the files are.
        caption: String,
        /// Text and file name (or `#` and an anchor) of each.
        files: Vec<(String, String)>,
    },
    /// A figure, which the page draws.
    Figure(Figure),
    /// What belongs together, folded under a heading until it is wanted.
    Group {
        /// Anchor, unique within the page.
        id: String,
        /// Heading.
        title: String,
        /// What is inside, in a few words.
        note: String,
        /// What is inside.
        blocks: Vec<Block>,
    },
}

impl Block {
    /// The block, and those inside.
    pub(super) fn and_inner(&self) -> Vec<&Block> {
        let inner = if let Self::Group { blocks, .. } = self { &blocks[..] } else { &[] };
        std::iter::once(self).chain(inner.iter().flat_map(Block::and_inner)).collect()
    }

    pub(super) fn markup(&self) -> Result<Markup, Error> {
        Ok(match self {
            Self::Text(text) => html! { p { (text) } },
            Self::Formula(latex) => html! { div.formula tabindex="0" { (PreEscaped(formula::mathml(latex)?)) } },
            Self::Facts(facts) => html! { dl { @for (name, value) in facts { dt { (name) } dd { (value) } } } },
            Self::Table { caption, table, csv } => html! {
                (scroll(caption, &table.markup(caption)))
                @if let Some(csv) = csv { p.source { "Data: " a href=(csv) { (csv) } } }
            },
            Self::Claims(claims) => scroll("Claims", &claims_table(claims)),
            Self::Links { caption, files } => html! {
                p.source { (caption) ": " @for (i, (text, file)) in files.iter().enumerate() { @if i > 0 { ", " } a href=(file) { (text) } } }
            },
            Self::Figure(figure) => drawn(figure)?,
            Self::Group { id, title, note, blocks } => {
                let blocks = blocks.iter().map(Block::markup).collect::<Result<Vec<_>, _>>()?;
                html! {
                    details.group #(id) {
                        summary { h3 { (title) } span.note { (note) } }
                        @for block in &blocks { (block) }
                    }
                }
            }
        })
    }
}

fn drawn(figure: &Figure) -> Result<Markup, Error> {
    let id = format!("figure-{}", figure.id);
    let svg = PreEscaped(plot::inline(figure, &id)?);
    Ok(html! {
        figure #(id) {
            (scroll(&figure.title, &svg))
            figcaption { (figure.caption) }
            p.source {
                @if !figure.data.is_empty() { "Data: " a href=(figure.data) { (figure.data) } ". " }
                @if !figure.command.is_empty() { "Made by " code { (figure.command) } }
            }
        }
    })
}

/// A box that scrolls by itself, so that the page never does sideways; reachable by the keyboard.
fn scroll(label: &str, inside: &Markup) -> Markup {
    html! { div.scroll tabindex="0" role="region" aria-label=(label) { (inside) } }
}

fn claims_table(claims: &[Claim]) -> Markup {
    html! {
        table.sortable.claims {
            caption { "Claims" }
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
