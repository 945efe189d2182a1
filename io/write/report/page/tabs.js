// SPDX-License-Identifier: Apache-2.0
// On narrow screens: the tabs of the sheet below the view, and its height.

// `name`: the data-tab of one of them.
function choose_tab(name) {
  document.body.dataset.tab = name;
  for (const tab of document.querySelectorAll("[role=tab]")) {
    tab.setAttribute("aria-selected", String(tab.dataset.tab === name));
    tab.tabIndex = tab.dataset.tab === name ? 0 : -1;
  }
}

function connect_tabs() {
  const tabs = Array.from(document.querySelectorAll("[role=tab]"));
  const choose = (tab, is_focused) => {
    choose_tab(tab.dataset.tab);
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
  // Elsewhere the charts open below the table.
  const is_narrow = matchMedia("(max-width: 899px)");
  const open_charts = () => { find("charts").open = is_narrow.matches; };
  is_narrow.addEventListener("change", open_charts);
  open_charts();
  find("sheet").addEventListener("click", () => {
    const is_tall = document.body.classList.toggle("tall-sheet");
    find("sheet").setAttribute("aria-expanded", String(is_tall));
    find("sheet").setAttribute("aria-label", is_tall ? "Smaller panel" : "Larger panel");
  });
}
