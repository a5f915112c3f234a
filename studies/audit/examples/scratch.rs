fn main() {
    for path in std::env::args().skip(1) {
        match audit::load(path.as_ref(), &audit::Choices::default()) {
            Err(e) => println!("ERROR {e}"),
            Ok(t) => {
                println!("{path}\trows {}\t{}\tp {:?} v {:?} q {:?} w {:?} {:?} a {} ad {}\tties {}\tmisfit {:?}\tunused {:?}", t.rows(), t.rounding,
                    t.position.as_ref().map(|p| p.axes.len()), t.velocity.as_ref().map(|p| p.axes.len()), t.attitude.as_ref().map(|a| a.reading.name()),
                    t.omega.is_some(), t.omega_frame, t.angle.is_some(), t.angle_rate.is_some(), t.ties.len(),
                    t.time[1], t.unused);
                if std::env::var("V").is_ok() { for r in &t.recognised { println!("   {:?} {:?}: {} ({})", r.role, r.columns, r.reading, r.reason); } for x in &t.ties { println!("   TIE {} {:?}", x.what, x.readings); } }
            }
        }
    }
}
