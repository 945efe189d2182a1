# SPDX-License-Identifier: Apache-2.0
"""Checks marks, notes and links of a report: by keys and by hand, after a reload, in files, and without a storage."""

import json
import tempfile
from pathlib import Path

from report_browser import By, Keys, Select, camera, next_picture, press, require, still, wait_for

NOTE = "</script><img src=x onerror='window.foreign = true'> \"a, b\""
NO_STORAGE = "Object.defineProperty(window, 'localStorage', {get() { throw new DOMException('none', 'SecurityError'); }});"


def value(driver, expression, *arguments):
    return driver.execute_script(f"return {expression}", *arguments)


def mark(driver, loop):
    return value(driver, "lacuna.mark(arguments[0])", loop)


def row_text(driver, loop):
    return driver.find_element(By.CSS_SELECTOR, f"#body tr[data-id='{loop}'] .mark-cell").text


def open_page(driver, address):
    driver.get("about:blank")
    driver.get(address)
    wait_for(driver, "window.lacuna && window.lacuna.ready", "the page is ready")


def show_details(driver):
    """On narrow screens they are a tab of their own."""
    tab = driver.find_element(By.ID, "tab-details")
    if tab.is_displayed():
        tab.click()


def show_loops(driver):
    tab = driver.find_element(By.ID, "tab-loops")
    if tab.is_displayed():
        tab.click()


def check_set(driver):
    """Returns the id of a loop that is marked as real, with NOTE."""
    press(driver, "n")
    still(driver)
    loop = value(driver, "lacuna.selected()")
    require(mark(driver, loop) == "none", f"loop {loop} has no mark at first")
    press(driver, "i")
    require(mark(driver, loop) == "ignore" and row_text(driver, loop) == "Ignore", "I marks the selected loop, the table shows it")
    show_details(driver)
    driver.find_element(By.CSS_SELECTOR, "input[name=mark][value='scan again']").click()
    require(mark(driver, loop) == "scan again", "a click marks it")
    press(driver, "r")
    require(value(driver, "document.querySelector('input[name=mark]:checked').value") == "real", "a key moves the choice of the details")
    press(driver, "e")
    note = driver.switch_to.active_element
    require(note.get_attribute("id") == "note", "E goes to the note")
    note.send_keys(NOTE + " 0 i")
    require(mark(driver, loop) == "real", "letters of a note are no keys")
    note.send_keys(Keys.BACKSPACE * 4)
    require(value(driver, "lacuna.note(arguments[0])", loop) == NOTE, "the note is kept")
    press(driver, Keys.ESCAPE)
    require(value(driver, "lacuna.selected()") == loop, "Escape leaves the note alone")
    press(driver, Keys.ESCAPE)
    still(driver)
    show_loops(driver)
    return loop


def check_focused_row(driver, count):
    """A key marks the row in focus, not the selected loop."""
    if count < 2:
        return
    press(driver, "n")
    still(driver)
    selected = value(driver, "lacuna.selected()")
    driver.find_element(By.CSS_SELECTOR, f"#body tr[data-id='{selected}']").send_keys(Keys.ARROW_DOWN)
    focused = int(driver.switch_to.active_element.get_attribute("data-id"))
    press(driver, "o")
    require(focused != selected and mark(driver, focused) == "done", f"O marks the row in focus (loop {focused})")
    press(driver, "0")
    require(mark(driver, focused) == "none", "0 takes the mark away")
    press(driver, Keys.ESCAPE)
    still(driver)


def check_filter(driver, loop, count):
    chosen = Select(driver.find_element(By.ID, "mark-filter"))
    chosen.select_by_value("real")
    wait_for(driver, "lacuna.visible_loops() === 1", "the filter shows the one real loop")
    require(chosen.first_selected_option.text == "Real (1)", "its list counts them")
    chosen.select_by_value("none")
    wait_for(driver, f"lacuna.visible_loops() === {count - 1}", "the filter shows those without a mark")
    driver.find_element(By.ID, "reset").click()
    wait_for(driver, f"lacuna.visible_loops() === {count}", "a reset shows all")


def check_kept(driver, loop):
    address = driver.current_url
    open_page(driver, address)
    require(mark(driver, loop) == "real" and value(driver, "lacuna.note(arguments[0])", loop) == NOTE,
            "after a reload mark and note are there")
    require(not driver.find_element(By.ID, "storage-notice").is_displayed(), "nothing says that they are not kept")
    require(value(driver, "window.foreign === undefined"), "no script of a note runs")


def load(driver, text):
    """Loads a file by the button's field; returns the notice."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "<b>marks.json"
        file.write_text(text)
        driver.find_element(By.ID, "marks-file").send_keys(str(file))
        wait_for(driver, "!document.getElementById('notice').hidden", "a notice says what was loaded")
        words = driver.find_element(By.ID, "notice-text").text
    driver.find_element(By.ID, "notice-close").click()
    return words


def check_file(driver, loop):
    driver.execute_script("window.saved = null; const make = URL.createObjectURL; URL.createObjectURL = (blob) => {"
                          " blob.text().then((text) => { window.saved = text; URL.createObjectURL = make; }); return '#'; };"
                          "document.getElementById('marks-save').click();")
    wait_for(driver, "window.saved", "a file is saved")
    text = value(driver, "window.saved")
    file = json.loads(text)
    require(file["schema"] == "marks 1" and [entry["id"] for entry in file["marks"]] == [loop], "it has the marked loop")
    entry = file["marks"][0]
    require(entry["mark"] == "real" and entry["note"] == NOTE, "with mark and note")

    other = dict(entry, id=10 ** 9, mark="done", centroid=[entry["centroid"][0] + 0.3 * entry["diameter"], *entry["centroid"][1:]])
    lost = dict(entry, id=2, centroid=[place + 1e6 for place in entry["centroid"]])
    words = load(driver, json.dumps(dict(file, marks=[other, lost])))
    require("<b>marks.json: 1 of 2 marks found their loops, 1 of them by place." in words, f"a notice: {words}")
    require(mark(driver, loop) == "done", "a mark with another id is found by its place")
    kept = json.loads(value(driver, "lacuna.marks_text()"))["marks"]
    require([item["id"] for item in kept] == sorted([2, loop]) and lost in kept, "the one that fits no loop is saved again")
    open_page(driver, driver.current_url)
    require(json.loads(value(driver, "lacuna.marks_text()"))["marks"] == kept, "and kept")

    words = load(driver, text.replace('"real"', '"maybe"'))
    require('marks[0].mark: ' in words and "real" in words, f"a wrong file: {words}")
    require("holes 3" in load(driver, '{"schema": "holes 3"}'), "another file is refused by its schema")
    require("not JSON" in load(driver, text[:-5]), "so is half of a file")
    require(mark(driver, loop) == "done", "a wrong file changes nothing")


def check_without_storage(driver):
    made = driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": NO_STORAGE})
    open_page(driver, driver.current_url)
    require(driver.find_element(By.ID, "storage-notice").is_displayed(), "without a storage the page says so")
    press(driver, "n")
    press(driver, "g")
    still(driver)
    require(mark(driver, value(driver, "lacuna.selected()")) == "scan again", "marks work without it")
    driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", {"identifier": made["identifier"]})


def check_links(driver):
    """Every loop has an address of its own."""
    address = driver.current_url.split("#")[0]
    ids = value(driver, "Array.from(document.querySelectorAll('#body tr[data-row]'), (row) => Number(row.dataset.id))")
    open_page(driver, address)
    home = camera(driver)
    entries = value(driver, "history.length")
    open_page(driver, f"{address}#hole={ids[-1]}")
    require(value(driver, "lacuna.selected()") == ids[-1], f"the address #hole={ids[-1]} opens at its loop")
    require(camera(driver) != home and value(driver, "lacuna.is_still()"), "the view begins there")
    entries = value(driver, "history.length")
    press(driver, "n")
    still(driver)
    require(value(driver, "location.hash") == f"#hole={value(driver, 'lacuna.selected()')}", "the address follows the selection")
    press(driver, Keys.ESCAPE)
    still(driver)
    require(value(driver, "location.hash") == "" and value(driver, "history.length") == entries, "the history gets no entry")
    require(all(abs(a - b) < 1e-6 * (1 + abs(b)) for a, b in zip(camera(driver), home)), "Escape flies to the usual view")
    driver.find_element(By.CSS_SELECTOR, "input[name=kind][value=outer]").click()
    next_picture(driver)
    hidden = [loop for loop in ids if loop not in
              value(driver, "Array.from(document.querySelectorAll('#body tr[data-row]'), (row) => Number(row.dataset.id))")]
    if hidden:
        driver.execute_script(f"location.hash = '#hole={hidden[0]}'")
        wait_for(driver, f"lacuna.selected() === {hidden[0]}", "a link to a loop that the filters hide clears them")
        still(driver)
        press(driver, Keys.ESCAPE)
        still(driver)
    driver.execute_script("location.hash = '#hole=987654'")
    wait_for(driver, "document.getElementById('notice-text').textContent === 'This page has no loop 987654.'", "a wrong id has a notice")
    require(value(driver, "lacuna.selected()") is None, "and selects nothing")
    open_page(driver, address)


def check_has(driver, file):
    """The page has the marks and notes of a file, whatever the ids."""
    wanted = sorted((entry["mark"], entry["note"]) for entry in json.loads(file.read_text(encoding="utf-8"))["marks"])
    have = sorted((entry["mark"], entry["note"]) for entry in json.loads(value(driver, "lacuna.marks_text()"))["marks"])
    require(len(wanted) > 1 and have == wanted, f"the page has the {len(wanted)} marks of the file")
    require(value(driver, "document.querySelectorAll('#body .mark-cell svg').length") > 0, "the table shows them")
    require(value(driver, "window.foreign === undefined"), "no script of a note runs")


def check(driver, count):
    loop = check_set(driver)
    check_focused_row(driver, count)
    check_filter(driver, loop, count)
    check_kept(driver, loop)
    check_file(driver, loop)
    check_without_storage(driver)
    check_links(driver)
