// SPDX-License-Identifier: Apache-2.0
// Loops as thick lines. WebGL's own lines are one pixel wide, so each edge is a quad of the wanted width.
//
// The corners of all quads are made once. A filter only writes the indices of the quads that are drawn. Instances of
// one quad would need a quarter of the memory, but graphics in software takes seconds for 100,000 of them.

// Per corner: one end of the edge, and the other end. Then length along the loop, loop * 4 + end * 2 + side, edge of
// the loop, radius of the loop.
const kLineVertexShader = `
  ${kCameraShader}
  ${kSectionShader}
  uniform vec2 resolution;
  uniform float near, half_width, pixel_ratio, focal, crowded;
  attribute vec3 other;
  attribute vec4 more;
  varying vec2 place;       // pixels along and across the edge, from its start
  varying float edge_pixels, along, inverse_distance, loop_number, half_pixels;
  void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    loop_number = floor(more.y / 4.0 + 0.001);
    float code = more.y - 4.0 * loop_number;
    bool is_end = code > 1.5;
    float side = mod(code, 2.0) > 0.5 ? 1.0 : -1.0;
    vec3 mine = to_view(position), far_end = to_view(other);
    along = more.x;
    vec2 heights = vec2(height_of(position), height_of(other));
    if (max(heights.x, heights.y) < section.x || min(heights.x, heights.y) > section.y) return;
    vec2 shown = clamp(heights, section.x, section.y);
    if (shown != heights) {
      vec2 parts = (shown - heights.x) / (heights.y - heights.x);
      along += (is_end ? -1.0 : 1.0) * parts.x * distance(mine, far_end);
      vec3 edge = far_end - mine;
      far_end = mine + parts.y * edge;
      mine += parts.x * edge;
    }
    float limit = -near;
    if (mine.z > limit && far_end.z > limit) return;
    if (mine.z > limit) {
      float part = (limit - mine.z) / (far_end.z - mine.z);
      along += (is_end ? -1.0 : 1.0) * part * distance(mine, far_end);
      mine = mix(mine, far_end, part);
    } else if (far_end.z > limit) {
      far_end = mix(far_end, mine, (limit - far_end.z) / (mine.z - far_end.z));
    }
    vec3 a = is_end ? far_end : mine, b = is_end ? mine : far_end;
    vec2 scale = vec2(projectionMatrix[0][0], projectionMatrix[1][1]) * resolution * 0.5;
    vec2 start = a.xy / -a.z * scale, end = b.xy / -b.z * scale;
    edge_pixels = length(end - start);
    // Where edges are much shorter than a pixel, one in 2, 4, 8 is enough: the others lie under its round ends.
    float stride = exp2(floor(log2(max(1.0, 1.2 * pixel_ratio / max(edge_pixels, 1e-3)))));
    if (mod(more.z, stride) > 0.5) return;
    vec2 direction = edge_pixels > 1e-4 ? (end - start) / edge_pixels : vec2(1.0, 0.0);
    // Where there are very many, those that look small have thin lines.
    float looks_large = smoothstep(5.0, 40.0, more.w * focal / max(-mine.z, 1e-9) / pixel_ratio);
    half_pixels = half_width * pixel_ratio * mix(crowded, 1.0, looks_large);
    float reach = half_pixels + 1.0;
    place = vec2(is_end ? edge_pixels + reach : -reach, side * reach);
    vec2 pixel = start + direction * place.x + vec2(-direction.y, direction.x) * place.y;
    inverse_distance = -1.0 / mine.z;
    gl_Position = vec4(pixel / (resolution * 0.5), 0.0, 1.0);
  }`;

const kLineFragmentShader = `
  ${kDepthShader}
  uniform vec3 colour;
  uniform sampler2D loop_colours;  // of each loop, 256 in a row
  uniform float rows;              // of them; 0: all loops have one colour
  uniform float has_depth, hidden, opacity, pull, dash;
  varying vec2 place;
  varying float edge_pixels, along, inverse_distance, loop_number, half_pixels;
  void main() {
    float beyond = place.x - clamp(place.x, 0.0, edge_pixels);
    float cover = clamp(half_pixels + 0.5 - length(vec2(beyond, place.y)), 0.0, 1.0);
    if (cover <= 0.0) discard;
    if (dash > 0.0 && fract(along / dash) > 0.62) discard;
    float shown = 1.0;
    if (has_depth > 0.5 && hidden < 1.0) {
      float here = 1.0 / inverse_distance;
      if (here * 0.997 - pull > scene_distance(gl_FragCoord.xy)) shown = hidden;
    }
    if (shown <= 0.0) discard;
    float number = floor(loop_number + 0.5);
    #ifdef PICK
    gl_FragColor = vec4(mod(number, 256.0), mod(floor(number / 256.0), 256.0), floor(number / 65536.0), 255.0) / 255.0;
    #else
    vec2 place_of_colour = (vec2(mod(number, 256.0), floor(number / 256.0)) + 0.5) / vec2(256.0, max(rows, 1.0));
    vec3 own = rows > 0.5 ? texture2D(loop_colours, place_of_colour).rgb : colour;
    gl_FragColor = vec4(own, cover * shown * opacity);
    #endif
  }`;

// Corners of the quads of all loops, four per edge, in the order of the loops' vertices.
class LineCorners {
  constructor(loops) {
    const {count, first, vertices} = loops;
    const edges = vertices.length / 3;
    this.first = first;
    const here = new Float32Array(edges * 12), other = new Float32Array(edges * 12), more = new Float32Array(edges * 16);
    for (let loop = 0; loop < count; ++loop) {
      let length = 0;
      const {radius} = loop_box(loops, loop) || {};
      for (let i = first[loop]; i < first[loop + 1]; ++i) {
        const a = 3 * i, b = 3 * (i + 1 < first[loop + 1] ? i + 1 : first[loop]);
        const next = length + Math.hypot(vertices[b] - vertices[a], vertices[b + 1] - vertices[a + 1], vertices[b + 2] - vertices[a + 2]);
        for (let corner = 0; corner < 4; ++corner) {
          const from = corner < 2 ? a : b, to = corner < 2 ? b : a, at = 12 * i + 3 * corner;
          for (let k = 0; k < 3; ++k) { here[at + k] = vertices[from + k]; other[at + k] = vertices[to + k]; }
          more.set([corner < 2 ? length : next, 4 * loop + corner, i - first[loop], radius], 16 * i + 4 * corner);
        }
        length = next;
      }
    }
    // The arrays are freed once the graphics memory has them.
    const attribute = (array, size) => new THREE.BufferAttribute(array, size).onUpload(function () { this.array = null; });
    this.attributes = {position: attribute(here, 3), other: attribute(other, 3), more: attribute(more, 4)};
  }
}

// Some of the loops, drawn in one or more passes.
class LoopLines {
  // At most `edges` edges of `corners`.
  constructor(corners, edges, camera_uniforms) {
    this.corners = corners;
    this.camera_uniforms = camera_uniforms;
    this.geometry = new THREE.BufferGeometry();
    for (const [name, attribute] of Object.entries(corners.attributes)) this.geometry.setAttribute(name, attribute);
    this.indices = new THREE.BufferAttribute(new Uint32Array(Math.max(6, edges * 6)), 1);
    this.indices.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setIndex(this.indices);
    this.objects = [];
    this.count = 0;
  }

  // One pass of drawing: {width (pixels), colour, opacity, hidden (opacity behind the surface), dash}.
  add_pass(scene, style, is_pick = false) {
    const material = new THREE.ShaderMaterial({
      uniforms: {
        ...this.camera_uniforms,
        half_width: {value: style.width / 2},
        colour: {value: new THREE.Vector3(1, 1, 1)},
        loop_colours: {value: null},
        rows: {value: 0},
        opacity: {value: style.opacity === undefined ? 1 : style.opacity},
        hidden: {value: 0},
        pull: {value: 0},
        dash: {value: 0},
        crowded: {value: 1},
      },
      defines: is_pick ? {PICK: 1} : {},
      vertexShader: kLineVertexShader,
      fragmentShader: kLineFragmentShader,
      depthTest: false,
      depthWrite: false,
      side: THREE.DoubleSide,
      transparent: !is_pick,
      blending: is_pick ? THREE.NoBlending : THREE.NormalBlending,
    });
    const mesh = new THREE.Mesh(this.geometry, material);
    mesh.frustumCulled = false;
    mesh.visible = false;
    mesh.renderOrder = style.order || 0;
    scene.add(mesh);
    this.objects.push(mesh);
    return material.uniforms;
  }

  // Draws these loops (indices), no others.
  show(loops) {
    const {first} = this.corners;
    const out = this.indices.array;
    let at = 0;
    for (const loop of loops) {
      for (let i = first[loop]; i < first[loop + 1]; ++i) {
        const corner = 4 * i;
        out[at] = corner;
        out[at + 1] = out[at + 4] = corner + 1;
        out[at + 2] = out[at + 3] = corner + 2;
        out[at + 5] = corner + 3;
        at += 6;
      }
    }
    this.count = at / 6;
    this.indices.updateRange = {offset: 0, count: Math.max(6, at)};
    this.indices.needsUpdate = true;
    this.geometry.setDrawRange(0, at);
    this.set_visible(true);
  }

  // The first pass is the casing.
  set_casing(is_drawn) {
    this.objects[0].visible = is_drawn && this.is_visible;
  }

  set_visible(is_visible) {
    this.is_visible = is_visible && this.count > 0;
    for (const object of this.objects) object.visible = this.is_visible;
  }
}
