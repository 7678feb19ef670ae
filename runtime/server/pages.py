"""Serve the files of one folder over HTTP, for pages that talk to the server."""

import http
from email.utils import formatdate
from pathlib import Path
from urllib.parse import unquote, urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Response

__all__ = ["page_of"]

_TYPES = {
    ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".mjs": "text/javascript",
    ".json": "application/json", ".wasm": "application/wasm",
    ".svg": "image/svg+xml", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg",
    ".gif": "image/gif", ".webp": "image/webp", ".ico": "image/x-icon",
    ".woff": "font/woff", ".woff2": "font/woff2", ".ttf": "font/ttf",
    ".glb": "model/gltf-binary", ".gltf": "model/gltf+json",
    ".mp3": "audio/mpeg", ".ogg": "audio/ogg", ".mp4": "video/mp4", ".webm": "video/webm",
}  # fmt: skip
"""File types that are served."""
_LARGEST = 64_000_000  # [bytes] of a file


def page_of(connection: ServerConnection, path: str, folder: Path | None) -> Response:
    """The file of ``folder`` that ``path`` names, ``index.html`` for a folder; 404 for any other.

    Serves only files inside the folder, of the types that pages use, without names or folders that begin with
    a dot. Links count by their target.
    """
    if folder is None:
        return connection.respond(http.HTTPStatus.UPGRADE_REQUIRED, "this is a WebSocket server\n")
    file = _served(folder.resolve(), unquote(urlsplit(path).path))
    try:
        body = None if file is None else file.read_bytes()
    except OSError:
        body = None
    if file is None or body is None:
        return connection.respond(http.HTTPStatus.NOT_FOUND, "there is no such file\n")
    headers = Headers(
        {
            "Date": formatdate(usegmt=True),
            "Connection": "close",
            "Content-Length": str(len(body)),
            "Content-Type": _TYPES[file.suffix.lower()],
            "X-Content-Type-Options": "nosniff",
        }
    )
    return Response(200, "OK", headers, body)


def _served(root: Path, path: str) -> Path | None:
    """The file of the folder ``root`` that ``path`` names, None if it must not be served."""
    try:
        file = (root / path.lstrip("/")).resolve()
        file = (file / "index.html").resolve() if file.is_dir() else file
        if not file.is_relative_to(root) or file.suffix.lower() not in _TYPES:
            return None
        hidden = any(part.startswith(".") for part in file.relative_to(root).parts)
        return file if not hidden and file.is_file() and file.stat().st_size <= _LARGEST else None
    except (OSError, ValueError, RuntimeError):  # invalid names, or links in a circle
        return None
