// SPDX-License-Identifier: Apache-2.0
// Links into a report: its address with #hole=ID opens at the loop with this id in holes.json, a hole or an outer curve.

// The id of a part of an address such as "#hole=12"; null without one.
function linked_id(hash) {
  const match = /^#hole=(\d{1,15})$/.exec(hash);
  return match ? Number(match[1]) : null;
}

// Gives the address the id of a loop, or none for null. The history gets no entry, so Back leaves the page.
function set_link(id) {
  const hash = id === null ? "" : `#hole=${id}`;
  if (location.hash === hash) return;
  try {
    history.replaceState(null, "", location.pathname + location.search + hash);
  } catch (error) {
    // A page without an address of its own, such as one in a frame of others: nothing to link to.
  }
}
