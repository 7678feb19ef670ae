"""The pictures of a report: maps on one scale, and a bot's last moments."""

import base64
import io

import matplotlib.image
import numpy as np
import pytest

from runtime.playtest.pictures import address, film_strip, heat_map, level_map
from runtime.views.render import Triangles


def pixels(data):
    head, _, content = data.partition(",")
    assert head == "data:image/png;base64"
    return matplotlib.image.imread(io.BytesIO(base64.b64decode(content)))


def test_pixels_come_back_out_of_an_address():
    given = np.random.default_rng(0).integers(0, 256, (4, 7, 3), dtype=np.uint8)
    assert np.array_equal((pixels(address(given))[:, :, :3] * 255).round().astype(np.uint8), given)


def test_maps_lie_on_one_another_and_show_one_metre_around_the_level(outcome):
    site = outcome.stage.site
    picture, shown = level_map(site)
    low, high = site.graph.terrain.bounds[:, :2]
    assert shown == pytest.approx([*(low - 1.0), *(high + 1.0)])
    x, y = 8.0, 2.0  # on the floor
    heat = pixels(heat_map(site, [(x, y, 0.0, 9), (x, y + 3.0, 0.0, 0)]))
    level = pixels(picture)
    assert heat.shape == level.shape and max(level.shape) == 1400
    scale = level.shape[1] / (shown[2] - shown[0])

    def at(x, y):
        return heat[round((shown[3] - y) * scale), round((x - shown[0]) * scale)]

    (red, _, blue, solid), never, outside = at(x, y), at(x, y + 3.0), at(x + 3.0, y)
    assert solid > 0.5 and red > blue  # hot
    assert never[2] > never[0] and never[3] > 0.5  # blue
    assert outside[3] == 0.0


def test_a_film_strip_ends_where_the_trouble_is(outcome):
    site = outcome.stage.site
    triangles = Triangles(site.graph.terrain.vertices, site.graph.terrain.faces)
    fault = next(each for each in outcome.report.faults if each.sightings)
    trouble = outcome.tally.met(fault.sightings[0])
    strip = pixels(film_strip(site.character, triangles, trouble))
    assert strip.shape[:2] == (170, 5 * 200 + 4 * 4)
    gaps = strip[:, [200 + 204 * k for k in range(4)], :3]
    assert (gaps == 1.0).all()
    frames = [strip[:, 204 * k : 204 * k + 200, :3] for k in range(5)]
    assert all(np.ptp(frame) > 0.3 for frame in frames) and not np.array_equal(frames[0], frames[-1])
