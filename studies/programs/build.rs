//! What the report says of its own making: commit, compiler, target.

use std::process::Command;

fn main() {
    let output = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let commit = output("git", &["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown commit".to_owned());
    let compiler = output(&rustc, &["-V"]).unwrap_or_else(|| "unknown compiler".to_owned());
    println!("cargo::rustc-env=STUDIES_COMMIT={commit}");
    println!("cargo::rustc-env=STUDIES_COMPILER={compiler}");
    println!("cargo::rustc-env=STUDIES_TARGET={}", std::env::var("TARGET").unwrap_or_default());
    println!("cargo::rerun-if-changed=../../.git/HEAD");
    println!("cargo::rerun-if-changed=../../.git/refs/heads");
}
