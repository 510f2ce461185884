// ---- meshes

/** A packed mesh; decoded when first shown. Layout: report_page.cpp, PackedMesh. */
class Mesh {
  constructor(description, group, id) {
    Object.assign(this, description);
    this.group = group;
    this.id = id;
    this.pose = new Pose();
    this.gpu = null;
  }
  decode() {
    if (this.position) return this;
    const text = atob($(this.id).textContent), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    let at = 0;
    const take = size => bytes.slice(at, at += size);
    const stored = new Uint16Array(take(6 * this.vertices).buffer);
    this.index = this.vertices > 65536 ? new Uint32Array(take(12 * this.faces).buffer) : new Uint16Array(take(6 * this.faces).buffer);
    this.predicted = take(this.faces);
    this.trueLabel = this.truth ? take(this.faces) : null;
    this.confidence = take(this.faces);
    this.entropy = this.hasEntropy ? take(this.faces) : null;
    this.border = this.hasBorder ? take(this.faces) : null;
    this.normalizePositions(stored);
    this.corner = this.weld(stored);
    this.normal = this.shadingNormals();
    this.edges = this.interiorEdges();
    return this;
  }
  /** Positions in a ball of radius 1 around the center of the box of the used vertices. */
  normalizePositions(stored) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const p = this.position = new Float32Array(stored.length);
    for (const v of this.index)
      for (let c = 0; c < 3; ++c) {
        const x = p[3 * v + c] = stored[3 * v + c] * this.step[c];
        low[c] = Math.min(low[c], x);
        high[c] = Math.max(high[c], x);
      }
    const center = low.map((x, c) => (x + high[c]) / 2);
    let radius = 0;
    for (const v of this.index) radius = Math.max(radius, Math.hypot(...center.map((x, c) => p[3 * v + c] - x)));
    const scale = radius > 0 ? 1 / radius : 1;
    for (let i = 0; i < p.length; ++i) p[i] = (p[i] - center[i % 3]) * scale;
  }
  /** The index buffer with vertices of equal position made one, so that seams of a file cut neither edges nor normals. */
  weld(stored) {
    const first = new Map(), merged = new Uint32Array(this.vertices);
    for (let v = 0; v < this.vertices; ++v) {
      const key = (stored[3 * v] * 65536 + stored[3 * v + 1]) * 65536 + stored[3 * v + 2];
      if (!first.has(key)) first.set(key, v);
      merged[v] = first.get(key);
    }
    return Uint32Array.from(this.index, v => merged[v]);
  }
  /** A normal per corner: the mean over the faces around it that meet at less than 40 degrees, so creases stay sharp. */
  shadingNormals() {
    const F = this.faces, p = this.position, area = new Float32Array(3 * F), unit = new Float32Array(3 * F);
    const begin = new Uint32Array(this.vertices + 1), around = new Uint32Array(3 * F);
    for (let f = 0; f < F; ++f) {
      const [a, b, c] = [3 * this.index[3 * f], 3 * this.index[3 * f + 1], 3 * this.index[3 * f + 2]];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], length = Math.hypot(...n) || 1;
      area.set(n, 3 * f);
      unit.set(n.map(x => x / length), 3 * f);
    }
    for (const v of this.corner) ++begin[v + 1];
    for (let v = 0; v < this.vertices; ++v) begin[v + 1] += begin[v];
    const next = begin.slice();
    for (let i = 0; i < 3 * F; ++i) around[next[this.corner[i]]++] = Math.floor(i / 3);
    const result = new Float32Array(9 * F), crease = Math.cos(40 * Math.PI / 180);
    for (let i = 0; i < 3 * F; ++i) {
      const f = 3 * Math.floor(i / 3), v = this.corner[i];
      let x = 0, y = 0, z = 0;
      for (let j = begin[v]; j < begin[v + 1]; ++j) {
        const g = 3 * around[j];
        if (unit[f] * unit[g] + unit[f + 1] * unit[g + 1] + unit[f + 2] * unit[g + 2] < crease) continue;
        x += area[g]; y += area[g + 1]; z += area[g + 2];
      }
      const length = Math.hypot(x, y, z) || 1;
      result[3 * i] = x / length; result[3 * i + 1] = y / length; result[3 * i + 2] = z / length;
    }
    return result;
  }
  /** [vertex, vertex, face, face] of every pair of faces that share an edge. */
  interiorEdges() {
    const open = new Map(), edges = [];
    for (let i = 0; i < this.corner.length; ++i) {
      const f = Math.floor(i / 3), a = this.corner[i], b = this.corner[3 * f + (i + 1) % 3];
      if (a === b) continue;
      const key = Math.min(a, b) * this.vertices + Math.max(a, b);
      if (open.has(key)) edges.push(a, b, open.get(key), f);
      open.set(key, f);
    }
    return Uint32Array.from(edges);
  }
  isWrong(f) { return this.trueLabel && this.trueLabel[f] !== UNLABELED && this.trueLabel[f] !== this.predicted[f]; }
  /** The color of a face in a mode of SHADES. */
  shade(mode, f) {
    const values = this[mode];
    if (!values) return UNKNOWN;
    return shadeColor(SHADES[mode].darkest ? 1 - values[f] / 255 : values[f] / 255);
  }
  /** The sRGB color of a face in a mode. */
  faceColor(mode, f) {
    const mark = state.highlight;
    if (SHADES[mode]) return this.shade(mode, f);
    if (mode === 'errors') {
      const truth = this.trueLabel ? this.trueLabel[f] : UNLABELED;
      if (truth === UNLABELED) return UNKNOWN;
      return this.isWrong(f) && (mark < 0 || mark === truth || mark === this.predicted[f]) ? WRONG : RIGHT;
    }
    const label = mode === 'truth' ? this.trueLabel ? this.trueLabel[f] : UNLABELED : this.predicted[f];
    if (label === UNLABELED) return UNKNOWN;
    return mark >= 0 && label !== mark ? NEUTRAL : this.group.rgb[label];
  }
  /** The labels whose boundaries are drawn in a mode. */
  boundaryLabels(mode) { return (mode === 'truth' || mode === 'errors') && this.trueLabel || this.predicted; }
  /** The face a ray hits first (origin and direction in the mesh's frame), or -1. */
  pick(o, d) {
    const p = this.position;
    let best = Infinity, hit = -1;
    for (let f = 0; f < this.faces; ++f) {
      const a = 3 * this.index[3 * f], b = 3 * this.index[3 * f + 1], c = 3 * this.index[3 * f + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const hx = d[1] * vz - d[2] * vy, hy = d[2] * vx - d[0] * vz, hz = d[0] * vy - d[1] * vx;
      const det = ux * hx + uy * hy + uz * hz;
      if (Math.abs(det) < 1e-14) continue;
      const sx = o[0] - p[a], sy = o[1] - p[a + 1], sz = o[2] - p[a + 2];
      const s = (sx * hx + sy * hy + sz * hz) / det;
      if (s < 0 || s > 1) continue;
      const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
      const t = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
      if (t < 0 || s + t > 1) continue;
      const distance = (vx * qx + vy * qy + vz * qz) / det;
      if (distance > 0 && distance < best) { best = distance; hit = f; }
    }
    return hit;
  }
}
