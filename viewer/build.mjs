// SPDX-License-Identifier: GPL-3.0-or-later
// Puts script and style into one page without data. Usage: node build.mjs OUTPUT
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";

async function bundled(entry) {
  const result = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: entry.endsWith(".js") ? "iife" : undefined,
    target: ["chrome100", "firefox100", "safari15"],
    legalComments: "inline",
  });
  return result.outputFiles[0].text;
}

let page = readFileSync("src/index.html", "utf8");
for (const [mark, entry] of [
  ["/*style*/", "src/style.css"],
  ["/*script*/", "src/main.js"],
]) {
  const text = await bundled(entry);
  page = page.replace(mark, () => text); // a function: $ has no meaning in it
}
// Pages hold a copy of three.js, and with it its licence.
const licence = readFileSync("node_modules/three/LICENSE", "utf8").trim();
page = page.replace("<head>", () => `<!-- The script below contains three.js:\n${licence}\n-->\n<head>`);
writeFileSync(process.argv[2], page);
