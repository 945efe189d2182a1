// SPDX-License-Identifier: Apache-2.0
// Mouse and fingers on the view, besides the drags that OrbitControls has; and what is under the pointer: a loop, or a point.

// `actions`: {zoom(factor, x, y), click(x, y), double_click(x, y), hover(x, y), leave(), is_busy()}
function connect_pointer(canvas, actions) {
  // Before OrbitControls, which would zoom to the middle of the picture.
  canvas.parentElement.addEventListener("wheel", (event) => {
    if (event.target !== canvas) return;
    event.preventDefault();
    event.stopPropagation();
    const lines = event.deltaMode === 1 ? 16 : 1;
    const amount = Math.max(-120, Math.min(120, event.deltaY * lines));
    actions.zoom(Math.exp(amount * 0.0016), event.clientX, event.clientY);
  }, {capture: true, passive: false});
  let down = null;
  canvas.addEventListener("pointerdown", (event) => {
    down = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null;
    actions.leave();
  });
  canvas.addEventListener("pointerup", (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    down = null;
    actions.click(event.clientX, event.clientY);
  });
  canvas.addEventListener("dblclick", (event) => actions.double_click(event.clientX, event.clientY));
  let hovered = 0;
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons !== 0 || event.pointerType === "touch" || event.timeStamp < hovered || actions.is_busy()) return;
    const begin = performance.now();
    actions.hover(event.clientX, event.clientY);
    // A slow machine looks less often.
    hovered = event.timeStamp + 40 + 4 * (performance.now() - begin);
  });
  canvas.addEventListener("pointerleave", () => actions.leave());
}

const kPickPixels = 9;

// Picks loops from a picture of their numbers, drawn with the lines' own shader.
class LoopPicker {
  constructor(renderer, scene) {
    Object.assign(this, {renderer, scene});
    this.target = new THREE.WebGLRenderTarget(1, 1, {depthBuffer: false});
  }

  // Index of the loop drawn nearest to the pixel of the canvas (CSS pixels from its corner), -1 if none is near.
  loop_at(left, top, camera, {width, height}) {
    const ratio = this.renderer.getPixelRatio();
    const size = Math.round(kPickPixels * ratio) | 1;
    const column = Math.round(left * ratio) - (size >> 1);
    const row = height - 1 - Math.round(top * ratio) - (size >> 1);
    if (column < 0 || row < 0 || column + size > width || row + size > height) return -1;
    this.target.setSize(width, height);
    this.target.scissor.set(column, row, size, size);
    this.target.scissorTest = true;
    this.renderer.setRenderTarget(this.target);
    this.renderer.setClearColor(0, 0);
    this.renderer.clear(true, false, false);
    this.renderer.render(this.scene, camera);
    const pixels = new Uint8Array(4 * size * size);
    this.renderer.readRenderTargetPixels(this.target, column, row, size, size, pixels);
    this.renderer.setRenderTarget(null);
    let best = -1, least = Infinity;
    for (let i = 0; i < size * size; ++i) {
      if (pixels[4 * i + 3] === 0) continue;
      const away = Math.hypot((i % size) - (size >> 1), Math.floor(i / size) - (size >> 1));
      if (away < least) {
        least = away;
        best = pixels[4 * i] + 256 * pixels[4 * i + 1] + 65536 * pixels[4 * i + 2];
      }
    }
    return best;
  }
}

// {place, distance} of the point nearest to the eye among those close to the ray; null without any.
// `tangent`: of the angle that is still close; `from`: the least distance that is shown. `section`: lowest and highest height that is shown, along the axis `up`.
function point_along({positions, count}, eye, ray, tangent, spacing, from, section, up) {
  let best = -1, nearest = Infinity;
  for (let i = 0; i < count; ++i) {
    if (positions[3 * i + up] < section.x || positions[3 * i + up] > section.y) continue;
    const px = positions[3 * i] - eye[0], py = positions[3 * i + 1] - eye[1], pz = positions[3 * i + 2] - eye[2];
    const along = px * ray[0] + py * ray[1] + pz * ray[2];
    if (along <= from || along >= nearest) continue;
    const aside = Math.sqrt(Math.max(0, px * px + py * py + pz * pz - along * along));
    if (aside < along * tangent + spacing * 0.6) { nearest = along; best = i; }
  }
  return best < 0 ? null : {place: Array.from(positions.subarray(3 * best, 3 * best + 3)), distance: nearest};
}
