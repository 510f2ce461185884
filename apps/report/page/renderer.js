// ---- drawing: one WebGL context for all views, copied to the 2D canvas of each

const CAMERA_DISTANCE = 4.2;
const FOCAL_LENGTH = 4.05;
const SURFACE = [`
  attribute vec3 position, normal, color;
  uniform mat3 rotation; uniform vec4 lens; uniform vec2 pan; uniform float distance;
  varying vec3 n, albedo, toEye;
  void main() {
    vec3 p = rotation * position - vec3(0, 0, distance);
    gl_Position = vec4(p.xy * lens.xy - pan * p.z, p.z * lens.z + lens.w, -p.z);
    n = rotation * normal; albedo = color; toEye = -p;
  }`, `
  precision highp float;
  varying vec3 n, albedo, toEye;
  void main() {
    vec3 v = normalize(toEye), m = normalize(n);
    if (dot(m, v) < 0.) m = -m;
    vec3 base = pow(albedo, vec3(2.2));
    vec3 sky = mix(vec3(.27, .26, .30), vec3(.62, .64, .68), m.y * .5 + .5);
    float key = max(dot(m, normalize(vec3(-.45, .65, .75))), 0.);
    float gloss = pow(max(dot(m, normalize(vec3(-.45, .65, .75) + v)), 0.), 40.) * .05;
    float rim = 1. - .28 * pow(1. - max(dot(m, v), 0.), 3.);
    gl_FragColor = vec4(pow((base * (sky + .58 * key) + gloss) * rim, vec3(1. / 2.2)), 1.);
  }`];
const BOUNDARY = [`
  attribute vec3 here, there; attribute float side;
  uniform mat3 rotation; uniform vec4 lens; uniform vec2 pan, pixel; uniform float distance, width;
  vec4 project(vec3 x) {
    vec3 p = rotation * x - vec3(0, 0, distance);
    return vec4(p.xy * lens.xy - pan * p.z, p.z * lens.z + lens.w, -p.z);
  }
  void main() {
    vec4 a = project(here), b = project(there);
    vec2 along = (b.xy / b.w - a.xy / a.w) / pixel;
    float len = length(along);
    along = len > 1e-4 ? along / len : vec2(1, 0);
    vec2 offset = (vec2(-along.y, along.x) * side - .4 * along) * .5 * width;
    gl_Position = vec4(a.xy + offset * pixel * a.w, a.z - .004 * a.w, a.w);
  }`, `
  precision mediump float;
  uniform vec4 color;
  void main() { gl_FragColor = vec4(color.rgb * color.a, color.a); }`];

class Renderer {
  constructor() {
    this.canvas = document.createElement('canvas');
    this.canvas.width = this.canvas.height = 16;
    this.gl = this.canvas.getContext('webgl', { alpha: true, antialias: true, premultipliedAlpha: true });
    this.canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    this.canvas.addEventListener('webglcontextrestored', () => {
      for (const view of allViews()) view.mesh.gpu = null;
      this.build();
      redrawAll();
    });
    if (this.gl) this.build();
  }
  build() {
    this.surface = this.program(SURFACE);
    this.boundary = this.program(BOUNDARY);
    const gl = this.gl;
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.SCISSOR_TEST);
  }
  program(sources) {
    const gl = this.gl, program = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((type, i) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, sources[i]);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program));
    const found = { program, uniform: {}, attribute: {} };
    for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i-- > 0;) {
      const name = gl.getActiveUniform(program, i).name;
      found.uniform[name] = gl.getUniformLocation(program, name);
    }
    for (let i = gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); i-- > 0;) {
      const name = gl.getActiveAttrib(program, i).name;
      found.attribute[name] = gl.getAttribLocation(program, name);
    }
    return found;
  }
  fill(buffer, data) {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, data, this.gl.STATIC_DRAW);
  }
  /** Buffers of a mesh: the geometry once; colors and boundaries once per mode, again when the highlight changes. */
  upload(mesh, mode) {
    const gl = this.gl;
    mesh.decode();
    if (!mesh.gpu) {
      mesh.gpu = { position: gl.createBuffer(), normal: gl.createBuffer(), paint: {} };
      const corners = new Float32Array(9 * mesh.faces);
      mesh.index.forEach((v, i) => corners.set(mesh.position.subarray(3 * v, 3 * v + 3), 3 * i));
      this.fill(mesh.gpu.position, corners);
      this.fill(mesh.gpu.normal, mesh.normal);
    }
    const paint = mesh.gpu.paint[mode] ??= { highlight: null, color: gl.createBuffer(), boundary: gl.createBuffer() };
    if (paint.highlight === state.highlight) return paint;
    paint.highlight = state.highlight;
    const colors = new Uint8Array(12 * mesh.faces);
    for (let f = 0; f < mesh.faces; ++f) {
      const color = mesh.faceColor(mode, f);
      for (let i = 0; i < 3; ++i) colors.set(color, 12 * f + 4 * i);
    }
    this.fill(paint.color, colors);
    const lines = this.boundaryQuads(mesh, mesh.boundaryLabels(mode));
    paint.boundaryVertices = lines.length / 7;
    this.fill(paint.boundary, lines);
    return paint;
  }
  /** Two triangles per boundary edge; each vertex is [here, there, side] and is moved sideways by the shader. */
  boundaryQuads(mesh, labels) {
    const p = mesh.position, out = [];
    for (let e = 0; e < mesh.edges.length; e += 4) {
      if (labels[mesh.edges[e + 2]] === labels[mesh.edges[e + 3]]) continue;
      const a = p.subarray(3 * mesh.edges[e], 3 * mesh.edges[e] + 3), b = p.subarray(3 * mesh.edges[e + 1], 3 * mesh.edges[e + 1] + 3);
      out.push(...a, ...b, 1, ...a, ...b, -1, ...b, ...a, -1, ...b, ...a, -1, ...a, ...b, -1, ...b, ...a, 1);
    }
    return new Float32Array(out);
  }
  attribute(location, buffer, size, type, normalized, stride, offset) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, type, normalized, stride, offset);
  }
  use(shader, view) {
    const gl = this.gl, lens = view.lens();
    gl.useProgram(shader.program);
    gl.uniformMatrix3fv(shader.uniform.rotation, false, view.mesh.pose.columnMajorRotation());
    gl.uniform4fv(shader.uniform.lens, lens);
    gl.uniform2fv(shader.uniform.pan, view.mesh.pose.pan);
    gl.uniform1f(shader.uniform.distance, CAMERA_DISTANCE);
  }
  draw(view) {
    const gl = this.gl, ratio = Math.min(window.devicePixelRatio || 1, 3);
    const w = Math.round(view.canvas.clientWidth * ratio), h = Math.round(view.canvas.clientHeight * ratio);
    if (!gl || gl.isContextLost() || !w || !h) return;
    if (this.canvas.width < w) this.canvas.width = w;
    if (this.canvas.height < h) this.canvas.height = h;
    if (view.canvas.width !== w || view.canvas.height !== h) Object.assign(view.canvas, { width: w, height: h });
    const paint = this.upload(view.mesh, view.mode);
    gl.viewport(0, 0, w, h);
    gl.scissor(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawSurface(view, paint);
    this.drawBoundary(view, paint, w, h, ratio);
    const context = view.canvas.getContext('2d');
    context.clearRect(0, 0, w, h);
    context.drawImage(this.canvas, 0, this.canvas.height - h, w, h, 0, 0, w, h);
  }
  drawSurface(view, paint) {
    const gl = this.gl, gpu = view.mesh.gpu, { attribute } = this.surface;
    this.use(this.surface, view);
    this.attribute(attribute.position, gpu.position, 3, gl.FLOAT, false, 0, 0);
    this.attribute(attribute.normal, gpu.normal, 3, gl.FLOAT, false, 0, 0);
    this.attribute(attribute.color, paint.color, 3, gl.UNSIGNED_BYTE, true, 4, 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3 * view.mesh.faces);
  }
  drawBoundary(view, paint, w, h, ratio) {
    const gl = this.gl, { attribute, uniform } = this.boundary;
    if (!paint.boundaryVertices) return;
    this.use(this.boundary, view);
    gl.uniform2f(uniform.pixel, 2 / w, 2 / h);
    gl.uniform1f(uniform.width, 1.4 * ratio);
    gl.uniform4f(uniform.color, .07, .09, .14, SHADES[view.mode] ? .5 : .85);
    this.attribute(attribute.here, paint.boundary, 3, gl.FLOAT, false, 28, 0);
    this.attribute(attribute.there, paint.boundary, 3, gl.FLOAT, false, 28, 12);
    this.attribute(attribute.side, paint.boundary, 1, gl.FLOAT, false, 28, 24);
    gl.drawArrays(gl.TRIANGLES, 0, paint.boundaryVertices);
  }
  release(mesh) {
    if (!mesh.gpu) return;
    const buffers = [mesh.gpu.position, mesh.gpu.normal, ...Object.values(mesh.gpu.paint).flatMap(p => [p.color, p.boundary])];
    for (const buffer of buffers) this.gl.deleteBuffer(buffer);
    mesh.gpu = null;
  }
}
