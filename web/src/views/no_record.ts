// Identify without a record: where to get one.
import { h } from "../dom.ts";
import type { View } from "./start.ts";

export function noRecordView(trouble = ""): View {
  const heading = h("h1", { tabindex: -1 }, "Identify");
  const element = h(
    "main",
    { class: "identify", id: "main" },
    heading,
    trouble ? h("p", { class: "trouble", role: "status" }, trouble) : null,
    h(
      "p",
      {},
      "There is no recorded test here yet. ",
      h("a", { href: "#/" }, "Drop one on Start"),
      ": a step, a relay test, or any movement of the controller's output.",
    ),
  );
  return { element, heading, dispose: () => undefined };
}
