// @ts-check
// Keeps the files of the site, so that it opens and answers without a network once it was loaded.
importScripts("contents.js");
const { version, files } = self.CONTENTS;

addEventListener("install", (event) => event.waitUntil((async () => {
  await (await caches.open(version)).addAll(files);
  await self.skipWaiting();
})()));

addEventListener("activate", (event) => event.waitUntil((async () => {
  const older = (await caches.keys()).filter((name) => name.startsWith("symobs-live-") && name !== version);
  await Promise.all(older.map((name) => caches.delete(name)));
  await self.clients.claim();
})()));

addEventListener("fetch", (event) => event.respondWith((async () => {
  const kept = await (await caches.open(version)).match(event.request, { ignoreSearch: true });
  return kept ?? fetch(event.request);
})()));
