/**
 * Caches the page's own files, so that it opens without a network. Does not handle any other request.
 *
 * The build inserts the list of files. Their names contain their hashes, so a new build has a new list, and the browser detects that this
 * script has changed. The new version waits until no page of the previous one is open, since those may still fetch parts of it.
 */
declare const self: ServiceWorkerGlobalScope;
declare const __FILES__: readonly string[];

const CACHE = `cusp ${__FILES__.join(" ")}`;
const addresses = new Set(["./", ...__FILES__].map((file) => new URL(file, self.registration.scope).href));

self.addEventListener("install", (event) => {
  const keep = async (): Promise<void> => {
    const cache = await caches.open(CACHE);
    await cache.addAll([...addresses]);
  };
  event.waitUntil(keep());
});

self.addEventListener("activate", (event) => {
  const forget = async (): Promise<void> => {
    const names = await caches.keys();
    await Promise.all(names.filter((name) => name.startsWith("cusp ") && name !== CACHE).map((name) => caches.delete(name)));
    await self.clients.claim();
  };
  event.waitUntil(forget());
});

self.addEventListener("fetch", (event) => {
  const { request } = event;
  const address = new URL(request.url);
  address.search = "";
  address.hash = "";
  if (request.method !== "GET" || !addresses.has(address.href)) return;
  const answer = async (): Promise<Response> => {
    const kept = await caches.match(address.href);
    // The page itself may have changed; files named by their hash cannot.
    if (request.mode !== "navigate" && kept !== undefined) return kept;
    return fetch(request).catch((error: unknown) => {
      if (kept !== undefined) return kept;
      throw error;
    });
  };
  event.respondWith(answer());
});
