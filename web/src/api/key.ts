// The key of a service that requires one: stored for this tab only, asked for once however many calls wait for it.
const STORED_AS = "tunewright-key";

/** Asks the user for a key; null if none is given. `refused`: the last one was wrong. */
export type AskForKey = (refused: boolean) => Promise<string | null>;

let ask: AskForKey = () => Promise.resolve(null);
let asking: Promise<string | null> | null = null;

export function askForKeyWith(asker: AskForKey): void {
  ask = asker;
}

export function currentKey(): string | null {
  try {
    return sessionStorage.getItem(STORED_AS);
  } catch {
    return null;
  }
}

function keep(key: string): void {
  try {
    sessionStorage.setItem(STORED_AS, key);
  } catch {
    // Without storage the key is asked for again at the next call.
  }
}

/** A key other than `tried`, which was refused: one that was entered meanwhile, or one that is asked for now. */
export async function otherKey(tried: string | null): Promise<string | null> {
  const known = currentKey();
  if (known !== null && known !== tried) return known;
  asking ??= ask(tried !== null).finally(() => {
    asking = null;
  });
  const key = await asking;
  if (key !== null) keep(key);
  return key;
}
