"""Files of one folder over HTTP, for pages that talk to the server."""

import http
import mimetypes
from email.utils import formatdate
from pathlib import Path
from urllib.parse import unquote, urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Response

__all__ = ["page_of"]

_TYPES = {".js": "text/javascript", ".mjs": "text/javascript"}


def page_of(connection: ServerConnection, path: str, folder: Path | None) -> Response:
    """The file of ``folder`` that ``path`` names, ``index.html`` for a folder; 404 for any other, also for
    what lies outside."""
    if folder is None:
        return connection.respond(http.HTTPStatus.UPGRADE_REQUIRED, "this is a WebSocket server\n")
    root = folder.resolve()
    try:
        file = (root / unquote(urlsplit(path).path).lstrip("/")).resolve()
        file = file / "index.html" if file.is_dir() else file
        inside = file.is_relative_to(root) and file.is_file()
        body = file.read_bytes() if inside else None
    except (OSError, ValueError):
        body = None
    if body is None:
        return connection.respond(http.HTTPStatus.NOT_FOUND, "there is no such file\n")
    kind = _TYPES.get(file.suffix) or mimetypes.guess_type(file.name)[0] or "application/octet-stream"
    headers = Headers(
        {
            "Date": formatdate(usegmt=True),
            "Connection": "close",
            "Content-Length": str(len(body)),
            "Content-Type": kind,
        }
    )
    return Response(200, "OK", headers, body)
