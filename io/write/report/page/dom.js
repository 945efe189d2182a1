// SPDX-License-Identifier: Apache-2.0
// Short ways to make and find elements; and what leaves the page, for the clipboard and for files.

function find(id) {
  return document.getElementById(id);
}

// element("td", {class: "number", title: "..."}, "text" or node, ...)
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  set_attributes(made, attributes);
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

function drawing(name, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  set_attributes(made, attributes);
  made.append(...children);
  return made;
}

function set_attributes(to, attributes) {
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    // The page's security policy allows no style attributes in text, but this way of setting them.
    if (key === "style") to.style.cssText = value; else to.setAttribute(key, value === true ? "" : value);
  }
}

// Name and value pairs of a description list; `rows` holds [name, value, class or nothing].
function description(rows) {
  const list = element("dl", {class: "pairs"});
  for (const [name, value, style] of rows) {
    list.append(element("div", {class: style}, element("dt", {}, name), element("dd", {}, value)));
  }
  return list;
}

function style_value(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

async function copy_text(text, button) {
  const is_done = await Promise.resolve().then(() => navigator.clipboard.writeText(text)).then(() => true, () => false);
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
