// SPDX-License-Identifier: Apache-2.0
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
    const vector = (column) => Array.from(column.subarray(3 * index, 3 * index + 3));
    const is_plane = count > 2 && Math.hypot(...vector(normal)) > 0.5;
    this.plane = is_plane ? {across: new THREE.Vector3(...vector(normal)), middle: to_scene(this.frame, vector(centroid))} : null;
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
