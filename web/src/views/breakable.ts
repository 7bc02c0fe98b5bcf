// Long names of parameters, which may be broken where their parts meet.
import { h } from "../dom.ts";

export const breakable = (name: string): (string | HTMLElement)[] =>
  name.split(/(?<=[._])/).flatMap((part, index) => (index === 0 ? [part] : [h("wbr", {}), part]));
