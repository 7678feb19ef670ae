"""``surefoot serve`` and ``dis``: worlds for others."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.declared.options import (
    BroadcastOption,
    DisListenOption,
    DisNameOption,
    DisOption,
    DisOriginOption,
    JsonOption,
    MulticastOption,
    ScaleOption,
    UpOption,
    dis_line,
)
from runtime.cli.starting import begin, finish, reads


def serve(
    levels: Annotated[
        list[Path],
        typer.Argument(
            callback=reads,
            help="Mesh files, graphs written by `surefoot bake`, or folders of open worlds.",
        ),
    ],
    host: Annotated[
        str, typer.Option(help="Address to listen on; any other than this machine needs --token.")
    ] = ("127.0.0.1"),
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port to listen on; 0: any free port.")] = 8765,
    token: Annotated[
        str, typer.Option(envvar="SUREFOOT_TOKEN", help="Secret that clients must send to connect.")
    ] = "",
    pages: Annotated[Path | None, typer.Option(help="Folder of web pages to serve over HTTP.")] = None,
    up: UpOption = None,
    scale: ScaleOption = None,
    radius: Annotated[
        float, typer.Option(help="[m] Of open worlds: how far around players chunks are loaded.")
    ] = 250.0,
    dis: DisOption = None,
    dis_listen: DisListenOption = None,
    dis_name: DisNameOption = "1:1:1",
    dis_origin: DisOriginOption = (0.0, 0.0, 0.0),
    multicast: MulticastOption = False,
    broadcast: BroadcastOption = False,
) -> None:
    """Run worlds for engines in other languages, over WebSockets. Stop with Ctrl-C. With --dis the first
    world that a client creates talks to other simulators."""
    commands = begin()
    line = dis_line(dis, dis_listen, dis_name, dis_origin, multicast, broadcast)
    commands.serve_worlds(levels, up, scale, radius, commands.Address(host, port, token, pages), line)


class DisAction(StrEnum):
    """What `surefoot dis` does."""

    record = "record"
    replay = "replay"
    show = "show"


def dis(
    action: Annotated[DisAction, typer.Argument(help="Record what comes, send it again, or list it.")],
    file: Annotated[Path, typer.Argument(help="Packets (.pcap).")],
    address: Annotated[
        str,
        typer.Option(metavar="ADDRESS:PORT", help="Where to listen (record) or to send (replay)."),
    ] = "127.0.0.1:3000",
    seconds: Annotated[float, typer.Option(help="[s] How long to record.")] = 10.0,
    speed: Annotated[float, typer.Option(help="How many times faster to replay.")] = 1.0,
    multicast: MulticastOption = False,
    broadcast: BroadcastOption = False,
    as_json: JsonOption = False,
) -> None:
    """Record, replay or show DIS packets."""
    begin()
    from runtime.cli import dis_commands

    if action is DisAction.record:
        result = dis_commands.record_packets(file, address, seconds, multicast, broadcast)
    elif action is DisAction.replay:
        result = dis_commands.replay_packets(file, address, speed, multicast, broadcast)
    else:
        result = dis_commands.show_packets(file)
    finish(result, as_json)
