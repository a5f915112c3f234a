//! The binaries as a user meets them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

/// Every binary of the workspace.
pub const PROGRAMS: [&str; 8] =
    ["report", "convergence", "drift", "rotation", "adequacy", "stability", "loops", "tradeoff"];

/// The binary of that name, of the same profile as this test. `cargo test` alone does not build the binaries of another
/// package, so the first call does.
///
/// # Panics
/// If the binaries do not build.
pub fn program(name: &str) -> Command {
    let mut command = Command::new(directory().join(name));
    command.env("NO_COLOR", "1").stdin(Stdio::null());
    command
}

/// Where the binaries lie, built.
///
/// # Panics
/// If they do not build.
pub fn directory() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let test = std::env::current_exe().expect("a test knows its own path");
        let directory = test.parent().and_then(Path::parent).expect("target/<profile>/deps/<test>").to_owned();
        let profile = match directory.file_name().and_then(|name| name.to_str()) {
            Some("debug") | None => "dev".to_owned(),
            Some(name) => name.to_owned(),
        };
        let target = directory.parent().expect("the profile's directory is inside the target directory");
        let status = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "--workspace", "--bins", "--profile", &profile])
            .arg("--target-dir")
            .arg(target)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .status();
        assert!(status.is_ok_and(|status| status.success()), "the binaries of `studies` do not build");
        directory
    })
}

/// What the program of that name does, writing into `out`.
///
/// # Panics
/// If it does not start.
pub fn run(name: &str, arguments: &[&str], out: &Path) -> Output {
    program(name).args(arguments).arg("--out").arg(out).output().expect("the binary was built with the workspace")
}

/// What a program said.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The files of a directory by name, with their bytes; none if it is not there. What is hidden is no part of a report.
///
/// # Panics
/// If a file cannot be read.
pub fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(directory).into_iter().flatten().map(|entry| entry.expect("readable").path());
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let visible = entries.filter(|path| !name(path).starts_with('.'));
    visible.map(|path| (name(&path), fs::read(path).expect("readable"))).collect()
}

/// What is the same in two runs of one plan: neither the files with times in them, those of the tradeoff study but for its
/// claims, nor that study's section of the page.
///
/// # Panics
/// If the section has no end, or the manifest is none.
pub fn untimed(mut files: BTreeMap<String, Vec<u8>>) -> BTreeMap<String, Vec<u8>> {
    let timed = |name: &str| name.starts_with("tradeoff") || name.starts_with("work-time");
    files.retain(|name, _| name == "tradeoff-claims.csv" || !timed(name));
    // Its rows are sealed in the manifest.
    if let Some(manifest) = files.get_mut("manifest.json") {
        let mut content: serde_json::Value = serde_json::from_slice(manifest).expect("a manifest");
        if let Some(rows) = content["rows"].as_object_mut() {
            rows.retain(|name, _| !timed(name));
        }
        *manifest = content.to_string().into_bytes();
    }
    if let Some(page) = files.get_mut("index.html") {
        let content = text(page);
        if let Some(start) = content.find("<section id=\"tradeoff\"") {
            let length = content[start..].find("</section>").expect("a section ends");
            *page = format!("{}{}", &content[..start], &content[start + length..]).into_bytes();
        }
    }
    files
}

/// The same files, byte for byte.
///
/// # Panics
/// If they are not.
pub fn assert_same(one: &BTreeMap<String, Vec<u8>>, two: &BTreeMap<String, Vec<u8>>) {
    assert!(one.keys().eq(two.keys()), "{:?}\n{:?}", one.keys(), two.keys());
    for (name, bytes) in one {
        assert!(*bytes == two[name], "{name} differs");
    }
}
