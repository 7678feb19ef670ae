// Everything that talks to the graphics card: the level, lines, balls and tubes in many copies, and skins.

// a surface in its own colour under the sun
const SHADED = `
    in vec3 normal, own;
    out vec4 colour;
    void main() {
      vec3 n = normalize(normal);
      colour = vec4(own * (0.50 + 0.15 * n.z + 0.50 * max(dot(n, sun), 0.0)), 1.0);
    }`;

const SHADERS = {
  level: [`
    in vec3 place;
    out vec3 at;
    void main() { at = place; gl_Position = view * vec4(place, 1.0); }`, `
    in vec3 at;
    uniform vec4 feet[16];
    uniform vec3 target;
    uniform float open;
    out vec4 colour;
    void main() {
      // what stands between the eye and whom the camera goes with is left out
      vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
      vec3 sight = target - eye, there = at - eye;
      float share = dot(there, sight) / dot(sight, sight);
      bool under = normal.z > 0.5 && at.z < target.z;
      float aside = length(there - share * sight);
      if (open > 0.0 && !under && length(sight) * (1.0 - share) > 0.1 * open + 0.6 * aside
          && aside < open * (0.35 + 0.65 * share)) discard;
      bool floor_ = normal.z > 0.6;
      vec3 own = floor_ ? vec3(0.80, 0.79, 0.76) : vec3(0.70, 0.67, 0.63);
      vec2 tile = floor(at.xy + 1e-3);
      if (floor_ && mod(tile.x + tile.y, 2.0) > 0.5) own *= 0.93;
      float shade = 1.0;
      for (int k = 0; k < 16; k++) {
        float above = feet[k].z - at.z;
        float away = length(feet[k].xy - at.xy) / max(feet[k].w, 1e-3);
        if (feet[k].w > 0.0 && above > 0.0 && above < 6.0 * feet[k].w)
          shade = min(shade, 1.0 - 0.45 * (1.0 - smoothstep(0.35, 1.0, away)));
      }
      colour = vec4(own * (0.55 + 0.12 * normal.z + 0.40 * max(dot(normal, sun), 0.0)) * shade, 1.0);
    }`],
  shapes: [`
    in vec3 place;
    in mat4 pose;
    in vec3 tint;
    uniform float round_;
    out vec3 normal, own;
    void main() {
      vec3 along = vec3(place.xy, place.z * round_);
      mat3 turn = mat3(pose);
      vec3 scale = vec3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2]));
      normal = turn * (along / max(scale, 1e-9));
      own = tint;
      gl_Position = view * pose * vec4(place, 1.0);
    }`, SHADED],
  // each bone is three texels: the rows of the matrix that moves it from rest
  skin: [`
    in vec3 place, outward, tint;
    in vec4 bone, share;
    uniform sampler2D rows;
    out vec3 normal, own;
    void main() {
      vec4 sum[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
      for (int k = 0; k < 4; k++)
        for (int row = 0; row < 3; row++) sum[row] += share[k] * texelFetch(rows, ivec2(row, int(bone[k])), 0);
      vec4 at = vec4(place, 1.0);
      normal = vec3(dot(sum[0].xyz, outward), dot(sum[1].xyz, outward), dot(sum[2].xyz, outward));
      own = tint;
      gl_Position = view * vec4(dot(sum[0], at), dot(sum[1], at), dot(sum[2], at), 1.0);
    }`, SHADED],
  // a segment is a strip of two triangles, so many pixels wide
  lines: [`
    in vec3 begin, end;
    uniform vec2 pixel;
    uniform float width;
    void main() {
      vec4 a = view * vec4(begin, 1.0), b = view * vec4(end, 1.0);
      float near = 0.02;
      if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
      if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
      vec2 along = (b.xy / b.w - a.xy / a.w) / pixel;
      along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
      vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1) * 2.0 - 1.0);
      vec4 here = corner.x > 0.5 ? b : a;
      here.xy += (vec2(-along.y, along.x) * corner.y + along * (corner.x * 2.0 - 1.0)) * 0.5 * width * pixel * here.w;
      here.z -= 2e-4 * here.w;
      gl_Position = here;
    }`, `
    uniform vec4 tint;
    out vec4 colour;
    void main() { colour = tint; }`],
};
const HEAD = `#version 300 es
  precision highp float;
  uniform mat4 view;
  uniform vec3 eye;
  const vec3 sun = vec3(0.348, -0.497, 0.795);
`;

class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", { antialias: true });
    if (!this.gl) throw new Error("this browser does not show WebGL 2");
    const gl = this.gl;
    this.programs = Object.fromEntries(Object.entries(SHADERS).map(([name, [vertex, fragment]]) =>
      [name, this.program(HEAD + vertex, HEAD + fragment)]));
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.ball = this.shapes(ballMesh());
    this.tube = this.shapes(tubeMesh());
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    return { program, at: (name) => gl.getUniformLocation(program, name) };
  }

  buffer(data, target = this.gl.ARRAY_BUFFER) {
    const made = this.gl.createBuffer();
    this.gl.bindBuffer(target, made);
    this.gl.bufferData(target, data, this.gl.STATIC_DRAW);
    return made;
  }

  // An attribute of `size` numbers from the bound buffer; `step` 1: one value for each copy.
  attribute(program, name, size, stride, offset, step) {
    const gl = this.gl, index = gl.getAttribLocation(program.program, name);
    for (let column = 0; column < Math.ceil(size / 4); column++) {
      gl.enableVertexAttribArray(index + column);
      gl.vertexAttribPointer(index + column, Math.min(size, 4), gl.FLOAT, false, stride, offset + 16 * column);
      gl.vertexAttribDivisor(index + column, step);
    }
  }

  level(vertices, faces) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    this.buffer(vertices);
    this.attribute(this.programs.level, "place", 3, 0, 0, 0);
    this.buffer(faces, gl.ELEMENT_ARRAY_BUFFER);
    return { array, count: faces.length };
  }

  // `ends`: six numbers for each segment.
  lines(ends, colour, width) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    this.buffer(ends instanceof Float32Array ? ends : new Float32Array(ends));
    this.attribute(this.programs.lines, "begin", 3, 24, 0, 1);
    this.attribute(this.programs.lines, "end", 3, 24, 12, 1);
    return { array, count: ends.length / 6, colour, width };
  }

  shapes(mesh) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    this.buffer(mesh);
    this.attribute(this.programs.shapes, "place", 3, 0, 0, 0);
    const copies = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, copies);
    this.attribute(this.programs.shapes, "pose", 16, 76, 0, 1);
    this.attribute(this.programs.shapes, "tint", 3, 76, 64, 1);
    return { array, copies, count: mesh.length / 3 };
  }

  // A character's mesh: every face has corners of its own, since its colour is the face's.
  skin({ points, normals, bones, shares, faces, colours }) {
    const gl = this.gl, array = gl.createVertexArray(), program = this.programs.skin;
    const corners = new Float32Array(17 * faces.length);
    faces.forEach((point, k) => {
      corners.set(points.subarray(3 * point, 3 * point + 3), 17 * k);
      corners.set(normals.subarray(3 * point, 3 * point + 3), 17 * k + 3);
      corners.set(colours.subarray(3 * Math.floor(k / 3), 3 * Math.floor(k / 3) + 3), 17 * k + 6);
      corners.set(bones.subarray(4 * point, 4 * point + 4), 17 * k + 9);
      corners.set(shares.subarray(4 * point, 4 * point + 4), 17 * k + 13);
    });
    gl.bindVertexArray(array);
    this.buffer(corners);
    let at = 0;
    for (const [name, size] of [["place", 3], ["outward", 3], ["tint", 3], ["bone", 4], ["share", 4]]) {
      this.attribute(program, name, size, 68, 4 * at, 0);
      at += size;
    }
    const rows = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, rows);
    for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, which, gl.NEAREST);
    return { array, rows, count: faces.length };
  }

  begin(view) {
    const gl = this.gl, ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((n) => Math.round(n * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.80, 0.87, 0.93, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.pixel = [2 / width, 2 / height];
    this.ratio = ratio;
    this.view = view;
  }

  use(program) {
    this.gl.useProgram(program.program);
    this.gl.uniformMatrix4fv(program.at("view"), false, this.view.matrix);
    this.gl.uniform3fv(program.at("eye"), this.view.eye);
  }

  drawLevel(level, feet, target, open) {
    const gl = this.gl, program = this.programs.level;
    this.use(program);
    gl.uniform4fv(program.at("feet"), feet);
    gl.uniform3fv(program.at("target"), target);
    gl.uniform1f(program.at("open"), open);
    gl.enable(gl.CULL_FACE);
    gl.bindVertexArray(level.array);
    gl.drawElements(gl.TRIANGLES, level.count, gl.UNSIGNED_INT, 0);
    gl.disable(gl.CULL_FACE);
  }

  drawLines(lines) {
    const gl = this.gl, program = this.programs.lines;
    if (!lines.count) return;
    this.use(program);
    gl.uniform2fv(program.at("pixel"), this.pixel);
    gl.uniform1f(program.at("width"), lines.width * this.ratio);
    gl.uniform4fv(program.at("tint"), lines.colour);
    gl.bindVertexArray(lines.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
  }

  // `rows`: twelve numbers for each bone, a matrix row by row.
  drawSkin(skin, rows) {
    const gl = this.gl, program = this.programs.skin;
    this.use(program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, skin.rows);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, 3, rows.length / 12, 0, gl.RGBA, gl.FLOAT, rows);
    gl.uniform1i(program.at("rows"), 0);
    gl.bindVertexArray(skin.array);
    gl.drawArrays(gl.TRIANGLES, 0, skin.count);
  }

  // `copies`: 19 numbers each, a matrix and a colour.
  drawShapes(shape, copies, count) {
    const gl = this.gl, program = this.programs.shapes;
    this.use(program);
    gl.uniform1f(program.at("round_"), shape === this.ball ? 1 : 0);
    gl.bindVertexArray(shape.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, shape.copies);
    gl.bufferData(gl.ARRAY_BUFFER, copies.subarray(0, 19 * count), gl.STREAM_DRAW);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, shape.count, count);
  }
}
