// Draws a world of `surefoot serve`: a click spawns an agent, a click with shift sends all there.
import * as THREE from "three";

const UP = new THREE.Vector3(0, 0, 1);
const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.setSize(innerWidth, innerHeight);
document.body.prepend(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xdfe6ea);
scene.add(new THREE.HemisphereLight(0xffffff, 0x667788, 2.2));
const sun = new THREE.DirectionalLight(0xffffff, 2);
sun.position.set(3, -5, 8);
scene.add(sun);
const camera = new THREE.PerspectiveCamera(50, innerWidth / innerHeight, 0.1, 500);
camera.up.copy(UP);
const view = { middle: new THREE.Vector3(), away: 10, turn: -2.2, rise: 0.9 };

function aim() {
  const level = view.away * Math.cos(view.rise);
  camera.position.set(level * Math.cos(view.turn), level * Math.sin(view.turn), view.away * Math.sin(view.rise));
  camera.position.add(view.middle);
  camera.lookAt(view.middle);
}

// --- the server: requests have promises, the rest goes to what hears it
const socket = new WebSocket(`ws://${location.host}`);
const waiting = new Map();
let lastId = 0;
function ask(type, fields = {}) {
  const id = ++lastId;
  socket.send(JSON.stringify({ type, id, ...fields }));
  return new Promise((resolve, reject) => waiting.set(id, { resolve, reject }));
}
const hears = {
  agent: (message) => addAgent(message.agent),
  gone: (message) => removeAgent(message.agent),
  event: (message) => tell(`${message.event.agent}: ${message.event.kind}`),
  state: (message) => message.agents.forEach(poseAgent),
};
socket.onmessage = ({ data }) => {
  const message = JSON.parse(data);
  if (message.type !== "reply" && message.type !== "error") return hears[message.type](message);
  const promise = waiting.get(message.id);
  waiting.delete(message.id);
  if (message.type === "reply") promise.resolve(message.result);
  else promise.reject(new Error(message.message));
};
socket.onclose = () => tell("the server has gone");

function tell(text) {
  const list = document.getElementById("told");
  const line = document.createElement("li");
  line.textContent = text;
  list.append(line);
  while (list.children.length > 6) list.firstChild.remove();
}

// --- figures: a group for each body of the skeleton, with its capsules and ellipsoids
const agents = new Map();
function addAgent(figure) {
  removeAgent(figure.name); // one of another size
  const groups = figure.bodies.map(() => new THREE.Group());
  const root = new THREE.Group();
  root.add(...groups);
  figure.owner.forEach((owner, k) => {
    const [a, b, c] = figure.size[k];
    let geometry;
    if (figure.round[k]) geometry = new THREE.SphereGeometry(1, 20, 14).scale(a, b, c);
    else geometry = new THREE.CapsuleGeometry(a, 2 * b, 6, 16).rotateX(Math.PI / 2);
    const material = new THREE.MeshStandardMaterial({ color: new THREE.Color(...figure.colour[k]), roughness: 0.8 });
    const shape = new THREE.Mesh(geometry, material);
    place(shape, figure.place[k], 0);
    groups[owner].add(shape);
  });
  agents.set(figure.name, { root, groups });
  scene.add(root);
}
function removeAgent(name) {
  agents.get(name)?.root.removeFromParent();
  agents.delete(name);
}
function place(object, numbers, at) {
  object.position.set(numbers[at], numbers[at + 1], numbers[at + 2]);
  object.quaternion.set(numbers[at + 4], numbers[at + 5], numbers[at + 6], numbers[at + 3]);
}
function poseAgent(state) {
  agents.get(state.name)?.groups.forEach((group, k) => place(group, state.transforms, 7 * k));
}

// --- the level
let ground;
function drawLevel({ vertices, faces }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(faces.flat().flatMap((v) => vertices[v]), 3));
  geometry.computeVertexNormals();
  ground = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0xb9b2a3, side: THREE.DoubleSide }));
  scene.add(ground);
  geometry.computeBoundingSphere();
  view.middle.copy(geometry.boundingSphere.center);
  view.away = 1.6 * geometry.boundingSphere.radius;
}

// --- the mouse
function spotUnder(event) {
  const ray = new THREE.Raycaster();
  ray.setFromCamera(new THREE.Vector2((2 * event.clientX) / innerWidth - 1, 1 - (2 * event.clientY) / innerHeight), camera);
  const hit = ray.intersectObject(ground).find((each) => Math.abs(each.face.normal.z) > 0.7);
  return hit?.point.toArray();
}
let dragged = 0;
renderer.domElement.onpointerdown = () => (dragged = 0);
renderer.domElement.onpointermove = (event) => {
  if (!event.buttons) return;
  dragged += Math.abs(event.movementX) + Math.abs(event.movementY);
  view.turn -= 0.005 * event.movementX;
  view.rise = Math.min(Math.max(view.rise + 0.005 * event.movementY, 0.1), 1.5);
};
renderer.domElement.onwheel = (event) => (view.away *= Math.exp(0.001 * event.deltaY));
renderer.domElement.onclick = async (event) => {
  const spot = dragged < 5 && ground && spotUnder(event);
  if (!spot) return;
  try {
    if (event.shiftKey) {
      for (const agent of agents.keys()) await ask("go_to", { world, agent, points: [spot] });
    } else {
      await ask("spawn", { world, body: document.getElementById("body").value, at: spot });
    }
  } catch (error) {
    tell(error.message);
  }
};
onresize = () => {
  renderer.setSize(innerWidth, innerHeight);
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
};

let world;
socket.onopen = async () => {
  const { levels } = await ask("hello", { version: 2, token: new URLSearchParams(location.search).get("token") ?? "" });
  drawLevel(await ask("level", { level: levels[0] }));
  ({ world } = await ask("create", { level: levels[0], states: "world" }));
  tell(`${world} on ${levels[0]}`);
};
renderer.setAnimationLoop(() => {
  aim();
  renderer.render(scene, camera);
});
