"""The report as a page: one HTML file that needs no server and no network."""

import json
import os
from importlib.resources import files
from typing import Any

from runtime.playtest.bots import Trouble
from runtime.playtest.closeup import close_up
from runtime.playtest.diff import Difference
from runtime.playtest.fault import Fault
from runtime.playtest.pictures import address, film_strip, heat_map, level_map
from runtime.playtest.run import Outcome
from runtime.views.render import Triangles
from surefoot.files.atomic_write import whole_file
from surefoot.progress import Progress

__all__ = ["write_page"]

_PICTURED = 60
"""Findings that get a picture; a report with more of them has other worries."""


def write_page(
    outcome: Outcome,
    path: str | os.PathLike[str],
    difference: Difference | None = None,
    progress: Progress | None = None,
) -> None:
    """Write the page of ``outcome`` to ``path``, whole or not at all; ``difference`` is to an earlier
    report."""
    template = files("runtime.playtest").joinpath("page.html").read_text(encoding="utf-8")
    with (progress or Progress(shown=False)).stage("drawing the report") as stage:
        values = _values(outcome, difference, stage)
    # a script ends at "</": names of files must not end this one
    data = json.dumps(values).replace("</", "<\\/")
    with whole_file(path) as temporary:
        temporary.write_text(template.replace("__REPORT__", data), encoding="utf-8")


def _values(outcome: Outcome, difference: Difference | None, stage: Any) -> dict[str, Any]:
    site, report = outcome.stage.site, outcome.report
    image, bounds = level_map(site)
    triangles = Triangles(site.graph.terrain.vertices, site.graph.terrain.faces)
    pictures: list[dict[str, str]] = []
    for k, fault in enumerate(report.faults[:_PICTURED]):
        stage.update(k / min(len(report.faults), _PICTURED))
        shown = {"close": address(close_up(site, triangles, fault))}
        trouble = _first_trouble(outcome, fault)
        if trouble is not None and len(trouble.track) > 1:
            shown["film"] = film_strip(site.character, triangles, trouble)
        pictures.append(shown)
    values = report.to_dict()
    titles = [fault.title for fault in report.faults]
    goals = outcome.stage.goals
    values |= {
        "titles": titles,
        "map": image,
        "heat": heat_map(site, report.patches),
        "bounds": bounds,
        "pictures": pictures,
        "spawns": [
            [name, *place] for name, place in zip(goals.spawn_names, goals.spawns.tolist(), strict=True)
        ],
        "places": [
            [name, *place] for name, place in zip(goals.place_names, goals.places.tolist(), strict=True)
        ],
    }
    del values["patches"]
    if difference is not None:
        parts = {"new": difference.new, "gone": difference.gone, "kept": difference.kept}
        values["difference"] = {
            name: [{"title": each.title, **each.to_dict()} for each in faults]
            for name, faults in parts.items()
        } | {"coverage": list(difference.coverage)}
    return values


def _first_trouble(outcome: Outcome, fault: Fault) -> Trouble | None:
    return outcome.tally.met(fault.sightings[0]) if fault.sightings else None
