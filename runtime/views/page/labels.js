// Labels: the nearest first, and none over another.

class Labels {
  constructor(parent) {
    this.parent = parent;
    this.all = [];
  }

  add(text, kind, colour) {
    const element = document.createElement("span");
    element.textContent = text;
    element.className = kind;
    if (colour) element.style.color = colour;
    this.parent.append(element);
    const label = { element, kind, size: [element.offsetWidth, element.offsetHeight] };
    this.all.push(label);
    return label;
  }

  // `places`: [label, point, whether it is wanted]; agents come before obstacles. `taken`: boxes to keep out of.
  show(places, view, width, height, taken) {
    const seen = [];
    for (const [label, point, wanted] of places) {
      const at = wanted ? projected(view.matrix, point, width, height) : null;
      if (at && at[0] > 0 && at[0] < width && at[1] > 0 && at[1] < height) seen.push([label, at]);
      else label.element.style.visibility = "hidden";
    }
    seen.sort(([a, p], [b, q]) => (a.kind === "agent" ? 0 : 1) - (b.kind === "agent" ? 0 : 1) || p[2] - q[2]);
    for (const [label, [x, y]] of seen) {
      const [w, h] = label.size;
      const box = [x - w / 2 - 2, y - h - 6, x + w / 2 + 2, y - 2];
      const free = taken.every((other) => box[2] < other[0] || box[0] > other[2] || box[3] < other[1] || box[1] > other[3]);
      label.element.style.visibility = free ? "visible" : "hidden";
      if (free) {
        taken.push(box);
        label.element.style.transform = `translate(${Math.round(x - w / 2)}px, ${Math.round(y - h - 4)}px)`;
      }
    }
  }
}
