// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them: significant digits, thousands separators, units. A missing number is a dash.

const kMissing = "–";

function is_number(value) {
  return typeof value === "number" && Number.isFinite(value);
}

function format_count(value) {
  return is_number(value) ? value.toLocaleString("en-US", {maximumFractionDigits: 0}) : kMissing;
}

function plural(count, one, many) {
  return `${format_count(count)} ${count === 1 ? one : many}`;
}

// `digits` significant digits, whole digits never rounded off; very large and small ones with a power of ten.
function format_number(value, digits = 3) {
  if (!is_number(value)) return kMissing;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e9 || size < 1e-4) {
    const [mantissa, power] = value.toExponential(digits - 1).split("e");
    const raised = String(Number(power)).replace(/[-0-9]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
    return `${mantissa}×10${raised}`;
  }
  const whole = Math.floor(Math.log10(size)) + 1;
  const shown = Math.max(digits, whole);
  return value.toLocaleString("en-US", {minimumSignificantDigits: shown, maximumSignificantDigits: shown});
}

// The number in a text field, with a comma or a point before the decimals. NaN for an empty field, and for any other
// text, which marks the field as invalid.
function typed_number(field) {
  const text = field.value.trim().replace(",", ".").replace("−", "-");
  const value = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(text) ? Number(text) : NaN;
  const is_invalid = text !== "" && !Number.isFinite(value);
  field.setAttribute("aria-invalid", String(is_invalid));
  field.title = is_invalid ? "Not a number: digits, and a point or a comma before the decimals" : "";
  return value;
}

function format_fraction(value) {
  return is_number(value) ? value.toFixed(3) : kMissing;
}

// Units of the scan's lengths. Only metres change to a smaller unit; other units stay as they are.
class Units {
  constructor(unit) {
    this.unit = unit || "";
    this.name = {"us-ft": "ft (US)"}[this.unit] || this.unit;
  }

  // {factor, name} that suits lengths (power 1) or areas (power 2) up to `largest`.
  scale(largest, power) {
    const sign = power === 2 ? "²" : "";
    const is_small = this.unit === "m" && is_number(largest) && largest > 0 && largest < (power === 2 ? 1e-3 : 0.1);
    if (is_small) return {factor: power === 2 ? 1e6 : 1e3, name: "mm" + sign};
    return {factor: 1, name: this.name ? this.name + sign : ""};
  }

  format(value, power, digits = 3) {
    if (!is_number(value)) return kMissing;
    const {factor, name} = this.scale(Math.abs(value), power);
    return format_number(value * factor, digits) + (name ? " " + name : "");
  }

  length(value, digits) { return this.format(value, 1, digits); }
  area(value, digits) { return this.format(value, 2, digits); }
}

// Decimals that place a point to about a tenth of the point spacing.
function place_decimals(spacing) {
  if (!is_number(spacing) || spacing <= 0) return 3;
  return Math.min(9, Math.max(0, Math.ceil(1 - Math.log10(spacing))));
}

function format_place(value, decimals) {
  if (!is_number(value)) return kMissing;
  const rounded = value.toFixed(decimals);
  return Number(rounded) === 0 ? rounded.replace("-", "") : rounded.replace("-", "−");
}

// 1, 2 or 5 times a power of ten, at most `limit`.
function round_step(limit) {
  const power = Math.pow(10, Math.floor(Math.log10(limit)));
  return [5, 2, 1].find((step) => step * power <= limit * 1.0000001) * power;
}
