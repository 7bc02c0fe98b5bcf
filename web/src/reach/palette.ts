// The search over the whole page: one field, one list. A choice is carried out and closes the dialog.
import { listJobs } from "../api/job_lists.ts";
import { newest } from "../api/latest.ts";
import type { Job, ListedJob, ProductSummary } from "../api/types.ts";
import { openDialog } from "../dom.ts";
import { combobox } from "../form/combobox.ts";
import type { Choice } from "../form/combobox.ts";
import { FormErrors } from "../form/errors.ts";
import { named, rememberMine } from "../my_controller.ts";
import { addressOfJob, formatRoute, showsStart } from "../routes.ts";
import type { Store } from "../store.ts";
import { DOCUMENTS, documentAddress } from "../words/documents.ts";
import { productTitle } from "../words/products.ts";
import { actionsOf } from "./actions.ts";
import { search } from "./finds.ts";
import type { Find, FindKind } from "./finds.ts";

const PAUSE_MS = 150;

const KIND_WORDS: Record<FindKind, string> = {
  action: "action",
  screen: "screen",
  job: "job",
  controller: "controller",
  method: "method",
  document: "document",
};

const go = (address: string): void => {
  location.href = address;
};

function screenFinds(): Find[] {
  const links = [...document.querySelectorAll<HTMLAnchorElement>(".top nav a[href]")];
  return links
    .filter((link) => !link.hidden)
    .map((link) => ({ id: link.href, kind: "screen", text: link.textContent ?? "", aside: "", go: () => link.click() }));
}

function actionFinds(): Find[] {
  const tools = [...document.querySelectorAll<HTMLButtonElement>(".top .tools button")].filter((button) => button.textContent?.startsWith("Theme"));
  return [
    ...actionsOf(document.getElementById("main")).map(({ text, place, run }): Find => ({ id: `${text} ${place}`, kind: "action", text, aside: place === text ? "" : place, go: run })),
    ...tools.map((button): Find => ({ id: "theme", kind: "action", text: button.textContent ?? "", aside: "", words: "dark light colours", go: () => button.click() })),
  ];
}

const jobFind = (job: Job | ListedJob): Find => ({
  id: job.id,
  kind: "job",
  text: job.name || job.id,
  aside: job.name ? job.id : "",
  words: job.status,
  go: () => go(addressOfJob(job.id, "design")),
});

export function openPalette(store: Store, announce: (sentence: string) => void): void {
  /** The product becomes the user's own, and the screen shows its settings. */
  function choose(product: ProductSummary): void {
    const { mine, products, route, job } = store.get();
    const next = named({ ...mine, product: product.id, name: "", needs: [] }, products);
    rememberMine(next);
    store.set((workspace) => ({ ...workspace, mine: next }));
    announce(`My controller is ${next?.name}.`);
    if (route.screen !== "design" && !showsStart(route)) go(job ? addressOfJob(job.id, "design") : formatRoute({ screen: "start" }));
  }

  const { methods, products, recent } = store.get();
  const known: Find[] = [
    ...actionFinds(),
    ...screenFinds(),
    ...products.map((product): Find => ({
      id: product.id,
      kind: "controller",
      text: productTitle(product),
      aside: "",
      words: [product.id, ...product.families].join(" "),
      go: () => choose(product),
    })),
    ...methods.map(({ id, title, source }): Find => ({ id, kind: "method", text: title, aside: id, words: source, go: () => go(formatRoute({ screen: "methods", id })) })),
    ...DOCUMENTS.map(({ id, title }): Find => ({ id, kind: "document", text: title, aside: "", words: id, go: () => go(documentAddress(id)) })),
  ];
  let jobs: Find[] = recent.map(jobFind);
  let asked = "";
  let shown: Find[] = [];
  let timer: ReturnType<typeof setTimeout> | undefined;
  const begin = newest();

  /** The jobs with this text at the service: the list shows them when they arrive. Without a connection the others
      are still found. */
  async function askJobs(text: string): Promise<void> {
    const isNewest = begin();
    const list = await listJobs(text).catch(() => null);
    if (!list || !isNewest()) return;
    jobs = list.jobs.map(jobFind);
    box.refresh();
  }

  function find(typed: string): Choice[] {
    const text = typed.trim();
    if (text !== asked) {
      asked = text;
      clearTimeout(timer);
      timer = setTimeout(() => void askJobs(text), PAUSE_MS);
    }
    shown = search([...known, ...jobs], text);
    return shown.map(({ kind, id, text: name, aside }) => ({
      id: `${kind} ${id}`,
      text: name,
      aside: [KIND_WORDS[kind], aside].filter(Boolean).join(" · "),
    }));
  }

  function take(choice: Choice | null): void {
    const chosen = choice && shown.find(({ kind, id }) => `${kind} ${id}` === choice.id);
    if (!chosen) return;
    dialog.close();
    chosen.go();
  }

  const box = combobox(
    { label: "Screen, method, controller, job, document or action", placeholder: "type a few letters", pointer: () => null, find, onChoose: take },
    new FormErrors(),
  );
  const dialog = openDialog("Find", "palette", box.element);
  const { input } = box.field;
  // One Escape leaves: the list is all that this dialog has.
  dialog.addEventListener("keydown", (event) => event.key === "Escape" && dialog.close(), true);
  dialog.addEventListener("close", () => clearTimeout(timer));
  input.focus();
  input.click();
}
