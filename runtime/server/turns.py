"""Scheduling: each client's share of the server's time.

Work is done in pieces. Of the accounts with waiting work, the one that has used the least time has the next
turn. Idle accounts do not save time up: they resume where the others are. So however much one client
requests, the others wait for one turn at a time.
"""

import asyncio
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from runtime.server.worker import Abandoned, Worker

__all__ = ["Abandoned", "Account", "Turns"]

_TURN = 0.001  # [s] least length of a turn; shorter pieces are combined
_PASSES = 6  # event loop cycles between turns: read a request, accept it, answer, send


class _Job:
    def __init__(self, work: Callable[[], Any], wanted: Callable[[], bool]) -> None:
        self.work, self.wanted = work, wanted
        self.done: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self.worker: Worker | None = None


class Account:
    """``used``: time [s] used, including credit for idle periods."""

    def __init__(self) -> None:
        self.used = 0.0
        self.jobs: deque[_Job] = deque()


class Turns:
    """``clock`` returns the time [s]. ``pieces`` counts those done."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self.pieces = 0
        self._clock = clock
        self._waiting: dict[Account, None] = {}
        self._more = asyncio.Event()
        self._idle: list[Worker] = []
        self._now = 0.0  # time used by the account that had the last turn

    async def run(
        self, account: Account, work: Callable[[], Any], wanted: Callable[[], bool] = lambda: True
    ) -> Any:
        """Run ``work`` in turns; returns its result or raises its error. If it is no longer ``wanted`` it is
        stopped, and `Abandoned` is raised."""
        job = _Job(work, wanted)
        if not account.jobs:
            account.used = max(account.used, self._now)
            self._waiting[account] = None
        account.jobs.append(job)
        self._more.set()
        return await job.done

    async def go_round(self) -> None:
        """Schedule turns until cancelled."""
        try:
            while True:
                if self._waiting:
                    self._give_turn(min(self._waiting, key=lambda account: account.used))
                    for _ in range(_PASSES):
                        await asyncio.sleep(0)
                else:
                    self._more.clear()
                    await self._more.wait()
        finally:
            for account in self._waiting:
                for job in account.jobs:
                    self._end(job)
            for worker in self._idle:
                worker.end()

    def _give_turn(self, account: Account) -> None:
        job = account.jobs.popleft()
        self._now, begun = account.used, self._clock()
        while (going := self._go_on(job)) and self._clock() - begun < _TURN:
            pass
        account.used += self._clock() - begun
        if going:
            account.jobs.append(job)
        if not account.jobs:
            del self._waiting[account]

    def _go_on(self, job: _Job) -> bool:
        """Do a piece of a job. Returns whether there is more to do."""
        if job.done.done() or not job.wanted():
            self._end(job)
            return False
        self.pieces += 1
        if job.worker is None:
            job.worker = self._idle.pop() if self._idle else Worker()
            job.worker.begin(job.work)
        if job.worker.go_on():
            return True
        worker, job.worker = job.worker, None
        self._idle.append(worker)
        if worker.error is None:
            job.done.set_result(worker.result)
        else:
            job.done.set_exception(worker.error)
        return False

    def _end(self, job: _Job) -> None:
        """Abort a job."""
        if job.worker is not None:
            job.worker.abandon()
            self._idle.append(job.worker)
            job.worker = None
        if not job.done.done():
            job.done.set_exception(Abandoned())
