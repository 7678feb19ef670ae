"""All measurements of the dog: paths, feet, spine, head, stops, moves, dead ends, gaits and changes, backs.

    python -m benchmarks.dog [--quick] [--only following stops ...] [--json FILE]

Prints each figure next to its target, and writes all figures to JSON. Levels, scans and recordings are shared
data; rows without their data say so.
"""

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks import dog_back, dog_checks, dog_gait, dog_gait_changes, dog_rooms, dog_walks
from benchmarks.shared_data import shared_folder, why_absent

Lines = list[tuple[str, str, str, bool | None]]
_VERDICT = {True: "yes", False: "NO", None: "-"}
_CHANGE = 25.0
"""[rad/s] by which a joint's speed may change from one tick to the next, see docs/how-it-works/animals.md."""
_OFF = {"level": (0.02, 1.0), "slope": (0.06, 2.5)}
"""Of its own height, and [deg], by which hips, shoulders and trunk may leave the range of even speeds."""
_FLEXION = 15.0
"""[deg] of the back over a stride, in a gallop at top speed."""
_SHARED = ("following", "footprint", "gait", "herd")


def _following(found: dict[str, Any]) -> Lines:
    lines: Lines = []
    for level, row in found.items():
        if not row["paths"]:
            lines.append((f"path on {level}", "no route long enough", "a route", False))
            continue
        name = f"{level[:12]}, {row['finished']}/{row['paths']} walks"
        front = (
            f"p95 {100 * row['front_p95']:.1f} cm; of the feet themselves p95 {100 * row['feet_p95']:.1f}, "
            f"max {100 * row['feet_max']:.1f}"
        )
        lines.append(
            (f"front from path: {name}", front, "p95 <= 3 cm", max(row["front_p95"], row["feet_p95"]) <= 0.03)
        )
        root = f"p95 {100 * row['root_p95']:.2f} cm, max {100 * row['root_max']:.2f}"
        lines.append((f"root from path: {name}", root, "<= 1 cm", row["root_p95"] <= 0.01))
        slide = f"max {1e3 * row['slide_max']:.2f} mm of {row['stances']} stances"
        lines.append((f"slide: {name}", slide, "<= 5 mm", row["slide_max"] <= 0.005))
        off = f"worst {100 * row['height_worst']:.2f} cm"
        lines.append((f"foot over ground: {name}", off, "<= 1 cm", row["heights_above_1cm"] == 0))
        joints = (
            f"worst change per tick {row['joint_change']:.1f} rad/s (p99 {row['joint_change_p99']:.1f}); "
            f"speed {row['joint_speed']:.0f} rad/s, jerk {row['joint_jerk']:.0f} rad/s3"
        )
        lines.append((f"joints: {name}", joints, f"<= {_CHANGE:.0f} rad/s", row["joint_change"] <= _CHANGE))
    return lines


def _stops(found: dict[str, Any]) -> Lines:
    return [
        (
            f"stops from {gait}", f"{100 * row['place_worst']:.2f} cm, {row['facing_worst_deg']:.2f} deg "
            f"(worst of {row['stops']})", "<= 2 cm, 2 deg",
            row["place_worst"] <= 0.02 and row["facing_worst_deg"] <= 2.0,
        )
        for gait, row in found.items()
    ]  # fmt: skip


def _local(found: dict[str, Any]) -> Lines:
    text = (
        f"{100 * found['place_worst']:.2f} cm, {found['facing_worst_deg']:.2f} deg (worst of "
        f"{found['moves']}; p99 {100 * found['place_p99']:.2f} cm, {found['facing_p99_deg']:.2f} deg)"
    )
    held = found["place_worst"] <= 0.02 and found["facing_worst_deg"] <= 2.0
    return [("local motion, targets within 1 m", text, "<= 2 cm, 2 deg", held)]


def _footprint(found: dict[str, Any]) -> Lines:
    text = (
        f"{found['passed']} of {found['placements']} passed, deepest "
        f"{100 * found['deepest_of_passed']:.2f} cm; "
        f"{100 * found['wrongly_refused']:.1f} % of {found['refused']} refused wrongly"
    )
    held = found["deepest_of_passed"] <= found["resolution"]
    return [("footprint check in a scan", text, f"<= {100 * found['resolution']:.0f} cm", held)]


def _dead_ends(found: dict[str, Any]) -> Lines:
    text = (
        f"out of {found['out']} of {found['dead_ends']}, {found['backed_out']} backed out, touched "
        f"{found['touched']}, nearest {100 * found['nearest_m']:.1f} cm"
    )
    return [
        ("dead ends", text, "all, 0 touched", found["out"] == found["dead_ends"] and not found["touched"])
    ]


def _gait(found: dict[str, Any]) -> Lines:
    lines: Lines = []
    for name, row in found.items():
        if row["real"] is None:
            continue
        ours, real, off = row["ours"], row["real"], row["off"]
        text = ", ".join(
            f"{key.replace('_', ' ')} {ours[key]:.2f} ({real[key]:.2f})"
            for key in ("frequency", "duty_front", "duty_rear", "diagonal_phase")
        )
        held = max(abs(value) for value in off.values()) <= 0.10
        lines.append((f"{name} {real['speed']:.2f} m/s, ours (real)", text, "within 10 %", held))
    return lines


def _gait_changes(found: dict[str, Any]) -> Lines:
    lines: Lines = []
    for name, row in found.items():
        text = (
            f"height {100 * row['height_off']:.1f} % (p95 {100 * row['height_off_p95']:.1f}), pitch "
            f"{row['pitch_off_deg']:.1f} deg (p95 {row['pitch_off_p95_deg']:.1f}); lowest bone "
            f"{100 * row['lowest_bone']:.2f} cm, slide {1e3 * row['slide']:.2f} mm, joints "
            f"{row['joint_change']:.1f} rad/s ({row['joint_change_usual']:.1f} at even speeds)"
        )
        height, pitch = _OFF["slope" if row["slope"] else "level"]
        held = (
            row["height_off"] <= height and row["pitch_off_deg"] <= pitch
            and row["lowest_bone"] >= -1e-3 and row["slide"] <= 1e-3
            and row["joint_change"] <= 1.1 * row["joint_change_usual"]
        )  # fmt: skip
        wanted = f"<= {100 * height:.1f} %, {pitch:.1f} deg"
        lines.append((f"gait changes: {name}, {row['tasks']}", text, wanted, held))
    return lines


def _backs(found: dict[str, Any]) -> Lines:
    lines: Lines = []
    for name, row in found.items():
        if "breaths" in row:
            text = (
                f"{row['breaths']:.1f} breaths/min, looks over {row['gaze_deg']:.0f} deg, hips roll over "
                f"{row['roll_deg']:.1f} deg, most alike {row['alike']:.2f}, slide {1e3 * row['slide']:.2f} mm"
            )
            held = row["gaze_deg"] >= 20.0 and row["alike"] <= 0.8 and row["slide"] == 0.0
            lines.append((f"back: {name}", text, "no two alike", held))
            continue
        text = (
            f"flexion {row['flexion_deg']:.1f} deg (most at {row['most_flexed']:.2f}, least at "
            f"{row['most_extended']:.2f} of the stride), bend {row['undulation_deg']:.1f}, hips roll "
            f"{row['hip_roll_deg']:.1f}, shoulders {row['shoulder_roll_deg']:.1f}, {row['nods']:.1f} nods of "
            f"{row['nod_deg']:.1f}, tail {row['tail_deg']:.1f} deg"
        )
        top = "gallop" in name and row["speed"] >= 0.95 * row["top_speed"]
        held = row["flexion_deg"] >= _FLEXION if top else None
        lines.append((f"back: {name}", text, f">= {_FLEXION:.0f} deg at top speed" if top else "", held))
    return lines


def _rooms(found: dict[str, Any]) -> Lines:
    lines: Lines = []
    for name, row in found.items():
        routes, arrived = row.get("with a route", 0), row.get("with a route: arrived", 0)
        unsaid = row.get("silent", 0) + sum(n for key, n in row.items() if key.endswith("without a reason"))
        text = (
            f"{arrived} of {routes} with a route arrived, {row.get('blocked at once', 0)} of {row['goals']} "
            f"blocked at once; {unsaid} nowhere without a word"
        )
        lines.append((f"{name} in furnished rooms", text, "0 without a word", unsaid == 0))
    return lines


def _herd(found: dict[str, Any]) -> Lines:
    text = (
        f"{found['ms_per_tick']:.2f} ms (p95 {found['ms_p95']:.2f}; wall {found['wall_ms']:.1f}), "
        f"{found['bodies']} bodies, {found['moving']} moving"
    )
    return [(f"{found['dogs']} dogs on nav_test", text, "<= 10 ms a tick", found["ms_per_tick"] <= 10.0)]


ROWS: dict[str, tuple[Callable[[bool], Any], Callable[[Any], Lines]]] = {
    "following": (dog_walks.following, _following),
    "spine": (
        dog_checks.spine,
        lambda r: [
            ("SpineFlex against brute force", f"{r['worst_rad']:.1e} rad", "<= 1e-9", r["worst_rad"] <= 1e-9)
        ],
    ),
    "head": (
        dog_checks.head,
        lambda r: [
            (
                f"head's target at {speed}",
                f"off by {1e3 * row['worst_m']:.1f} mm",
                "v x time",
                row["worst_m"] <= 0.005,
            )
            for speed, row in r.items()
        ],
    ),
    "stops": (dog_checks.stops, _stops),
    "local": (dog_checks.local_moves, _local),
    "footprint": (dog_checks.footprints, _footprint),
    "dead_ends": (dog_checks.dead_ends, _dead_ends),
    "gait": (dog_gait.against_real, _gait),
    "gait_changes": (dog_gait_changes.gait_changes, _gait_changes),
    "backs": (dog_back.backs, _backs),
    "rooms": (dog_rooms.rooms, _rooms),
    "herd": (lambda quick: dog_walks.many_at_once(1000, 60 if quick else 300), _herd),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a tenth of the samples")
    parser.add_argument("--only", nargs="+", choices=sorted(ROWS), default=list(ROWS))
    parser.add_argument("--json", type=Path, help="write every figure here")
    options = parser.parse_args()
    report: dict[str, Any] = {"quick": options.quick}
    print(f"{'what':46} {'wanted':>16}  held  found")
    for name in options.only:
        if name in _SHARED and shared_folder() is None:
            print(f"{name:46} skipped: {why_absent()}")
            continue
        measure, lines = ROWS[name]
        report[name] = measure(options.quick)
        for what, found, wanted, held in lines(report[name]):
            print(f"{what:46} {wanted:>16}  {_VERDICT[held]:4}  {found}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(report, indent=1, default=float))


if __name__ == "__main__":
    main()
