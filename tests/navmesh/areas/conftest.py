import numpy as np
import pytest

from benchmarks.area_costs import RADIUS, patchwork
from tests.navmesh.areas.painted import built


@pytest.fixture(scope="package", params=[7, 8])
def scene(request):
    made = patchwork(request.param)
    rng = np.random.default_rng(request.param)
    places = rng.uniform(-9.5, 9.5, (200, 2))
    places = places[made.gap_at(places) > RADIUS][:24]
    places = np.column_stack([places, np.zeros(len(places))])
    return made, built(made.terrain), places[:12], places[12:]
