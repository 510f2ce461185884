// ---- views: canvases that show a mesh in one mode and turn it

class View {
  /** `mode` null: whatever the page's mode is. `detail` is the element that names the face under the pointer. */
  constructor(canvas, mesh, mode, detail, inDialog) {
    Object.assign(this, { canvas, mesh, fixedMode: mode, detail, inDialog, visible: inDialog, dirty: true, pointers: new Map() });
    canvas.view = this;
    this.describe(-1);
    const on = (type, listener, options) => canvas.addEventListener(type, listener.bind(this), options);
    on('pointerdown', this.pointerDown);
    on('pointermove', this.pointerMove);
    for (const type of ['pointerup', 'pointercancel']) on(type, event => this.pointers.delete(event.pointerId));
    on('pointerleave', () => this.describe(-1));
    on('dblclick', () => { mesh.pose.home(); this.changed(); });
    on('wheel', this.wheel, { passive: false });
    on('keydown', this.keyDown);
  }
  get mode() { return this.fixedMode ?? state.mode; }
  /** Draws again whatever shows this mesh; with all linked, the other meshes turn along. */
  changed() {
    for (const view of allViews()) {
      if (state.linked) view.mesh.pose.rotation = this.mesh.pose.rotation;
      if (state.linked || view.mesh === this.mesh) view.dirty = true;
    }
    requestDraw();
  }
  /** Scale of x and y, and the two depth terms of the projection. */
  lens() {
    const w = this.canvas.clientWidth || 1, h = this.canvas.clientHeight || 1, size = Math.min(w, h);
    const f = FOCAL_LENGTH * this.mesh.pose.zoom, near = CAMERA_DISTANCE - 1.05, far = CAMERA_DISTANCE + 1.05;
    return [f * size / w, f * size / h, -(far + near) / (far - near), -2 * far * near / (far - near)];
  }
  move(dx, dy) {
    const { pan } = this.mesh.pose;
    this.mesh.pose.pan = [pan[0] + 2 * dx / this.canvas.clientWidth, pan[1] - 2 * dy / this.canvas.clientHeight];
  }
  pointerDown(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.canvas.focus({ preventScroll: true });
  }
  pointerMove(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return this.hover(event);
    const dx = event.clientX - last[0], dy = event.clientY - last[1];
    if (this.pointers.size === 2) this.pinch(event, last, dx, dy);
    else if (event.shiftKey || event.buttons & 4) this.move(dx, dy);
    else this.mesh.pose.turn(dx / 120, dy / 120);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.changed();
  }
  /** Two fingers: their distance zooms, their mean moves. */
  pinch(event, last, dx, dy) {
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
    const before = Math.hypot(last[0] - other[0], last[1] - other[1]);
    const after = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
    if (before > 1 && after > 1) this.mesh.pose.zoomBy(after / before);
    this.move(dx / 2, dy / 2);
  }
  /** On a card the wheel zooms only after a click, so that the page still scrolls under the pointer. */
  wheel(event) {
    if (!this.inDialog && !event.ctrlKey && document.activeElement !== this.canvas) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    this.mesh.pose.zoomBy(Math.exp(-Math.max(-120, Math.min(120, event.deltaY * lines)) * .0018));
    this.changed();
  }
  keyDown(event) {
    const step = Math.PI / 18, { pose } = this.mesh;
    const actions = {
      ArrowLeft: () => pose.turn(-step, 0), ArrowRight: () => pose.turn(step, 0),
      ArrowUp: () => pose.turn(0, -step), ArrowDown: () => pose.turn(0, step),
      '+': () => pose.zoomBy(1.15), '=': () => pose.zoomBy(1.15), '-': () => pose.zoomBy(1 / 1.15),
      '0': () => pose.home(), Home: () => pose.home(),
      Enter: () => { if (!this.inDialog) openLarge(this.mesh); },
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
    this.changed();
  }
  hover(event) {
    if (!renderer.gl || !this.mesh.position || event.pointerType === 'touch') return;
    const box = this.canvas.getBoundingClientRect(), lens = this.lens(), { rotation: r, pan } = this.mesh.pose;
    const x = (2 * (event.clientX - box.left) / box.width - 1 - pan[0]) / lens[0];
    const y = (1 - 2 * (event.clientY - box.top) / box.height - pan[1]) / lens[1];
    const inMesh = v => [0, 1, 2].map(c => r[c] * v[0] + r[3 + c] * v[1] + r[6 + c] * v[2]);
    this.describe(this.mesh.pick(inMesh([0, 0, CAMERA_DISTANCE]), inMesh([x, y, -1])));
  }
  /** The caption: the face under the pointer, or the mesh. */
  describe(face) {
    const mesh = this.mesh;
    if (face < 0) return void this.detail.replaceChildren(`${count(mesh.faces)} faces`);
    const { labels, colors } = mesh.group, label = mesh.predicted[face];
    const parts = [swatch(colors[label]), `${labels[label]}, ${Math.round(mesh.confidence[face] / 2.55)}% sure`];
    if (mesh.isWrong(face)) parts.push(' — truly ', swatch(colors[mesh.trueLabel[face]]), labels[mesh.trueLabel[face]]);
    this.detail.replaceChildren(...parts);
  }
}

const renderer = new Renderer();
let drawRequested = false;
const large = { mesh: null, views: [] };
const allViews = () => [...state.views, ...large.views];
function requestDraw() {
  if (drawRequested || !renderer.gl) return;
  drawRequested = true;
  requestAnimationFrame(() => {
    drawRequested = false;
    for (const view of allViews()) {
      if (!view.dirty || !view.visible) continue;
      view.dirty = false;
      renderer.draw(view);
    }
  });
}
function redrawAll() {
  for (const view of allViews()) view.dirty = true;
  requestDraw();
}
const sightings = new IntersectionObserver(entries => {
  for (const { target, isIntersecting } of entries) target.view.visible = isIntersecting;
  requestDraw();
}, { rootMargin: '200px' });
const resizes = new ResizeObserver(entries => {
  for (const { target } of entries) if (target.view) target.view.dirty = true;
  requestDraw();
});
