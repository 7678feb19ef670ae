"""The sentences of a report: where, what, and why, with the numbers that a designer needs to mend it."""

import numpy as np
from numpy.typing import ArrayLike

from locomotion.skills.registry import skill_kinds
from navmesh.obstacles.kinds import Crossing
from navmesh.obstacles.obstacles import Obstacles
from runtime.playtest.character import Character
from runtime.playtest.holes import Hole
from runtime.playtest.openings import Barrier

__all__ = ["Wording", "place", "triple"]


def triple(point: ArrayLike) -> tuple[float, float, float]:
    """A place to the centimetre, as plain numbers."""
    x, y, z = (round(float(value), 2) + 0.0 for value in np.asarray(point))
    return x, y, z


def place(point: ArrayLike) -> str:
    """A place in a sentence."""
    x, y, z = (round(float(value), 1) + 0.0 for value in np.asarray(point))
    return f"({x:.1f}, {y:.1f}, {z:.1f})"


class Wording:
    """Sentences about what ``character`` meets."""

    def __init__(self, character: Character) -> None:
        self.character = character
        self.noun = character.noun

    def ups(self, rise: float) -> str:
        """What the body does about ``rise`` [m]: "a person steps 0.20 m and jumps 0.28 to 0.52 m"."""
        step, can = self.character.rules.max_step, self._can("onto", rise)
        if step < rise and can:
            return f"a {self.noun} {can} that only where there is room to run up and to land"
        return f"a {self.noun} steps {step:.2f} m and {self._ranges('onto', step)}"

    def downs(self, fall: float) -> str:
        """What the body does about a ``fall`` [m]."""
        if can := self._can("off", fall):
            return f"a {self.noun} {can} that only where there is room before it and to land"
        return f"a {self.noun} {self._ranges('off', self.character.rules.max_step)}"

    def _can(self, crossing: Crossing, size: float) -> str:
        """As in "jumps", of what is so large [m]; empty where the body does not clear it."""
        able = [kind for kind, low, high in self.character.clears(crossing) if low <= size <= high]
        return able[0].does.split()[0] if able else ""

    def _ranges(self, crossing: Crossing, no_obstacle: float = 0.0, what: str = "") -> str:
        """As in "jumps 0.28 to 0.52 m", or "jumps 0.70 m" where what is less is ``no_obstacle`` [m]; or "does
        not leap gaps", with ``what`` behind the verb."""
        clears = self.character.clears(crossing)
        if not clears:
            usual = next(kind for kind in skill_kinds() if kind.obstacle.crossing == crossing)
            return f"does not {usual.verb}{what}"
        return " and ".join(
            f"{kind.does.split()[0]} {f'{low:.2f} to ' if low > no_obstacle else ''}{high:.2f} m"
            for kind, low, high in clears
        )

    def unreachable(self, centre: np.ndarray, area: float, barrier: Barrier | None) -> str:
        """Why a part of the level cannot be reached."""
        what = f"the part of {area:.0f} m² around {place(centre)} cannot be reached"
        if barrier is None:
            return f"{what}: nothing that can be reached is near it"
        return f"{what}: {self.barrier(barrier)}"

    def more_unreachable(self, where: ArrayLike, count: int, area: float, largest: float) -> str:
        """Parts like those that were told, but smaller."""
        each = f"{count} more parts of up to {largest:.0f} m² each, {area:.0f} m² in all,"
        return (
            f"{each} cannot be reached either; larger ones are told one by one. The next is at {place(where)}"
        )

    def barrier(self, barrier: Barrier) -> str:
        """What is in the way, how much of it, and what the body can do."""
        noun, rules = self.noun, self.character.rules
        at, size, need = place(barrier.place), abs(barrier.size), 2.0 * self.character.radius
        if barrier.kind == "narrow":
            return f"the passage at {at} is {size:.2f} m wide; a {noun} needs {need:.2f} m"
        if barrier.kind == "passes":
            wide = f"is {size:.2f} m wide" if size < np.inf else "is wide enough"
            return f"the passage at {at} {wide}, and a {noun} needs {need:.2f} m, but the graph has lost it"
        if barrier.kind == "low":
            return f"the passage at {at} is {size:.2f} m high; a {noun} needs {rules.headroom:.2f} m"
        if barrier.kind == "steep":
            most = np.degrees(rules.max_slope)
            return f"the slope at {at} is {size:.0f}° steep; a {noun} walks up to {most:.0f}°"
        if barrier.kind == "gap":
            return f"the gap at {at} is {size:.2f} m wide; {self.leaps(size)}"
        if barrier.kind == "wall":
            return f"a wall stands between it and the floor beside it at {at}"
        if barrier.size > 0.0:
            return f"its lowest edge, at {at}, is {size:.2f} m above the floor beside it; {self.ups(size)}"
        return f"its edge at {at} is {size:.2f} m below the floor beside it; {self.downs(size)}"

    def leaps(self, width: float) -> str:
        """What the body does about a gap of ``width`` [m]."""
        if can := self._can("across", width):
            return f"a {self.noun} {can} that only where there is room to run up and to land"
        return f"a {self.noun} {self._ranges('across', what=' gaps')}"

    def tops(self, centre: np.ndarray, count: int, area: float, width: float) -> str:
        """Parts that nobody reaches nor is meant to."""
        parts = f"{count} parts like it, {area:.0f} m² in all," if count > 1 else f"it, {area:.0f} m²,"
        where = f"a {self.noun} would fit on what is at {place(centre)}, less than {width:.1f} m wide,"
        return f"{where} but cannot get there: {parts} count as tops of walls"

    def no_return(self, kind: str, centre: np.ndarray, area: float, entry, out: Barrier | None) -> str:
        """What is entered but not left."""
        way = f"the {entry['affordance']} of {entry['height']:.2f} m at {place(entry['place'])}"
        what = "is a trap" if kind == "trap" else "is one-way"
        text = (
            f"the part of {area:.0f} m² around {place(centre)} {what}: {way} leads in and nothing leads back"
        )
        if out is None:
            return text
        if out.kind != "rise":
            return f"{text}; {self.barrier(out)}"
        if out.size > 0.0:
            edge = f"its lowest edge, at {place(out.place)}, is {out.size:.2f} m high"
            return f"{text}; {edge}; {self.ups(out.size)}"
        return f"{text}; at {place(out.place)} it is {-out.size:.2f} m down; {self.downs(-out.size)}"

    def hole(self, hole: Hole) -> str:
        """A place without floor."""
        wide = float(np.linalg.norm(hole.span[1] - hole.span[0]))
        where = f"the floor has a hole of {wide:.2f} by {hole.long:.2f} m at {place(hole.place)}"
        return f"{where}: who walks there falls out of the level"

    def open_edge(self, hole: Hole) -> str:
        """The outer edge of a level."""
        others = len(hole.rim) - 1
        also = f" and at {others} places like it" if others else ""
        return f"the level ends at {place(hole.place)}{also} without a wall: who walks on falls out of it"

    def passage(self, barrier: Barrier, through: float, around: float) -> str:
        """A door that does not let the body in."""
        return f"{self.barrier(barrier)}: the way around is {around:.0f} m instead of {through:.1f} m"

    def unusable(self, obstacles: Obstacles, index: int) -> str:
        """An obstacle without a link."""
        name, need = obstacles.affordance[index], 2.0 * self.character.radius
        text = (
            f"the {name} {str(obstacles.tag[index])!r} at {place(obstacles.position[index])} cannot be used"
        )
        if obstacles.width[index] < need:
            return f"{text}: it is {obstacles.width[index]:.2f} m wide and a {self.noun} needs {need:.2f} m"
        return f"{text}: there is no room for a {self.noun} before it or behind it"
