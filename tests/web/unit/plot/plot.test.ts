import assert from "node:assert/strict";
import test from "node:test";
import { nearestIndex } from "../../../../web/src/plot/cursor.ts";
import { makeScale } from "../../../../web/src/plot/axis.ts";
import { columnExtremes, drawableRuns } from "../../../../web/src/plot/dense.ts";
import { fileNameOf, frameToCsv, frameToSvg } from "../../../../web/src/plot/export.ts";
import type { Frame, Mark } from "../../../../web/src/plot/frame.ts";
import { markLabels } from "../../../../web/src/plot/labels.ts";
import { layoutFrame, wholeView } from "../../../../web/src/plot/layout.ts";
import { axisName, drawLayout, legibleTicks, pointNear, tracePath } from "../../../../web/src/plot/marks.ts";
import { readings } from "../../../../web/src/plot/readout.ts";
import { zoomAbout, zoomToRectangle } from "../../../../web/src/plot/zoom.ts";

const plane: Frame = {
  title: "Curve <&> circle",
  description: 'Says "nothing" & more.',
  x: { kind: "linear", label: "Re", range: [-2, 1] },
  panes: [
    {
      y: { kind: "linear", label: "Im", range: [-1, 1] },
      traces: [1, 2, 3, 4].map((look) => ({
        name: `trace ${look}`,
        look: look as 1 | 2 | 3 | 4,
        x: [-1, 0, null, 0.5],
        y: [0, 0.5, 1, NaN],
        parameter: [1, 2, 3, 4],
      })),
      marks: [
        { kind: "circle", x: -1, y: 0, radius: 0.7, label: "Ms 1.4", labelAt: "above" },
        { kind: "point", x: -1, y: 0, label: "−1" },
        { kind: "level", value: 0.2, role: "limit", label: "limit" },
        { kind: "upright", value: 0, role: "zero" },
      ],
    },
  ],
  equal: true,
  link: "omega",
  cursorLabel: "ω (rad/s)",
  cursorKind: "log",
  fileName: "plane",
};

const times: Frame = {
  ...plane,
  equal: false,
  x: { kind: "linear", label: "time (s)" },
  panes: [
    { y: { kind: "linear", label: "y" }, traces: [{ name: "a", look: 1, x: [0, 1, 2], y: [0, 1, 0.5] }], weight: 2 },
    { y: { kind: "log", label: "u" }, traces: [{ name: "a", look: 1, x: [0, 1, 2], y: [0, 1, 10] }] },
  ],
};

const empty: Frame = {
  ...times,
  panes: [{ y: { kind: "log", label: "|S|" }, traces: [] }],
  x: { kind: "log", label: "ω" },
};

test("an exported SVG holds no class, style, variable or unescaped text, and has title, description and the circle's transparency", () => {
  const svg = frameToSvg(plane, wholeView(plane), 500, 300, (token) => (token === "--surface" ? "#ffffff" : "#123456"));
  assert.doesNotMatch(svg, /\sclass=|\sstyle=|<style|var\(/);
  assert.match(svg, /<title>Curve &lt;&amp;&gt; circle<\/title>/);
  assert.match(svg, /<desc>Says "nothing" &amp; more\.<\/desc>/);
  assert.match(svg, /fill-opacity="0\.07"/);
  assert.match(svg, /stroke-dasharray="12 3"/);
  assert.doesNotMatch(svg, /NaN|undefined|Infinity|null/);
  assert.match(svg, /^<svg xmlns="http:\/\/www\.w3\.org\/2000\/svg"/);
});

test("every colour that drawings use is a token", () => {
  const asked = new Set<string>();
  frameToSvg(plane, wholeView(plane), 500, 300, (token) => {
    asked.add(token);
    return "#000000";
  });
  for (const token of [
    "--series-1",
    "--series-2",
    "--series-3",
    "--series-4",
    "--limit",
    "--grid",
    "--text",
    "--muted",
    "--surface",
    "--bad",
  ])
    assert.ok(asked.has(token), token);
});

test("a plot without data is drawn with axes and no broken number", () => {
  const svg = frameToSvg(empty, wholeView(empty), 400, 200, () => "#000000");
  assert.doesNotMatch(svg, /NaN|undefined|Infinity/);
  assert.ok(drawLayout(empty, layoutFrame(empty, 400, 200, wholeView(empty)), "c").length > 0);
});

test("equal axes are equal at first and stay so through every zoom", () => {
  const unit = (layout: ReturnType<typeof layoutFrame>): [number, number] => {
    const box = layout.boxes[0]!;
    return [box.x.toPixel(1) - box.x.toPixel(0), box.y.toPixel(0) - box.y.toPixel(1)];
  };
  let view = wholeView(plane);
  for (let step = 0; step < 4; step += 1) {
    const layout = layoutFrame(plane, 640, 300, view);
    const [x, y] = unit(layout);
    assert.ok(Math.abs(x / y - 1) < 1e-9, `step ${step}: ${x} ${y}`);
    const box = layout.boxes[0]!;
    view =
      step % 2 === 0
        ? zoomToRectangle(
            plane,
            layout,
            view,
            box,
            { x: box.left + 50, y: box.top + 20 },
            { x: box.left + 250, y: box.top + 60 },
          )
        : zoomAbout(plane, layout, view, box.left + 100, 0.5);
  }
});

test("panes of one plot share their x axis, and a flat drag zooms x alone", () => {
  const layout = layoutFrame(times, 500, 300, wholeView(times));
  assert.deepEqual(layout.boxes[0]!.x.range, layout.boxes[1]!.x.range);
  assert.ok(layout.boxes[0]!.height > 1.9 * layout.boxes[1]!.height);
  const box = layout.boxes[0]!;
  const view = zoomToRectangle(
    times,
    layout,
    wholeView(times),
    box,
    { x: box.left + 50, y: 40 },
    { x: box.left + 150, y: 44 },
  );
  assert.notEqual(view.x, null);
  assert.deepEqual(view.y, [null, null]);
});

test("a logarithmic pane skips zero, gaps break the line", () => {
  const layout = layoutFrame(times, 500, 300, wholeView(times));
  const path = tracePath(layout.boxes[1]!, times.panes[1]!.traces[0]!);
  assert.equal(path.match(/[ML]/g)?.length, 2);
  assert.deepEqual(drawableRuns([0, 1, null, 3], [1, 1, 1, 1], false, false), [
    [0, 1],
    [3, 3],
  ]);
  assert.deepEqual(drawableRuns([], [], false, false), []);
});

test("long traces keep the extremes of each pixel column", () => {
  const values = Array.from({ length: 100 }, (_, index) => (index === 57 ? 9 : index === 12 ? -9 : Math.sin(index)));
  const kept = columnExtremes(
    values.map((_, index) => Math.floor(index / 50)),
    values,
  );
  assert.ok(kept.includes(57) && kept.includes(12) && kept.includes(0) && kept.includes(99));
  assert.ok(kept.length <= 8);
  assert.deepEqual(
    kept,
    [...kept].sort((a, b) => a - b),
  );
});

test("a cursor finds the nearest sample", () => {
  assert.equal(nearestIndex([0, 1, 2], 1.4), 1);
  assert.equal(nearestIndex([null, 5], -3), 1);
  assert.equal(nearestIndex([], 1), -1);
});

test("the CSV export has every sample with its trace and axis", () => {
  const lines = frameToCsv(times).trim().split("\r\n");
  assert.equal(lines.length, 7);
  assert.equal(lines[0], "trace,axis,time (s),value");
  assert.equal(lines[2], "a,y,1,1");
});

test("while something is held the ranges only grow, and a zoom stays what it is", () => {
  const rising = (top: number): Frame => ({
    title: "t",
    description: "",
    x: { kind: "linear", label: "x" },
    panes: [{ y: { kind: "linear", label: "y" }, traces: [{ name: "a", look: 1, x: [0, top], y: [0, top] }] }],
    link: "x",
    cursorLabel: "x",
    cursorKind: "linear",
    fileName: "f",
  });
  const wide = layoutFrame(rising(10), 400, 300, wholeView(rising(10)));
  const held = layoutFrame(rising(4), 400, 300, wholeView(rising(4)), wide);
  assert.deepEqual(held.boxes[0]!.y.range, wide.boxes[0]!.y.range);
  assert.deepEqual(held.boxes[0]!.x.range, wide.boxes[0]!.x.range);
  const grown = layoutFrame(rising(20), 400, 300, wholeView(rising(20)), held);
  assert.ok(grown.boxes[0]!.y.range[1] > 20);
  const zoomed = layoutFrame(rising(4), 400, 300, { x: [1, 2], y: [[0, 3]] }, wide);
  assert.deepEqual([zoomed.boxes[0]!.x.range, zoomed.boxes[0]!.y.range], [[1, 2], [0, 3]]);
});

test("a handle is found from near by, and no other point", () => {
  const frame: Frame = {
    title: "t",
    description: "",
    x: { kind: "linear", label: "x", range: [0, 10] },
    panes: [
      {
        y: { kind: "linear", label: "y", range: [0, 10] },
        traces: [],
        marks: [
          { kind: "point", x: 5, y: 5, label: "here", handle: true },
          { kind: "point", x: 5.1, y: 5, label: "a rule", quiet: true },
        ],
      },
    ],
    link: "x",
    cursorLabel: "x",
    cursorKind: "linear",
    fileName: "f",
  };
  const box = layoutFrame(frame, 400, 300, wholeView(frame)).boxes[0]!;
  const near = { x: box.x.toPixel(5) + 6, y: box.y.toPixel(5) - 6 };
  assert.equal(pointNear(box, near, 12, (mark) => mark.handle === true)?.label, "here");
  assert.equal(pointNear(box, near, 12, (mark) => mark.quiet === true)?.label, "a rule");
  assert.equal(pointNear(box, { x: near.x + 40, y: near.y }, 12, () => true), null);
});

test("zoomed in time, y shows what is in view; what was zoomed by hand stays", () => {
  const frame: Frame = { ...times, panes: [{ y: { kind: "linear", label: "y" }, traces: [{ name: "a", look: 1, x: [0, 1, 2, 3, 4], y: [0, 100, 1, 2, 1] }] }] };
  const at = (view: ReturnType<typeof wholeView>) => layoutFrame(frame, 400, 300, view).boxes[0]!.y.range;
  assert.ok(at(wholeView(frame))[1] > 100);
  const [lo, hi] = at({ x: [3, 4], y: [null] });
  assert.ok(lo < 1 && lo > 0 && hi > 2 && hi < 3);
  assert.deepEqual(at({ x: [3, 4], y: [[0, 7]] }), [0, 7]);
});

test("turns about the origin that run into each other are a disc; enlarged they are the curve", () => {
  const turns = [...Array(400).keys()].map((k) => k / 6);
  const trace = { name: "L", look: 1 as const, x: turns.map((t) => 0.2 * Math.cos(t)), y: turns.map((t) => 0.2 * Math.sin(t)), parameter: turns };
  const frame: Frame = { ...plane, panes: [{ ...plane.panes[0]!, traces: [{ ...trace, winding: { from: 40, radius: 0.2 } }], marks: [] }] };
  const drawn = (view: ReturnType<typeof wholeView>) => {
    const layout = layoutFrame(frame, 400, 300, view);
    return { corners: tracePath(layout.boxes[0]!, frame.panes[0]!.traces[0]!).split("L").length, discs: JSON.stringify(drawLayout(frame, layout, "p")).split('"circle"').length - 1 };
  };
  assert.deepEqual(drawn(wholeView(frame)), { corners: 41, discs: 1 });
  assert.deepEqual(drawn({ x: [-0.25, 0.25], y: [[-0.25, 0.25]] }), { corners: 400, discs: 0 });
});

test("names of marks stand neither on one another nor where the curve runs, where there is another place", () => {
  const level = (value: number, label: string): Mark => ({ kind: "level", value, role: "limit", label });
  const frame: Frame = {
    ...times,
    panes: [{ y: { kind: "linear", label: "y", range: [0, 2] }, traces: [], marks: [level(1, "first"), level(1.02, "second"), { kind: "point", x: 1, y: 1, label: "third" }] }],
  };
  const boxes = (of: Frame) =>
    markLabels(layoutFrame(of, 400, 300, wholeView(of)).boxes[0]!).map(({ attributes }) => attributes as Record<string, number | string>);
  const [first, second] = boxes(frame);
  assert.ok(first!["text-anchor"] !== second!["text-anchor"] || Math.abs(Number(first!["y"]) - Number(second!["y"])) >= 14);
  // A curve along the upper right moves the name to another side of its line.
  const x = [...Array(200).keys()].map((k) => k / 100);
  const crossed: Frame = { ...frame, panes: [{ ...frame.panes[0]!, traces: [{ name: "y", look: 1, x, y: x.map(() => 1.06) }], marks: [level(1, "limit")] }] };
  assert.ok(Number(boxes(crossed)[0]!["y"]) > layoutFrame(crossed, 400, 300, wholeView(crossed)).boxes[0]!.y.toPixel(1));
});

test("values at the cursor have the unit of their axis, those of a plane none", () => {
  const measured: Frame = { ...times, cursorLabel: "time (s)", panes: [{ ...times.panes[0]!, y: { kind: "linear", label: "y (°C)" } }, times.panes[1]!] };
  const boxes = layoutFrame(measured, 500, 300, wholeView(measured)).boxes;
  assert.deepEqual(readings(measured, boxes[0]!, 1), ["time 1 s", "a 1 °C"]);
  assert.deepEqual(readings(measured, boxes[1]!, 2), ["time 2 s", "a 10"]);
  const [curve] = layoutFrame(plane, 500, 300, wholeView(plane)).boxes;
  assert.equal(readings(plane, curve!, 2)[1], "trace 1 0 + 0.5i");
});

test("an export says whose plot it is, in its title and in a file name that every system takes", () => {
  const owned: Frame = { ...plane, subject: "TIC-101 <heater>/Öl" };
  assert.match(frameToSvg(owned, wholeView(owned), 500, 300, () => "#000000"), /<title>TIC-101 &lt;heater&gt;\/Öl: Curve &lt;&amp;&gt; circle<\/title>/);
  assert.equal(fileNameOf(owned), "TIC-101-heater-Öl-plane");
  assert.equal(fileNameOf({ ...plane, subject: "../*" }), "plane", "nothing is left of the name");
  assert.equal(fileNameOf(plane), "plane");
});

test("the texts of a narrow axis do not overlap, and its name does not run into the next pane", () => {
  const range = [0.045, 4.5] as const;
  const at = (height: number) => ({ y: makeScale("log", range, [height, 0]) });
  const values = [0.1, 0.3, 1, 3];
  assert.deepEqual(legibleTicks(at(400), values), values);
  // Half a decade is 9 pixels high: the powers of ten remain.
  assert.deepEqual(legibleTicks(at(36), values), [0.1, 1]);
  const name = (label: string, height: number) => axisName({ height, pane: { y: { kind: "log", label }, traces: [] } });
  assert.equal(name("|CS| (%/degC)", 36), "|CS|");
  assert.equal(name("|CS| (%/degC)", 200), "|CS| (%/degC)");
  assert.equal(name("y (°C)", 36), "y (°C)");
});
