// A part of the page's build: docs/*.md as plain pages in documents/, so that every explanation can be read offline.
import { readdirSync, readFileSync } from "node:fs";
import path from "node:path";
import { marked } from "marked";

const FOLDERS = ["", "adr/"];

const escapeText = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");

/** A scrolling part that the keyboard reaches. */
const scroller = (name, content) => `<div class="scroll" tabindex="0" role="group" aria-label="${name}">${content}</div>\n`;

/** The address of a link on a served page; null: its target is not served, so that only its text stays. */
function servedAddress(href, isServed, from) {
  if (/^[a-z]+:/.test(href) || href.startsWith("#")) return href;
  const [file, anchor] = href.split("#", 2);
  const target = path.posix.join(path.posix.dirname(from), file);
  if (!isServed(target)) return null;
  return file.replace(/\.md$/, ".html") + (anchor ? `#${anchor}` : "");
}

/** The page of one document. `from`: its path in docs/; `head`: links to style and script. */
function pageOf(text, from, isServed, head) {
  const up = from.includes("/") ? "../../" : "../";
  const title = /^# (.+)$/m.exec(text)?.[1] ?? from;
  const renderer = new marked.Renderer();
  const { table, tablecell, code } = renderer;
  renderer.table = (...parts) => scroller("Table", table.apply(renderer, parts));
  // A heading without a word is no heading.
  renderer.tablecell = (content, { header, ...flags }) => tablecell.call(renderer, content, { ...flags, header: header && content !== "" });
  renderer.code = (...parts) => scroller("Code", code.apply(renderer, parts));
  renderer.link = (href, _title, label) => {
    const address = servedAddress(href, isServed, from);
    return address === null ? label : `<a href="${escapeText(address)}">${label}</a>`;
  };
  const body = marked.parse(text, { renderer, mangle: false });
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8" />
<meta name="viewport" content="width=device-width, initial-scale=1" />
<meta name="color-scheme" content="light dark" />
<title>${escapeText(title.replaceAll("`", ""))} · Tunewright</title>
<link rel="icon" href="${up}icon.svg" type="image/svg+xml" />
${head(up)}
</head>
<body>
<header class="top"><a class="brand" href="${up}#/">Tunewright</a>
<nav aria-label="Documents"><a href="${up}documents/README.html">Documents</a><a href="${up}documents/glossary.html">Glossary</a><a href="${up}documents/methods.html">Methods</a><a href="${up}#/docs">API</a></nav></header>
<main id="main" class="document">
${body}</main>
</body>
</html>
`;
}

/** `source`: the folder of the documents; `entry`: the script of each page. */
export function documents(source, entry) {
  const files = () =>
    FOLDERS.flatMap((folder) =>
      readdirSync(path.join(source, folder))
        .filter((name) => /\.(md|csv)$/.test(name))
        .map((name) => folder + name),
    );
  const pictures = () => readdirSync(path.join(source, "pictures")).map((name) => `pictures/${name}`);
  return {
    name: "documents",
    apply: "build",
    enforce: "post",
    generateBundle: {
      order: "post",
      handler(_options, bundle) {
        const built = Object.values(bundle);
        const styles = built.filter(({ fileName }) => fileName.endsWith(".css")).map(({ fileName }) => fileName);
        const script = built.find((chunk) => chunk.type === "chunk" && chunk.isEntry && chunk.name === entry);
        if (styles.length === 0 || !script) throw new Error("The documents have no style sheet or no script.");
        const head = (up) =>
          [
            ...styles.map((name) => `<link rel="stylesheet" href="${up}${name}" />`),
            `<script type="module" src="${up}${script.fileName}"></script>`,
          ].join("\n");
        const served = new Set([...files(), ...pictures()]);
        for (const name of served) {
          const bytes = readFileSync(path.join(source, name));
          const isPage = name.endsWith(".md");
          this.emitFile({
            type: "asset",
            fileName: `documents/${name.replace(/\.md$/, ".html")}`,
            source: isPage ? pageOf(bytes.toString("utf8"), name, (target) => served.has(target), head) : bytes,
          });
        }
      },
    },
  };
}
