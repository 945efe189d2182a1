# SPDX-License-Identifier: Apache-2.0
"""Checks marks, notes and links of a report: by keys and by hand, in files, and in addresses."""

import json
import tempfile
from pathlib import Path

from report_browser import act, By, open_page, play, require, saved, value, wait_for

NOTE = "</script><img src=x onerror='window.foreign = true'> \"a, b\""
# On narrow screens the parts of the page are tabs.
SHOW_LOOPS, SHOW_DETAILS = "$('#tab-loops').click()", "$('#tab-details').click()"

SET = [
    ("a loop has no mark at first", "lacuna.mark() === 'none'", "press n", "kept.loop = lacuna.selected()"),
    ("I marks the selected loop", "lacuna.mark() === 'ignore'", "press i"),
    ("the table shows it", "$(`#body tr[data-id='${kept.loop}'] .mark-cell`).textContent === 'Ignore'"),
    ("a click marks it", "lacuna.mark() === 'scan again'", SHOW_DETAILS, "click input[name=mark][value='scan again']"),
    ("a key moves the choice of the details", "$('input[name=mark]:checked').value === 'real'", "press r"),
    ("E goes to the note", "document.activeElement.id === 'note'", "press e"),
    ("letters of a note are no keys", "lacuna.mark() === 'real'", f"press {NOTE} 0 i"),
    ("the note is kept", f"lacuna.note() === {json.dumps(NOTE)}", *["press BACKSPACE"] * 4),
    ("Escape leaves the note alone", "lacuna.selected() === kept.loop", "press ESCAPE"),
    ("no script of a note runs", "window.foreign === undefined", "press ESCAPE", SHOW_LOOPS),
]
# A key marks the row in focus, not the selected loop.
FOCUSED_ROW = [
    ("O marks the row in focus", "kept.focused !== lacuna.selected() && lacuna.mark(kept.focused) === 'done'",
     "press n", "$(`#body tr[data-id='${lacuna.selected()}']`).focus()", "press ARROW_DOWN",
     "kept.focused = Number(document.activeElement.dataset.id)", "press o"),
    ("0 takes the mark away", "lacuna.mark(kept.focused) === 'none'", "press 0"),
    ("Escape deselects", "lacuna.selected() === null", "press ESCAPE"),
]
FILTER = [
    ("the filter shows the one real loop", "lacuna.shown() === 1", "choose #mark-filter = real"),
    ("its list counts them", "$('#mark-filter').selectedOptions[0].text === 'Real (1)'"),
    ("the filter shows those without a mark", "lacuna.shown() === page.data.loops.count - 1", "choose #mark-filter = none"),
    ("a reset shows all", "lacuna.shown() === page.data.loops.count", "click #reset"),
]


def load(driver, text):
    """Loads a file by the button's field; returns the notice."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "<b>marks.json"
        file.write_text(text)
        driver.find_element(By.ID, "marks-file").send_keys(str(file))
        wait_for(driver, "!$('#notice').hidden", "a notice says what was loaded")
        words = value(driver, "$('#notice-text').textContent")
    act(driver, "click #notice-close")
    return words


def check_file(driver):
    loop = value(driver, "kept.loop")
    text = saved(driver, "#marks-save").decode()
    file = json.loads(text)
    entry = file["marks"][0]
    require(file["schema"] == "marks 1" and [entry["id"] for entry in file["marks"]] == [loop], "a file has the marked loop")
    require(entry["mark"] == "real" and entry["note"] == NOTE, "with mark and note")

    open_page(driver, driver.current_url)
    require(value(driver, "page.marks.entries()") == [], "a page that is opened again has no marks")
    other = dict(entry, id=10 ** 9, mark="done", centroid=[entry["centroid"][0] + 0.3 * entry["diameter"], *entry["centroid"][1:]])
    lost = dict(entry, id=2, centroid=[place + 1e6 for place in entry["centroid"]])
    words = load(driver, json.dumps(dict(file, marks=[other, lost])))
    require("<b>marks.json: 1 of 2 marks found their loops, 1 of them by place." in words, f"a notice: {words}")
    require(value(driver, "lacuna.mark(arguments[0])", loop) == "done", "a mark with another id is found by its place")
    marks = json.loads(value(driver, "page.marks.text()"))["marks"]
    require([item["id"] for item in marks] == sorted([2, loop]) and lost in marks, "the one that fits no loop is saved again")

    words = load(driver, text.replace('"real"', '"maybe"'))
    require('marks[0].mark: ' in words and "real" in words, f"a wrong file: {words}")
    require("holes 3" in load(driver, '{"schema": "holes 3"}'), "another file is refused by its schema")
    require("not JSON" in load(driver, text[:-5]), "so is half of a file")
    require(value(driver, "lacuna.mark(arguments[0])", loop) == "done", "a wrong file changes nothing")


def check_links(driver):
    """Every loop has an address of its own."""
    address = driver.current_url.split("#")[0]
    loop = value(driver, "lacuna.row_ids().pop()")
    text = value(driver, "page.marks.text()")
    open_page(driver, address)
    home = value(driver, "lacuna.camera()")
    open_page(driver, f"{address}#hole={loop}")
    driver.execute_script("[kept.loop, kept.home, kept.ids] = [...arguments, lacuna.row_ids()];", loop, home)
    play(driver, [
        ("the address opens at its loop", "lacuna.selected() === kept.loop"),
        ("the view begins there", "distance(lacuna.camera(), kept.home) > 0 && lacuna.is_still()"),
        ("the address follows the selection", "location.hash === `#hole=${lacuna.selected()}`", "kept.entries = history.length", "press n"),
        ("the history gets no entry", "location.hash === '' && history.length === kept.entries", "press ESCAPE"),
        ("Escape flies to the usual view", "are_close(lacuna.camera(), kept.home)"),
        ("a link to a loop that the filters hide clears them", "kept.hidden === undefined || lacuna.selected() === kept.hidden",
         "click input[name=kind][value=outer]", "kept.hidden = kept.ids.find((id) => !lacuna.row_ids().includes(id))",
         "if (kept.hidden !== undefined) location.hash = `#hole=${kept.hidden}`"),
        ("a wrong id has a notice", "$('#notice-text').textContent === 'This page has no loop 987654.'",
         "press ESCAPE", "location.hash = '#hole=987654'"),
        ("and selects nothing", "lacuna.selected() === null")])
    open_page(driver, address)
    load(driver, text)


def check_has(driver, file):
    """The page has the marks and notes of a file, whatever the ids."""
    pairs = [sorted((entry["mark"], entry["note"]) for entry in json.loads(text)["marks"])
             for text in (file.read_text(encoding="utf-8"), value(driver, "page.marks.text()"))]
    require(len(pairs[0]) > 1 and pairs[0] == pairs[1], f"the page has the {len(pairs[0])} marks of the file")
    play(driver, [("the table shows them", "$$('#body .mark-cell svg').length > 0"),
                  ("no script of a note runs", "window.foreign === undefined")])


def check(driver):
    play(driver, SET)
    if value(driver, "page.data.loops.count") > 1:
        play(driver, FOCUSED_ROW)
    play(driver, FILTER)
    check_file(driver)
    check_links(driver)
