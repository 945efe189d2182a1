# SPDX-License-Identifier: Apache-2.0
"""Checks causes of holes and stations of a report: column, filter, colours, details, line, markers, facts, keys, widths."""

from report_browser import play, require, value
from report_marks import SHOW_DETAILS, SHOW_LOOPS
from report_tools import saved_table

CAUSES = ["hidden", "opening", "out_of_view", "no_return", "filtered"]
IS_SHOWN = "(node) => node.getBoundingClientRect().width > 0"
# Ids of the rows, the words of their causes, and the ranks of these: those without a cause come last.
ROWS = "kept.rows = $$('#body tr[data-row]').map((row) => [Number(row.dataset.id), row.querySelector('.column-cause').textContent]);" \
       "kept.ranks = kept.rows.map(([, words]) => (words ? page.data.loops.causes.map(cause_title).indexOf(words) : 99))"

WITHOUT = [
    ("without stations the facts say how to give them, in one sentence",
     "kept.facts.includes('--stations FILE') && kept.facts.includes('docs/stations.md') && kept.facts.split('Causes').length === 3 &&"
     "!kept.facts.includes('Stations')", "kept.facts = $('#facts-body').textContent"),
    ("nothing else of it shows", f"!['#cause-select', '#loop-colours', '#stations-check', '.column-cause'].flatMap($$).some({IS_SHOWN})"),
    ("no station is drawn", "$$('#stations-over path.station').length === 0"),
]

# The page of a comparison has loops of both results, and what has become of them, in place of causes.
CHANGES = [
    ("loops have changes", "['same', 'closed'].every((change) => page.data.loops.cause.includes(change))"),
    ("the table has them in words", "kept.rows.every(([id, words]) => words === lacuna.cause(id).replace(/_/g, ' '))", ROWS),
    ("under their name", "$('th[data-key=cause]').innerText.trim().endsWith('Change')"),
    ("the head names the other result", "$('#summary').textContent.includes('compared with ')"),
    ("loops have the colours of changes", "$('#legend').textContent.includes('closed')"),
    ("as the legend says", "lacuna.pixels('cause-closed') > 0"),
    ("details have the id before", "$('#details-body').textContent.includes('Before')",
     "$(`#body tr[data-id='${kept.rows.find(([, words]) => words === 'closed')[0]}']`).click()"),
]


def check_changes(driver):
    play(driver, CHANGES)
    head, rows = saved_table(driver)
    require([row[head.index("change")] for row in rows].count("closed") == value(driver, "page.data.loops.cause").count("closed"),
            "the saved table has changes")


WIDTHS = [
    ("nothing is wider than the page", "document.documentElement.scrollWidth <= innerWidth"),
    ("the filters have few rows", "kept.tops.size <= (innerWidth >= 1280 ? 1 : 4)",
     "kept.tops = new Set($$('#filters > *').map((item) => item.getBoundingClientRect()).map(({top, bottom}) => Math.round((top + bottom) / 20)));"),
    # Openings are no missing surface: the head of the page says both, with their unit.
    ("the head says openings apart", "$('#summary').textContent.includes(' missing, ') && $('#summary').textContent.includes(' openings')"),
]
COLUMN = [
    ("the table has causes in words", "kept.rows.every(([id, words]) => words === (lacuna.cause(id) === 'none' ? '' : lacuna.cause(id).replace(/_/g, ' ')))", ROWS),
    ("a key on the head of the column sorts it", "kept.ranks.every((rank, i) => i === 0 || kept.ranks[i - 1] <= rank)",
     "$('th[data-key=cause] button').focus()", "press ENTER", ROWS),
    ("once more, the other way", "kept.ranks.filter((rank) => rank < 99).every((rank, i, all) => i === 0 || all[i - 1] >= rank)", "press ENTER", ROWS),
    ("by area again", "$('th[data-key=area]').ariaSort === 'descending'", "click th[data-key=area] button"),
]
FILTER = [
    *((f"the filter shows {name}", f"lacuna.shown() === page.data.loops.cause.filter((cause) => cause === '{name}').length", f"choose #cause-filter = {name}")
      for name in [*CAUSES, "none"]),
    ("its list counts them", "$$('#cause-filter option').some((option) => option.text === "
     "`Hidden (${page.data.loops.cause.filter((cause) => cause === 'hidden').length})`)"),
    ("a reset shows all", "lacuna.shown() === page.data.loops.count && $('#cause-filter').selectedOptions[0].text === 'Any cause'", "click #reset"),
]


def check_saved(driver):
    head, rows = saved_table(driver)
    causes = {int(row[0]): row[head.index("cause")] for row in rows}
    require(all(words == value(driver, "lacuna.cause(arguments[0])", loop).replace("none", "") for loop, words in causes.items()),
            "the saved table has causes, as holes.csv")
    shares = [sum(float(row[head.index(name)] or 0) for name in CAUSES) for row in rows if row[head.index("cause")]]
    require(shares and all(abs(share - 1) < 0.01 for share in shares), f"and the shares of {len(shares)} holes")


FACTS = [
    ("the facts count the causes", "kept.causes.every((name) => $('#facts-body').textContent.includes("
     "`${cause_title(name)}${page.data.loops.cause.filter((cause) => cause === name).length}`))",
     "kept.causes = Array.from(new Set(page.data.loops.cause)).filter((name) => name !== 'none')"),
    ("they do not say that causes are not known", "!$('#facts-body').textContent.includes('are not known, because')"),
    ("they list stations, and where to stand next", "String($$('#facts .places').map((table) => table.tBodies[0].rows.length)) === "
     "String([page.data.stations.length, page.data.next_stations.length].filter(Boolean))"),
    ("within their width", "$('#facts').scrollWidth <= $('#facts').clientWidth"),
    ("the summary on paper has causes", "kept.heads.includes('Cause') && kept.pages[0].includes('Causes')",
     "window.dispatchEvent(new Event('beforeprint'))",
     "kept.heads = $$('.print-table th').map((head) => head.textContent); kept.pages = $$('.print-page').map((each) => each.textContent);",
     "window.dispatchEvent(new Event('afterprint'))"),
    ("so has each page", "kept.pages.length > 1 && kept.pages.slice(1).every((text) => text.includes('Cause'))"),
]

# kept.names: styles of the causes that there are, but of that which has the colour of edges. Points are hidden, and loops are drawn
# through the surface: some lie behind it.
SWITCH = "$('#through').click(); $('#show-points').click();"
COLOURS = [
    ("loops have the colours of kinds", "lacuna.pixels('hole') > 0", SWITCH,
     "kept.names = kept.causes.filter((name) => name !== 'no_return').map((name) => cause_style(name).slice(2));"
     "kept.before = kept.names.map((name) => lacuna.pixels(name));"),
    ("by cause, they have them no longer", "lacuna.pixels('hole') === 0", "choose #loop-colouring = cause"),
    # All loops of one cause may be too small for pixels without a mixture.
    ("they have those of causes", "kept.names.filter((name, i) => lacuna.pixels(name) > kept.before[i] + 10).length >= Math.min(3, kept.names.length)"),
    ("the legend names the causes", "innerWidth < 900 || kept.causes.every((name) => $('#legend').textContent.includes(cause_title(name)))"),
    ("each differs from the background", "kept.names.every((name) => lacuna.colour(name).reduce("
     "(sum, value, k) => sum + Math.abs(value - lacuna.colour('view')[k]), 0) > 150)"),
    ("by kind again, they are as before", "lacuna.pixels('hole') > 0", "choose #loop-colouring = kind"),
    ("all is shown", "$('#show-points').checked", SWITCH),
]

# What lies over the view in sight: boxes of markers, and of the names that are shown.
MARKERS = "const boxes = (what) => $$('#stations-over ' + what).map((node) => node.getBoundingClientRect()).filter((box) => box.width > 0);" \
          "kept.seen = {stations: boxes('path.station'), next: boxes('rect.next'), names: boxes('text:not(.next)')};"
# No name covers another one, or a marker.
APART = "kept.seen.names.every((a, i) => [...kept.seen.names.slice(0, i), ...kept.seen.stations, ...kept.seen.next].every((b) => " \
        "a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top))"
STATIONS = [
    ("stations and next ones are drawn", "kept.seen.stations.length === page.data.stations.length && "
     "kept.seen.next.length === page.data.next_stations.length", "click [data-side=top]", MARKERS),
    ("some with names", "kept.seen.names.length > 0"),
    ("names do not overlap", APART),
    ("a switch hides them, by a key", "!Object.values(kept.seen).some((boxes) => boxes.length > 0)", "kept.shown = JSON.stringify(kept.seen)",
     "$('#view-more').focus()", "press ENTER", "$('#show-stations').focus()", "press SPACE", MARKERS),
    ("nothing of the settings is cut", "$('#view-settings').scrollWidth <= $('#view-settings').clientWidth"),
    ("and shows them again", "JSON.stringify(kept.seen) === kept.shown", "press SPACE", "$('#view-more').focus()", "press ENTER", MARKERS),
    ("names do not overlap from the front", APART, "press 2", MARKERS),
    ("all of it fits", "!$('#view-settings').offsetParent", "click [data-side=fit]"),
]

LINES = "kept.lines = $$('#stations-over .sight line:not(.casing)');"
HIDDEN = [
    ("what hides it is named", "kept.text.includes('what stands at') && kept.text.includes('from station ')"),
    # From above, the station, what hides and the hole lie in the view.
    ("a line goes from the station to what hides, and on to the hole", "$$('#stations-over .sight line').length === 4", "click [data-side=top]", LINES),
    ("both parts are joined", "(([a, b]) => Math.hypot(a.x2.baseVal.value - b.x1.baseVal.value, a.y2.baseVal.value - b.y1.baseVal.value) < 0.5)(kept.lines)"),
    ("dashed behind what hides", "(([a, b]) => a === 'none' && b !== 'none')(kept.lines.map((line) => getComputedStyle(line).strokeDasharray))",
     LINES),
    ("the station is emphasised", "$$('#stations-over .chosen path.station').length > 0"),
]


def details_steps(name):
    """The first hole of a cause is found by the filter and a key."""
    return [
        (f"a hole has the cause {name}", f"lacuna.cause() === '{name}'", SHOW_LOOPS, f"choose #cause-filter = {name}", "$('#canvas').focus()", "press n", SHOW_DETAILS),
        ("the details have the shares of its causes, those above 1 %",
         "Object.entries(kept.wanted).every(([cause, share]) => Math.abs(kept.words[cause] - 100 * share) <= 0.51) && "
         "Object.keys(kept.words).length === Object.keys(kept.wanted).length",
         "kept.text = $('#details-body').innerText;"
         "kept.words = Object.fromEntries(Array.from(kept.text.matchAll(/([a-z][a-z ]*) (\\d+) %/g), ([, words, share]) => [words, Number(share)]));"
         "kept.wanted = Object.fromEntries(Object.entries(lacuna.shares()).filter(([, share]) => share > 0.01)"
         ".map(([cause, share]) => [cause_title(cause), share]));"),
        *(HIDDEN if name == "hidden" else [
            ("one with another cause has no line", "kept.text.includes('what stands at') === ('hidden' in kept.words) && kept.lines.length === 0", LINES)]),
        ("without a selection there is no line", "kept.lines.length === 0", "press ESCAPE", SHOW_LOOPS, "click #reset", LINES),
    ]


def check(driver):
    if value(driver, "page.data.stations.length") == 0:
        play(driver, WITHOUT)
        return
    play(driver, WIDTHS + COLUMN + FILTER)
    check_saved(driver)
    play(driver, FACTS)
    if value(driver, "page.view !== null"):
        play(driver, COLOURS + STATIONS)
        for name in ("hidden", "opening", "filtered"):
            if name in value(driver, "page.data.loops.cause"):
                play(driver, details_steps(name))
