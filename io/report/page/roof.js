// SPDX-License-Identifier: Apache-2.0
// Whether a scan has a roof, such as a ceiling, that hides all else from above.

const kRoofCells = 24;       // along each side
const kLeastRoofed = 0.6;    // share of the cells with something below their highest point
const kRoofThickness = 0.12; // share of the heights

// The height below which the view sees into the scan, in scene coordinates; Infinity where nothing hides it.
function roof_height({positions, count}, {low, high}, up) {
  const [a, b] = [0, 1, 2].filter((axis) => axis !== up);
  const tall = high[up] - low[up];
  const cell_of = (i) => {
    const part = (axis) => Math.floor((kRoofCells * (positions[3 * i + axis] - low[axis])) / Math.max(1e-9, high[axis] - low[axis]));
    const [column, row] = [part(a), part(b)];
    return column >= 0 && column < kRoofCells && row >= 0 && row < kRoofCells ? row * kRoofCells + column : -1;
  };
  const highest = new Float32Array(kRoofCells * kRoofCells).fill(-Infinity), below = new Uint8Array(kRoofCells * kRoofCells);
  for (let i = 0; i < count; ++i) {
    const cell = cell_of(i), height = positions[3 * i + up];
    if (cell >= 0 && height <= high[up]) highest[cell] = Math.max(highest[cell], height);
  }
  const is_roof = (height) => height > high[up] - 2 * kRoofThickness * tall;
  for (let i = 0; i < count; ++i) {
    const cell = cell_of(i);
    if (cell >= 0 && is_roof(highest[cell]) && positions[3 * i + up] < highest[cell] - 0.4 * tall) below[cell] = 1;
  }
  const occupied = highest.filter((height) => height > -Infinity).length;
  const roofed = below.reduce((sum, value) => sum + value, 0);
  if (occupied === 0 || roofed < kLeastRoofed * occupied) return Infinity;
  const tops = Array.from(highest).filter((height, cell) => below[cell] === 1).sort((x, y) => x - y);
  return tops[Math.floor(0.05 * tops.length)] - kRoofThickness * tall;
}
