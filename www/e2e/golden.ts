/**
 * Recorded pictures of the page: so small that fonts and rasterisers make little difference, and large enough that a
 * missing, moved or wrongly coloured panel makes a great one.
 */
import { existsSync } from "node:fs";
import { mkdir, mkdtemp, readFile, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { decode, encode } from "fast-png";

const FOLDER = fileURLToPath(new URL("./goldens/", import.meta.url));

/** Largest width of a recorded picture, pixels, and pixels of a narrow page per recorded pixel. */
const WIDTH = 96;
const SHRINK = 8;
/** Step between the recorded levels of a channel: a larger one makes smaller files. */
const STEP = 8;
/** Side of the squares of which the worst counts, pixels. */
const BLOCK = 6;
/** Chroma counts less than luma, as it does for the eye. */
const CHROMA_PART = 0.5;

/** The differences allowed, as fractions of the range from black to white. */
export const TOLERANCE = { mean: 0.02, worst: 0.14, height: 0.04 };

export interface Picture {
  width: number;
  height: number;
  /** Red, green, blue, 0 to 255. */
  data: Uint8Array;
}

export interface Difference {
  mean: number;
  /** Of the square of {@link BLOCK} pixels that differs most. */
  worst: number;
  /** Of the heights, as a fraction of the golden's. */
  height: number;
}

/** Reduces a picture to `wide` by `high` cells, each the mean of the pixels that it covers. */
function averaged({ width, height, data }: Picture, wide: number, high: number, channels = 3): Picture {
  const out = new Uint8Array(3 * wide * high);
  for (let y = 0; y < high; y++) {
    const [top, bottom] = [Math.floor((y * height) / high), Math.max(Math.ceil(((y + 1) * height) / high), 1)];
    for (let x = 0; x < wide; x++) {
      const [left, right] = [Math.floor((x * width) / wide), Math.max(Math.ceil(((x + 1) * width) / wide), 1)];
      const area = (bottom - top) * (right - left);
      for (let channel = 0; channel < 3; channel++) {
        let sum = 0;
        for (let row = top; row < bottom; row++) {
          for (let column = left; column < right; column++) sum += data[channels * (row * width + column) + channel] ?? 0;
        }
        out[3 * (y * wide + x) + channel] = sum / area;
      }
    }
  }
  return { width: wide, height: high, data: out };
}

/** Reduces a screenshot to what is recorded. */
export function small(screenshot: Uint8Array): Picture {
  const { width, height, data, channels } = decode(screenshot);
  if (!(data instanceof Uint8Array) && !(data instanceof Uint8ClampedArray)) throw new Error("not a screenshot");
  const whole = { width, height, data: new Uint8Array(data) };
  const wide = Math.min(WIDTH, Math.floor(width / SHRINK));
  return averaged(whole, wide, Math.round((height * wide) / width), channels);
}

/** One luma and two chroma values a pixel, roughly 0 to 1. */
function seen({ data }: Picture): Float64Array {
  const out = new Float64Array(data.length);
  for (let i = 0; i < data.length; i += 3) {
    const [r, g, b] = [(data[i] ?? 0) / 255, (data[i + 1] ?? 0) / 255, (data[i + 2] ?? 0) / 255];
    const luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    out.set([luma, CHROMA_PART * (b - luma), CHROMA_PART * (r - luma)], i);
  }
  return out;
}

export function difference(golden: Picture, actual: Picture): Difference {
  const { width, height } = golden;
  const fitted = actual.height === height ? actual : averaged(actual, width, height);
  const [a, b] = [seen(golden), seen(fitted)];
  const blocks = Math.ceil(width / BLOCK);
  const sums = new Float64Array(blocks * Math.ceil(height / BLOCK));
  const counts = new Float64Array(sums.length);
  let sum = 0;
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const i = 3 * (y * width + x);
      const off = [0, 1, 2].map((k) => (a[i + k] ?? 0) - (b[i + k] ?? 0));
      const block = Math.floor(y / BLOCK) * blocks + Math.floor(x / BLOCK);
      const distance = Math.hypot(...off);
      sum += distance;
      sums[block] = (sums[block] ?? 0) + distance;
      counts[block] = (counts[block] ?? 0) + 1;
    }
  }
  return {
    mean: sum / (width * height),
    worst: Math.max(...sums.map((it, i) => it / (counts[i] ?? 1))),
    height: Math.abs(actual.height - height) / height,
  };
}

export const isAlike = ({ mean, worst, height }: Difference): boolean =>
  mean <= TOLERANCE.mean && worst <= TOLERANCE.worst && height <= TOLERANCE.height;

const pathOf = (name: string): string => join(FOLDER, `${name}.png`);

/** The golden of this name; null if none has been recorded. */
export async function golden(name: string): Promise<Picture | null> {
  if (!existsSync(pathOf(name))) return null;
  const { width, height, data } = decode(await readFile(pathOf(name)));
  return { width, height, data: new Uint8Array(data) };
}

export async function record(name: string, { width, height, data }: Picture): Promise<void> {
  await mkdir(FOLDER, { recursive: true });
  const coarse = data.map((value) => Math.min(255, Math.round(value / STEP) * STEP));
  await writeFile(pathOf(name), encode({ width, height, data: coarse, channels: 3 }, { zlib: { level: 9 } }));
}

const FONTS = join(FOLDER, "fonts.txt");

/** The widths of letters where the goldens were recorded; null if that is unknown. */
export const goldenFonts = async (): Promise<string | null> => (existsSync(FONTS) ? (await readFile(FONTS, "utf8")).trim() : null);

export async function recordFonts(widths: string): Promise<void> {
  await mkdir(FOLDER, { recursive: true });
  await writeFile(FONTS, `${widths}\n`);
}

/** Saves what was seen for inspection, and returns the folder. */
export async function keep(name: string, screenshot: Uint8Array, { width, height, data }: Picture): Promise<string> {
  const folder = await mkdtemp(join(tmpdir(), "cusp-golden-"));
  await writeFile(join(folder, `${name}.png`), screenshot);
  await writeFile(join(folder, `${name}-small.png`), encode({ width, height, data, channels: 3 }));
  return folder;
}
