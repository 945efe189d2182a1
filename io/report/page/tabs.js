// SPDX-License-Identifier: Apache-2.0
// On narrow screens: the tabs of the sheet below the view, and its height.

function connect_tabs() {
  const tabs = Array.from(document.querySelectorAll("[role=tab]"));
  const choose = (tab, is_focused) => {
    document.body.dataset.tab = tab.dataset.tab;
    for (const other of tabs) {
      other.setAttribute("aria-selected", String(other === tab));
      other.tabIndex = other === tab ? 0 : -1;
    }
    if (is_focused) tab.focus();
  };
  for (const [at, tab] of tabs.entries()) {
    tab.addEventListener("click", () => choose(tab, false));
    tab.addEventListener("keydown", (event) => {
      const move = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (move) choose(tabs[(at + move + tabs.length) % tabs.length], true);
    });
  }
  choose(tabs[0], false);
  find("sheet").addEventListener("click", () => {
    const is_tall = document.body.classList.toggle("tall-sheet");
    find("sheet").setAttribute("aria-expanded", String(is_tall));
    find("sheet").setAttribute("aria-label", is_tall ? "Smaller panel" : "Larger panel");
  });
}
