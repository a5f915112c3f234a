//! Development only.
use audit::checks;
fn main() {
    for path in std::env::args().skip(1) {
        match audit::load(path.as_ref(), &audit::Choices::default()) {
            Err(e) => println!("ERROR {e}"),
            Ok(t) => {
                println!("{path}");
                let (clock, mut f) = checks::time::check(&t);
                f.extend(checks::reading(&t));
                f.extend(checks::kinematics::check(&t, &clock, None));
                f.extend(checks::clamps::check(&t));
                f.extend(checks::conservation::check(&t, [1.25, 0.8125, 1.5625].into()));
                for x in f { println!("   {} {} {} | {}", x.verdict.id(), x.id, x.value, x.evidence); }
            }
        }
    }
}
