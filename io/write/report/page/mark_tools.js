// SPDX-License-Identifier: Apache-2.0
// What shows and changes marks: their sign in the table, the fields of the selected loop, files, and notices.

// A small drawing and the word: the shape alone says which, without colours.
const kMarkShapes = {
  "real": [["circle", {cx: 8, cy: 8, r: 4.5, class: "solid"}]],
  "ignore": [["circle", {cx: 8, cy: 8, r: 4.7}], ["path", {d: "M4.8 11.2l6.4-6.4"}]],
  "scan again": [["path", {d: "M12.6 6.2A5 5 0 1 0 13 8.6M12.9 2.9v3.4H9.5"}]],
  "done": [["path", {d: "M3.2 8.4l3.2 3.2 6.4-7"}]],
};

function mark_sign(name) {
  const shapes = (kMarkShapes[name] || []).map(([shape, attributes]) => drawing(shape, attributes));
  return drawing("svg", {viewBox: "0 0 16 16", class: `sign ${mark_class(name)}`, "aria-hidden": "true"}, ...shapes);
}

function mark_class(name) {
  return `mark-${name.replace(" ", "-")}`;
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

// Numbers of loops in the list of the filter; a line where the browser keeps no marks.
function update_mark_tools(marks) {
  for (const option of find("mark-filter").options) {
    const is_mark = kMarkNames.includes(option.value);
    option.textContent = option.dataset.title + (is_mark ? ` (${format_count(marks.count(option.value))})` : "");
  }
  find("storage-notice").hidden = marks.is_kept || marks.loops.count === 0;
}

// `file_name()` names the file that is saved.
function connect_marks(marks, file_name) {
  const option = (value, title) => element("option", {value, "data-title": title}, title);
  find("mark-filter").append(option("any", "Any mark"), option(kNoMark, "No mark"), ...kMarks.map(({name, title}) => option(name, title)));
  const chosen = find("marks-file");
  find("marks-save").addEventListener("click", () => save_text(marks.text(), file_name(), "application/json"));
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
