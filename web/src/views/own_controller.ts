// The user's own controller on Design: its choice, the settings to type, today's settings in it, its law, and the
// entry's controller as code.
import { ApiError, sentenceOf } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { callSubject } from "../api/live.ts";
import { getProduct } from "../api/products.ts";
import type { AsEntered, Controller, Entry, Job, Product, Result, SettingValue, TuningRequest } from "../api/types.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { withBaseline, withImplement } from "../form/tuning_request.ts";
import { implementOf, inUnits, mineOfRequest, named, rememberMine, sameImplement, typedBaseline } from "../my_controller.ts";
import type { MyController } from "../my_controller.ts";
import type { Store } from "../store.ts";
import type { UnitNames } from "../words/numbers.ts";
import { codeCard } from "./cards/code_card.ts";
import { myControllerCard } from "./cards/my_controller_card.ts";
import { ownTodayCard } from "./cards/own_today_card.ts";
import { productCard } from "./cards/product_card.ts";
import { typedCard } from "./cards/typed_card.ts";
import { askTyped } from "./typed_question.ts";
import type { TypedAnswer, TypedQuestion } from "./typed_question.ts";

interface Shown {
  job: Job;
  /** The request of the result. */
  request: TuningRequest;
  /** As displayed, modified or not. */
  result: Result;
  index: number;
  name: string;
  units: UnitNames;
  /** The entry of the job that the service can write as code; null if the displayed design is not the job's own. */
  code: number | null;
}

export interface OwnController {
  /** The cards next to the plots, and those below them. */
  side: HTMLElement;
  below: HTMLElement[];
  show(shown: Shown): void;
  /** Settings that are tried by hand; null: the entry's own again. */
  follow(controller: Controller | null): void;
  dispose(): void;
}

/** `retune`: designs again in this job's place. */
export function ownController(
  store: Store,
  announce: (sentence: string) => void,
  retune: (request: TuningRequest) => Promise<void>,
): OwnController {
  let shown: Shown | null = null;
  let mine: MyController | null = store.get().mine;
  let tried: Controller | null = null;
  /** The question whose answer is shown or in progress. */
  let asked = "";
  const errors = new FormErrors();
  const about = productCard();
  const code = codeCard(announce);
  const redesign = h("button", { type: "button", onclick: () => void designForMine() });
  const today = ownTodayCard(errors, (settings) => void designBesideToday(settings));
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const picker = myControllerCard(errors, chooseMine, h("div", { class: "actions" }, redesign), trouble, today.element);
  const typed = typedCard(announce);
  const side = h("div", { class: "own-controller" }, picker.element, typed.element);

  const calls = latest<TypedQuestion, TypedAnswer>(askTyped, {
    onBusy: typed.setBusy,
    onAnswer({ product, entered, judged }) {
      if (!shown) return;
      showTyped(product, entered, judged ?? (tried ? null : shown.result.controllers[shown.index]!));
      if (!tried) announce(`Settings of ${shown.name} for ${mine?.name ?? product.name} are shown.`);
    },
    onError(error) {
      typed.complain(firstFault(error));
      asked = "";
    },
  });

  function firstFault(error: unknown): string {
    const listed = error instanceof ApiError ? errors.mark("/implement", underImplement(error)) : [];
    return listed[0]?.detail ?? sentenceOf(error);
  }

  function chooseMine(next: MyController | null): void {
    mine = next;
    rememberMine(next);
    store.set((workspace) => ({ ...workspace, mine: next }));
    showMine();
  }

  function showTyped(product: Product, entered: AsEntered, judged: Entry | null): void {
    const name = tried ? "the manual controller" : shown!.name;
    typed.show({ product, name, entered, judged: tried ? null : judged, time: shown!.units.time });
  }

  /** Shows the product's own cards: its law, and today's settings in it. */
  function showProduct(): void {
    const id = mine?.product;
    if (!id) {
      about.show(null);
      return today.setProduct(null);
    }
    getProduct(id).then(
      (product) => {
        if (mine?.product !== id) return;
        about.show(product);
        today.setProduct(product);
      },
      (error: unknown) => complain(error),
    );
  }

  function showTodays(): void {
    const baseline = shown?.request.baseline;
    if (baseline?.product === undefined || baseline.product !== mine?.product) return;
    getProduct(baseline.product).then((product) => {
      today.setProduct(product);
      today.load(baseline);
    }, complain);
  }

  function showRedesign(): void {
    const before = shown?.request.implement;
    const implement = implementOf(mine);
    redesign.hidden = !shown || sameImplement(before, implement) || (mine !== null && !implement);
    redesign.textContent = mine ? "Design for this controller" : "Design for an ideal controller";
  }

  function update(): void {
    showRedesign();
    ask();
  }

  /** Updates for another controller, or another job's. */
  function showMine(): void {
    showProduct();
    code.propose(mine);
    update();
  }

  /** The service writes the controller of a job, not one that is tried by hand. */
  function showCode(): void {
    if (!shown) return;
    const { job, code: index, name, units, result } = shown;
    code.show(!tried && index !== null && result.controllers[index]?.controller ? { job: job.id, index, name, units } : null);
  }

  function ask(): void {
    const entry = shown?.result.controllers[shown.index];
    const controller = tried ?? entry?.controller;
    const implement = implementOf(mine);
    if (!shown || !entry || !controller || !implement) {
      calls.drop();
      asked = "";
      return typed.hide();
    }
    const request = shown.request;
    const key = JSON.stringify([shown.job.id, shown.index, implement, controller]);
    if (key === asked) return;
    asked = key;
    const known = !tried && sameImplement(request.implement, implement) ? entry.as_entered : undefined;
    if (known) {
      calls.drop();
      typed.setBusy(false);
      getProduct(implement.product).then(
        (product) => {
          if (asked === key) showTyped(product, known, entry);
        },
        (error: unknown) => typed.complain(firstFault(error)),
      );
      return;
    }
    const subject = tried ? null : callSubject(request, shown.result);
    calls.send({ implement, controller, subject, request });
  }

  async function work(button: HTMLButtonElement, request: TuningRequest): Promise<void> {
    const label = button.textContent;
    button.disabled = true;
    button.textContent = "Designing…";
    trouble.hidden = true;
    side.setAttribute("aria-busy", "true");
    try {
      await retune(request);
    } catch (error) {
      complain(error);
    } finally {
      button.disabled = false;
      button.textContent = label;
      side.removeAttribute("aria-busy");
    }
  }

  function complain(error: unknown): void {
    const problem = error instanceof ApiError ? (error.problem.errors ?? []) : [];
    const others = errors.mark("", problem);
    const general = sentenceOf(error);
    trouble.textContent = problem.length > 0 ? others.map((item) => item.detail).join(" ") : general;
    trouble.hidden = trouble.textContent === "";
  }

  async function designForMine(): Promise<void> {
    const request = shown?.request;
    if (request) await work(redesign, withImplement(request, implementOf(mine)));
  }

  async function designBesideToday(settings: Record<string, SettingValue> | undefined): Promise<void> {
    const request = shown?.request;
    const implement = implementOf(mine);
    if (!request || !mine) return;
    if (!settings) return complain(`Enter the present settings of ${mine.name} first.`);
    if (!implement) return complain("Give the ranges above first.");
    await work(today.button, withBaseline(withImplement(request, implement), typedBaseline(implement, settings)));
  }

  picker.setProducts(store.get().products);
  picker.set(mine);
  const leave = store.subscribe((workspace, previous) => {
    if (workspace.products === previous.products) return;
    picker.setProducts(workspace.products);
    nameMine();
  });

  /** A request names its product by the id only. */
  function nameMine(): void {
    const known = named(mine, store.get().products);
    if (known === mine) return;
    mine = known;
    picker.set(mine);
    showMine();
  }

  return {
    side,
    below: [code.element, about.element],
    show(next) {
      const sameJob = shown?.job.id === next.job.id;
      if (!sameJob || shown?.index !== next.index) tried = null;
      shown = next;
      if (!sameJob) {
        mine = mineOfRequest(next.request.implement, inUnits(mine, next.units));
        picker.setUnits(next.units);
        picker.set(mine);
        nameMine();
        showMine();
        showTodays();
      }
      showCode();
      update();
    },
    follow(controller) {
      if (controller === tried) return;
      tried = controller;
      showCode();
      ask();
    },
    dispose() {
      leave();
      calls.drop();
      code.dispose();
    },
  };
}

/** Moves faults of a call about the controller alone to their place in a request. */
const underImplement = ({ problem }: ApiError): { pointer: string; detail: string }[] =>
  (problem.errors ?? []).map((error) =>
    error.pointer.startsWith("/implement") ? error : { ...error, pointer: `/implement${error.pointer}` },
  );
