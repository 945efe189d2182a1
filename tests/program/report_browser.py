# SPDX-License-Identifier: Apache-2.0
"""Drives a report in headless Chromium, with WebGL in software. `play` runs lists of steps: what is done, and what holds then."""

import base64
import shutil
import time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    webdriver = By = Keys = None

WAIT_SECONDS = 60

# What the steps have of the page, besides its own functions; places and heights are in real coordinates.
PROBE = """
const {data, table, marks, view} = page, {loops, frame} = data;
const index_of = (id) => loops.id.indexOf(id);
const colour = (name) => css_rgb(style_value(`--${name}`)).map((value) => Math.round(255 * value));
const is_near = (pixels, i, colour, most) => colour.every((value, k) => Math.abs(pixels[i + k] - value) <= most);
window.$ = (selector) => document.querySelector(selector);
window.$$ = (selector) => Array.from(document.querySelectorAll(selector));
window.kept = {};  // from one step to the next
window.distance = (a, b) => Math.hypot(...a.map((value, k) => value - b[k]));
window.are_close = (a, b) => a.every((value, k) => Math.abs(value - b[k]) < 1e-6 * (1 + Math.abs(b[k])));
window.lacuna = {
  colour,
  is_still: () => !view || (!view.navigation.flight && !view.frames.requested),
  camera: () => to_real(frame, view.navigation.camera.position.toArray()),
  target: () => to_real(frame, view.navigation.controls.target.toArray()),
  shown: () => table.shown.length,
  row_ids: () => $$('#body tr[data-row]').map((row) => Number(row.dataset.id)),
  selected: () => (page.selected < 0 ? null : loops.id[page.selected]),
  mark: (id = lacuna.selected()) => marks.mark[index_of(id)],
  note: (id = lacuna.selected()) => marks.note[index_of(id)],
  cause: (id = lacuna.selected()) => loops.cause[index_of(id)],
  shares: () => Object.fromEntries(kCauses.map((name) => [name, loops.shares[name][page.selected]])),
  bounds: (axis) => [data.report.bounds.min[axis], data.report.bounds.max[axis]],
  heights: (id) => {
    const {low, high} = loop_box(loops, index_of(id));
    return [low, high].map((place) => to_real(frame, place)[frame.up]);
  },
  loop_at: (x, y) => { const at = view.loop_at(x, y); return at < 0 ? null : loops.id[at]; },
  // The picture: rows from the bottom, 4 bytes a pixel.
  picture: () => {
    view.draw();
    const gl = view.renderer.getContext(), {width, height} = view.canvas, pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return {width, height, pixels};
  },
  // Pixels of the view that have nearly one of the colours.
  pixels: (...names) => {
    const {pixels} = lacuna.picture(), wanted = names.map(colour);
    let count = 0;
    for (let i = 0; i < pixels.length; i += 4) if (wanted.some((each) => is_near(pixels, i, each, 3))) ++count;
    return count;
  },
  // Pixels that are not background, the highest and the lowest row that has one (from the bottom), and the rows in all.
  covered: () => {
    const {width, height, pixels} = lacuna.picture(), ground = colour('view');
    let count = 0, high = -1, low = -1;
    for (let i = 0; i < pixels.length; i += 4) {
      if (is_near(pixels, i, ground, 6)) continue;
      ++count;
      high = Math.floor(i / 4 / width);
      if (low < 0) low = high;
    }
    return {count, part: count / (width * height), high, low, height};
  },
};
"""


class Failed(Exception):
    pass


def require(is_true, text):
    if not is_true:
        raise Failed(text)
    print(f"ok: {text}")


def open_browser(arguments):
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for option in ["--headless=new", "--no-sandbox", "--hide-scrollbars", "--disable-dev-shm-usage", "--force-color-profile=srgb"]:
        options.add_argument(option)
    for option in ["--disable-3d-apis"] if arguments.no_webgl else ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]:
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
    driver.set_page_load_timeout(WAIT_SECONDS)
    driver.set_script_timeout(WAIT_SECONDS)
    width, height = (int(value) for value in arguments.size.split("x"))
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
        {"name": "prefers-color-scheme", "value": "dark" if arguments.dark else "light"}]})
    return driver


def is_installed():
    return webdriver is not None and shutil.which("chromium") and shutil.which("chromedriver")


def value(driver, expression, *arguments):
    return driver.execute_script(f"return {expression}", *arguments)


def wait_for(driver, expression, text, seconds=WAIT_SECONDS):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if value(driver, f"Boolean({expression})"):
            return
        time.sleep(0.05)
    raise Failed(f"{text}: no {expression}")


def open_page(driver, address):
    driver.get("about:blank")
    driver.get(address)
    wait_for(driver, "window.page", "the page is ready")
    driver.execute_script(PROBE)


def act(driver, action):
    """One action, and all that it starts: a key, a click, a text, or JavaScript. A text may have ${JavaScript} within."""
    verb, _, rest = action.partition(" ")
    selector, _, text = rest.partition(" = ")
    if verb == "press":
        webdriver.ActionChains(driver).send_keys(getattr(Keys, rest, rest)).perform()
    elif verb == "click":
        driver.find_element(By.CSS_SELECTOR, rest).click()
    elif verb == "type":
        field = driver.find_element(By.CSS_SELECTOR, selector)
        field.send_keys(Keys.CONTROL + "a")
        field.send_keys(value(driver, f"`{text}`") or Keys.DELETE)
    elif verb in ("slide", "choose"):  # settings of the view are behind a button, so not by hand
        driver.execute_script("const field = $(arguments[0]); field.value = arguments[1]; field.dispatchEvent(new Event(arguments[2]));",
                              selector, value(driver, f"`{text}`"), "input" if verb == "slide" else "change")
    else:
        driver.execute_script(action)
    driver.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));")
    wait_for(driver, "!window.lacuna || lacuna.is_still()", "the view comes to rest")


def play(driver, steps):
    """Steps: (what holds in words, the same in JavaScript, *actions before it)."""
    for words, expected, *actions in steps:
        for action in actions:
            act(driver, action)
        if not value(driver, f"Boolean({expected})"):
            raise Failed(f"{words}: not {expected}")
        print(f"ok: {words}")


def saved(driver, button):
    """The bytes of the file that a button saves."""
    driver.execute_script("""
        kept.file = null;
        const make = URL.createObjectURL;
        URL.createObjectURL = (blob) => {
          const reader = new FileReader();
          reader.onload = () => { kept.file = reader.result; };
          reader.readAsDataURL(blob);
          URL.createObjectURL = make;
          return '#';
        };
        $(arguments[0]).click();""", button)
    wait_for(driver, "kept.file", "a file is saved")
    return base64.b64decode(value(driver, "kept.file").split(",")[1])
