//! The one command in front of all programs.

use verification::programs::{files, program, run, text};

// Fails if: a command is another program, loses an argument, or keeps its own name among them.
#[test]
fn a_command_is_the_program_of_its_name() {
    let names = programs::cli::front::names();
    assert!(names.len() >= 12);
    let said = |name: &str, arguments: &[&str]| {
        let output = program(name).args(arguments).output().expect("the binary was built");
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let help = said("fixed-step", &["--help"]);
    assert_eq!(help.0, Some(0));
    for name in names {
        assert!(help.1.lines().any(|line| line.trim_start().starts_with(name)), "{name} is not in the help");
        assert_eq!(said("fixed-step", &[name, "--help"]), said(name, &["--help"]), "{name}");
        let wrong = said("fixed-step", &[name, "--no-such-flag"]);
        assert_eq!((wrong.0, &wrong), (Some(2), &said(name, &["--no-such-flag"])), "{name}");
    }
    assert!(help.1.lines().all(|line| line.chars().count() <= 110), "{}", help.1);
}

// Fails if: options without a command are refused, or a command that is none is taken for the report.
#[test]
fn without_a_command_it_is_the_report() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let output = run("fixed-step", &["--quick", "--scene", "constant-force", "--method", "rk4"], directory.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(files(directory.path()).contains_key("index.html"));
    let list = program("fixed-step").arg("list").output().expect("the binary was built");
    assert!(text(&list.stdout).contains("torque-free-spin"));
    let wrong = program("fixed-step").arg("tradof").output().expect("the binary was built");
    assert_eq!(wrong.status.code(), Some(2));
    assert!(text(&wrong.stderr).contains("did you mean 'tradeoff'?"), "{}", text(&wrong.stderr));
}
