// Vectors [x, y, z], quaternions [w, x, y, z], matrices of 16 numbers column by column.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, k) => [a[0] * k, a[1] * k, a[2] * k];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(a, 1 / Math.max(Math.hypot(a[0], a[1], a[2]), 1e-12));
const mix = (a, b, share) => a.map((value, k) => value + share * (b[k] - value));

function turned(q, v) {
  const axis = [q[1], q[2], q[3]];
  const twice = times(cross(axis, v), 2);
  return add(add(v, times(twice, q[0])), cross(axis, twice));
}

function product(p, q) {
  return [
    p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
    p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
    p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
    p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
  ];
}

// Quaternions along the chord of the shorter arc.
function between(p, q, share) {
  const side = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] < 0 ? -1 : 1;
  const mixed = p.map((value, k) => value + share * (side * q[k] - value));
  const length = Math.hypot(...mixed);
  return mixed.map((value) => value / length);
}

// The matrix that sees from `eye` towards `target`, Z up: `tall` is the tangent of half the height of the picture.
function viewMatrix(eye, target, tall, aspect, near, far) {
  const back = unit(minus(eye, target));
  const right = unit(cross([0, 0, 1], back));
  const up = cross(back, right);
  const depth = 1 / (near - far);
  const x = 1 / (tall * aspect), y = 1 / tall, z = (near + far) * depth;
  const columns = [0, 1, 2].map((k) => [x * right[k], y * up[k], z * back[k], -back[k]]);
  columns.push([-x * dot(right, eye), -y * dot(up, eye), -z * dot(back, eye) + 2 * near * far * depth, dot(back, eye)]);
  return new Float32Array(columns.flat());
}

// Where on the page a point is: [x, y, depth in metres], null when it is behind the eye.
function projected(matrix, point, width, height) {
  const [x, y, , w] = [0, 1, 2, 3].map((row) =>
    matrix[row] * point[0] + matrix[4 + row] * point[1] + matrix[8 + row] * point[2] + matrix[12 + row]);
  return w > 0.05 ? [(0.5 + 0.5 * x / w) * width, (0.5 - 0.5 * y / w) * height, w] : null;
}

// Unit ball and open unit tube (along z) as triangles: positions are normals, too.
function ballMesh(rings = 10, sides = 16) {
  const corner = (i, j) => {
    const down = (Math.PI * i) / rings, round = (2 * Math.PI * j) / sides;
    return [Math.sin(down) * Math.cos(round), Math.sin(down) * Math.sin(round), Math.cos(down)];
  };
  return gridMesh(rings, sides, corner);
}

function tubeMesh(sides = 16) {
  return gridMesh(1, sides, (i, j) => {
    const round = (2 * Math.PI * j) / sides;
    return [Math.cos(round), Math.sin(round), 1 - 2 * i];
  });
}

function gridMesh(rows, columns, corner) {
  const points = [];
  for (let i = 0; i < rows; i++)
    for (let j = 0; j < columns; j++) {
      const [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
      points.push(...a, ...b, ...c, ...a, ...c, ...d);
    }
  return new Float32Array(points);
}
