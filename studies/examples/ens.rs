fn main() {
    let scenes = std::env::args().skip(1).map(|id| studies::scenes::by_id(&id).unwrap()).collect();
    let mut sel = studies::study::Selection { scenes, methods: integrator::methods::MethodId::ALL.to_vec(), precisions: studies::run::Precision::ALL.to_vec(), steps: vec![], quick: false, progress: studies::sweep::Progress::silent() };
    let t = std::time::Instant::now();
    let p = studies::ensemble::ensemble(&mut sel, 256, 1).unwrap();
    println!("{:?}", t.elapsed());
    std::fs::create_dir_all("/tmp/ens").unwrap();
    for (n, c) in &p.files { std::fs::write(format!("/tmp/ens/{n}"), c).unwrap(); }
    for b in &p.section.blocks { if let reports::Block::Table{caption, table, ..} = b { println!("{caption}\n{}", table.to_text()); } }
    println!("{}", studies::produce::verdicts(&p.claims));
}
