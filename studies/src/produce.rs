//! From a plan to files: rows, tables, figures, claims, one page. Nothing is written before everything is known.

use reports::{Block, Claim, Finding, OutputDir, Page, Section, Table};

use crate::adequacy::Adequacy;
use crate::cli::Common;
use crate::convergence::Convergence;
use crate::drift::DriftStudy;
use crate::error::Error;
use crate::provenance;
use crate::rotation::Rotation;
use crate::stability::Stability;
use crate::study::{Derived, Selection, Study};
use crate::teach;

/// What a study has made: files to be written, and its part of the page.
pub struct Product {
    /// Name and content of each file.
    pub files: Vec<(String, String)>,
    /// Its part of the page.
    pub section: Section,
    /// Its verdicts.
    pub claims: Vec<Claim>,
}

/// The directory of the whole report, below `target/`.
pub const REPORT: &str = "report";

/// Every study of the report, in its order.
pub fn all(selection: &mut Selection) -> Result<Vec<Product>, Error> {
    Ok(vec![
        of::<Convergence>(selection)?,
        of::<DriftStudy>(selection)?,
        of::<Rotation>(selection)?,
        of::<Adequacy>(selection)?,
        of::<Stability>(selection)?,
    ])
}

/// Runs one study and makes all that follows from its rows.
///
/// # Errors
/// Rows or figures that have no form as text.
pub fn of<S: Study>(selection: &mut Selection) -> Result<Product, Error> {
    if let Some(label) = &mut selection.progress.label {
        S::ID.clone_into(label);
    }
    from_rows::<S>(&S::measure(selection))
}

/// All that follows from the rows of a study, without running anything.
///
/// # Errors
/// Rows or figures that have no form as text.
pub fn from_rows<S: Study>(rows: &[S::Row]) -> Result<Product, Error> {
    let mut files = vec![(format!("{}.csv", S::ID), reports::write_csv(rows)?)];
    let claims = S::claims(rows);
    let claims_csv = format!("{}-claims.csv", S::ID);
    files.push((claims_csv, reports::write_csv(&claims)?));
    let (mut blocks, mut linked) = (Vec::new(), Vec::new());
    for figure in S::figures(rows) {
        let svg = reports::svg(&figure)?;
        files.push((format!("{}.svg", figure.id), svg.clone()));
        if S::is_on_page(&figure) {
            blocks.push(Block::Figure { figure, svg });
        } else {
            linked.push((figure.title, format!("{}.svg", figure.id)));
        }
    }
    if !linked.is_empty() {
        blocks.push(Block::Links { caption: "More charts".to_owned(), files: linked });
    }
    blocks.push(Block::Claims(claims.clone()));
    for Derived { name, caption, csv, table } in S::tables(rows)? {
        files.push((format!("{name}.csv"), csv));
        blocks.push(Block::Table { caption: caption.to_owned(), table, csv: Some(format!("{name}.csv")) });
    }
    let section = Section { id: S::ID.to_owned(), title: S::TITLE.to_owned(), intro: S::INTRO.to_owned(), blocks };
    Ok(Product { files, section, claims })
}

/// Runs one study and writes its files.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn study<S: Study>(common: &Common) -> Result<Vec<Claim>, Error> {
    let mut selection = common.selection()?;
    let out = OutputDir::create(common.out(S::ID))?;
    let product = of::<S>(&mut selection)?;
    out.write_all(&product.files)?;
    Ok(product.claims)
}

/// Runs every study and writes the report.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn report(common: &Common) -> Result<Vec<Claim>, Error> {
    let mut selection = common.selection()?;
    let out = OutputDir::create(common.out(REPORT))?;
    let products = all(&mut selection)?;
    let (mut files, mut sections, mut claims) = (Vec::new(), Vec::new(), Vec::new());
    for product in products {
        files.extend(product.files);
        sections.push(product.section);
        claims.extend(product.claims);
    }
    let page = Page {
        title: "How accurate is a fixed step?".to_owned(),
        lead: "Explicit and semi-implicit Euler, with four yardsticks, on scenes whose exact motion is known."
            .to_owned(),
        findings: findings(&claims, &files),
        sections,
        footer: provenance::lines(common),
    };
    let rows = files.iter().find(|(name, _)| name == "convergence.csv").map_or("", |(_, csv)| csv);
    files.push((teach::FILE.to_owned(), teach::page(rows, &common.set, &provenance::lines(common))?));
    files.push(("manifest.json".to_owned(), provenance::manifest(common)));
    files.push(("index.html".to_owned(), page.html()?));
    out.write_all(&files)?;
    Ok(claims)
}

/// What a busy reader should take away: a title, the claim that carries it, and the chart that shows it.
const FINDINGS: [(&str, &str, &str); 6] = [
    ("Explicit Euler gains energy at every step", "drift.oscillator.explicit-euler.energy", "drift-oscillator-energy"),
    (
        "Semi-implicit Euler keeps it in a band, for ever",
        "drift.oscillator.semi-implicit-euler.energy",
        "drift-oscillator-energy",
    ),
    (
        "A force that depends on the velocity takes that advantage away",
        "drift.charged-particle/magnetic.semi-implicit-euler.energy",
        "drift-charged-particle-magnetic-energy",
    ),
    (
        "RK4 is worth its four evaluations where the motion is smooth",
        "convergence.torque-free-spin.rk4.order",
        "precision-torque-free-spin-attitude",
    ),
    (
        "Without the gyroscopic term no step is small enough",
        "rotation.semi-implicit-euler/without-gyroscopic-term.order-0",
        "rotation-error-torque-free-spin",
    ),
    (
        "A spinning body is not a spring: semi-implicit Euler gains energy",
        "rotation.step-law.energy.asymmetric-body.semi-implicit-euler/body-omega",
        "rotation-axis-start-near-most-inertia",
    ),
];

/// The findings whose claim was made; a claim that broke is told as broken.
fn findings(claims: &[Claim], files: &[(String, String)]) -> Vec<Finding> {
    let finding = |&(title, id, figure): &(&str, &str, &str)| {
        let claim = claims.iter().find(|claim| claim.id == id || claim.id.starts_with(&format!("{id}.")))?;
        let drawn = files.iter().any(|(name, _)| name.strip_suffix(".svg") == Some(figure));
        Some(Finding {
            title: title.to_owned(),
            text: format!("{}: {} (theory: {}) – {}.", claim.statement, claim.measured, claim.theory, claim.verdict),
            figure: drawn.then(|| figure.to_owned()),
        })
    };
    FINDINGS.iter().filter_map(finding).collect()
}

/// A short table: how many claims of each study hold, and every one that does not.
pub fn summary(claims: &[Claim]) -> String {
    if claims.is_empty() {
        return verdicts(claims);
    }
    let mut table = Table::new(&["study", "holds", "broken", "not tested"], &["holds", "broken", "not tested"]);
    for study in claims.chunk_by(|a, b| a.study == b.study) {
        let counts = reports::claim::counts(study);
        let numbers = [counts.holds, counts.broken, counts.not_tested].map(|n| n.to_string());
        table.push(std::iter::once(study[0].study.clone()).chain(numbers));
    }
    let broken = broken(claims);
    if broken.rows.is_empty() { table.to_text() } else { format!("{}\n{}", broken.to_text(), table.to_text()) }
}

fn broken(claims: &[Claim]) -> Table {
    let mut table = Table::new(&["broken claim", "theory", "measured", "bound"], &[]);
    for claim in claims.iter().filter(|claim| claim.verdict == reports::Verdict::Broken) {
        table.push([&claim.id, &claim.theory, &claim.measured, &claim.bound].map(String::clone));
    }
    table
}

/// Every claim with its verdict.
pub fn verdicts(claims: &[Claim]) -> String {
    if claims.is_empty() {
        return "no claim is made about this selection; its tables and charts are written\n".to_owned();
    }
    let mut table = Table::new(&["claim", "theory", "measured", "verdict"], &[]);
    for claim in claims {
        let verdict = format!("{} {}", claim.verdict.sign(), claim.verdict);
        table.push([&claim.id, &claim.theory, &claim.measured, &verdict].map(String::clone));
    }
    table.to_text()
}
