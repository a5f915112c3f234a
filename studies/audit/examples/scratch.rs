//! Development only.
use audit::checks;
use audit::physics::*;
use nalgebra::Vector3;
fn main() {
    let body = Vector3::new(1.25, 0.8125, 1.5625);
    for path in std::env::args().skip(1) {
        match audit::load(path.as_ref(), &audit::Choices::default()) {
            Err(e) => println!("ERROR {e}"),
            Ok(t) => {
                println!("{path}");
                let (clock, _) = checks::time::check(&t);
                let name = path.split('/').next_back().unwrap_or("");
                let case = name.chars().next().unwrap_or(' ');
                let g = Vector3::new(0.0, 0.0, -9.81);
                let mut p = Physics { inertia: Some(body), moment: Some(Moment::None), ..Physics::UNKNOWN };
                match case {
                    'B' | 'E' => p.force = Some(Force::Constant(g)),
                    'C' => p.force = Some(Force::Spring { rate: 12.5 / 3.0, anchor: Vector3::new(0.5, -0.25, 1.0) }),
                    'H' => p.force = Some(Force::Kepler { mu: 1.0, centre: Vector3::zeros() }),
                    'F' => p.pendulum = Some(36.7875 / 5.5),
                    'G' => { let a = Vector3::new(0.0, 0.0, 1.25); p.inertia = Some(body + Vector3::new(1.5625, 1.5625, 0.0) * 3.0); p.moment = Some(Moment::Weight { arm: a * 3.0, gravity: g }) }
                    'D' => p.force = Some(Force::None),
                    _ => p.force = Some(Force::None),
                }
                let k = std::env::var("K").ok().and_then(|k| k.parse().ok());
                let start = std::time::Instant::now();
                for s in audit::step::identify(&t, &clock, &p, k) {
                    println!("   {:?} {:?} rows {} of {} tried {} res {:.1e}", s.moves, s.verdict, s.candidates[0].rows, s.rows, s.tried, s.resolution);
                    for c in s.candidates.iter().take(4) { println!("        {:.2e} {} k {} same {}", c.largest_difference, c.id, c.steps_per_row, c.same_as.len()); }
                }
                println!("   time {:?}", start.elapsed());
            }
        }
    }
}
