// Values inside objects, by the names on the way to them.

/** Puts a value at its path; undefined puts nothing. */
export function place(target: Record<string, unknown>, path: string[], value: unknown): void {
  if (value === undefined) return;
  let at = target;
  for (const key of path.slice(0, -1)) {
    if (typeof at[key] !== "object" || at[key] === null) at[key] = {};
    at = at[key] as Record<string, unknown>;
  }
  at[path[path.length - 1]!] = value;
}

/** The value at a path, or undefined. */
export function pick(source: unknown, path: string[]): unknown {
  return path.reduce<unknown>(
    (at, key) => (typeof at === "object" && at !== null ? (at as Record<string, unknown>)[key] : undefined),
    source,
  );
}
