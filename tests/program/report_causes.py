# SPDX-License-Identifier: Apache-2.0
"""Checks causes of holes and stations of a report: column, filter, colours, details, line, markers, facts, keys, widths."""

import csv
import io
import math
import re

from report_browser import By, Keys, Select, next_picture, press, require, still
from report_marks import show_details, show_loops, value
from report_tools import saved

TITLES = {"hidden": "hidden", "opening": "opening", "out_of_view": "out of view", "no_return": "no return", "filtered": "filtered",
          "none": ""}
ROWS = "Array.from(document.querySelectorAll('#body tr[data-row]'), (row) => [Number(row.dataset.id), " \
       "row.querySelector('.column-cause').textContent])"
# Pixels of the view that have nearly the colour of a name.
PIXELS = """
const {pixels} = lacuna.read_pixels(), colour = lacuna.colours()[arguments[0]];
let count = 0;
for (let i = 0; i < pixels.length; i += 4) if (colour.every((value, k) => Math.abs(pixels[i + k] - value) <= 3)) ++count;
return count;
"""
# What lies over the view in sight: places of markers, the names that are shown, and the boxes of these.
MARKERS = """
const boxes = (what) => Array.from(document.querySelectorAll('#stations-over ' + what))
    .filter((node) => node.getBoundingClientRect().width > 0)
    .map((node) => { const b = node.getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]; });
return {stations: boxes('path.station'), next: boxes('rect.next'), names: boxes('text:not(.next)'), lines: boxes('.sight line')};
"""


def facts(driver):
    return driver.find_element(By.ID, "facts-body").get_attribute("textContent")


def choose(driver, name, option):
    """By hand where it is in sight: settings of the view are behind a button."""
    driver.execute_script("const list = document.getElementById(arguments[0]); list.value = arguments[1];"
                          "list.dispatchEvent(new Event('change'));", name, option)
    next_picture(driver)
    still(driver)


def check_without(driver):
    require("--stations FILE" in facts(driver) and "docs/stations.md" in facts(driver), "without stations the facts say how to give them")
    require(facts(driver).count("Causes") == 2 and "Stations" not in facts(driver), "in one sentence")
    for selector in ("#cause-select", "#loop-colours", "#stations-check", ".column-cause"):
        require(all(not item.is_displayed() for item in driver.find_elements(By.CSS_SELECTOR, selector)), f"nothing else of it shows: {selector}")
    require(not value(driver, "document.querySelectorAll('#stations-over path.station').length"), "no station is drawn")


def check_changes(driver):
    """The page of a comparison has loops of both results, and what has become of them, in place of causes."""
    changes = value(driver, "lacuna.causes()")
    require({"same", "closed"} <= set(changes), f"loops have changes: {sorted(set(changes))}")
    require(all(words == value(driver, "lacuna.cause(arguments[0])", loop).replace("_", " ") for loop, words in value(driver, ROWS)),
            "the table has them in words")
    require(driver.find_element(By.CSS_SELECTOR, "th[data-key=cause]").text.endswith("Change"), "under their name")
    require("compared with " in driver.find_element(By.ID, "summary").text, "the head names the other result")
    require("closed" in driver.find_element(By.ID, "legend").text, "loops have the colours of changes")
    require(driver.execute_script(PIXELS, "cause-closed") > 0, "as the legend says")
    closed = next(loop for loop, words in value(driver, ROWS) if words == "closed")
    driver.find_element(By.CSS_SELECTOR, f"#body tr[data-id='{closed}']").click()
    next_picture(driver)
    require("Before" in driver.find_element(By.ID, "details-body").text, "details have the id before")
    head, *rows = list(csv.reader(io.StringIO(saved(driver, "csv").decode(), newline="")))
    require([row[head.index("change")] for row in rows].count("closed") == changes.count("closed"), "the saved table has changes")


def check_head(driver):
    """Openings are no missing surface: the head of the page says both, with their unit."""
    words = driver.find_element(By.ID, "summary").text
    require(" missing, " in words and " openings" in words, f"the head says openings apart: {words}")


def check_column(driver):
    shown = value(driver, ROWS)
    require(all(words == TITLES[value(driver, "lacuna.cause(arguments[0])", loop)] for loop, words in shown), "the table has causes in words")
    button = driver.find_element(By.CSS_SELECTOR, "th[data-key=cause] button")
    button.send_keys(Keys.ENTER)
    order = list(TITLES.values())
    ranks = [order.index(words) for _, words in value(driver, ROWS)]
    require(ranks == sorted(ranks), "a key on the head of the column sorts it")
    button.send_keys(Keys.ENTER)
    ranks = [order.index(words) for _, words in value(driver, ROWS) if words]
    require(ranks == sorted(ranks, reverse=True), "once more, the other way")
    driver.find_element(By.CSS_SELECTOR, "th[data-key=area] button").click()


def check_filter(driver, count):
    chosen = Select(driver.find_element(By.ID, "cause-filter"))
    causes = value(driver, "lacuna.causes()")
    for name in TITLES:
        chosen.select_by_value(name)
        next_picture(driver)
        require(value(driver, "lacuna.visible_loops()") == causes.count(name), f"the filter shows {causes.count(name)} of {count} loops: {name}")
    require(f"Hidden ({causes.count('hidden')})" in [option.text for option in chosen.options], "its list counts them")
    driver.find_element(By.ID, "reset").click()
    next_picture(driver)
    require(value(driver, "lacuna.visible_loops()") == count and chosen.first_selected_option.text == "Any cause", "a reset shows all")


def check_saved(driver):
    head, *rows = list(csv.reader(io.StringIO(saved(driver, "csv").decode(), newline="")))
    causes = {int(row[0]): row[head.index("cause")] for row in rows}
    require(all(words == value(driver, "lacuna.cause(arguments[0])", loop).replace("none", "") for loop, words in causes.items()),
            "the saved table has causes, as holes.csv")
    shares = [sum(float(row[head.index(name)] or 0) for name in TITLES if name != "none") for row in rows if row[head.index("cause")]]
    require(shares and all(abs(share - 1) < 0.01 for share in shares), f"and the shares of {len(shares)} holes")


def check_colours(driver):
    """Loops are drawn through the surface: some lie behind it."""
    causes = set(value(driver, "lacuna.causes()")) - {"none"}
    names = {f"cause-{name.replace('_', '-')}" for name in causes} - {"cause-no-return"}  # which is that of edges, too
    driver.execute_script("document.getElementById('through').click(); document.getElementById('show-points').click();")
    before = {name: driver.execute_script(PIXELS, name) for name in names}
    choose(driver, "loop-colouring", "cause")
    after = {name: driver.execute_script(PIXELS, name) for name in names}
    require(driver.execute_script(PIXELS, "hole") == 0, "loops have no longer the colour of holes")
    # All loops of one cause may be too small for pixels without a mixture.
    require(sum(after[name] > before[name] + 10 for name in names) >= min(3, len(names)), f"they have those of causes: {after}")
    if value(driver, "innerWidth >= 900"):
        legend = driver.find_element(By.ID, "legend").text
        require(all(TITLES[name] in legend for name in causes), "the legend names the causes")
    colours = value(driver, "lacuna.colours()")
    for name in names:
        require(sum(abs(a - b) for a, b in zip(colours[name], colours["view"])) > 150, f"{name} differs from the background")
    choose(driver, "loop-colouring", "kind")
    require(driver.execute_script(PIXELS, "hole") > 0, "by kind again, they are as before")
    driver.execute_script("document.getElementById('through').click(); document.getElementById('show-points').click();")


def check_names(seen):
    """No name covers another one, or a marker."""
    names, markers = seen["names"], seen["stations"] + seen["next"]
    apart = all(a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]
                for i, a in enumerate(names) for b in names[:i] + markers)
    require(apart, f"{len(names)} names do not overlap")


def check_markers(driver):
    stations, next_stations = value(driver, "[lacuna.stations, lacuna.next_stations]")
    driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
    still(driver)
    seen = driver.execute_script(MARKERS)
    require(len(seen["stations"]) == stations and len(seen["next"]) == next_stations,
            f"{stations} stations and {next_stations} next ones are drawn")
    require(seen["names"], "some with names")
    check_names(seen)
    more = driver.find_element(By.ID, "view-more")
    more.send_keys(Keys.ENTER)
    switch = driver.find_element(By.ID, "show-stations")
    switch.send_keys(Keys.SPACE)
    require(not any(driver.execute_script(MARKERS).values()), "a switch hides them, by a key")
    require(value(driver, "document.getElementById('view-settings').scrollWidth <= document.getElementById('view-settings').clientWidth"),
            "nothing of the settings is cut")
    switch.send_keys(Keys.SPACE)
    more.send_keys(Keys.ENTER)
    require(driver.execute_script(MARKERS) == seen, "and shows them again")
    press(driver, "2")
    still(driver)
    check_names(driver.execute_script(MARKERS))
    driver.find_element(By.CSS_SELECTOR, "[data-side=fit]").click()
    still(driver)


def select_cause(driver, name):
    """Returns the id of a hole of this cause, by the filter and a key; None without one."""
    if name not in value(driver, "lacuna.causes()"):
        return None
    show_loops(driver)
    choose(driver, "cause-filter", name)
    driver.execute_script("document.getElementById('canvas').focus()")
    press(driver, "n")
    still(driver)
    show_details(driver)
    return value(driver, "lacuna.selected()")


def end_selection(driver):
    press(driver, Keys.ESCAPE)
    still(driver)
    show_loops(driver)
    driver.find_element(By.ID, "reset").click()
    next_picture(driver)


def check_details(driver):
    for name in ("hidden", "opening", "filtered"):
        loop = select_cause(driver, name)
        if loop is None:
            continue
        text = driver.find_element(By.ID, "details-body").text
        require(f"{TITLES[name]} " in text and " %" in text, f"the details of hole {loop} have the shares of its causes")
        words = {match.group(1): int(match.group(2)) for match in re.finditer(r"([a-z][a-z ]*) (\d+) %", text)}
        shares = {TITLES[key]: share for key, share in value(driver, "lacuna.shares(arguments[0])", loop).items() if share > 0.01}
        require(words.keys() == shares.keys() and all(abs(words[key] - 100 * shares[key]) <= 0.51 for key in words), f"those above 1 %: {words}")
        lines = driver.execute_script(MARKERS)["lines"]
        if name == "hidden":
            require("what stands at" in text and "from station " in text, "and what hides it")
            # From above, the station, what hides and the hole lie in the view.
            driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
            still(driver)
            require(len(driver.execute_script(MARKERS)["lines"]) == 4, "a line goes from the station to what hides, and on to the hole")
            ends = driver.execute_script("return Array.from(document.querySelectorAll('#stations-over .sight line:not(.casing)'),"
                                         "(line) => ['x1', 'y1', 'x2', 'y2'].map((key) => Number(line.getAttribute(key))))")
            require(math.dist(ends[0][2:], ends[1][:2]) < 0.5, "both parts are joined")
            dashes = driver.execute_script("return Array.from(document.querySelectorAll('#stations-over .sight line:not(.casing)'),"
                                           "(line) => getComputedStyle(line).strokeDasharray)")
            require(dashes[0] == "none" and dashes[1] != "none", "dashed behind what hides")
            require(driver.find_elements(By.CSS_SELECTOR, "#stations-over .chosen path.station"), "the station is emphasised")
        else:
            require(("what stands at" in text) == ("hidden" in words) and not lines, "one with another cause has no line")
        end_selection(driver)
        require(not driver.execute_script(MARKERS)["lines"], "without a selection there is no line")


def check_facts(driver):
    text = facts(driver)
    causes = value(driver, "lacuna.causes()")
    for name in set(causes) - {"none"}:
        require(f"{TITLES[name]}{causes.count(name)}" in text, f"the facts count the causes: {TITLES[name]} {causes.count(name)}")
    require("are not known, because" not in text, "they do not say that causes are not known")
    tables = driver.find_elements(By.CSS_SELECTOR, "#facts .places")
    rows = [len(table.find_elements(By.CSS_SELECTOR, "tbody tr")) for table in tables]
    wanted = value(driver, "[lacuna.stations, lacuna.next_stations]")
    require(rows == [count for count in wanted if count], f"they list stations, and where to stand next: {rows}")
    require(value(driver, "document.getElementById('facts').scrollWidth <= document.getElementById('facts').clientWidth"), "within their width")


def check_print(driver):
    driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    heads = value(driver, "Array.from(document.querySelectorAll('.print-table th'), (head) => head.textContent)")
    text = value(driver, "document.querySelector('.print-summary').textContent")
    pages = value(driver, "Array.from(document.querySelectorAll('.print-page:not(.print-summary)'), (page) => page.textContent)")
    driver.execute_script("window.dispatchEvent(new Event('afterprint'))")
    require("Cause" in heads and "Causes" in text, "the summary on paper has causes")
    require(pages and all("Cause" in page for page in pages), "so has each page")


def check_width(driver):
    require(value(driver, "document.documentElement.scrollWidth <= innerWidth"), "nothing is wider than the page")
    wide = value(driver, "innerWidth")
    tops = value(driver, "[...new Set(Array.from(document.querySelectorAll('#filters > *'))"
                         ".map((item) => { const box = item.getBoundingClientRect(); return Math.round((box.top + box.bottom) / 20); }))].length")
    require(tops <= (1 if wide >= 1280 else 4), f"the filters have {tops} rows at {wide} pixels")


def check(driver, count):
    if value(driver, "lacuna.stations") == 0:
        check_without(driver)
        return
    check_width(driver)
    check_head(driver)
    check_column(driver)
    check_filter(driver, count)
    check_saved(driver)
    check_facts(driver)
    check_print(driver)
    if value(driver, "lacuna.has_view"):
        check_colours(driver)
        check_markers(driver)
        check_details(driver)
