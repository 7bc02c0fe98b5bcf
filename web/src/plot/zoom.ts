// Zooming in pixels, so that linear and logarithmic axes behave alike. Equal axes stay equal: the layout extends the
// narrower one.
import type { Range, Scale } from "./axis.ts";
import type { Frame } from "./frame.ts";
import type { Layout, PaneBox, View } from "./layout.ts";

/** With less vertical movement a drag zooms time only. */
const TALL_PX = 16;
const NARROWEST = 1e-6;

const ordered = (scale: Scale, a: number, b: number): Range => {
  const [p, q] = [scale.toValue(a), scale.toValue(b)];
  return p < q ? [p, q] : [q, p];
};

const tooNarrow = ([lo, hi]: Range): boolean => !(hi - lo > NARROWEST * Math.max(Math.abs(lo), Math.abs(hi)));

/** The range between two pixels, within the box. */
export function stretchOf(box: PaneBox, a: number, b: number): Range {
  const inside = (pixel: number): number => Math.max(box.left, Math.min(box.left + box.width, pixel));
  return ordered(box.x, inside(a), inside(b));
}

export function zoomToRectangle(
  frame: Frame,
  layout: Layout,
  view: View,
  box: PaneBox,
  from: { x: number; y: number },
  to: { x: number; y: number },
): View {
  const inX = (pixel: number): number => Math.max(box.left, Math.min(box.left + box.width, pixel));
  const inY = (pixel: number): number => Math.max(box.top, Math.min(box.top + box.height, pixel));
  const index = layout.boxes.indexOf(box);
  const x = ordered(box.x, inX(from.x), inX(to.x));
  const tall = frame.equal || Math.abs(to.y - from.y) > TALL_PX;
  const y = tall ? ordered(box.y, inY(from.y), inY(to.y)) : null;
  if (tooNarrow(x) || (y !== null && tooNarrow(y))) return view;
  return { x, y: view.y.map((old, at) => (at === index && y !== null ? y : old)) };
}

/** Scales the x range (and y, if the axes are equal) around a pixel: factor < 1 zooms in. */
export function zoomAbout(frame: Frame, layout: Layout, view: View, pixel: number, factor: number): View {
  const box = layout.boxes[0]!;
  const around = (scale: Scale, centre: number, low: number, high: number): Range =>
    ordered(scale, centre + (low - centre) * factor, centre + (high - centre) * factor);
  const x = around(box.x, pixel, box.left, box.left + box.width);
  const middle = box.top + box.height / 2;
  const y = frame.equal ? around(box.y, middle, box.top, box.top + box.height) : null;
  if (tooNarrow(x)) return view;
  return { x, y: view.y.map((old, at) => (at === 0 && y !== null ? y : old)) };
}
