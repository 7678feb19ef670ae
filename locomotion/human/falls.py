"""A person that falls, from losing its balance until it stands again."""

from __future__ import annotations

import mujoco

from locomotion.body.hand_hold import let_go_both
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.body_events import Fell, GotUp, LostGround
from locomotion.gaits.run import controller
from locomotion.gaits.walk.controller import observe_walk
from locomotion.gaits.walk.layout import new_walk
from locomotion.gaits.walk.skill import rise_walking
from locomotion.human.arrived_or_stuck import notice
from locomotion.human.person import Person
from locomotion.human.state import MOVING, Status
from locomotion.paths.tracking import SLOPE_HERE

__all__ = ["fall", "tick_on_all_fours"]

_LONGEST_DOWN = 12000  # ticks after which a fallen body stays down for good
_LOOKS = 20  # ticks between checks whether one on hands and feet can walk on


def fall(person: Person, gets_up: bool) -> None:
    """The person has lost its balance; ``gets_up``: whether it gets up again if there is ground."""
    let_go_both(person.data)
    person.on_feet.landing.forget()
    on_way = person.status in MOVING
    speed, slope = person.on_feet.speed, float(person.follower.memory[SLOPE_HERE])
    person.end("fallen", Fell(person.time, person.point, speed, slope, person.arc_length))
    if gets_up and not person.simulation.over_ground:
        person.events.append(_off_level(person))
    elif gets_up:
        person.status, person.on_feet.slowing, person.on_feet.brakes = "getting up", 0.0, False
        person.on_feet.walk[:] = new_walk()
        person.on_feet.stop_learned()
        person.run_up.give_up()
        person.fours.fall(person.data)
        person.fours.fell_at, person.fours.on_way = float(person.ticks), float(on_way)


def tick_on_all_fours(person: Person, gets_up: bool) -> None:
    """One tick on hands and feet, getting there after a fall, or standing up from there."""
    fours, lookup = person.fours, person.simulation.lookup
    follower = person.follower if fours.on_way > 0.0 and person.status in MOVING else None
    if person.ticks % _LOOKS == 0:
        if person.status != "fallen" and _is_off_level(person):
            person.end("fallen", _off_level(person))
        fours.look(person.ground, person.position, follower)
    fours.steer(follower, person.control[controller.COM], person.ticks, person.command)
    fours.tick(lookup, person.command, person.data, fours.gentle > 0.0)
    mujoco.mj_step(person.physics, person.data, STEPS_PER_TICK)
    person.control[controller.FALLEN] = 0.0
    stands = fours.observe(lookup, person.data, person.observed)
    if person.status == "fallen":
        return
    got_up = person.status == "getting up"
    if fours.fallen and person.status != "getting up":
        fall(person, gets_up)
    elif stands:
        _stand_up(person)
    elif fours.borne and fours.gentle == 0.0 and person.status == "getting up":
        _got_up(person, "scrambling")
    if person.status == "getting up":
        person.follower.make_headway(person.ticks)
        if person.ticks - fours.fell_at > _LONGEST_DOWN:
            person.status, person.ended_at = "fallen", person.ticks
    elif follower is not None and follower.path is not None and person.status in MOVING and not got_up:
        notice(person)  # except one that has just got up, which may be given another path


def _off_level(person: Person) -> LostGround:
    return LostGround(person.time, person.point, "it has fallen off the level")


def _is_off_level(person: Person) -> bool:
    """Whether it falls, and there is nothing below."""
    return person.data.ncon == 0 and not person.simulation.over_ground


def _stand_up(person: Person) -> None:
    """Hand over to the walking controller."""
    rise_walking(person.on_feet.walk, person.observed, person.fours.facing)
    observe_walk(person.index, person.data, person.on_feet.walk)
    person.fours.leave()
    if person.status == "getting up":
        _got_up(person, "walking")
    elif person.status == "scrambling":
        person.status = "walking"


def _got_up(person: Person, status: Status) -> None:
    person.follower.go_on_from(person.position, person.ticks)
    person.status = status if person.fours.on_way > 0.0 else "standing"
    person.ended_at = person.ticks
    down = (person.ticks - person.fours.fell_at) * CONTROL_DT
    person.events.append(GotUp(person.time, person.point, down))
