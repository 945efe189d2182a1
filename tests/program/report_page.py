#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks report.html in a real browser: headless Chromium, with WebGL in software.

    report_page.py REPORT.html [--screenshot OUT.png] [--size 1400x900] [--dark] [--no-webgl] [--run SCRIPT] [--no-checks] [--causes] [--changes]
                   [--save-marks FILE] [--load-marks FILE]

--screenshot  a picture at the end (with --run: after that JavaScript and its flight)
--causes      checks causes and stations alone, or that the page says how to give stations
--changes     checks what a comparison shows alone
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
import report_section
import report_tools
from report_browser import By, Keys, Failed, camera, move_slider, open_browser, press, require, still, wait_for

LEAST_COVERED = 0.02  # of the canvas
# Counts, in the page, the pixels that are not background and those of the colours of holes and outer curves.
COUNT_PIXELS = """
const {width, height, pixels} = lacuna.read_pixels(), colours = lacuna.colours();
const near = (i, c, most) => Math.abs(pixels[i] - c[0]) <= most && Math.abs(pixels[i + 1] - c[1]) <= most &&
                             Math.abs(pixels[i + 2] - c[2]) <= most;
let covered = 0, hole = 0, outer = 0;
for (let i = 0; i < pixels.length; i += 4) {
  if (!near(i, colours.view, 6)) ++covered;
  if (near(i, colours.hole, 3)) ++hole;
  if (near(i, colours.outer, 3)) ++outer;
}
return {covered: covered / (width * height), hole, outer};
"""


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def check_points(driver):
    if driver.execute_script("return lacuna.points") == 0:
        require(driver.find_element(By.ID, "facts").text != "", "no points: the facts are there")
        return
    # Without the loops: their lines alone cover enough of the view.
    toggle = "document.getElementById('show-loops').click();"
    driver.execute_script(toggle)
    seen = driver.execute_script(COUNT_PIXELS)
    driver.execute_script(toggle)
    require(seen["hole"] + seen["outer"] == 0, "the switch of the loops hides them")
    require(seen["covered"] > LEAST_COVERED, f"points cover {100 * seen['covered']:.1f} % of the view")


def check_filter(driver, count):
    before = driver.execute_script(COUNT_PIXELS)
    require(before["hole"] + before["outer"] > 50,
            f"loops are drawn ({before['hole']} pixels of holes, {before['outer']} of outer curves)")
    move_slider(driver, "size-slider", 1000)
    require(driver.execute_script("return lacuna.visible_loops()") == 0, "the filter can leave out all loops")
    after = driver.execute_script(COUNT_PIXELS)
    require(after["hole"] + after["outer"] == 0, "loops left out are not drawn")
    move_slider(driver, "size-slider", 500)
    part = driver.execute_script("return lacuna.visible_loops()")
    require(0 < part < count or count == 1, f"the filter shows {part} of {count} loops at the middle of the slider")
    driver.find_element(By.ID, "reset").click()
    wait_for(driver, f"lacuna.visible_loops() === {count}", "a reset shows all loops")


def check_flight(driver):
    home = camera(driver)
    row = driver.find_element(By.CSS_SELECTOR, "#body tr[data-row='0']")
    identity = int(row.get_attribute("data-id"))
    row.click()
    still(driver)
    require(driver.execute_script("return lacuna.selected()") == identity, f"a click selects the first row (id {identity})")
    away = distance(camera(driver), home)
    require(away > 0, f"the camera flies to it ({away:.4g})")
    press(driver, Keys.ESCAPE)
    still(driver)
    back = distance(camera(driver), home)
    require(back < 1e-4 * away + 1e-9, "Escape flies back")
    require(driver.execute_script("return lacuna.selected()") is None, "Escape deselects")


# Pixels that the veil takes away from the background, such as those of lines over it, and those that it changes.
BEHIND = """
const {scenes} = lacuna.view, ground = lacuna.colours().view;
const contrast = ({pixels}, i) => [0, 1, 2].reduce((sum, k) => sum + Math.abs(pixels[i + k] - ground[k]), 0);
const {plane} = scenes.veil;
const pale = lacuna.read_pixels();
scenes.veil.plane = null;
const plain = lacuna.read_pixels();
scenes.veil.plane = plane;
let darker = 0, changed = 0;
for (let i = 0; i < pale.pixels.length; i += 4) {
  const [with_veil, without] = [contrast(pale, i), contrast(plain, i)];
  if (with_veil !== without) ++changed;
  if (with_veil > without) ++darker;
}
return [darker, changed];"""


def check_ids_apart(driver):
    boxes = driver.execute_script("return Array.from(document.querySelectorAll('#names-over text:not([hidden])'), (text) => {"
                                  "const {left, right, top, bottom} = text.getBoundingClientRect(); return [left, right, top, bottom]; });")
    apart = all(a[1] <= b[0] or b[1] <= a[0] or a[3] - 2 <= b[2] or b[3] - 2 <= a[2] for i, a in enumerate(boxes) for b in boxes[:i])
    require(apart, f"{len(boxes)} ids lie apart")


def check_charts(driver):
    """The histograms open below the table, so that its lines keep their place; on narrow screens they have a tab."""
    is_narrow = driver.execute_script("return innerWidth < 900")
    require(driver.execute_script("return document.getElementById('charts').open") == is_narrow, "charts are open in their tab alone")
    if not is_narrow:
        require(driver.execute_script("return document.getElementById('charts').getBoundingClientRect().top >="
                                      "document.getElementById('rows').getBoundingClientRect().bottom - 1"), "charts lie below the table")


def check_seen(driver):
    """A click shows the hole, whatever stands before it; in the order of the table, each from where the last one ended."""
    kinds = driver.execute_script("return Array.from(document.querySelectorAll('#body tr'), (row) => row.textContent.includes('hole'))")
    veiled = 0
    for row in [i for i, is_hole in enumerate(kinds) if is_hole][:12]:
        driver.execute_script(f"document.querySelectorAll('#body tr')[{row}].click()")
        still(driver)
        share = driver.execute_script("return lacuna.seen()")
        require(share > 0.5, f"row {row + 1}: {100 * share:.0f} % of the loop is seen after a click")
        darker, changed = driver.execute_script(BEHIND)
        require(10 * darker <= changed, f"row {row + 1}: what lies behind the hole is pale ({changed} pixels)")
        veiled += changed
        check_ids_apart(driver)
    require(veiled > 0 or driver.execute_script("return lacuna.stations") == 0, "a room has something behind its holes")
    press(driver, Keys.ESCAPE)
    still(driver)


IDS = """return Array.from(document.querySelectorAll('#names-over text:not([hidden])'), (text) => {
  const box = text.getBoundingClientRect(), canvas = document.getElementById('canvas').getBoundingClientRect();
  return [Number(text.textContent), box.x + box.width / 2, box.y + box.height / 2,
          document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2).id === 'canvas'];
});"""


def check_inside(driver):
    """Ids stand in their holes, and a click there selects one."""
    driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
    still(driver)
    places = [(hole, x, y) for hole, x, y, is_free in driver.execute_script(IDS) if is_free]
    require(places, f"{len(places)} holes have their ids in the view")
    found = []
    for _, x, y in places[:8]:
        driver.execute_script("for (const type of ['pointerdown', 'pointerup']) document.getElementById('canvas').dispatchEvent(new PointerEvent("
                              "type, {clientX: arguments[0], clientY: arguments[1], button: 0, isPrimary: true, bubbles: true}));", x, y)
        found.append(driver.execute_script("return lacuna.selected()"))
    hits = sum(hole == places[i][0] for i, hole in enumerate(found))
    require(None not in found and hits > 0, f"a click inside selects a hole, {hits} of {len(found)} the one of the id")
    press(driver, Keys.ESCAPE)
    still(driver)


def check_keys(driver):
    press(driver, "n")
    still(driver)
    first = driver.execute_script("return lacuna.selected()")
    require(first is not None, f"N selects a loop (id {first})")
    press(driver, Keys.ESCAPE)
    still(driver)
    home = camera(driver)
    press(driver, "1")
    still(driver)
    require(distance(camera(driver), home) > 0, "1 turns the view")
    press(driver, "?")
    require(driver.execute_script("return document.getElementById('help').open"), "? opens the list of keys")
    press(driver, Keys.ESCAPE)


def check_without_webgl(driver):
    require("WebGL" in driver.find_element(By.ID, "message").text, "without WebGL there is a message")
    count = driver.execute_script("return lacuna.visible_loops()")
    rows = len(driver.find_elements(By.CSS_SELECTOR, "#body tr[data-row]"))
    require(min(count, 1) <= rows, f"the table has {rows} rows of {count}")
    require("Points" in driver.find_element(By.ID, "facts").get_attribute("textContent"), "the facts are there")
    if count > 0:
        driver.find_element(By.CSS_SELECTOR, "#body tr[data-row]").click()
        require(driver.execute_script("return lacuna.selected()") is not None, "a click selects a row")
        move_slider(driver, "size-slider", 1000)
        driver.find_element(By.ID, "reset").click()
        wait_for(driver, f"lacuna.visible_loops() === {count}", "a reset shows all loops")
        report_print.check_pages(driver)


def check_policy(driver):
    policy = driver.execute_script("return document.querySelector('meta[http-equiv=\"Content-Security-Policy\"]').content")
    require(policy.startswith("default-src 'none';") and "unsafe" not in policy, "a policy allows nothing by default")
    driver.execute_script("const s = document.createElement('script'); s.textContent = 'window.foreign = true';"
                          "document.body.append(s); document.body.setAttribute('onclick', 'window.foreign = true');"
                          "document.body.click(); document.body.removeAttribute('onclick'); s.remove();")
    require(driver.execute_script("return window.foreign === undefined"), "a script of others does not run")
    messages = [entry["message"] for entry in driver.get_log("browser")]
    require(messages and all("Content Security Policy" in message for message in messages), "the browser says why")


def type_in(driver, name, text):
    field = driver.find_element(By.ID, name)
    field.send_keys(Keys.CONTROL + "a")
    field.send_keys(text)
    report_browser.next_picture(driver)
    return field


def check_typed(driver, count):
    most = driver.execute_script("return Math.max(...Array.from(document.querySelectorAll('#body tr[data-row]'),"
                                 "row => Number(row.querySelector('.column-diameter').textContent.replace(/,/g, ''))))")
    least = f"{most / 2:.4f}"
    type_in(driver, "size-number", least)
    with_point = driver.execute_script("return lacuna.visible_loops()")
    field = type_in(driver, "size-number", least.replace(".", ","))
    require(driver.execute_script("return lacuna.visible_loops()") == with_point and with_point > 0,
            f"a comma is a decimal point ({with_point} of {count} loops)")
    require(field.get_attribute("aria-invalid") == "false", "such a field is valid")
    type_in(driver, "size-number", "2,5m")
    require(field.get_attribute("aria-invalid") == "true", "a field with other text is marked")
    require(driver.execute_script("return lacuna.visible_loops()") == count, "it filters nothing")
    type_in(driver, "size-number", "0")
    require(field.get_attribute("aria-invalid") == "false", "a number clears the mark")


def check_facts(driver):
    names = driver.find_elements(By.CSS_SELECTOR, ".files bdi")
    require(names and all(name.get_attribute("dir") == "ltr" for name in names), "file names are read from the left")


def check_place(driver):
    """Where the table is the widest part: nothing of it is cut."""
    if driver.execute_script("return innerWidth") < 1280:
        return
    require(driver.execute_script("const rows = document.getElementById('rows');"
                                  "return rows.scrollWidth <= rows.clientWidth && Array.from(rows.querySelectorAll('td.place'))"
                                  ".every((place) => place.scrollWidth <= place.clientWidth)"), "places are whole")


def check_console(driver):
    entries = [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
    require(not entries, "no error in the console" + (f": {entries[0]}" if entries else ""))


def run(driver, arguments):
    begin = time.monotonic()
    driver.get(arguments.report.resolve().as_uri())
    wait_for(driver, "window.lacuna && window.lacuna.ready", "the page is ready")
    times = driver.execute_script("return lacuna.times")
    print(f"ready: {arguments.report.stat().st_size / 1e6:.1f} MB in {time.monotonic() - begin:.2f} s; in the page: "
          + ", ".join(f"{name} {value / 1000:.2f} s" for name, value in times.items()))
    # The software driver of tests has warnings of its own.
    messages = [entry["message"] for entry in driver.get_log("browser") if "GPU stall" not in entry["message"]
                and "GL Driver Message" not in entry["message"]]
    require(not messages, "no message in the console" + (f": {messages[0]}" if messages else ""))
    if arguments.load_marks:
        print(report_marks.load(driver, arguments.load_marks.read_text(encoding="utf-8")))
        report_marks.check_has(driver, arguments.load_marks)
    if arguments.changes:
        report_causes.check_changes(driver)
    elif arguments.causes:
        report_causes.check(driver, driver.execute_script("return lacuna.visible_loops()"))
    elif not arguments.no_checks:
        check_policy(driver)
        check_facts(driver)
        if arguments.no_webgl:
            check_without_webgl(driver)
        else:
            require(driver.execute_script("return lacuna.has_view"), "there is a 3D view")
            check_points(driver)
            count = driver.execute_script("return lacuna.visible_loops()")
            if driver.execute_script("return lacuna.points") > 0:
                report_section.check(driver, count)
                report_tools.check(driver, count)
            if count > 0:
                check_filter(driver, count)
                check_typed(driver, count)
                check_place(driver)
                check_charts(driver)
                check_flight(driver)
                check_seen(driver)
                check_inside(driver)
                check_keys(driver)
                report_marks.check(driver, count)
                report_print.check(driver)
    if arguments.save_marks:
        arguments.save_marks.write_text(driver.execute_script("return lacuna.marks_text()"), encoding="utf-8")
    if arguments.run:
        print("run:", driver.execute_script(arguments.run))
        still(driver)
        time.sleep(0.4)
    if arguments.screenshot:
        driver.save_screenshot(str(arguments.screenshot))
    check_console(driver)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("report", type=Path)
    parser.add_argument("--screenshot", type=Path)
    parser.add_argument("--size", default="1400x900")
    parser.add_argument("--dark", action="store_true")
    parser.add_argument("--no-webgl", action="store_true")
    parser.add_argument("--no-checks", action="store_true")
    parser.add_argument("--causes", action="store_true")
    parser.add_argument("--changes", action="store_true")
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
