"""Opening a page in headless Chromium and looking at it until something is drawn."""

import base64
import io
import json
import shutil
import subprocess
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import matplotlib.image
import numpy as np
from websockets.sync.client import connect

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-port=0",
)


class Page:
    """A page that is open in a browser."""

    def __init__(self, socket, deadline: float) -> None:
        self._socket, self._deadline, self._id = socket, deadline, 0

    def call(self, method: str, **params) -> dict:
        """The result of a method of the DevTools protocol, empty if it failed."""
        self._id += 1
        self._socket.send(json.dumps({"id": self._id, "method": method, "params": params}))
        while True:
            answer = json.loads(self._socket.recv(timeout=max(self._deadline - time.monotonic(), 0.1)))
            if answer.get("id") == self._id:
                return answer.get("result", {})

    def value(self, expression: str):
        """What a JavaScript expression gives."""
        return self.call("Runtime.evaluate", expression=expression).get("result", {}).get("value")

    def click(self, x: float, y: float, modifiers: int = 0) -> None:
        """Go there, press and release the left button; ``modifiers``: 8 is shift."""
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        for kind in ("mousePressed", "mouseReleased"):
            self.call(
                "Input.dispatchMouseEvent",
                type=kind, x=x, y=y, button="left", clickCount=1, modifiers=modifiers,
            )  # fmt: skip

    def picture(self) -> np.ndarray | None:
        """(h, w, 3), 0 to 1."""
        data = self.call("Page.captureScreenshot").get("data")
        if data is None:
            return None
        return matplotlib.image.imread(io.BytesIO(base64.b64decode(data)), format="png")[..., :3]


@contextmanager
def opened(address: str, profile: Path, size: tuple[int, int], seconds: float) -> Iterator[Page | None]:
    """The page at ``address``; None when there is none in time. Its calls raise TimeoutError afterwards."""
    assert BROWSER is not None
    command = [
        BROWSER, *FLAGS, f"--window-size={size[0]},{size[1]}", f"--user-data-dir={profile}", address
    ]  # fmt: skip
    browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + seconds
    try:
        debugging = _page_address(profile / "DevToolsActivePort", deadline)
        if debugging is None:
            yield None
        else:
            with connect(debugging, max_size=None, open_timeout=60) as socket:
                yield Page(socket, deadline)
    finally:
        browser.terminate()
        browser.wait(30)


def screenshot(
    page: Path, profile: Path, size: tuple[int, int], is_drawn, seconds: float
) -> np.ndarray | None:
    """The first picture (h, w, 3) of ``page`` for which ``is_drawn(picture)``; None after ``seconds``."""
    deadline = time.monotonic() + seconds
    try:
        with opened(page.as_uri(), profile, size, seconds) as shown:
            while shown is not None and time.monotonic() < deadline:
                picture = shown.picture()
                if picture is not None and is_drawn(picture):
                    return picture
    except TimeoutError:
        pass
    return None


def _page_address(port_file: Path, deadline: float) -> str | None:
    """The debugging address of the first page, once there is one."""
    while time.monotonic() < deadline:
        if port_file.is_file() and (lines := port_file.read_text().split()):
            with urllib.request.urlopen(f"http://127.0.0.1:{lines[0]}/json/list", timeout=60) as answer:
                for target in json.load(answer):
                    if target["type"] == "page":
                        return target["webSocketDebuggerUrl"]
        time.sleep(0.2)
    return None
