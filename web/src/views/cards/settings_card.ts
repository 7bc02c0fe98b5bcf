// "Settings to enter": the chosen controller in the form of the user's controller.
import type { Entry, WhyNull } from "../../api/types.ts";
import { h, uniqueId } from "../../dom.ts";
import { filterWords } from "../../words/figures.ts";
import { formatSetting, plainSetting, quotient, withUnit } from "../../words/numbers.ts";
import type { UnitNames } from "../../words/numbers.ts";
import { copyButton } from "../copy.ts";

export type SettingsForm = "ideal" | "parallel" | "series" | "npid";

export interface Setting {
  name: string;
  unit: string;
  value: number | null;
}

/** A controller of any form. */
type EquivalentSettings = { b?: number; why_null?: WhyNull } & Partial<Record<"Kp" | "Ki" | "Kd" | "Ti" | "Td", number | null>>;

/** The settings of one form, or a sentence why that form does not exist. */
export function settingsOf(entry: Entry, form: SettingsForm, units: UnitNames): Setting[] | string {
  const controller = entry.controller;
  if (!controller) return "There is no controller to enter.";
  const gain = quotient(units.u, units.y);
  const per = gain ? `${gain}/${units.time}` : `1/${units.time}`;
  const times = gain ? `${gain} ${units.time}` : units.time;
  const filter: Setting[] =
    typeof controller.filter?.Tf === "number" ? [{ name: "Tf", unit: units.time, value: controller.filter.Tf }] : [];
  const lag = controller.setpoint_filter?.T;
  /** Parts that act on the set point only, if b is not 1. */
  const weights = (b: number | undefined): Setting[] => [
    ...(typeof b === "number" && b !== 1 ? [{ name: "b", unit: "", value: b }] : []),
    ...(typeof lag === "number" ? [{ name: "Set-point filter", unit: units.time, value: lag }] : []),
  ];
  if (form === "ideal" || form === "npid") {
    const { delta_r } = controller;
    const delta: Setting[] =
      form === "npid" && typeof delta_r === "number" ? [{ name: "delta_r", unit: units.y, value: delta_r }] : [];
    return [
      { name: "Kp", unit: gain, value: controller.Kp ?? null },
      { name: "Ti", unit: units.time, value: controller.Ti ?? null },
      { name: "Td", unit: units.time, value: controller.Td ?? 0 },
      ...delta,
      ...filter,
      ...weights(controller.b),
    ];
  }
  const equivalent: EquivalentSettings | null | undefined = entry.equivalents?.[form];
  if (!equivalent || typeof equivalent.Kp !== "number") {
    const why = equivalent?.why_null ?? entry.equivalents?.why_null;
    return (
      why?.[form] ??
      why?.["Kp"] ??
      Object.values(why ?? {})[0] ??
      `This controller has no ${form} form: its zeros are complex. Enter it in the ideal or parallel form.`
    );
  }
  if (form === "parallel") {
    return [
      { name: "Kp", unit: gain, value: equivalent.Kp },
      { name: "Ki", unit: per, value: equivalent.Ki ?? null },
      { name: "Kd", unit: times, value: equivalent.Kd ?? null },
      ...filter,
      ...weights(equivalent.b),
    ];
  }
  return [
    { name: "Kp", unit: gain, value: equivalent.Kp },
    { name: "Ti", unit: units.time, value: equivalent.Ti ?? null },
    { name: "Td", unit: units.time, value: equivalent.Td ?? null },
    ...filter,
    ...weights(equivalent.b),
  ];
}

/** The text for the clipboard. */
export function settingsText(form: SettingsForm, settings: Setting[]): string {
  const lines = settings.map(
    (setting) =>
      `${setting.name} = ${setting.value === null ? "off" : plainSetting(setting.value)}${setting.unit && setting.value !== null ? ` ${setting.unit}` : ""}`,
  );
  return [`form: ${form}`, ...lines].join("\n");
}

const FORMULAS: Record<SettingsForm, string> = {
  ideal: "Kp (1 + 1/(Ti s) + Td s)",
  parallel: "Kp + Ki/s + Kd s",
  series: "Kp (1 + 1/(Ti s)) (1 + Td s)",
  npid: "Kp (e + 1/Ti ∫ exp(−e²/(2 delta_r²)) e dt − Td dy/dt)",
};

export interface SettingsCard {
  element: HTMLElement;
  show(entry: Entry, name: string, units: UnitNames): void;
}

export function settingsCard(announce: (sentence: string) => void): SettingsCard {
  /** The chosen form; a nonlinear controller has only its own. */
  let chosen: SettingsForm = "ideal";
  let shown: { entry: Entry; name: string; units: UnitNames } | null = null;
  const titleId = uniqueId("settings-title");
  const group = uniqueId("form");
  const title = h("h2", { id: titleId }, "Settings to enter");
  const body = h("div", {});
  const copy = copyButton({ label: "Copy", text: copied }, announce);
  const radios = (["ideal", "parallel", "series"] as const).map((name) => {
    const input = h("input", { type: "radio", name: group, value: name, checked: name === chosen });
    input.addEventListener("change", () => {
      chosen = name;
      write();
    });
    return h("label", {}, input, h("span", {}, name));
  });
  const segments = h("fieldset", { class: "segments" }, h("legend", { class: "visually-hidden" }, "Form"), radios);
  const element = h("section", { class: "card settings", "aria-labelledby": titleId }, h("div", { class: "head" }, title, copy), segments, body);

  const formOf = (entry: Entry): SettingsForm => (entry.controller?.form === "npid" ? "npid" : chosen);

  function write(): void {
    if (!shown) return;
    title.textContent = `Settings to enter: ${shown.name}`;
    const form = formOf(shown.entry);
    segments.hidden = form === "npid";
    const settings = settingsOf(shown.entry, form, shown.units);
    copy.hidden = typeof settings === "string";
    if (typeof settings === "string") {
      body.replaceChildren(h("p", {}, settings));
      return;
    }
    const filter = shown.entry.controller?.filter;
    const weights = shown.entry.controller;
    body.replaceChildren(
      h(
        "table",
        { class: "figures" },
        h("caption", { class: "visually-hidden" }, `Settings of ${shown.name} in ${form} form`),
        h(
          "tbody",
          {},
          settings.map((setting) =>
            h(
              "tr",
              {},
              h("th", { scope: "row" }, withUnit(setting.name, setting.unit)),
              h("td", {}, setting.value === null ? "off" : formatSetting(setting.value)),
            ),
          ),
        ),
      ),
      h(
        "p",
        { class: "hint" },
        `${FORMULAS[form]}; set-point weights b ${formatSetting(weights?.b ?? 1)}, c ${formatSetting(weights?.c ?? 0)}; filter ${filterWords(filter?.type)}${weights?.action ? `; ${weights.action} action` : ""}.`,
      ),
    );
  }

  function copied(): string | null {
    if (!shown) return null;
    const form = formOf(shown.entry);
    const settings = settingsOf(shown.entry, form, shown.units);
    return typeof settings === "string" ? null : settingsText(form, settings);
  }

  return {
    element,
    show(entry, name, units) {
      shown = { entry, name, units };
      write();
    },
  };
}
