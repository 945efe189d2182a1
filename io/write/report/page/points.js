// SPDX-License-Identifier: Apache-2.0
// The points of the sample: round, sized in the scan's units, lit from both sides, coloured in one of four ways.

const kColourings = ["probability", "height", "colour", "plain"];

// Mean distance of a sample point to its dozen of neighbours, in scene units: 1.7 times the edge of the square that each
// stands for.
function sample_spacing({report, frame, points}) {
  const spacing = (1.7 * ((report.sample || {}).spacing || 0)) / frame.edge;
  return spacing > 0 ? spacing : 1 / Math.sqrt(Math.max(16, points.count));
}

// Whether the scan has colours, not intensities alone.
function are_colourful({count, colours}) {
  const step = Math.max(1, Math.floor(count / 1000));
  let grey = 0, all = 0;
  for (let i = 0; i < count; i += step, ++all) {
    const [red, green, blue] = colours.subarray(4 * i, 4 * i + 3);
    if (Math.max(red, green, blue) - Math.min(red, green, blue) < 8) ++grey;
  }
  return grey < 0.9 * all;
}

class PointCloud {
  // `data` of read_data(); `spacing` of sample_spacing().
  constructor(data, spacing, camera_uniforms) {
    const {count, positions, attributes, colours} = data.points;
    this.count = count;
    this.spacing = spacing;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("traits", new THREE.BufferAttribute(attributes, 4, true));
    if (colours) geometry.setAttribute("scanned", new THREE.BufferAttribute(colours, 4, true));
    this.ramp = new THREE.DataTexture(new Uint8Array(256 * 4), 256, 1, THREE.RGBAFormat);
    this.ramp.minFilter = this.ramp.magFilter = THREE.LinearFilter;
    this.uniforms = {
      ...camera_uniforms,
      ramp: {value: this.ramp},
      colouring: {value: 0},
      low: {value: -0.5},
      high: {value: 0.5},
      size: {value: spacing},
      is_lit: {value: data.has_normals ? 1 : 0},
    };
    this.material = new THREE.ShaderMaterial({
      uniforms: this.uniforms,
      defines: colours ? {HAS_COLOURS: 1} : {},
      vertexShader: `
        ${kCameraShader}
        ${kSectionShader}
        uniform float size, focal, pixel_ratio, colouring, low, high, is_lit;
        uniform sampler2D ramp;
        attribute vec4 traits;
        #ifdef HAS_COLOURS
        attribute vec4 scanned;
        #endif
        varying vec3 colour;
        varying float diameter;
        vec3 normal_of(vec2 code) {
          vec3 n = vec3(code, 1.0 - abs(code.x) - abs(code.y));
          if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
          return normalize(n);
        }
        void main() {
          float height = height_of(position);
          if (height < section.x || height > section.y) {
            gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
            return;
          }
          vec3 place = to_view(position);
          gl_Position = projectionMatrix * vec4(place, 1.0);
          diameter = clamp(size * focal / max(-place.z, 1e-9), 1.6 * pixel_ratio, 48.0 * pixel_ratio);
          gl_PointSize = diameter;
          float value = colouring < 0.5 ? traits.x : (height - low) / max(high - low, 1e-9);
          colour = texture2D(ramp, vec2((clamp(value, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
          float darkest = 0.55;
          #ifdef HAS_COLOURS
          if (colouring > 1.5 && colouring < 2.5) { colour = scanned.rgb; darkest = 0.8; }
          #endif
          if (is_lit > 0.5) {
            vec3 n = turn * normal_of((traits.yz * 255.0 - 128.0) / 127.0);
            if (dot(n, place) > 0.0) n = -n;
            float light = 0.5 + 0.5 * dot(n, normalize(vec3(-0.45, 0.6, 0.75)));
            colour *= mix(darkest, 1.06, light * light);
          }
        }`,
      fragmentShader: `
        varying vec3 colour;
        varying float diameter;
        void main() {
          vec2 from_middle = gl_PointCoord - 0.5;
          if (diameter > 2.5 && dot(from_middle, from_middle) > 0.25) discard;
          gl_FragColor = vec4(min(colour, 1.0), 1.0);
        }`,
    });
    this.object = new THREE.Points(geometry, this.material);
    this.object.frustumCulled = false;
  }

  set_colouring(name, theme) {
    this.uniforms.colouring.value = kColourings.indexOf(name);
    this.ramp.image.data.set(ramp_bytes(theme, name === "colour" ? "plain" : name));
    this.ramp.needsUpdate = true;
  }

  set_heights(low, high) {
    this.uniforms.low.value = low;
    this.uniforms.high.value = high;
  }

  // Draws `count` points, larger if not all of them.
  set_drawn(count) {
    this.object.geometry.setDrawRange(0, count);
    const missing = Math.sqrt(this.count / Math.max(1, count));
    this.uniforms.size.value = 1.35 * this.spacing * Math.min(3, missing);
  }
}
