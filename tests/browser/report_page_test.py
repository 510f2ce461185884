"""Opens a report page in headless Chromium, turns its meshes with real input events and reads its tables.

    report_page_test.py MAKE_PAGE

MAKE_PAGE is the program that writes the page. Exit code 77 says that the test was skipped, and why."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from chromium import SOFTWARE_GL, Browser, changed_share, missing_programs

SKIPPED = 77
ALL_SECONDS = 600  # of the whole test, less than ctest's limit, so that the browser is always closed
MAKE_PAGE = None
KEY = {"Enter": "\ue007", "Escape": "\ue00c", "ArrowRight": "\ue014"}

# Per canvas of a list: which cells of a grid of 120 x 90 its mesh covers, as a text of 0 and 1.
SILHOUETTES = """return [...document.querySelectorAll(arguments[0])].map(canvas => {
  const copy = document.createElement('canvas');
  copy.width = 120; copy.height = 90;
  const context = copy.getContext('2d', { willReadFrequently: true });
  context.drawImage(canvas, 0, 0, copy.width, copy.height);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  let text = '';
  for (let i = 3; i < data.length; i += 4) text += data[i] > 127 ? 1 : 0;
  return text;
});"""
# Texts whose contrast with what lies behind them is below 4.5 (WCAG 2, AA).
PALE_TEXTS = """
const canvas = document.createElement('canvas'), context = canvas.getContext('2d', { willReadFrequently: true });
canvas.width = canvas.height = 1;
const parse = color => {
  context.clearRect(0, 0, 1, 1); context.fillStyle = color; context.fillRect(0, 0, 1, 1);
  const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data; return [r, g, b, a / 255];
};
const over = (top, below) => [0, 1, 2].map(c => top[c] * top[3] + below[c] * (1 - top[3])).concat(1);
const behind = node => {
  const layers = [];
  for (; node; node = node.parentElement) {
    const color = parse(getComputedStyle(node).backgroundColor);
    if (color[3]) layers.push(color);
    if (color[3] === 1) break;
  }
  return layers.reverse().reduce((below, top) => over(top, below), [255, 255, 255, 1]);
};
const light = color => color.slice(0, 3).map(x => x / 255).map(x => x <= .04045 ? x / 12.92 : ((x + .055) / 1.055) ** 2.4)
  .reduce((sum, x, c) => sum + x * [.2126, .7152, .0722][c], 0);
const found = [], walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
  const node = walker.currentNode.parentElement, text = walker.currentNode.nodeValue.trim();
  if (!text || !node.checkVisibility() || ['SCRIPT', 'OPTION', 'TITLE'].includes(node.tagName.toUpperCase())) continue;
  const style = getComputedStyle(node), ground = behind(node);
  const ink = over(parse(node instanceof SVGElement ? style.fill : style.color), ground);
  const [high, low] = [light(ink), light(ground)].sort((a, b) => b - a), contrast = (high + .05) / (low + .05);
  if (contrast < 4.5) found.push(`${text}: ${contrast.toFixed(2)}`);
}
return found;"""


def difference(one, other):
    """How many cells two silhouettes differ in, as a share of those that the first covers."""
    return sum(a != b for a, b in zip(one, other)) / max(one.count("1"), 1)


def make_page(folder):
    page = pathlib.Path(folder) / "report.html"
    subprocess.run([MAKE_PAGE, page], check=True, timeout=120)
    return page


class PageTest(unittest.TestCase):
    """One browser per class; after every test its console must have stayed silent."""

    switches = SOFTWARE_GL
    width = 1280

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="exemplar-page-")
        cls.addClassCleanup(folder.cleanup)
        cls.page = make_page(folder.name)
        cls.browser = Browser(*cls.switches, width=cls.width)
        cls.addClassCleanup(cls.close_browser)

    @classmethod
    def close_browser(cls):
        cls.browser.close()
        if left := cls.browser.processes():
            raise AssertionError(f"processes of the browser are left: {left}")

    def setUp(self):
        self.browser.open(self.page)
        self.browser.wait_for("document.querySelectorAll('#grid .card').length === 3")
        self.browser.settle()

    def tearDown(self):
        self.assertEqual(self.browser.messages(), [])

    def wait_for_meshes(self, selector="#grid .card:first-child canvas"):
        """Waits until all canvases of the selector are drawn; the page draws those in sight or near it."""
        self.browser.script(f"document.querySelector('{selector}').scrollIntoView({{ block: 'nearest' }})")
        self.browser.wait_for("(list => list.length && list.every(canvas => canvas.width > 20 && "
                              f"canvas.view && !canvas.view.dirty))([...document.querySelectorAll('{selector}')])")
        self.browser.settle()

    def silhouettes(self, selector):
        return self.browser.script(SILHOUETTES, selector)

    def texts(self, selector):
        return self.browser.script(f"return [...document.querySelectorAll('{selector}')].map(node => node.textContent)")


class Drawn(PageTest):
    """With WebGL, on a wide window."""

    FIRST = "#grid .card:first-child canvas"
    SECOND = "#grid .card:nth-child(2) canvas"

    def test_mesh_is_drawn_and_a_drag_changes_its_pixels(self):
        self.wait_for_meshes(self.FIRST)
        views = self.browser.find_all(self.FIRST)
        self.assertEqual(len(views), 3)
        before = [self.browser.screenshot(view) for view in views]
        width, _, channels, rows = before[0]
        colors = {row[i:i + channels] for row in rows for i in range(0, width * channels, channels)}
        self.assertGreater(len(colors), 500, "the view shows hardly anything")
        for other in before[1:]:
            self.assertGreater(changed_share(before[0], other), 0.005, "two modes look the same")
        self.browser.drag(views[0], 90, 30)
        self.browser.settle()
        for view, old in zip(views, before):
            self.assertGreater(changed_share(old, self.browser.screenshot(view)), 0.01)

    def test_three_views_turn_together_and_others_stay(self):
        self.wait_for_meshes(self.FIRST)
        self.wait_for_meshes(self.SECOND)
        first, second = self.silhouettes(self.FIRST), self.silhouettes(self.SECOND)
        self.assertGreater(first[0].count("1"), 300)
        for number in range(3):
            self.browser.drag(self.browser.find_all(self.FIRST)[number], 50 + 10 * number, -20)
            self.browser.settle()
            turned = self.silhouettes(self.FIRST)
            # Boundary lines, which differ, reach half a pixel beyond the mesh.
            self.assertGreater(difference(turned[0], first[0]), 0.1)
            self.assertLess(max(difference(turned[0], other) for other in turned[1:]), 0.03)
            self.assertEqual(self.silhouettes(self.SECOND), second)
            first = turned

    def test_all_meshes_turn_together_on_demand(self):
        self.wait_for_meshes(self.FIRST)
        self.wait_for_meshes(self.SECOND)
        self.browser.click(self.browser.find("#linked"))
        before = self.silhouettes(self.SECOND)
        self.browser.drag(self.browser.find(self.FIRST), 80, 0)
        self.browser.settle()
        self.assertNotEqual(self.silhouettes(self.SECOND), before)

    def test_keyboard_turns_enlarges_and_closes(self):
        self.wait_for_meshes(self.FIRST)
        before = self.silhouettes(self.FIRST)
        self.browser.script(f"document.querySelector('{self.FIRST}').focus()")
        self.browser.press(KEY["ArrowRight"], KEY["ArrowRight"])
        self.browser.settle()
        turned = self.silhouettes(self.FIRST)
        self.assertNotEqual(turned, before)
        self.browser.press("0")
        self.browser.settle()
        self.assertEqual(self.silhouettes(self.FIRST), before)
        self.browser.press(KEY["Enter"])
        self.wait_for_meshes("#large-views canvas")
        self.assertEqual(len(self.browser.find_all("#large-views canvas")), 3)
        large = self.silhouettes("#large-views canvas")
        self.browser.press(KEY["ArrowRight"])
        self.browser.settle()
        self.assertNotEqual(self.silhouettes("#large-views canvas"), large)
        self.browser.press(KEY["Escape"])
        self.browser.wait_for("!document.querySelector('dialog').open && document.querySelector('.controls #modes')")

    def test_every_mode_shows_something_else(self):
        seen = []
        for mode in ("predicted", "truth", "errors", "confidence", "entropy", "border"):
            self.browser.script(f"document.querySelector('#modes input[value={mode}]').click()")
            self.wait_for_meshes(self.FIRST)
            seen.append(self.browser.screenshot(self.browser.find(self.FIRST)))
        for i, one in enumerate(seen):
            for other in seen[:i]:
                self.assertGreater(changed_share(one, other), 0.005)

    def test_worst_mesh_comes_first_and_order_can_change(self):
        name = "#grid .name span:first-child"
        self.assertEqual(self.texts(name), ["human-3", "human-2", "human-1"])
        self.browser.script("const order = document.getElementById('order'); order.value = 'best';"
                            "order.dispatchEvent(new Event('change'))")
        self.assertEqual(self.texts(name), ["human-1", "human-2", "human-3"])

    def test_link_of_the_overview_shows_the_other_group(self):
        self.browser.click(self.browser.find(".overview a[href='#group-2']"))
        self.browser.wait_for("document.getElementById('group-title').textContent === 'cup'")
        self.wait_for_meshes(self.FIRST)
        self.assertEqual(self.texts("#grid .name span:first-child"), ["cup-3", "cup-2", "cup-1"])

    def test_texts_are_readable_in_light_and_dark(self):
        for scheme in ("light", "dark"):
            self.browser.developer_command("Emulation.setEmulatedMedia",
                                           features=[{"name": "prefers-color-scheme", "value": scheme}])
            self.browser.settle()
            self.assertEqual(self.browser.script(PALE_TEXTS), [], scheme)

    def test_nothing_is_wider_than_the_window(self):
        self.assertLessEqual(self.browser.script("return document.documentElement.scrollWidth"), self.width)


    def test_a_drawing_plays(self):
        image = self.browser.find(".drawing img")
        self.browser.script("arguments[0].scrollIntoView()", image)
        self.browser.settle()

        def color():
            _, _, channels, rows = self.browser.screenshot(image)
            row, middle = rows[len(rows) // 2], len(rows[0]) // channels // 2 * channels
            return tuple(row[middle:middle + 3])

        seen = set()
        end = time.monotonic() + 20
        while len(seen) < 2 and time.monotonic() < end:
            seen.add(color())
        self.assertEqual(seen, {(255, 0, 0), (0, 0, 255)})


class Narrow(PageTest):
    """On a window as wide as a telephone."""

    width = 400

    def test_nothing_is_wider_than_the_window(self):
        self.wait_for_meshes()
        self.assertLessEqual(self.browser.script("return document.documentElement.scrollWidth"), self.width)
        tops = self.browser.script("return [...document.querySelectorAll('#grid .card:first-child canvas')]"
                                   ".map(canvas => canvas.getBoundingClientRect().top)")
        self.assertEqual(tops, [tops[0]] * 3)


class WithoutWebgl(PageTest):
    """A browser that cannot draw still shows all numbers."""

    switches = ["--disable-gpu", "--disable-3d-apis"]

    def test_tables_remain(self):
        self.assertTrue(self.browser.script("return document.getElementById('no-webgl').checkVisibility()"))
        self.assertFalse(self.browser.script("return [...document.querySelectorAll('canvas')]"
                                             ".some(canvas => canvas.checkVisibility())"))
        titles = self.texts(".panel h3")
        self.assertEqual(sorted(titles), ["All groups", "Anything", "Chosen features", "Confusion", "Measures", "Tested meshes",
                                          "Time", "Validation"])
        self.assertEqual(self.texts(".overview tbody th"), ["human", "cup"])
        self.assertEqual(self.texts("#grid .name span:first-child"), ["human-3", "human-2", "human-1"])

    def test_numbers_are_those_of_the_report(self):
        first = self.texts(".overview tbody tr:first-child td")
        self.assertEqual(first[1], "90.0")
        self.assertRegex(first[2], r"^\d+\.\d worse$")
        self.assertEqual(first[3:], ["12.0", "14.3", "2.3 better", "0.150"])
        self.assertEqual(len(self.texts(".confusion tbody tr")), 9)
        self.assertEqual(len(self.texts(".charts svg path.curve")), 6)
        self.assertEqual(self.texts(".families tbody th")[0], "context")

    def test_texts_of_a_table_stay_texts(self):
        self.assertEqual(self.texts(".texts tbody th"), ["<script>alert(1)</script>.off", "plain"])
        self.assertEqual(self.texts(".texts tbody td"), ["1,234", "<img src=x onerror=alert(1)>", "5", ""])
        self.assertEqual(self.texts(".texts td.number"), ["1,234", "5"])
        self.assertEqual(self.browser.find_all(".texts img, .texts script"), [])

    def test_a_column_sorts_the_tested_meshes(self):
        names = ".scores tbody th"
        self.assertEqual(self.texts(names), ["human-3", "human-2", "human-1"])
        self.browser.click(self.browser.find(".scores th:nth-child(2) button"))
        self.assertEqual(self.texts(names), ["human-1", "human-2", "human-3"])


def interrupt(number, _):
    """Ends the program by the one exception that unittest lets through; the browser closes at exit."""
    raise KeyboardInterrupt("terminated" if number == signal.SIGTERM else f"not done after {ALL_SECONDS} s")


def main():
    global MAKE_PAGE
    if not os.environ.get("EXEMPLAR_BROWSER"):
        print("skipped: opening pages in a browser is asked for with 'tests/run.sh --browser'")
        return SKIPPED
    if missing := missing_programs():
        print(f"error: no {' and no '.join(missing)}; 'tests/run.sh --browser' installs them on Debian")
        return 1
    MAKE_PAGE = pathlib.Path(sys.argv.pop(1)).absolute()
    signal.signal(signal.SIGTERM, interrupt)
    signal.signal(signal.SIGALRM, interrupt)
    signal.alarm(ALL_SECONDS)
    result = unittest.main(exit=False, verbosity=2).result
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
