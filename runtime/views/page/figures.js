// Figures: where their bodies are at a moment, as balls and tubes.

const WIDEST = 32767;

class Figures {
  constructor(run) {
    this.times = run.times;
    this.agents = run.agents;
    this.skins = new Map(run.skins.map((skin) => [run.agents[skin.agent], skin]));
    let balls = 0, tubes = 0;
    for (const agent of run.agents)
      for (const round of agent.round) round ? balls++ : ((balls += 2), tubes++);
    this.balls = new Float32Array(19 * balls);
    this.tubes = new Float32Array(19 * tubes);
  }

  // The frame before `moment` and the share of the way to the next.
  frame(moment) {
    const times = this.times;
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      times[middle] <= moment ? (low = middle) : (high = middle);
    }
    if (high <= low) return [0, 0, 0];
    return [low, high, Math.min(Math.max((moment - times[low]) / (times[high] - times[low]), 0), 1)];
  }

  // Place and turn of each body of `poses` at a moment.
  placed(poses, moment) {
    const [before, after, share] = this.frame(moment);
    const bodies = poses.positions.length / 3 / poses.positions.rows, placed = [];
    for (let body = 0; body < bodies; body++) {
      const [a, b] = [before * bodies + body, after * bodies + body];
      placed.push([
        mix(poses.positions.subarray(3 * a, 3 * a + 3), poses.positions.subarray(3 * b, 3 * b + 3), share),
        between(turn(poses.turns, a), turn(poses.turns, b), share),
      ]);
    }
    return placed;
  }

  // Whether body `owner` of an agent is seen: things are while they are held, the others unless a skin is.
  seen(agent, owner, before) {
    if (owner < agent.own) return !this.skins.has(agent);
    return Boolean(agent.held[(agent.held.length / agent.held.rows) * before + owner - agent.own]);
  }

  // Fills `balls` and `tubes` and gives how many there are.
  pose(moment) {
    const [before] = this.frame(moment);
    let balls = 0, tubes = 0;
    for (const agent of this.agents) {
      const placed = this.placed(agent, moment), skin = this.skins.get(agent);
      if (skin && skin.things) placed.splice(agent.own, placed.length, ...this.placed(skin.things, moment));
      for (let k = 0; k < agent.owner.length; k++) {
        if (!this.seen(agent, agent.owner[k], before)) continue;
        const [at, q] = placed[agent.owner[k]];
        const own = Array.from(agent.place.subarray(7 * k, 7 * k + 7));
        const middle = add(at, turned(q, own.slice(0, 3)));
        const axes = axesOf(product(q, own.slice(3)));
        const [sx, sy, sz] = agent.sizes.subarray(3 * k, 3 * k + 3);
        const colour = agent.colours.subarray(3 * k, 3 * k + 3);
        if (agent.round[k]) {
          put(this.balls, balls++, axes, [sx, sy, sz], middle, colour);
        } else {
          put(this.tubes, tubes++, axes, [sx, sx, sy], middle, colour);
          for (const end of [-sy, sy]) put(this.balls, balls++, axes, [sx, sx, sx], add(middle, times(axes[2], end)), colour);
        }
      }
    }
    return { balls, tubes };
  }

  // Where an agent's root is, evened out.
  calm(agent, moment) {
    const [before, after, share] = this.frame(moment);
    return Array.from(mix(agent.calm.subarray(3 * before, 3 * before + 3), agent.calm.subarray(3 * after, 3 * after + 3), share));
  }

  root(agent, moment) {
    const [before, after, share] = this.frame(moment);
    const row = (agent.positions.length / agent.positions.rows);
    return Array.from(mix(agent.positions.subarray(row * before, row * before + 3), agent.positions.subarray(row * after, row * after + 3), share));
  }
}

const turn = (turns, k) => [0, 1, 2, 3].map((part) => turns[4 * k + part] / WIDEST);
const axesOf = (q) => [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => turned(q, axis));

function put(copies, k, axes, sizes, middle, colour) {
  const at = 19 * k;
  for (let column = 0; column < 3; column++) {
    copies.set(times(axes[column], sizes[column]), at + 4 * column);
    copies[at + 4 * column + 3] = 0;
  }
  copies.set(middle, at + 12);
  copies[at + 15] = 1;
  copies.set(colour, at + 16);
}
