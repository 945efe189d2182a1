// SPDX-License-Identifier: Apache-2.0
// What the shaders share: the section, and the camera in parts, so that large scenes stay still when it is close.
//
// A vertex is taken relative to the eye before it is turned: near the eye the difference of two close floats is exact.
// One matrix for all would lose those digits, and a hole of 10 cm in a scan of 1 km would tremble.

const kCameraShader = `
  uniform vec3 eye_high, eye_low;
  uniform mat3 turn;
  vec3 to_view(vec3 place) { return turn * ((place - eye_high) - eye_low); }
`;

// Lowest and highest height that is drawn, in scene coordinates.
const kSectionShader = `
  uniform vec2 section;
  uniform vec3 up;
  float height_of(vec3 place) { return dot(place, up); }
`;

const kDepthShader = `
  uniform sampler2D depth_map;
  uniform vec2 resolution;
  uniform float near, far;
  float scene_distance(vec2 pixel) {
    float depth = texture2D(depth_map, pixel / resolution).x;
    return near * far / (far - depth * (far - near));
  }
`;

const kAllHeights = [-1, 1];  // scene coordinates lie between -0.5 and 0.5

// One set of uniforms for all materials.
function make_camera_uniforms() {
  return {
    eye_high: {value: new THREE.Vector3()},
    eye_low: {value: new THREE.Vector3()},
    turn: {value: new THREE.Matrix3()},
    section: {value: new THREE.Vector2(...kAllHeights)},
    up: {value: new THREE.Vector3(0, 0, 1)},
    near: {value: 0.1},
    far: {value: 10},
    focal: {value: 1000},  // pixels at distance 1
    resolution: {value: new THREE.Vector2(1, 1)},
    pixel_ratio: {value: 1},
    depth_map: {value: null},
    has_depth: {value: 0},
  };
}

function update_camera_uniforms(uniforms, camera, height) {
  const eye = camera.position;
  const high = [eye.x, eye.y, eye.z].map(Math.fround);
  uniforms.eye_high.value.set(...high);
  uniforms.eye_low.value.set(eye.x - high[0], eye.y - high[1], eye.z - high[2]);
  uniforms.turn.value.setFromMatrix4(camera.matrixWorldInverse);
  uniforms.near.value = camera.near;
  uniforms.far.value = camera.far;
  uniforms.focal.value = height / (2 * Math.tan((camera.fov * Math.PI) / 360));
}

// A triangle over the whole canvas.
function screen_geometry() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
  return geometry;
}

// Eye-dome lighting (Boucheny 2009): pixels farther away than their neighbours get darker, so edges and steps show.
function eye_dome_material(camera_uniforms) {
  return new THREE.ShaderMaterial({
    depthTest: false,
    depthWrite: false,
    uniforms: {...camera_uniforms, colour_map: {value: null}, background: {value: new THREE.Vector3()},
               strength: {value: 60}, slack: {value: 0}, mask_map: {value: null}, veil: {value: new THREE.Vector4()}, pull: {value: 0}},
    vertexShader: `void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`,
    fragmentShader: `
      ${kDepthShader}
      uniform sampler2D colour_map;
      uniform vec3 background;
      uniform sampler2D mask_map;  // where the chosen hole is
      uniform vec4 veil;           // its plane: normal and distance from the eye; 0 for none
      uniform float focal, pull;
      uniform float strength, pixel_ratio, has_depth, slack;  // slack: steps between discs of one surface
      bool is_behind_hole(float away) {
        if (veil.xyz == vec3(0.0) || texture2D(mask_map, gl_FragCoord.xy / resolution).x < 0.5) return false;
        vec3 ray = vec3((gl_FragCoord.xy - 0.5 * resolution) / focal, -1.0);
        return away > veil.w / dot(veil.xyz, ray) + pull;
      }
      float step_to(float here, vec2 offset) {
        return max(0.0, here - log2(scene_distance(gl_FragCoord.xy + offset * pixel_ratio)));
      }
      void main() {
        vec4 colour = texture2D(colour_map, gl_FragCoord.xy / resolution);
        if (colour.a < 0.5) { gl_FragColor = vec4(background, 1.0); return; }
        float shade = 1.0;
        if (has_depth > 0.5) {
          float away = scene_distance(gl_FragCoord.xy);
          float here = log2(max(away - slack, away * 0.5));
          float sum = step_to(here, vec2(1.4, 0.0)) + step_to(here, vec2(-1.4, 0.0)) +
                      step_to(here, vec2(0.0, 1.4)) + step_to(here, vec2(0.0, -1.4)) +
                      step_to(here, vec2(1.0, 1.0)) + step_to(here, vec2(-1.0, -1.0)) +
                      step_to(here, vec2(1.0, -1.0)) + step_to(here, vec2(-1.0, 1.0));
          shade = max(0.35, exp(-strength * sum / 8.0));
        }
        vec3 seen = colour.rgb * shade;
        if (has_depth > 0.5 && is_behind_hole(scene_distance(gl_FragCoord.xy))) seen = mix(background, seen, 0.25);
        gl_FragColor = vec4(seen, 1.0);
      }`,
  });
}

// What lies behind the chosen hole is pale: within its outline, and beyond its plane. So a hole does not look like a
// closed surface where the scan goes on behind it. `lacuna render --view ID` has the same rule.

class Veil {
  constructor({loops, frame}, camera_uniforms) {
    Object.assign(this, {loops, frame, plane: null});
    this.scene = new THREE.Scene();
    this.target = new THREE.WebGLRenderTarget(1, 1, {depthBuffer: false, stencilBuffer: false,
                                                     minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter});
    // Each triangle of a fan inverts what it covers: the even-odd rule, for outlines of any form.
    const material = new THREE.ShaderMaterial({
      uniforms: camera_uniforms,
      vertexShader: `${kCameraShader} void main() { gl_Position = projectionMatrix * vec4(to_view(position), 1.0); }`,
      fragmentShader: `void main() { gl_FragColor = vec4(1.0); }`,
      depthTest: false,
      depthWrite: false,
      side: THREE.DoubleSide,
      transparent: true,
      blending: THREE.CustomBlending,
      blendSrc: THREE.OneMinusDstColorFactor,
      blendDst: THREE.ZeroFactor,
    });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  // -1 for none; outer curves have none, since the surface is within them.
  choose(index) {
    const {is_hole, first, vertices, normal, centroid} = this.loops;
    const count = index >= 0 && is_hole[index] ? first[index + 1] - first[index] : 0;
    const is_plane = count > 2 && Math.hypot(...vector_of(normal, index)) > 0.5;
    this.plane = is_plane ? {across: new THREE.Vector3(...vector_of(normal, index)), middle: to_scene(this.frame, vector_of(centroid, index))} : null;
    if (!is_plane) return;
    const triangles = new Uint32Array(3 * (count - 2)).map((_, i) => (i % 3 === 0 ? 0 : Math.floor(i / 3) + (i % 3)));
    this.mesh.geometry.dispose();
    this.mesh.geometry = new THREE.BufferGeometry();
    this.mesh.geometry.setAttribute("position", new THREE.BufferAttribute(vertices.slice(3 * first[index], 3 * first[index + 1]), 3));
    this.mesh.geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  }

  // Gives the shading its mask and the plane as seen from the eye: [normal, distance], all 0 without a hole.
  draw(renderer, camera, {width, height}, uniforms) {
    uniforms.veil.value.set(0, 0, 0, 0);
    if (!this.plane) return;
    const across = this.plane.across.clone().transformDirection(camera.matrixWorldInverse);
    const middle = new THREE.Vector3(...this.plane.middle).applyMatrix4(camera.matrixWorldInverse);
    uniforms.veil.value.set(across.x, across.y, across.z, across.dot(middle));
    uniforms.mask_map.value = this.target.texture;
    this.target.setSize(width, height);
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0, 0);
    renderer.clear(true, false, false);
    renderer.render(this.scene, camera);
  }
}
