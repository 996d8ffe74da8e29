/** Saves files through the browser. */

/** Long enough for the browser to have started saving. */
const SAVED_MS = 60_000;

interface Saved {
  name: string;
  blob: Blob;
}

export function saveFile({ name, blob }: Saved): void {
  const address = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), SAVED_MS);
}

/** Saves a file once made; null saves nothing. */
export async function saveMade(making: Promise<Saved | null>): Promise<void> {
  const file = await making;
  if (file !== null) saveFile(file);
}
