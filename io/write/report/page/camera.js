// SPDX-License-Identifier: Apache-2.0
// Where the camera is: a pose looks at a target from a direction, with an axis that is up. Flights go from pose to pose.

const kFieldOfView = 38;  // degrees, vertical
const kLeastPolar = 1e-4;

// {target: [x, y, z], distance, polar (from up), azimuth, up}
function pose_of(camera, target, up) {
  const offset = camera.position.clone().sub(target);
  const distance = Math.max(offset.length(), 1e-12);
  const [first, second, height] = level_parts(offset.toArray(), up);
  return {
    target: target.toArray(),
    distance,
    polar: Math.acos(Math.min(1, Math.max(-1, height / distance))),
    azimuth: Math.atan2(second, first),
    up,
  };
}

function pose_direction(pose) {
  const across = Math.sin(pose.polar);
  return upright(across * Math.cos(pose.azimuth), across * Math.sin(pose.azimuth), Math.cos(pose.polar), pose.up);
}

// The pose that has all of `places` (numbers x, y, z, x, ...) in the middle of the picture, from the direction of `from`.
function pose_of_places(places, from, aspect) {
  const back = pose_direction(from);
  const right = upright(-Math.sin(from.azimuth), Math.cos(from.azimuth), 0, from.up);
  const up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
              back[0] * right[1] - back[1] * right[0]];
  const axes = [right, up, back];
  const turned = new Float64Array(places.length);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < places.length; ++i) {
    const k = i % 3, at = i - k;
    turned[i] = places[at] * axes[k][0] + places[at + 1] * axes[k][1] + places[at + 2] * axes[k][2];
    low[k] = Math.min(low[k], turned[i]);
    high[k] = Math.max(high[k], turned[i]);
  }
  const middle = low.map((value, k) => (value + high[k]) / 2);
  const tall = Math.tan((kFieldOfView * Math.PI) / 360);
  const slopes = [tall * aspect, tall];
  let distance = 0;
  // Near parts look larger: the middle of the picture is found step by step.
  for (let step = 0; step < 4; ++step) {
    distance = 1e-6;
    for (let i = 0; i < turned.length; i += 3) {
      const toward = turned[i + 2] - middle[2];
      for (let k = 0; k < 2; ++k) distance = Math.max(distance, toward + Math.abs(turned[i + k] - middle[k]) / slopes[k]);
    }
    for (let k = 0; k < 2; ++k) {
      let least = Infinity, most = -Infinity;
      for (let i = 0; i < turned.length; i += 3) {
        const seen = (turned[i + k] - middle[k]) / Math.max(1e-9, distance - (turned[i + 2] - middle[2]));
        least = Math.min(least, seen);
        most = Math.max(most, seen);
      }
      if (step < 3) middle[k] += ((least + most) / 2) * distance * 0.9;
    }
  }
  const target = [0, 1, 2].map((axis) => axes.reduce((sum, unit, k) => sum + unit[axis] * middle[k], 0));
  return {target, distance, polar: from.polar, azimuth: from.azimuth, up: from.up};
}

// Looks along a normal from the side where the camera is. Straight from above the picture keeps its turn.
function pose_along(normal, target, distance, now) {
  const length = Math.hypot(...normal);
  if (!(length > 0)) return {target, distance, polar: now.polar, azimuth: now.azimuth, up: now.up};
  const eye = pose_direction(now).map((value, axis) => now.target[axis] + value * now.distance - target[axis]);
  const side = eye[0] * normal[0] + eye[1] * normal[1] + eye[2] * normal[2] < 0 ? -1 : 1;
  const [first, second, height] = level_parts(normal.map((value) => (side * value) / length), now.up);
  const is_upright = Math.hypot(first, second) < 0.02;
  return {
    target,
    distance,
    polar: Math.min(Math.PI - kLeastPolar, Math.max(kLeastPolar, Math.acos(Math.min(1, Math.max(-1, height))))),
    azimuth: is_upright ? now.azimuth : Math.atan2(second, first),
    up: now.up,
  };
}

function poses_between(a, b, part) {
  const eased = part * part * (3 - 2 * part);
  const turn = Math.atan2(Math.sin(b.azimuth - a.azimuth), Math.cos(b.azimuth - a.azimuth));
  const mix = (from, to) => from + (to - from) * eased;
  const distance = Math.exp(mix(Math.log(a.distance), Math.log(b.distance)));
  // The target moves as the distance does: while far, the picture moves as much as while near.
  const moved = Math.abs(b.distance - a.distance) < 1e-3 * a.distance
      ? eased : (distance - a.distance) / (b.distance - a.distance);
  return {
    target: a.target.map((value, axis) => value + (b.target[axis] - value) * moved),
    distance,
    polar: mix(a.polar, b.polar),
    azimuth: a.azimuth + turn * eased,
    up: b.up,
  };
}
