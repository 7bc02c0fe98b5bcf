// The parts of a form that the user has typed or chosen for the current loop; the others were filled in, or belong to
// the previous loop.

export interface Typed {
  has(part: string): boolean;
  /** From now on no part counts as typed. */
  forget(): void;
}

/** `partOf`: the part that contains an input. Texts written by the page itself cause no event. */
export function typedParts(element: HTMLElement, partOf: (input: EventTarget | null) => string = () => ""): Typed {
  const parts = new Set<string>();
  for (const name of ["input", "change"]) element.addEventListener(name, (event) => parts.add(partOf(event.target)));
  return { has: (part) => parts.has(part), forget: () => parts.clear() };
}
