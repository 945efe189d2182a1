// SPDX-License-Identifier: Apache-2.0
// When pictures are drawn: only after a change, and with fewer points while a slow machine moves.

const kStillMilliseconds = 160;  // after this all points are drawn

class Frames {
  // `move()` before each picture; `draw(count)` draws the first `count` of `points` points.
  constructor(points, {move, draw}) {
    Object.assign(this, {points, move, draw});
    this.budget = points;  // points drawn while the view moves
    this.last_change = 0;
    this.is_begun = false;  // a picture is there: changes before it need none of their own
    this.requested = false;
  }

  // The picture moves: `budget` points are enough for now.
  changed() {
    this.last_change = performance.now();
    this.request();
  }

  request() {
    if (this.requested || !this.is_begun) return;
    this.requested = true;
    requestAnimationFrame((now) => this.step(now));
  }

  // One picture; goes on only while something moves.
  step(now) {
    this.requested = false;
    this.move();
    const is_moving = performance.now() - this.last_change < kStillMilliseconds;
    this.adapt(now, is_moving);
    this.draw(is_moving ? this.budget : this.points);
    if (is_moving && this.budget < this.points) {
      clearTimeout(this.still);
      this.still = setTimeout(() => this.request(), kStillMilliseconds + 20);
    }
  }

  // Fewer points while the view moves, if the machine does not keep up.
  adapt(now, is_moving) {
    const interval = now - (this.last_step || 0);
    const was_moving = this.was_moving;
    this.last_step = now;
    this.was_moving = is_moving;
    if (!is_moving || !was_moving) return;
    if (interval > 45) this.budget = Math.max(Math.min(60000, this.points), Math.round(this.budget * (interval > 150 ? 0.4 : 0.75)));
    if (interval < 20) this.budget = Math.min(this.points, Math.round(this.budget * 1.15) + 1);
  }
}
