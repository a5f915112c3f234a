use integrator::*; use nalgebra::*;
struct Spring; impl Model<f64> for Spring { type Config=Vector1<f64>; fn rate(&self,_t:f64,s:&State<Vector1<f64>>)->Vector1<f64>{ -s.q*4.0 } }
fn main(){ let mut s=State{q:Vector1::new(0.75),v:Vector1::new(-1.25)}; let h=0.125;
 for i in 0..3000 { let n=methods::ImplicitEuler.step(&Spring,0.0,h,s); if !n.is_finite(){ println!("{i} {:?}",s); 
   break;} s=n; } }
