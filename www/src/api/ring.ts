/** Corners of the two triangles of a quad, as bits along and across the ring. */
const [ALONG, ACROSS] = ["011010", "001011"];

/** A small closed model: a ring of `2 × parts²` facets, nine numbers each, in mm. */
export function ring(parts: number): Float32Array {
  const angle = (step: number): number => (2 * Math.PI * (step % parts)) / parts;
  const corners = Array.from({ length: 6 * parts * parts }, (_, k) => {
    const quad = Math.floor(k / 6);
    const turn = angle(Math.floor(quad / parts) + Number(ALONG[k % 6]));
    const bend = angle(quad + Number(ACROSS[k % 6]));
    const out = 3 + Math.cos(bend);
    return [out * Math.cos(turn), out * Math.sin(turn), Math.sin(bend)];
  });
  return Float32Array.from(corners.flat());
}
