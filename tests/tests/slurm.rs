//! A run in shards on a real Slurm, on one machine: `cargo test ... --test slurm -- --ignored`, as root, with Debian's packages slurmctld,
//! slurmd, slurm-client and munge.

use std::fs;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use verification::programs::{assert_same, directory, files, run, text, untimed};

/// A Slurm of one node that lives as long as this.
struct Slurm {
    root: PathBuf,
    daemons: Vec<Child>,
}

impl Slurm {
    fn start(root: &Path) -> Self {
        for name in ["ctld", "d", "log"] {
            fs::create_dir_all(root.join(name)).expect("writable");
        }
        let at = |name: &str| root.join(name).display().to_string();
        let cpus = std::thread::available_parallelism().map_or(1, usize::from);
        let conf = format!(
            "ClusterName=trial\nSlurmctldHost=localhost\nAuthType=auth/munge\nSlurmUser=root\nSlurmdUser=root\n\
             StateSaveLocation={}\nSlurmdSpoolDir={}\nSlurmctldPidFile={}\nSlurmdPidFile={}\nSlurmctldLogFile={}\n\
             SlurmdLogFile={}\nProctrackType=proctrack/pgid\nTaskPlugin=task/none\nSelectType=select/cons_tres\n\
             SelectTypeParameters=CR_Core\nReturnToService=2\nMpiDefault=none\nNodeName=localhost CPUs={cpus} State=UNKNOWN\n\
             PartitionName=all Nodes=localhost Default=YES MaxTime=INFINITE State=UP\n",
            at("ctld"),
            at("d"),
            at("ctld.pid"),
            at("d.pid"),
            at("log/ctld.log"),
            at("log/d.log"),
        );
        fs::write(root.join("slurm.conf"), conf).expect("writable");
        let mut daemons = Vec::new();
        daemons.extend(munge());
        let mut slurm = Slurm { root: root.to_owned(), daemons };
        for (daemon, more) in [("slurmctld", &["-D"][..]), ("slurmd", &["-D", "-N", "localhost"])] {
            let child = slurm.command(daemon).args(more).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
            slurm.daemons.push(child.unwrap_or_else(|error| panic!("{daemon}: {error}; install it")));
        }
        slurm.wait_for("a node that is idle", || slurm.said("sinfo", &["-h", "-o", "%T"]).contains("idle"));
        slurm
    }

    fn command(&self, name: &str) -> Command {
        let mut command = Command::new(name);
        command.env("SLURM_CONF", self.root.join("slurm.conf")).env("FIXED_STEP", directory().join("fixed-step"));
        command.env("PATH", format!("/usr/sbin:/sbin:{}", std::env::var("PATH").unwrap_or_default()));
        command
    }

    fn said(&self, name: &str, arguments: &[&str]) -> String {
        let output = self.command(name).args(arguments).output().unwrap_or_else(|error| panic!("{name}: {error}"));
        text(&output.stdout) + &text(&output.stderr)
    }

    fn wait_for(&self, what: &str, is_there: impl Fn() -> bool) {
        let start = Instant::now();
        while !is_there() {
            let log = |name: &str| fs::read_to_string(self.root.join("log").join(name)).unwrap_or_default();
            assert!(start.elapsed() < Duration::from_secs(120), "no {what}\n{}\n{}", log("ctld.log"), log("d.log"));
            std::thread::sleep(Duration::from_millis(200));
        }
    }
}

/// Munge, which has a directory and a user of its own; nothing where it runs already.
fn munge() -> Option<Child> {
    let is_running = Command::new("pgrep").args(["-x", "munged"]).stdout(Stdio::null()).status();
    if is_running.is_ok_and(|status| status.success()) {
        return None;
    }
    let id = |flag: &str| {
        let output = Command::new("id").args([flag, "munge"]).output().expect("id is everywhere");
        text(&output.stdout).trim().parse::<u32>().expect("the package munge makes a user munge: install it")
    };
    fs::create_dir_all("/run/munge").expect("root may write here");
    std::os::unix::fs::chown("/run/munge", Some(id("-u")), Some(id("-g"))).expect("root may");
    let mut command = Command::new("/usr/sbin/munged");
    command.args(["--foreground", "--force"]).uid(id("-u")).gid(id("-g")).stdout(Stdio::null()).stderr(Stdio::null());
    Some(command.spawn().expect("the package munge is installed"))
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for daemon in &mut self.daemons {
            // The end of the test is not disturbed by a daemon that is gone.
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

// Fails if: the script gives a task another part, the merge does not wait, or a part that was killed and run again changes a byte.
#[test]
#[ignore = "needs Slurm's packages and root; .ci/run calls it"]
fn an_array_job_and_its_merge_give_the_bytes_of_one_run() {
    let root = tempfile::tempdir().expect("a temporary directory");
    let slurm = Slurm::start(&root.path().join("slurm"));
    let plan = ["--quick", "--scene", "oscillator", "--method", "rk4", "--method", "semi-implicit-euler"];
    let whole = root.path().join("whole");
    run("report", &[&plan[..], &["--quiet"]].concat(), &whole);
    let out = root.path().join("out");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/cluster/slurm.sbatch");
    let (script, target) = (script.display().to_string(), out.display().to_string());
    let submitted = slurm.said(&script, &[&["submit", "4", &target, "report"], &plan[..]].concat());
    assert!(submitted.contains("merge: job"), "{submitted}");
    let is_done = || slurm.said("squeue", &["-h"]).trim().is_empty();
    slurm.wait_for("end of the jobs", is_done);
    assert_same(&untimed(files(&out)), &untimed(files(&whole)));

    // A task is killed in the middle of a longer run, and submitted again.
    let longer = ["--scene", "kepler", "--scene", "heavy-top", "--precision", "f64"];
    let (again, one) = (root.path().join("again"), root.path().join("one"));
    run("convergence", &[&longer[..], &["--quiet"]].concat(), &one);
    let target = again.display().to_string();
    let submitted = slurm.said(&script, &[&["submit", "2", &target, "convergence"], &longer[..]].concat());
    let array = submitted.split("job ").nth(1).and_then(|rest| rest.split(';').next()).expect("a number").to_owned();
    slurm.wait_for("task that runs", || {
        slurm.said("squeue", &["-h", "-t", "R", "-o", "%i"]).contains(&format!("{array}_"))
    });
    slurm.said("scancel", &["--signal=KILL", &format!("{array}_2")]);
    slurm.said("scancel", &[&format!("{array}_2")]);
    slurm.wait_for("end of the tasks", || !slurm.said("squeue", &["-h", "-o", "%i"]).contains(&format!("{array}_")));
    // The merge waits for a task that will not end well.
    slurm.said("scancel", &["--state=PENDING"]);
    slurm.wait_for("end of the jobs", is_done);
    let part = again.with_extension("shards").join("2");
    let was_killed = !part.join("manifest.json").exists();
    assert!(was_killed, "the task had finished before it was killed: give it a longer run");
    let alone = ["--parsable", "--array=2", "--output=/dev/null", &script, "task", "2", &target, "convergence"];
    slurm.said("sbatch", &[&alone[..], &longer[..]].concat());
    slurm.wait_for("end of the jobs", is_done);
    let merged = slurm.said(&script, &["merge", "2", &target, "convergence"]);
    assert!(again.join("manifest.json").exists(), "{merged}");
    assert_same(&untimed(files(&again)), &untimed(files(&one)));
}
