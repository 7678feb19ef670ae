"""Whose turn it is in the server: long work is done in pieces, and nobody waits for somebody else's."""

import asyncio
import logging
from itertools import pairwise

import pytest

from runtime import World
from runtime.server.logs import Sparing
from runtime.server.turns import Abandoned, Account, Turns
from surefoot.pausing import pause


class Counted:
    """A clock that goes by what the work costs, and who worked when."""

    def __init__(self):
        self.now, self.done = 0.0, []

    def __call__(self):
        return self.now

    def work(self, who, pieces, cost=1.0):
        """So many ``pieces`` of ``cost`` [s]."""

        def pieces_of_work():
            for _ in range(pieces):
                self.now += cost
                self.done.append(who)
                pause()
            return who

        return pieces_of_work


def in_turns(conversation):
    """Run ``conversation(turns, clock)`` while turns are given."""

    async def main():
        clock = Counted()
        turns = Turns(clock)
        task = asyncio.ensure_future(turns.go_round())
        try:
            return await conversation(turns, clock)
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    return asyncio.run(asyncio.wait_for(main(), 60))


@pytest.mark.parametrize("size", [100, 10_000])
@pytest.mark.parametrize("jobs", [1, 20])
def test_others_wait_for_one_piece_of_work_however_much_is_asked_for(size, jobs):
    async def conversation(turns, clock):
        heavy, light = Account(), Account()
        works = [asyncio.ensure_future(turns.run(heavy, clock.work("heavy", size))) for _ in range(jobs)]
        await asyncio.sleep(0)
        for _ in range(30):
            assert await turns.run(light, clock.work("light", 1)) == "light"
        for work in works:
            work.cancel()
        return clock.done

    done = in_turns(conversation)
    lights = [k for k, who in enumerate(done) if who == "light"]
    assert len(lights) == 30
    # one that was begun before it asked, and one on equal terms
    assert max(b - a for a, b in pairwise(lights)) <= 3


def test_time_is_shared_and_not_the_number_of_pieces():
    async def conversation(turns, clock):
        coarse, fine = Account(), Account()
        works = [
            asyncio.ensure_future(turns.run(account, clock.work(who, 100_000, cost)))
            for account, who, cost in ((coarse, "coarse", 0.5), (fine, "fine", 0.002))
        ]
        while clock.now < 100.0:
            await asyncio.sleep(0)
            assert abs(coarse.used - fine.used) <= 0.51
        for work in works:
            work.cancel()
        return clock.done

    done = in_turns(conversation)
    assert done.count("fine") > 100 * done.count("coarse") > 0


def test_each_of_many_has_its_turn_and_nobody_saves_turns_up():
    async def conversation(turns, clock):
        accounts = [Account() for _ in range(40)]
        works = [
            asyncio.ensure_future(turns.run(account, clock.work(k, 50))) for k, account in enumerate(accounts)
        ]
        while clock.now < 400:
            await asyncio.sleep(0)
        late = Account()  # has used nothing so far
        works += [asyncio.ensure_future(turns.run(late, clock.work("late", 50)))]
        await asyncio.gather(*works)
        return clock.done

    done = in_turns(conversation)
    for begin in range(0, 400, 40):
        assert sorted(done[begin : begin + 40]) == list(range(40))
    first = done.index("late")
    assert first - 400 <= 42 and done[first : first + 82].count("late") <= 4


def test_short_pieces_are_done_several_at_a_time():
    async def conversation(turns, clock):
        await turns.run(Account(), clock.work("short", 1000, 1e-5))
        return turns.pieces

    assert in_turns(conversation) == 1001  # and the end


def test_errors_come_to_who_asked_and_unwanted_work_ends_where_it_is():
    async def conversation(turns, clock):
        account, put_away = Account(), []

        def fails():
            pause()
            raise ValueError("no")

        def interrupted():
            try:
                clock.work("cut", 1000)()
            finally:
                put_away.append(clock.done.count("cut"))

        with pytest.raises(ValueError, match="no"):
            await turns.run(account, fails)
        with pytest.raises(Abandoned):
            await turns.run(account, interrupted, lambda: clock.done.count("cut") < 7)
        assert put_away == [7]
        cut = asyncio.ensure_future(turns.run(account, interrupted))
        while clock.done.count("cut") < 20:
            await asyncio.sleep(0)
        cut.cancel()
        assert await turns.run(account, clock.work("next", 3)) == "next"
        assert len(put_away) == 2 and put_away[1] < 30

    in_turns(conversation)


def test_a_world_that_is_stepped_in_turns_goes_on_as_one_stepped_at_once(graph):
    def make():
        world = World(graph, seed=2)
        for number, y in enumerate((1.0, 2.5, 4.0)):
            world.spawn("human", (2.0, y, 0.0), name=f"p{number}").go_to((9.0, 5.0 - y, 0.0), speed=3.0)
        world.spawn("dog", (3.0, 5.0, 0.0)).go_to((9.0, 1.0, 0.0), speed=1.5)
        return world

    alone = make()
    alone.step(1.0)

    async def conversation(turns, clock):
        worlds = [make() for _ in range(3)]
        await asyncio.gather(*(turns.run(Account(), lambda world=world: world.step(1.0)) for world in worlds))
        assert turns.pieces > 3 * 100 * 4  # people, dogs and walkers, and their choices
        return worlds

    worlds = in_turns(conversation)
    assert {world.state_hash() for world in worlds} == {alone.state_hash()}


def test_a_log_is_not_filled_and_says_what_it_left_out():
    def entry(at, text):
        record = logging.LogRecord("surefoot.serve", logging.ERROR, "", 0, text, (), None)
        record.created = at
        return record

    sparing = Sparing()
    kept = [sparing.filter(entry(100.0 + 0.01 * k, "again")) for k in range(1000)]
    assert kept == [True] * 10 + [False] * 990
    later = entry(161.0, "another")
    assert sparing.filter(later)
    assert later.getMessage() == "another (990 more entries were dropped before this one)"
    assert sparing.filter(entry(161.1, "third"))
