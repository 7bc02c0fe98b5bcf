// Calls each tool once through the protocol's own client, over both transports, and prints one line of JSON.
//   node sdk_client.mjs BINARY URL [KEY]
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../../..");
// The client is among the pinned tools of the front end.
const fromWeb = createRequire(path.join(root, "web/package.json"));
const part = (name) => import(pathToFileURL(fromWeb.resolve(`@modelcontextprotocol/sdk/${name}`)).href);
const { Client } = await part("client/index.js");
const { StdioClientTransport } = await part("client/stdio.js");
const { StreamableHTTPClientTransport } = await part("client/streamableHttp.js");

const [binary, url, key] = process.argv.slice(2);
const plant = "2 e^(-3s)/(10s+1)";
const controller = { form: "ideal", Kp: 0.84, Ti: 5.7, Td: 1.3 };
const times = Array.from({ length: 90 }, (_, i) => i);
const record = {
  t: times,
  u: times.map((t) => (t >= 10 ? 50 : 40)),
  y: times.map((t) => 20 + 20 * (1 - 0.9 ** Math.max(0, t - 13))),
};
const operation = times.map((t) => `${t},50,${50 + Math.sin(t / 3)},${40 + Math.cos(t / 3)},AUTO`);
const calls = [
  ["tune", { plant, tune: [{ method: "robust", Ms: 1.4 }] }],
  ["identify", { record }],
  ["check_record", { loops: [{ tag: "FIC101", csv: ["t,sp,pv,op,mode", ...operation].join("\n") }] }],
  ["compare", { plant, tune: [{ method: "simc" }, { method: "lambda" }] }],
  ["evaluate", { plant, controllers: [controller] }],
  ["plan_relay_test", { plant }],
  ["settings", { product: "emerson_deltav_standard", controller, y_span: [0, 200], u_span: [0, 100] }],
  ["list_products", { search: "deltav" }],
  ["list_methods", {}],
  ["code", { controller, language: "c", sample_time: 0.5 }],
  ["test_program", { experiment: "relay", language: "st", sample_time: 0.5, u_step: 5 }],
  ["job_status", {}],
];

async function session(transport) {
  const client = new Client({ name: "sdk-test", version: "1" });
  await client.connect(transport);
  const { tools } = await client.listTools();
  const seen = {};
  for (const [name, args] of calls) {
    const result = await client.callTool({ name, arguments: args });
    seen[name] = { refused: result.isError === true, text: result.content[0].text.length, figures: Object.keys(result.structuredContent ?? {}) };
    if (name === "tune") {
      const uri = result.structuredContent.whole.resource;
      const { contents } = await client.readResource({ uri });
      seen[name].status = JSON.parse(contents[0].text).status;
    }
  }
  const wrong = await client.callTool({ name: "tune", arguments: { plant: 7 } });
  let unknown = 0;
  await client.callTool({ name: "tunes", arguments: {} }).catch((error) => (unknown = error.code));
  const templates = await client.listResourceTemplates();
  await client.ping();
  const server = client.getServerVersion();
  await client.close();
  return { tools: tools.map((tool) => tool.name), seen, wrong: wrong.isError === true, unknown, server: server.name, templates: templates.resourceTemplates.length };
}

const headers = key ? { Authorization: `Bearer ${key}` } : {};
const stdio = await session(new StdioClientTransport({ command: binary, args: ["mcp"] }));
const http = await session(new StreamableHTTPClientTransport(new URL(url), { requestInit: { headers } }));
console.log(JSON.stringify({ stdio, http }));
