// SPDX-License-Identifier: Apache-2.0
// Settings of the view: size of the points, what is shown.

function connect_settings() {
  find("view-more").addEventListener("click", () => {
    const is_open = find("view-settings").hidden;
    find("view-settings").hidden = !is_open;
    find("view-more").setAttribute("aria-expanded", String(is_open));
  });
}

function connect_shown(scenes) {
  const size = () => {
    const factor = Math.pow(2, Number(find("point-size").value));
    find("point-size-value").textContent = `× ${format_number(factor, 2)}`;
    scenes.set_point_size(factor);
  };
  find("point-size").addEventListener("input", size);
  size();
  const shown = () => scenes.set_shown(find("show-points").checked, find("show-loops").checked);
  find("show-points").addEventListener("change", shown);
  find("show-loops").addEventListener("change", shown);
  find("through").addEventListener("change", () => scenes.set_through(find("through").checked));
}
