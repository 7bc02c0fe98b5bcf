// Shared cursors and zoom ranges: plots with the same link name share them.
import type { Range } from "./axis.ts";

export interface CursorPosition {
  value: number | null;
  /** The plot that moved it, which shows the figures. */
  source: object | null;
}

export interface Listener {
  onCursor(position: CursorPosition): void;
  /** Another plot shows that range, or everything. */
  onZoom(stretch: Range | null): void;
}

const links = new Map<string, Set<Listener>>();

export function joinLink(name: string, listener: Listener): () => void {
  const listeners = links.get(name) ?? new Set<Listener>();
  links.set(name, listeners);
  listeners.add(listener);
  return () => {
    listeners.delete(listener);
    if (listeners.size === 0) links.delete(name);
  };
}

export function moveCursor(name: string, position: CursorPosition): void {
  for (const listener of links.get(name) ?? []) listener.onCursor(position);
}

/** `mine`: the plot that shows it already. */
export function zoomTogether(name: string, stretch: Range | null, mine: Listener): void {
  for (const listener of links.get(name) ?? []) if (listener !== mine) listener.onZoom(stretch);
}

/** Index of the sample nearest to the value; -1 for an empty list. The list increases or decreases. */
export function nearestIndex(list: readonly (number | null)[], value: number): number {
  let best = -1;
  let distance = Infinity;
  for (let index = 0; index < list.length; index += 1) {
    const sample = list[index];
    if (typeof sample !== "number" || !Number.isFinite(sample)) continue;
    const away = Math.abs(sample - value);
    if (away < distance) {
      distance = away;
      best = index;
    }
  }
  return best;
}
