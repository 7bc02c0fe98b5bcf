// Which parts of a form somebody has typed or chosen since it began to speak of its loop; the others were filled in, or are
// those of the loop before.

export interface Typed {
  has(part: string): boolean;
  /** From now on nothing counts as typed. */
  forget(): void;
}

/** `partOf`: the part that an input belongs to. What the page writes itself reports no event. */
export function typedParts(element: HTMLElement, partOf: (input: EventTarget | null) => string = () => ""): Typed {
  const parts = new Set<string>();
  for (const name of ["input", "change"]) element.addEventListener(name, (event) => parts.add(partOf(event.target)));
  return { has: (part) => parts.has(part), forget: () => parts.clear() };
}
