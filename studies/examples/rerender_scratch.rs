use studies::study::Study; use studies::produce::from_rows;
use reports::*;
fn p<S: Study>(dir:&str)->studies::produce::Product{ let f=format!("{dir}/{}.csv",S::ID); let t=std::fs::read_to_string(&f).unwrap(); from_rows::<S>(&read_csv::<S::Row>(&t,&f).unwrap()).unwrap() }
fn main(){ let a:Vec<String>=std::env::args().collect(); let d=&a[1];
 let ps=vec![p::<studies::convergence::Convergence>(d),p::<studies::drift::DriftStudy>(d),p::<studies::rotation::Rotation>(d),p::<studies::adequacy::Adequacy>(d),p::<studies::stability::Stability>(d)];
 std::fs::create_dir_all(&a[2]).unwrap(); let mut s=vec![];
 for p in ps { for (n,t) in p.files { std::fs::write(format!("{}/{n}",a[2]),t).unwrap(); } s.push(p.section); }
 let h=studies::page::html(s,&studies::scenes::catalogue(),true,vec![("version".into(),"x".into())]).unwrap();
 std::fs::write(format!("{}/index.html",a[2]),h).unwrap(); }
