use studies::stability::{displaced::Stepping, limits};
use studies::{run::Precision, scenes};
use integrator::methods::MethodId;
fn main() {
    for scene in scenes::catalogue() {
        for &method in MethodId::ALL { for precision in [Precision::F64, Precision::F32] {
            let t = std::time::Instant::now();
            for r in limits::rows(&Stepping { scene: scene.as_ref(), method, precision }) {
                println!("{:?} {} {} {:?} low {:?} high {:?} theory {:?} closed {:?} measured {:?} rel {:?} {} {:?}", r.part, r.scene, r.method, r.precision, r.low, r.high, r.theory, r.closed_form, r.measured, r.measured.map(|m| m/r.theory.unwrap()-1.0), r.failure, t.elapsed());
            }
        }}
    }
}
