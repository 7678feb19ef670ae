"""A level of two floors, and a mission on it."""

import textwrap

FLOORS = {"near": (0.0, 0.0, 12.0, 6.0, 0.0), "island": (16.0, 0.0, 20.0, 6.0, 0.0)}
"""x0, y0, x1, y1, z of each floor of the small level; nobody gets from one to the other."""

MISSION = textwrap.dedent(
    """\
    level:
      file: level.obj
      up: z
    seed: 3
    time_limit: 20
    agents:
      - name: ada
        body: human
        start: [2, 3, 0]
        facing_deg: 0
        speed: 3.0
        goto:
          - [9, 3, 0]
        expect:
          arrives_within: 15
          never_falls: true
    """
)


def obj_text():
    lines, count = [], 0
    for x0, y0, x1, y1, z in FLOORS.values():
        for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1)):
            lines.append(f"v {x} {y} {z}")
        lines += [f"f {count + 1} {count + 2} {count + 3}", f"f {count + 1} {count + 3} {count + 4}"]
        count += 4
    return "\n".join(lines) + "\n"
