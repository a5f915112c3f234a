"""Time to accuracy of heyoka's adaptive Taylor integrator on the problems of this package.

    cargo run --release -- --csv ../../studies/measure/data/peers.csv
    cargo run --release -- --problems /tmp/problems.json
    python3 -m venv /tmp/peers && /tmp/peers/bin/pip install heyoka numpy
    /tmp/peers/bin/python with_heyoka.py /tmp/problems.json ../../studies/measure/data/peers.csv

The tolerance is searched as for the others: the largest from which on four smaller ones meet the error too. A run is timed
whole, with its call from Python (about a microsecond), the least and the median over many. Its rows replace those that the
table has of heyoka. F. Biscani, D. Izzo, Revisiting high-order Taylor methods for astrodynamics, MNRAS 504 (2021) 2614.
"""

import csv
import json
import statistics
import sys
import time

import heyoka as hy
import numpy as np

CONFIRMED = 4
ROUNDS = 400


def pendulum(problem):
    angle, rate = hy.make_vars("angle", "rate")
    return [(angle, rate), (rate, problem["minus_w0_squared"] * hy.sin(angle))]


def kepler(problem):
    x, y, vx, vy = hy.make_vars("x", "y", "vx", "vy")
    pull = problem["minus_mu"] * (x * x + y * y) ** -1.5
    return [(x, vx), (y, vy), (vx, pull * x), (vy, pull * y)]


def spin(problem):
    w, x, y, z, p, q, r = hy.make_vars("w", "x", "y", "z", "p", "q", "r")
    a, b, c = problem["ratios"]
    return [
        (w, -0.5 * (x * p + y * q + z * r)),
        (x, 0.5 * (w * p + y * r - z * q)),
        (y, 0.5 * (w * q + z * p - x * r)),
        (z, 0.5 * (w * r + x * q - y * p)),
        (p, a * q * r),
        (q, b * r * p),
        (r, c * p * q),
    ]


def distance(got, exact):
    """The larger error of the two halves."""
    half = len(exact) // 2
    return max(np.linalg.norm(got[:half] - exact[:half]), np.linalg.norm(got[half:] - exact[half:]))


def rotated(q, omega):
    w, v = q[0], q[1:]
    return omega + 2.0 * np.cross(v, np.cross(v, omega) + w * omega)


def spin_distance(got, exact):
    """Angle between the attitudes and difference of the angular velocities in the world frame."""
    a, b = got[:4] / np.linalg.norm(got[:4]), exact[:4] / np.linalg.norm(exact[:4])
    angle = 4.0 * np.arcsin(min(1.0, 0.5 * min(np.linalg.norm(a - b), np.linalg.norm(a + b))))
    return max(angle, np.linalg.norm(rotated(a, got[4:]) - rotated(b, exact[4:])))


SCENES = {
    "pendulum": (pendulum, distance),
    "kepler": (kepler, distance),
    "torque-free-spin": (spin, spin_distance),
}


def run(taylor, start, horizon_s):
    taylor.time = 0.0
    taylor.state[:] = start
    taylor.propagate_until(horizon_s)
    return taylor.state


def coarsest(candidates, asked):
    found, confirmed = None, 0
    for tolerance, (taylor, error) in candidates:
        if not error <= asked:
            found, confirmed = None, 0
            continue
        found = found or (tolerance, taylor, error)
        confirmed += 1
        if confirmed > CONFIRMED:
            return found
    return None


def timed(taylor, start, horizon_s):
    samples = []
    for _ in range(ROUNDS):
        begin = time.perf_counter_ns()
        for _ in range(10):
            run(taylor, start, horizon_s)
        samples.append((time.perf_counter_ns() - begin) / 10.0)
    return min(samples), statistics.median(samples)


def row(scene, template, ours, asked, met, times, horizon_s):
    tolerance, taylor, error = met
    least, median = (t / horizon_s for t in times)
    return template | {
        "comparison": "time-to-accuracy",
        "scene": scene,
        "system": "heyoka",
        "method": f"Taylor of order {taylor.order}, adaptive",
        "setting": f"tolerance {tolerance:.1e}",
        "horizon_s": horizon_s,
        "asked_error": asked,
        "error": error,
        "evaluations": "",
        "ns_per_simulated_second": float(f"{least:.3e}"),
        "median_ns_per_simulated_second": float(f"{median:.3e}"),
        "ratio_to_ours": float(f"{least / ours:.3e}") if ours else "",
        "note": "called from Python, in a process of its own",
    }


def measured(scene, problem, errors, rows):
    equations, error_of = SCENES[scene]
    start = np.array(problem["problem"]["start"])
    tolerances = [10.0 ** (-i / 4.0) for i in range(1, 63)]
    integrators = [hy.taylor_adaptive(equations(problem), list(start), tol=t) for t in tolerances]
    for end in problem["problem"]["ends"]:
        horizon_s, exact = end["horizon_s"], np.array(end["exact"])
        seen = [(i, error_of(np.array(run(i, start, horizon_s)), exact)) for i in integrators]
        for asked in errors:
            met = coarsest(zip(tolerances, seen), asked)
            if met is None:
                print(f"{scene}: heyoka does not meet {asked:g}")
                continue
            ours = [
                float(r["ns_per_simulated_second"])
                for r in rows
                if r["comparison"] == "time-to-accuracy" and r["scene"] == scene and r["system"] == "integrator"
                and float(r["horizon_s"]) == horizon_s and float(r["asked_error"]) == asked
            ]
            least = min(ours, default=None)
            new = row(scene, rows[0], least, asked, met, timed(met[1], start, horizon_s), horizon_s)
            print(f"{scene} {asked:g} after {horizon_s} s: {new['method']}, {new['setting']}, error {new['error']:.1e}, "
                  f"{new['ns_per_simulated_second']:.1f} ns/s, {new['ratio_to_ours']} of ours")
            yield new


def main(problems, table):
    with open(problems) as file:
        problems = json.load(file)
    with open(table, newline="") as file:
        rows = [r for r in csv.DictReader(file) if r["system"] != "heyoka"]
    new = [r for scene in SCENES for r in measured(scene, problems[scene], problems["errors"], rows)]
    with open(table, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows + new)


if __name__ == "__main__":
    main(*sys.argv[1:])
