# SPDX-License-Identifier: Apache-2.0
"""Checks small tools of a report: measuring, the picture of the view, north, the range of diameters, the saved table."""

import base64
import csv
import io
import math
import re
import struct

from report_browser import By, Keys, camera, next_picture, press, require, still, wait_for

# Places of the window with a point of the scan, near the middle of the view and away from it.
CLICK = """
const canvas = document.getElementById('canvas'), box = canvas.getBoundingClientRect();
const x = box.left + arguments[0] * box.width, y = box.top + arguments[1] * box.height;
for (const type of ['pointerdown', 'pointerup']) {
  canvas.dispatchEvent(new PointerEvent(type, {clientX: x, clientY: y, isPrimary: true, button: 0, bubbles: true}));
}
return [document.getElementById('measure-text').textContent, lacuna.measured()];
"""
# Places of the names of the axes. In one script, since the page draws them anew.
TRIAD = "return Object.fromEntries(Array.from(document.querySelectorAll('#triad text')," \
        "(text) => [text.textContent, ['x', 'y'].map((key) => Number(text.getAttribute(key)))]))"
CATCH_BLOB = """
window.caught = null;
const make = URL.createObjectURL;
URL.createObjectURL = (blob) => {
  const reader = new FileReader();
  reader.onload = () => { window.caught = reader.result; };
  reader.readAsDataURL(blob);
  URL.createObjectURL = make;
  return '#';
};
document.getElementById(arguments[0]).click();
"""


def saved(driver, button):
    """The bytes of the file that a button saves."""
    driver.execute_script(CATCH_BLOB, button)
    wait_for(driver, "window.caught", "a file is saved")
    return base64.b64decode(driver.execute_script("return window.caught").split(",")[1])


def check_measure(driver):
    driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
    still(driver)
    driver.find_element(By.CSS_SELECTOR, "[data-side=fit]").click()
    still(driver)
    press(driver, "m")
    require(driver.find_element(By.ID, "measure").get_attribute("aria-pressed") == "true", "M begins to measure")
    found = []
    for at in [(0.3 + 0.05 * i, 0.3 + 0.06 * i) for i in range(8)]:
        _, places = driver.execute_script(CLICK, *at)
        if len(places) > len(found):
            found.append(at)
        if len(found) == 2:
            break
    require(len(found) == 2 and len(places) == 2, "clicks choose two points of the scan")
    require(driver.execute_script("return lacuna.selected()") is None, "they select no loop")
    text = driver.find_element(By.ID, "measure-text").text
    length = math.dist(*places)
    shown = float(re.match(r"[\d.,]+", text).group().replace(",", ""))
    factor = 1000 if re.match(r"[\d.,]+ mm", text) else 1
    require(abs(shown / factor - length) <= 1e-3 * length, f"the distance {length:.4g} is shown as {shown:.4g}")
    require(len(driver.find_elements(By.CSS_SELECTOR, "#measure-over circle")) == 2, "two signs stand at the points")
    sign = driver.find_elements(By.CSS_SELECTOR, "#measure-over circle")[1]
    box = driver.execute_script("const b = document.getElementById('canvas').getBoundingClientRect(); return [b.width, b.height]")
    away = math.dist((float(sign.get_attribute("cx")) / box[0], float(sign.get_attribute("cy")) / box[1]), found[1])
    require(away < 0.03, f"where they were chosen ({away:.3f} of the view away)")
    press(driver, Keys.ESCAPE)
    require(not driver.find_element(By.ID, "measure-panel").is_displayed(), "Escape ends measuring")


def check_picture(driver):
    png = saved(driver, "picture")
    size = struct.unpack(">II", png[16:24])
    canvas = driver.execute_script("const c = document.getElementById('canvas'); return [c.width, c.height]")
    require(png[:8] == b"\x89PNG\r\n\x1a\n" and list(size) == canvas, f"the picture of the view is a PNG of {size[0]} x {size[1]} pixels")
    require(len(png) > 5000, f"it is not empty ({len(png)} bytes)")


def needle_turn(needle):
    """Degrees clockwise."""
    return float(re.search(r"rotate\((.*?)\)", needle.find_element(By.TAG_NAME, "path").get_attribute("transform")).group(1))


def check_north(driver):
    has_crs = driver.execute_script("return lacuna.crs !== null")
    driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
    still(driver)
    needle = driver.find_element(By.ID, "north")
    require(needle.is_displayed() == has_crs, "an arrow shows north" if has_crs else "without a CRS nothing shows north")
    if has_crs:
        require(abs(needle_turn(needle)) < 0.5, "from above it shows up")
        driver.execute_script("document.getElementById('canvas').focus()")
        press(driver, Keys.ARROW_LEFT * 3)
        still(driver)
        x, y = driver.execute_script(TRIAD)["y"]
        wanted = math.degrees(math.atan2(x, 3.5 - y))
        require(abs(wanted) > 1 and abs(needle_turn(needle) - wanted) < 0.5, f"it turns with the view, as y does ({wanted:.1f} degrees)")


def choose_up(driver, axis):
    driver.execute_script("const list = document.getElementById('up-axis'); list.value = arguments[0]; list.dispatchEvent(new Event('change'));", axis)
    next_picture(driver)
    still(driver)


def check_up(driver):
    """From above, the camera is along the axis that is up. The section has the heights along it."""
    driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
    still(driver)
    home = camera(driver)
    for axis in (0, 1, 2):
        choose_up(driver, axis)
        driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
        still(driver)
        eye = [a - b for a, b in zip(camera(driver), driver.execute_script("return lacuna.target()"))]
        require(eye[axis] > 0.999 * math.hypot(*eye), f"with {'xyz'[axis]} up, Top looks along it")
        driver.find_element(By.CSS_SELECTOR, "[data-side=front]").click()
        still(driver)
        x, y = driver.execute_script(TRIAD)["xyz"[axis]]
        require(abs(x) < 0.5 and y < -20, "from the front it goes up")
        low, high = driver.execute_script("return lacuna.bounds()[arguments[0]]", axis)
        slider = driver.find_element(By.ID, "above-slider")
        ends = [float(slider.get_attribute(name)) for name in ("min", "max")]
        step = float(slider.get_attribute("step"))
        require(abs(ends[0] - low) <= step and abs(ends[1] - high) <= step, f"the section reaches from {ends[0]} to {ends[1]}")
    driver.find_element(By.CSS_SELECTOR, "[data-side=top]").click()
    still(driver)
    require(all(abs(a - b) < 1e-6 * (1 + abs(b)) for a, b in zip(camera(driver), home)), "z again, the view is as at first")


def type_in(driver, name, text):
    field = driver.find_element(By.ID, name)
    field.send_keys(Keys.CONTROL + "a")
    field.send_keys(text or Keys.DELETE)
    next_picture(driver)
    return field


def shown(driver):
    return driver.execute_script("return lacuna.visible_loops()")


def check_range(driver, count):
    sizes = driver.execute_script("return lacuna.diameters()")
    factor = 1000 if driver.find_element(By.ID, "size-unit").text == "mm" else 1
    middle = sorted(sizes)[len(sizes) // 2] * factor * 1.0001
    type_in(driver, "size-most", f"{middle:.6f}".replace(".", ","))
    below = sum(size * factor <= float(f"{middle:.6f}") for size in sizes)
    require(shown(driver) == below > 0, f"{below} of {count} loops are at most as large as {middle:.4g}")
    require(type_in(driver, "size-most", "2,5m").get_attribute("aria-invalid") == "true", "other text is marked")
    require(shown(driver) == count, "it filters nothing")
    type_in(driver, "size-most", "0")
    require(shown(driver) == 0, "none is at most 0 large")
    driver.find_element(By.ID, "reset").click()
    wait_for(driver, f"lacuna.visible_loops() === {count}", "a reset shows all")


def check_table(driver, count):
    """The saved table: units in its header, short digits, and notes as they are."""
    press(driver, "n")
    still(driver)
    note = "a, \"b\"\nc"
    driver.execute_script("const note = document.getElementById('note'); note.value = arguments[0]; note.dispatchEvent(new Event('input'));", note)
    rows = list(csv.reader(io.StringIO(saved(driver, "csv").decode(), newline="")))
    head, rows = rows[0], rows[1:]
    unit = driver.execute_script("return lacuna.unit")
    for name, wanted in {"perimeter": unit, "area": unit + "^2", "diameter": unit, "x": unit, "confidence": ""}.items():
        require((f"{name} ({wanted})" if unit and wanted else name) in head, f"the head names {name} with its unit '{wanted}'")
    require(len(rows) == count and all(len(row) == len(head) for row in rows), f"{count} rows have {len(head)} values")
    require([row[-1] for row in rows].count(note) == 1, "a note of lines and quotes is one value")
    values = [word for row in rows for name, word in list(zip(head, row))[2:-2] if word and name != "cause"]
    require(all(float(word) is not None and len(re.sub(r"[-.]|e.*", "", word).lstrip("0")) <= 15 for word in values),
            f"{len(values)} numbers have no noise of binary fractions")
    require(driver.execute_script("return lacuna.short_place(849393.9500000001)") == 849393.95, "849393.9500000001 is written as 849393.95")
    driver.execute_script("const note = document.getElementById('note'); note.value = ''; note.dispatchEvent(new Event('input'));")
    press(driver, Keys.ESCAPE)
    still(driver)


def check(driver, count):
    check_measure(driver)
    check_picture(driver)
    check_north(driver)
    check_up(driver)
    if count > 0:
        check_range(driver, count)
        check_table(driver, count)
    driver.find_element(By.CSS_SELECTOR, "[data-side=front]").click()
    still(driver)
