"""The picture of how builds grow is drawn, also without the peer."""

from benchmarks.navmesh_scale import forget_most, most_resident, resident, row
from benchmarks.scale_plot import draw_growth


def level(area: float, **more: float) -> dict[str, float]:
    return {
        "km2": area, "triangles": 12, "build_ms": 9e3 * area, "obstacles_ms": 1e4 * area,
        "two_threads_ms": 6e3 * area, "peak_mb": 900 * area, "held_mb": 800 * area, "file_mb": 30 * area,
        **more,
    }  # fmt: skip


def test_a_picture_is_drawn(tmp_path):
    report = {"city 8": level(0.06), "city 4": level(0.015), "hills 300": level(0.09, recast_ms=7.0)}
    draw_growth(report, tmp_path / "growth.png")
    assert (tmp_path / "growth.png").read_bytes().startswith(b"\x89PNG")


def test_a_row_says_the_ratios_of_what_was_measured():
    assert "180 (0.50) | 200 (0.56) | 120 (0.67) | 18; 16" in row("city 5", level(0.02, recast_ms=360.0))


def test_memory_is_counted_from_when_it_was_forgotten():
    forget_most()
    held = bytearray(b"1") * 64_000_000
    now = resident()  # before the most, which grows with it
    assert most_resident() >= now > len(held) / 1e6
