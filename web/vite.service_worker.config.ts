import { defineConfig } from "vite";

// Apart from the page: browsers run it as one file, under a name that never changes.
export default defineConfig({
  publicDir: false,
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
