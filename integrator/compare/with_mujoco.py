"""What a step of a free body costs in MuJoCo: the whole pipeline, without geometry.

    /tmp/peers/bin/pip install mujoco
    /tmp/peers/bin/python with_mujoco.py ../../studies/measure/data/peers.csv

The steps are taken inside one call, so that Python is not in the measurement. Its rows replace those that the table has of
MuJoCo. Its Euler is semi-implicit, with the gyroscopic term evaluated at the old velocity.
"""

import csv
import statistics
import sys
import time

import mujoco

STEP_S = 2.0**-10
STEPS = 1000
ROUNDS = 200

MODEL = """
<mujoco>
  <option timestep="{step}" gravity="0 0 0" integrator="{integrator}"/>
  <worldbody>
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="1" diaginertia="1.25 0.75 1.75"/>
    </body>
  </worldbody>
</mujoco>
"""


def measured(integrator):
    model = mujoco.MjModel.from_xml_string(MODEL.format(step=STEP_S, integrator=integrator))
    data = mujoco.MjData(model)
    data.qvel[:] = [0.5, -0.25, 0.75, 1.5, -0.75, 1.0]
    samples = []
    for _ in range(ROUNDS):
        begin = time.perf_counter_ns()
        mujoco.mj_step(model, data, nstep=STEPS)
        samples.append((time.perf_counter_ns() - begin) / STEPS)
    return min(samples), statistics.median(samples)


def row(integrator, template, ours):
    least, median = (t / STEP_S for t in measured(integrator))
    print(f"MuJoCo {integrator}: {least * STEP_S:.0f} ns a step, {least / ours:.1f} of ours")
    return template | {
        "comparison": "free-body",
        "scene": "torque-free-spin",
        "system": "MuJoCo",
        "method": integrator,
        "setting": "step 2^-10 s, 1 bodies",
        "asked_error": "",
        "error": "",
        "evaluations": "",
        "ns_per_simulated_second": float(f"{least:.3e}"),
        "median_ns_per_simulated_second": float(f"{median:.3e}"),
        "ratio_to_ours": float(f"{least / ours:.3e}"),
        "note": "what a user pays: the whole pipeline, without geometry; in a process of its own",
    }


def main(table):
    with open(table, newline="") as file:
        rows = [r for r in csv.DictReader(file) if r["system"] != "MuJoCo"]
    template = next(r for r in rows if r["comparison"] == "free-body" and r["system"] == "integrator")
    ours = float(template["ns_per_simulated_second"])
    new = [row(integrator, template, ours) for integrator in ("Euler", "implicitfast", "RK4")]
    with open(table, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows + new)


if __name__ == "__main__":
    main(*sys.argv[1:])
