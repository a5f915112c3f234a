//! Files as programs write them, and files that are broken: what is read, and where an error points.

use std::path::PathBuf;

use audit::read::names::Role;
use audit::{Choices, Trajectory, load};

/// A body that turns about a fixed axis and moves in a circle: enough to decide every reading.
fn rows(write: impl Fn(usize, f64, [f64; 4], [f64; 3]) -> String) -> String {
    (0..40)
        .map(|i| {
            let t = i as f64 * 0.05;
            // A precession about z with a spin about the body's z: the body axes and the world axes differ.
            let (a, b) = (0.35 * t, 0.6 * t);
            let (tilt, cos, sin) = (0.4_f64, 0.4_f64.cos(), 0.4_f64.sin());
            let _ = tilt;
            let q = [(a + b).cos() * cos, (a - b).cos() * sin, (a - b).sin() * sin, (a + b).sin() * cos];
            // omega in the world: 0.7 z + 1.2 R z.
            let z = [
                2.0 * (q[1] * q[3] + q[0] * q[2]),
                2.0 * (q[2] * q[3] - q[0] * q[1]),
                1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]),
            ];
            write(i, t, q, [1.2 * z[0], 1.2 * z[1], 0.7 + 1.2 * z[2]]) + "\n"
        })
        .collect()
}

fn read(text: &str) -> Result<Trajectory, String> {
    let dir = tempfile::tempdir().expect("a temporary directory");
    let path: PathBuf = dir.path().join("run.csv");
    std::fs::write(&path, text).expect("written");
    load(&path, &Choices::default()).map_err(|e| e.to_string().replace(&format!("{}:", path.display()), ""))
}

/// The attitude and the world's angular velocity of row 20, however they were written.
fn check(name: &str, text: &str) {
    let t = read(text).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!(t.rows(), 40, "{name}");
    assert!((t.time[20] - t.time[0] - 1.0).abs() < 1e-6, "{name}: {}", t.time[20]);
    let q = t.attitude.as_ref().unwrap_or_else(|| panic!("{name}: no attitude")).at(20);
    let expected = [
        0.95_f64.cos() * 0.4_f64.cos(),
        0.25_f64.cos() * 0.4_f64.sin(),
        -(0.25_f64.sin()) * 0.4_f64.sin(),
        0.95_f64.sin() * 0.4_f64.cos(),
    ];
    let off = q.angle_to(integrator::Rotation::from_wxyz(expected));
    assert!(off < 1e-5, "{name}: attitude off by {off}, read as {:?}", t.recognised);
    if let Some(w) = t.omega_world(20) {
        // 0.7 z + 1.2 R z has the norm sqrt(0.7^2 + 1.2^2 + 2 0.7 1.2 cos 0.8).
        let norm = (0.49 + 1.44 + 1.68 * 0.8_f64.cos()).sqrt();
        assert!((w.norm() - norm).abs() < 1e-5 && w.z > 1.5, "{name}: omega {w:?}");
    }
    assert!(t.ties.is_empty(), "{name}: {:?}", t.ties);
}

// Fails if a separator, a comment mark, a name, an order, a frame or a unit is not understood.
#[test]
fn files_are_read_as_programs_write_them() {
    let wxyz = |sep: &'static str| {
        move |_: usize, t: f64, q: [f64; 4], w: [f64; 3]| {
            [t, q[0], q[1], q[2], q[3], w[0], w[1], w[2]].map(|x| format!("{x:?}")).join(sep)
        }
    };
    let header = "time,q_w,q_x,q_y,q_z,wx,wy,wz\n";
    check("plain", &format!("{header}{}", rows(wxyz(","))));
    check("BOM and CRLF", &format!("\u{feff}{header}{}", rows(wxyz(","))).replace('\n', "\r\n"));
    check(
        "tabs and comments",
        &format!("# made by hand\n% x\n// y\n{}{}", header.replace(',', "\t"), rows(wxyz("\t"))),
    );
    check(
        "blanks, padded",
        &format!("# {}{}", header.replace(',', " "), rows(|i, t, q, w| format!("  {}  ", wxyz("   ")(i, t, q, w)))),
    );
    check(
        "decimal comma",
        &format!("{}{}", header.replace(',', ";"), rows(|i, t, q, w| wxyz(";")(i, t, q, w).replace('.', ","))),
    );
    check("trailing delimiter", &format!("{header}{}", rows(|i, t, q, w| wxyz(",")(i, t, q, w) + ",")));
    check("leading index", &format!(",{header}{}", rows(|i, t, q, w| format!("{i},{}", wxyz(",")(i, t, q, w)))));
    check("units below", &format!("{header}s,-,-,-,-,rad/s,rad/s,rad/s\n{}", rows(wxyz(","))));
    check("no header", &rows(wxyz(",")));
    check("quoted", &format!("{header}{}", rows(|i, t, q, w| format!("\"{}\"", wxyz("\",\"")(i, t, q, w)))));
    let ns = |i: usize, _: f64, q: [f64; 4], w: [f64; 3]| {
        let stamp = 1_403_636_580_838_555_648_i64 + i as i64 * 50_000_000;
        format!("{stamp},{:?},{:?},{:?},{:?},{:?},{:?},{:?}", q[0], q[1], q[2], q[3], w[0], w[1], w[2])
    };
    check(
        "EuRoC stamps",
        &format!(
            "#timestamp [ns], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], w_x [rad s^-1], w_y [rad s^-1], w_z [rad s^-1]\n{}",
            rows(ns)
        ),
    );
    let xyzw = |_: usize, t: f64, q: [f64; 4], w: [f64; 3]| {
        let d = 180.0 / std::f64::consts::PI;
        format!("{},{:?},{:?},{:?},{:?},{:?},{:?},{:?}", t * 1e3, q[1], q[2], q[3], q[0], w[0] * d, w[1] * d, w[2] * d)
    };
    check(
        "ms, open order, deg/s",
        &format!("t_ms,q0,q1,q2,q3,angVelX_deg_s,angVelY_deg_s,angVelZ_deg_s\n{}", rows(xyzw)),
    );
    let mrp = |_: usize, t: f64, q: [f64; 4], w: [f64; 3]| {
        let s = |i: usize| q[i] / (1.0 + q[0]);
        format!("{t:?},{:?},{:?},{:?},{:?},{:?},{:?}", s(1), s(2), s(3), w[0], w[1], w[2])
    };
    check("MRP", &format!("t,sigma_BN_1,sigma_BN_2,sigma_BN_3,omega_1,omega_2,omega_3\n{}", rows(mrp)));
    let matrix = |transposed: bool| {
        move |_: usize, t: f64, q: [f64; 4], w: [f64; 3]| {
            let r = integrator::Rotation::from_wxyz(q).matrix();
            let r = if transposed { r } else { r.transpose() };
            // nalgebra stores columns: the transpose's columns are the rows.
            let cells: Vec<String> = r.iter().chain(w.iter()).map(|x| format!("{x:?}")).collect();
            format!("{t:?},{}", cells.join(","))
        }
    };
    let names = "t,r11,r12,r13,r21,r22,r23,r31,r32,r33,wx,wy,wz\n";
    check("matrix", &format!("{names}{}", rows(matrix(false))));
    check("matrix, transposed", &format!("{names}{}", rows(matrix(true))));
}

// Fails if a stamp in ns is parsed through f64, which holds 256 ns apart there.
#[test]
fn stamps_in_ns_keep_their_last_digit() {
    let stamp = |i: i64| 1_403_636_580_838_555_648_i64 + 50_000_001 * i;
    let text: String = (0..20).map(|i| format!("{},{},{}\n", stamp(i), i, 2 * i)).collect();
    let t = read(&format!("#timestamp,x,y\n{text}")).expect("read");
    assert!((t.time[19] - 19.0 * 0.050000001).abs() < 1e-12, "{}", t.time[19]);
}

// Fails if TUM's order (scalar last) is lost where nothing in the file can decide it.
#[test]
fn eight_columns_without_names_are_tum() {
    let text: String = (0..20)
        .map(|i| format!("{} {} 0.5 -1 0 0 {} {}\n", i, 2 * i, (0.1 * f64::from(i)).sin(), (0.1 * f64::from(i)).cos()))
        .collect();
    let t = read(&text).expect("read");
    let q = t.attitude.expect("attitude").at(3);
    assert!((q.w - 0.3_f64.cos()).abs() < 1e-12 && (q.v.z - 0.3_f64.sin()).abs() < 1e-12);
    assert!(t.recognised.iter().any(|r| r.role == Role::Position));
}

// Fails if a broken file is read, or its error points elsewhere.
#[test]
fn broken_files_are_refused_with_their_place() {
    let long = "1".repeat(3 << 20);
    let cases: [(&str, String, &str); 9] = [
        ("empty", String::new(), "1:1: the file is empty"),
        ("NaN", "t,x,y\n0,1,2\n1,nan,3\n".to_owned(), "3:2: 'nan' in 'x': the run is not finite from here on"),
        ("too few", "t,x,y\n0,1,2\n1,4\n".to_owned(), "3:2: the row has 2 cells"),
        ("too many", "t,x,y\n0,1,2\n1,4,5,6\n".to_owned(), "3:4: '6' is one cell more"),
        ("cut", "t,x,y\n0,1,2\n1,4,5\n2,7".to_owned(), "4:2: the row has 2 cells"),
        ("text", "t,x,y\n0,1,2\n1,left,5\n".to_owned(), "3:2: 'left' in 'x' is no number"),
        ("empty cell", "t,x,y\n0,1,2\n1,,5\n".to_owned(), "3:2: the cell of 'x' is empty"),
        ("long line", format!("t,x\n0,1\n{long}\n"), "3:1: the line is longer"),
        ("no names", "alpha_1,beta_2\n0,1\n1,2\n".to_owned(), "no position, attitude or angle"),
    ];
    for (name, text, expected) in cases {
        let error = read(&text).err().unwrap_or_else(|| panic!("{name}: read"));
        assert!(error.contains(expected), "{name}: {error}");
    }
    assert!(read("\u{0}\u{1}\u{2}\u{3}").err().is_some_and(|e| e.contains("binary")));
}
