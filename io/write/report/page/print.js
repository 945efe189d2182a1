// SPDX-License-Identifier: Apache-2.0
// The report on paper: a summary, then a page for each hole that the filters show, the largest first.
//
// The pages are made when printing begins, and go when it ends. Pictures are JPEG: a PDF takes them as they are.

const kMostPages = 100;            // of holes: filters choose others
const kSummaryRows = 12;
const kPrintWidth = 1200, kPrintHeight = 690;  // pixels of a picture

class PrintPages {
  // `page`: the parts of the page and its state.
  constructor(page) {
    this.page = page;
    this.place = find("print");
    window.addEventListener("beforeprint", () => { if (!this.is_filled) this.fill(); });
    window.addEventListener("afterprint", () => this.clear());
    find("print-open").addEventListener("click", () => this.open());
    find("print-form").addEventListener("submit", (event) => {
      event.preventDefault();
      find("print-dialog").close();
      this.print();
    });
    find("print-cancel").addEventListener("click", () => find("print-dialog").close());
  }

  open() {
    const count = this.loops().length;
    find("print-count").textContent = `${plural(count, "hole", "holes")} ${count === 1 ? "passes" : "pass"} the filters. Each has a page of its own, the largest first${count > kMostPages ? `, up to ${kMostPages}` : ""}.`;
    find("print-dialog").showModal();
  }

  // With the pages ready before: other browsers than Chromium do not wait for their pictures.
  async print() {
    this.fill();
    await Promise.all(Array.from(this.place.querySelectorAll("img"), (image) => image.decode().catch(() => null)));
    window.print();
  }

  clear() {
    this.place.replaceChildren();
    this.is_filled = false;
  }

  // Indices of what has pages, the largest first.
  loops() {
    const {loops} = this.page.data;
    const size = (i) => (loops.area[i] >= 0 ? loops.area[i] : -1);
    return this.page.table.shown.filter((i) => loops.is_hole[i]).sort((a, b) => size(b) - size(a) || a - b);
  }

  fill() {
    const all = this.loops();
    const shown = all.slice(0, kMostPages);
    const root = document.documentElement, {theme} = this.page;
    root.dataset.theme = "light";  // of the pictures, too
    root.classList.add("on-paper");
    this.page.update_colours("light");
    const pictures = this.pictures(shown);
    const plan = new Plan(this.page.data, this.page.section ? this.page.section.heights() : kAllHeights);
    root.classList.remove("on-paper");
    root.dataset.theme = theme;
    this.page.update_colours(theme);
    this.place.replaceChildren(this.summary(all, shown, pictures, plan),
                               ...shown.map((index, at) => this.loop_page(index, at, shown.length, pictures, plan)));
    this.is_filled = true;
  }

  // {summary, of: by index}: addresses of pictures; null where there is none.
  pictures(shown) {
    const {data, view, units} = this.page;
    const made = {summary: null, of: new Map()};
    if (!view) return made;
    const selected = view.scenes.selected;
    view.take_pictures(kPrintWidth, kPrintHeight, (picture) => {
      const {navigation} = view;
      view.scenes.set_selected(-1);
      made.summary = picture(navigation.fit_pose(kHomePolar, kHomeAzimuth), Infinity, units);
      view.set_section(...kAllHeights);
      for (const index of shown) {
        if (!loop_box(data.loops, index)) continue;
        view.scenes.set_selected(index);
        const pose = navigation.loop_pose(index, navigation.fit_pose(kHomePolar, kHomeAzimuth));
        made.of.set(index, picture(pose, navigation.loop_cut(index, pose), units));
      }
    });
    view.scenes.set_selected(selected);
    view.set_section(...this.page.section.heights());
    return made;
  }

  // ---- Pages

  head(title, right) {
    return element("header", {class: "print-head"}, element("h2", {}, title), element("span", {}, right));
  }

  summary(all, shown, pictures, plan) {
    const {data, units, filter, marks, view} = this.page;
    const {report, loops} = data;
    const counts = report.counts || {};
    const pages = shown.length === all.length
        ? `The pages that follow show ${all.length === 0 ? "none" : "all"} of them.`
        : `The pages that follow show the ${format_count(shown.length)} largest of them.`;
    const words = filter.words(units);
    const rows = [["Points", format_count(counts.points)], ["Holes", format_count(counts.holes)],
                  ["Outer curves", format_count(counts.outer)],
                  ["Area of holes", missing_area(report, units) || kMissing]];
    if (report.bounds) {
      const {min, max} = report.bounds;
      rows.push(["Extent", [0, 1, 2].map((k) => units.length(max[k] - min[k])).join(" × ")]);
    }
    if (loops.has_causes) {
      rows.push([`${loops.cause_word}s`, cause_counts(loops, all).map(([cause, count]) => `${cause_title(cause)} ${format_count(count)}`).join(", ") || kMissing]);
    }
    const origin = [["Unit", units.name || "not stated"], ["CRS", report.crs ? crs_name(report.crs) : "not stated"]];
    const marked = kMarks.map(({name, title}) => [element("span", {}, mark_sign(name), title),
                                                  format_count(all.filter((i) => marks.mark[i] === name).length)]);
    return element("section", {class: "print-page print-summary"},
        this.head(report.title || "Scan", `Lacuna report, ${new Date().toISOString().slice(0, 10)}`),
        find("print-words").value ? element("p", {class: "print-words"}, find("print-words").value) : "",
        pictures.summary ? element("img", {src: pictures.summary, class: "print-picture", alt: ""}) : plan.figure(-1),
        view && view.scenes.by_cause ? element("p", {class: "legend-lines"}, ...cause_legend(loops)) : "",
        element("p", {class: "print-words"},
                `${plural(all.length, "hole", "holes")} ${all.length === 1 ? "passes" : "pass"} the filters` +
                `${words ? ` (${words})` : ""}. ${pages}`),
        element("div", {class: "print-columns"}, description(rows), description([...marked, ...origin])),
        shown.length > 0 ? this.summary_table(shown) : "");
  }

  summary_table(shown) {
    const {data: {loops}, units, table, marks} = this.page;
    const columns = [
      ["Id", (i) => String(loops.id[i])], ["Area", (i) => units.area(loops.area[i])],
      ["Diameter", (i) => units.length(loops.diameter[i])], ["Confidence", (i) => format_fraction(loops.confidence[i])],
      ...(loops.has_causes ? [[loops.cause_word, (i) => (loops.cause[i] === kNoCause ? "" : cause_title(loops.cause[i])), "word"]] : []),
      ["Mark", (i) => (marks.mark[i] === kNoMark ? "" : mark_title(marks.mark[i])), "word"],
      [`Place x, y, z${units.name ? `, ${units.name}` : ""}`, (i) => table.place(i).join("  ")],
    ];
    return place_table(shown.slice(0, kSummaryRows), columns, "print-table", shown.length > kSummaryRows ? `The ${kSummaryRows} largest` : "By size");
  }

  loop_page(index, at, count, pictures, plan) {
    const {data, marks, details} = this.page;
    const {loops} = data;
    const picture = pictures.of.get(index);
    const name = marks.mark[index];
    return element("section", {class: "print-page"},
        this.head(loop_name(loops, index), `${at + 1} of ${format_count(count)} · ${data.report.title || "Scan"}`),
        picture ? element("img", {src: picture, class: "print-picture", alt: ""})
                : element("p", {class: "print-words"}, this.page.view ? "Not drawn: it passes through points far from all others."
                                                                      : "Not drawn: this browser gives no WebGL."),
        element("div", {class: "print-columns"}, plan.figure(index), details.measures(index)),
        element("div", {class: "print-note"},
                element("p", {}, element("span", {class: "quiet"}, "Mark "),
                        name === kNoMark ? "none" : element("span", {}, mark_sign(name), mark_title(name))),
                element("p", {class: "print-note-text"}, element("span", {class: "quiet"}, "Note "), marks.note[index])));
  }
}

// The scan from above with the place of one loop: drawn without WebGL, for paper.

const kPlanWidth = 900, kPlanHeight = 780;  // pixels at most

// One drawing of all points and loops, shared by the pages; the place of a loop lies over it.
class Plan {
  // `heights`: lowest and highest that is shown, in scene coordinates.
  constructor(data, heights) {
    this.data = data;
    const {low, high} = scene_bounds(data).box;
    const {up} = data.frame;
    this.axes = [(up + 1) % 3, (up + 2) % 3];  // to the right, and to the top of the plan
    const [a, b] = this.axes;
    const margin = 0.03 * Math.max(high[a] - low[a], high[b] - low[b], 1e-6);
    this.corner = [low[a] - margin, high[b] + margin];
    const wide = high[a] - low[a] + 2 * margin, tall = high[b] - low[b] + 2 * margin;
    this.factor = Math.min(kPlanWidth / wide, kPlanHeight / tall);
    this.size = [Math.ceil(wide * this.factor), Math.ceil(tall * this.factor)];
    this.source = this.draw(heights);
  }

  // Pixels of a scene position.
  at(values, i) {
    const [a, b] = this.axes;
    return [(values[3 * i + a] - this.corner[0]) * this.factor, (this.corner[1] - values[3 * i + b]) * this.factor];
  }

  draw([lowest, highest]) {
    const {points, loops, frame} = this.data;
    const [width, height] = this.size;
    const [canvas, pen] = paper(width, height);
    pen.fillStyle = "#c9cfd1";
    for (let i = 0; i < points.count; ++i) {
      const at_height = points.positions[3 * i + frame.up];
      if (at_height < lowest || at_height > highest) continue;
      const [x, y] = this.at(points.positions, i);
      pen.fillRect(x - 0.75, y - 0.75, 1.5, 1.5);
    }
    for (let loop = 0; loop < loops.count; ++loop) {
      pen.strokeStyle = style_value(loops.is_hole[loop] ? "--hole" : "--outer");
      pen.lineWidth = loops.is_hole[loop] ? 2 : 1.2;
      trace_loop(pen, loops, loop, (i) => this.at(loops.vertices, i));
      pen.stroke();
    }
    return canvas.toDataURL("image/png");
  }

  // The drawing, with a ring and lines to the edges at the loop; -1: without.
  figure(index) {
    const [width, height] = this.size;
    const over = drawing("svg", {viewBox: `0 0 ${width} ${height}`, class: "plan-over", "aria-hidden": "true"});
    const box = index < 0 ? null : loop_box(this.data.loops, index);
    if (box) {
      const [x, y] = this.at(box.middle, 0);
      const radius = Math.max(16, 0.62 * Math.hypot(...this.axes.map((axis) => box.high[axis] - box.low[axis])) * this.factor);
      const line = (x1, y1, x2, y2) => drawing("line", {x1, y1, x2, y2});
      over.append(drawing("circle", {cx: x, cy: y, r: radius}), line(0, y, x - radius, y), line(x + radius, y, width, y),
                  line(x, 0, x, y - radius), line(x, y + radius, x, height));
    }
    return element("figure", {class: "plan"},
                   element("div", {class: "plan-box", style: `aspect-ratio:${width}/${height};width:min(100%, ${(84 * width / height).toFixed(2)}mm)`},
                           element("img", {src: this.source, alt: ""}), over),
                   element("figcaption", {class: "quiet"}, `From above, ${"xyz"[this.axes[0]]} to the right, ${"xyz"[this.axes[1]]} to the top`));
  }
}

// A white canvas and its pen.
function paper(width, height) {
  const canvas = element("canvas", {width, height});
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, width, height);
  return [canvas, pen];
}

// The closed path of a loop; `at(i)`: pixels of its vertex.
function trace_loop(pen, {first}, loop, at) {
  pen.beginPath();
  for (let i = first[loop]; i < first[loop + 1]; ++i) pen.lineTo(...at(i));
  pen.closePath();
}

// A bar of a round length, in the lower right corner; `pixel`: its size in the scan's unit.
function draw_bar(pen, width, height, pixel, units) {
  const length = round_step(0.18 * width * pixel);
  if (!Number.isFinite(length) || !(length > 0)) return;
  const long = length / pixel, right = width - 30, base = height - 24, high = 12;
  pen.fillStyle = "#ffffffd9";
  pen.fillRect(right - long - 14, base - 44, long + 28, 58);
  pen.strokeStyle = pen.fillStyle = "#16191b";
  pen.lineWidth = 2.5;
  pen.beginPath();
  pen.moveTo(right - long, base - high);
  pen.lineTo(right - long, base);
  pen.lineTo(right, base);
  pen.lineTo(right, base - high);
  pen.stroke();
  pen.font = "22px sans-serif";
  pen.textAlign = "right";
  pen.fillText(units.length(length, 1), right, base - high - 6);
}
