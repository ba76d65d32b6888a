// A small renderer in WebGL 2: balls, limbs and boxes that one stretches and places, a ground, and
// shadows that are the figures pressed flat onto it.
import { axesAlong, clamp, length, scale, sub } from './vector.js';

const FLOATS = 16;  // Of an instance: three axes, the origin, the taper, the colour.
const SUN = [0.35, 0.25, 0.9];

// A colour as three numbers from 0xRRGGBB.
export const rgb = hex => [(hex >> 16 & 255) / 255, (hex >> 8 & 255) / 255, (hex & 255) / 255];

const FIGURE_VERTEX = `#version 300 es
layout(location = 0) in vec4 vertex;  // Along x and y, from the end along a cap, along z.
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 x_axis;
layout(location = 3) in vec3 y_axis;
layout(location = 4) in vec3 z_axis;
layout(location = 5) in vec3 origin;
layout(location = 6) in vec4 look;  // Taper, colour.
uniform mat4 to_clip;
uniform vec3 eye;
uniform vec4 flat_on;  // Direction to the sun; the height on which a shadow lies.
uniform bool shadow;
out vec3 colour;
out vec3 turned;
out float distance_m;
void main() {
  float radius = mix(1.0, look.x, vertex.w);
  vec3 cap = normalize(z_axis) * length(x_axis) * vertex.z;
  vec3 at = origin + (x_axis * vertex.x + y_axis * vertex.y + cap) * radius + z_axis * vertex.w;
  turned = normalize(x_axis * normal.x / dot(x_axis, x_axis) + y_axis * normal.y / dot(y_axis, y_axis) +
                     z_axis * normal.z / (length(z_axis) * (vertex.z == 0.0 ? length(z_axis) : length(x_axis))));
  colour = look.yzw;
  if (shadow) {
    at -= flat_on.xyz * (max(at.z - flat_on.w, 0.0) / flat_on.z);
    at.z = flat_on.w + 0.006;
  }
  distance_m = distance(eye, at);
  gl_Position = to_clip * vec4(at, 1.0);
}`;
const FIGURE_FRAGMENT = `#version 300 es
precision highp float;
in vec3 colour;
in vec3 turned;
in float distance_m;
uniform vec4 flat_on;
uniform bool shadow;
uniform vec3 fog;
out vec4 pixel;
void main() {
  if (shadow) { pixel = vec4(0.0, 0.0, 0.0, 0.35); return; }
  vec3 n = normalize(turned);
  float light = 0.62 * max(dot(n, flat_on.xyz), 0.0) + 0.42 + 0.12 * n.z;
  pixel = vec4(mix(colour * light, fog, smoothstep(25.0, 90.0, distance_m)), 1.0);
}`;
const GROUND_VERTEX = `#version 300 es
layout(location = 0) in vec2 corner;
uniform mat4 to_clip;
uniform highp vec4 middle;  // Where the ground is drawn about, and its height.
out vec2 at;
void main() {
  at = middle.xy + corner * 120.0;
  gl_Position = to_clip * vec4(at, middle.z, 1.0);
}`;
const GROUND_FRAGMENT = `#version 300 es
precision highp float;
in vec2 at;
uniform highp vec4 middle;
uniform vec3 ground;
uniform vec3 line;
uniform vec3 fog;
out vec4 pixel;
void main() {
  float distance_m = distance(at, middle.xy);
  vec2 cell = abs(fract(at - 0.5) - 0.5) / max(fwidth(at), vec2(1e-4));
  float on_line = (1.0 - min(min(cell.x, cell.y), 1.0)) * (1.0 - smoothstep(4.0, 22.0, distance_m));
  vec3 colour = mix(ground, line, 0.7 * on_line);
  pixel = vec4(mix(colour, fog, smoothstep(10.0, 90.0, distance_m)), 1.0);
}`;

function link(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
      throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  const uniforms = {};
  const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) ?? 0;
  for (let i = 0; i < count; ++i) {
    const { name } = gl.getActiveUniform(program, i);
    uniforms[name] = gl.getUniformLocation(program, name);
  }
  return { program, uniforms };
}

// Triangles between rows of vertices, each of `columns` + 1.
function joinRows(rows, columns) {
  const indices = [];
  for (let row = 0; row + 1 < rows; ++row) {
    for (let i = 0; i < columns; ++i) {
      const a = row * (columns + 1) + i, b = a + columns + 1;
      indices.push(a, a + 1, b + 1, a, b + 1, b);
    }
  }
  return indices;
}

// A unit ball, or a limb: two half balls about z = 0 and z = 1.
function roundMesh(columns, rings, isLimb) {
  const vertices = [], half = rings / 2;
  let rows = 0;
  for (let ring = 0; ring <= rings; ++ring) {
    const elevation = -Math.PI / 2 + Math.PI * ring / rings;
    for (const end of isLimb && ring === half ? [0, 1] : [ring > half ? 1 : 0]) {
      ++rows;
      for (let i = 0; i <= columns; ++i) {
        const turn = 2 * Math.PI * i / columns;
        const x = Math.cos(elevation) * Math.cos(turn), y = Math.cos(elevation) * Math.sin(turn);
        const z = Math.sin(elevation);
        vertices.push(x, y, isLimb ? z : 0, isLimb ? end : z, x, y, z);
      }
    }
  }
  return { vertices, indices: joinRows(rows, columns) };
}

// A cube with sides of 1; its height goes by the ends, so that a flat one stays sharp.
function boxMesh() {
  const vertices = [], indices = [];
  for (let axis = 0; axis < 3; ++axis) {
    for (const side of [-1, 1]) {
      const first = vertices.length / 7, normal = [0, 0, 0];
      normal[axis] = side;
      for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
        const p = [0, 0, 0];
        p[axis] = side;
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        vertices.push(p[0] / 2, p[1] / 2, 0, p[2] / 2 + 0.5, ...normal);
      }
      indices.push(...(side > 0 ? [0, 1, 2, 0, 2, 3] : [0, 2, 1, 0, 3, 2]).map(i => first + i));
    }
  }
  return { vertices, indices };
}

// The picture: instances of each shape. Colours are arrays of three numbers.
export class Parts {
  constructor() { this.lists = { balls: [], limbs: [], boxes: [] }; }

  clear() { for (const list of Object.values(this.lists)) list.length = 0; }

  // An ellipsoid with its half axes along `axes`.
  ball(centre, axes, half, colour) {
    this.lists.balls.push(...scale(axes[0], half[0]), ...scale(axes[1], half[1]),
                          ...scale(axes[2], half[2]), ...centre, 1, ...colour);
  }

  // A rod from a to b with round ends.
  limb(a, b, radiusA, radiusB, colour) {
    const line = sub(b, a);
    if (length(line) < 1e-5) return;
    const axes = axesAlong(line);
    this.lists.limbs.push(...scale(axes[0], radiusA), ...scale(axes[1], radiusA), ...line, ...a,
                          radiusB / radiusA, ...colour);
  }

  // A box with its sides along `axes`, about `middle`.
  box(middle, axes, sides, colour) {
    const low = sub(middle, scale(axes[2], sides[2] / 2));
    this.lists.boxes.push(...scale(axes[0], sides[0]), ...scale(axes[1], sides[1]),
                          ...scale(axes[2], sides[2]), ...low, 1, ...colour);
  }
}

export class Renderer {
  // Throws where there is no WebGL 2.
  constructor(canvas) {
    this.canvas = canvas;
    Object.assign(this, { scale: 1, slow_s: 0, pictures: 0 });
    const wanted = { alpha: false, stencil: true, powerPreference: 'low-power' };
    const probe = document.createElement('canvas').getContext('webgl2');
    const info = probe?.getExtension('WEBGL_debug_renderer_info');
    const name = info ? String(probe.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
    // A processor that draws has no time for smooth edges and fine pixels.
    this.isSoftware = /swiftshader|llvmpipe|software|basic render/i.test(name);
    probe?.getExtension('WEBGL_lose_context')?.loseContext();
    if (this.isSoftware) this.scale = 0.7;
    this.gl = canvas.getContext('webgl2', { ...wanted, antialias: !this.isSoftware });
    if (!this.gl) throw new Error('this browser has no WebGL 2, which the picture needs');
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.build());
    this.build();
  }

  build() {
    const gl = this.gl;
    this.figures = link(gl, FIGURE_VERTEX, FIGURE_FRAGMENT);
    this.ground = link(gl, GROUND_VERTEX, GROUND_FRAGMENT);
    const [balls, limbs] = this.isSoftware ? [[12, 8], [8, 4]] : [[18, 12], [12, 8]];
    this.meshes = { balls: this.mesh(roundMesh(...balls, false)),
                    limbs: this.mesh(roundMesh(...limbs, true)), boxes: this.mesh(boxMesh()) };
    this.groundArray = gl.createVertexArray();
    gl.bindVertexArray(this.groundArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  mesh({ vertices, indices }) {
    const gl = this.gl, array = gl.createVertexArray(), instances = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices), gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(indices), gl.STATIC_DRAW);
    const attribute = (place, size, stride, offset, divisor) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * stride, 4 * offset);
      gl.vertexAttribDivisor(place, divisor);
    };
    attribute(0, 4, 7, 0, 0);
    attribute(1, 3, 7, 4, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, instances);
    for (let i = 0; i < 4; ++i) attribute(2 + i, 3, FLOATS, 3 * i, 1);
    attribute(6, 4, FLOATS, 12, 1);
    return { array, instances, count: indices.length };
  }

  // Keeps the canvas as large as it is shown; with coarser pixels where a processor draws and takes
  // long, `frame_s` from picture to picture.
  resize(frame_s) {
    if (this.isSoftware) {
      this.slow_s += 0.2 * (frame_s - this.slow_s);
      if (++this.pictures % 10 === 0) {
        const factor = this.slow_s > 0.07 ? 0.8 : this.slow_s < 0.025 ? 1.25 : 1;
        this.scale = clamp(this.scale * factor, 0.4, 1);
      }
    }
    const ratio = this.isSoftware ? this.scale : Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width === width && this.canvas.height === height) return;
    this.canvas.width = width;
    this.canvas.height = height;
  }

  // One picture. ground: {middle, height, shadow: the height on which shadows lie}; colours: {fog,
  // ground, line}. `fixed` casts no shadow.
  draw(toClip, eye, figures, fixed, ground, colours) {
    const gl = this.gl, sun = scale(SUN, 1 / length(SUN));
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...colours.fog, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.useProgram(this.ground.program);
    gl.uniformMatrix4fv(this.ground.uniforms.to_clip, false, toClip);
    gl.uniform4f(this.ground.uniforms.middle, ...ground.middle, ground.height, 0);
    for (const name of ['ground', 'line', 'fog'])
      gl.uniform3f(this.ground.uniforms[name], ...colours[name]);
    gl.bindVertexArray(this.groundArray);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);

    const uniforms = this.figures.uniforms;
    gl.useProgram(this.figures.program);
    gl.uniformMatrix4fv(uniforms.to_clip, false, toClip);
    gl.uniform3f(uniforms.eye, ...eye);
    gl.uniform3f(uniforms.fog, ...colours.fog);
    gl.uniform4f(uniforms.flat_on, ...sun, ground.shadow);
    gl.uniform1i(uniforms.shadow, 0);
    this.drawParts(fixed);
    this.drawParts(figures);
    gl.uniform1i(uniforms.shadow, 1);
    gl.enable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    gl.enable(gl.STENCIL_TEST);  // Each pixel is darkened once.
    gl.stencilFunc(gl.EQUAL, 0, 0xff);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
    this.drawParts(figures);
    gl.disable(gl.STENCIL_TEST);
    gl.enable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
  }

  drawParts(parts) {
    const gl = this.gl;
    for (const [shape, list] of Object.entries(parts.lists)) {
      if (list.length === 0) continue;
      const mesh = this.meshes[shape];
      gl.bindVertexArray(mesh.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, mesh.instances);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(list), gl.STREAM_DRAW);
      gl.drawElementsInstanced(gl.TRIANGLES, mesh.count, gl.UNSIGNED_SHORT, 0, list.length / FLOATS);
    }
  }
}
