// The page's state: one immutable workspace in a signal. Every change is a function from one workspace to the next; the
// display is updated once per frame, and only if its part of the workspace has changed.
import { computed, effect, signal, untracked } from "@preact/signals-core";
import type { ReadonlySignal } from "@preact/signals-core";
import type { Example, IdentifyRequest, Job, Method, ProductSummary } from "./api/types.ts";
import type { StepTexts } from "./form/own_step.ts";
import type { MyController } from "./my_controller.ts";
import type { Route } from "./routes.ts";

export interface Workspace {
  route: Route;
  job: Job | null;
  /** The reason why the job cannot be shown or followed at the moment, or "". */
  jobTrouble: string;
  /** The entry whose settings and verdict are shown; null: the one that the answer proposes. */
  selected: number | null;
  /** Indices of the entries drawn, at most four. Null: the default choice. */
  drawn: number[] | null;
  /** Order of the comparison: a column's id, with a minus for descending order; "" is the ranking. */
  sort: string;
  /** The limit on Ms below which rows are ranked, as typed; null: the request's. */
  rankMs: number | null;
  /** The user's own step as typed, by the names of its fields; null: the request's, or the proposed one. */
  step: StepTexts | null;
  /** The current recorded test. */
  test: IdentifyRequest | null;
  methods: Method[];
  /** Products. */
  products: ProductSummary[];
  /** The user's own product; the browser stores it. */
  mine: MyController | null;
  examples: Example[];
  recent: Job[];
  /** The reason why methods or examples could not be loaded, or "". */
  serviceTrouble: string;
}

export interface Store {
  get(): Workspace;
  set(change: (workspace: Workspace) => Workspace): void;
  /** A part of the workspace, or a value derived from it, as a signal: equal values are not a change. */
  pick<T>(select: (workspace: Workspace) => T): ReadonlySignal<T>;
  subscribe(listener: (workspace: Workspace, previous: Workspace) => void): () => void;
}

export function createStore(initial: Workspace): Store {
  const current = signal(initial);
  return {
    get: () => current.peek(),
    set(change) {
      current.value = change(current.peek());
    },
    pick: (select) => computed(() => select(current.value)),
    subscribe(listener) {
      let painted = current.peek();
      return shown(
        () => current.value,
        (workspace) => {
          const previous = painted;
          painted = workspace;
          if (previous !== workspace) listener(workspace, previous);
        },
      );
    },
  };
}

/** Shows a value now, and again in the frame after each change. Returns a function that stops it. */
export function shown<T>(read: () => T, show: (value: T) => void): () => void {
  let pending = false;
  let stopped = false;
  let first = true;
  const value = computed(read);
  const paint = (): void => {
    pending = false;
    if (!stopped) show(value.peek());
  };
  const stop = effect(() => {
    const now = value.value;
    if (first) {
      first = false;
      return untracked(() => show(now));
    }
    if (pending) return;
    pending = true;
    nextFrame(paint);
  });
  return () => {
    stopped = true;
    stop();
  };
}

/** A hidden tab gets no frames; its state must still be updated before it is shown. */
function nextFrame(work: () => void): void {
  if (document.hidden) setTimeout(work, 0);
  else requestAnimationFrame(work);
}
