# SPDX-License-Identifier: Apache-2.0
"""Checks the section of a report: it hides points and loops by their height, in the view alone."""

from report_browser import By, Keys, camera, move_slider, press, require, still

LINE_PIXELS = 4  # half of the widest line, and its soft edge
# Number of pixels that are not background, the highest and the lowest row that has one (from the bottom).
COVERED_ROWS = """
const {width, height, pixels} = lacuna.read_pixels(), ground = lacuna.colours().view;
let covered = 0, high = -1, low = -1;
for (let i = 0; i < pixels.length; i += 4) {
  if (ground.every((value, k) => Math.abs(pixels[i + k] - value) <= 6)) continue;
  ++covered;
  high = Math.floor(i / 4 / width);
  if (low < 0) low = high;
}
return {covered, high, low, height};
"""
# Pairs [id, [x, y]]: a place of the window where each loop is picked.
PICKED = """
const box = document.getElementById('canvas').getBoundingClientRect(), places = new Map();
for (let y = box.top + 6; y < box.bottom - 6; y += 24) {
  for (let x = box.left + 6; x < box.right - 6; x += 24) {
    const id = lacuna.loop_at(x, y);
    if (id !== null) places.set(id, [x, y]);
  }
}
return Array.from(places);
"""
PICKED_AT = "return arguments[0].map(([x, y]) => lacuna.loop_at(x, y));"


def limits(driver):
    """Values of the two sliders."""
    return driver.execute_script("return ['above', 'below'].map((n) => Number(document.getElementById(n + '-slider').value))")


def type_height(driver, name, height):
    number = driver.find_element(By.ID, f"{name}-number")
    number.send_keys(Keys.CONTROL + "a")
    number.send_keys(f"{height:.6f}")
    number.send_keys(Keys.TAB)  # the change is done
    still(driver)
    return number


def look_from(driver, side):
    driver.find_element(By.CSS_SELECTOR, f"[data-side={side}]").click()
    still(driver)


def reset(driver):
    driver.find_element(By.ID, "reset").click()
    still(driver)


def show_alone(driver, name):
    """Points or loops alone; "" for both."""
    driver.execute_script("for (const name of ['points', 'loops']) { const box = document.getElementById('show-' + name);"
                          "  if (box.checked !== (!arguments[0] || arguments[0] === name)) box.click(); }", name)
    still(driver)


def check_hides(driver, name, low, high):
    """Above and below the middle of the heights, seen from the side."""
    show_alone(driver, name)
    everything = driver.execute_script(COVERED_ROWS)
    tall = everything["high"] - everything["low"]
    move_slider(driver, "above-slider", (low + high) / 2)
    lower = driver.execute_script(COVERED_ROWS)
    require(0 < lower["covered"] < everything["covered"] and lower["high"] < everything["high"] - 0.2 * tall
            and lower["low"] <= everything["low"] + 1, f"{name}: the upper half is hidden")
    move_slider(driver, "above-slider", high)
    move_slider(driver, "below-slider", (low + high) / 2)
    upper = driver.execute_script(COVERED_ROWS)
    require(0 < upper["covered"] < everything["covered"] and upper["low"] > everything["low"] + 0.2 * tall
            and upper["high"] >= everything["high"] - 1, f"{name}: the lower half is hidden")
    reset(driver)
    require(driver.execute_script(COVERED_ROWS) == everything, f"{name}: a reset brings all back")
    show_alone(driver, "")


def check_cut(driver):
    """What is shown up to the height of the camera that looks ahead ends in the middle of the picture."""
    show_alone(driver, "loops")
    type_height(driver, "above", camera(driver)[2])
    seen = driver.execute_script(COVERED_ROWS)
    over = seen["high"] - seen["height"] / 2
    require(over <= LINE_PIXELS, f"edges of loops are cut at the height ({over:.0f} pixels over it)")
    reset(driver)
    show_alone(driver, "")


def check_picks(driver, low, high):
    look_from(driver, "top")
    places = dict(driver.execute_script(PICKED))
    heights = {loop: driver.execute_script("return lacuna.loop_heights(arguments[0])", loop) for loop in places}
    # Between the lowest and the highest of them there is a height that hides one and leaves another one.
    middle = (min(top for _, top in heights.values()) + max(bottom for bottom, _ in heights.values())) / 2
    hidden = {loop for loop, (bottom, _) in heights.items() if bottom > middle}
    require(hidden, f"{len(places)} loops are picked, some above {middle:.3g}")
    number = type_height(driver, "above", middle)
    require(abs(limits(driver)[0] - middle) <= (high - low) / 200, "the field moves the slider")
    require(float(number.get_attribute("value")) == float(f"{middle:.6f}"), "the field keeps what is typed")
    now = set(driver.execute_script(PICKED_AT, list(places.values())))
    require(not hidden & now, f"hidden loops ({len(hidden)}) are not picked")
    left = {loop for loop, (_, top) in heights.items() if top < middle}
    require(left and left <= now, f"loops that are left ({len(left)}) are picked")
    reset(driver)
    require(driver.execute_script(PICKED_AT, list(places.values())) == list(places), "after a reset all are picked")


def check_flight(driver, count, low, high):
    move_slider(driver, "above-slider", low)
    require(driver.execute_script(COVERED_ROWS)["covered"] == 0, "the lowest height hides all")
    require(driver.execute_script("return lacuna.visible_loops()") == count, "the table keeps the hidden loops")
    driver.find_element(By.CSS_SELECTOR, "#body tr[data-row='0']").click()
    still(driver)
    require(limits(driver) == [high, low], "a flight to a hidden loop opens the section")
    require(driver.execute_script(COVERED_ROWS)["covered"] > 0, "the loop is seen")
    press(driver, Keys.ESCAPE)
    still(driver)
    require(limits(driver) == [low, low], "Escape brings the section back")
    press(driver, "n")
    still(driver)
    move_slider(driver, "below-slider", high)
    press(driver, Keys.ESCAPE)
    still(driver)
    require(limits(driver) == [high, high], "Escape leaves a section that was moved since")
    reset(driver)
    require(limits(driver) == [high, low], "a reset clears it")


def check_keyboard(driver, low, high):
    home = camera(driver)
    slider = driver.find_element(By.ID, "above-slider")
    slider.send_keys(Keys.ARROW_LEFT)
    still(driver)
    require(low < limits(driver)[0] < high, "an arrow key moves the slider")
    require(camera(driver) == home, "the arrow key does not turn the view")
    above = slider.get_attribute("aria-valuetext")
    require(above.startswith("above "), f"a screen reader says: {above}")
    require("Hidden: above" in driver.find_element(By.ID, "legend").text, "the legend names what is hidden")
    slider.send_keys(Keys.END)
    require(slider.get_attribute("aria-valuetext") == "off", "at its end it is off")
    require(not driver.find_element(By.ID, "reset").is_enabled(), "there is nothing to reset")


def check_roof(driver):
    """A page begins without the roof that hides all else from above, if there is one; all heights are there after a reset."""
    begin = limits(driver)
    if driver.find_element(By.ID, "reset").is_enabled():
        reset(driver)
        require(limits(driver)[0] > begin[0] and limits(driver)[1] == begin[1], f"a roof above {begin[0]} was hidden at first")


def check(driver, count):
    check_roof(driver)
    high, low = limits(driver)
    if low == high:
        require(not driver.find_element(By.ID, "above-slider").is_enabled(), "a flat scan has no section")
        return
    driver.find_element(By.ID, "view-more").click()
    require(low < high, f"the section shows all heights, {low} to {high}")
    look_from(driver, "side")
    check_hides(driver, "points", low, high)
    if count > 0:
        check_hides(driver, "loops", low, high)
        check_cut(driver)
        check_picks(driver, low, high)
        check_flight(driver, count, low, high)
    check_keyboard(driver, low, high)
    look_from(driver, "front")
    driver.find_element(By.ID, "view-more").click()
