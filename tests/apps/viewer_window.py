"""exemplar-viewer for tests: with pictures in files, and in a window on a display of its own (Xvfb)."""

import os
import pathlib
import shutil
import struct
import subprocess
import time
import unittest

from program import ProgramTest

VIEWER = pathlib.Path(os.environ.get("EXEMPLAR_VIEWER", "build/exemplar-viewer")).absolute()
WIDTH, HEIGHT = 1280, 720  # of the display


class ViewerTest(ProgramTest):
    """Without a window; the validation layer is on."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.environment.setdefault("XDG_RUNTIME_DIR", str(cls.folder))
        cls.environment["EXEMPLAR_VALIDATION"] = "1"

    @classmethod
    def view(cls, *arguments, code=0):
        return cls.call(*arguments, code=code, program=VIEWER)


@unittest.skipUnless(shutil.which("Xvfb") and shutil.which("xdotool"), "needs Xvfb and xdotool")
class WindowTest(ViewerTest):
    """In a window, moved by real events of mouse and keys."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        reader, writer = os.pipe()
        cls.display = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", f"{WIDTH}x{HEIGHT}x24",
                                        "-fbdir", str(cls.folder), "-nolisten", "tcp", "-nocursor", "-noreset"], pass_fds=[writer],
                                       stderr=subprocess.DEVNULL)
        cls.addClassCleanup(cls.end_display)
        os.close(writer)
        with os.fdopen(reader) as file:
            cls.environment["DISPLAY"] = ":" + file.readline().strip()
        cls.environment.pop("WAYLAND_DISPLAY", None)

    @classmethod
    def end_display(cls):
        cls.display.terminate()
        cls.display.wait()

    def screen(self, width, height):
        """RGB of the upper left part of the screen, where windows open without a window manager."""
        data = (self.folder / "Xvfb_screen0").read_bytes()
        head = struct.unpack(">25I", data[:100])
        at, stride = head[0] + 12 * head[19], head[12]
        self.assertEqual((head[11], head[7]), (32, 0))  # bits per pixel, lowest byte first
        rows = []
        for y in range(height):
            row = data[at + y * stride:at + y * stride + 4 * width]
            rgb = bytearray(3 * width)
            rgb[0::3], rgb[1::3], rgb[2::3] = row[2::4], row[1::4], row[0::4]
            rows.append(bytes(rgb))
        return b"".join(rows)

    def difference(self, picture):
        width, height, pixels = picture
        screen = self.screen(width, height)
        return max(abs(a - b) for a, b in zip(screen, pixels))

    def until(self, condition, what):
        end = time.monotonic() + 60
        while not condition():
            if time.monotonic() > end:
                self.fail(f"waited in vain until {what}")
            time.sleep(0.1)

    def open(self, *arguments):
        process = self.start("--quiet", *arguments, program=VIEWER)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.until(lambda: process.poll() is not None or self.windows(process), "the window opens")
        self.assertIsNone(process.poll(), process.poll() and process.communicate())
        return process, self.windows(process)[0]

    def windows(self, process):
        return self.xdotool("search", "--pid", process.pid, "--name", "Exemplar", check=False).split()

    def xdotool(self, *arguments, check=True):
        result = subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, text=True, timeout=60,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
        if check:
            self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def closes_well(self, process):
        """By its key; validation messages make the exit code 1."""
        self.xdotool("mousemove", 200, 100, "key", "ctrl+q")
        errors = process.communicate(timeout=60)[1]
        self.assertEqual((process.returncode, errors), (0, ""))
