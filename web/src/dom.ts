// Elements without a framework: created once, then updated. Text only ever enters as text nodes (no Trusted Types
// policy is needed).

export type Child = Node | string | number | null | undefined | false | Child[];
type AttributeValue = string | number | boolean | null | undefined | ((event: never) => void);

const SVG = "http://www.w3.org/2000/svg";
const MATHML = "http://www.w3.org/1998/Math/MathML";

function append(parent: Element, children: Child[]): void {
  for (const child of children) {
    if (Array.isArray(child)) append(parent, child);
    else if (child instanceof Node) parent.append(child);
    else if (child !== null && child !== undefined && child !== false) parent.append(String(child));
  }
}

/** An HTML element. Functions are listeners (`onclick`), `true` is a bare attribute, `false` and null leave the
    attribute out. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, AttributeValue> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value as unknown as EventListener);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, String(value));
  }
  append(element, children);
  return element;
}

/** Moves the focus of an element that is about to be removed or disabled to the first of these that can take it:
    otherwise the keyboard would start again at the top of the page. */
export function passFocus(from: Element, ...to: (HTMLElement | null)[]): void {
  if (!from.contains(document.activeElement)) return;
  to.find((element) => element && !element.matches(":disabled") && element.getClientRects().length > 0)?.focus();
}

/** Updates a part whose elements are made anew: the focus goes to the new element of the same kind and name. */
export function keepFocus(part: HTMLElement, update: () => void): void {
  const focused = document.activeElement;
  if (!(focused instanceof HTMLElement) || focused === part || !part.contains(focused)) return update();
  const nameOf = (element: Element): string => element.getAttribute("aria-label") ?? element.textContent ?? "";
  const name = nameOf(focused);
  const alike = (): HTMLElement[] => [...part.querySelectorAll<HTMLElement>(focused.tagName)].filter((element) => nameOf(element) === name);
  const at = alike().indexOf(focused);
  update();
  if (!focused.isConnected) (alike()[at] ?? alike()[0])?.focus({ preventScroll: true });
}

/** A menu under a summary element stays inside the window, and closes when the focus leaves it, or by Escape. */
export function closesItself(menu: HTMLDetailsElement): HTMLDetailsElement {
  menu.addEventListener("toggle", () => {
    menu.classList.remove("leftward");
    const right = menu.lastElementChild?.getBoundingClientRect().right ?? 0;
    menu.classList.toggle("leftward", menu.open && right > document.documentElement.clientWidth);
  });
  menu.addEventListener("focusout", (event) => {
    if (!(event.relatedTarget instanceof Node && menu.contains(event.relatedTarget))) menu.open = false;
  });
  menu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    menu.open = false;
    menu.querySelector("summary")?.focus();
  });
  return menu;
}

/** A card that can be folded away. */
export function foldingCard(title: string, aside: string, open: boolean, ...content: Child[]): HTMLElement {
  const heading = h("h2", { id: uniqueId("card") }, `${title} `, h("span", { class: "optional" }, aside));
  return h(
    "section",
    { class: "card optional-card", "aria-labelledby": heading.id },
    h("details", { open }, h("summary", {}, heading), h("div", { class: "stack" }, content)),
  );
}

/** A description of a node outside HTML: formulas and plots are built from it before they enter the page. */
export interface TreeNode {
  tag: string;
  attributes?: Record<string, string | number>;
  children?: (TreeNode | string)[];
}

/** Shorthand for TreeNode. */
export function node(
  tag: string,
  attributes: Record<string, string | number> = {},
  ...children: (TreeNode | string)[]
): TreeNode {
  return { tag, attributes, children };
}

function build(tree: TreeNode, namespace: string): Element {
  const element = document.createElementNS(namespace, tree.tag);
  for (const [name, value] of Object.entries(tree.attributes ?? {})) element.setAttribute(name, String(value));
  for (const child of tree.children ?? []) element.append(typeof child === "string" ? child : build(child, namespace));
  return element;
}

export const svgElement = (tree: TreeNode): SVGElement => build(tree, SVG) as SVGElement;
export const mathElement = (tree: TreeNode): MathMLElement => build(tree, MATHML) as MathMLElement;

/** Writes descriptions into an SVG element, one after another: unchanged nodes are not touched, so that only moving
    parts are laid out again. */
export function svgWriter(parent: Element): (children: TreeNode[]) => void {
  let before: (TreeNode | string)[] = [];
  return (children) => {
    rewrite(parent, before, children);
    before = children;
  };
}

function rewrite(parent: Element, before: (TreeNode | string)[], after: (TreeNode | string)[]): void {
  for (let index = before.length - 1; index >= after.length; index -= 1) parent.childNodes[index]!.remove();
  after.forEach((child, index) => {
    const old = before[index];
    if (old === undefined) parent.append(typeof child === "string" ? child : svgElement(child));
    else if (typeof child !== "string" && typeof old !== "string" && child.tag === old.tag)
      rewriteNode(parent.childNodes[index] as Element, old, child);
    else if (child !== old) parent.childNodes[index]!.replaceWith(typeof child === "string" ? child : svgElement(child));
  });
}

function rewriteNode(element: Element, before: TreeNode, after: TreeNode): void {
  const [old, now] = [before.attributes ?? {}, after.attributes ?? {}];
  for (const name of Object.keys(old)) if (!(name in now)) element.removeAttribute(name);
  for (const [name, value] of Object.entries(now)) if (old[name] !== value) element.setAttribute(name, String(value));
  rewrite(element, before.children ?? [], after.children ?? []);
}

/** Sets a text only if it has changed: setting the same text would cause a new layout. */
export function say(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** Sets an attribute only if it has changed. */
export function setAttribute(element: Element, name: string, value: string): void {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

let counter = 0;
/** An id that is unique in the page. */
export function uniqueId(prefix: string): string {
  counter += 1;
  return `${prefix}-${counter}`;
}

/** Long names of parameters, which may be broken between their parts. */
export const breakable = (name: string): (string | HTMLElement)[] =>
  name.split(/(?<=[._])/).flatMap((part, index) => (index === 0 ? [part] : [h("wbr", {}), part]));

/** Opens a modal dialog with a heading and a button that closes it; it is removed when it closes, and the focus returns to where it was. */
export function openDialog(title: string, name: string, ...content: Child[]): HTMLDialogElement {
  const heading = h("h2", { id: uniqueId("dialog") }, title);
  const close = h("button", { type: "button", class: "quiet", onclick: () => dialog.close() }, "Close");
  const dialog = h(
    "dialog",
    { class: `modal ${name}`, "aria-labelledby": heading.id },
    h("div", { class: "modal-head" }, heading, close),
    content,
  );
  dialog.addEventListener("close", () => dialog.remove());
  // A press on the backdrop has the dialog itself as its target, outside its rectangle.
  dialog.addEventListener("pointerdown", (event) => {
    const { left, right, top, bottom } = dialog.getBoundingClientRect();
    const inside = event.clientX >= left && event.clientX <= right && event.clientY >= top && event.clientY <= bottom;
    if (event.target === dialog && !inside) dialog.close();
  });
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}
