// Files in the formats of loggers, from the drop to a tuned loop; the preview; the choice of a part by dragging.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { accessibilityViolations, browserTests, dropFile, root } from "../../harness.mjs";

/** Above the default, so that a limit of the page's own would be seen. */
const tests = browserTests(["--max-body", "9MiB"]);
const { withPage } = tests;

const y = (i) => 20 + (i > 25 ? 10 * (1 - Math.exp(-(i - 25) / 30)) : 0) + 0.01 * Math.sin(37 * i);
const u = (i) => (i >= 20 ? 5 : 0);
const fixed = (value, decimal = ".") => value.toFixed(3).replace(".", decimal);
const rows = (line, count = 300) => Array.from({ length: count }, (_, i) => line(i));
const file = (head, line, tail = []) => [...head, ...rows(line), ...tail].join("\r\n");
const two = (value) => String(value).padStart(2, "0");
const clock = (i) => `14:${two(3 + Math.floor(i / 60))}:${two(i % 60)}`;
const latin1 = (text) => Buffer.from(text, "latin1");
const utf16 = (text) => Buffer.concat([Buffer.from([0xff, 0xfe]), Buffer.from(text, "utf16le")]);
const german = (i) => `${fixed(i, ",")};${fixed(u(i), ",")};${fixed(y(i), ",")}`;
const plain = (i) => `${i},${u(i)},${fixed(y(i))}`;

/** Texts for readers contain no name of the API. */
const noApiWords = async (page) => {
  const text = await page.locator("main").innerText();
  assert.doesNotMatch(text, /columns\.[tuyr]|units\.time|record\/|\bcsv is\b|columns\/|time_unit|\bdt\b/);
};

/** Dropped as bytes: the page must not decode them itself. */
async function dropBytes(page, name, bytes) {
  const list = await page.evaluateHandle(
    ([name, bytes]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([new Uint8Array(bytes)], name, { type: "text/csv" }));
      return transfer;
    },
    [name, [...bytes]],
  );
  await page.dispatchEvent(".drop", "drop", { dataTransfer: list });
}

async function tuned(page) {
  await page.getByRole("heading", { name: "Model candidates" }).waitFor();
  await noApiWords(page);
  await page.getByRole("button", { name: "Use and tune" }).click();
  await page.getByRole("heading", { name: "Model from the record" }).waitFor();
  const { result } = await (
    await fetch(`${tests.service.base}/v1/jobs/${/#\/jobs\/([^/]+)\/design/.exec(page.url())[1]}`)
  ).json();
  return result.model.plant;
}

const FILES = [
  ["semicolons and decimal commas", file(["Zeit;Stellwert;Temperatur"], german)],
  ["ISO stamps", file(["timestamp,output,temperature"], (i) => `2026-11-23T${clock(i)}Z,${u(i)},${fixed(y(i))}`)],
  [
    "German dates",
    file(["Zeit;OP;PV"], (i) => `23.11.2026 ${clock(i)};${fixed(u(i), ",")};${fixed(y(i), ",")}`),
  ],
  ["Windows-1252", latin1(file(["Zeit [s];Stellgröße [%];Temperatur [°C]"], german))],
  ["UTF-16", utf16(file(["Time\tOP\tPV"], (i) => `${i}\t${u(i)}\t${fixed(y(i))}`))],
  ["milliseconds", file(["millis,pwm,temp"], (i) => `${1000 * i},${u(i)},${fixed(y(i))}`)],
  ["tabs", file(["time\tu\ty"], (i) => `${i}\t${u(i)}\t${fixed(y(i))}`)],
  ["quoted cells", file(['"Time","OP","PV"'], (i) => `"${i}","${u(i)}","${fixed(y(i))}"`)],
  ["units below the headings", file(["Time,OP,PV", "s,%,degC"], plain)],
  ["a total at the end", file(["Time;OP;PV"], german, ["Total;;8123,4"])],
  [
    "a serial log with garbage",
    file(["millis,pwm,temp"], (i) => (i === 77 ? "77000,5,2\u0000\u0007;x" : `${1000 * i},${u(i)},${fixed(y(i))}`)),
  ],
  ["thousands separators", file(["Time;OP;PV"], (i) => `${fixed(i, ",")};${fixed(u(i), ",")};1.0${fixed(y(i), ",")}`)],
  ["lines that name their values", file([], (i) => `time=${i} temp=${fixed(y(i))} pwm=${u(i)}`)],
];

for (const [name, content] of FILES) {
  test(`dropped, one click, tuned: ${name}`, async () => {
    await withPage("", {}, async (page) => {
      await dropBytes(page, "log.csv", Buffer.from(content));
      const { K, T } = await tuned(page);
      assert.ok(Math.abs(K / 2 - 1) < 0.02, `K ${K}`);
      assert.ok(Math.abs(T / 30 - 1) < 0.05, `T ${T}`);
    });
  });
}

test("dropped, one click, tuned: the heater of the TCLab", async () => {
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "tclab.csv", readFileSync(path.join(root, "api/examples/tclab-step.csv"), "utf8"));
    assert.ok((await tuned(page)).K > 0.3);
  });
});

test("a file without a header shows its columns, and is tuned after they are chosen", async () => {
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "log.csv", file([], (i) => `${fixed(y(i))},${fixed(u(i) + 0.001 * (i % 2))},${40 + (i % 3)}`));
    const summary = page.getByRole("group", { name: "Problems to fix" });
    await summary.waitFor();
    assert.match(await summary.innerText(), /No time column found\. Choose one or enter the sampling time/);
    await noApiWords(page);
    assert.equal(await page.locator(".preview-columns li svg").count(), 3);
    await page.getByText("300 rows, columns separated by commas").waitFor();
    assert.deepEqual(await accessibilityViolations(page), []);
    await page.getByLabel("Controller output (u)").selectOption({ index: 2 });
    await page.getByLabel("Measurement (y)").selectOption({ index: 1 });
    await page.getByLabel("Sampling time (s)").fill("1");
    await page.getByRole("button", { name: "Identify this test" }).click();
    const { K } = await tuned(page);
    assert.ok(Math.abs(K / 2 - 1) < 0.02, `K ${K}`);
  });
});

test("a press that leaves a field ends on its button, whatever the service answers meanwhile", async () => {
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "log.csv", file(["OP,PV"], (i) => `${u(i)},${fixed(y(i))}`));
    await page.getByText("300 rows, columns separated by commas").waitFor();
    await page.getByLabel("Sampling time (s)").fill("2");
    const button = page.getByRole("button", { name: "Identify this test" });
    await button.scrollIntoViewIfNeeded();
    const { x, y: top, width, height } = await button.boundingBox();
    await page.mouse.move(x + width / 2, top + height / 2);
    const looked = page.waitForResponse(/\/v1\/records\/preview/);
    await page.mouse.down();
    await looked;
    await page.waitForTimeout(200);
    await page.mouse.up();
    await page.getByRole("heading", { name: "Model candidates" }).waitFor();
  });
});

test("a file without times is tuned after the sampling time is entered", async () => {
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "log.csv", file(["OP,PV"], (i) => `${u(i)},${fixed(y(i))}`));
    const summary = page.getByRole("group", { name: "Problems to fix" });
    await summary.waitFor();
    assert.match(await summary.innerText(), /No time column found\. Choose one or enter the sampling time/);
    const field = page.getByLabel("Sampling time (s)");
    await field.fill("2");
    await page.getByRole("button", { name: "Identify this test" }).click();
    const { T } = await tuned(page);
    assert.ok(Math.abs(T / 60 - 1) < 0.05, `T ${T}`);
  });
});

test("of two files the one that was dropped last is identified, however late the first is read", async () => {
  const file = (K) => ["t,u,y", ...Array.from({ length: 200 }, (_, t) => {
    const y = t > 25 ? K * (1 - Math.exp(-(t - 25) / 30)) : 0;
    return `${t},${t >= 20 ? 1 : 0},${(y + 0.001 * Math.sin(37 * t)).toFixed(4)}`;
  })].join("\n");
  await withPage("", {}, async (page) => {
    let answerFirst;
    const first = new Promise((resolve) => (answerFirst = resolve));
    let files = 0;
    await page.route("**/v1/records/preview", async (route) => {
      files += 1;
      if (files === 1) await first;
      await route.continue();
    });
    await dropFile(page, ".drop", "first.csv", file(2));
    await page.getByText("Reading first.csv...").waitFor();
    await dropFile(page, ".drop", "second.csv", file(9));
    await page.getByText(/^K 9\.0/).first().waitFor();
    const late = page.waitForResponse((response) => response.url().endsWith("/v1/records/preview"));
    answerFirst();
    await (await late).finished();
    await page.getByRole("link", { name: "Start", exact: true }).click();
    assert.equal(await page.getByLabel("or paste it").inputValue(), file(9));
  });
});

test("what was passed over is listed, and another unit of time can be chosen", async () => {
  await withPage("", {}, async (page) => {
    const log = file(["Trend of TIC101", "Time,OP,PV"], (i) => `${20 * i},${u(i)},${fixed(y(i))}`, ["Total,,8123.4"]);
    await dropFile(page, ".drop", "log.csv", log);
    await page.getByRole("heading", { name: "Model candidates" }).waitFor();
    await page.getByText("How the record is read").click();
    await page.getByText("2 lines ignored").click();
    await page.getByText('Line 303: column "Time": "Total" is not a number.').waitFor();
    await page.getByText("The file does not say that these are seconds").waitFor();
    const answered = page.waitForResponse((response) => response.url().endsWith("/v1/identify"));
    await page.getByLabel("Times are in").selectOption("ms");
    const answer = await answered;
    assert.equal(answer.request().postDataJSON().record.time_unit, "ms");
    assert.ok(Math.abs((await answer.json()).model.plant.T / 0.6 - 1) < 0.05);
  });
});

test("the part that counts is chosen by dragging over the plot; with Shift dragging zooms; each step has its button", async () => {
  const steps = (i) => (i < 60 ? 0 : i < 300 ? 5 : i < 500 ? 0 : 8);
  let level = 20;
  const log = ["t,u,y", ...Array.from({ length: 700 }, (_, i) => {
    const row = `${i},${steps(i)},${fixed(level + 0.01 * Math.sin(37 * i))}`;
    level += (20 + 2 * steps(i - 3) - level) / 25;
    return row;
  })].join("\n");
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "steps.csv", log);
    await page.getByRole("heading", { name: "Model candidates" }).waitFor();
    const canvas = page.locator("section.plot svg.canvas");
    const box = await canvas.boundingBox();
    const drag = async (a, b) => {
      await page.mouse.move(box.x + a * box.width, box.y + 60);
      await page.mouse.down();
      await page.mouse.move(box.x + b * box.width, box.y + 80, { steps: 4 });
      await page.mouse.up();
    };
    await page.keyboard.down("Shift");
    await drag(0.3, 0.8);
    await page.keyboard.up("Shift");
    const all = page.getByRole("button", { name: "Show all" });
    await all.waitFor();
    await all.click();
    const identified = () => page.waitForResponse((response) => response.url().endsWith("/v1/identify"));
    const dragged = identified();
    await drag(0.3, 0.8);
    const { from, to } = (await dragged).request().postDataJSON().record;
    assert.ok(from > 100 && from < 300 && to > 450 && to < 650, `${from} to ${to}`);
    assert.equal(Math.round(Number(await page.getByLabel("Use from (s)", { exact: true }).inputValue())), Math.round(from));
    const used = identified();
    await page.getByRole("combobox", { name: "Use one step alone" }).selectOption({ label: "at 300 s" });
    const step = (await used).request().postDataJSON().record;
    assert.equal(step.from, 180);
    assert.equal(step.to, 499);
  });
});

test("a record of 100,000 rows is used whole, though only its beginning is shown as text", async () => {
  const count = 100_000;
  const slow = (i) => (300 * i) / count;
  const log = ["t,u,y", ...rows((i) => `${slow(i).toFixed(4)},${u(slow(i))},${fixed(y(slow(i)))}`, count)].join("\n");
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "long.csv", log);
    const { K, T } = await tuned(page);
    assert.ok(Math.abs(K / 2 - 1) < 0.02 && Math.abs(T / 30 - 1) < 0.05, `K ${K}, T ${T}`);
    await page.getByRole("link", { name: "Change the request" }).click();
    const text = page.getByLabel("or paste it");
    await page.getByText("The first 30 of 100001 lines; all of them are used.").waitFor();
    assert.equal((await text.inputValue()).split("\n").length, 30);
    await page.getByRole("button", { name: "Remove it" }).click();
    assert.equal(await text.inputValue(), "");
    assert.ok(await text.isEditable());
  });
});

/** A step test of 300 rows, each so many characters long. */
const padded = (length) => ["t,u,y", ...rows(plain)].map((line) => line.padEnd(length)).join("\n");

test("a file of 8.3 MiB is read by a service that takes 9 MiB", async () => {
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "long.csv", padded(29_000));
    await page.getByRole("heading", { name: "Model candidates" }).waitFor();
  });
});

test("a file above the largest body of the service is refused with both sizes, on Start and on Range", async () => {
  const refusal = "long.csv has 9.1 MiB; at most 9.0 MiB can be sent. Cut the record to the test itself.";
  await withPage("", {}, async (page) => {
    await dropFile(page, ".drop", "long.csv", padded(31_800));
    await page.getByText(refusal).waitFor();
  });
  await withPage("#/range", {}, async (page) => {
    const file = { name: "long.csv", mimeType: "text/csv", buffer: Buffer.from(padded(31_800)) };
    await page.locator(".add-records input[type=file]").setInputFiles(file);
    await page.getByText(refusal).waitFor();
  });
});
