//! Bounds on scenes with parameters of the user's own: the column `set`.

use gate::{Bounds, Flat};
use integrator::methods::{ExplicitEuler, SemiImplicitEuler};
use measure::sweep::Progress;
use reports::Verdict;

const HEADER: &str = "scene,set,method,precision,quantity,kind,steps,end_s,unit,low,high,measured,reason,mutant\n";

fn bounds(rows: &[&str]) -> Result<Bounds, String> {
    let file = format!("{HEADER}{}# end: {} rows\n", rows.concat(), rows.len());
    Bounds::parse(file.as_bytes(), "mine.csv").map_err(|error| error.to_string())
}

/// x = cos 2 t for m = 2 kg and k = 8 N/m. The error of semi-implicit Euler is h w x0 sin(w T) / 2 with w = 2 rad/s, so that the
/// constant at T = 1 s is sin 2.
const CONSTANT: &str = "oscillator,mass=2 stiffness=8 x0=1 v0=0,semi-implicit-euler,f64,position,error-constant,4096,1.0,m/s^1,\
    0.909,0.9096,0.909297,theory: sin 2,\n";
const ORDER: &str = "oscillator,mass=2 stiffness=8 x0=1 v0=0,semi-implicit-euler,f64,position,order,4096,1.0,1,0.98,1.02,1.0,theory: 1,\n";
/// The same on the default parameters.
const DEFAULT: &str = "oscillator,,semi-implicit-euler,f64,position,order,4096,1.0,1,0.98,1.02,1.0,theory: 1,\n";

// Fails if: the parameters of a row are ignored, or taken for another row's.
#[test]
fn rows_are_judged_on_the_scene_with_their_parameters() {
    let mine =
        bounds(&[DEFAULT, CONSTANT, ORDER]).or_else(|_| bounds(&[DEFAULT, ORDER, CONSTANT])).expect("a file of bounds");
    let rows: Vec<_> = mine.rows.iter().collect();
    let judged = mine.check(&rows, &Progress::silent()).expect("scenes and methods");
    assert_eq!(judged.len(), 3);
    assert!(judged.iter().all(|one| one.verdict() == Verdict::Holds), "{judged:?}");
    // Negative control: the constant of another stiffness, and another method.
    let other = bounds(&[&CONSTANT.replace("stiffness=8", "stiffness=6")]).expect("a file of bounds");
    let judged = other.check(&other.rows.iter().collect::<Vec<_>>(), &Progress::silent()).expect("scenes and methods");
    assert_eq!(judged[0].verdict(), Verdict::Broken);
    let held = mine.hold("semi-implicit-euler", &Flat(SemiImplicitEuler)).expect("rows of the method");
    held.assert();
    let wrong = mine.hold("semi-implicit-euler", &Flat(ExplicitEuler)).expect("rows of the method");
    assert!(!wrong.broken().is_empty());
}

// Fails if: a wrong setting is taken, or the message lacks line, column or name; or a file loses its settings when it is written.
#[test]
fn wrong_settings_are_refused_and_right_ones_survive_writing() {
    for (settings, expected) in [
        ("mass=-1", "mine.csv:2:2: scene 'oscillator': parameter 'mass' = -1"),
        ("mas=1", "'mas'"),
        ("mass", "not of the form NAME=VALUE"),
    ] {
        let row = ORDER.replace("mass=2 stiffness=8 x0=1 v0=0", settings);
        let message = bounds(&[&row]).err().unwrap_or_default();
        assert!(message.contains(expected), "{settings}: {message}");
    }
    let mine = bounds(&[ORDER]).expect("a file of bounds");
    let written = gate::read::write(&mine.rows).expect("rows have a form");
    let again = Bounds::parse(written.as_bytes(), "again.csv").expect("what was written");
    assert_eq!(again.rows, mine.rows);
}
