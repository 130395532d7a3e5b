// @ts-check
import { atAddress, http } from "./symobs-live.js";

// The token is read once and taken out of the address, so that no link holds it; every tab of this browser knows it.
const given = /(?:^#|&)token=([^&]*)/.exec(location.hash);
if (given) {
  localStorage.setItem("symobs-token", given[1]);
  history.replaceState(null, "", `#${location.hash.slice(1).replace(/(^|&)token=[^&]*&?/, "$1")}`.replace(/^#$/, location.pathname));
}
atAddress(http(localStorage.getItem("symobs-token") ?? ""));
