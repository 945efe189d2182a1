# SPDX-License-Identifier: Apache-2.0
"""Drives a report in headless Chromium, with WebGL in software."""

import shutil
import time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    webdriver = By = Keys = Select = None

WAIT_SECONDS = 60


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
    if arguments.no_webgl:
        options.add_argument("--disable-3d-apis")
    else:
        options.add_argument("--use-angle=swiftshader")
        options.add_argument("--enable-unsafe-swiftshader")
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


def wait_for(driver, expression, text, seconds=WAIT_SECONDS):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if driver.execute_script(f"return Boolean({expression})"):
            return
        time.sleep(0.05)
    raise Failed(f"timed out: {text}")


def still(driver):
    wait_for(driver, "lacuna.is_still()", "the view comes to rest")


def camera(driver):
    return driver.execute_script("return lacuna.camera()")


def press(driver, key):
    webdriver.ActionChains(driver).send_keys(key).perform()


def is_installed():
    return webdriver is not None and shutil.which("chromium") and shutil.which("chromedriver")


def next_picture(driver):
    driver.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));")


def move_slider(driver, name, value):
    driver.execute_script("const s = document.getElementById(arguments[0]); s.value = arguments[1];"
                          "s.dispatchEvent(new Event('input'));", name, value)
    next_picture(driver)
    still(driver)
