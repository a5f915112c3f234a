//! Claims in short: for a terminal, for a pull request's comment, for a machine.

use reports::claim::{Counts, counts};
use reports::{Claim, Table, Verdict, exit_code};
use serde::Serialize;

use crate::produce::Judged;
use crate::provenance::Manifest;
use measure::error::Error;

/// How many claims of each study hold, and every one that does not.
pub fn summary(claims: &[Claim]) -> String {
    if claims.is_empty() {
        return verdicts(claims);
    }
    let broken = broken(claims);
    let table = counted(claims).to_text();
    if broken.rows.is_empty() { table } else { format!("{}\n{table}", broken.to_text()) }
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

/// A heading with the verdict, the counts of each study, the broken claims and where the numbers come from.
pub fn markdown(judged: &Judged) -> String {
    let Judged { claims, manifest } = judged;
    let Counts { holds, broken: against, not_tested } = counts(claims);
    let head = if against > 0 { Verdict::Broken } else { Verdict::Holds };
    let title =
        format!("### {} Accuracy: {holds} claims hold, {against} broken, {not_tested} not tested\n", head.sign());
    let broken = broken(claims);
    let broken = if broken.rows.is_empty() { String::new() } else { format!("{}\n", broken.to_markdown()) };
    let origin = manifest.lines().into_iter().filter(|(name, _)| name != "run again");
    let origin = origin.map(|(name, value)| format!("{name}: {value}")).collect::<Vec<_>>().join(" · ");
    format!("{title}\n{broken}{}\n<sub>{origin}</sub>\n", counted(claims).to_markdown())
}

/// What a machine is told. Keys are added and never change their meaning under the same `format`.
#[derive(Serialize)]
struct ForMachines<'a> {
    format: u32,
    #[serde(flatten)]
    manifest: &'a Manifest,
    holds: bool,
    studies: Vec<Study<'a>>,
    claims: &'a [Claim],
}

#[derive(Serialize)]
struct Study<'a> {
    study: &'a str,
    holds: usize,
    broken: usize,
    not_tested: usize,
}

/// Provenance, plan, the counts of each study and all claims as one JSON object.
///
/// # Errors
/// None that is known: claims have a form in JSON.
pub fn json(judged: &Judged) -> Result<String, Error> {
    let Judged { claims, manifest } = judged;
    let studies = by_study(claims);
    let all = ForMachines { format: 1, manifest, holds: exit_code(claims) == 0, studies, claims };
    let text = serde_json::to_string_pretty(&all).map_err(|error| Error::plan("JSON", error.to_string()))?;
    Ok(text + "\n")
}

fn by_study(claims: &[Claim]) -> Vec<Study<'_>> {
    let studies = claims.chunk_by(|a, b| a.study == b.study);
    studies
        .map(|claims| {
            let Counts { holds, broken, not_tested } = counts(claims);
            Study { study: &claims[0].study, holds, broken, not_tested }
        })
        .collect()
}

fn counted(claims: &[Claim]) -> Table {
    let mut table = Table::new(&["study", "holds", "broken", "not tested"], &["holds", "broken", "not tested"]);
    for Study { study, holds, broken, not_tested } in by_study(claims) {
        table.push([study.to_owned(), holds.to_string(), broken.to_string(), not_tested.to_string()]);
    }
    table
}

fn broken(claims: &[Claim]) -> Table {
    let mut table = Table::new(&["broken claim", "theory", "measured", "bound"], &[]);
    for claim in claims.iter().filter(|claim| claim.verdict == Verdict::Broken) {
        table.push([&claim.id, &claim.theory, &claim.measured, &claim.bound].map(String::clone));
    }
    table
}
