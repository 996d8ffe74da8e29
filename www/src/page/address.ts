/** Splits the page's URL query into the page's own keys and the settings. */

/** The page's own keys: `locale`, and for developers `backend` and `gpu-method`. */
export const ADDRESS_KEYS: readonly string[] = ["locale", "backend", "gpu-method"];

/** Settings in a URL query. */
export function settingsOf(address: URLSearchParams): string {
  return new URLSearchParams([...address].filter(([key]) => !ADDRESS_KEYS.includes(key))).toString();
}

/** Query for the settings and the page's own keys; empty if all are at their defaults. */
export function addressOf(settings: string, own: URLSearchParams): string {
  const query = [settings, own.toString()].filter((part) => part !== "").join("&");
  return query === "" ? "" : `?${query}`;
}
