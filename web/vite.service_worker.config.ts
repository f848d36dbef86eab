import { defineConfig } from "vite";
import { LANGUAGES } from "./languages.mjs";

// Apart from the page: browsers run it as one file, under a name that never changes.
export default defineConfig({
  publicDir: false,
  define: { LANGUAGES },
  build: {
    outDir: "../server/api/console/built",
    emptyOutDir: false,
    sourcemap: false,
    rollupOptions: {
      input: "src/calling/service_worker.ts",
      output: { format: "iife", entryFileNames: "service_worker.js" },
    },
  },
});
