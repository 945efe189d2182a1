// Loops as thick lines. WebGL's own lines are one pixel wide, so each edge is a quad of the width asked for.
//
// One buffer holds the vertices of all loops drawn, each loop closed by its first vertex once more. Instance i is the
// edge from vertex i to i + 1; where these belong to two loops it has no area. A filter writes the buffer again.

const kVertexNumbers = 5;  // x, y, z, length along the loop, loop

const kLineVertexShader = `
  ${kCameraShader}
  uniform vec2 resolution;
  uniform float near, half_width, pixel_ratio;
  attribute vec3 from, to;
  attribute vec2 from_more, to_more;
  varying vec2 place;       // pixels along and across the edge, from its start
  varying float edge_pixels, along, inverse_distance, loop_number;
  void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    loop_number = from_more.y;
    vec3 a = to_view(from), b = to_view(to);
    float limit = -near;
    if (from_more.y != to_more.y || (a.z > limit && b.z > limit)) return;
    float a_along = from_more.x, b_along = to_more.x;
    if (a.z > limit) {
      float part = (limit - a.z) / (b.z - a.z);
      a = mix(a, b, part);
      a_along = mix(a_along, b_along, part);
    } else if (b.z > limit) {
      float part = (limit - b.z) / (a.z - b.z);
      b = mix(b, a, part);
      b_along = mix(b_along, a_along, part);
    }
    vec2 scale = vec2(projectionMatrix[0][0], projectionMatrix[1][1]) * resolution * 0.5;
    vec2 start = a.xy / -a.z * scale, end = b.xy / -b.z * scale;
    edge_pixels = length(end - start);
    vec2 direction = edge_pixels > 1e-4 ? (end - start) / edge_pixels : vec2(1.0, 0.0);
    vec2 across = vec2(-direction.y, direction.x);
    float reach = half_width * pixel_ratio + 1.0;
    place = vec2(position.x * edge_pixels + (position.x * 2.0 - 1.0) * reach, position.y * reach);
    vec2 pixel = start + direction * place.x + across * place.y;
    float part = clamp(place.x / max(edge_pixels, 1e-4), 0.0, 1.0);
    along = mix(a_along, b_along, part);
    inverse_distance = mix(-1.0 / a.z, -1.0 / b.z, part);
    gl_Position = vec4(pixel / (resolution * 0.5), 0.0, 1.0);
  }`;

const kLineFragmentShader = `
  ${kDepthShader}
  uniform vec3 colour;
  uniform float half_width, pixel_ratio, has_depth, hidden, opacity, pull, dash;
  varying vec2 place;
  varying float edge_pixels, along, inverse_distance, loop_number;
  void main() {
    float beyond = place.x - clamp(place.x, 0.0, edge_pixels);
    float cover = clamp(half_width * pixel_ratio + 0.5 - length(vec2(beyond, place.y)), 0.0, 1.0);
    if (cover <= 0.0) discard;
    if (dash > 0.0 && fract(along / dash) > 0.62) discard;
    float shown = 1.0;
    if (has_depth > 0.5 && hidden < 1.0) {
      float here = 1.0 / inverse_distance;
      if (here * 0.997 - pull > scene_distance(gl_FragCoord.xy)) shown = hidden;
    }
    if (shown <= 0.0) discard;
    #ifdef PICK
    float number = floor(loop_number + 0.5);
    gl_FragColor = vec4(mod(number, 256.0), mod(floor(number / 256.0), 256.0), floor(number / 65536.0), 255.0) / 255.0;
    #else
    gl_FragColor = vec4(colour, cover * shown * opacity);
    #endif
  }`;

class LoopLines {
  // Reserves space for `reserved` loops of `data.loops` (indices).
  constructor(loops, reserved, camera_uniforms) {
    this.loops = loops;
    let size = 0;
    for (const loop of reserved) size += loops.first[loop + 1] - loops.first[loop] + 1;
    this.camera_uniforms = camera_uniforms;
    this.numbers = new Float32Array(Math.max(2, size) * kVertexNumbers);
    this.buffer = new THREE.InstancedInterleavedBuffer(this.numbers, kVertexNumbers, 1);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    this.geometry = new THREE.InstancedBufferGeometry();
    this.geometry.setAttribute("position", new THREE.BufferAttribute(
        new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, -1, 0, 1, 1, 0, 0, 1, 0]), 3));
    const attribute = (name, count, offset) =>
        this.geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(this.buffer, count, offset));
    attribute("from", 3, 0);
    attribute("from_more", 2, 3);
    attribute("to", 3, kVertexNumbers);
    attribute("to_more", 2, kVertexNumbers + 3);
    this.geometry.maxInstancedCount = 0;
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
        opacity: {value: style.opacity === undefined ? 1 : style.opacity},
        hidden: {value: 0},
        pull: {value: 0},
        dash: {value: 0},
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
  show(indices) {
    const {first, vertices} = this.loops;
    const out = this.numbers;
    let at = 0;
    for (const loop of indices) {
      const begin = first[loop], end = first[loop + 1];
      let length = 0, x = 0, y = 0, z = 0;
      for (let i = begin; i <= end && end > begin; ++i) {
        const from = 3 * (i === end ? begin : i);
        const next_x = vertices[from], next_y = vertices[from + 1], next_z = vertices[from + 2];
        if (i > begin) length += Math.hypot(next_x - x, next_y - y, next_z - z);
        x = out[at] = next_x;
        y = out[at + 1] = next_y;
        z = out[at + 2] = next_z;
        out[at + 3] = length;
        out[at + 4] = loop;
        at += kVertexNumbers;
      }
    }
    this.count = Math.max(0, at / kVertexNumbers - 1);
    this.buffer.updateRange = {offset: 0, count: at};
    this.buffer.needsUpdate = true;
    this.geometry.maxInstancedCount = this.count;
    this.set_visible(true);
  }

  set_visible(is_visible) {
    for (const object of this.objects) object.visible = is_visible && this.count > 0;
  }
}
