#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks report.html in a real browser: headless Chromium, with WebGL in software.

    report_page.py REPORT.html [--screenshot OUT.png] [--size 1400x900] [--dark] [--no-webgl] [--run SCRIPT] [--no-checks] [--causes] [--changes] [--small]
                   [--save-marks FILE] [--load-marks FILE]

--screenshot  a picture at the end (with --run: after that JavaScript and its flight)
--causes      checks causes and stations alone, or that the page says how to give stations
--changes     checks what a comparison shows alone
--small       checks small loops, and that nothing is cut or covered, alone
--save-marks  writes the marks that the checks have made
--load-marks  loads a file of marks, as by hand, and checks that the page has them
--no-webgl    a browser without WebGL: the message, the table and the facts
Prints what it checked; exits with 1 and one line on failure, with 77 if Selenium or Chromium is missing.
Debian: python3-selenium chromium chromium-driver.
"""

import argparse
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True  # none among the sources

import report_browser
import report_causes
import report_marks
import report_print
import report_tools
from report_browser import Failed, act, open_browser, open_page, play, require, value

FACTS = [
    ("file names are read from the left", "$$('.files bdi').length > 0 && $$('.files bdi').every((name) => name.dir === 'ltr')"),
]

POINTS = [
    ("the switch of the loops hides them", "lacuna.pixels('hole', 'outer') === 0", "$('#show-loops').click()"),
    # Without the loops: their lines alone cover enough of the view.
    ("points cover some of the view", "lacuna.covered().part > 0.02"),
    ("loops are shown again", "$('#show-loops').checked", "$('#show-loops').click()"),
]

LOOPS = [
    ("loops are drawn", "lacuna.pixels('hole', 'outer') > 50"),
    ("the filter can leave out all loops", "lacuna.shown() === 0", "type #size-number = 1e9"),
    ("loops left out are not drawn", "lacuna.pixels('hole', 'outer') === 0"),
    ("a reset shows all loops", "lacuna.shown() === page.data.loops.count", "click #reset"),

    ("a number filters", "(kept.shown = lacuna.shown()) > 0",
     "kept.most = Math.max(...$$('#body .column-diameter').map((cell) => Number(cell.textContent.replace(/,/g, ''))))",
     "type #size-number = ${(kept.most / 2).toFixed(4)}"),
    ("a comma is a decimal point", "lacuna.shown() === kept.shown", "type #size-number = ${(kept.most / 2).toFixed(4).replace('.', ',')}"),
    ("such a field is valid", "$('#size-number').ariaInvalid === 'false'"),
    ("a field with other text is marked", "$('#size-number').ariaInvalid === 'true'", "type #size-number = 2,5m"),
    ("it filters nothing", "lacuna.shown() === page.data.loops.count"),
    ("a number clears the mark", "$('#size-number').ariaInvalid === 'false'", "type #size-number = 0"),

    ("a click selects the first row", "lacuna.selected() === lacuna.row_ids()[0]",
     "kept.home = lacuna.camera()", "click #body tr[data-row='0']"),
    ("the camera flies to it", "(kept.away = distance(lacuna.camera(), kept.home)) > 0"),
    ("Escape flies back", "distance(lacuna.camera(), kept.home) < 1e-4 * kept.away + 1e-9", "press ESCAPE"),
    ("Escape deselects", "lacuna.selected() === null"),
]

# Nothing is cut or covered. kept.over: what lies over the picture or is wider than its place.
WHOLE = """
const box = $('#canvas').getBoundingClientRect();
const over = $$('.view-bar *, .view-foot *').filter((node) => {
  const {left, top, right, bottom, width} = node.getBoundingClientRect();
  return width > 0 && right > box.left && left < box.right && bottom > box.top + 1 && top < box.bottom - 1;
});
const cut = $$('#rows td, #rows th button, .view-bar, .view-foot, .legend, #rows').filter((node) => node.scrollWidth > node.clientWidth + 1);
kept.over = [...over, ...cut].map((node) => `${node.tagName} ${node.id} ${node.className} ${node.textContent.slice(0, 30)}`);
"""
# The part of the picture's width or height that positions take, the larger of both; and how many of them lie within it.
EXTENT = """
const {camera} = page.view.navigation, {positions} = page.data.points;
const extent = (places, skip) => {
  const seen = [];
  for (let i = 0; i < places.length; i += 3 * skip) {
    const {x, y, z} = new THREE.Vector3(...places.subarray(i, i + 3)).project(camera);
    if (z < 1) seen.push([x, y]);
  }
  const ends = [0, 1].map((k) => seen.map((at) => at[k]).sort((a, b) => a - b));
  const within = seen.filter((at) => at.every((value) => Math.abs(value) <= 1)).length / Math.max(1, seen.length);
  return {within, part: Math.max(...ends.map((values) => (values[values.length - 1] - values[0]) / 2)),
          most: Math.max(...ends.map((values) => (values[Math.floor(0.98 * (values.length - 1))] - values[Math.floor(0.02 * (values.length - 1))]) / 2))};
};
const {first, vertices} = page.data.loops;
kept.points = extent(positions, 7);
kept.chosen = page.selected < 0 ? null : extent(vertices.subarray(3 * first[page.selected], 3 * first[page.selected + 1]), 1);
"""
FRAME = [
    ("nothing covers the picture, and nothing is cut", "kept.over.length === 0 || kept.over", WHOLE),
    ("the first picture holds 98 in 100 points, and no more than it needs", "kept.points.within > 0.97 && kept.points.most > 0.6", EXTENT),
]
CHOSEN = [
    ("a chosen hole fills half of the picture", "kept.chosen.part > 0.45 && kept.chosen.part < 0.8 && kept.chosen.within === 1",
     "press n", EXTENT),
    ("nothing is cut then", "kept.over.length === 0", WHOLE, "press ESCAPE"),
]
# The page of a scan with many loops near the spacing: all but the first.
SMALL = [
    ("small loops are one line of the table", "lacuna.shown() === 1 && $('#fold').textContent === `${kept.small} below 3 spacingsShow`",
     "kept.small = plural(page.data.loops.count - 1, 'loop', 'loops')"),
    ("and one of the picture", "$('#legend').textContent.includes(`${kept.small} below 3 spacings: show`)"),
    ("which shows them", "lacuna.shown() === page.data.loops.count && $('#fold-switch').textContent === 'Hide'", "$('#legend .link').click()"),
    ("a switch folds them again", "lacuna.shown() === 1", "click #fold-switch"),
    ("a mark takes one out", "lacuna.shown() === 2", "page.marks.set(page.data.loops.is_small.indexOf(1), 'real')"),
    ("a link to one shows all", "lacuna.selected() === kept.last && lacuna.shown() === page.data.loops.count",
     "kept.last = page.data.loops.id[page.data.loops.is_small.lastIndexOf(1)]; location.hash = `#hole=${kept.last}`"),
]

# Ids stand in their holes, and a click there selects one. [id, x, y] of those that nothing covers.
IDS = """
kept.ids = $$('#names-over text:not([hidden])').map((text) => {
  const box = text.getBoundingClientRect();
  return [Number(text.textContent), box.x + box.width / 2, box.y + box.height / 2];
}).filter(([, x, y]) => document.elementFromPoint(x, y).id === 'canvas').slice(0, 8);
kept.found = kept.ids.map(([, clientX, clientY]) => {
  for (const type of ['pointerdown', 'pointerup'])
    $('#canvas').dispatchEvent(new PointerEvent(type, {clientX, clientY, button: 0, isPrimary: true, bubbles: true}));
  return lacuna.selected();
});"""
INSIDE = [
    ("holes have their ids in the view", "kept.ids.length > 0", "click [data-side=top]", IDS),
    ("a click inside selects a hole", "!kept.found.includes(null)"),
    ("that of the id", "kept.found.some((id, i) => id === kept.ids[i][0])"),
    ("Escape deselects", "lacuna.selected() === null", "press ESCAPE"),
]

KEYS = [
    ("N selects a loop", "lacuna.selected() !== null", "press n"),
    ("3 turns the view", "distance(lacuna.camera(), kept.home) > 0", "press ESCAPE", "kept.home = lacuna.camera()", "press 3"),
    ("? opens the list of keys", "$('#help').open", "press ?"),
    ("Escape closes it", "!$('#help').open", "press ESCAPE"),
]

# The part of the chosen loop that is seen: pixels of its own colour, of those that it has where nothing hides it. Then the
# pixels that the veil takes away from the background, such as those of lines over it, and those that it changes.
SEEN = """
const {scenes} = page.view, {selected, selected_casing} = scenes.passes;
const own = loop_style(page.data.loops, page.selected, scenes.by_cause).slice(2);
const count = (hidden) => {
  selected.hidden.value = selected_casing.hidden.value = hidden;
  return lacuna.pixels(own);
};
scenes.set_loops([]);
const [seen, all] = [count(0), count(1)];
kept.seen = all > 0 ? seen / all : 0;
scenes.set_loops(page.table.shown);
const ground = lacuna.colour('view'), {plane} = scenes.veil;
const contrast = ({pixels}, i) => [0, 1, 2].reduce((sum, k) => sum + Math.abs(pixels[i + k] - ground[k]), 0);
const pale = lacuna.picture();
scenes.veil.plane = null;
const plain = lacuna.picture();
scenes.veil.plane = plane;
kept.darker = kept.changed = 0;
for (let i = 0; i < pale.pixels.length; i += 4) {
  const [with_veil, without] = [contrast(pale, i), contrast(plain, i)];
  if (with_veil !== without) ++kept.changed;
  if (with_veil > without) ++kept.darker;
}
kept.veiled = (kept.veiled || 0) + kept.changed;
kept.boxes = $$('#names-over text:not([hidden])').map((text) => text.getBoundingClientRect());"""


def check_seen(driver):
    """A click shows the hole, whatever stands before it; in the order of the table, each from where the last one ended."""
    rows = value(driver, "$$('#body tr').flatMap((row, i) => (row.textContent.includes('hole') ? [i] : []))")
    for row in rows[:12]:
        play(driver, [
            (f"row {row + 1}: the loop is seen after a click", "kept.seen > 0.5", f"$$('#body tr')[{row}].click()", SEEN),
            ("what lies behind the hole is pale, but for a few pixels of lines", "10 * kept.darker <= Math.max(kept.changed, 600)"),
            ("ids lie apart", "kept.boxes.every((a, i) => kept.boxes.slice(0, i).every((b) => "
             "a.right <= b.left || b.right <= a.left || a.bottom - 2 <= b.top || b.bottom - 2 <= a.top))")])
    play(driver, [("a room has something behind its holes", "kept.veiled > 0 || page.data.stations.length === 0", "press ESCAPE")])


WITHOUT_WEBGL = [
    ("without WebGL there is a message", "$('#message').textContent.includes('WebGL')"),
    ("the table has rows", "lacuna.row_ids().length >= Math.min(page.data.loops.count, 1)"),
    ("the facts are there", "$('#facts').textContent.includes('Points')"),
    ("a click selects a row", "lacuna.selected() !== null", "click #body tr[data-row]"),
    ("a reset shows all loops", "lacuna.shown() === page.data.loops.count", "type #size-number = 1e9", "click #reset"),
]


def check_policy(driver):
    policy = value(driver, "$('meta[http-equiv=\"Content-Security-Policy\"]').content")
    require(policy.startswith("default-src 'none';") and "unsafe" not in policy, "a policy allows nothing by default")
    play(driver, [("a script of others does not run", "window.foreign === undefined",
                   "const s = document.createElement('script'); s.textContent = 'window.foreign = true';"
                   "document.body.append(s); document.body.setAttribute('onclick', 'window.foreign = true');"
                   "document.body.click(); document.body.removeAttribute('onclick'); s.remove();")])
    messages = [entry["message"] for entry in driver.get_log("browser")]
    require(messages and all("Content Security Policy" in message for message in messages), "the browser says why")


def check(driver):
    check_policy(driver)
    play(driver, FACTS)
    if not value(driver, "page.view !== null"):
        play(driver, WITHOUT_WEBGL)
        report_print.check_pages(driver)
        return
    play(driver, FRAME + (CHOSEN if value(driver, "page.data.loops.count > 0") else []) + POINTS)
    report_tools.check(driver)
    play(driver, LOOPS)
    check_seen(driver)
    play(driver, INSIDE + KEYS)
    report_marks.check(driver)
    report_print.check(driver)


def run(driver, arguments):
    begin = time.monotonic()
    open_page(driver, arguments.report.resolve().as_uri())
    print(f"ready: {arguments.report.stat().st_size / 1e6:.1f} MB in {time.monotonic() - begin:.2f} s")
    # The software driver of tests has warnings of its own.
    messages = [entry["message"] for entry in driver.get_log("browser") if "GPU stall" not in entry["message"]
                and "GL Driver Message" not in entry["message"]]
    require(not messages, "no message in the console" + (f": {messages[0]}" if messages else ""))
    require(arguments.no_webgl or value(driver, "page.view !== null"), "there is a 3D view, if there is WebGL")
    if arguments.load_marks:
        print(report_marks.load(driver, arguments.load_marks.read_text(encoding="utf-8")))
        report_marks.check_has(driver, arguments.load_marks)
    if arguments.changes:
        report_causes.check_changes(driver)
    elif arguments.small:
        play(driver, FRAME + SMALL)
    elif arguments.causes:
        report_causes.check(driver)
    elif not arguments.no_checks:
        check(driver)
    if arguments.save_marks:
        arguments.save_marks.write_text(value(driver, "page.marks.text()"), encoding="utf-8")
    if arguments.run:
        act(driver, arguments.run)
        time.sleep(0.4)
    if arguments.screenshot:
        driver.save_screenshot(str(arguments.screenshot))
    errors = [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
    require(not errors, "no error in the console" + (f": {errors[0]}" if errors else ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("report", type=Path)
    parser.add_argument("--screenshot", type=Path)
    parser.add_argument("--size", default="1400x900")
    for name in ["--dark", "--no-webgl", "--no-checks", "--causes", "--changes", "--small"]:
        parser.add_argument(name, action="store_true")
    parser.add_argument("--save-marks", type=Path)
    parser.add_argument("--load-marks", type=Path)
    parser.add_argument("--run", help="JavaScript before the picture")
    arguments = parser.parse_args()
    if not report_browser.is_installed():
        print("report_page.py: skipped: python3-selenium, chromium or chromium-driver is missing")
        return 77
    driver = open_browser(arguments)
    try:
        run(driver, arguments)
    except Failed as failure:
        print(f"report_page.py: {failure}", file=sys.stderr)
        return 1
    finally:
        driver.quit()
    return 0


if __name__ == "__main__":
    sys.exit(main())
