"""A mission in a city of which only what is around its people is loaded.

    python examples/open_world_mission.py FOLDER [--blocks 8]
    surefoot run FOLDER/errand.yaml --out FOLDER/out

The first command generates a city of 30 m blocks and writes it as an open world, with a mission beside it.
One runs through the city, another one first goes elsewhere and then follows. No place is loaded when they set
out.
"""

import argparse
from pathlib import Path

from benchmarks.large_levels import large_level
from navmesh import bake_open_world
from runtime.planning.rules import obstacle_rules, person_walk_rules

SIDE = 30.0  # [m] of a block and of a chunk
MISSION = """\
level: {{file: city.world, radius: 60}}
time_limit: 300
waypoints: {{corner: [{far}, {far}, 0], market: [{half}, {far}, 0]}}
agents:
  - name: ada
    start: [{near}, {near}, 0]
    speed: 4
    goto: [[{far}, {half}, 0], corner]
    expect: {{never_falls: true}}
  - name: bob
    start: [{near}, {half}, 0]
    speed: 3
    script:
      - goto: market
      - follow: {{agent: ada, distance: 3, seconds: 30}}
"""


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="where the city and the mission are written")
    parser.add_argument("--blocks", type=int, default=8, help="of 30 m, along each side")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    city = large_level("city", options.blocks)
    rules = person_walk_rules(), obstacle_rules({})
    bake_open_world(city, options.folder / "city.world", (0.3,), SIDE, *rules)
    # crossings of streets, where nothing is built
    near, half, far = (SIDE * k for k in (1, options.blocks // 2, options.blocks - 1))
    mission = options.folder / "errand.yaml"
    mission.write_text(MISSION.format(near=near, half=half, far=far), encoding="utf-8")
    print(f"wrote {mission}; run it: surefoot run {mission}")


if __name__ == "__main__":
    main()
