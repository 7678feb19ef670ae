"""Opening a page in headless Chromium and looking at it until something is drawn."""

import base64
import io
import json
import shutil
import subprocess
import time
import urllib.request
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


def screenshot(
    page: Path, profile: Path, size: tuple[int, int], is_drawn, seconds: float
) -> np.ndarray | None:
    """The first picture (h, w, 3) of ``page`` for which ``is_drawn(picture)``; None after ``seconds``."""
    assert BROWSER is not None
    command = [
        BROWSER,
        *FLAGS,
        f"--window-size={size[0]},{size[1]}",
        f"--user-data-dir={profile}",
        page.as_uri(),
    ]
    browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + seconds
    try:
        address = _page_address(profile / "DevToolsActivePort", deadline)
        if address is None:
            return None
        with connect(address, max_size=None, open_timeout=60) as socket:
            while time.monotonic() < deadline:
                socket.send(json.dumps({"id": 1, "method": "Page.captureScreenshot"}))
                answer = json.loads(socket.recv(timeout=max(deadline - time.monotonic(), 0.1)))
                if "result" not in answer:
                    continue
                content = io.BytesIO(base64.b64decode(answer["result"]["data"]))
                picture = matplotlib.image.imread(content, format="png")[..., :3]
                if is_drawn(picture):
                    return picture
    except TimeoutError:
        return None
    finally:
        browser.terminate()
        browser.wait(30)
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
