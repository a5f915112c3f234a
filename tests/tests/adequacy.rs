//! The adequacy study: its hierarchies, its recommendations, and that an inconsistent model is told from a consistent one.

use std::sync::OnceLock;

use measure::adequacy::{Adequacy, Row, rungs};
use measure::study::{Selection, Study};
use measure::sweep::Progress;
use reports::Verdict;
use scenes::run::Precision;

fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| {
        Adequacy::measure(&Selection {
            scenes: scenes::all(),
            methods: integrator::methods::MethodId::ALL.to_vec(),
            schemes: Vec::new(),
            precisions: Precision::ALL.to_vec(),
            steps: Vec::new(),
            length: None,
            quick: false,
            draws: Default::default(),
            looped: None,
            shard: None,
            progress: Progress::silent(),
        })
    })
}

#[test]
fn every_model_is_as_consistent_as_it_says() {
    let claims = Adequacy::claims(rows());
    assert!(claims.len() >= 40, "{} claims", claims.len());
    for claim in claims {
        assert_eq!(claim.verdict, Verdict::Holds, "{}: {}", claim.id, claim.measured);
    }
}

#[test]
fn a_model_that_says_the_opposite_of_itself_is_refused() {
    // With RK4, beside whose own error that of every model is seen.
    let with_rk4 = rows().iter().filter(|row| row.method == "rk4");
    let turned: Vec<Row> = with_rk4.map(|row| Row { consistent: !row.consistent, ..row.clone() }).collect();
    let claims = Adequacy::claims(&turned);
    // Where the error is below what rounding can hide nothing is seen of a model that leaves something out.
    let broken = claims.iter().filter(|claim| claim.verdict == Verdict::Broken).count();
    assert!(claims.iter().all(|claim| claim.verdict != Verdict::Holds) && broken >= 10, "{broken} of {}", claims.len());
}

/// The error of a model without drag is the distance that drag makes, whatever the method.
#[test]
fn the_model_error_is_a_property_of_the_model() {
    let seen = rungs(rows());
    let errors: Vec<f64> =
        seen.iter().filter(|s| s.scene == "linear-drag" && s.model == "no drag").filter_map(|s| s.finest).collect();
    assert_eq!(errors.len(), 3);
    // Semi-implicit Euler adds a t h / 2 of its own: t = 2.25 s at most, |a| < 10 m/s^2, h < 0.6 ms.
    assert!(errors.iter().all(|e| (e - errors[2]).abs() < 10.0 * 2.25 * 0.6e-3), "{errors:?}");
}

/// Counted on paper: x'' = 0 in three dimensions by semi-implicit Euler is a multiplication and an addition for each of the
/// six components, and the model without drag is cheaper than that with it.
#[test]
fn operations_are_those_of_the_formula() {
    let seen = rungs(rows());
    let of = |scene: &str, model: &str| {
        let found = seen.iter().find(|s| s.scene == scene && s.model == model && s.method == "semi-implicit-euler");
        found.expect("a ladder").operations_a_step
    };
    assert_eq!(of("linear-drag", "no drag"), 12);
    assert_eq!(of("principal-axis-torque", "one angle instead of an attitude"), 4);
    assert!(
        of("linear-drag", "full") > 12 && of("heavy-top", "full") > of("heavy-top", "one angle instead of an attitude")
    );
}

#[test]
fn a_recommendation_reaches_its_level_and_the_least_adequate_model_is_taken() {
    let tables = Adequacy::tables(rows()).expect("flat rows");
    let advice = &tables.iter().find(|t| t.name == "adequacy-recommendations").expect("a table").csv;
    let mut reader = csv::Reader::from_reader(advice.as_bytes());
    let headers = reader.headers().expect("a header").clone();
    let column = |name: &str| headers.iter().position(|h| h == name).expect("a column");
    let (scene, level, model, error) = (column("scene"), column("error_level"), column("model"), column("error"));
    let mut reached = 0;
    for record in reader.records() {
        let record = record.expect("a well-formed row");
        if let (Ok(level), Ok(error)) = (record[level].parse::<f64>(), record[error].parse::<f64>()) {
            assert!(error <= level, "{record:?}");
            reached += 1;
        }
        match &record[scene] {
            "box-tumbling position" => assert_eq!(&record[model], "translation only"),
            "principal-axis-torque" => assert_eq!(&record[model], "one angle instead of an attitude"),
            "torque-free-spin" | "heavy-top" | "kepler" => assert_eq!(&record[model], "full"),
            _ => {}
        }
    }
    assert!(reached >= 40, "{reached} levels reached");
}
