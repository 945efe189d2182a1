// SPDX-License-Identifier: Apache-2.0
// Why holes are there: names, colours, counts and words of causes (docs/stations.md). On the page of a comparison, the changes of
// loops take their place (`lacuna compare`).

// In the order of the legend, the filter and the sort. The style --cause-NAME has the colour of each: they differ for
// colour-blind readers, too (Machado, Oliveira, Fernandes 2009), by 0.11 or more in OKLab.
const kCauses = ["hidden", "opening", "out_of_view", "no_return", "filtered"];
const kChanges = ["opened", "closed", "changed", "found_now", "not_found_now", "same", "not_comparable"];
const kNoCause = "none";  // of outer curves, and of holes where no station counts
const kLeastShare = 0.01;  // of a hole's area: smaller ones are not named

function cause_title(name) {
  return name === kNoCause ? "not known" : name.replace(/_/g, " ");
}

function cause_style(name) {
  return `--cause-${name.replace(/_/g, "-")}`;
}

function cause_swatch(name, shape) {
  return element("i", {class: shape, style: `--own:var(${cause_style(name)})`});
}

// The style of a loop's colour.
function loop_style(loops, index, by_cause) {
  if (by_cause) return cause_style(loops.cause[index]);
  return loops.is_hole[index] ? "--hole" : "--outer";
}

// Places among the causes; NaN without a cause.
function cause_ranks(loops) {
  const ranks = new Map(loops.causes.map((name, rank) => [name, rank]));
  return Float64Array.from(loops.cause, (name) => (ranks.has(name) ? ranks.get(name) : NaN));
}

// [name, count] of the causes of these holes (indices), or of the changes of these loops; without zeros, and kNoCause
// comes last.
function cause_counts(loops, indices) {
  const counts = new Map([...loops.causes.map((name) => [name, 0]), [kNoCause, 0]]);
  for (const i of indices) {
    if (loops.is_hole[i] || loops.has_changes) counts.set(loops.cause[i], (counts.get(loops.cause[i]) || 0) + 1);
  }
  return Array.from(counts).filter(([, count]) => count > 0);
}

// Shows what only scans with stations have, or comparisons, and fills the list of the filter.
function connect_causes(loops) {
  document.body.classList.toggle("has-causes", loops.has_causes);
  document.body.classList.toggle("has-changes", loops.has_changes);
  for (const id of ["cause-select", "loop-colours"]) find(id).hidden = !loops.has_causes;
  const counts = new Map(cause_counts(loops, loops.cause.keys()));
  const option = (value, text) => element("option", {value}, text);
  const word = loops.cause_word.toLowerCase();
  find("loop-colouring").querySelector("[value=cause]").textContent = word;
  find("cause-select").querySelector(".unseen").textContent = loops.cause_word;
  find("cause-filter").append(option("any", `Any ${word}`),
      ...loops.causes.map((name) => option(name, `${name[0].toUpperCase()}${cause_title(name).slice(1)} (${format_count(counts.get(name) || 0)})`)),
      ...(loops.has_changes ? [] : [option(kNoCause, "No cause")]));
}

// Rows of a loop's measures: its cause with the shares of its area, and what hides it; or its change.
function cause_rows({loops, stations}, index, decimals) {
  if (loops.has_changes) {
    return [["Change", element("span", {}, cause_swatch(loops.cause[index], "dot"), cause_title(loops.cause[index]))],
            ["Before", loops.earlier[index] || "none"]];
  }
  if (!loops.has_causes || !loops.is_hole[index]) return [];
  const shares = kCauses.map((name) => ({title: cause_title(name), share: loops.shares[name][index]}))
      .filter(({share}) => share > kLeastShare).sort((a, b) => b.share - a.share);
  if (loops.cause[index] === kNoCause || shares.length === 0) return [["Cause", cause_title(loops.cause[index])]];
  const words = shares.map(({title, share}) => `${title} ${Math.round(100 * share)} %`).join(", ");
  const rows = [["Cause", element("span", {}, cause_swatch(loops.cause[index], "dot"), words), "wide"]];
  const station = stations[loops.hidden_from[index]];
  if (station && loops.shares.hidden[index] > kLeastShare) {
    const place = vector_of(loops.hidden_by, index).map((value) => format_place(value, decimals)).join("  ");
    rows.push(["Hidden by", `what stands at ${place}, from station ${station.name}`, "wide"]);
  }
  return rows;
}

// Lines of the legend where loops have the colours of causes.
function cause_legend(loops) {
  const lines = cause_counts(loops, loops.cause.keys()).map(
      ([name]) => element("span", {}, cause_swatch(name, "swatch cause"), cause_title(name)));
  if (!loops.has_changes && loops.is_hole.some((is_hole) => !is_hole)) lines.push(element("span", {}, cause_swatch(kNoCause, "swatch outer"), "outer curve"));
  return lines;
}

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
    const fly = element("button", {type: "button", title: "Fly to the loop"}, "Fly");
    fly.addEventListener("click", () => this.actions.fly(index));
    const close = element("button", {type: "button"}, "Deselect");
    close.addEventListener("click", () => this.actions.close());
    find("details-heading").replaceChildren(element("i", {class: `swatch ${name}`}), loop_name(loops, index));
    body.replaceChildren(
        mark_fields(this.marks, index),
        this.measures(index),
        element("div", {class: "buttons"}, copy, fly, close));
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
      ...cause_rows(this.data, index, this.decimals),
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

function loop_name(loops, index) {
  return `${loops.is_hole[index] ? "Hole" : "Outer curve"} ${loops.id[index]}`;
}
