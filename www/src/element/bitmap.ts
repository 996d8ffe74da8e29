/** Packed masks (one bit a pixel, most significant first, rows padded to whole bytes) made smaller for the screen. */

export interface Coverage {
  width: number;
  height: number;
  /** For each pixel the part of it that is lit, 0 to 255. */
  values: Uint8ClampedArray;
}

/** How many times a mask must be halved so that neither side is over `limit`: as a factor 1, 2, 4 or 8. */
export function factorFor(width: number, height: number, limit: number): number {
  let factor = 1;
  while (factor < 8 && Math.max(width, height) / factor > limit) factor *= 2;
  return factor;
}

const BITS = Uint8Array.from({ length: 256 }, (_, byte) => {
  let bits = 0;
  for (let rest = byte; rest > 0; rest >>= 1) bits += rest & 1;
  return bits;
});

/** The mask with blocks of `factor` × `factor` pixels merged; `factor` is 1, 2, 4 or 8, so that no block splits a byte. */
export function coverage(bits: Uint8Array, width: number, height: number, factor: number): Coverage {
  const stride = Math.ceil(width / 8);
  const outWidth = Math.ceil(width / factor);
  const outHeight = Math.ceil(height / factor);
  const perByte = 8 / factor;
  const block = (1 << factor) - 1;
  const full = factor * factor;
  const counts = new Uint16Array(outWidth);
  const values = new Uint8ClampedArray(outWidth * outHeight);

  for (let y = 0; y < outHeight; y++) {
    counts.fill(0);
    const end = Math.min((y + 1) * factor, height);
    for (let row = y * factor; row < end; row++) {
      for (let byte = 0; byte < stride; byte++) {
        const lit = bits[row * stride + byte] ?? 0;
        if (lit === 0) continue;
        for (let k = 0; k < perByte; k++) {
          const x = byte * perByte + k;
          if (x < outWidth) counts[x] = (counts[x] ?? 0) + (BITS[(lit >> (8 - factor * (k + 1))) & block] ?? 0);
        }
      }
    }
    for (let x = 0; x < outWidth; x++) values[y * outWidth + x] = Math.round(((counts[x] ?? 0) * 255) / full);
  }
  return { width: outWidth, height: outHeight, values };
}
