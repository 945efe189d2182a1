// SPDX-License-Identifier: Apache-2.0
// The selected loop: its measures, its mark and its note.

class Details {
  // `actions`: {fly(index), close()}
  constructor(data, units, decimals, marks, actions) {
    Object.assign(this, {data, units, decimals, marks, actions});
    this.show(-1);
  }

  show(index) {
    const body = find("details-body");
    document.body.classList.toggle("has-selected", index >= 0);
    if (index < 0) {
      const has_loops = this.data.loops.count > 0;
      find("details-heading").replaceChildren("Selected loop");
      body.replaceChildren(element("p", {class: "quiet"},
          has_loops ? "Choose a row of the table or a loop in the view." : "This scan has no loops."));
      return;
    }
    const {loops} = this.data;
    const name = loops.is_hole[index] ? "hole" : "outer";
    const place = this.vector(loops.centroid, index, this.decimals);
    const copy = element("button", {type: "button", id: "copy"}, "Copy place");
    copy.addEventListener("click", () => copy_text(place.join(" ").replace(/−/g, "-"), copy));
    const link = element("button", {type: "button", id: "copy-link", title: "The address of this page at this loop"}, "Copy link");
    link.addEventListener("click", () => copy_text(location.href, link));
    const fly = element("button", {type: "button", title: "Fly to the loop"}, "Fly");
    fly.addEventListener("click", () => this.actions.fly(index));
    const close = element("button", {type: "button"}, "Deselect");
    close.addEventListener("click", () => this.actions.close());
    find("details-heading").replaceChildren(element("i", {class: `swatch ${name}`}), loop_name(loops, index));
    body.replaceChildren(
        mark_fields(this.marks, index),
        this.measures(index),
        element("div", {class: "buttons"}, copy, link, fly, close));
    update_mark_fields(this.marks, index);
  }

  // Texts of three numbers of a loop.
  vector(column, index, digits) {
    return vector_of(column, index).map((value) => format_place(value, digits));
  }

  // Pairs of names and values.
  measures(index) {
    const {data: {loops}, units} = this;
    return description([
      ["Area", units.area(loops.area[index], 4)],
      ["Perimeter", units.length(loops.perimeter[index], 4)],
      ["Diameter", units.length(loops.diameter[index], 4)],
      ["Confidence", format_fraction(loops.confidence[index])],
      ["Found at scales", scales(loops, index, units)],
      ...cause_rows(this.data, index, this.decimals),
      ["Planarity", format_fraction(loops.planarity[index])],
      ["Points", format_count(loops.points[index])],
      [`Centroid${units.name ? ", " + units.name : ""}`, axes(this.vector(loops.centroid, index, this.decimals)), "wide"],
      ["Normal", axes(this.vector(loops.normal, index, 4)), "wide"],
    ]);
  }
}

function axes(values) {
  return element("span", {class: "axes"},
      ...values.map((value, axis) => element("span", {}, element("i", {}, "xyz"[axis]), value)));
}

// From the first to the last lattice at which the hole is found.
function scales(loops, index, units) {
  const name = (edge) => edge > 0 ? units.length(edge) : "all points";
  const first = name(loops.first_scale[index]), last = name(loops.last_scale[index]);
  return first === last ? first : `${first} to ${last}`;
}

function loop_name(loops, index) {
  return `${loops.is_hole[index] ? "Hole" : "Outer curve"} ${loops.id[index]}`;
}
