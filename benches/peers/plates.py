"""MuJoCo's ellipsoid fluid model on the falling plates of Andersen, Pesavento & Wang (2005).

    pip install -r requirements.txt
    python plates.py              # falls, about a minute; writes plates.json and prints Markdown
    python plates.py --cost       # nanoseconds per body and step, with and without fluid

Aluminium plates 0.81 mm thick in water, released from rest at six angles; regime, drift, descent and spin
over the last two thirds of 7 s. The model has no buoyancy: gravity is reduced by 1 - 1000/2700 instead,
which gives the plate its weight in water.
"""

import argparse
import json
import math
import time
from pathlib import Path

import mujoco
import numpy as np

WATER, VISCOSITY, ALUMINIUM = 1000.0, 0.89e-6, 2700.0
THICKNESS, SPAN, GRAVITY = 0.81e-3, 0.19, 9.81
SECONDS = 7.0
SLENDERNESS = (8, 10, 14)
ANGLES = (5, 15, 30, 45, 60, 80)
RUNS = (("implicitfast", 1 / 60), ("implicitfast", 1 / 240), ("implicitfast", 1e-3), ("Euler", 1 / 240))
MEASURED = {
    8: "tumbling, drift 15.9 cm/s, descent 11.5 cm/s, spin 14.5 rad/s",
    10: "chaotic",
    14: "fluttering, descent 9.0 cm/s",
}


def model(slenderness, integrator, dt, count=1, fluid=True):
    """Plates with the chord along x, the span along y and the normal along z."""
    half = (0.5 * slenderness * THICKNESS, 0.5 * SPAN, 0.5 * THICKNESS)
    size = " ".join(map(str, half))
    body = (
        '<body pos="{x} 0 0"><freejoint/><geom type="box" size="{size}" density="{density}" '
        'contype="0" conaffinity="0" fluidshape="ellipsoid"/></body>'
    )
    bodies = "".join(body.format(x=i, size=size, density=ALUMINIUM) for i in range(count))
    density, viscosity = (WATER, WATER * VISCOSITY) if fluid else (0, 0)
    gravity = GRAVITY * (1 - WATER / ALUMINIUM)
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option gravity="0 0 {-gravity}" timestep="{dt}" integrator="{integrator}" '
        f'density="{density}" viscosity="{viscosity}"/><worldbody>{bodies}</worldbody></mujoco>'
    )


def fall(slenderness, integrator, dt, degrees):
    """One fall from rest, tilted about the span."""
    plate = model(slenderness, integrator, dt)
    data = mujoco.MjData(plate)
    half = math.radians(degrees) / 2
    data.qpos[3:7] = (math.cos(half), 0, math.sin(half), 0)
    steps = round(SECONDS / dt)
    begin, angle, angles, start = steps // 3, 0.0, [], None
    for step in range(steps):
        if step == begin:
            start = data.qpos[:3].copy()
        mujoco.mj_step(plate, data)
        # The wreck of a run that blows up is reset by the engine, with a warning.
        blown = any(w.number for w in data.warning) or np.abs(data.qvel[:3]).max() > 10
        if blown or not np.isfinite(data.qpos).all():
            return {"regime": "blows up", "at": step * dt}
        if step >= begin:
            angle += data.qvel[4] * dt
            angles.append(angle)
    way = (data.qpos[:3] - start) / (dt * (steps - begin))
    turns, reversals = count(np.array(angles))
    if reversals == 0 and turns >= 1:
        regime = "tumbling"
    elif turns == 0:
        regime = "fluttering" if reversals > 1 else "steady"
    else:
        regime = "chaotic"
    return {
        "regime": regime,
        "half_turns": turns,
        "reversals": reversals,
        "drift": float(abs(way[0])),
        "descent": float(-way[2]),
        "spin": float(abs(angles[-1]) / (dt * (steps - begin))),
    }


def count(angles):
    """Half turns made in one go, and how often the rotation turns back by more than 0.2 rad."""
    turns = reversals = 0
    side = extreme = start = angles[0]
    direction = 0
    for angle in angles:
        if direction == 0:
            if abs(angle - start) > 0.2:
                direction, extreme = np.sign(angle - start), angle
        elif (angle - extreme) * direction > 0:
            extreme = angle
        elif (extreme - angle) * direction > 0.2:
            # A swing of a flutter may pass the vertical, but not by half a turn more.
            turns += max(0, int((abs(extreme - side) - math.pi / 2) // math.pi))
            reversals += 1
            direction, side, extreme = -direction, extreme, angle
    turns += int(abs(extreme - side) // math.pi) if reversals == 0 else 0
    return turns, reversals


def falls():
    table = []
    for slenderness in SLENDERNESS:
        for integrator, dt in RUNS:
            runs = [fall(slenderness, integrator, dt, angle) for angle in ANGLES]
            table.append(
                {"beta": f"1/{slenderness}", "integrator": integrator, "dt": dt, "runs": runs}
            )
    return table


def markdown(table):
    lines = [
        "| plate β | measured | integrator, dt | regimes over the six releases | drift, cm/s "
        "| descent, cm/s | spin, rad/s |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in table:
        alive = [run for run in row["runs"] if "descent" in run]
        regimes = [run["regime"] for run in row["runs"]]
        seen = ", ".join(f"{regimes.count(r)} {r}" for r in sorted(set(regimes)))

        def median(key, scale):
            return f"{scale * np.median([run[key] for run in alive]):.1f}" if alive else "–"

        cells = (
            row["beta"],
            MEASURED[int(row["beta"][2:])],
            f"{row['integrator']}, 1/{1 / row['dt']:.0f} s",
            seen,
            median("drift", 100),
            median("descent", 100),
            median("spin", 1),
        )
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def cost(count=1000, rounds=15):
    """Median and least nanoseconds per body and step, with and without fluid in turns."""
    for integrator in ("Euler", "implicitfast", "RK4"):
        # Fine steps, so that no plate of the explicit integrator blows up while it is timed.
        models = [model(14, integrator, 1e-4, count, fluid) for fluid in (False, True)]
        times = ([], [])
        for _ in range(rounds):
            for plates, seen in zip(models, times):
                data = mujoco.MjData(plates)
                random = np.random.default_rng(1)
                data.qvel[:] = random.normal(size=plates.nv) * np.tile([0.1] * 3 + [5] * 3, count)
                mujoco.mj_step(plates, data, 5)
                begin = time.perf_counter()
                mujoco.mj_step(plates, data, 20)
                seen.append((time.perf_counter() - begin) / (20 * count) * 1e9)
        dry, wet = (np.array(seen) for seen in times)
        ratio = np.median(wet / dry)
        print(
            f"| {integrator} | {np.median(dry):.0f} ({dry.min():.0f}) | "
            f"{np.median(wet):.0f} ({wet.min():.0f}) | {np.median(wet - dry):.0f} | {ratio:.2f} |"
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cost", action="store_true", help="time steps instead of dropping plates")
    arguments = parser.parse_args()
    if arguments.cost:
        print("| integrator | dry, ns | in water, ns | difference, ns | ratio |\n|---|---|---|---|---|")
        cost()
    else:
        table = falls()
        Path(__file__).with_name("plates.json").write_text(json.dumps(table, indent=1) + "\n")
        print(markdown(table))
