import { defineConfig } from "vite";

// Relative base: the page works behind any prefix. Nothing is inlined: the server's policy allows neither data: URLs nor inline code.
export default defineConfig({
  base: "./",
  build: {
    outDir: "../build/web",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
  },
  server: { proxy: { "/v1": "http://127.0.0.1:8080" } },
});
