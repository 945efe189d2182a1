// SPDX-License-Identifier: Apache-2.0
// Which axis points up: z, unless the reader chooses another one. frame.up has its number: 0, 1 or 2 for x, y or z.
//
// The two level axes follow it in the order x, y, z, x, so that a view from above is never a mirror image.

// [x, y, z] of a vector that is given along the two level axes and up.
function upright(first, second, height, up) {
  const vector = [0, 0, 0];
  vector[(up + 1) % 3] = first;
  vector[(up + 2) % 3] = second;
  vector[up] = height;
  return vector;
}

// The parts of a vector along the level axes, then that along up.
function level_parts(vector, up) {
  return [vector[(up + 1) % 3], vector[(up + 2) % 3], vector[up]];
}

// Between heights in scene coordinates and real ones.
function real_height(frame, height) {
  return to_real(frame, upright(0, 0, height, frame.up))[frame.up];
}

function scene_height(frame, height) {
  return to_scene(frame, upright(0, 0, height, frame.up))[frame.up];
}
