/** Scales packed masks down for the screen: one bit per pixel, most significant first, rows padded to whole bytes. */

export interface Coverage {
  width: number;
  height: number;
  /** The lit fraction of each pixel, 0 to 255. */
  values: Uint8ClampedArray;
}

export interface Rectangle {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** Number of mask pixels per side to merge into one, at `scale` screen pixels per mask pixel: 1, 2, 4 or 8. */
export function factorFor(scale: number): number {
  let factor = 1;
  while (factor < 8 && 2 * factor * scale <= 1) factor *= 2;
  return factor;
}

/** `part` extended to multiples of 8 pixels, within the mask, so that it can be merged by any factor. */
export function wholeBytes({ x, y, width, height }: Rectangle, maskWidth: number, maskHeight: number): Rectangle {
  const down = (value: number): number => Math.max(0, Math.floor(value / 8) * 8);
  const [left, top] = [down(x), down(y)];
  const right = Math.min(maskWidth, Math.ceil((x + width) / 8) * 8);
  const bottom = Math.min(maskHeight, Math.ceil((y + height) / 8) * 8);
  return { x: left, y: top, width: Math.max(0, right - left), height: Math.max(0, bottom - top) };
}

const BITS = Uint8Array.from({ length: 256 }, (_, byte) => {
  let bits = 0;
  for (let rest = byte; rest > 0; rest >>= 1) bits += rest & 1;
  return bits;
});

/** Number of lit pixels. */
export function litPixels(bits: Uint8Array): number {
  let lit = 0;
  for (const byte of bits) lit += BITS[byte] ?? 0;
  return lit;
}

/**
 * Part of a mask with blocks of `factor` × `factor` pixels merged. `factor` is 1, 2, 4 or 8, and `part.x` a multiple of 8, so that no block
 * straddles two bytes. Cost: linear in the bytes of the part.
 */
export function coverage(bits: Uint8Array, maskWidth: number, part: Rectangle, factor: number): Coverage {
  const stride = Math.ceil(maskWidth / 8);
  const outWidth = Math.ceil(part.width / factor);
  const outHeight = Math.ceil(part.height / factor);
  const perByte = 8 / factor;
  const block = (1 << factor) - 1;
  const full = factor * factor;
  const first = part.x / 8;
  const bytes = Math.ceil(part.width / 8);
  const counts = new Uint16Array(outWidth);
  const values = new Uint8ClampedArray(outWidth * outHeight);

  for (let y = 0; y < outHeight; y++) {
    counts.fill(0);
    const end = part.y + Math.min((y + 1) * factor, part.height);
    for (let row = part.y + y * factor; row < end; row++) {
      for (let byte = 0; byte < bytes; byte++) {
        const lit = bits[row * stride + first + byte] ?? 0;
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
