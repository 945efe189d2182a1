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
