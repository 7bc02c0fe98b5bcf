// The page's state: one immutable workspace. Every change is a function from one workspace to the next; subscribers run once per frame.
import type { ProductSummary } from "./api/products.ts";
import type { Example, IdentifyRequest, Job, Method } from "./api/types.ts";
import type { MyController } from "./my_controller.ts";
import type { Route } from "./routes.ts";

export interface Workspace {
  route: Route;
  job: Job | null;
  /** Why the job cannot be shown or followed at the moment, or "". */
  jobTrouble: string;
  /** Whose settings and verdict are shown; null: the first entry that has an answer. */
  selected: number | null;
  /** Indices of the entries drawn, at most four. Null: the default choice. */
  drawn: number[] | null;
  /** Order of the league table: a column's id, with a minus where it falls; "" is the ranking. */
  sort: string;
  /** The recorded test that is being looked at. */
  test: IdentifyRequest | null;
  methods: Method[];
  /** Controllers as they are built. */
  products: ProductSummary[];
  /** The one that the user has; the browser remembers it. */
  mine: MyController | null;
  examples: Example[];
  recent: Job[];
  /** Why methods or examples could not be had, or "". */
  serviceTrouble: string;
}

export interface Store {
  get(): Workspace;
  set(change: (workspace: Workspace) => Workspace): void;
  subscribe(listener: (workspace: Workspace, previous: Workspace) => void): () => void;
}

export function createStore(initial: Workspace): Store {
  let current = initial;
  let painted = initial;
  let pending = false;
  const listeners = new Set<(workspace: Workspace, previous: Workspace) => void>();
  const flush = (): void => {
    pending = false;
    const previous = painted;
    painted = current;
    for (const listener of [...listeners]) listener(current, previous);
  };
  return {
    get: () => current,
    set(change) {
      const next = change(current);
      if (next === current) return;
      current = next;
      if (!pending) {
        pending = true;
        // A hidden tab gets no frames; its state must still be painted when it is looked at.
        if (document.hidden) setTimeout(flush, 0);
        else requestAnimationFrame(flush);
      }
    },
    subscribe(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
}
