// Jobs in lists: their cells in words, and the orders of a batch.
import type { Controller, ListedJob, Outline, Plant } from "../api/types.ts";
import { verdictWords } from "./check.ts";
import { figureUnit } from "./figure_units.ts";
import { DASH, formatNumber, formatParameter, formatSetting, quotient, unitNames, withUnit } from "./numbers.ts";
import type { UnitNames } from "./numbers.ts";
import { plantTitle, plantWords } from "./plant.ts";

const MINUTE = 60;
const HOUR = 60 * MINUTE;
const DAY = 24 * HOUR;

/** "3 min": the time since then. */
export function age(created: string, now: number): string {
  const seconds = Math.max(0, (now - Date.parse(created)) / 1000);
  if (!Number.isFinite(seconds)) return DASH;
  if (seconds < MINUTE) return "now";
  if (seconds < HOUR) return `${Math.floor(seconds / MINUTE)} min`;
  if (seconds < DAY) return `${Math.floor(seconds / HOUR)} h`;
  return `${Math.floor(seconds / DAY)} d`;
}

const lag = (value: unknown): string =>
  typeof value === "number" && value !== 0 ? `(${shownFactor(value)}s + 1)` : "";
const shownFactor = (value: number): string => (value === 1 ? "" : formatParameter(value));

/** "2 e^(−3s)/(10s + 1)"; the kind of a plant without a short formula. */
export function shortPlant(outline: Outline | undefined): string {
  const plant = outline?.plant;
  if (outline?.range) return rangeOutline(outline.range);
  if (outline?.check) return checkOutline(outline.check);
  if (!plant) return DASH;
  const below = denominator(plant);
  if (below === null || typeof plant["K"] !== "number")
    return plant.type === "nonlinear" ? plantWords(plant, unitNames(outline.units)) : plantTitle(plant.type);
  const delay = typeof plant["L"] === "number" && plant["L"] !== 0 ? ` e^(−${shownFactor(plant["L"])}s)` : "";
  return `${formatParameter(plant["K"])}${delay}${below === "" ? "" : `/${below}`}`;
}

const rangeOutline = ({ scheduling, points }: NonNullable<Outline["range"]>): string =>
  `${points} points${scheduling ? ` over ${scheduling}` : ""}`;

/** "60 loops, first FIC101"; of one loop its cause. */
const checkOutline = ({ loops, tag, verdict }: NonNullable<Outline["check"]>): string =>
  loops === 1 ? verdictWords(verdict ?? "").toLowerCase() : `${loops ?? 0} loops${tag ? `, first ${tag}` : ""}`;

function denominator(plant: Plant): string | null {
  if (plant.type === "fopdt") return lag(plant["T"]);
  if (plant.type === "ipdt") return plant["T"] ? `(s${lag(plant["T"])})` : "s";
  if (plant.type !== "sopdt" || typeof plant["T1"] !== "number") return null;
  const factors = [lag(plant["T1"]), lag(plant["T2"])].filter(Boolean);
  return factors.length > 1 ? `(${factors.join("")})` : (factors[0] ?? "");
}

/** "robust", "robust of 12": the best of several. */
export function methodWords(outline: Outline | undefined): string {
  if (!outline?.method) return DASH;
  const name = outline.method.replaceAll("_", " ");
  return (outline.entries ?? 1) > 1 ? `${name}, best of ${outline.entries}` : name;
}

/** The reduction of the load IAE from today's, in percent; null if it is not known. */
export function gain(job: ListedJob): number | null {
  const [today, now] = [job.outline?.today?.load_IAE, job.outline?.load_IAE];
  return typeof today === "number" && typeof now === "number" && today > 0 ? 100 * (1 - now / today) : null;
}

/** The largest Ms on any plant that the loop may meet; a tuned loop without a known Ms counts as the riskiest. */
export function risk(job: ListedJob): number | null {
  const outline = job.outline;
  if (job.status !== "succeeded" || !outline?.method || outline.check) return null;
  const figure = outline.worst_Ms === undefined ? outline.Ms : outline.worst_Ms;
  return typeof figure === "number" ? figure : Infinity;
}

export interface BatchColumn {
  id: string;
  label: string;
  /** The text of the cell. */
  text(job: ListedJob): string;
  /** The value for sorting; null is last in both directions. */
  value(job: ListedJob): number | string | null;
  /** The first press sorts in descending order. */
  falls?: boolean;
}

const numbered = (
  id: string,
  label: string,
  read: (job: ListedJob) => number | null | undefined,
  falls = false,
): BatchColumn => ({
  id,
  label,
  falls,
  text: (job) => {
    const value = read(job);
    return value === Infinity ? "no margin" : formatNumber(value);
  },
  value: (job) => read(job) ?? null,
});

const FIRST_COLUMNS: BatchColumn[] = [
  { id: "index", label: "Loop", text: (job) => String((job.index ?? 0) + 1), value: (job) => job.index ?? 0 },
  { id: "name", label: "Name", text: (job) => job.name ?? `Loop ${(job.index ?? 0) + 1}`, value: (job) => job.name },
  { id: "plant", label: "Plant", text: (job) => shortPlant(job.outline), value: (job) => shortPlant(job.outline) },
  {
    id: "method",
    label: "Method",
    text: (job) => methodWords(job.outline),
    value: (job) => job.outline?.method ?? null,
  },
];

/** The unit in the heading if it is that of all loops, else in each cell. */
function loadColumn(jobs: readonly ListedJob[]): BatchColumn {
  const unitOf = (units: UnitNames): string => figureUnit("LoadPerformance", "IAE", units);
  const shared = sharedUnits(jobs);
  const column = numbered("iae", shared ? withUnit("Load IAE", unitOf(shared)) : "Load IAE", (job) => job.outline?.load_IAE, true);
  return {
    ...column,
    text: (job) => (shared || column.value(job) === null ? column.text(job) : `${column.text(job)} ${unitOf(unitNames(job.outline?.units))}`.trim()),
  };
}

const LAST_COLUMNS: BatchColumn[] = [
  {
    id: "gain",
    label: "Gain over today",
    falls: true,
    text: (job) => {
      const value = gain(job);
      return value === null ? DASH : `${formatNumber(value)} %`;
    },
    value: gain,
  },
  {
    id: "excess",
    label: "Above optimum",
    falls: true,
    text: (job) => {
      const value = job.outline?.excess_percent;
      return typeof value === "number" ? `${formatNumber(value)} %` : DASH;
    },
    value: (job) => job.outline?.excess_percent ?? null,
  },
  numbered("Ms", "Ms", (job) => job.outline?.Ms, true),
  numbered("risk", "Worst Ms", risk, true),
  { id: "status", label: "Status", text: (job) => job.status, value: (job) => job.status },
];

/** Settings of a controller; times and gains are in the units of the loops, if these are common. */
const SETTINGS: { id: string; unit(units: UnitNames): string; read(controller: Controller): number | null | undefined }[] = [
  { id: "Kp", unit: (units) => quotient(units.u, units.y), read: ({ Kp }) => Kp },
  { id: "Ki", unit: () => "", read: ({ Ki }) => Ki },
  { id: "Kd", unit: () => "", read: ({ Kd }) => Kd },
  { id: "Ti", unit: (units) => units.time, read: ({ Ti }) => Ti },
  { id: "Td", unit: (units) => units.time, read: ({ Td }) => Td || null },
  { id: "Tf", unit: (units) => units.time, read: ({ filter }) => filter?.Tf },
  { id: "b", unit: () => "", read: ({ b }) => b },
  { id: "Set-point filter", unit: (units) => units.time, read: ({ setpoint_filter }) => setpoint_filter?.T },
];

/** The settings of a loop that are shown next to each other: today's, then the new ones. */
const SIDES: { mark: string; of(job: ListedJob): Pick<Outline, "controller" | "to_type"> | undefined }[] = [
  { mark: " today", of: (job) => job.outline?.today },
  { mark: "", of: (job) => job.outline },
];

/** The units of all loops that were tuned, if they are common. */
function sharedUnits(jobs: readonly ListedJob[]): UnitNames | undefined {
  const all = jobs.filter((job) => job.outline?.controller).map((job) => unitNames(job.outline?.units));
  return all.every((units) => JSON.stringify(units) === JSON.stringify(all[0])) ? all[0] : undefined;
}

function settingColumns(jobs: readonly ListedJob[]): BatchColumn[] {
  const shared = sharedUnits(jobs);
  return SETTINGS.flatMap(({ id, unit, read }) =>
    SIDES.map(({ mark, of }) => {
      const value = (job: ListedJob): number | null => {
        const { controller, to_type: typed } = of(job) ?? {};
        return controller && !typed ? (read(controller) ?? null) : null;
      };
      return {
        id: `${id}${mark}`,
        label: shared ? withUnit(`${id}${mark}`, unit(shared)) : `${id}${mark}`,
        text: (job: ListedJob) => {
          const own = value(job) === null || shared ? "" : unit(unitNames(job.outline?.units));
          return `${formatSetting(value(job))}${own ? ` ${own}` : ""}`;
        },
        value,
      };
    }),
  );
}

/** More settings than this, of several products, are one text a loop. */
const MAX_SETTINGS = 10;

/** Columns of the settings to type into the product, two for each. */
function typedColumns(jobs: readonly ListedJob[]): BatchColumn[] {
  const names = [...new Set(jobs.flatMap((job) => Object.keys(job.outline?.to_type ?? {})))];
  if (names.length > MAX_SETTINGS)
    return SIDES.map(({ mark, of }) => {
      const text = (job: ListedJob): string =>
        Object.entries(of(job)?.to_type ?? {}).map(([name, typed]) => `${name} ${typed}`).join("; ") || DASH;
      return { id: `type${mark}`, label: `Settings${mark}`, text, value: text };
    });
  return names.flatMap((name) =>
    SIDES.map(({ mark, of }) => ({
      id: `type.${name}${mark}`,
      label: `${name}${mark}`,
      text: (job: ListedJob) => of(job)?.to_type?.[name] ?? DASH,
      value: (job: ListedJob) => {
        const text = of(job)?.to_type?.[name];
        const number = Number.parseFloat(text ?? "");
        return text === undefined ? null : Number.isNaN(number) ? text : number;
      },
    })),
  );
}

const ALWAYS = ["index", "name", "status"];

/** The columns for these loops: description, settings to enter, results; without columns that would hold only
    dashes. */
export function batchColumns(jobs: readonly ListedJob[]): BatchColumn[] {
  return [...FIRST_COLUMNS, ...typedColumns(jobs), ...settingColumns(jobs), loadColumn(jobs), ...LAST_COLUMNS].filter(
    (column) => ALWAYS.includes(column.id) || jobs.length === 0 || jobs.some((job) => column.text(job) !== DASH),
  );
}

/** In the order of a column; equal ones and those without a value keep their order. */
export function sorted<Row>(rows: readonly Row[], column: { value(row: Row): number | string | null }, falling: boolean): Row[] {
  const sign = falling ? -1 : 1;
  return [...rows].sort((a, b) => {
    const [left, right] = [column.value(a), column.value(b)];
    if (left === null || right === null) return Number(left === null) - Number(right === null);
    if (typeof left === "string" || typeof right === "string")
      return sign * String(left).localeCompare(String(right), undefined, { numeric: true });
    return left === right ? 0 : sign * (left < right ? -1 : 1);
  });
}
