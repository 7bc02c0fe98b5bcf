// The user's own controller on Design: its choice, the settings to type, today's settings in it, its law, and the
// entry's controller as code.
import { ApiError, sentenceOf, waitAfter } from "../api/client.ts";
import { latest } from "../api/latest.ts";
import { callSubject } from "../api/live.ts";
import { getProduct, knownProduct } from "../api/products.ts";
import type { AsEntered, Controller, Entry, Implement, Job, Product, Result, SettingValue, TuningRequest } from "../api/types.ts";
import { h } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { choicesOf } from "../form/product_settings.ts";
import { givenBaseline, withBaseline, withImplement } from "../form/tuning_request.ts";
import { implementOf, inUnits, isFor, mineOfRequest, named, rememberMine, sameImplement, typedInto } from "../my_controller.ts";
import type { MyController } from "../my_controller.ts";
import type { Store } from "../store.ts";
import { formOf, formRows, productRows } from "../words/answer.ts";
import type { UnitNames } from "../words/numbers.ts";
import { productTitle, typedRows, typedText } from "../words/products.ts";
import { formulaLine, rememberedForm, rememberForm, settingsOf, settingsText } from "../words/settings.ts";
import type { TextbookForm } from "../words/settings.ts";
import { answerCard } from "./cards/answer_card.ts";
import type { Answer } from "./cards/answer_card.ts";
import { codeCard } from "../program/code_card.ts";
import { productDetails, productTroubles } from "./cards/in_product.ts";
import { myControllerCard } from "./cards/my_controller_card.ts";
import { ownTodayCard } from "./cards/own_today_card.ts";
import { productCard } from "./cards/product_card.ts";
import { snippetBlocks } from "./copy.ts";
import { askTyped } from "./typed_question.ts";
import type { TypedAnswer, TypedQuestion } from "./typed_question.ts";
import { controllerInForm, controllerInProduct } from "./typed_settings.ts";
import type { SettingsByHand, TypedTexts } from "./typed_settings.ts";

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
  /** How the settings came about if they are not the job's, such as "set by hand"; else "". */
  mark: string;
  /** Other settings can be typed in their place. */
  typeable: boolean;
  /** The result is that of everything that was moved and typed. */
  isCurrent(): boolean;
}

export interface OwnController {
  /** The settings to enter, first on the screen; and the cards below the plots. */
  answer: HTMLElement;
  below: HTMLElement[];
  show(shown: Shown): void;
  /** While a slider is held: the settings alone, as far as they are known without a request to the service. What was
      asked before is outdated; the release asks again. */
  move(shown: Shown): void;
  /** Settings that are tried by hand; null: the entry's own again. */
  follow(controller: Controller | null): void;
  dispose(): void;
}

export interface OwnControllerEvents {
  announce(sentence: string): void;
  /** Designs again in this job's place. */
  retune(request: TuningRequest): Promise<void>;
  /** Settings that were typed in the card: shown as set by hand. */
  onByHand(settings: SettingsByHand): void;
  /** The entry's controller was evaluated on a product for which the job was not designed; null: the job's own loop is
      that of the settings. */
  onJudged(entry: Entry | null): void;
  /** Settings are being read, after which `onByHand` is called unless they are refused. */
  onReading(reading: Promise<void>): void;
}

export function ownController(store: Store, { announce, retune, onByHand, onJudged, onReading }: OwnControllerEvents): OwnController {
  let shown: Shown | null = null;
  let mine: MyController | null = store.get().mine;
  let form: TextbookForm = rememberedForm();
  let tried: Controller | null = null;
  /** The question whose answer is shown or in progress. */
  let asked = "";
  const errors = new FormErrors();
  const about = productCard();
  const code = codeCard(announce);
  const redesign = h("button", { type: "button", onclick: () => void designForMine() });
  const today = ownTodayCard(errors, (settings) => void designWithToday(settings));
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const picker = myControllerCard(
    errors,
    { forms: true, onChange: chooseMine },
    h("div", { class: "actions" }, redesign),
    trouble,
  );
  const answer = answerCard({
    announce,
    onType(texts) {
      const reading = typeInto(texts);
      onReading(reading);
      return reading;
    },
  }, {
    picker: picker.element,
    notes: picker.notes,
    folded: [picker.facts, today.element],
  });
  answer.element.classList.add("own-controller");

  const calls = latest<TypedQuestion, TypedAnswer>(askTyped, {
    onBusy: answer.setBusy,
    onAnswer({ product, entered, judged }, { implement, controller }) {
      if (!shown) return;
      const newest = keyOf(implement, controller) === asked;
      showTyped(product, entered, judged ?? (tried ? null : shown.result.controllers[shown.index]!), newest);
      if (!tried) onJudged(judged && { ...judged, controller });
      if (!tried) announce(`Settings of ${shown.name} for ${mine?.name ?? product.name} are shown.`);
    },
    onError: fail,
  });

  function fail(error: unknown): void {
    answer.complain(["Nothing to type", ""], firstFault(error));
    asked = "";
    later(error, () => asked === "" && ask());
  }

  /** Tries again while the card is shown, if a failed call may succeed then. */
  function later(error: unknown, again: () => void): void {
    const wait = waitAfter(error);
    if (wait !== null) setTimeout(() => shown && again(), wait);
  }

  /** Nothing is asked any more: an answer in progress would replace newer settings. */
  function dropQuestion(): void {
    calls.drop();
    asked = "";
    answer.setBusy(false);
  }

  function firstFault(error: unknown): string {
    const listed = error instanceof ApiError ? errors.mark("/implement", underImplement(error)) : [];
    return listed[0]?.detail ?? sentenceOf(error);
  }

  function chooseMine(next: MyController | null, chosen: TextbookForm): void {
    mine = next;
    form = chosen;
    rememberForm(chosen);
    rememberMine(next);
    store.set((workspace) => ({ ...workspace, mine: next }));
    showMine();
  }

  const keyOf = (implement: Implement, controller: Controller): string =>
    JSON.stringify([shown?.job.id, shown?.index, implement, controller]);

  const whose = (): string => [tried ? "the manual controller" : shown!.name, shown!.mark].filter(Boolean).join(", ");

  /** The job's entry of today's settings. */
  const todayEntry = (): Entry | undefined => shown?.result.controllers.find((entry) => entry.method === "baseline");

  /** Today's settings by the product's own names: as the service wrote them, or as they were given. */
  function todaysTyped(product: Product): Record<string, SettingValue> {
    const { implement } = shown!.request;
    const baseline = givenBaseline(shown!.request);
    const written = isFor(implement, mine) ? todayEntry()?.as_entered?.as_typed : undefined;
    return { ...written, ...(baseline?.product === product.id ? baseline.settings : {}) };
  }

  function showTyped(product: Product, entered: AsEntered, judged: Entry | null, newest = true): void {
    const heading = productTitle(product);
    const settled = tried ? null : judged;
    answer.show({
      heading: ["Type into", ` ${heading}`],
      whose: whose(),
      rows: productRows(product, entered, todaysTyped(product)),
      text: typedText(`${heading}: ${whose()}`, typedRows(product, entered)),
      below: [...productTroubles(settled, shown!.units.time), ...snippetBlocks(entered, announce)],
      details: productDetails(product, entered, settled, shown!.units.time),
      current: newest && isCurrent(),
      choices: typeable() ? (name) => choicesOf(product, name) : null,
    });
  }

  const typeable = (): boolean => !tried && shown!.typeable;

  let typings = 0;
  /** Typings that are being read. */
  let reading = 0;

  const isCurrent = (): boolean => reading === 0 && shown!.isCurrent();

  /** Typed texts as a controller: in the product, or in the form. Only the last ones count, and only while the same
      entry is shown. */
  async function typeInto(texts: TypedTexts): Promise<void> {
    if (!shown) return;
    const { request, result, index, job } = shown;
    const typing = (typings += 1);
    const current = (): boolean => typing === typings && shown?.job.id === job.id && shown.index === index;
    const implement = implementOf(mine);
    const subject = callSubject(request, result);
    reading += 1;
    try {
      const product = implement && (await getProduct(implement.product));
      const entry = result.controllers[index]!;
      const typed = product
        ? await controllerInProduct(product, implement, texts, request)
        : await controllerInForm(entry, formOf(entry, form), texts, subject!);
      if (current()) onByHand(typed);
    } catch (error) {
      if (!current()) return;
      const listed = error instanceof ApiError ? (error.problem.errors ?? []) : [];
      answer.refuse(listed[0]?.detail ?? sentenceOf(error));
    } finally {
      reading -= 1;
    }
  }

  function showForm(): void {
    const { result, index, units } = shown!;
    const job = result.controllers[index]!;
    const entry = tried ? { ...job, controller: tried } : job;
    const inForm = formOf(entry, form);
    const rows = formRows(entry, todayEntry(), inForm, units);
    const settings = settingsOf(entry, inForm, units);
    // Settings of a textbook form must not stand under the name of a product.
    if (mine) return answer.complain(["Type into", ` ${mine.name}`], "");
    const heading: Answer["heading"] = ["Settings to enter:", ` ${shown!.name}`];
    if (typeof rows === "string" || typeof settings === "string") return answer.complain(heading, String(rows));
    const text = settingsText(inForm, settings);
    answer.show({
      heading,
      whose: whose(),
      rows,
      text,
      below: [h("p", { class: "hint" }, formulaLine(inForm, entry))],
      details: [],
      current: isCurrent(),
      choices: typeable() ? () => [] : null,
    });
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
        trouble.hidden = true;
        about.show(product);
        today.setProduct(product);
      },
      (error: unknown) => {
        complain(error);
        later(error, () => mine?.product === id && showProduct());
      },
    );
  }

  function showTodays(): void {
    const baseline = shown && givenBaseline(shown.request);
    if (baseline?.product === undefined || baseline.product !== mine?.product) return;
    const { job } = shown!;
    getProduct(baseline.product).then(
      (product) => {
        if (shown?.job.id !== job.id) return;
        trouble.hidden = true;
        today.setProduct(product);
        today.load(baseline);
      },
      (error: unknown) => {
        complain(error);
        later(error, () => shown?.job.id === job.id && showTodays());
      },
    );
  }

  function showRedesign(): void {
    const before = shown?.request.implement;
    const implement = implementOf(mine);
    redesign.hidden = !shown || isFor(before, mine) || (mine !== null && !implement);
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
    if (!implement) onJudged(null);
    if (!shown || !entry || !controller || !implement) {
      dropQuestion();
      if (shown && entry) showForm();
      return;
    }
    const request = shown.request;
    const key = keyOf(implement, controller);
    if (key === asked) return;
    asked = key;
    const known = !tried && isFor(request.implement, mine) ? entry.as_entered : undefined;
    if (known) {
      onJudged(null);
      calls.drop();
      answer.setBusy(false);
      getProduct(implement.product).then(
        (product) => {
          if (asked === key) showTyped(product, known, entry);
        },
        (error: unknown) => {
          if (asked === key) fail(error);
        },
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
    answer.setBusy(true);
    try {
      await retune(request);
    } catch (error) {
      complain(error);
    } finally {
      button.disabled = false;
      button.textContent = label;
      answer.setBusy(false);
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

  async function designWithToday(settings: Record<string, SettingValue> | undefined): Promise<void> {
    const request = shown?.request;
    const implement = implementOf(mine);
    if (!request || !mine) return;
    if (!settings) return complain(`Enter the present settings of ${mine.name} first.`);
    if (!implement) return complain("Give the ranges above first.");
    await work(today.button, withBaseline(withImplement(request, implement), typedInto(implement, settings)));
  }

  picker.setProducts(store.get().products);
  picker.set(mine, form);
  const leave = store.subscribe((workspace, previous) => {
    if (workspace.products !== previous.products) {
      picker.setProducts(workspace.products);
      nameMine();
    }
    // Chosen elsewhere, such as in the search over the page.
    const { mine: other } = workspace;
    if (other && other !== previous.mine && other.product !== mine?.product) picker.choose(other.product);
  });

  /** A request names its product by the id only. */
  function nameMine(): void {
    const known = named(mine, store.get().products);
    if (known === mine) return;
    mine = known;
    picker.set(mine);
    showMine();
  }

  function takeMine({ request, result, units }: Shown): void {
    mine = mineOfRequest(request.implement, inUnits(mine, units));
    picker.set(mine);
    nameMine();
    picker.setOutput(result.model?.fit?.u ?? request.record?.u ?? []);
    picker.setUnits(units);
    showMine();
  }

  /** Settings that were typed into another product than the chosen one, such as those of a link. */
  function bringsProduct({ implement: before }: TuningRequest, { implement }: TuningRequest): boolean {
    return implement?.product !== undefined && !sameImplement(implement, before) && !isFor(implement, mine);
  }

  return {
    answer: answer.element,
    below: [code.element, about.element],
    show(next) {
      const before = shown;
      const sameJob = before?.job.id === next.job.id;
      if (!sameJob || before?.index !== next.index) tried = null;
      shown = next;
      if (!sameJob) {
        takeMine(next);
        showTodays();
      } else if (bringsProduct(before.request, next.request)) takeMine(next);
      showCode();
      update();
    },
    move(next) {
      shown = next;
      dropQuestion();
      const entry = next.result.controllers[next.index];
      const implement = implementOf(mine);
      if (!implement) return showForm();
      const entered = isFor(next.request.implement, mine) ? entry?.as_entered : undefined;
      const product = knownProduct(implement.product);
      if (entered && product) showTyped(product, entered, entry!);
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
      shown = null;
      code.dispose();
    },
  };
}

/** Moves faults of a call about the controller alone to their place in a request. */
const underImplement = ({ problem }: ApiError): { pointer: string; detail: string }[] =>
  (problem.errors ?? []).map((error) =>
    error.pointer.startsWith("/implement") ? error : { ...error, pointer: `/implement${error.pointer}` },
  );
