//! What a busy reader sees first: the answer, what is broken, the findings, and the verdicts by study.

use super::{Block, Finding, Page, mark};
use crate::{Error, Verdict, claim, plot};
use maud::{Markup, PreEscaped, html};

impl Page {
    /// # Errors
    /// A figure or a formula that cannot be drawn.
    pub(super) fn opening(&self) -> Result<Markup, Error> {
        let numbered = self.findings.iter().enumerate();
        let findings = numbered.map(|(i, one)| self.finding(i, one)).collect::<Result<Vec<_>, _>>()?;
        let answer = self.answer.iter().map(Block::markup).collect::<Result<Vec<_>, _>>()?;
        Ok(html! {
            div.opening {
                h1 { (self.title) }
                p.lead { (self.lead) }
                @if !self.links.is_empty() {
                    p.links { @for (text, file) in &self.links { a.button href=(file) { (text) } " " } }
                }
                (self.broken())
                @for block in &answer { (block) }
                @if !findings.is_empty() {
                    h2 #findings { "What matters" }
                    ol.findings { @for finding in &findings { li { (finding) } } }
                }
                (self.verdicts())
            }
        })
    }

    fn verdicts(&self) -> Markup {
        let counts = claim::counts(self.claims());
        let all =
            [(counts.holds, Verdict::Holds), (counts.broken, Verdict::Broken), (counts.not_tested, Verdict::NotTested)];
        let studies = self.sections.iter().map(|section| (section, claim::counts(section.claims())));
        let judged = studies.filter(|(_, c)| c.holds + c.broken + c.not_tested > 0);
        html! {
            ul.counts aria-label="Verdicts of all claims" {
                @for (count, verdict) in all { li { strong { (count) } " " (mark(verdict)) } }
            }
            table.summary {
                caption { "Claims of each study" }
                thead { tr { th scope="col" { "Study" } @for head in ["Hold", "Broken", "Not tested"] { th scope="col" { (head) } } } }
                tbody {
                    @for (section, c) in judged {
                        tr {
                            th scope="row" { a href={ "#" (section.id) } { (section.title) } }
                            @for (count, class) in [(c.holds, "holds"), (c.broken, "broken"), (c.not_tested, "not-tested")] {
                                td class=[(count > 0).then_some(class)] { (count) }
                            }
                        }
                    }
                }
            }
        }
    }

    fn broken(&self) -> Markup {
        let broken: Vec<_> = self.claims().into_iter().filter(|claim| claim.verdict == Verdict::Broken).collect();
        html! {
            @if !broken.is_empty() {
                h2 #broken { "Broken claims" }
                ul {
                    @for claim in broken {
                        li { a href={ "#claim-" (claim.id) } { (claim.statement) } ": measured " (claim.measured) ", bound " (claim.bound) }
                    }
                }
            }
        }
    }

    fn finding(&self, index: usize, finding: &Finding) -> Result<Markup, Error> {
        let figure = finding.figure.as_ref().and_then(|id| self.figure(id));
        let drawn = figure.map(|figure| plot::inline(figure, &format!("finding-{index}"))).transpose()?;
        Ok(html! {
            div {
                h3 { (finding.title) }
                @if !finding.number.is_empty() { p.number { (finding.number) } }
                p { (finding.text) }
                p.source {
                    @if let Some(id) = &finding.claim { a href={ "#claim-" (id) } { "The claim" } ". " }
                    @if let Some(figure) = figure { a href={ "#figure-" (figure.id) } { "The chart in its study" } "." }
                }
            }
            @if let (Some(figure), Some(svg)) = (figure, drawn) {
                div.scroll tabindex="0" role="region" aria-label=(figure.title) { (PreEscaped(svg)) }
            }
        })
    }
}
