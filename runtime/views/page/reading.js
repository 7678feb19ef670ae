// What the page was given: the header with every array that it names in the place of its entry.

const KINDS = { "<f4": Float32Array, "<u4": Uint32Array, "<i2": Int16Array };

async function readRun() {
  const header = JSON.parse(document.getElementById("header").textContent);
  const text = atob(document.getElementById("arrays").textContent);
  const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const bytes = await new Response(unpacked).arrayBuffer();
  return withArrays(header, bytes);
}

function withArrays(value, bytes) {
  if (value === null || typeof value !== "object") return value;
  if (Array.isArray(value)) return value.map((each) => withArrays(each, bytes));
  if ("kind" in value && "at" in value) {
    const count = value.shape.reduce((product, length) => product * length, 1);
    return Object.assign(new KINDS[value.kind](bytes, value.at, count), { rows: value.shape[0] });
  }
  return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, withArrays(each, bytes)]));
}
