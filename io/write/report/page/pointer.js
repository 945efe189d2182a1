// SPDX-License-Identifier: Apache-2.0
// Mouse and fingers on the view, besides the drags that OrbitControls has.

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
