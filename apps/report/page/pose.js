// ---- how a mesh is turned

/** Row-major rotation by `angle` around the screen's x axis (0) or y axis (1), times `r`. */
function turned(r, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  const m = axis ? [c, 0, s, 0, 1, 0, -s, 0, c] : [1, 0, 0, 0, c, -s, 0, s, c];
  return m.map((_, i) => [0, 1, 2].reduce((sum, k) => sum + m[3 * Math.floor(i / 3) + k] * r[3 * k + i % 3], 0));
}
/** Removes the drift of many small turns. */
function orthonormal(r) {
  const unit = v => { const l = Math.hypot(...v); return v.map(x => x / l); };
  const x = unit(r.slice(0, 3)), dot = x[0] * r[3] + x[1] * r[4] + x[2] * r[5];
  const y = unit([r[3] - dot * x[0], r[4] - dot * x[1], r[5] - dot * x[2]]);
  return [...x, ...y, x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
}
const HOME = turned(turned([1, 0, 0, 0, 1, 0, 0, 0, 1], 1, -.6), 0, .42);

/** Rotation, zoom and shift of a mesh: one for all its views, so they turn together. */
class Pose {
  constructor() { this.home(); }
  home() {
    this.rotation = HOME;
    this.zoom = 1;
    this.pan = [0, 0];
  }
  turn(dx, dy) {
    const speed = 1 / Math.max(1, Math.sqrt(this.zoom));
    this.rotation = orthonormal(turned(turned(this.rotation, 1, dx * speed), 0, dy * speed));
  }
  zoomBy(factor) { this.zoom = Math.min(20, Math.max(.4, this.zoom * factor)); }
  columnMajorRotation() {
    const r = this.rotation;
    return [r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]];
  }
}
