// SPDX-License-Identifier: Apache-2.0
// Marks of loops: what a reader decides about each, with a note. docs/formats.md has the form of a file of them.
//
// The browser keeps them, by result.

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
    this.key = `lacuna ${kMarksSchema} ${result_code(report)}`;
    this.clear();
    this.is_kept = can_keep();
    const kept = this.kept();
    if (kept) this.take(kept);
    window.addEventListener("storage", (event) => { if (event.key === this.key) this.take_again(); });
    window.addEventListener("pagehide", () => this.keep());
  }

  clear() {
    this.mark = new Array(this.loops.count).fill(kNoMark);
    this.note = new Array(this.loops.count).fill("");
    this.unmatched = [];  // entries that fit no loop of this page: a file that is saved has them again
  }

  // A loop without a finite place could not be found again.
  can_mark(index) {
    return [0, 1, 2].every((axis) => Number.isFinite(this.loops.centroid[3 * index + axis])) && this.loops.diameter[index] > 0;
  }

  set(index, name) {
    if (!this.can_mark(index) || this.mark[index] === name) return;
    this.mark[index] = name;
    this.keep();
    this.on_change();
  }

  set_note(index, text) {
    if (!this.can_mark(index)) return;
    this.note[index] = text;
    clearTimeout(this.soon);
    this.soon = setTimeout(() => this.keep(), 300);
  }

  count(name) { return this.mark.reduce((sum, mark) => sum + (mark === name), 0); }

  entries() {
    const {loops} = this;
    const marked = [];
    for (let i = 0; i < loops.count; ++i) {
      if (this.mark[i] === kNoMark && this.note[i] === "") continue;
      marked.push({id: loops.id[i], kind: loops.is_hole[i] ? "hole" : "outer",
                   centroid: Array.from(loops.centroid.subarray(3 * i, 3 * i + 3), short_place), diameter: loops.diameter[i],
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
    const {by_place, unmatched} = this.take(entries);
    this.keep();
    this.on_change();
    return {all: entries.length, by_place, unmatched};
  }

  take(entries) {
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
    return {by_place, unmatched};
  }

  // Another window of this page has changed them.
  take_again() {
    const kept = this.kept();
    if (!kept) return;
    this.clear();
    this.take(kept);
    this.on_change();
  }

  // Entries that the browser has kept; null without any.
  kept() {
    try {
      const text = localStorage.getItem(this.key);
      return text === null ? null : read_marks(text);
    } catch (error) {
      return null;
    }
  }

  keep() {
    clearTimeout(this.soon);
    if (!this.is_kept) return;
    const text = this.text();
    if (text === this.last) return;
    try {
      localStorage.setItem(this.key, text);
      this.last = text;
    } catch (error) {
      this.is_kept = false;  // the storage is full
      this.on_change();
    }
  }
}

// Whether the browser keeps anything for this page: it may not for a file, or in a private window.
function can_keep() {
  try {
    localStorage.setItem("lacuna", "1");
    localStorage.removeItem("lacuna");
    return true;
  } catch (error) {
    return false;
  }
}

// Equal for pages of equal results.
function result_code({title, inputs, loops}) {
  const {id, centroid, diameter} = loops || {};
  return text_code(JSON.stringify([title, inputs, id, centroid, diameter]));
}

// 64 bits of a text, as hexadecimal digits: FNV-1a (Fowler, Noll, Vo) from two starts.
function text_code(text) {
  return [0x811c9dc5, 0x01000193].map((start) => {
    let code = start;
    for (let i = 0; i < text.length; ++i) code = Math.imul(code ^ text.charCodeAt(i), 0x01000193);
    return (code >>> 0).toString(16).padStart(8, "0");
  }).join("");
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
