"""Runs a free body in MuJoCo and prints a trajectory as CSV.

    python run.py case.json --rate 60 --for 2 --integrator Euler > mujoco.csv

case.json is what `exact --scene torque-free-spin --case` prints.
"""

import argparse
import json

import mujoco

MODEL = """
<mujoco>
  <option timestep="{step!r}" gravity="0 0 0" integrator="{integrator}"/>
  <worldbody>
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="1" diaginertia="{a!r} {b!r} {c!r}"/>
    </body>
  </worldbody>
</mujoco>
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("--rate", type=int, default=60, help="steps in a second")
    parser.add_argument("--for", type=float, default=2.0, dest="length", help="length of the run, s")
    parser.add_argument("--integrator", default="Euler", choices=["Euler", "RK4", "implicit", "implicitfast"])
    flags = parser.parse_args()

    with open(flags.case, encoding="utf-8") as file:
        case = json.load(file)
    inertia = next((p["value"] for p in case["parameters"] if p["name"] == "inertia"), None)
    start = case["start"]
    if inertia is None or "qw" not in start or case["scene"].split("/")[0] not in ("torque-free-spin", "tennis-racket"):
        raise SystemExit(f"{flags.case}: scene {case['scene']}: give a free body: torque-free-spin or tennis-racket")

    a, b, c = inertia
    text = MODEL.format(step=1.0 / flags.rate, integrator=flags.integrator, a=a, b=b, c=c)
    model = mujoco.MjModel.from_xml_string(text)
    # The compiler sorts the principal moments and turns the frame of inertia with them. Set them as they are given.
    model.body_inertia[1] = inertia
    model.body_iquat[1] = [1.0, 0.0, 0.0, 0.0]
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    data.qpos[3:7] = [start[name] for name in ("qw", "qx", "qy", "qz")]
    data.qvel[3:6] = [start[f"omega_body_{axis}_rad_s"] for axis in "xyz"]

    print("t,qw,qx,qy,qz,wx_body,wy_body,wz_body")
    for i in range(round(flags.length * flags.rate) + 1):
        # qpos and qvel are of the same time after a step; xquat is that of the step before.
        print(i / flags.rate, *(repr(float(x)) for x in (*data.qpos[3:7], *data.qvel[3:6])), sep=",")
        mujoco.mj_step(model, data)


main()
