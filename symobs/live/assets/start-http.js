// @ts-check
import { http, mount } from "./symobs-live.js";

// The token is read once and taken out of the address, so that no link holds it.
const given = /(?:^#|&)token=([^&]*)/.exec(location.hash);
if (given) {
  sessionStorage.setItem("symobs-token", given[1]);
  history.replaceState(null, "", `#${location.hash.slice(1).replace(/(^|&)token=[^&]*&?/, "$1")}`.replace(/^#$/, location.pathname));
}
const token = sessionStorage.getItem("symobs-token") ?? "";
let moving = false;
const live = mount(/** @type {HTMLElement} */ (document.querySelector("main")), http(token), {
  state: decodeURIComponent(location.hash.slice(1)) ? location.hash : "",
  link: (state) => `${location.origin}${location.pathname}#${state}`,
  changed(state, final) {
    // A drag is one step of the history: Back undoes it.
    if (!moving || !final) history[moving || !final ? (moving ? "replaceState" : "pushState") : "pushState"](null, "", `#${state}`);
    else history.replaceState(null, "", `#${state}`);
    moving = !final;
  },
});
addEventListener("popstate", () => live.set(location.hash));
