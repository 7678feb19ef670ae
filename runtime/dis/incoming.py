"""Entities of others in our world: they come, are corrected, and go.

A packet is taken for news of an entity if its timestamp is later than that of the last one. What was told is
reckoned on from when it was sent (`runtime.dis.timestamps.SenderClock`).
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from runtime.bodies.remote_figures import LONGEST, TELEPORT, RemoteDriver, told_state
from runtime.bodies.remote_looks import PERSON, THING, animal_of
from runtime.bodies.remote_poses import STANDS
from runtime.dis.appearance import POSTURES, Appearance
from runtime.dis.dead_reckoning import MODELS, Motion, velocities
from runtime.dis.enumerations import Health, LifeForm, is_life_form
from runtime.dis.geodesy import LevelFrame
from runtime.dis.sieve import Address, Sieve
from runtime.dis.timestamps import JUMP, SenderClock, elapsed
from runtime.world.world import World

__all__ = ["Incoming", "Limits", "remote_name"]

Name = tuple[int, int, int]
_FPW, _STATIC = MODELS.index("FPW"), MODELS.index("static")
_FAR = 50_000.0  # [m] from the level's origin, beyond which no entity is taken in
_ODD, _STEADY = 3, 0.2  # packets in a row that disagree; [s] apart, at least, for velocities to be measured
_USELESS, _STIRS = 0.8, 0.5  # share of the way that the velocity told did not foretell; [m/s]
_ALOFT = (LifeForm.JUMPING, LifeForm.SWIMMING, LifeForm.PARACHUTING)
_LIFE_FORM_SPEED = 15.0  # [m/s] of a life form at most


@dataclass(frozen=True)
class Limits:
    """What others may take up. ``entities`` at a time; ``packets`` a second of the world's time, of which one
    second's worth may come at once; ``silence`` [s] after which an entity is gone: 2.4 heartbeats of 5 s."""

    entities: int = 1000
    packets: int = 10_000
    silence: float = LONGEST


def remote_name(name: Name) -> str:
    """What the agent of an entity is called: site, application and entity."""
    return "dis:{}:{}:{}".format(*name)


@dataclass
class _Heard:
    """What is remembered of an entity: who sent it, the last packet, and where it was and how fast [m/s] by
    that. ``odd``: how many packets in a row followed a velocity that the entity did not have (below 0: that
    it had); ``distrusted``: whether the velocities told are not believed."""

    sender: Address
    last: bytes
    stamp: int
    bits: int
    place: np.ndarray
    speed: np.ndarray
    odd: int = 0
    distrusted: bool = False


@dataclass
class Incoming:
    """``own``: our site and application. ``counts``: packets, news, and what was dropped, by kind."""

    world: World
    frame: LevelFrame
    exercise: int
    own: tuple[int, int]
    limits: Limits = field(default_factory=Limits)
    counts: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self._sieve = Sieve(self.exercise, self.counts)
        self._heard: dict[Name, _Heard] = {}
        self._clocks: dict[tuple[int, int, Address], SenderClock] = {}
        self._allowed, self._time = float(self.limits.packets), self.world.time

    def receive(self, packets: Iterable[tuple[bytes, Address]]) -> None:
        """Take in datagrams that have come by the world's present time, each with its sender's address."""
        now = self.world.time
        most = float(self.limits.packets)
        self._allowed = min(self._allowed + max(now - self._time, 0.0) * most, most)
        self._time = now
        taken = []
        for packet in packets:
            if self._allowed < 1.0:
                self.counts["too many packets"] += 1
                continue
            self._allowed -= 1.0
            taken.append(packet)
        if taken:
            records, senders = self._sieve.passed(taken)
            if len(records):
                self._take(records, senders, now)

    def _take(self, records: np.ndarray, senders: list[Address], now: float) -> None:
        motions = self._motions(records)
        near = np.linalg.norm(motions.position, axis=1) <= _FAR
        told = velocities(motions, np.zeros(len(records)), motions.rotation)
        columns = (
            records[name].tolist() for name in ("site", "application", "entity", "timestamp", "appearance")
        )
        corrected: list[tuple[RemoteDriver, int, float, bool]] = []
        for k, (site, application, entity, stamp, bits) in enumerate(zip(*columns, strict=True)):
            name = site, application, entity
            if name[:2] == self.own:
                self.counts["our own"] += 1
                continue
            if not near[k]:
                self.counts["too far away"] += 1
                continue
            heard, driver = self._heard.get(name), self._driver(name)
            if driver is None:
                heard = None
            news = _Heard(senders[k], records[k].tobytes(), stamp, bits, motions.position[k].copy(), told[k])
            if heard is not None and driver is not None and self._is_old(heard, news, driver):
                continue
            appearance = Appearance.of(bits)
            if appearance.deactivated:
                self._remove(name)
                continue
            if driver is None and len(self._heard) >= self.limits.entities:
                self.counts["too many entities"] += 1
                continue
            life = is_life_form(int(records[k]["type"]["kind"]))
            self._mend(heard, news, motions, k, life)
            clock = self._clocks.setdefault((site, application, senders[k]), SenderClock())
            age = min(clock.age(stamp, now), self.limits.silence)
            if appearance.frozen:
                motions.algorithm[k] = _STATIC
            if driver is None:
                driver = self._come(name, records[k], motions.of(np.array([k])), age, life)
            else:
                corrected.append((driver, k, age, heard is None))
            if heard is None or heard.bits != bits:
                self._show(driver, appearance, life)
            self._heard[name] = news
            self.counts["news"] += 1
        if corrected:
            drivers, rows, ages, teleports = zip(*corrected, strict=True)
            indices = np.array([driver.index for driver in drivers])
            drivers[0].population.tell(
                indices, motions.of(np.array(rows)), np.array(ages), np.array(teleports)
            )

    def _is_old(self, heard: _Heard, news: _Heard, driver: RemoteDriver) -> bool:
        """Whether a packet tells nothing new, or is not from whom the entity is."""
        if heard.sender != news.sender:
            self.counts["another sender"] += 1
        elif news.last == heard.last:
            self.counts["repeated"] += 1
            driver.population.heard(driver)
        elif -JUMP < elapsed(news.stamp, heard.stamp) < 0.0:
            self.counts["overtaken"] += 1
        else:
            return False
        return True

    def _motions(self, records: np.ndarray) -> Motion:
        """What records tell, in the level's frame."""
        algorithm = records["algorithm"].astype(np.int64)
        in_body = (algorithm >= MODELS.index("FPB"))[:, None]

        def vectors(name: str) -> np.ndarray:
            told = records[name].astype(np.float64)
            return np.where(in_body, told, self.frame.vectors_to_level(told))

        return Motion(
            algorithm,
            self.frame.to_level(records["location"].astype(np.float64)),
            self.frame.rotations(records["orientation"].astype(np.float64)),
            vectors("velocity"),
            vectors("acceleration"),
            records["angular_velocity"].astype(np.float64),
        )

    def _mend(self, before: _Heard | None, news: _Heard, motions: Motion, row: int, life: bool) -> None:
        """Replace a velocity that is not the entity's by the one that its places show. Only packets in a row
        decide, since each may tell of a turn."""
        if life and np.linalg.norm(news.speed) > _LIFE_FORM_SPEED:
            self.counts["impossible velocities"] += 1
            motions.algorithm[row] = _STATIC
        if before is None:
            return
        news.odd, news.distrusted = before.odd, before.distrusted
        seconds, moved = elapsed(news.stamp, before.stamp), news.place - before.place
        far = float(np.linalg.norm(moved))
        if not _STEADY <= seconds <= self.limits.silence or far > TELEPORT:
            return
        missed = float(np.linalg.norm(moved - before.speed * seconds))
        stirs = far > _STIRS * seconds
        if stirs and missed > _USELESS * far:
            news.odd = max(before.odd, 0) + 1
        elif not stirs or missed < 0.5 * far:
            news.odd = min(before.odd, 0) - 1
        news.distrusted = news.odd >= _ODD or (before.distrusted and news.odd > -_ODD)
        if news.distrusted:
            self.counts["wrong velocities"] += 1
            motions.algorithm[row], motions.velocity[row] = _FPW, moved / seconds

    def _come(self, name: Name, record: np.void, motion: Motion, age: float, life: bool) -> RemoteDriver:
        """A new entity."""
        kind = record["type"]
        look = (animal_of(int(kind["category"]), int(kind["extra"])) or PERSON) if life else THING
        marking = bytes(record["marking"]).split(b"\0")[0].decode("ascii", "replace")
        aloft = Appearance.of(int(record["appearance"])).life_form in _ALOFT
        state = told_state(look, marking, motion, age, on_ground=life and not aloft)
        agent = self.world.admit("remote", remote_name(name), state)
        return agent.simulated(RemoteDriver)

    def _show(self, driver: RemoteDriver, appearance: Appearance, life: bool) -> None:
        """Let a figure look as its simulator says."""
        form, row = appearance.life_form, driver.row
        driver.posture = POSTURES.get(form, STANDS) if life else STANDS
        row["crawling"] = form is LifeForm.CRAWLING
        row["fatal"] = life and appearance.health is Health.FATAL
        row["told_gait"] = {LifeForm.RUNNING: 1.0, LifeForm.WALKING: -1.0}.get(form, 0.0)
        row["on_ground"] = life and form not in _ALOFT

    def _driver(self, name: Name) -> RemoteDriver | None:
        agent = self.world.agents.get(remote_name(name))
        found = None if agent is None else agent.driver.simulated
        return found if isinstance(found, RemoteDriver) else None

    def _remove(self, name: Name) -> None:
        self._heard.pop(name, None)
        agent = self.world.agents.get(remote_name(name))
        if agent is not None:
            agent.remove()
        here = {(*each[:2], heard.sender) for each, heard in self._heard.items()}
        self._clocks = {key: clock for key, clock in self._clocks.items() if key in here}

    def time_out(self) -> None:
        """Remove those of whom nothing has been heard for too long, and forget those that are no more in the
        world."""
        drivers = (self._driver(name) for name in self._heard)
        if not self._heard:  # a restored world may hold some all the same
            drivers = (agent.driver.simulated for agent in self.world.agents.values())
        some = next((each for each in drivers if isinstance(each, RemoteDriver)), None)
        if some is not None:
            figures = some.population
            silent = np.flatnonzero(figures.rows["since_heard"] > self.limits.silence).tolist()
            if not silent and len(figures.drivers) == len(self._heard):
                return
            for driver in [figures.drivers[index] for index in silent]:
                self.counts["timed out"] += 1
                next(each for each in self.world.agents.values() if each.driver is driver).remove()
        for name in [each for each in self._heard if self._driver(each) is None]:
            self._remove(name)

    def leave(self) -> None:
        """Take all entities of others out of the world."""
        for name in tuple(self._heard):
            self._remove(name)
