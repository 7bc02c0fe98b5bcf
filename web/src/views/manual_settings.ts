// Settings to try by hand: sliders around an optimum, and the plant's response while they move.
import { ApiError, sentenceOf } from "../api/client.ts";
import { stepOf } from "../api/evaluate.ts";
import { latest } from "../api/latest.ts";
import type { Controller, EmulatedScenario, Emulation, Entry, Plant, Tuned } from "../api/types.ts";
import type { OwnRun } from "../charts/emulation.ts";
import { h, passFocus } from "../dom.ts";
import { FormErrors } from "../form/errors.ts";
import { slider } from "../form/slider.ts";
import type { Slider } from "../form/slider.ts";
import { unitOf } from "../words/emulation.ts";
import { formatNumber } from "../words/numbers.ts";
import type { UnitNames } from "../words/numbers.ts";

export interface ManualSettings {
  element: HTMLElement;
  /** Returns to the entry's own settings; hides itself if the service cannot try others. */
  show(entry: Entry, plant: Plant | undefined, units: UnitNames): void;
  /** The set-point step for the trial; one with its own start or parameters cannot be used. */
  setScenario(scenario: EmulatedScenario | undefined): void;
  /** The result of the last settings, in a sentence. */
  say(sentence: string): void;
  dispose(): void;
}

type Sought = "Kp" | "Ti" | "Td";
interface Asked {
  plant: Plant;
  controller: Controller;
  scenario: EmulatedScenario;
  horizon: number;
}

/** Null if nothing is tried any more. */
export interface ManualSettingsEvents {
  onRun(run: OwnRun | null): void;
  /** The controller with the sliders' values, as soon as they move. */
  onTry(controller: Controller | null): void;
}

export function manualSettings({ onRun, onTry }: ManualSettingsEvents): ManualSettings {
  let shown: { entry: Entry; plant: Plant; units: UnitNames } | null = null;
  let scenario: EmulatedScenario | undefined;
  const errors = new FormErrors();
  const trouble = h("p", { class: "trouble", role: "status", hidden: true });
  const said = h("p", { class: "hint" });
  const back = h("button", { type: "button", disabled: true, onclick: () => reset() }, "Back to the optimum");
  const make = (name: Sought, log: boolean): Slider =>
    slider(
      {
        label: name,
        log,
        pointer: () => null,
        spoken: (value) => `${name} ${formatNumber(value)}`,
        onMove: ask,
        onRelease: ask,
      },
      errors,
    );
  const sliders: Record<Sought, Slider> = { Kp: make("Kp", false), Ti: make("Ti", true), Td: make("Td", true) };
  const element = h(
    "details",
    { class: "by-hand" },
    h("summary", {}, "Try other settings"),
    h(
      "div",
      { class: "fields three" },
      Object.values(sliders).map((item) => item.element),
    ),
    h("div", { class: "actions" }, back, said),
    trouble,
  );
  const calls = latest<Asked, Entry>(
    ({ plant, controller, scenario: tried, horizon }) => stepOf(plant, controller, tried.setpoint_step, horizon),
    {
      onBusy: (busy) => element.setAttribute("aria-busy", String(busy)),
      onAnswer(entry, asked) {
        const response = entry.responses?.setpoint;
        if (!response) return complain(entry.error?.detail ?? "There is no response with these settings.");
        trouble.hidden = true;
        const absolute = (values: (number | null)[], rest: number): (number | null)[] =>
          values.map((value) => (value === null ? null : value + rest));
        const { y_rest, u_rest } = asked.scenario;
        onRun({ t: response.t, y: absolute(response.y, y_rest), u: absolute(response.u, u_rest) });
      },
      onError(error) {
        const first = error instanceof ApiError ? error.problem.errors?.[0]?.detail : undefined;
        complain(first ?? sentenceOf(error));
      },
    },
  );

  function complain(sentence: string): void {
    trouble.textContent = sentence;
    trouble.hidden = false;
    onRun(null);
  }

  function ask(): void {
    const controller = shown?.entry.controller;
    const horizon = shown?.entry.emulation?.horizon;
    if (!shown || !controller || !scenario || typeof horizon !== "number") return;
    const moved = { ...controller };
    for (const name of soughtBy(controller)) moved[name] = sliders[name].value();
    back.disabled = false;
    onTry(moved);
    calls.send({ plant: shown.plant, controller: moved, scenario, horizon });
  }

  function reset(): void {
    calls.drop();
    element.removeAttribute("aria-busy");
    passFocus(back, element.querySelector<HTMLElement>(".slider:not([hidden]) input[type=range]"));
    back.disabled = true;
    trouble.hidden = true;
    said.textContent = "";
    const controller = shown?.entry.controller;
    if (controller) for (const name of soughtBy(controller)) sliders[name].set(controller[name]!);
    onTry(null);
    onRun(null);
  }

  const possible = (): boolean =>
    Boolean(shown?.entry.controller && scenario && !scenario.initial && !scenario.parameters);

  return {
    element,
    show(entry, plant, units) {
      shown = plant ? { entry, plant, units } : null;
      const controller = entry.controller;
      const names = controller ? soughtBy(controller) : [];
      for (const name of Object.keys(sliders) as Sought[]) {
        sliders[name].element.hidden = !names.includes(name);
        sliders[name].field.setUnit(unitOf(name, units));
        if (!names.includes(name)) continue;
        sliders[name].set(controller![name]!);
        sliders[name].setLimits(...limitsOf(entry.emulation, name, controller![name]!));
      }
      reset();
      element.hidden = !possible();
    },
    setScenario(next) {
      scenario = next;
      reset();
      element.hidden = !possible();
    },
    say(sentence) {
      said.textContent = sentence;
    },
    dispose: calls.drop,
  };
}

/** The members of the controller among the three. */
const soughtBy = (controller: Controller): Sought[] =>
  (["Kp", "Ti", "Td"] as const).filter((name) => typeof controller[name] === "number" && controller[name] !== 0);

/** The search's own bounds, else a factor of five on both sides. */
function limitsOf(emulation: Emulation | undefined, name: Tuned, value: number): [number, number] {
  const bounds = emulation?.bounds?.[name];
  if (bounds) return bounds;
  return value > 0 ? [value / 5, value * 5] : [value * 5, value / 5];
}
