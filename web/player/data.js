// Unpacking of what quadcore/report/packing.py packs.

/** Decompress base 64 of zlib's format. */
export async function inflate(text) {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Read numbers of single precision: first the lowest byte of each, then the next byte of each. */
export function readNumbers(bytes) {
  const count = bytes.length / 4;
  const joined = new Uint8Array(bytes.length);
  for (let i = 0; i < count; ++i) {
    for (let part = 0; part < 4; ++part) joined[4 * i + part] = bytes[part * count + i];
  }
  return new Float32Array(joined.buffer);
}

/** Replace each {at, count, kind} in a structure by its numbers. */
export function fillNumbers(value, numbers) {
  if (Array.isArray(value)) return value.map((entry) => fillNumbers(entry, numbers));
  if (value === null || typeof value !== "object") return value;
  if ("at" in value && "count" in value) return numbers.subarray(value.at, value.at + value.count);
  const filled = {};
  for (const key of Object.keys(value)) filled[key] = fillNumbers(value[key], numbers);
  return filled;
}
