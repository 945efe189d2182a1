// SPDX-License-Identifier: Apache-2.0
// Out of the page: to the clipboard, and to files.

// The clipboard, or the old way where a page of a file may not use it.
async function copy_text(text, button) {
  let is_done = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch (error) {
    const field = element("textarea", {class: "unseen", "aria-hidden": "true"});
    field.value = text;
    document.body.append(field);
    field.select();
    is_done = document.execCommand("copy");
    field.remove();
    button.focus();
  }
  const name = button.textContent;
  button.textContent = is_done ? "Copied" : "Not copied";
  setTimeout(() => { button.textContent = name; }, 1400);
}

function save_text(text, name, type) {
  save_blob(new Blob([text], {type}), name);
}

function save_blob(blob, name) {
  const address = URL.createObjectURL(blob);
  const link = element("a", {href: address, download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}
