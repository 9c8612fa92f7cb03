// Unpacks the series of an episode: base64 of deflated bytes that workbench/report/blob.cpp writes.

async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Reads numbers of `width` bytes, stored byte by byte of all numbers.
function words(bytes, at, count, width) {
  const all = new Uint32Array(count);
  for (let byte = 0; byte < width; byte++)
    for (let i = 0; i < count; i++) all[i] |= bytes[at + byte * count + i] << (8 * byte);
  return all;
}

const readers = {
  exact(bytes, at, part) {
    return { values: new Float32Array(words(bytes, at, part.count, 4).buffer), size: 4 };
  },
  rounded(bytes, at, part) {
    const values = new Float64Array(part.count);
    const step = (part.high - part.low) / part.parts;
    let before = 0;
    words(bytes, at, part.count, 2).forEach((difference, i) => {
      before = (before + difference) & 0xffff;
      const value = before >= 32768 ? before - 65536 : before;
      values[i] = value === -32768 ? NaN
        : value === -32767 ? -Infinity
        : value === 32767 ? Infinity
        : part.low + (value + part.parts / 2) * step;
    });
    return { values, size: 2 };
  },
  whole(bytes, at, part) {
    return { values: words(bytes, at, part.count, part.bytes), size: part.bytes };
  },
};

// Returns {steps, buckets, why, tracks}. A track, by kind and index, is a list of series: one,
// or two with the least and the greatest numbers of each bucket.
async function unpack(text) {
  const bytes = await inflated(text);
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  let at = 4 + length;
  const tracks = {};
  for (const track of head.tracks) {
    const series = track.parts.map((part) => {
      const read = readers[part.type](bytes, at, part);
      at += read.size * part.count;
      return read.values;
    });
    (tracks[track.of] ??= [])[track.index] = series;
  }
  return { steps: head.steps, buckets: head.buckets, why: head.why, tracks };
}
