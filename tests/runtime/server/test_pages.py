"""Pages come from one folder, and nothing else comes with them."""

import asyncio
import urllib.error
import urllib.request

import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from runtime.server.pages import _served
from tests.runtime.server.serving import talk


def test_pages_come_from_one_folder_only_and_are_what_pages_are_made_of(graph, tmp_path):
    pages = tmp_path / "pages"
    for folder in (".git", "code", "data.html"):
        (pages / folder).mkdir(parents=True)
    (pages / "index.html").write_text("<p>here</p>")
    (pages / "page.JS").write_text("here()")
    (pages / "data.html" / "index.html").write_text("<p>there</p>")
    (tmp_path / "secret.js").write_text("no")
    for name in (".git/config", ".git/index.html", ".env.js", "code/run.py", "key", "key.pem", "notes.yaml"):
        (pages / name).write_text("no")
    for name, target in (
        ("out.js", tmp_path / "secret.js"), ("dot.html", pages / ".git/index.html"),
        ("typed.js", pages / "key.pem"), ("circle.js", pages / "circle.js"), ("up", tmp_path),
    ):  # fmt: skip
        (pages / name).symlink_to(target)
    (pages / "alias.js").symlink_to(pages / "page.JS")

    def fetch(port, path):
        with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=20) as answer:
            return answer.read().decode(), answer.headers["Content-Type"]

    async def conversation(server, join, port):
        assert await asyncio.to_thread(fetch, port, "/") == ("<p>here</p>", "text/html")
        assert await asyncio.to_thread(fetch, port, "/page.JS?v=1") == ("here()", "text/javascript")
        assert await asyncio.to_thread(fetch, port, "/alias.js") == ("here()", "text/javascript")
        assert await asyncio.to_thread(fetch, port, "/data.html/") == ("<p>there</p>", "text/html")
        for path in (
            "/../secret.js", "/%2e%2e/secret.js", "/nothing", "/%00", "/.git/config", "/.git", "/.env.js",
            "/.git/index.html", "/%2egit/config", "/code/run.py", "/key", "/key.pem", "/notes.yaml", "/code",
            "/out.js", "/dot.html", "/typed.js", "/circle.js", "/up/secret.js", "//etc/passwd",
            f"/{'x' * 3000}.js",
        ):  # fmt: skip
            with pytest.raises(urllib.error.HTTPError) as error:
                await asyncio.to_thread(fetch, port, path)
            assert error.value.code == 404
            error.value.close()

    talk(graph, conversation, pages=pages)


def test_a_file_too_large_is_not_served(tmp_path, monkeypatch):
    monkeypatch.setattr("runtime.server.pages._LARGEST", 4)
    for name, content in (("small.js", "1234"), ("large.js", "12345")):
        (tmp_path / name).write_text(content)
    assert _served(tmp_path, "/small.js") == tmp_path / "small.js"
    assert _served(tmp_path, "/large.js") is None
