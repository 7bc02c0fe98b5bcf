// The parts of a form that the user has typed or chosen for the current loop; the others were filled in, or belong to
// the previous loop.

export interface Typed {
  has(part: string): boolean;
  /** From now on no part counts as typed. */
  forget(): void;
  /** The typed parts, to count as typed again later. */
  list(): string[];
  note(parts: readonly string[]): void;
}

/** `partOf`: the part that contains an input. Texts written by the page itself cause no event. */
export function typedParts(
  elements: readonly HTMLElement[],
  partOf: (input: EventTarget | null) => string = () => "",
): Typed {
  const parts = new Set<string>();
  for (const element of elements)
    for (const name of ["input", "change"]) element.addEventListener(name, (event) => parts.add(partOf(event.target)));
  return {
    has: (part) => parts.has(part),
    forget: () => parts.clear(),
    list: () => [...parts],
    note: (typed) => typed.forEach((part) => parts.add(part)),
  };
}
