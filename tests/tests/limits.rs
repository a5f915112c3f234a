//! The programs where the system gives them little: threads, processes, memory. A message, never a panic.
#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use verification::programs::{directory, text};

/// The program where every user may start it and write.
fn for_everyone(out: &Path) -> PathBuf {
    let copy = out.join("convergence");
    fs::copy(directory().join("convergence"), &copy).expect("copied");
    for path in [out, &copy] {
        fs::set_permissions(path, fs::Permissions::from_mode(0o777)).expect("ours");
    }
    copy
}

/// What a shell says of a program started under limits, as the user nobody where this one is root: root has no limit of processes.
fn limited(limits: &str, arguments: &str, out: &Path) -> Output {
    let binary = for_everyone(out);
    let line = format!("{limits} && exec '{}' {arguments} --out '{}/out'", binary.display(), out.display());
    let shell = |command: &mut Command| command.arg("-c").arg(&line).output().expect("a shell");
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| text(&id.stdout).trim() == "0");
    if is_root && limits.contains("ulimit -u") {
        shell(Command::new("setpriv").args(["--reuid=65534", "--regid=65534", "--clear-groups", "bash"]))
    } else {
        shell(&mut Command::new("bash"))
    }
}

// Fails if: threads are started where a refusal panics, or the message has no remedy.
#[test]
fn threads_that_the_system_refuses_are_wrong_input() {
    let out = tempfile::tempdir().expect("a temporary directory");
    for (limits, arguments) in [
        ("ulimit -v 600000", "--quick --scene constant-force --threads 1024"),
        ("ulimit -u 3", "--quick --scene constant-force --threads 64"),
        ("ulimit -u 1", "--quick --scene constant-force"),
    ] {
        let output = limited(limits, arguments, out.path());
        let said = text(&output.stderr);
        assert!(!said.contains("panicked"), "{limits}: {said}");
        assert_eq!(output.status.code(), Some(2), "{limits}: {said}");
        assert!(said.starts_with("error: --threads: ") && said.contains("ulimit -u"), "{limits}: {said}");
    }
}
