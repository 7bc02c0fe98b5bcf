// Faults at their fields: one sentence next to the field, and the same in a summary that takes the focus.
import { ApiError, sentenceOf, whenBack } from "../api/client.ts";
import { whenReleased } from "../api/press.ts";
import type { FieldError } from "../api/types.ts";
import { h } from "../dom.ts";

export interface Control {
  input: HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;
  /** The element next to the field that holds its sentence. */
  error: HTMLElement;
  /** The fault of the text itself: it is shown as long as the text is there. */
  fault?: string;
  /** JSON Pointer of the value in the current request; null: not part of it. */
  pointer(): string | null;
}

/** The control for a pointer: its own, else that of the nearest enclosing value, else one inside it. */
export function matchPointer(pointer: string, known: readonly (string | null)[]): number {
  let best = -1;
  let length = -1;
  known.forEach((candidate, index) => {
    if (candidate === null) return;
    const same = candidate === pointer;
    const encloses = pointer.startsWith(`${candidate}/`);
    if ((same || encloses) && candidate.length > length) {
      best = index;
      length = candidate.length;
    }
  });
  if (best >= 0) return best;
  return pointer === ""
    ? -1
    : known.findIndex((candidate) => candidate !== null && candidate.startsWith(`${pointer}/`));
}

export class FormErrors {
  readonly summary = h("div", {
    class: "summary",
    role: "group",
    "aria-label": "Problems to fix",
    tabindex: -1,
    hidden: true,
  });
  /** Each control with its displayed sentence. */
  private readonly controls = new Map<Control, string>();

  add(control: Control): void {
    this.controls.set(control, "");
    control.input.addEventListener("input", () => this.settle(control));
    control.input.addEventListener("change", () => this.settle(control));
  }

  /** Shows that the text cannot be used, whatever the rest of the form contains. */
  refuse(control: Control, sentence: string): void {
    control.fault = sentence;
    this.clearControl(control);
  }

  /** The field has another text: the fault of the previous one is removed. */
  settle(control: Control): void {
    delete control.fault;
    this.clearControl(control);
  }

  remove(control: Control): void {
    this.controls.delete(control);
  }

  clear(): void {
    this.summary.hidden = true;
    this.summary.replaceChildren();
    for (const control of this.controls.keys()) this.clearControl(control);
  }

  /** Shows the current faults below a pointer at their fields, without taking the focus; returns those without a
      field. */
  mark(scope: string, errors: FieldError[]): FieldError[] {
    for (const control of this.controls.keys()) if (control.pointer()?.startsWith(`${scope}/`)) this.clearControl(control);
    return errors.filter((error) => !this.place(error));
  }

  /** Shows every fault at its field and all of them in the summary, which takes the focus. */
  show(errors: FieldError[], general = ""): void {
    this.clear();
    const items = errors.map((error) => {
      const control = this.place(error);
      if (!control) return h("li", {}, error.detail, error.pointer ? h("code", {}, ` ${error.pointer}`) : null);
      openAround(control.input);
      const link = h("a", { href: `#${control.input.id}` }, this.inWords(control, error));
      link.addEventListener("click", (event) => {
        event.preventDefault();
        control.input.focus();
      });
      return h("li", {}, link);
    });
    const count = errors.length;
    const head = count === 0 ? general : `${count} ${count === 1 ? "problem" : "problems"} to fix`;
    this.summary.replaceChildren(h("h2", {}, head), ...(items.length > 0 ? [h("ul", {}, items)] : []));
    this.summary.hidden = false;
    this.summary.focus();
    this.summary.scrollIntoView({ block: "nearest" });
  }

  /** A failed call: its faults at fields, and its general sentence. A lost connection is no longer shown once it is
      back. */
  fail(error: unknown, listed: FieldError[] = error instanceof ApiError ? (error.problem.errors ?? []) : []): void {
    this.show(listed, sentenceOf(error));
    const said = this.summary.firstElementChild;
    void whenBack(error, () => {
      if (this.summary.firstElementChild === said) this.clear();
    });
  }

  /** The control that now shows the fault. */
  private place(error: FieldError): Control | undefined {
    const controls = [...this.controls.keys()];
    const control = controls[matchPointer(error.pointer, controls.map((item) => item.pointer()))];
    if (!control) return undefined;
    const words = this.inWords(control, error);
    if (words !== control.fault) this.say(control, [this.controls.get(control), words].filter(Boolean).join(" "));
    return control;
  }

  private inWords(control: Control, error: FieldError): string {
    const labels = [...this.controls.keys()].flatMap((item) => {
      const pointer = item.pointer();
      if (pointer === null || parentOf(pointer) !== parentOf(error.pointer)) return [];
      return [[memberOf(pointer), labelOf(item)] as const];
    });
    return inLabels(error, labelOf(control), new Map(labels));
  }

  private clearControl(control: Control): void {
    this.say(control, control.fault ?? "");
  }

  /** A sentence appears and disappears next to its field, which moves the content below. */
  private say(control: Control, words: string): void {
    if (!this.controls.has(control)) return;
    this.controls.set(control, words);
    whenReleased(() => {
      const now = this.controls.get(control) ?? "";
      control.error.textContent = now;
      control.error.hidden = now === "";
      if (now === "") control.input.removeAttribute("aria-invalid");
      else control.input.setAttribute("aria-invalid", "true");
    });
  }
}

const parentOf = (pointer: string): string => pointer.slice(0, pointer.lastIndexOf("/"));
const memberOf = (pointer: string): string => pointer.slice(pointer.lastIndexOf("/") + 1);
const labelOf = ({ input }: Control): string => input.labels?.[0]?.firstElementChild?.textContent ?? "";

/** Replaces names of members in the service's sentences by the page's labels: `own` is that of the fault's field,
    `labels` those of its neighbours by member. A name that may be a word or a signal, such as y, stays within a
    sentence. */
export function inLabels({ pointer, detail }: FieldError, own: string, labels: ReadonlyMap<string, string>): string {
  const member = memberOf(pointer);
  // The label of a field for pasting is an instruction and does not name its content.
  const subject = member === "csv" ? "The text" : own;
  const named = subject !== "" && [" is ", " has "].some((verb) => detail.startsWith(member + verb));
  const [head, rest] = named ? [subject, detail.slice(member.length)] : ["", detail];
  const words = rest.replace(/\b[a-z]+(?:_[a-z]+)+\b|\b[uy]0\b/g, (name) => {
    const label = labels.get(name);
    return label ? `"${label}"` : name;
  });
  return head + words;
}

/** Opens the folded parts of the page that contain an element. */
export function openAround(element: Element): void {
  for (let at = element.closest("details"); at; at = at.parentElement?.closest("details") ?? null) at.open = true;
}

const WHOSE = "These results belong to the last answered request, not to the present form.";

/** The note above results next to a form whose last request was refused; they lose their colours meanwhile. */
export interface StaleMark {
  element: HTMLElement;
  set(stale: boolean): void;
}

export function staleMark(results: () => HTMLElement): StaleMark {
  const element = h("p", { class: "trouble", role: "status", hidden: true });
  return {
    element,
    set(stale) {
      element.textContent = stale ? WHOSE : "";
      element.hidden = !stale;
      results().toggleAttribute("data-stale", stale);
    },
  };
}
