"""Whether the playtest tells planted faults from harmless look-alikes, and how fast it is.

    python -m benchmarks.playtest_faults [--seed 1] [--count 40] [--bots 8] [--seconds 60] [--json FILE]
    python -m benchmarks.playtest_faults --courtyard | --dungeon | --large "city 2" "city 4"

Forty halls with one fault each, and forty with something that only looks like one, at random sizes, places
and angles (`benchmarks.planted_rooms`). A fault is found if it is the only failure, with its kind, within 0.5
m of its place, and measured within 5 cm (slopes: 1 degree); a look-alike holds if nothing fails. With
--courtyard twenty faults are planted in our courtyard, one at a time. With --dungeon 64 bots play Recast's
dungeon for 300 s each, in 1 and in 2 processes, and the reports are compared. With --large one bot plays
levels of `benchmarks.large_levels` for 5 s; printed are the processor times of the playtest and of its page,
and what was found, with a digest of the report.
"""

import argparse
import hashlib
import json
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import shapely
import trimesh

from benchmarks.large_levels import large_level
from benchmarks.planted_rooms import FAULTS, LOOK_ALIKES, Hall, planted
from benchmarks.shared_data import level_path, shared_folder, why_absent
from runtime.playtest import Fault, playtest
from runtime.playtest.page import write_page

COURTYARD = Path(__file__).resolve().parents[1] / "examples" / "levels" / "courtyard.obj"
IN_PLACE = 0.5
"""[m] from a planted fault that a finding may lie."""
EXACT_LENGTH = 0.05
"""[m] that a finding may measure too much or too little."""
EXACT = {"steep": 1.0}
"""[°] the same, for slopes."""
NEAR = 1.5
"""[m] beyond the edges of a planted fault that a finding may lie."""

Rectangle = tuple[float, float, float, float]  # x0, x1, y0, y1
Edit = Callable[[trimesh.Trimesh], trimesh.Trimesh]


@dataclass(frozen=True)
class Plant:
    """A fault to plant: the kind that must be reported, where, and how it is made."""

    kind: str
    where: Rectangle
    edit: Edit

    def is_found_as(self, fault: Fault) -> bool:
        """Whether ``fault`` is this one."""
        x0, x1, y0, y1 = self.where
        x, y, _ = fault.position
        return fault.kind == self.kind and x0 - NEAR <= x <= x1 + NEAR and y0 - NEAR <= y <= y1 + NEAR


def plants() -> list[Plant]:
    """The twenty."""
    room, corner = (52.0, 57.0, 25.0, 29.0), (0.4, 4.3, 35.0, 39.6)
    yard = (36.8, 41.2, 31.8, 35.4)
    lane_door = (1.8, 2.5, 18.8, 19.2)
    holes = [((20.5, 21.5, 26.0, 27.0), 0.0), ((40.0, 41.0, 3.0, 4.0), 0.3), ((37.5, 39.0, 26.0, 27.5), 0.0)]
    gardens = [
        ((44.6, 51.0, 22.0, 28.0), 1.5),
        ((6.0, 22.0, 19.4, 21.8), 1.2),
        ((36.8, 41.6, 23.5, 31.0), 1.0),
    ]
    pits = [
        ((53.0, 55.5, 30.0, 32.5), 0.0, 1.2),
        ((38.0, 40.5, 20.0, 22.5), 0.0, 1.9),
        ((45.0, 47.5, 8.0, 10.5), 0.3, 1.3),
    ]
    platforms = [
        ((37.0, 40.0, 32.0, 35.0), 0.0, 0.94),
        ((53.0, 56.0, 25.0, 28.0), 0.0, 1.1),
        ((28.5, 31.5, 27.0, 31.0), 0.45, 1.45),
    ]
    flights = [((53.0, 56.0, 25.0, 28.0), 0.25), ((37.5, 40.5, 32.0, 35.0), 0.22)]
    across = (46.0, 46.3, 36.0, 39.6)
    return [
        *(Plant("hole", at, partial(cut, at=at, z=z)) for at, z in holes),
        Plant("walled_off", room, partial(boxes, solids=walls(room))),
        Plant("walled_off", across, partial(boxes, solids=[(*across, 0.0, 6.0)])),
        Plant("walled_off", corner, partial(boxes, solids=walls(corner))),
        *(Plant("one_way", at, partial(pit, at=at, z=0.0, deep=deep)) for at, deep in gardens),
        *(Plant("trap", at, partial(pit, at=at, z=z, deep=deep)) for at, z, deep in pits),
        Plant("narrow", lane_door, partial(boxes, solids=[(*lane_door, 0.0, 2.4)])),
        Plant("narrow", room, partial(boxes, solids=walls(room, door=0.45))),
        Plant("narrow", yard, partial(boxes, solids=walls(yard, door=0.4))),
        *(Plant("ledge", at, partial(boxes, solids=[(*at, low, high)])) for at, low, high in platforms),
        *(Plant("step", at, partial(boxes, solids=stairs(at, rise))) for at, rise in flights),
    ]


def boxes(mesh: trimesh.Trimesh, solids: Sequence[tuple[float, ...]]) -> trimesh.Trimesh:
    """``mesh`` with solid boxes (x0, x1, y0, y1, z0, z1) in it."""
    made = [trimesh.creation.box(bounds=np.array(each).reshape(3, 2).T) for each in solids]
    return trimesh.util.concatenate([mesh, *made])


def walls(at: Rectangle, door: float = 0.0, thick: float = 0.3, high: float = 3.2) -> list[tuple[float, ...]]:
    """The four walls of a room, with a door [m] in the western one."""
    x0, x1, y0, y1 = at
    middle = 0.5 * (y0 + y1)
    west = [(x0, x0 + thick, y0, middle - 0.5 * door), (x0, x0 + thick, middle + 0.5 * door, y1)]
    others = [(x1 - thick, x1, y0, y1), (x0, x1, y0, y0 + thick), (x0, x1, y1 - thick, y1)]
    return [(*each, 0.0, high) for each in west + others]


def stairs(at: Rectangle, rise: float, tread: float = 0.3, high: float = 0.75) -> list[tuple[float, ...]]:
    """A platform that cannot be jumped onto, with stairs of ``rise`` [m] up to it on the western side."""
    count = int(np.ceil(high / rise - 1e-9))
    x0, _, y0, y1 = at
    edges = [x0 - (count - k) * tread for k in range(1, count + 1)]
    steps = [(edges[k], edges[k + 1], y0, y1, 0.0, (k + 1) * rise) for k in range(count - 1)]
    return [*steps, (*at, 0.0, count * rise)]


def cut(mesh: trimesh.Trimesh, at: Rectangle, z: float) -> trimesh.Trimesh:
    """``mesh`` without its floor at height ``z`` [m] inside a rectangle."""
    x0, x1, y0, y1 = at
    flat = (np.abs(mesh.triangles[:, :, 2] - z) < 1e-6).all(axis=1) & (mesh.face_normals[:, 2] > 0.5)
    kept = [*mesh.triangles[~flat]]
    for corners in mesh.triangles[flat]:
        rest = corners
        for axis, side, value in ((0, -1.0, x0), (0, 1.0, x1), (1, -1.0, y0), (1, 1.0, y1)):
            beyond = side * (rest[:, axis] - value)
            outside = clipped(rest, beyond)
            kept += [outside[[0, k, k + 1]] for k in range(1, len(outside) - 1)]
            rest = clipped(rest, -beyond)
            if len(rest) < 3:
                break
    triangles = np.array(kept)
    faces = np.arange(3 * len(triangles)).reshape(-1, 3)
    return trimesh.Trimesh(triangles.reshape(-1, 3), faces, process=False)


def clipped(polygon: np.ndarray, beyond: np.ndarray) -> np.ndarray:
    """The part of a convex ``polygon`` (k, 3) where ``beyond`` (k,), linear in between, is above 0."""
    points = []
    for k in range(len(polygon)):
        j = (k + 1) % len(polygon)
        if beyond[k] >= 0.0:
            points.append(polygon[k])
        if beyond[k] * beyond[j] < 0.0:
            points.append(polygon[k] + beyond[k] / (beyond[k] - beyond[j]) * (polygon[j] - polygon[k]))
    keep = len(points) > 2 and (beyond > 1e-9).any()
    return np.array(points) if keep else np.empty((0, 3))


def pit(mesh: trimesh.Trimesh, at: Rectangle, z: float, deep: float) -> trimesh.Trimesh:
    """``mesh`` with a pit in its floor at height ``z`` [m]."""
    x0, x1, y0, y1 = at
    sides = trimesh.creation.box(bounds=[(x0, y0, z - deep), (x1, y1, z)])
    sides.update_faces(sides.face_normals[:, 2] < 0.5)
    sides.invert()
    return trimesh.util.concatenate([cut(mesh, at, z), sides])


def look(mesh: trimesh.Trimesh, folder: Path, bots: int, seconds: float) -> list[Fault]:
    """What fails a playtest of ``mesh`` with the courtyard's own plan beside it."""
    level, plan = folder / "courtyard.obj", "courtyard.playtest.yaml"
    mesh.export(level)
    (folder / plan).write_bytes(COURTYARD.with_name(plan).read_bytes())
    return list(playtest(level, bots=bots, seconds=seconds, seed=7).report.failures)


def find_all(bots: int, seconds: float) -> dict:
    """Plant and look, one fault at a time."""
    clean = trimesh.load_mesh(COURTYARD, process=False)
    rows, alarms = [], 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        on_clean = [fault.text for fault in look(clean.copy(), folder, bots, seconds)]
        print(f"level as it is: {len(on_clean)} faults", *on_clean, sep="\n  ")
        for number, plant in enumerate(plants(), start=1):
            faults = look(plant.edit(clean.copy()), folder, bots, seconds)
            found = [fault for fault in faults if plant.is_found_as(fault)]
            others = [fault for fault in faults if not plant.is_found_as(fault)]
            alarms += len(others)
            verdict = f"found: {found[0].text}" if found else "MISSED"
            print(f"{number:2} {plant.kind:11} {verdict}")
            for fault in others:
                print(f"{'':15}also {fault.kind}: {fault.text}")
            rows.append(
                {"kind": plant.kind, "found": bool(found), "others": [fault.text for fault in others]}
            )
    hits = sum(row["found"] for row in rows)
    print(f"{hits} of {len(rows)} found; {alarms} others beside; {len(on_clean)} on the level as it is")
    return {"found": hits, "planted": len(rows), "others": alarms, "clean": len(on_clean), "rows": rows}


def judged(hall: Hall, failures: Sequence[Fault]) -> str:
    """What is wrong with ``failures`` of a playtest of ``hall``; "" where nothing is."""
    said = "; ".join(f"{each.kind} at {hall.own(each.position).round(2)}: {each.text}" for each in failures)
    wanted = hall.fault
    if wanted is None:
        return said and f"false: {said}"
    (fault, *others) = failures or [None]
    if fault is None or others or fault.kind != wanted.kind:
        return f"expected one {wanted.kind}, said: {said or 'nothing'}"
    away = float(shapely.distance(wanted.area, shapely.Point(hall.own(fault.position)[:2])))
    if away > IN_PLACE:
        return f"{away:.2f} m from where it is: {said}"
    if wanted.size is not None and not (
        fault.size is not None and abs(fault.size - wanted.size) <= EXACT.get(wanted.kind, EXACT_LENGTH)
    ):
        return f"measured {fault.size}, not {wanted.size:.3f}: {said}"
    return ""


def plant_and_look(seed: int, count: int, bots: int, seconds: float) -> dict:
    """``count`` halls with faults and as many with look-alikes, every kind in turn."""
    rows = []
    for names in (list(FAULTS), list(LOOK_ALIKES)):
        for number in range(count):
            name = names[number % len(names)]
            hall = planted(np.random.default_rng([seed, number, len(names)]), name)
            with tempfile.TemporaryDirectory() as folder:
                level = Path(folder) / "hall.obj"
                hall.mesh.export(level)
                spawn = [round(float(value), 3) for value in hall.spawn]
                level.with_suffix(".playtest.yaml").write_text(f"spawns:\n  - {{name: gate, at: {spawn}}}\n")
                failures = playtest(level, bots=bots, seconds=seconds, seed=seed).report.failures
            wrong = judged(hall, failures)
            print(f"{number + 1:3} {hall.says}: {wrong or 'right'}", flush=True)
            rows.append({"hall": hall.says, "fault": hall.fault is not None, "wrong": wrong})
    figures = {}
    for what, is_fault in (("faults", True), ("look-alikes", False)):
        mine = [row for row in rows if row["fault"] == is_fault]
        figures[what] = sum(not row["wrong"] for row in mine)
        print(f"{what}: {figures[what]} of {len(mine)} right")
    return {"seed": seed, "count": count, **figures, "rows": rows}


def play_dungeon(bots: int = 64, seconds: float = 300.0) -> dict:
    """How much faster than real time a playtest of dungeon is, everything included."""
    found = {}
    reports = []
    for processes in (1, 2):
        begun = time.perf_counter()
        asked = {"bots": bots, "seconds": seconds, "seed": 7, "processes": processes}
        outcome = playtest(level_path("dungeon"), up="y", **asked)
        wall = time.perf_counter() - begun
        reports.append(json.dumps(outcome.report.to_dict()))
        total = outcome.tally.seconds
        print(
            f"dungeon, {bots} bots x {seconds:g} s, {processes} processes: {wall:.1f} s, "
            f"{total / wall:.0f} x real time in total, {seconds / wall:.1f} x for the session as a whole"
        )
        found[f"{processes} processes"] = {"wall": wall, "total": total / wall, "session": seconds / wall}
    print("the reports of 1 and 2 processes are", "equal" if reports[0] == reports[1] else "DIFFERENT")
    return {**found, "equal": reports[0] == reports[1]}


def play_large(name: str, seed: int) -> dict:
    """How long a playtest of a large level takes, and how much it finds."""
    kind, size = name.split()
    terrain = large_level(kind, int(size), seed)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{kind}.ply"
        trimesh.Trimesh(terrain.vertices, terrain.faces, process=False).export(file)
        begun = time.process_time()
        outcome = playtest(file, bots=1, seconds=5.0, seed=seed)
        played = time.process_time()
        write_page(outcome, Path(folder) / "report.html")
        drawn = time.process_time()
    report = outcome.report
    kinds = Counter(fault.kind for fault in report.faults)
    told = json.dumps([fault.to_dict() for fault in report.faults])
    figures = {
        "triangles": len(terrain.faces), "played": played - begun, "drawn": drawn - played, "found": kinds,
        "digest": hashlib.sha256(told.encode()).hexdigest()[:12],
    }  # fmt: skip
    print(
        f"{name}, seed {seed}, {len(terrain.faces)} triangles: playtest {figures['played']:.1f} s, page "
        f"{figures['drawn']:.1f} s; {len(report.faults)} findings {figures['digest']}: {dict(kinds)}",
        flush=True,
    )
    return figures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=40, help="halls with faults, and as many without")
    parser.add_argument("--bots", type=int, default=8)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--courtyard", action="store_true", help="plant twenty in the courtyard instead")
    parser.add_argument("--dungeon", action="store_true", help="only time the dungeon")
    parser.add_argument("--large", nargs="+", help="only time playtests of these levels")
    parser.add_argument("--json", type=Path, help="write the figures here")
    options = parser.parse_args()
    if options.dungeon and shared_folder() is None:
        raise SystemExit(f"dungeon skipped: {why_absent()}")
    if options.dungeon:
        figures = play_dungeon()
    elif options.large:
        figures = {name: play_large(name, options.seed) for name in options.large}
    elif options.courtyard:
        figures = find_all(options.bots, options.seconds)
    else:
        figures = plant_and_look(options.seed, options.count, options.bots, options.seconds)
    if options.json:
        options.json.write_text(json.dumps(figures, indent=1))


if __name__ == "__main__":
    main()
