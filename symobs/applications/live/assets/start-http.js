// @ts-check
import { atAddress, http } from "./symobs-live.js";

// The token is read once and taken out of the address, so that no link holds it.
const given = /(?:^#|&)token=([^&]*)/.exec(location.hash);
if (given) {
  sessionStorage.setItem("symobs-token", given[1]);
  history.replaceState(null, "", `#${location.hash.slice(1).replace(/(^|&)token=[^&]*&?/, "$1")}`.replace(/^#$/, location.pathname));
}
atAddress(http(sessionStorage.getItem("symobs-token") ?? ""));
