// Links to the pages of loops. What is shown of the work list is a part of the address: it is written when a link is
// used, so that it is that of the list as it is then.
import { h } from "../dom.ts";

/** Of a loop's page, by its place. */
export type LoopAddress = (place: number) => string;

export const loopLink = (place: number, tag: string, address: LoopAddress): HTMLAnchorElement =>
  h("a", { href: address(place), "data-loop": place }, tag);

/** Writes the address of each link of a part before it is followed or copied. */
export function followAddress(part: HTMLElement, address: LoopAddress): void {
  const write = (event: Event): void => {
    const link = event.target instanceof Element ? event.target.closest<HTMLAnchorElement>("a[data-loop]") : null;
    if (link) link.href = address(Number(link.dataset["loop"]));
  };
  for (const event of ["pointerdown", "focusin", "click"]) part.addEventListener(event, write, { capture: true });
}
