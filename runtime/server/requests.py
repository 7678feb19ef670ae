"""Handlers of client requests.

Long work is done in the turns of the client that requested it, one request at a time in each world.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

from runtime.errors import RuntimeInputError
from runtime.server import messages as m
from runtime.server.client import Client
from runtime.server.hosted import HostedWorld, skeleton, way_message
from runtime.server.levels import Levels
from runtime.server.turns import Abandoned, Turns
from runtime.server.worlds import Worlds
from runtime.world.level_of_detail import Viewer

__all__ = ["Requests"]


class Requests:
    """Handles requests about ``worlds`` on ``levels``."""

    def __init__(self, levels: Levels, worlds: Worlds, turns: Turns) -> None:
        self._levels, self._worlds, self._turns = levels, worlds, turns

    async def result(self, client: Client, request: Any) -> dict[str, Any] | bytes:
        """Fields of the reply, or their JSON text. Raises `RuntimeInputError`, and `ValueError` from what was
        requested."""
        return await getattr(self, f"_do_{request.type}")(client, request)

    async def advance(self, hosted: HostedWorld, client: Client, dt: Callable[[], float]) -> None:
        """Advance a world by ``dt()`` [s] in the turns of ``client``."""
        await self._work(client, hosted, lambda: hosted.step(dt()))

    async def _work(
        self, client: Client, hosted: HostedWorld, work: Callable[[], Any], told: bool = True
    ) -> Any:
        """Run ``work`` and return its result; its events are sent to all members of the world."""
        try:
            async with hosted.lock:
                found = await self._turns.run(client.account, work, lambda: not hosted.closed)
                if told:
                    self._worlds.tell(hosted)
                return found
        except Abandoned:
            raise RuntimeInputError(f"world {hosted.name!r} has been closed") from None

    # ---
    async def _do_hello(self, client: Client, request: m.Hello) -> Any:
        raise RuntimeInputError("hello was sent already")

    async def _do_level(self, client: Client, request: m.Level) -> Any:
        return self._levels.mesh(request.level)

    async def _do_graph(self, client: Client, request: m.Graph) -> Any:
        return self._levels.graph(request.level)

    async def _do_chunk(self, client: Client, request: m.Chunk) -> Any:
        return self._levels.chunk(request.level, request.chunk)

    async def _do_create(self, client: Client, request: m.Create) -> Any:
        self._worlds.check_world(client)
        name, manual = self._worlds.new_name(), request.clock == "manual"

        def make() -> HostedWorld:
            start = self._levels.start(request.level, request.around)
            made = HostedWorld(name, request.level, start, request.seed, manual)
            if request.around:
                made.play(client, request.around)
            return made

        hosted = await self._turns.run(client.account, make)
        self._worlds.connect(hosted)
        self._worlds.hosted[name] = hosted
        self._worlds.join(client, hosted, request.states)  # at once, or it would count as deserted
        return await self._join(client, hosted, request.states)

    async def _do_join(self, client: Client, request: m.Join) -> Any:
        return await self._join(client, self._worlds.named(request.world), request.states)

    async def _join(self, client: Client, hosted: HostedWorld, states: m.States) -> Any:
        joined = await self._work(client, hosted, partial(hosted.join, states), told=False)
        self._worlds.join(client, hosted, states)
        return {**joined, "loaded": list(hosted.loaded)}

    async def _do_leave(self, client: Client, request: m.Leave) -> Any:
        hosted = self._worlds.hosted.get(request.world)
        return {"left": hosted is not None and self._worlds.leave(client, hosted)}

    async def _do_close(self, client: Client, request: m.Close) -> Any:
        self._worlds.close(self._worlds.joined(client, request.world))
        return {}

    async def _do_spawn(self, client: Client, request: m.Spawn) -> Any:
        hosted = self._worlds.joined(client, request.world)

        def spawn() -> Any:
            self._worlds.check_room(hosted)
            self._worlds.check_agents(client, 1)
            agent = hosted.spawn(request.body, request.at, request.facing, request.name, request.detail)
            hosted.spawned[agent.name] = client
            return agent

        agent = await self._work(client, hosted, spawn, told=False)
        self._worlds.announce(hosted, {"type": "agent", "world": hosted.name, "agent": skeleton(agent)})
        self._worlds.tell(hosted)
        return {"agent": agent.name}

    async def _do_go_to(self, client: Client, request: m.GoTo) -> Any:
        hosted = self._worlds.joined(client, request.world)
        go_to = partial(hosted.go_to, request.agent, request.points, request.speed, request.facing)
        status = await self._work(client, hosted, go_to, told=False)
        self._worlds.tell_events(hosted)
        return {"status": status}

    async def _tell(self, client: Client, world: str, tell: Callable[[HostedWorld], Any]) -> Any:
        """Have ``tell`` done with a hosted world."""
        hosted = self._worlds.joined(client, world)
        await self._work(client, hosted, partial(tell, hosted))
        return {}

    async def _do_posture(self, client: Client, request: m.TakePosture) -> Any:
        return await self._tell(
            client, request.world, lambda hosted: hosted.agent(request.agent).take_posture(request.posture)
        )

    async def _do_hold(self, client: Client, request: m.Hold) -> Any:
        return await self._tell(
            client,
            request.world,
            lambda hosted: hosted.agent(request.agent).hold(request.object, request.state),
        )

    async def _do_detail(self, client: Client, request: m.SetDetail) -> Any:
        return await self._tell(
            client,
            request.world,
            lambda hosted: setattr(hosted.agent(request.agent), "detail", request.detail),
        )

    async def _do_style(self, client: Client, request: m.SetStyle) -> Any:
        hosted = self._worlds.joined(client, request.world)

        def dress() -> dict[str, Any]:
            agent = hosted.agent(request.agent)
            agent.set_style(**request.traits)
            return skeleton(agent)

        dressed = await self._work(client, hosted, dress)
        if "size" in request.traits:
            self._worlds.announce(hosted, {"type": "agent", "world": hosted.name, "agent": dressed})
        return {}

    async def _do_push(self, client: Client, request: m.Push) -> Any:
        return await self._tell(
            client,
            request.world,
            lambda hosted: hosted.agent(request.agent).push(request.force, request.seconds),
        )

    async def _do_viewers(self, client: Client, request: m.Viewers) -> Any:
        viewers = [Viewer(each.position, each.direction, each.field_of_view) for each in request.viewers]
        return await self._tell(
            client, request.world, lambda hosted: setattr(hosted.world, "viewers", viewers)
        )

    async def _do_players(self, client: Client, request: m.Players) -> Any:
        return await self._tell(client, request.world, lambda hosted: hosted.play(client, request.players))

    async def _do_stop(self, client: Client, request: m.Stop) -> Any:
        hosted = self._worlds.joined(client, request.world)
        return {"status": await self._work(client, hosted, partial(hosted.stop, request.agent), told=False)}

    async def _do_way(self, client: Client, request: m.Way) -> Any:
        hosted = self._worlds.joined(client, request.world)
        return await self._work(client, hosted, lambda: way_message(hosted.agent(request.agent)), told=False)

    async def _do_remove(self, client: Client, request: m.Remove) -> Any:
        hosted = self._worlds.joined(client, request.world)
        await self._work(client, hosted, partial(hosted.remove, request.agent), told=False)
        self._worlds.announce(hosted, {"type": "gone", "world": hosted.name, "agent": request.agent})
        self._worlds.tell(hosted)
        return {}

    async def _do_step(self, client: Client, request: m.Step) -> Any:
        hosted = self._worlds.joined(client, request.world)
        if not hosted.manual:
            raise RuntimeInputError(
                f"world {hosted.name!r} runs by itself; create it with the clock 'manual' to step it"
            )
        ticks = await self._work(client, hosted, partial(hosted.step, request.dt))
        return {"ticks": ticks, "time": hosted.world.time}

    async def _do_save(self, client: Client, request: m.Save) -> Any:
        hosted = self._worlds.joined(client, request.world)
        return await self._work(client, hosted, hosted.save, told=False)

    async def _do_restore(self, client: Client, request: m.Restore) -> Any:
        hosted = self._worlds.joined(client, request.world)

        def restore() -> Any:
            before = set(hosted.world.agents)
            if hosted.saved is not None:
                self._worlds.check_agents(client, len(hosted.saved.agents.keys() - before))
            found, now = hosted.restore(), hosted.world.agents
            return found, sorted(before - now.keys()), [now[name] for name in now if name not in before]

        found, gone, come = await self._work(client, hosted, restore, told=False)
        for name in gone:
            self._worlds.announce(hosted, {"type": "gone", "world": hosted.name, "agent": name})
        for agent in come:
            self._worlds.announce(hosted, {"type": "agent", "world": hosted.name, "agent": skeleton(agent)})
        self._worlds.tell(hosted)
        return found
