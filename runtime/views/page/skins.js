// People as a character: where its bones are at a moment, and how far that is from rest.

class Skins {
  constructor(run, figures, drawing) {
    this.figures = figures;
    this.skins = run.skins;
    if (!this.skins.length) return;
    const { rest } = run.character;
    this.count = rest.length / 7;
    this.rest = [...Array(this.count).keys()].map((b) => {
      const [x, y, z, w, ...axis] = rest.subarray(7 * b, 7 * b + 7);
      return { at: [x, y, z], back: [w, ...axis.map((part) => -part)] };
    });
    this.mesh = drawing.skin(run.character);
    this.rows = new Float32Array(12 * this.count); // of each bone the three rows of its matrix
  }

  draw(drawing, moment) {
    for (const skin of this.skins) {
      const placed = this.figures.placed(skin.bones, moment);
      this.rest.forEach(({ at, back }, b) => {
        const turn = product(placed[b][1], back);
        const shift = minus(placed[b][0], turned(turn, at));
        const axes = axesOf(turn);
        for (let row = 0; row < 3; row++)
          this.rows.set([axes[0][row], axes[1][row], axes[2][row], shift[row]], 12 * b + 4 * row);
      });
      drawing.drawSkin(this.mesh, this.rows);
    }
  }
}
