// Relay test: its simulation on a plant, a plan for it, and its record for Identify.
import { simulateRelay } from "../api/plants.ts";
import type { FieldError, IdentifyRequest, RelayAnswer, RelayPlan, RelayRequest, RelaySettings, Units } from "../api/types.ts";
import { latest } from "../api/latest.ts";
import { relayFrame } from "../charts/relay.ts";
import { h, uniqueId } from "../dom.ts";
import { textField } from "../form/controls.ts";
import { FormErrors, staleMark } from "../form/errors.ts";
import { parseNumber } from "../form/number.ts";
import { plantFields } from "../form/plant_fields.ts";
import { createPlot } from "../plot/plot.ts";
import type { Plot } from "../plot/plot.ts";
import { formatNumber, unitNames } from "../words/numbers.ts";
import { planSentences } from "../words/relay_plan.ts";
import { experimentCard } from "../program/experiment_card.ts";
import { cycleCard } from "./cards/cycle_card.ts";
import { requestMenu } from "./request_menu.ts";
import type { View } from "./start.ts";

export interface RelayEvents {
  /** The labels of the units on Start. */
  units(): Units | undefined;
  onIdentify(request: IdentifyRequest): void;
  /** The plant as typed, for the address. */
  onPlant(form: string, values: Record<string, string>): void;
}

export interface RelayView extends View {
  /** Takes a plant as typed, if one is given, and simulates. */
  open(form: string, values: Record<string, string>): void;
}

type SettingName = keyof RelaySettings;

const SETTINGS: {
  name: SettingName;
  label: string;
  hint: string;
  unit: keyof ReturnType<typeof unitNames> | "";
  value: string;
}[] = [
  { name: "u_plus", label: "Upper level", hint: "of u, from the operating point", unit: "u", value: "1" },
  { name: "u_minus", label: "Lower level", hint: "if its size differs from that of the upper level, the test is biased", unit: "u", value: "-1" },
  {
    name: "hysteresis",
    label: "Hysteresis",
    hint: "switches when y leaves it; 3 times the noise",
    unit: "y",
    value: "0",
  },
  { name: "cycles", label: "Cycles", hint: "recorded from the start", unit: "", value: "6" },
  { name: "noise_std", label: "Noise of y", hint: "standard deviation; it also affects the relay", unit: "y", value: "0" },
  {
    name: "relay_sample_time",
    label: "Relay sample time",
    hint: "0: switches at the instant of crossing",
    unit: "time",
    value: "0",
  },
  { name: "record_interval", label: "Record every", hint: "empty: 200 rows per period", unit: "time", value: "" },
  { name: "seed", label: "Seed", hint: "of the noise", unit: "", value: "0" },
];

export function relayView(announce: (sentence: string) => void, events: RelayEvents): RelayView {
  const errors = new FormErrors();
  let units = unitNames(undefined);
  let answer: RelayAnswer | null = null;
  let plot: Plot | null = null;
  const heading = h("h1", { tabindex: -1 }, "A relay test on this plant");
  const busy = h("p", { class: "hint busy", hidden: true }, "Simulating...");
  const plant = plantFields(
    errors,
    () => true,
    () => {
      const { form, values } = plant.typed();
      events.onPlant(form, values);
      simulate();
    },
  );
  const settings = SETTINGS.map((setting) => ({
    ...setting,
    field: textField({ ...setting, unit: "", pointer: () => `/relay/${setting.name}` }, errors),
  }));
  const settingsTitle = h("h2", { id: uniqueId("relay") }, "The relay");
  const form = h(
    "form",
    { class: "card relay-form", novalidate: true },
    h("h2", {}, "The plant"),
    plant.elements,
    settingsTitle,
    h(
      "div",
      { class: "fields", role: "group", "aria-labelledby": settingsTitle.id },
      settings.map(({ field }) => field.element),
    ),
    h("div", { class: "actions" }, h("button", { type: "submit", class: "primary" }, "Simulate")),
  );
  const slot = h("div", { class: "record-slot" });
  const identify = h("button", { type: "button", class: "primary", onclick: () => passOn() }, "Identify this record");
  const remarks = h("ul", { class: "notes" });
  const planTitle = h("h2", { id: uniqueId("plan") }, "Recommended test");
  const planText = h("div", { class: "stack" });
  const planCard = h("section", { class: "card plan", "aria-labelledby": planTitle.id }, planTitle, planText);
  const cycle = cycleCard();
  const program = experimentCard(announce);
  const stale = staleMark(() => results);
  const results = h(
    "div",
    { class: "relay-results" },
    stale.element,
    h("h2", { class: "visually-hidden" }, "The record"),
    slot,
    h("div", { class: "actions" }, identify),
    remarks,
    h("div", { class: "cards two" }, planCard, cycle.element),
  );
  results.hidden = true;
  const menu = requestMenu(announce);
  menu.show("", null);
  const element = h(
    "main",
    { class: "identify relay", id: "main" },
    h("div", { class: "identify-head" }, heading, busy, menu.element),
    errors.summary,
    h("div", { class: "relay-body" }, form, results),
    program.element,
  );

  function read(): { request: RelayRequest; errors: FieldError[] } {
    const reading = plant.read();
    const faults = [...reading.errors];
    const relay: RelaySettings = {};
    for (const { name, label, field } of settings) {
      if (field.input.value.trim() === "") continue;
      const parsed = parseNumber(field.input.value, label);
      if (parsed.ok) relay[name] = parsed.value;
      else faults.push({ pointer: `/relay/${name}`, detail: parsed.sentence });
    }
    return { request: { ...named(), plant: reading.plant, relay }, errors: faults };
  }

  function setBusy(now: boolean): void {
    busy.hidden = !now;
    element.toggleAttribute("data-busy", now);
  }

  const calls = latest<RelayRequest, RelayAnswer>(simulateRelay, {
    onBusy: setBusy,
    onAnswer(next, asked) {
      errors.clear();
      answer = next;
      menu.show("v1/experiments/relay", asked);
      results.hidden = false;
      markStale(false);
      const frame = relayFrame(next, asked.relay?.hysteresis ?? 0, units);
      if (plot) plot.update(frame);
      else {
        plot = createPlot(frame, announce);
        plot.element.classList.add("tall");
        slot.replaceChildren(plot.element);
      }
      const sentences = [
        ...(next.reversed ? ["The plant's gain is negative: the relay acts in the opposite direction."] : []),
        ...(next.warnings ?? []).map((warning) => warning.detail),
      ];
      remarks.hidden = sentences.length === 0;
      remarks.replaceChildren(...sentences.map((sentence) => h("li", {}, sentence)));
      cycle.show(next.limit_cycle, null, [], units);
      showPlan(next.plan);
      program.propose(next.plan, units);
      announce(`Oscillates with a period of ${formatNumber(next.limit_cycle.Pu, 4)} ${units.time}.`);
    },
    onError(error) {
      errors.fail(error);
      markStale(true);
    },
  });

  function showPlan(plan: RelayPlan | undefined): void {
    planCard.hidden = !plan;
    if (!plan) return;
    planText.replaceChildren(
      h("p", {}, planSentences(plan, units).join(" ")),
      ...(plan.reason ? [h("p", { class: "hint" }, plan.reason)] : []),
      h("div", { class: "actions" }, h("button", { type: "button", onclick: () => use(plan) }, "Use these settings")),
    );
  }

  function use(plan: RelayPlan): void {
    for (const { name, field } of settings) {
      const value = (plan as Record<string, unknown>)[name];
      // The planned relay records at the interval of the plan, unless it samples y more slowly.
      if (typeof value === "number" && name !== "record_interval")
        field.input.value = String(Number(value.toPrecision(4)));
    }
    simulate();
  }

  function markStale(now: boolean): void {
    stale.set(now);
    identify.disabled = now;
  }

  function named(): { units?: Units } {
    const units = events.units();
    return units ? { units } : {};
  }

  function simulate(): void {
    const now = read();
    errors.clear();
    if (now.errors.length === 0) return calls.send(now.request);
    // An answer in progress would belong to an earlier request than the refused one.
    calls.drop();
    setBusy(false);
    errors.show(now.errors);
    markStale(true);
  }

  function passOn(): void {
    if (answer) events.onIdentify({ ...named(), record: { ...answer.record } });
  }

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    // The service may still be parsing the typed line.
    void plant.settled().then(simulate);
  });

  return {
    element,
    heading,
    dispose() {
      calls.drop();
      plot?.dispose();
      program.dispose();
    },
    open(id, values) {
      units = unitNames(events.units());
      plant.setUnits(units);
      program.setUnits(units);
      for (const { unit, field } of settings) field.setUnit(unit === "" ? "" : units[unit]);
      if (id !== "") plant.loadTyped(id, values);
      simulate();
    },
  };
}
