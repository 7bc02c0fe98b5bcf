// The user's own controller: its product, spans and sample time. The browser stores it for later designs.
import type { Implement, Need, ProductSummary, SettingValue, Span, TypedSettings } from "./api/types.ts";
import type { UnitNames } from "./words/numbers.ts";
import { productTitle } from "./words/products.ts";

export interface MyController {
  product: string;
  /** Its name in the list. */
  name: string;
  needs: Need[];
  y_span?: Span;
  u_span?: Span;
  sample_time?: number;
  /** The units of ranges and sample time. */
  units?: UnitNames;
}

const KEY = "tunewright-controller";

/** The needs that are not given yet. */
export const missingOf = (mine: MyController): Need[] => mine.needs.filter((need) => mine[need] === undefined);

/** The member of a request; null while something is missing. Spans that the product does not need are left out. */
export function implementOf(mine: MyController | null): (Implement & { product: string }) | null {
  if (!mine || missingOf(mine).length > 0) return null;
  const { product, needs, y_span, u_span, sample_time } = mine;
  return {
    product,
    ...(y_span && needs.includes("y_span") ? { y_span } : {}),
    ...(u_span && needs.includes("u_span") ? { u_span } : {}),
    ...(sample_time !== undefined ? { sample_time } : {}),
  };
}

type Spans = Pick<Implement, "product" | "y_span" | "u_span" | "sample_time">;

/** The same product with the same spans and sample time. */
export function sameImplement(a: Spans | null | undefined, b: Spans | null | undefined): boolean {
  const keyOf = (implement: Spans | null | undefined): string =>
    JSON.stringify(
      implement ? [implement.product, implement.y_span, implement.u_span, implement.sample_time].map((x) => x ?? null) : null,
    );
  return keyOf(a) === keyOf(b);
}

/** True if a request is for this controller: ranges that the product does not need do not count. */
export function isFor(implement: Spans | null | undefined, mine: MyController | null): boolean {
  const ofMine = implementOf(mine);
  if (!mine || implement?.product !== mine.product) return sameImplement(implement, ofMine);
  const { product, name, needs } = mine;
  return sameImplement(implementOf(mineOfRequest(implement, { product, name, needs })), ofMine);
}

/** The controller for which a request was made; the current one if it names none. A request contains neither name
    nor needs. */
export function mineOfRequest(implement: Implement | undefined, mine: MyController | null): MyController | null {
  const { product, y_span, u_span, sample_time } = implement ?? {};
  if (product === undefined) return mine;
  return {
    ...(product === mine?.product ? unasked(mine) : { product, name: product, needs: [] }),
    ...(y_span ? { y_span } : {}),
    ...(u_span ? { u_span } : {}),
    ...(sample_time !== undefined ? { sample_time } : {}),
  };
}

/** Ranges that the product does not need are in no request, but are kept. */
function unasked({ product, name, needs, y_span, u_span, units }: MyController): MyController {
  return {
    ...(units ? { units } : {}),
    product,
    name,
    needs,
    ...(y_span && !needs.includes("y_span") ? { y_span } : {}),
    ...(u_span && !needs.includes("u_span") ? { u_span } : {}),
  };
}

/** For a loop in these units: numbers given in other units are dropped. An unnamed unit may be any, and is kept in mind. */
export function inUnits(mine: MyController | null, units: UnitNames): MyController | null {
  const { y_span, u_span, sample_time, units: given, ...rest } = mine ?? {};
  if (!mine || !given) return mine;
  const fits = (name: keyof UnitNames): boolean => given[name] === "" || units[name] === "" || given[name] === units[name];
  return {
    ...(rest as MyController),
    ...(y_span && fits("y") ? { y_span } : {}),
    ...(u_span && fits("u") ? { u_span } : {}),
    ...(sample_time !== undefined && fits("time") ? { sample_time } : {}),
    units: { time: units.time || given.time, u: units.u || given.u, y: units.y || given.y },
  };
}

/** The same controller with its name and its needs from the list. */
export function named(mine: MyController | null, products: readonly ProductSummary[]): MyController | null {
  const product = products.find((item) => item.id === mine?.product);
  if (!mine || !product) return mine;
  const name = productTitle(product);
  const same = mine.name === name && JSON.stringify(mine.needs) === JSON.stringify(product.needs);
  return same ? mine : { ...mine, name, needs: product.needs as Need[] };
}

/** Settings in it, as a request gives them: with spans and sample time like `implement`. */
export function typedInto(
  { product, y_span, u_span, sample_time }: Pick<MyController, "product" | "y_span" | "u_span" | "sample_time">,
  settings: Record<string, SettingValue>,
): TypedSettings {
  return {
    product,
    settings,
    ...(y_span ? { y_span } : {}),
    ...(u_span ? { u_span } : {}),
    ...(sample_time !== undefined ? { sample_time } : {}),
  };
}

export function rememberMine(mine: MyController | null): void {
  try {
    if (mine) localStorage.setItem(KEY, JSON.stringify(mine));
    else localStorage.removeItem(KEY);
  } catch {
    // Without storage the browser forgets the choice; nothing else depends on it.
  }
}

export function rememberedMine(): MyController | null {
  try {
    return readMine(JSON.parse(localStorage.getItem(KEY) ?? "null"));
  } catch {
    return null;
  }
}

const NEEDS: readonly string[] = ["y_span", "u_span", "sample_time"];

/** The stored text may come from an older page, or from elsewhere. */
export function readMine(data: unknown): MyController | null {
  if (typeof data !== "object" || data === null) return null;
  const { product, name, needs, y_span, u_span, sample_time, units } = data as Record<string, unknown>;
  if (typeof product !== "string" || typeof name !== "string" || !Array.isArray(needs)) return null;
  return {
    product,
    name,
    needs: needs.filter((need): need is Need => NEEDS.includes(need as string)),
    ...(isSpan(y_span) ? { y_span } : {}),
    ...(isSpan(u_span) ? { u_span } : {}),
    ...(typeof sample_time === "number" && sample_time > 0 ? { sample_time } : {}),
    ...(isUnits(units) ? { units: { time: units.time, u: units.u, y: units.y } } : {}),
  };
}

const isUnits = (value: unknown): value is UnitNames =>
  typeof value === "object" &&
  value !== null &&
  ["time", "u", "y"].every((name) => typeof (value as Record<string, unknown>)[name] === "string");

const isSpan = (value: unknown): value is Span =>
  Array.isArray(value) &&
  value.length === 2 &&
  value.every((end) => typeof end === "number" && Number.isFinite(end)) &&
  (value[0] as number) < (value[1] as number);
