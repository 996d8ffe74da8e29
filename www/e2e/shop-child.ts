/** The shop's server in its own process, which tests may kill. It reports to its parent when it listens and, on request, its memory. */
import { run } from "../examples/shop/start.js";

export async function main([folder = "", pages = "", cusp = "", port]: string[]): Promise<void> {
  process.on("message", () => {
    // Twice, since the first collection may free objects that keep others alive.
    for (let i = 0; i < 2; i++) globalThis.gc?.();
    process.send?.(process.memoryUsage());
  });
  // Only the server keeps the process alive.
  process.channel?.unref();
  process.send?.(await run({ folder, pages, cusp }, Number(port)));
}
