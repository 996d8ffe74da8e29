/** The built page: all files are read once, so that no URL can reach any other. */
import { readdir, readFile } from "node:fs/promises";
import { extname, join, relative, sep } from "node:path";

export interface PageFile {
  type: string;
  bytes: Buffer;
  /** True if its name changes with its content. */
  isHashed: boolean;
}

const TYPES: Readonly<Record<string, string>> = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
  ".stl": "model/stl",
};

/** Files by URL path, such as `/assets/index.js`; that of `index.html` is `/`. */
export async function readPages(folder: string): Promise<ReadonlyMap<string, PageFile>> {
  const pages = new Map<string, PageFile>();
  for (const entry of await readdir(folder, { recursive: true, withFileTypes: true })) {
    if (!entry.isFile()) continue;
    const path = join(entry.parentPath, entry.name);
    const address = `/${relative(folder, path).replaceAll(sep, "/")}`;
    const type = TYPES[extname(path)] ?? "application/octet-stream";
    pages.set(address === "/index.html" ? "/" : address, {
      type,
      bytes: await readFile(path),
      isHashed: address.startsWith("/assets/"),
    });
  }
  return pages;
}
