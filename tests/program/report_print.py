# SPDX-License-Identifier: Apache-2.0
"""Checks the report on paper: a summary, then a page for each hole, the largest first."""

import base64
import re

from report_browser import play, require, value

NOTE = "<b>on paper</b>"
FILL, CLEAR = "window.dispatchEvent(new Event('beforeprint'))", "window.dispatchEvent(new Event('afterprint'))"
# kept.holes: ids of the holes in the first rows of the table, the largest first. kept.all: their number at the top.
HOLES = "kept.holes = $$('#body tr[data-row]').filter((row) => row.querySelector('.swatch.hole')).map((row) => Number(row.dataset.id));" \
        "kept.all = Number(/([\\d,]+) holes?/.exec($('#summary').textContent)[1].replace(/,/g, ''));"
PAGES = "kept.pages = $$('.print-page').map((page) => page.querySelector('h2').textContent);" \
        "kept.texts = $$('.print-page').map((page) => page.textContent);" \
        "kept.are_ready = $$('#print img').every((image) => image.complete && image.naturalWidth > 0);"
# kept.seen: the parts of the picture of the first hole that have the colour of holes, inside of its middle.
PICTURE = """
const image = $$('.print-page')[1].querySelector('.print-picture');
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
kept.seen = {red, middle: [(left + right) / 2 / width, (low + high) / 2 / height], tall: (high - low) / height};
"""

FILLED = [
    ("a summary and a page for each hole, the largest first",
     "kept.pages.length - 1 === Math.min(100, kept.all) && kept.holes.every((id, i) => kept.pages[i + 1] === `Hole ${id}`)", HOLES, FILL, PAGES),
    ("their pictures are ready", "kept.are_ready"),
]
FIRST_PICTURE = [
    ("the picture has the hole in its middle", "kept.seen.red > 200 && kept.seen.middle.every((place) => Math.abs(place - 0.5) < 0.12) &&"
     "kept.seen.tall > 0.1 && kept.seen.tall < 0.85", PICTURE),
]
CLEARED = [("after printing they are gone", "kept.pages.length === 0", CLEAR, PAGES)]
# The page of a hole has its mark and its note, as text.
MARKED = [
    ("the page of a hole has its mark and its note", f"kept.texts[1 + kept.holes.indexOf(kept.loop)].includes('Scan again') && "
     f"kept.texts[1 + kept.holes.indexOf(kept.loop)].includes('{NOTE}')",
     "press n", "press g", f"$('#note').value = '{NOTE}'; $('#note').dispatchEvent(new Event('input'));",
     "kept.home = lacuna.camera(); kept.loop = lacuna.selected(); kept.theme = document.documentElement.dataset.theme;", HOLES, FILL, PAGES),
    ("the view is as before", "lacuna.camera().every((value, k) => Math.abs(value - kept.home[k]) < 1e-9 * (1 + Math.abs(value)))"),
    ("so is the theme", "document.documentElement.dataset.theme === kept.theme"),
    ("so is the selection", "lacuna.selected() === kept.loop", CLEAR),
    ("Escape deselects", "lacuna.selected() === null", "press ESCAPE"),
]
MOST = [
    ("the dialog counts the holes", "$('#print-count').textContent.includes(`${kept.all} holes pass the filters`)", "click #print-open"),
    ("the summary says so", "kept.texts[0].includes(`${kept.all} holes pass the filters`)", "click #print-cancel", FILL, PAGES, CLEAR),
]


def check_pages(driver):
    play(driver, FILLED)
    if value(driver, "page.view && kept.all > 0"):
        play(driver, FIRST_PICTURE)
    play(driver, CLEARED)


def check_pdf(driver):
    count = value(driver, "kept.all")
    pdf = base64.b64decode(driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": False})["data"])
    pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
    require(pages == 1 + count, f"a PDF has {pages} pages, one for each")
    require(pdf.count(b"/DCTDecode") >= 1 + count, "with pictures")


def check(driver):
    check_pages(driver)
    play(driver, MARKED)
    if value(driver, "kept.all >= 3"):
        play(driver, MOST)
    check_pdf(driver)
