// @ts-check
import { mount } from "./symobs-live.js";

/** Questions and answers as messages between a view and the kernel; several views of one widget tell theirs by a name. */
function kernel(model) {
  const waiting = new Map(), own = crypto.getRandomValues(new Uint32Array(2)).join("-");
  let count = 0;
  const hear = ({ id, body }) => { waiting.get(id)?.(body); waiting.delete(id); };
  model.on("msg:custom", hear);
  const ask = (body, signal) => new Promise((answered, refused) => {
    const id = `${own}-${++count}`;
    waiting.set(id, answered);
    signal?.addEventListener("abort", () => { waiting.delete(id); refused(new Error("not wanted any more")); });
    model.send({ id, body });
  });
  return { ask, close: () => model.off("msg:custom", hear) };
}

export default {
  render({ model, el }) {
    const { ask, close } = kernel(model);
    const live = mount(el, ask, {
      state: model.get("state"),
      changed(state, final) { if (final) { model.set("state", state); model.save_changes(); } },
    });
    const follow = () => { if (model.get("state") !== live.state()) live.set(model.get("state")); };
    model.on("change:state", follow);
    return () => { model.off("change:state", follow); close(); live.destroy(); };
  },
};
