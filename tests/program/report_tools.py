# SPDX-License-Identifier: Apache-2.0
"""Checks tools of a report: the section, measuring, the picture of the view, north, up, the range of diameters, the saved table."""

import csv
import io
import re
import struct

from report_browser import act, play, require, saved, value

LINE_PIXELS = 4  # half of the widest line, and its soft edge

# A page begins without the ceiling that hides all else from above, if there is one; all heights are there after a reset.
LIMITS = "['above', 'below'].map((name) => Number($(`#${name}-slider`).value))"
STOREYS = [
    ("a ceiling was hidden at first, if any", f"(([above, below]) => !kept.is_within || (above > kept.begin[0] && below === kept.begin[1]))({LIMITS})",
     f"kept.begin = {LIMITS}; kept.is_within = page.data.report.ceilings.length > 0; $('#reset').click();"),
    ("the list of storeys is there then alone", "(getComputedStyle($('#storey')).display !== 'none') === kept.is_within && $('#storeys').value === 'all'"),
    ("it takes the ceiling off again", f"!kept.is_within || String({LIMITS}) === String(kept.begin)", "if (kept.is_within) { $('#storeys').value = '0'; $('#storeys').dispatchEvent(new Event('change')); }"),
    ("all heights", f"{LIMITS}[0] >= kept.begin[0]", "$('#reset').click()"),
]
SECTION = [
    ("the section shows all heights", f"([kept.high, kept.low] = {LIMITS})[0] > kept.low", "click #view-more", "click [data-side=side]"),
]
# Points or loops alone, seen from the side: above and below the middle of the heights.
HIDES = [
    ("{0}: the upper half is hidden", "(({{count, high, low}}, all) => 0 < count && count < all.count && low <= all.low + 1 && "
     "high < all.high - 0.2 * (all.high - all.low))(lacuna.covered(), kept.all)",
     "$('#show-{1}').click()", "kept.all = lacuna.covered()", "slide #above-slider = ${{(kept.low + kept.high) / 2}}"),
    ("{0}: the lower half is hidden", "(({{count, high, low}}, all) => 0 < count && count < all.count && high >= all.high - 1 && "
     "low > all.low + 0.2 * (all.high - all.low))(lacuna.covered(), kept.all)",
     "slide #above-slider = ${{kept.high}}", "slide #below-slider = ${{(kept.low + kept.high) / 2}}"),
    ("{0}: a reset brings all back", "JSON.stringify(lacuna.covered()) === JSON.stringify(kept.all)", "click #reset"),
    ("{0}: alone no longer", "$('#show-{1}').checked", "$('#show-{1}').click()"),
]
# kept.places: pairs [id, [x, y]], a place of the window where each loop is picked.
PICKED = """
const box = $('#canvas').getBoundingClientRect(), places = new Map();
for (let y = box.top + 6; y < box.bottom - 6; y += 24) {
  for (let x = box.left + 6; x < box.right - 6; x += 24) {
    const id = lacuna.loop_at(x, y);
    if (id !== null) places.set(id, [x, y]);
  }
}
kept.places = Array.from(places);
// Between the lowest and the highest of them there is a height that hides one and leaves another one.
const heights = new Map(kept.places.map(([id]) => [id, lacuna.heights(id)]));
kept.middle = (Math.min(...Array.from(heights.values(), ([, top]) => top)) + Math.max(...Array.from(heights.values(), ([bottom]) => bottom))) / 2;
const ids = Array.from(heights.keys());
kept.hidden = ids.filter((id) => heights.get(id)[0] > kept.middle);
kept.left = ids.filter((id) => heights.get(id)[1] < kept.middle);"""
NOW = "kept.now = kept.places.map(([, [x, y]]) => lacuna.loop_at(x, y))"
SECTION_OF_LOOPS = [
    # What is shown up to the height of the camera that looks ahead ends in the middle of the picture.
    ("edges of loops are cut at the height", f"(({{high, height}}) => high - height / 2 <= {LINE_PIXELS})(lacuna.covered())",
     "$('#show-points').click()", "slide #above-slider = ${lacuna.camera()[2].toFixed(6)}"),
    ("loops are picked, some above a height", "kept.hidden.length > 0", "click #reset", "$('#show-points').click()", "click [data-side=top]", PICKED),
    ("hidden loops are not picked", "kept.hidden.every((id) => !kept.now.includes(id))", "slide #above-slider = ${kept.middle}", NOW),
    ("loops that are left are picked", "kept.left.length > 0 && kept.left.every((id) => kept.now.includes(id))"),
    ("after a reset all are picked", "kept.places.every(([id], i) => kept.now[i] === id)", "click #reset", NOW),

    ("the lowest height hides all", "lacuna.covered().count === 0", "slide #above-slider = ${kept.low}"),
    ("the table keeps the hidden loops", "lacuna.shown() === page.data.loops.count"),
    ("a flight to a hidden loop opens the section", f"String({LIMITS}) === String([kept.high, kept.low])", "click #body tr[data-row='0']"),
    ("the loop is seen", "lacuna.covered().count > 0"),
    ("Escape brings the section back", f"String({LIMITS}) === String([kept.low, kept.low])", "press ESCAPE"),
    ("Escape leaves a section that was moved since", f"String({LIMITS}) === String([kept.high, kept.high])",
     "press n", "slide #below-slider = ${kept.high}", "press ESCAPE"),
    ("a reset clears it", f"String({LIMITS}) === String([kept.high, kept.low])", "click #reset"),
]
SECTION_BY_KEYS = [
    ("an arrow key moves the slider", f"kept.low < {LIMITS}[0] && {LIMITS}[0] < kept.high",
     "kept.home = lacuna.camera()", "$('#above-slider').focus()", "press ARROW_LEFT"),
    ("the arrow key does not turn the view", "String(lacuna.camera()) === String(kept.home)"),
    ("a screen reader says it", "$('#above-slider').ariaValueText.startsWith('above ')"),
    ("the legend names what is hidden", "$('#legend').textContent.includes('Hidden: above')"),
    ("at its end it is off", "$('#above-slider').ariaValueText === 'off'", "press END"),
    ("there is nothing to reset", "$('#reset').disabled"),
    ("the settings are closed", "$('#view-settings').hidden", "click [data-side=front]", "click #view-more"),
]

# Clicks go on until two of them are on points of the scan.
CLICKS = """
const box = $('#canvas').getBoundingClientRect();
kept.clicks = [];
for (let i = 0; i < 8 && kept.clicks.length < 2; ++i) {
  const part = [0.3 + 0.05 * i, 0.3 + 0.06 * i], before = page.measure.places.length;
  const clientX = box.left + part[0] * box.width, clientY = box.top + part[1] * box.height;
  for (const type of ['pointerdown', 'pointerup'])
    $('#canvas').dispatchEvent(new PointerEvent(type, {clientX, clientY, isPrimary: true, button: 0, bubbles: true}));
  if (page.measure.places.length > before) kept.clicks.push(part);
}"""
MEASURE = [
    ("M begins to measure", "$('#measure').ariaPressed === 'true'", "click [data-side=top]", "click [data-side=fit]", "press m"),
    ("clicks choose two points of the scan", "kept.clicks.length === 2 && page.measure.places.length === 2", CLICKS),
    ("they select no loop", "lacuna.selected() === null"),
    ("the distance is shown", "Math.abs(kept.shown - kept.length) <= 1e-3 * kept.length",
     "kept.length = distance(...page.measure.places.map((place) => to_real(page.data.frame, place)));"
     "const [, shown, unit] = /^([\\d.,]+)( mm)?/.exec($('#measure-text').textContent);"
     "kept.shown = Number(shown.replace(/,/g, '')) / (unit ? 1000 : 1);"),
    ("two signs stand at the points", "$$('#measure-over circle').length === 2"),
    ("where they were chosen", "distance([sign.cx.baseVal.value / box.width, sign.cy.baseVal.value / box.height], kept.clicks[1]) < 0.03",
     "window.sign = $$('#measure-over circle')[1]; window.box = $('#canvas').getBoundingClientRect();"),
    ("Escape ends measuring", "$('#measure-panel').hidden", "press ESCAPE"),
]

# Places of the names of the axes.
TRIAD = "Object.fromEntries($$('#triad text').map((text) => [text.textContent, ['x', 'y'].map((key) => Number(text.getAttribute(key)))]))"
NORTH = [
    ("the axes have the names of a CRS if there is one", f"String(Object.keys({TRIAD}).sort()) === (page.data.report.crs ? 'E,N,z' : 'x,y,z')", "click [data-side=top]"),
    ("north is up from above", f"(([x, y]) => Math.abs(x) < 0.5 && y < -20)({TRIAD}[page.data.report.crs ? 'N' : 'y'])"),
]


def up_steps(axis):
    """From above, the camera is along the axis that is up. The section has the heights along it."""
    slider = "$('#above-slider')"
    return [
        (f"with {'xyz'[axis]} up, Top looks along it", f"kept.eye[{axis}] > 0.999 * Math.hypot(...kept.eye)",
         f"choose #up-axis = {axis}", "click [data-side=top]",
         "const target = lacuna.target(); kept.eye = lacuna.camera().map((value, k) => value - target[k]);"),
        ("from the front it goes up", f"(([x, y]) => Math.abs(x) < 0.5 && y < -20)({TRIAD}.{'xyz'[axis]})", "click [data-side=front]"),
        ("the section reaches as far as the scan", f"['min', 'max'].every((end, k) => Math.abs({slider}[end] - lacuna.bounds({axis})[k]) <= {slider}.step)"),
    ]


UP = [
    ("from above", "(kept.home = lacuna.camera()).length === 3", "click [data-side=top]"),
    *up_steps(0), *up_steps(1), *up_steps(2),
    ("z again, the view is as at first", "are_close(lacuna.camera(), kept.home)", "click [data-side=top]"),
]

RANGE = [
    ("loops are at most as large as the middle one", "(kept.below = kept.sizes.filter((size) => size <= Number(kept.middle)).length) === lacuna.shown()",
     "const factor = $('#size-unit').textContent === 'mm' ? 1000 : 1;"
     "kept.sizes = Array.from(page.data.loops.diameter, (size) => size * factor).sort((a, b) => a - b);"
     "kept.middle = (kept.sizes[Math.floor(kept.sizes.length / 2)] * 1.0001).toFixed(6);",
     "type #size-most = ${kept.middle.replace('.', ',')}"),
    ("some are", "kept.below > 0"),
    ("other text is marked", "$('#size-most').ariaInvalid === 'true'", "type #size-most = 2,5m"),
    ("it filters nothing", "lacuna.shown() === page.data.loops.count"),
    ("none is at most 0 large", "lacuna.shown() === 0", "type #size-most = 0"),
    ("a reset shows all", "lacuna.shown() === page.data.loops.count", "click #reset"),
]


def saved_table(driver):
    """The head and the rows."""
    head, *rows = csv.reader(io.StringIO(saved(driver, "#csv").decode(), newline=""))
    return head, rows


def check_picture(driver):
    png = saved(driver, "#picture")
    size = list(struct.unpack(">II", png[16:24]))
    require(png[:8] == b"\x89PNG\r\n\x1a\n" and size == value(driver, "[$('#canvas').width, $('#canvas').height]"),
            f"the picture of the view is a PNG of {size[0]} x {size[1]} pixels")
    require(len(png) > 5000, f"it is not empty ({len(png)} bytes)")


def set_note(driver, text):
    driver.execute_script("const note = $('#note'); note.value = arguments[0]; note.dispatchEvent(new Event('input'));", text)


def check_table(driver):
    """The saved table: units in its header, short digits, and notes as they are."""
    act(driver, "press n")
    note = "a, \"b\"\nc"
    set_note(driver, note)
    head, rows = saved_table(driver)
    unit = value(driver, "page.units.unit")
    for name, wanted in {"perimeter": unit, "area": unit + "^2", "diameter": unit, "x": unit, "confidence": ""}.items():
        require((f"{name} ({wanted})" if unit and wanted else name) in head, f"the head names {name} with its unit '{wanted}'")
    require(len(rows) == value(driver, "page.data.loops.count") and all(len(row) == len(head) for row in rows), f"{len(rows)} rows have {len(head)} values")
    require([row[-1] for row in rows].count(note) == 1, "a note of lines and quotes is one value")
    values = [word for row in rows for name, word in list(zip(head, row))[2:-2] if word and name != "cause"]
    require(all(float(word) is not None and len(re.sub(r"[-.]|e.*", "", word).lstrip("0")) <= 15 for word in values),
            f"{len(values)} numbers have no noise of binary fractions")
    require(value(driver, "short_place(849393.9500000001)") == 849393.95, "849393.9500000001 is written as 849393.95")
    set_note(driver, "")
    act(driver, "press ESCAPE")


def check(driver):
    has_loops = value(driver, "page.data.loops.count > 0")
    play(driver, STOREYS)
    if value(driver, "$('#section').disabled"):
        require(value(driver, f"(([above, below]) => above === below)({LIMITS})"), "a flat scan has no section")
    else:
        play(driver, SECTION)
        for shown, hidden in [("points", "loops"), ("loops", "points")][:1 + has_loops]:
            play(driver, [tuple(part.format(shown, hidden) for part in step) for step in HIDES])
        play(driver, (SECTION_OF_LOOPS if has_loops else []) + SECTION_BY_KEYS)
    play(driver, MEASURE)
    check_picture(driver)
    play(driver, NORTH + UP)
    if has_loops:
        play(driver, RANGE)
        check_table(driver)
    act(driver, "click [data-side=front]")
