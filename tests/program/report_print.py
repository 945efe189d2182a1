# SPDX-License-Identifier: Apache-2.0
"""Checks the report on paper: a summary, then a page for each hole, the largest first."""

import base64
import re

from report_browser import By, Keys, camera, press, require, still

NOTE = "<b>on paper</b>"
PAGES = "return Array.from(document.querySelectorAll('.print-page'), (page) => page.querySelector('h2').textContent)"
BEFORE = "window.dispatchEvent(new Event('beforeprint'));"
# Parts of the picture of a page that are dark or have the colour of holes, inside of the middle half and outside of it.
PICTURE = """
const image = document.querySelectorAll('.print-page')[arguments[0]].querySelector('.print-picture');
const canvas = document.createElement('canvas'), width = canvas.width = image.naturalWidth, height = canvas.height = image.naturalHeight;
const pen = canvas.getContext('2d');
pen.drawImage(image, 0, 0);
const {data} = pen.getImageData(0, 0, width, height), hole = [210, 68, 15];
let red = 0, left = width, right = 0, low = height, high = 0;
for (let i = 0; i < data.length; i += 4) {
  if (!hole.every((value, k) => Math.abs(data[i + k] - value) < 40)) continue;
  const x = (i / 4) % width, y = Math.floor(i / 4 / width);
  if (Math.abs(x - width / 2) > height / 2.4 || Math.abs(y - height / 2) > height / 2.4) continue;
  ++red;
  left = Math.min(left, x); right = Math.max(right, x); low = Math.min(low, y); high = Math.max(high, y);
}
return {width, height, red, middle: [(left + right) / 2 / width, (low + high) / 2 / height], tall: (high - low) / height};
"""


def holes_by_area(driver):
    """Ids of the holes in the first rows of the table, which is sorted by area."""
    return driver.execute_script("return Array.from(document.querySelectorAll('#body tr[data-row]'))"
                                 ".filter((row) => row.querySelector('.swatch.hole')).map((row) => Number(row.dataset.id))")


def hole_count(driver):
    """As the bar at the top says."""
    found = re.match(r"([\d,]+) holes?", driver.find_element(By.ID, "summary").get_attribute("textContent"))
    return int(found.group(1).replace(",", ""))


def check_pages(driver):
    holes = holes_by_area(driver)
    driver.execute_script(BEFORE)
    names = driver.execute_script(PAGES)
    require(len(names) - 1 == min(100, hole_count(driver)) and names[1:len(holes) + 1] == [f"Hole {loop}" for loop in holes],
            f"a summary and {len(names) - 1} pages, the largest hole first")
    require(driver.execute_script("return Array.from(document.querySelectorAll('#print img')).every((i) => i.complete && i.naturalWidth > 0)"),
            "their pictures are ready")
    if holes:
        seen = driver.execute_script(PICTURE, 1)
        require(seen["red"] > 200 and all(abs(place - 0.5) < 0.12 for place in seen["middle"]) and 0.1 < seen["tall"] < 0.85,
                f"the picture has the hole in its middle ({seen['red']} pixels, {100 * seen['tall']:.0f} % of its height)")
    driver.execute_script("window.dispatchEvent(new Event('afterprint'))")
    require(driver.execute_script(PAGES) == [], "after printing they are gone")


def check_marked(driver):
    """The page of a hole has its mark and its note, as text."""
    holes = holes_by_area(driver)
    press(driver, "n")
    still(driver)
    loop = driver.execute_script("return lacuna.selected()")
    press(driver, "g")
    driver.execute_script("const note = document.getElementById('note'); note.value = arguments[0]; note.dispatchEvent(new Event('input'));", NOTE)
    home, theme = camera(driver), driver.execute_script("return document.documentElement.dataset.theme")
    driver.execute_script(BEFORE)
    page = driver.execute_script("return document.querySelectorAll('.print-page')[arguments[0]].textContent", 1 + holes.index(loop))
    require("Scan again" in page and NOTE in page, "the page of a hole has its mark and its note")
    still(driver)
    require(all(abs(a - b) < 1e-9 * (1 + abs(b)) for a, b in zip(camera(driver), home)), "the view is as before")
    require(driver.execute_script("return document.documentElement.dataset.theme") == theme, "so is the theme")
    require(driver.execute_script("return lacuna.selected()") == loop, "so is the selection")
    driver.execute_script("window.dispatchEvent(new Event('afterprint'))")
    press(driver, Keys.ESCAPE)
    still(driver)


def check_most(driver):
    count = hole_count(driver)
    if count < 3:
        return
    driver.find_element(By.ID, "print-open").click()
    require(f"{count} holes pass the filters" in driver.find_element(By.ID, "print-count").text, "the dialog counts the holes")
    field = driver.find_element(By.ID, "print-most")
    field.send_keys(Keys.CONTROL + "a")
    field.send_keys("2,5")
    require(field.get_attribute("aria-invalid") == "true", "2,5 pages are refused")
    field.send_keys(Keys.CONTROL + "a")
    field.send_keys("2")
    driver.find_element(By.ID, "print-cancel").click()
    driver.execute_script(BEFORE)
    require(len(driver.execute_script(PAGES)) == 3, "it prints as many as the field says")
    text = driver.execute_script("return document.querySelector('.print-page').textContent")
    require(f"{count} holes pass the filters" in text and "the 2 largest of them" in text, "the summary says so")
    driver.execute_script("window.dispatchEvent(new Event('afterprint'))")


def check_pdf(driver):
    count = min(2, hole_count(driver))
    pdf = base64.b64decode(driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": False})["data"])
    pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
    require(pages == 1 + count, f"a PDF has {pages} pages, one for each")
    require(pdf.count(b"/DCTDecode") >= 1 + count, "with pictures")


def check(driver):
    check_pages(driver)
    check_marked(driver)
    check_most(driver)
    check_pdf(driver)
