/** The shop's server in a process of its own, which tests may kill. It tells its parent when it listens, and, when asked, its memory. */
import { run } from "../examples/shop/start.js";

export async function main([folder = "", pages = "", cusp = "", port]: string[]): Promise<void> {
  process.on("message", () => {
    // Twice, since the first collection may free what others are kept alive by.
    for (let i = 0; i < 2; i++) globalThis.gc?.();
    process.send?.(process.memoryUsage());
  });
  // The server alone decides how long the process lives.
  process.channel?.unref();
  process.send?.(await run({ folder, pages, cusp }, Number(port)));
}
