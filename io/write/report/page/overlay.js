// SPDX-License-Identifier: Apache-2.0
// Scene positions in pixels of the view, for drawings that lie over it.

// [right, up, ahead] of the eye.
function seen_from(camera, place) {
  const {x, y, z} = new THREE.Vector3(...place).applyMatrix4(camera.matrixWorldInverse);
  return [x, y, -z];
}

// {width, height, focal}: the view in pixels of the page; `focal` is at distance 1.
function view_pixels({canvas, navigation}) {
  const {clientWidth: width, clientHeight: height} = canvas;
  return {width, height, focal: height / (2 * Math.tan((navigation.camera.fov * Math.PI) / 360))};
}

function to_pixel({width, height, focal}, [right, up, ahead]) {
  return [width / 2 + (focal * right) / ahead, height / 2 - (focal * up) / ahead];
}

// The pixel of a place; null behind the eye, or more than `margin` pixels outside of the view.
function pixel_of(view, place, margin) {
  const seen = seen_from(view.navigation.camera, place);
  if (!(seen[2] > 0)) return null;
  const pixels = view_pixels(view);
  const [x, y] = to_pixel(pixels, seen);
  return x > -margin && x < pixels.width + margin && y > -margin && y < pixels.height + margin ? [x, y] : null;
}

// The part of an edge that the view shows, as {x1, y1, x2, y2} in pixels; null without one.
function pixels_of_edge(view, from, to) {
  const pixels = view_pixels(view);
  const a = seen_from(view.navigation.camera, from), b = seen_from(view.navigation.camera, to);
  // Inside of five planes through the eye: linear in the part of the edge (Liang, Barsky 1984).
  const wide = pixels.width / 2 / pixels.focal, tall = pixels.height / 2 / pixels.focal;
  const planes = [([, , z]) => z - 1e-7, ([x, , z]) => wide * z - x, ([x, , z]) => wide * z + x,
                  ([, y, z]) => tall * z - y, ([, y, z]) => tall * z + y];
  let begin = 0, end = 1;
  for (const inside of planes) {
    const at_a = inside(a), at_b = inside(b);
    if (at_a < 0 && at_b < 0) return null;
    if (at_a < 0) begin = Math.max(begin, at_a / (at_a - at_b));
    if (at_b < 0) end = Math.min(end, at_a / (at_a - at_b));
  }
  if (!(begin < end)) return null;
  const at = (part) => to_pixel(pixels, a.map((value, k) => value + part * (b[k] - value)));
  const [x1, y1] = at(begin), [x2, y2] = at(end);
  return {x1, y1, x2, y2};
}
