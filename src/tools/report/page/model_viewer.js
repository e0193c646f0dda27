// Shows the page's model, with WebGL 2 and nothing else: drag turns, right drag or two fingers move, wheel or pinch
// comes nearer. y points down, as in the frame of a camera.
//
// The element #model holds, in base64: of each vertex x, y and z as 16-bit steps of data-step metres from data-low, then of
// each the normal as three bytes (127 is zero), then, if data-colored, red, green and blue; then three numbers of vertices
// a triangle, each as the difference to the number before: the sign is the last bit, seven bits a byte, the lowest first.
// data-way holds x, y, z and a forward direction as six 32-bit floats a pose.
"use strict";

function bytesOf(text) {
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
}

function readModel(element) {
  const vertices = Number(element.dataset.vertices), triangles = Number(element.dataset.triangles);
  const colored = element.dataset.colored === "1", bytes = bytesOf(element.textContent);
  const positions = new Uint16Array(bytes.buffer, 0, 3 * vertices);
  const normals = bytes.subarray(6 * vertices, 9 * vertices);
  const colors = bytes.subarray(9 * vertices, colored ? 12 * vertices : 9 * vertices);
  const indices = new Uint32Array(3 * triangles);
  let at = (colored ? 12 : 9) * vertices, last = 0;
  for (let i = 0; i < indices.length; ++i) {
    let code = 0, shift = 0, byte;
    do {
      byte = bytes[at++];
      code |= (byte & 127) << shift;
      shift += 7;
    } while (byte > 127);
    last += code & 1 ? -((code + 1) >>> 1) : code >>> 1;
    indices[i] = last;
  }
  const way = new Float32Array(bytesOf(element.dataset.way).buffer);
  const low = element.dataset.low.split(" ").map(Number), step = Number(element.dataset.step);
  return { positions, normals, colors, indices, way, colored, low, step };
}

// Vectors of three, and matrices of sixteen numbers, column by column.
const sub = (a, b) => a.map((x, i) => x - b[i]);
const addTimes = (a, b, s) => a.map((x, i) => x + s * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));

function lookAt(eye, forward) {
  const back = unit(forward).map((x) => -x), right = unit(cross([0, -1, 0], back)), up = cross(back, right);
  return [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1];
}

function perspective(height, width, near, far) {
  const f = 1 / Math.tan(width > height ? 0.45 : 0.6);
  return [f * Math.min(height / width, 1), 0, 0, 0, 0, f * Math.min(width / height, 1), 0, 0,
    0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
}

const VERTEX_SHADER = `#version 300 es
uniform mat4 view, projection;
uniform vec3 low;
uniform float step_m;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 color;
out vec3 p_C, n_C, paint;
void main() {
  vec4 p = view * vec4(low + step_m * position, 1.0);
  p_C = p.xyz;
  n_C = mat3(view) * (normal - 127.0);
  paint = color;
  gl_Position = projection * p;
}`;

const FRAGMENT_SHADER = `#version 300 es
precision highp float;
uniform float lit;  // 0: the colour as it is, 1: grey, by the angle alone
uniform vec4 line;  // of the way, where its last is 1
in vec3 p_C, n_C, paint;
out vec4 pixel;
void main() {
  float facing = abs(dot(normalize(n_C), normalize(p_C)));
  vec3 grey = vec3(0.80, 0.84, 0.88) * (0.15 + 0.85 * facing);
  vec3 color = mix(paint * (0.8 + 0.2 * facing), grey, lit) * (gl_FrontFacing ? 1.0 : 0.45);
  pixel = vec4(mix(color, line.rgb, line.a), 1.0);
}`;

function buildProgram(gl) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX_SHADER], [gl.FRAGMENT_SHADER, FRAGMENT_SHADER]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  return (name) => gl.getUniformLocation(program, name);
}

function fill(gl, location, data, type, normalised) {
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, 3, type, normalised, 0, 0);
}

function upload(gl, model) {
  const surface = gl.createVertexArray(), way = gl.createVertexArray();
  gl.bindVertexArray(surface);
  fill(gl, 0, model.positions, gl.UNSIGNED_SHORT, false);
  fill(gl, 1, model.normals, gl.UNSIGNED_BYTE, false);
  if (model.colored) fill(gl, 2, model.colors, gl.UNSIGNED_BYTE, true);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, model.indices, gl.STATIC_DRAW);
  gl.bindVertexArray(way);
  const points = model.way.filter((_, i) => i % 6 < 3);
  fill(gl, 0, points.map((x, i) => (x - model.low[i % 3]) / model.step), gl.FLOAT, false);
  return { surface, way };
}

// The mean of the positions, and twice their deviation from it, as far-away pieces hardly change it.
function spreadOf(model) {
  const count = model.positions.length / 3, sum = [0, 0, 0], squares = [0, 0, 0];
  for (let i = 0; i < model.positions.length; ++i) {
    sum[i % 3] += model.positions[i];
    squares[i % 3] += model.positions[i] ** 2;
  }
  const mean = sum.map((x) => x / count);
  const variances = squares.map((x, axis) => x / count - mean[axis] ** 2);
  const radius = 2 * model.step * Math.sqrt(variances[0] + variances[1] + variances[2]);
  return { middle: addTimes(model.low, mean, model.step), radius: radius || 1 };
}

function show(canvas, tools, model) {
  const gl = canvas.getContext("webgl2", { antialias: true });
  if (!gl) throw new Error("this browser has no WebGL 2");
  const at = buildProgram(gl), arrays = upload(gl, model), poses = model.way.length / 6;
  const { middle, radius } = spreadOf(model);
  const start = () => ({ target: middle, distance: 1.5 * radius, turn: 0.4, rise: 0.75 });
  let camera = start(), flight = null, waiting = false;
  const options = { shaded: !model.colored, way: true, behind: false };

  function view() {
    if (flight === null) {
      const { turn, rise } = camera;
      const back = [Math.cos(rise) * Math.sin(turn), -Math.sin(rise), -Math.cos(rise) * Math.cos(turn)];
      return [addTimes(camera.target, back, camera.distance), back.map((x) => -x)];
    }
    const whole = Math.min(Math.floor(flight), poses - 1), next = Math.min(whole + 1, poses - 1);
    const pose = (i) => [...model.way.subarray(6 * i, 6 * i + 6)];
    const now = addTimes(pose(whole), sub(pose(next), pose(whole)), flight - whole);
    return [now.slice(0, 3), now.slice(3)];
  }

  function draw(eye, forward) {
    const width = (canvas.width = canvas.clientWidth * devicePixelRatio);
    const height = (canvas.height = canvas.clientHeight * devicePixelRatio);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.11, 0.125, 0.15, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(at("view"), false, lookAt(eye, forward));
    gl.uniformMatrix4fv(at("projection"), false, perspective(height, width, radius / 300, 30 * radius));
    gl.uniform3fv(at("low"), model.low);
    gl.uniform1f(at("step_m"), model.step);
    gl.uniform1f(at("lit"), options.shaded ? 1 : 0);
    gl.uniform4f(at("line"), 0, 0, 0, 0);
    if (options.behind) gl.disable(gl.CULL_FACE);
    else gl.enable(gl.CULL_FACE);
    gl.bindVertexArray(arrays.surface);
    gl.drawElements(gl.TRIANGLES, model.indices.length, gl.UNSIGNED_INT, 0);
    gl.uniform4f(at("line"), 1, 0.65, 0.1, 1);
    gl.bindVertexArray(arrays.way);
    if (options.way && flight === null && poses > 1) gl.drawArrays(gl.LINE_STRIP, 0, poses);
  }

  function paint() {
    waiting = false;
    draw(...view());
    if (flight === null) return;
    flight += Math.max(poses / 900, 0.5);
    if (flight > poses - 1) flight = null;
    later();
  }
  function later() {
    if (!waiting) requestAnimationFrame(paint);
    waiting = true;
  }

  const actions = {
    paint: () => (options.shaded = model.colored && !options.shaded),
    way: () => (options.way = !options.way),
    behind: () => (options.behind = !options.behind),
    fly: () => (flight = flight === null && poses > 1 ? 0 : null),
    start: () => ((camera = start()), (flight = null)),
  };
  tools.addEventListener("click", (event) => {
    const action = actions[event.target.dataset.do];
    if (action) action();
    later();
  });
  control(canvas, () => { flight = null; return camera; }, later);
  addEventListener("resize", later);
  later();
}

// Turns, moves and zooms the camera by mouse and fingers.
function control(canvas, cameraNow, changed) {
  const pointers = new Map();
  function move(camera, dx, dy) {
    const scale = (1.2 * camera.distance) / canvas.clientHeight;
    const right = [Math.cos(camera.turn), 0, Math.sin(camera.turn)];
    const forward = [-Math.sin(camera.turn), 0, Math.cos(camera.turn)];
    const down = addTimes(addTimes([0, 0, 0], [0, 1, 0], Math.cos(camera.rise)), forward, -Math.sin(camera.rise));
    camera.target = addTimes(addTimes(camera.target, right, -scale * dx), down, -scale * dy);
  }
  function zoom(camera, factor) {
    camera.distance = Math.min(Math.max(camera.distance * factor, 1e-3), 1e4);
  }
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const camera = cameraNow(), now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (pointers.size === 2) {
      const other = [...pointers.entries()].find(([id]) => id !== event.pointerId)[1];
      const gap = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      zoom(camera, gap(before) / gap(now));
      move(camera, dx / 2, dy / 2);
    } else if (event.buttons & 6 || event.shiftKey) {
      move(camera, dx, dy);
    } else {
      camera.turn -= 0.008 * dx;
      camera.rise = Math.min(Math.max(camera.rise + 0.008 * dy, -1.5), 1.5);
    }
    pointers.set(event.pointerId, now);
    changed();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(cameraNow(), Math.exp(0.001 * event.deltaY));
    changed();
  }, { passive: false });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
}

const element = document.getElementById("model"), canvas = document.getElementById("canvas");
if (element) {
  try {
    show(canvas, document.getElementById("tools"), readModel(element));
  } catch (error) {
    canvas.insertAdjacentHTML("afterend", `<p class="note">The model cannot be shown: ${error.message}.</p>`);
    canvas.remove();
  }
}
