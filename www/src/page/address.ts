/** What of the page's address is the page's own, and what is the settings'. */

/** `locale`, and for developers `backend`. */
export const ADDRESS_KEYS: readonly string[] = ["locale", "backend"];

/** The settings that an address names. */
export function settingsOf(address: URLSearchParams): string {
  return new URLSearchParams([...address].filter(([key]) => !ADDRESS_KEYS.includes(key))).toString();
}

/** The query for settings and the page's own; empty where all is as usual. */
export function addressOf(settings: string, own: URLSearchParams): string {
  const query = [settings, own.toString()].filter((part) => part !== "").join("&");
  return query === "" ? "" : `?${query}`;
}
