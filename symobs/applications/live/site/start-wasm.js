// @ts-check
import { atAddress, filled, LANGUAGES } from "./symobs-live.js";

const SCHEMA = "symobs-live/1", ANSWER = 10, LONG = 60;
const LOOKS = ["page", "view", "export", "start"];
const language = LANGUAGES[/[#&]language=(\w+)/.exec(location.hash)?.[1]] ?? LANGUAGES.en;
const told = /** @type {HTMLElement} */ (document.querySelector("[role=status]"));

/**
 * A worker that is asked one question at a time. One that takes too long, or ends by itself, is replaced with the next
 * question; asked again, a question has a minute.
 */
function place() {
  const slow = new Set();
  let worker = null, last = Promise.resolve();

  const ask = (body, signal) => new Promise((answered) => {
    if (signal?.aborted) { answered({}); return; }
    const question = JSON.stringify({ ...body, id: 0 });
    const seconds = LOOKS.includes(body.want) || slow.has(question) ? LONG : ANSWER;
    let timer = 0;
    const give_up = (message) => {
      clearTimeout(timer);
      worker?.terminate();
      worker = null;
      slow.add(question);
      answered({ schema: SCHEMA, id: body.id, status: "undecided", message });
    };
    worker ??= new Worker("worker.js", { type: "module" });
    worker.onerror = (event) => give_up(event.message || language.not_loaded);
    worker.onmessage = ({ data }) => {
      if (data.loading) told.textContent = filled(language.loading, { part: language[data.loading] ?? data.loading });
      else if (data.begun) timer = setTimeout(() => give_up(filled(language.late, { seconds })), 1000 * seconds);
      else if (data.ended) give_up(filled(language.ended, { reason: data.ended }));
      else {
        clearTimeout(timer);
        told.textContent = "";
        document.querySelector(".first")?.remove();
        answered(data.answer);
      }
    };
    worker.postMessage(body);
  });
  return (body, signal) => (last = last.then(() => ask(body, signal)));
}

// Derivations have a worker of their own, which begins with the first of them: what moves never waits for a page.
const answers = place(), pages = place();
atAddress((body, signal) => (body.want === "page" ? pages : answers)(body, signal));
navigator.serviceWorker?.register("offline.js").catch(() => {});
