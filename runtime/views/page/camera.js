// The camera: it goes with an agent, or stays where it was moved; it is turned and moved by hand.

class Camera {
  constructor(canvas) {
    this.tall = Math.tan(0.31);
    this.target = [0, 0, 0];
    this.turn = -2.2;
    this.pitch = 0.42;
    this.away = 6;
    this.freed = () => {};
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
    });
    canvas.addEventListener("pointermove", (event) => this.drag(event, canvas));
    for (const kind of ["pointerup", "pointercancel"])
      canvas.addEventListener(kind, (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.nearer(Math.exp(0.0012 * event.deltaY));
    }, { passive: false });
  }

  drag(event, canvas) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const [x, y] = [event.clientX - before.clientX, event.clientY - before.clientY];
    this.pointers.set(event.pointerId, event);
    if (this.pointers.size === 2) {
      const other = [...this.pointers.values()].find((each) => each.pointerId !== event.pointerId);
      const span = (each) => Math.hypot(each.clientX - other.clientX, each.clientY - other.clientY);
      this.nearer(span(before) / Math.max(span(event), 1));
    } else if (event.buttons & 2 || event.shiftKey) {
      this.move(x, y, canvas.clientHeight);
    } else {
      this.turn -= 0.006 * x;
      this.pitch = Math.min(Math.max(this.pitch + 0.006 * y, -0.2), 1.5);
    }
  }

  nearer(factor) {
    this.away = Math.min(Math.max(this.away * factor, 0.5), 2000);
  }

  // A move by hand ends going with anybody.
  move(x, y, height) {
    const scale = (2 * this.away * this.tall) / height;
    const right = [-Math.sin(this.turn), Math.cos(this.turn), 0], ahead = [-Math.cos(this.turn), -Math.sin(this.turn), 0];
    this.target = add(this.target, add(times(right, -x * scale), times(ahead, y * scale)));
    this.freed();
  }

  get eye() {
    const level = this.away * Math.cos(this.pitch);
    return add(this.target, [level * Math.cos(this.turn), level * Math.sin(this.turn), this.away * Math.sin(this.pitch)]);
  }

  view(width, height) {
    const eye = this.eye;
    const matrix = viewMatrix(eye, this.target, this.tall, width / height, 0.02 * this.away, 400 * Math.max(this.away, 5));
    return { eye, matrix };
  }
}
