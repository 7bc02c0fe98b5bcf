import { defineConfig } from "vite";
import { documents } from "./documents.mjs";
import { problems } from "./problems.mjs";

// Relative base: the page works behind any prefix. Nothing is inlined: the server's policy allows neither data: URLs nor inline code.
export default defineConfig({
  base: "./",
  plugins: [documents("../docs", "theme"), problems("../bench/problems/problems.json")],
  build: {
    outDir: "../build/web",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    rollupOptions: { input: { index: "index.html", theme: "src/theme.ts" } },
  },
  server: { proxy: { "/v1": "http://127.0.0.1:8080" } },
});
