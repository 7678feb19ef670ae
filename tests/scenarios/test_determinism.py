"""One mission, run again and in other processes, ends the same way to the last bit."""

import multiprocessing

from benchmarks.determinism import run


def test_a_mission_has_one_hash_with_one_process_and_with_two(folder):
    mission = folder / "mission.yaml"
    hashes = {run(mission), run(mission)}
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        hashes |= set(pool.map(run, [mission] * 4))
    assert len(hashes) == 1
