"""Randomly mutated mission files: does each run, or get refused with a message that says where?

    python -m benchmarks.mission_fuzz [--files 10000] [--seed 0] [--seconds 0.3] [--kept fuzz.json]

A mission that uses every feature is mutated: a third of the time as text (bytes removed, inserted, doubled,
cut off), a third as data (keys and values removed, swapped, renamed, replaced by odd ones), and a third so
mildly that it may still be valid (other numbers, other names, steps left out or swapped). Accepted files run
for the first `--seconds` of simulated time. A file is wrong if it causes anything but a one-line message
``file:line:column: ...`` about a place in it. Exit code 1 if any is. With `--kept` results so far are saved
in a file, and a run with the same seed continues.
"""

import argparse
import copy
import json
import re
import tempfile
import time
import traceback
from pathlib import Path
from typing import Any

import numpy as np
import yaml

import navmesh
from runtime.missions.check import build_graph, prepare_mission
from runtime.missions.mission import LoadedMission, load_mission
from runtime.missions.run import run_mission
from surefoot.files.atomic_write import whole_file
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress

LEVEL = [(0, 0, 12, 6, 0.0), (12, 0, 20, 6, 0.4)]
"""x0, y0, x1, y1, z of a floor and a platform."""
MISSION = """\
level: {file: level.obj, up: z, scale: 1.0, tags: level.tags.yaml}
rules: {max_slope_deg: 30, max_step: 0.2, headroom: 1.8, resolution: 0.1}
seed: 3
time_limit: 30
waypoints: {west: [2, 3, 0], middle: [6, 1, 0], east: [9, 5, 0]}
regions:
  corner: {min: [0, 0, -1], max: [3, 3, 2]}
  ball: {center: [9, 5, 0], radius: 1.5}
agents:
  - name: ada
    body: human
    start: west
    facing_deg: 0
    speed: 3.0
    script:
      - wait: 0.1
      - goto: [[3, 3, 0], middle]
        speed: 1.5
      - use: {skill: jump, obstacle: ledge}
    expect: {arrives_within: 25, never_falls: true, uses_skills: [jump], stays_out_of: [ball]}
  - name: rex
    body: dog
    start: [4, 4, 0]
    script:
      - follow: {agent: tom, distance: 1.5, seconds: 5}
      - goto: east
    expect:
      keeps_distance: [{to: ada, at_least: 0.2, at_most: 20, after: 1}]
  - name: tom
    body: cat
    start: middle
    goto: [[8, 1, 0], [8, 5, 0]]
triggers:
  - when: {after: 0.1}
    then: [{agent: tom, do: [{patrol: {points: [west, east], rounds: 2, seconds: 9}}]}]
  - when: {enters: {agent: rex, region: ball}}
    then: [{agent: tom, do: [{wait: 1}, {goto: middle}]}]
  - when: {uses: {agent: ada, skill: jump}}
    then: [{agent: rex, do: [{goto: [5, 5, 0]}]}]
  - when: {arrives: tom}
    then: [{agent: ada, do: [{use: {skill: jump, near: [12, 3, 0.4]}}]}]
"""
ODD = [
    None, True, False, 0, -1, 1, 2, 7, 1e-9, -0.0, 1e308, -1e308, 2**70, float("inf"), float("nan"), "", " ",
    "west", "ada", "rex", "nobody", "jump", "vault", "z", "level.obj", ".", "..", "/", "mission.yaml",
    "é\u2028x", "[key]", "(name)", [], {}, [[]], [0, 0, 0], [3, 3, 0], [1, 2], ["west"], {"a": 1},
    {"agent": "ada"}, {"goto": "west"},
]  # fmt: skip
SNIPPETS = [
    b":", b"- ", b"{", b"}", b"[", b"]", b",", b"'", b'"', b"#", b"&a ", b"*a", b"!!int ", b"!x ", b"<<: ",
    b"\n", b"\t", b"\x00", b"\xff", b"\xe2\x80\xa8", b"null", b"~", b".inf", b"1e999", b"0x", b"0o7",
    b"2001-01-01", b"|\n", b"? ", b"---\n", b"...\n", b"%YAML 9\n", b"  ", b"-", b"9999999999", b"yes",
]  # fmt: skip
_DATA = yaml.safe_load(MISSION)
PLACE = re.compile(r"^(?P<file>.*?):(?P<line>\d+):(?P<column>\d+): [^\n]+\Z")


def write_level(folder: Path) -> None:
    """A floor before a platform of 0.4 m, with its edge named."""
    lines, faces = [], []
    for x0, y0, x1, y1, z in LEVEL:
        n = len(lines) + 1
        lines += [f"v {x} {y} {z}" for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
        faces += [f"f {n} {n + 1} {n + 2}", f"f {n} {n + 2} {n + 3}"]
    faces += ["f 3 2 5", "f 3 5 8"]  # the riser
    (folder / "level.obj").write_text("\n".join(lines + faces) + "\n")
    change = "version: 1\nchange:\n  - at: [12, 3, 0.4]\n    affordance: jump\n    set: {name: ledge}\n"
    (folder / "level.tags.yaml").write_text(change)


def mutated(random: np.random.Generator) -> bytes:
    """`MISSION` with one to four changes."""
    changes = int(random.integers(1, 5))
    manner = random.integers(3)
    if manner == 0:
        text = MISSION.encode()
        for _ in range(changes):
            text = _mutated_text(text, random)
        return text
    data = copy.deepcopy(_DATA)
    for _ in range(changes):
        (_mutate_data if manner == 1 else _nudge)(data, random)
    return yaml.safe_dump(data, sort_keys=False, allow_unicode=True).encode()


def _mutated_text(text: bytes, random: np.random.Generator) -> bytes:
    at = int(random.integers(len(text) + 1))
    until = at + int(random.integers(1, 30))
    match random.integers(6):
        case 0:
            return text[:at] + text[until:]
        case 1:
            return text[:at] + SNIPPETS[random.integers(len(SNIPPETS))] + text[at:]
        case 2:
            return text[:until] + text[at:]
        case 3:
            return (
                text[:at]
                + bytes(random.integers(32, 127, int(random.integers(1, 4))).astype(np.uint8))
                + text[at:]
            )
        case 4:
            lines = text.splitlines(keepends=True) or [b""]
            a, b = random.integers(len(lines), size=2)
            lines[a], lines[b] = lines[b], lines[a]
            return b"".join(lines)
        case _:
            return (
                text[:at]
                if random.random() < 0.2
                else text[:at] + SNIPPETS[random.integers(len(SNIPPETS))] + text[until:]
            )


def _mutate_data(data: Any, random: np.random.Generator) -> None:
    holders = [holder for holder in _holders(data) if len(holder)]
    if not holders:
        return
    holder = holders[random.integers(len(holders))]
    keys = _keys(holder)
    key = keys[random.integers(len(keys))]
    other = holders[random.integers(len(holders))]
    match random.integers(6):
        case 0:
            del holder[key]
        case 1:
            holder[key] = copy.deepcopy(ODD[random.integers(len(ODD))])
        case 2:
            values = list(other.values()) if isinstance(other, dict) else other
            holder[key] = copy.deepcopy(values[random.integers(len(values))])
        case 3 if isinstance(holder, dict):
            holder[f"{key}x" if random.random() < 0.5 else "goto"] = holder.pop(key)
        case 4 if isinstance(holder[key], int | float):
            holder[key] = float(holder[key]) * float(random.choice([-1.0, 0.1, 0.5, 1.01, 2.0, 10.0, 1e4]))
        case _:
            if isinstance(holder, list):
                holder.insert(key, copy.deepcopy(holder[random.integers(len(holder))]))
            else:
                holder[str(random.choice(["wait", "speed", "near", "body", "min", "zzz"]))] = 1


def _nudge(data: Any, random: np.random.Generator) -> None:
    """Another number, or a value of the same kind from elsewhere in the file, or one item of a list less."""
    places = [(holder, key) for holder in _holders(data) for key in _keys(holder)]
    holder, key = places[random.integers(len(places))]
    value = holder[key]
    if isinstance(value, int | float):
        holder[key] = float(value) * float(random.choice([-1.0, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0]))
    elif isinstance(holder, list) and len(holder) > 1 and random.random() < 0.5:
        del holder[key]
    else:
        alike = [
            h[k] for h, k in places if type(h[k]) is type(value) and (isinstance(value, str) or k == key)
        ]
        holder[key] = copy.deepcopy(alike[random.integers(len(alike))])


def _keys(holder: Any) -> list[Any]:
    return list(holder) if isinstance(holder, dict) else list(range(len(holder)))


def _holders(data: Any) -> list[Any]:
    """Every mapping and list in ``data``."""
    inner = list(data.values()) if isinstance(data, dict) else data if isinstance(data, list) else None
    return [] if inner is None else [data, *(each for value in inner for each in _holders(value))]


class Fuzz:
    """Tries files in ``folder``, which has the level; graphs are built once for each level and rules."""

    def __init__(self, folder: Path, seconds: float) -> None:
        self.path, self._seconds = folder / "mission.yaml", seconds
        self._graphs: dict[str, navmesh.NodeGraph] = {}
        write_level(folder)

    def attempt(self, content: bytes) -> tuple[str, str]:
        """ "ran", "refused on reading", "refused on the level" or "wrong", and what was said."""
        self.path.write_bytes(content)
        stage = "refused on reading"
        try:
            loaded = load_mission(self.path)
            stage = "refused on the level"
            prepared = prepare_mission(loaded, Progress(shown=False), self._graph(loaded))
            limit = min(self._seconds, loaded.mission.time_limit)
            loaded.mission = loaded.mission.model_copy(update={"time_limit": limit})
            stage = "ran"
            result = run_mission(loaded, prepared=prepared)
            json.dumps(result.trace.report)
        except FileError as error:
            place = PLACE.match(str(error))
            lines = content.count(b"\n") + content.count(b"\r") + content.count("\u2028".encode()) + 2
            if stage == "ran" or place is None or int(place["line"]) > lines + content.count(b"\xc2\x85"):
                return "wrong", f"names no place: {error}"
            return stage, str(error)
        except Exception:
            return "wrong", traceback.format_exc()
        return "ran", f"{result.simulated:.2f} s"

    def _graph(self, loaded: LoadedMission) -> navmesh.NodeGraph:
        level = loaded.mission.level
        key = repr((loaded.level_path, level.up, level.scale, loaded.tags_path, loaded.rules()))
        if key not in self._graphs:
            self._graphs[key] = build_graph(loaded)
        return self._graphs[key]


def kept_so_far(file: Path | None, asked: dict[str, Any]) -> dict[str, Any]:
    """What an earlier run of the same kind has left in ``file``, or a beginning."""
    if file is not None and file.is_file():
        found = json.loads(file.read_text())
        if found["asked"] != asked:
            raise SystemExit(f"{file}: is of another run: {found['asked']}; this one: {asked}")
        return found
    return {"asked": asked, "tried": 0, "counts": {}, "wrong": [], "seconds": 0.0, "slowest": 0.0}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--files", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=0.3, help="of each mission that is accepted")
    parser.add_argument("--kept", type=Path, help="file for what was found, to go on from")
    options = parser.parse_args()
    found = kept_so_far(options.kept, {"seed": options.seed, "seconds": options.seconds})

    def keep() -> None:
        if options.kept is not None:
            with whole_file(options.kept) as temporary:
                temporary.write_text(json.dumps(found, indent=1) + "\n")

    with tempfile.TemporaryDirectory() as folder:
        fuzz = Fuzz(Path(folder), options.seconds)
        assert fuzz.attempt(MISSION.encode())[0] == "ran"
        with Progress().stage("trying mission files") as stage:
            for number in range(found["tried"], options.files):
                content = mutated(np.random.default_rng([options.seed, number]))
                at = time.perf_counter()
                outcome, said = fuzz.attempt(content)
                took = time.perf_counter() - at
                found["counts"][outcome] = found["counts"].get(outcome, 0) + 1
                found["slowest"] = max(found["slowest"], took)
                found["seconds"] += took
                found["tried"] = number + 1
                if outcome == "wrong":
                    found["wrong"].append({"file": content.decode(errors="replace"), "said": said})
                    print(said)
                if number % 100 == 99:
                    keep()
                stage.update((number + 1) / options.files, f"{number + 1} files")
    keep()
    for outcome in ("ran", "refused on reading", "refused on the level", "wrong"):
        print(f"{outcome:22} {found['counts'].get(outcome, 0):6}")
    print(f"{found['tried']} files in {found['seconds']:.0f} s, slowest {found['slowest']:.1f} s")
    return 1 if found["wrong"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
