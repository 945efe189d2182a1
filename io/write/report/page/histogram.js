// SPDX-License-Identifier: Apache-2.0
// Small histograms: bars with numbers on the axes; what passes the filters has the colour, the rest is grey.

const kChart = {width: 340, height: 112, left: 44, right: 8, top: 10, bottom: 22};

// bars: [{whole, part, colour or nothing}]; ticks: [{at (0 to 1), text}].
function draw_histogram(title, unit, bars, ticks, has_filter) {
  const {width, height, left, right, top, bottom} = kChart;
  const inner = width - left - right, base = height - bottom, tall = base - top;
  const most = bars.reduce((best, bar) => Math.max(best, bar.whole), 0);
  const picture = drawing("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", class: "histogram",
                                  "aria-label": histogram_words(title, unit, bars, ticks)});
  for (const part of most > 0 ? [0.5, 1] : []) {
    const y = base - tall * part;
    const count = most * part;
    picture.append(drawing("line", {x1: left, x2: width - right, y1: y, y2: y, class: "grid"}));
    if (part === 1 || Number.isInteger(count)) {
      picture.append(drawing("text", {x: left - 6, y: y + 3.5, class: "axis end"}, short_count(count)));
    }
  }
  const step = inner / Math.max(1, bars.length);
  bars.forEach((bar, i) => {
    const x = left + i * step + 0.75, wide = Math.max(0.5, step - 1.5);
    const rect = (count, style, colour) => {
      if (!(count > 0)) return;
      const high = Math.max(1, (tall * count) / most);
      picture.append(drawing("rect", {x, y: base - high, width: wide, height: high, class: style,
                                      style: colour ? `fill:${colour}` : null},
                             drawing("title", {}, `${bar.name}: ${format_count(bar.whole)}` +
                                     (has_filter ? `, shown ${format_count(bar.part)}` : ""))));
    };
    if (has_filter) rect(bar.whole, "rest");
    rect(has_filter ? bar.part : bar.whole, "bar", bar.colour);
  });
  picture.append(drawing("line", {x1: left, x2: width - right, y1: base + 0.5, y2: base + 0.5, class: "base"}));
  for (const {at, text} of ticks) {
    const x = left + at * inner;
    picture.append(drawing("line", {x1: x, x2: x, y1: base, y2: base + 4, class: "base"}));
    const side = at > 0.97 ? "end" : at < 0.03 ? "start" : "middle";
    picture.append(drawing("text", {x, y: height - 5, class: `axis ${side}`}, text));
  }
  return element("figure", {class: "chart"},
                 element("figcaption", {}, title, unit ? element("span", {class: "unit"}, unit) : null), picture);
}

function histogram_words(title, unit, bars, ticks) {
  const total = bars.reduce((sum, bar) => sum + bar.whole, 0);
  const range = ticks.length > 1 ? `, from ${ticks[0].text} to ${ticks[ticks.length - 1].text} ${unit}` : "";
  return `Histogram: ${title}${range}; ${format_count(total)} in all.`;
}

function short_count(value) {
  if (value >= 1e9) return `${format_number(value / 1e9, 2)} G`;
  if (value >= 1e6) return `${format_number(value / 1e6, 2)} M`;
  if (value >= 1e4) return `${format_number(value / 1e3, 2)} k`;
  return format_count(value);
}

// Bars of a logarithmic scale over all positive values; ticks at powers of ten (and 2, 5 if few).
function size_bars(values, passes, scale) {
  let least = Infinity, most = 0;
  for (const value of values) if (value > 0) { least = Math.min(least, value); most = Math.max(most, value); }
  if (!(most > 0)) return {bars: [], ticks: []};
  let low = Math.log10(least * scale.factor), high = Math.log10(most * scale.factor);
  if (high - low < 0.3) { const middle = (low + high) / 2; low = middle - 0.15; high = middle + 0.15; }
  const margin = 0.02 * (high - low);
  low -= margin;
  high += margin;
  const count = 28;
  const name = (i) => [i, i + 1].map((k) => format_number(Math.pow(10, low + ((high - low) * k) / count))).join(" to ") +
                      (scale.name ? " " + scale.name : "");
  const bars = Array.from({length: count}, (_, i) => ({whole: 0, part: 0, name: name(i)}));
  values.forEach((value, i) => {
    if (!(value > 0)) return;
    const place = ((Math.log10(value * scale.factor) - low) / (high - low)) * count;
    const bar = bars[Math.min(count - 1, Math.max(0, Math.floor(place)))];
    ++bar.whole;
    if (passes(i)) ++bar.part;
  });
  const ticks = [];
  for (let power = Math.floor(low); power <= Math.ceil(high); ++power) {
    for (const step of high - low < 1.2 ? [1, 2, 3, 5] : high - low < 2.6 ? [1, 3] : [1]) {
      const at = (Math.log10(step) + power - low) / (high - low);
      if (at >= 0 && at <= 1) ticks.push({at, text: String(Number((step * Math.pow(10, power)).toPrecision(3)))});
    }
  }
  return {bars, ticks: ticks.filter((_, i) => ticks.length < 8 || i % Math.ceil(ticks.length / 7) === 0)};
}

const kFractionTicks = [0, 0.25, 0.5, 0.75, 1].map((at) => ({at, text: String(at)}));

function fraction_bars(values, passes) {
  const bars = Array.from({length: 20}, (_, i) => ({whole: 0, part: 0, name: `${(i / 20).toFixed(2)} to ${((i + 1) / 20).toFixed(2)}`}));
  values.forEach((value, i) => {
    if (Number.isNaN(value)) return;
    const bar = bars[Math.min(19, Math.max(0, Math.floor(value * 20)))];
    ++bar.whole;
    if (passes(i)) ++bar.part;
  });
  return bars;
}

function draw_charts(data, units, filter, theme) {
  const {loops, report} = data;
  const passes = (i) => filter.passes(i);
  const charts = [];
  if (loops.count > 0) {
    const {bars, ticks} = size_bars(loops.diameter, passes, filter.scale);
    if (bars.length > 0) charts.push(draw_histogram("Loops by diameter", filter.scale.name, bars, ticks, true));
    charts.push(draw_histogram("Loops by confidence", "", fraction_bars(loops.confidence, passes), kFractionTicks, true));
  }
  if (report.probability && report.probability.some((count) => count > 0)) {
    const ramp = ramp_bytes(theme, "probability");
    const count = report.probability.length;
    const bars = report.probability.map((whole, i) => ({
      whole, colour: ramp_colour(ramp, (i + 0.5) / count),
      name: `${(i / count).toFixed(2)} to ${((i + 1) / count).toFixed(2)}`,
    }));
    charts.push(draw_histogram("Points by boundary probability", "", bars, kFractionTicks, false));
  }
  if (charts.length === 0) charts.push(element("p", {class: "quiet"}, "Nothing to count: no loops and no points."));
  find("charts-body").replaceChildren(...charts);
}
