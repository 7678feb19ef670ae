"""DIS: the figures of `docs/guides/dis.md`, one row or all.

python -m benchmarks.dis                       # all rows
python -m benchmarks.dis --rows reckoning geodesy --seed 5
"""

import argparse
import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.dis_reckoning import errors_against_integration
from benchmarks.dis_wireshark import differences, random_pdus
from benchmarks.shared_data import shared_folder, why_absent
from runtime.dis.dead_reckoning import MODELS
from runtime.dis.entity_state import decode
from runtime.dis.geodesy import LevelFrame, rotations_of


def wireshark(seed: int) -> None:
    """Every field of 1,000 random PDUs as tshark reads it."""
    if shutil.which("tshark") is None:
        print("wireshark: needs tshark (apt-get install tshark)")
        return
    with tempfile.TemporaryDirectory() as folder:
        wrong = differences(random_pdus(1000, seed), Path(folder))
    print(f"wireshark: 1000 random PDUs, {len(wrong)} fields read otherwise by tshark {wrong[:3] or ''}")


def recorded(seed: int) -> None:
    """Recorded PDUs of others, read and written again."""
    shared = shared_folder()
    if shared is None or not (shared / "dis").is_dir():
        print(f"recorded: {why_absent()}")
        return
    files = sorted((shared / "dis").glob("*.raw"))
    same = sum(decode(file.read_bytes()).encode() == file.read_bytes() for file in files)
    print(f"recorded: {same} of {len(files)} are the same bytes when written again")


def reckoning(seed: int) -> None:
    """Dead reckoning against integration in steps of 0.1 ms, 5 s, at poles and ±180° too."""
    for model in range(1, len(MODELS)):
        metres, radians = errors_against_integration(model, count=60, seconds=5.0, step=1e-4, seed=seed)
        print(f"reckoning: {MODELS[model]:6} off by {metres:.1e} m, {radians:.1e} rad at most after 5 s")


def geodesy(seed: int) -> None:
    """100,000 places and orientations from a level to geocentric and back."""
    chance = np.random.default_rng(seed)
    far, turned = 0.0, 0.0
    for number in range(100):
        latitude = (90.0, -90.0, 0.0)[number] if number < 3 else float(chance.uniform(-90, 90))
        longitude = (180.0, -180.0)[number % 2] if number < 20 else float(chance.uniform(-180, 180))
        frame = LevelFrame((latitude, longitude, float(chance.uniform(-400.0, 9000.0))))
        places = chance.normal(0.0, 3000.0, (1000, 3))
        back = frame.to_level(frame.to_geocentric(places))
        far = max(far, float(np.abs(back - places).max()))
        angles = chance.uniform(-np.pi, np.pi, (1000, 3))
        angles[:50, 1] = np.pi / 2 - 10.0 ** chance.uniform(-16, -3, 50)
        rotations = rotations_of(angles)
        again = frame.rotations(frame.orientations(rotations))
        turned = max(turned, float(np.linalg.norm(again - rotations, axis=(1, 2)).max() / np.sqrt(2.0)))
    print(f"geodesy: 100,000 places there and back: off by {far:.1e} m, {turned:.1e} rad at most")


ROWS: dict[str, Callable[[int], None]] = {
    "wireshark": wireshark,
    "recorded": recorded,
    "reckoning": reckoning,
    "geodesy": geodesy,
}


def main() -> None:
    parser = argparse.ArgumentParser(description="DIS: codec, dead reckoning, geodesy, figures, safety.")
    parser.add_argument("--rows", nargs="*", choices=list(ROWS), default=list(ROWS))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    for row in options.rows:
        begun = time.perf_counter()
        ROWS[row](options.seed)
        print(f"  ({row}: {time.perf_counter() - begun:.0f} s)", flush=True)


if __name__ == "__main__":
    main()
