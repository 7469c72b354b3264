"""Makes the CSV files of this folder from a checkout of https://github.com/th533/Falling-Paper.

python3 extract.py PATH/TO/Falling-Paper      (needs numpy and scipy)
"""

import csv
import itertools
import sys
from pathlib import Path

import numpy as np
from scipy.io import loadmat
from scipy.signal import find_peaks

HERE = Path(__file__).parent
SOURCE = Path(sys.argv[1]) / "Classification"
RATE = 98.0  # frames a second, as in the authors' classifyBehaviour.m
GRAMMAGE, AIR, VISCOSITY = 0.070, 1.2754, 1.48e-5  # the authors' plotBehaviour.m
CLASSES = {1: "tumbling", 2: "chaotic", 3: "steady_or_periodic"}
SHAPES = ("circle", "hexagon")  # squares and crosses are a check that nothing is fitted to
# (shape, release, radius in mm) of which the first two falls in the authors' order are shipped whole.
EXCERPTS = [
    ("circle", "edge", 16), ("circle", "edge", 24), ("circle", "edge", 44),
    ("circle", "flat", 18), ("hexagon", "edge", 18), ("hexagon", "edge", 42),
]


def load(shape):
    name = shape.capitalize()
    read = lambda file: loadmat(SOURCE / f"{file}.mat", squeeze_me=True, struct_as_record=False)
    return read(f"data{name}")["data"], read(f"data{name}Classified"), read(f"humanClassification{name}")


def release(fall):
    return "edge" if fall.initialCondition else "flat"


def trimmed(fall):
    """Without what the authors leave out: the end, from where the last frame is lower than 5 cm."""
    track, areas = fall.trajectory, np.stack([fall.areaCam1, fall.areaCam2], axis=1)
    last = np.flatnonzero(track[:, 2] >= 0.05)[-1]
    return track[: last + 1], areas[: last + 1]


def parts(fall):
    """Segments of the authors' classifyBehaviour.m, as (first, one past the last) frame, zero based."""
    track, _ = trimmed(fall)
    away = np.hypot(track[:, 0], track[:, 1])
    limit = 0.2 * fall.radius if release(fall) == "flat" else 0.01
    cut = next((i for i in range(len(track) - 1) if away[i] >= limit), len(track) - 1)
    if release(fall) == "flat":
        if cut + 1 <= 2:
            return [(0, len(track))]
        found = [(0, cut + 1)]
    else:
        found = []
    return found + ([(cut, len(track))] if len(track) - cut - 1 > 10 else [])


def clear(fall):
    """First frame at which the whole paper has come out of the image mask around its holder, and the
    authors' moving average over five frames has forgotten the time before."""
    speed = 1.2 if release(fall) == "edge" else 0.55
    return int(np.ceil(2 * fall.radius * RATE / speed)) + 3


def i_star(shape, radius):
    """Moment of inertia about a diameter over ρ d⁵, as the authors define d; their hexagons have a mass of
    σ 3√3 s²/2 with s = 2r/√3, and the moment that a hexagon of circumradius r would have."""
    if shape == "circle":
        return np.pi * GRAMMAGE / (64 * AIR * 2 * radius)
    mass = 1.5 * np.sqrt(3) * (2 * radius / np.sqrt(3)) ** 2 * GRAMMAGE
    return mass * radius**2 / 6 * (2 + np.cos(np.pi / 3)) / (AIR * (2 * radius) ** 5)


def statistics(shape):
    data, automatic, human = load(shape)
    row = 0
    for index, fall in enumerate(data):
        for first, end in parts(fall):
            track, areas = (x[first:end] for x in trimmed(fall))
            steps = np.linalg.norm(np.diff(track, axis=0), axis=1)
            if np.any(steps > 0.1):
                continue  # as the authors do: the tracking jumped
            moved = track[-1] - track[0]
            time = len(track) / RATE
            got = [moved[0], moved[1], abs(moved[2]), steps.sum(), time]
            keys = ("dx", "dy", "dz", "pathLength", "time")
            assert np.allclose(got, [automatic[k][row] for k in keys], atol=1e-9), (shape, index)
            line = np.linspace(0, 1, len(track))[:, None] * moved
            off = track - track[0] - line
            across = np.sqrt(np.mean(np.sum(off[:, :2] ** 2, axis=1)))
            peaks = sum(len(find_peaks(areas[:, k])[0]) for k in (0, 1)) / (2 * time)
            yield [
                shape, index, release(fall), f"{fall.radius:.3f}", first, end - 1,
                CLASSES[int(automatic["behaviourAuto"][row])], CLASSES[int(human["behaviourHuman"][row])],
                f"{2 * fall.radius * got[2] / time / VISCOSITY:.0f}", f"{i_star(shape, fall.radius):.4f}",
                f"{time:.4f}", f"{got[2] / time:.4f}", f"{np.hypot(*moved[:2]) / time:.4f}",
                f"{got[3] / time:.4f}", f"{across:.4f}", f"{np.sqrt(np.mean(off[:, 2] ** 2)):.4f}",
                f"{np.std(np.diff(track[:, 2])) * RATE:.4f}", f"{peaks:.2f}",
            ]
            row += 1
    assert row == len(human["behaviourHuman"])


def divergence(one, other):
    """Seconds until two falls of the same paper are one diameter apart; the length of both if never."""
    a, b = (trimmed(f)[0][clear(f):] for f in (one, other))
    n = min(len(a), len(b))
    apart = np.linalg.norm((a[:n] - a[0]) - (b[:n] - b[0]), axis=1) > 2 * one.radius
    return (np.argmax(apart) if apart.any() else n) / RATE


def write(name, header, rows):
    with open(HERE / name, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header.split(","))
        writer.writerows(rows)


def main():
    write(
        "falls.csv",
        "shape,fall,release,radius_m,first_frame,last_frame,class_automatic,class_human,re,i_star,time_s,"
        "descent_mps,drift_mps,path_speed_mps,deviation_horizontal_m,deviation_vertical_m,"
        "descent_deviation_mps,area_peaks_hz",
        itertools.chain(*map(statistics, SHAPES)),
    )
    spread = []
    for shape, way in itertools.product(SHAPES, ("edge", "flat")):
        falls = [f for f in load(shape)[0] if release(f) == way]
        for low, high in ((0.015, 0.020), (0.021, 0.027), (0.028, 0.037), (0.038, 0.050)):
            # The radii are multiples of a millimeter: the margin is for their last digit.
            some = [f for f in falls if low - 1e-6 <= f.radius <= high + 1e-6]
            pairs = [p for p in itertools.combinations(some, 2) if abs(p[0].radius - p[1].radius) < 1e-6]
            times = [divergence(*p) for p in pairs]
            quartiles = [f"{q:.3f}" for q in np.percentile(times, [25, 50, 75])]
            spread.append([shape, way, low, high, len(times), *quartiles])
    header = "shape,release,radius_from_m,radius_to_m,pairs,divergence_quarter_s,divergence_half_s,"
    write("repeats.csv", header + "divergence_three_quarters_s", spread)
    for shape, way, radius in EXCERPTS:
        data = load(shape)[0]
        same = [i for i, f in enumerate(data) if release(f) == way and abs(f.radius - radius / 1e3) < 1e-6]
        for name, index in zip("ab", same):
            track, areas = trimmed(data[index])
            rows = [
                [f"{i / RATE:.5f}", *(f"{x:.4f}" for x in track[i]), *(f"{x:.0f}" for x in areas[i])]
                for i in range(clear(data[index]), len(track))
            ]
            print(shape, way, radius, name, index, len(rows))
            write(f"{shape}_{radius}mm_{way}_{name}.csv", "t_s,x_m,y_m,z_m,area1_px,area2_px", rows)


main()
