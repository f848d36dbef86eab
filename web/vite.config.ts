import preact from "@preact/preset-vite";
import { defineConfig } from "vite";
import { LANGUAGES } from "./languages.mjs";

const SERVICE = "http://127.0.0.1:8080";

export default defineConfig({
  define: { LANGUAGES },
  plugins: [preact({ devToolsEnabled: false })],
  build: {
    // Inside the Python package, so that the wheel and an editable install both serve it.
    outDir: "../server/api/console/built",
    emptyOutDir: true,
    assetsInlineLimit: 0,
    sourcemap: false,
    // Three.js is big and comes only when the robot is looked at.
    chunkSizeWarningLimit: 1200,
    rolldownOptions: {
      // What every page begins with is one file after its words: a browser asks for six at a time.
      output: {
        codeSplitting: {
          groups: [
            { name: "main", test: /src\/main\.tsx$/, priority: 1 },
            { name: "begin", test: /src\/begin\.tsx$/ },
          ],
        },
      },
    },
  },
  server: {
    proxy: {
      "/api": { target: SERVICE },
      "/ws": { target: SERVICE, ws: true },
    },
  },
});
