"""What ``surefoot view``, ``export`` and ``film`` do."""

import time
from pathlib import Path
from typing import TYPE_CHECKING

from runtime.cli.commands import Result, check_page, ready, show_mission
from runtime.errors import RuntimeInputError
from runtime.missions.check import prepare_mission
from runtime.missions.mission import load_mission
from runtime.missions.run import run_mission
from runtime.traces.trace import Trace
from runtime.world.world import World
from surefoot.files.archive import check_target
from surefoot.progress import Progress

if TYPE_CHECKING:
    from locomotion import Rig

__all__ = ["export_gltf", "watch_mission", "watch_served", "write_video", "write_view"]


def write_view(
    source: Path, output: Path, follow: str | None, character: Path | None, mapping: str | None
) -> Result:
    """Write the page of a trace, or of a mission, which is run first; the camera follows ``follow``,
    and people wear the ``character``."""
    from runtime.views.view import write_page

    rig = _character(character, mapping)
    check_page(output)
    trace, progress = _trace_of(source, output)
    with progress.stage("writing the page"):
        write_page(trace, output, follow, rig)
    return _written(output, trace, "open it in a browser")


def watch_mission(mission: Path, port: int) -> Result:
    """Run a mission in real time and show it in a browser until interrupted."""
    from runtime.views.live import LiveView

    loaded = load_mission(mission)
    progress = ready()
    prepared = prepare_mission(loaded, progress)
    with LiveView(prepared.world, port=port) as view:
        print(f"open {view.address} in a browser; the run begins then", flush=True)
        while not view.watched:
            time.sleep(0.05)
        begun = time.monotonic()

        def watch(world: World) -> None:
            view.show()
            time.sleep(max(begun + world.time - time.monotonic(), 0.0))

        result = run_mission(loaded, prepared=prepared, watch=watch)
        show_mission(mission, result, [])
        print("close the page to end", flush=True)
        while view.watched:
            time.sleep(0.2)
    return Result({}, result.held, lambda: None)


def watch_served(address: str, name: str | None, token: str, port: int) -> Result:
    """Show a world of `surefoot serve` in a browser until it is closed or the command is interrupted."""
    from runtime.views.served import ServedWorld
    from runtime.views.window import Window

    with ServedWorld(address, name, token) as served:
        window = Window(served.level, port=port)
        try:
            print(f"open {window.address} in a browser to see {served.name}", flush=True)
            while (moment := served.moment()) is not None:
                window.show(moment)
        finally:
            window.close()
    return Result({}, True, lambda: print(f"{served.name} is closed"))


def export_gltf(source: Path, output: Path, character: Path | None, mapping: str | None) -> Result:
    """Export a trace, or a mission, which is run first, as animated glTF; people wear the ``character``."""
    from runtime.views.gltf import write_gltf

    rig = _character(character, mapping)
    check_target(output)
    if output.suffix.lower() != ".glb":
        raise RuntimeInputError(f"{output}: glTF is written as one binary file; use the ending .glb")
    trace, progress = _trace_of(source, output)
    with progress.stage("writing the animation"):
        write_gltf(trace, output, rig)
    return _written(output, trace, "open it in Blender, Godot or three.js")


def write_video(
    source: Path, output: Path, of: str | None, character: Path | None, mapping: str | None
) -> Result:
    """Render a trace, or a mission, which is run first, as a video; people wear the ``character``."""
    from runtime.views.camera import agent_named
    from runtime.views.film import write_film

    rig = _character(character, mapping)
    check_target(output)
    if output.suffix.lower() != ".mp4":
        raise RuntimeInputError(f"{output}: a video is written as .mp4; use that ending")
    trace, progress = _trace_of(source, output)
    agent_named(trace, of)
    write_film(trace, output, of, progress, character=rig)
    return _written(output, trace, "play it")


def _character(character: Path | None, mapping: str | None) -> "Rig | None":
    """The figure of ``--character``, read by ``--mapping``."""
    from locomotion import Rig

    if character is None and mapping is not None:
        raise RuntimeInputError(f"--mapping {mapping}: of which character? Give --character, too")
    return None if character is None else Rig.load(character, mapping)


def _trace_of(source: Path, output: Path) -> tuple[Trace, Progress]:
    """Load the trace at ``source``, or run the mission there; ``output`` must not be one of its files."""
    if source.suffix.lower() in (".yaml", ".yml"):
        loaded = load_mission(source)
        check_target(output)
        progress = ready()
        return run_mission(loaded, progress).trace, progress
    return Trace.read(source), Progress()


def _written(output: Path, trace: Trace, what_next: str) -> Result:
    size = output.stat().st_size
    values = {"output": str(output), "seconds": round(float(trace.times[-1]), 2), "bytes": size}
    return Result(values, True, lambda: print(f"{output}: {what_next} ({size / 1e6:.1f} MB)"))
