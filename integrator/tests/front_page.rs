//! The table of methods on the front page is the lists' own.

use integrator::methods::{Facts, MethodId, RigidStep};

/// The table as the front page has it, a line of comment each.
fn table() -> String {
    let mut lines = vec![
        "| method | order | evaluations | symplectic | reversible |".to_owned(),
        "|---|---|---|---|---|".to_owned(),
    ];
    let mut push = |name: String, facts: &Facts| {
        let claim = |claim: Option<bool>| claim.map_or("-", |yes| if yes { "yes" } else { "no" });
        let evaluations = facts.evaluations.map_or("iterates".to_owned(), |n| n.to_string());
        lines.push(format!(
            "| [{}](methods::{name}) | {} | {evaluations} | {} | {} |",
            facts.title.replace('|', r"\|"),
            facts.order,
            claim(facts.symplectic),
            claim(facts.reversible)
        ));
    };
    for method in MethodId::ALL {
        push(format!("{method:?}"), method.facts());
    }
    for step in RigidStep::ALL {
        push(format!("{step:?}"), step.facts());
    }
    lines.iter().map(|line| format!("//! {line}\n")).collect()
}

// Fails if: a row of the page, or a fact behind it, is another.
#[test]
fn the_front_page_lists_every_method_with_its_facts() {
    let page = include_str!("../src/lib.rs");
    assert!(page.contains(&table()), "the table of `src/lib.rs` should be:\n{}", table());
}
