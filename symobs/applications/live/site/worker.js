// @ts-check
// Python in a worker of the static site: it answers as the child of `symobs serve` does, one question after the other.
import { loadPyodide } from "./pyodide/pyodide.mjs";
import "./contents.js";

const here = (path) => new URL(path, import.meta.url).href;
const FOLDER = "/symobs";
const loaded = load();

async function load() {
  postMessage({ loading: "Python" });
  const python = await loadPyodide({ indexURL: here("pyodide/") });
  postMessage({ loading: "arithmetic" });
  await python.loadPackage(here(self.CONTENTS.wheel), { messageCallback() {}, errorCallback: console.error });
  postMessage({ loading: "symobs" });
  python.unpackArchive(await (await fetch(here("symobs.zip"))).arrayBuffer(), "zip", { extractDir: FOLDER });
  return python.runPython(`
import sys
sys.path.insert(0, "${FOLDER}")
from symobs.applications.live.child import respond
lambda text: respond(text.encode()).decode()`);
}

onmessage = async ({ data }) => {
  try {
    const respond = await loaded;
    postMessage({ begun: true });
    postMessage({ answer: JSON.parse(respond(JSON.stringify(data))) });
  } catch (error) {
    postMessage({ ended: String(error.message ?? error).trim().split("\n").at(-1) });
  }
};
