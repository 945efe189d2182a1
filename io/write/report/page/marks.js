// SPDX-License-Identifier: Apache-2.0
// Marks of loops: what a reader decides about each, with a note. docs/formats.md has the form of a file of them, which alone
// keeps them. Below: their sign in the table, the fields of the selected loop, files, and notices.

const kMarksSchema = "marks 1";
// In the order of the filter and of the sort; `key` sets the mark.
const kMarks = [
  {name: "real", title: "Real", key: "r"},
  {name: "ignore", title: "Ignore", key: "i"},
  {name: "scan again", title: "Scan again", key: "g"},
  {name: "done", title: "Done", key: "o"},
];
const kNoMark = "none";
const kMarkNames = [kNoMark, ...kMarks.map(({name}) => name)];
const kMostSizes = 1.5;  // of two diameters of one hole, the larger over the smaller

class Marks {
  // `on_change()` after each change of marks; not of notes, which no part but their field shows.
  constructor({loops, report}, on_change) {
    Object.assign(this, {loops, on_change, version: report.lacuna || ""});
    this.mark = new Array(loops.count).fill(kNoMark);
    this.note = new Array(loops.count).fill("");
    this.unmatched = [];  // entries that fit no loop of this page: a file that is saved has them again
    this.is_saved = true;
    window.addEventListener("beforeunload", (event) => { if (!this.is_saved) event.preventDefault(); });
  }

  // A loop without a finite place could not be found again.
  can_mark(index) {
    return vector_of(this.loops.centroid, index).every(Number.isFinite) && this.loops.diameter[index] > 0;
  }

  set(index, name) {
    if (!this.can_mark(index) || this.mark[index] === name) return;
    this.mark[index] = name;
    this.is_saved = false;
    this.on_change();
  }

  set_note(index, text) {
    if (!this.can_mark(index)) return;
    this.note[index] = text;
    this.is_saved = false;
  }

  count(name) { return this.mark.reduce((sum, mark) => sum + (mark === name), 0); }

  entries() {
    const {loops} = this;
    const marked = [];
    for (let i = 0; i < loops.count; ++i) {
      if (this.mark[i] === kNoMark && this.note[i] === "") continue;
      marked.push({id: loops.id[i], kind: loops.is_hole[i] ? "hole" : "outer",
                   centroid: vector_of(loops.centroid, i).map(short_place), diameter: loops.diameter[i],
                   mark: this.mark[i], note: this.note[i]});
    }
    const later = (a, b) => a.id - b.id || a.centroid[0] - b.centroid[0] || a.centroid[1] - b.centroid[1] ||
                            a.centroid[2] - b.centroid[2];
    return [...marked, ...this.unmatched].sort(later);
  }

  // The file: one line for each entry, by id.
  text() {
    const lines = this.entries().map((entry) => `    ${JSON.stringify(entry)}`);
    const list = lines.length > 0 ? `[\n${lines.join(",\n")}\n  ]` : "[]";
    return `{\n  "lacuna": ${JSON.stringify(this.version)},\n  "schema": "${kMarksSchema}",\n  "marks": ${list}\n}\n`;
  }

  // Takes the marks of a file; loops that it does not name keep theirs. Returns {all, by_place, unmatched}, counts of
  // entries. Throws an error of one line where the text is not such a file.
  load(text) {
    const entries = read_marks(text);
    const {loop_of, by_place} = match_marks(entries, this.loops);
    const known = new Set(this.unmatched.map((entry) => JSON.stringify(entry)));
    let unmatched = 0;
    entries.forEach((entry, i) => {
      if (loop_of[i] >= 0) {
        this.mark[loop_of[i]] = entry.mark;
        this.note[loop_of[i]] = entry.note;
        return;
      }
      ++unmatched;
      if (!known.has(JSON.stringify(entry))) this.unmatched.push(entry);
    });
    this.on_change();
    return {all: entries.length, by_place, unmatched};
  }
}

// Without the noise of binary fractions beyond 15 digits.
function short_place(value) {
  return Number(value.toPrecision(15));
}

// The entries of a file of marks. Throws an error that names the place, the reason, and what is allowed.
function read_marks(text) {
  let file;
  try {
    file = JSON.parse(text);
  } catch (error) {
    throw new Error("it is not JSON; a file that Save marks has written is needed");
  }
  const is_object = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
  if (!is_object(file) || file.schema !== kMarksSchema) {
    throw new Error(`its schema is ${is_object(file) ? JSON.stringify(file.schema) || "missing" : "missing"}; "${kMarksSchema}" is read`);
  }
  if (!Array.isArray(file.marks)) throw new Error("marks: a list is needed");
  return file.marks.map((entry, i) => {
    const need = (is_right, key, allowed) => {
      if (!is_right) throw new Error(`marks[${i}]${key ? "." + key : ""}: ${allowed}`);
    };
    need(is_object(entry), "", "an object is needed");
    need(Number.isSafeInteger(entry.id) && entry.id >= 0, "id", "a whole number from 0 is needed");
    need(entry.kind === "hole" || entry.kind === "outer", "kind", "hole or outer is allowed");
    need(Array.isArray(entry.centroid) && entry.centroid.length === 3 && entry.centroid.every(is_number), "centroid", "three numbers are needed");
    need(is_number(entry.diameter) && entry.diameter > 0, "diameter", "a number above 0 is needed");
    need(kMarkNames.includes(entry.mark), "mark", `${kMarkNames.slice(0, -1).join(", ")} or ${kMarkNames[kMarkNames.length - 1]} is allowed`);
    need(typeof entry.note === "string", "note", "a text is needed");
    const {id, kind, centroid, diameter, mark, note} = entry;
    return {id, kind, centroid, diameter, mark, note};
  });
}

// Finds the loop of each entry: by id, then by place, as docs/formats.md says. Returns {loop_of, by_place}:
// an index of a loop, or -1, for each entry, and how many were found by place.
function match_marks(entries, loops) {
  const loop_of = new Array(entries.length).fill(-1), is_taken = new Uint8Array(loops.count);
  const away = ({centroid}, i) => Math.hypot(...centroid.map((value, axis) => value - loops.centroid[3 * i + axis]));
  const is_kind = ({kind}, i) => (kind === "hole") === Boolean(loops.is_hole[i]);
  const index_of = new Map(Array.from(loops.id, (value, i) => [value, i]));
  entries.forEach((entry, at) => {
    const i = index_of.get(entry.id);
    if (i === undefined || is_taken[i] || !is_kind(entry, i)) return;
    if (!(away(entry, i) <= Math.min(entry.diameter, loops.diameter[i]))) return;
    loop_of[at] = i;
    is_taken[i] = 1;
  });
  const pairs = [];
  entries.forEach((entry, at) => {
    if (loop_of[at] >= 0) return;
    for (let i = 0; i < loops.count; ++i) {
      if (!(Math.abs(loops.centroid[3 * i] - entry.centroid[0]) <= entry.diameter / 2)) continue;  // of most pairs
      const sizes = loops.diameter[i] / entry.diameter;
      if (is_taken[i] || !is_kind(entry, i) || !(sizes <= kMostSizes && sizes >= 1 / kMostSizes)) continue;
      const distance = away(entry, i);
      if (distance <= entry.diameter / 2) pairs.push({at, i, distance});
    }
  });
  pairs.sort((a, b) => a.distance - b.distance || a.at - b.at || a.i - b.i);
  let by_place = 0;
  for (const {at, i} of pairs) {
    if (loop_of[at] >= 0 || is_taken[i]) continue;
    loop_of[at] = i;
    is_taken[i] = 1;
    ++by_place;
  }
  return {loop_of, by_place};
}

// A small drawing and the word: the shape alone says which, without colours.
const kMarkShapes = {
  "real": [["circle", {cx: 8, cy: 8, r: 4.5, class: "solid"}]],
  "ignore": [["circle", {cx: 8, cy: 8, r: 4.7}], ["path", {d: "M4.8 11.2l6.4-6.4"}]],
  "scan again": [["path", {d: "M12.6 6.2A5 5 0 1 0 13 8.6M12.9 2.9v3.4H9.5"}]],
  "done": [["path", {d: "M3.2 8.4l3.2 3.2 6.4-7"}]],
};

function mark_sign(name) {
  const shapes = (kMarkShapes[name] || []).map(([shape, attributes]) => drawing(shape, attributes));
  return drawing("svg", {viewBox: "0 0 16 16", class: `sign mark-${name.replace(" ", "-")}`, "aria-hidden": "true"}, ...shapes);
}

function mark_title(name) {
  const known = kMarks.find((mark) => mark.name === name);
  return known ? known.title : "None";
}

// The mark and the note of a loop, to change.
function mark_fields(marks, index) {
  const choice = (name, title, key) => element("label", {title: `${title} (${key})`},
      element("input", {type: "radio", name: "mark", value: name}), element("span", {}, title));
  const choices = element("fieldset", {class: "segments marks", disabled: !marks.can_mark(index)},
      element("legend", {class: "unseen"}, "Mark"), choice(kNoMark, "None", "0"),
      ...kMarks.map(({name, title, key}) => choice(name, title, key.toUpperCase())));
  choices.addEventListener("change", (event) => marks.set(index, event.target.value));
  const note = element("textarea", {id: "note", rows: 2, maxlength: 4000, placeholder: "Note", "aria-label": "Note", title: "Note (E)",
                                    disabled: !marks.can_mark(index)});
  note.value = marks.note[index];
  note.addEventListener("input", () => marks.set_note(index, note.value));
  return element("div", {class: "mark-fields"}, choices, note);
}

// Sets the fields of the selected loop to its mark.
function update_mark_fields(marks, index) {
  for (const radio of document.getElementsByName("mark")) radio.checked = radio.value === marks.mark[index];
  const note = find("note");
  if (note && note !== document.activeElement) note.value = marks.note[index];
}

// Numbers of loops in the list of the filter.
function update_mark_tools(marks) {
  for (const option of find("mark-filter").options) {
    const is_mark = kMarkNames.includes(option.value);
    option.textContent = option.dataset.title + (is_mark ? ` (${format_count(marks.count(option.value))})` : "");
  }
}

// `file_name()` names the file that is saved.
function connect_marks(marks, file_name) {
  const option = (value, title) => element("option", {value, "data-title": title}, title);
  find("mark-filter").append(option("any", "Any mark"), option(kNoMark, "No mark"), ...kMarks.map(({name, title}) => option(name, title)));
  const chosen = find("marks-file");
  find("marks-save").addEventListener("click", () => {
    save_text(marks.text(), file_name(), "application/json");
    marks.is_saved = true;
  });
  find("marks-load").addEventListener("click", () => chosen.click());
  chosen.addEventListener("change", async () => {
    const file = chosen.files[0];
    if (!file) return;
    try {
      show_notice(loaded_words(file.name, marks.load(await file.text())));
    } catch (error) {
      show_notice(`${file.name}: ${error.message}`, true);
    }
    chosen.value = "";  // the same file may be chosen again
  });
  for (const name of ["marks-save", "marks-load"]) find(name).disabled = marks.loops.count === 0;
  find("notice-close").addEventListener("click", () => { find("notice").hidden = true; });
}

function loaded_words(name, {all, by_place, unmatched}) {
  const found = `${name}: ${format_count(all - unmatched)} of ${plural(all, "mark", "marks")} found their loops` +
                (by_place > 0 ? `, ${format_count(by_place)} of them by place` : "") + ".";
  return unmatched === 0 ? found
      : `${found} The others fit no loop of this page; a file that is saved has them again.`;
}

function show_notice(text, is_error = false) {
  find("notice-text").textContent = text;
  find("notice").classList.toggle("error", is_error);
  find("notice").hidden = false;
}
