"""A headless Chromium driven by chromedriver (WebDriver over HTTP), with nothing but Python's own library."""

import atexit
import base64
import contextlib
import json
import os
import pathlib
import select
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
import zlib

# A software renderer draws WebGL the same on every machine; a container gives Chromium no sandbox and little /dev/shm.
SWITCHES = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run",
            "--disable-background-networking", "--force-device-scale-factor=1", "--hide-scrollbars"]
SOFTWARE_GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
START_SECONDS = 60
CALL_SECONDS = 120


def missing_programs():
    return [name for name in ("chromium", "chromedriver") if not shutil.which(name)]


class Browser(contextlib.AbstractContextManager):
    """One browser window of a size. Its files and processes live in a folder of its own and end with it."""

    def __init__(self, *switches, width=1280, height=900):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="exemplar-browser-"))
        self.driver = None
        self.session = ""
        atexit.register(self.close)  # also when an interrupt ends the program
        try:
            self.base = f"http://127.0.0.1:{self._start_driver()}"
            options = {"binary": shutil.which("chromium"),
                       "args": [*SWITCHES, *switches, f"--user-data-dir={self.folder}/profile"],
                       "mobileEmulation": {"deviceMetrics": {"width": width, "height": height, "pixelRatio": 1.0,
                                                             "mobile": False, "touch": False}}}
            answer = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
                "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}}})
            self.session = f"/session/{answer['sessionId']}"
        except BaseException:
            self.close()
            raise

    def __exit__(self, *_):
        self.close()

    # ---- life

    def _start_driver(self):
        """Starts chromedriver as the leader of a process group and returns its port, which it chooses and prints."""
        environment = dict(os.environ, HOME=str(self.folder), XDG_CONFIG_HOME=f"{self.folder}/config",
                           XDG_CACHE_HOME=f"{self.folder}/cache", TMPDIR=str(self.folder))
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], env=environment, stdin=subprocess.DEVNULL,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        said, end = b"", time.monotonic() + START_SECONDS
        while time.monotonic() < end:
            if not select.select([self.driver.stdout], [], [], 1)[0]:
                continue
            piece = os.read(self.driver.stdout.fileno(), 4096)
            said += piece
            for line in said.decode(errors="replace").splitlines():
                if "started successfully on port" in line and line.rstrip().endswith("."):
                    return int(line.rstrip(" .").rsplit(" ", 1)[1])
            if not piece:
                break
        raise RuntimeError(f"chromedriver did not start: {said.decode(errors='replace')}")

    def close(self):
        """Ends the browser, asking first; what is left of its processes is killed."""
        atexit.unregister(self.close)
        with contextlib.suppress(Exception):
            if self.session:
                self._call("DELETE", self.session)
        if self.driver:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.driver.pid, signal.SIGTERM)
            try:
                self.driver.wait(10)
            except subprocess.TimeoutExpired:
                os.killpg(self.driver.pid, signal.SIGKILL)
                self.driver.wait()
            self.driver.stdout.close()
        end = time.monotonic() + 10
        while self.processes() and time.monotonic() < end:
            time.sleep(0.1)
        for process in self.processes():
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        self.driver, self.session = None, ""
        shutil.rmtree(self.folder, ignore_errors=True)

    def processes(self):
        """The living processes of this browser: all that have its folder in their environment or command line."""
        mark, found = os.fsencode(self.folder), []
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                if mark in (entry / "cmdline").read_bytes() or mark in (entry / "environ").read_bytes():
                    found.append(int(entry.name))
        return found

    # ---- what a person does and sees

    def _call(self, method, path, body=None):
        data = json.dumps(body or {}).encode() if method == "POST" else None
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            # No proxy stands between this machine and itself.
            opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
            with opener.open(request, timeout=CALL_SECONDS) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{method} {path}: {error.read().decode(errors='replace')[:2000]}") from None

    def post(self, path, **body):
        return self._call("POST", self.session + path, body)

    def open(self, path):
        self.post("/url", url=pathlib.Path(path).absolute().as_uri())

    def script(self, text, *arguments):
        """The value of a JavaScript function body, whose arguments[i] are given."""
        return self.post("/execute/sync", script=text, args=[self._handle(a) for a in arguments])

    def developer_command(self, name, **parameters):
        return self.post("/goog/cdp/execute", cmd=name, params=parameters)

    def find(self, selector):
        return self.post("/element", using="css selector", value=selector)[ELEMENT]

    def find_all(self, selector):
        return [found[ELEMENT] for found in self.post("/elements", using="css selector", value=selector)]

    def click(self, element):
        self.post(f"/element/{element}/click")

    def press(self, *keys):
        actions = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        self.post("/actions", actions=[{"type": "key", "id": "keys", "actions": actions}])

    def drag(self, element, dx, dy, steps=4):
        """Presses the mouse in the middle of an element, moves it in steps and lets go."""
        origin = {ELEMENT: element}
        moves = [{"type": "pointerMove", "duration": 20, "origin": origin,
                  "x": round(dx * i / steps), "y": round(dy * i / steps)}
                 for i in range(steps + 1)]
        actions = [moves[0], {"type": "pointerDown", "button": 0}, *moves[1:], {"type": "pointerUp", "button": 0}]
        self.post("/actions", actions=[{"type": "pointer", "id": "mouse", "actions": actions}])

    def wait_for(self, text, *arguments, seconds=30):
        """Waits until a JavaScript expression is true."""
        end = time.monotonic() + seconds
        while not self.script(f"return Boolean({text})", *arguments):
            if time.monotonic() > end:
                raise TimeoutError(f"not within {seconds} s: {text}")
            time.sleep(0.05)

    def settle(self):
        """Waits until what was asked for is drawn: two frames later."""
        self.post("/execute/async", script="const done = arguments[0];"
                  "requestAnimationFrame(() => requestAnimationFrame(() => done(null)))", args=[])

    def screenshot(self, element):
        """An element as the screen shows it (see read_png)."""
        return read_png(base64.b64decode(self._call("GET", f"{self.session}/element/{element}/screenshot")))

    def messages(self):
        """What the console has said since the last call, page errors included."""
        return [f"{entry['level']}: {entry['message']}" for entry in self.post("/se/log", type="browser")]

    @staticmethod
    def _handle(value):
        return {ELEMENT: value} if isinstance(value, str) and value.startswith("f.") else value


def read_png(data):
    """(width, height, channels, rows of bytes) of a PNG file with 8 bits per channel, not interlaced."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG file")
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlace = struct.unpack(">IIBBBBB", data[at + 8:at + 21])
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    channels = {2: 3, 6: 4}[color]
    if depth != 8 or interlace:
        raise ValueError("a PNG of another kind than browsers write")
    return width, height, channels, _unfiltered(zlib.decompress(packed), width * channels, channels)


def _unfiltered(raw, stride, channels):
    rows, above = [], bytearray(stride)
    for start in range(0, len(raw), stride + 1):
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride if kind else 0):
            left, up = (row[i - channels] if i >= channels else 0), above[i]
            corner = above[i - channels] if i >= channels else 0
            row[i] = (row[i] + (left, up, (left + up) // 2, _paeth(left, up, corner))[kind - 1]) & 255
        rows.append(bytes(row))
        above = row
    return rows


def _paeth(left, up, corner):
    guess = left + up - corner
    return min((left, up, corner), key=lambda value: abs(guess - value))


def changed_share(one, other):
    """The share of the pixels of two pictures that differ; 1 if their sizes do."""
    width, height, channels, rows = one
    if (width, height, channels) != other[:3]:
        return 1.0
    changed = 0
    for a, b in zip(rows, other[3]):
        if a != b:
            changed += sum(a[i:i + channels] != b[i:i + channels] for i in range(0, len(a), channels))
    return changed / (width * height)
