// The page: layers, time line, events, and a picture of every moment.

const OBSTACLES = [0.82, 0.29, 0.36];
const PATHS = { raw: [0.47, 0.47, 0.47], pulled: [0.12, 0.47, 0.71], smooth: [0.84, 0.15, 0.16] };
const NOBODY = "nobody";
const SAID = 2.5; // [s] that what has happened is told
const $ = (id) => document.getElementById(id);
const css = (colour) => `rgb(${colour.map((part) => Math.round(255 * part)).join(",")})`;

class Page {
  constructor(run) {
    this.run = run;
    this.drawing = new Drawing($("canvas"));
    this.camera = new Camera($("canvas"));
    this.figures = new Figures(run);
    this.skins = new Skins(run, this.figures, this.drawing);
    this.labels = new Labels($("labels"));
    this.layers = {};
    this.begin = run.times[0];
    this.end = run.times[run.times.length - 1];
    this.moment = this.begin;
    this.playing = true;
    this.makeLevel();
    this.makePaths();
    this.names = run.agents.map((agent) => this.labels.add(agent.name, "agent"));
    this.makeControls();
    this.makeEvents();
    this.follow(run.follow);
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  // --- what there is
  layer(name, title, colour, shown) {
    const label = document.createElement("label"), box = document.createElement("input"), swatch = document.createElement("i");
    box.type = "checkbox";
    box.checked = shown;
    box.id = `layer-${name}`;
    if (colour) {
      swatch.className = "swatch";
      swatch.style.background = css(colour);
    }
    label.append(box, swatch, title);
    $("layers").append(label);
    this.layers[name] = { box, lines: [] };
    return this.layers[name];
  }

  makeLevel() {
    const { level } = this.run, drawing = this.drawing;
    this.layer("level", " level", null, true);
    this.surface = drawing.level(level.vertices, level.faces);
    const lift = (points, by) => points.map((value, k) => (k % 3 === 2 ? value + by : value));
    const rims = Object.fromEntries(Object.keys(level.colours).map((affordance) => [affordance, []]));
    const layer = this.layer("obstacles", " obstacles", Object.values(level.colours)[0] || OBSTACLES, true);
    this.tags = level.obstacles.map(({ affordance, label }, k) => {
      const rim = lift(Array.from(level.rims.subarray(6 * k, 6 * k + 6)), 0.05);
      rims[affordance].push(...rim);
      const middle = mix(rim.slice(0, 3), rim.slice(3), 0.5);
      return [this.labels.add(label, "obstacle", css(level.colours[affordance])), add(middle, [0, 0, 0.25])];
    });
    for (const [affordance, ends] of Object.entries(rims)) layer.lines.push(drawing.lines(ends, [...level.colours[affordance], 1], 5));
    this.layer("labels", " labels", null, true);
    const graph = this.layer("graph", " graph", [0.16, 0.62, 0.56], false);
    const circles = [];
    for (let k = 0; k < level.discs.length; k += 4) {
      const [x, y, z, radius] = level.discs.subarray(k, k + 4);
      const corner = (i) => [x + radius * Math.cos((i * Math.PI) / 12), y + radius * Math.sin((i * Math.PI) / 12), z + 0.04];
      for (let i = 0; i < 24; i++) circles.push(...corner(i), ...corner(i + 1));
    }
    graph.lines.push(drawing.lines(circles, [0.16, 0.62, 0.56, 0.6], 1));
    graph.lines.push(drawing.lines(lift(level.edges, 0.04), [0.08, 0.43, 0.39, 0.8], 1.5));
  }

  makePaths() {
    const titles = { raw: " A* path through the discs", pulled: " pulled path", smooth: " smoothed path" };
    Object.entries(titles).forEach(([name, title], height) => {
      const ends = [], lift = [0, 0, 0.05 + 0.02 * height];
      for (const agent of this.run.agents)
        for (const path of agent.paths) {
          const points = path[name];
          for (let k = 0; k + 5 < points.length; k += 3)
            ends.push(...add(points.subarray(k, k + 3), lift), ...add(points.subarray(k + 3, k + 6), lift));
        }
      const layer = this.layer(name, title, PATHS[name], name !== "raw");
      layer.lines.push(this.drawing.lines(ends, [...PATHS[name], 0.9], name === "smooth" ? 3.5 : 2.5));
    });
    this.layer("figures", " figures", null, true);
    this.layer("open", " see through walls before the figure", null, true);
  }

  makeControls() {
    const { agents } = this.run;
    for (const name of [...agents.map((agent) => agent.name), NOBODY]) $("follow").add(new Option(name, name));
    $("follow").addEventListener("change", () => this.follow($("follow").value));
    this.camera.freed = () => this.follow(NOBODY);
    $("play").addEventListener("click", () => this.play(!this.playing));
    $("time").max = this.end - this.begin;
    $("time").addEventListener("input", () => this.goTo(this.begin + Number($("time").value)));
    document.addEventListener("keydown", (event) => {
      if (event.target.tagName === "SELECT" || event.target.type === "checkbox") return;
      const step = { ArrowLeft: -0.1, ArrowRight: 0.1 }[event.key];
      if (event.key === " ") this.play(!this.playing);
      else if (step) this.goTo(this.moment + step);
      else return;
      event.preventDefault();
    });
    const wanted = new URLSearchParams(location.hash.slice(1));
    if (wanted.has("t")) this.goTo(Number(wanted.get("t")));
  }

  makeEvents() {
    this.told = this.run.events.map((event) => {
      const button = document.createElement("button"), mark = document.createElement("i");
      button.textContent = `${event.time.toFixed(2)} s  ${event.text}`;
      button.addEventListener("click", () => {
        this.follow(event.agent);
        this.goTo(event.time);
      });
      $("events").append(button);
      mark.style.left = `${(100 * (event.time - this.begin)) / Math.max(this.end - this.begin, 1e-9)}%`;
      mark.title = event.text;
      $("marks").append(mark);
      return { ...event, button };
    });
  }

  // --- what is done
  follow(name) {
    this.followed = this.run.agents.find((agent) => agent.name === name) || null;
    $("follow").value = this.followed ? name : NOBODY;
    if (this.followed && !this.near) {
      this.camera.away = 3.4 * this.followed.size;
      this.near = true;
    }
  }

  play(playing) {
    if (playing && this.moment >= this.end) this.moment = this.begin;
    this.playing = playing;
  }

  goTo(moment) {
    this.moment = Math.min(Math.max(moment, this.begin), this.end);
    this.playing = false;
  }

  tick(now) {
    const passed = Math.min((now - this.last) / 1000, 0.25);
    this.last = now;
    if (this.playing) {
      this.moment = Math.min(this.moment + passed * Number($("pace").value), this.end);
      if (this.moment >= this.end) this.playing = false;
    }
    this.draw();
    requestAnimationFrame((next) => this.tick(next));
  }

  draw() {
    const { drawing, camera, figures, moment } = this;
    const shown = (name) => this.layers[name].box.checked;
    if (this.followed) camera.target = figures.calm(this.followed, moment);
    const width = drawing.canvas.clientWidth, height = drawing.canvas.clientHeight;
    const view = camera.view(width, height);
    drawing.begin(view);
    const roots = this.run.agents.map((agent) => figures.root(agent, moment));
    if (shown("level")) {
      const open = this.followed && shown("open") ? 0.75 * this.followed.size : 0;
      drawing.drawLevel(this.surface, this.feet(roots, camera.target), camera.target, open);
    }
    if (shown("figures")) {
      const { balls, tubes } = figures.pose(moment);
      if (balls) drawing.drawShapes(drawing.ball, figures.balls, balls);
      if (tubes) drawing.drawShapes(drawing.tube, figures.tubes, tubes);
      this.skins.draw(drawing, moment);
    }
    for (const [name, layer] of Object.entries(this.layers))
      if (shown(name)) for (const lines of layer.lines) drawing.drawLines(lines);
    const names = this.names.map((label, k) => [label, add(roots[k], [0, 0, 0.6 * this.run.agents[k].size]), shown("labels") && shown("figures")]);
    const tags = this.tags.map(([label, point]) => [label, point, shown("labels") && shown("obstacles")]);
    const taken = [$("panel"), $("bar"), $("said")].map((each) => each.getBoundingClientRect());
    this.labels.show([...names, ...tags], view, width, height, taken.map((box) => [box.left, box.top, box.right, box.bottom]));
    this.tell();
  }

  // Where the sixteen nearest figures throw their shadows: x, y, z and radius of each.
  feet(roots, target) {
    const near = roots.map((root, k) => [Math.hypot(...minus(root, target)), root, 0.3 * this.run.agents[k].size]);
    near.sort((a, b) => a[0] - b[0]);
    const feet = new Float32Array(64);
    near.slice(0, 16).forEach(([, root, radius], k) => feet.set([...root, radius], 4 * k));
    return feet;
  }

  tell() {
    $("time").value = this.moment - this.begin;
    $("clock").textContent = `${this.moment.toFixed(2)} of ${this.end.toFixed(2)} s`;
    $("play").textContent = this.playing ? "❚❚" : "▶";
    let latest = "";
    for (const event of this.told) {
      const past = event.time <= this.moment + 1e-3;
      event.button.classList.toggle("past", past);
      if (past && this.moment - event.time < SAID) latest = event.text;
    }
    $("said").textContent = latest;
  }
}

readRun().then((run) => { window.surefoot = new Page(run); }).catch((error) => {
  document.body.textContent = `This page cannot be shown: ${error.message}`;
});
