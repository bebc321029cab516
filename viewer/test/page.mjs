// SPDX-License-Identifier: GPL-3.0-or-later
// Opens a page in headless Chromium and looks whether it does what it says. Usage: node page.mjs PAGE.html PICTURES
// [most megabytes]. Status 1 where something is not so.
import { statSync, writeFileSync } from "node:fs";
import { basename, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [file, folder, mostMegabytes = "25"] = process.argv.slice(2);
const name = basename(file, ".html");
const faults = [];
const expect = (so, what) => {
  console.log(`${so ? "  ok " : "FAIL "} ${what}`);
  if (!so) faults.push(what);
};

/** Share of pixels that differ visibly; 0 to 1. Decoded by the browser itself, in a page of its own. */
async function difference(helper, a, b) {
  return helper.evaluate(
    async ([first, second]) => {
      const pixels = async (data) => {
        const image = new Image();
        image.src = `data:image/png;base64,${data}`;
        await image.decode();
        const canvas = document.createElement("canvas");
        canvas.width = image.width;
        canvas.height = image.height;
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, image.width, image.height).data;
      };
      const [p, q] = [await pixels(first), await pixels(second)];
      let different = 0;
      for (let i = 0; i < p.length; i += 4)
        if (Math.max(Math.abs(p[i] - q[i]), Math.abs(p[i + 1] - q[i + 1]), Math.abs(p[i + 2] - q[i + 2])) > 12)
          ++different;
      return (4 * different) / p.length;
    },
    [a.toString("base64"), b.toString("base64")],
  );
}

/** Share of the picture that is not the background, taken from its corner. */
const filled = (helper, picture) =>
  helper.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const p = context.getImageData(0, 0, image.width, image.height).data;
    const corner = 4 * (5 * image.width + 5);
    let other = 0;
    for (let i = 0; i < p.length; i += 4)
      if (Math.abs(p[i] - p[corner]) + Math.abs(p[i + 1] - p[corner + 1]) + Math.abs(p[i + 2] - p[corner + 2]) > 24)
        ++other;
    return (4 * other) / p.length;
  }, picture.toString("base64"));

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, offline: true });
const page = await context.newPage();
const helper = await context.newPage();
const said = [],
  asked = [];
page.on("console", (message) => {
  if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver Message/.test(message.text()))
    said.push(message.text());
});
page.on("pageerror", (error) => said.push(String(error)));
page.on("request", (request) => {
  if (!/^(file|data|blob):/.test(request.url())) asked.push(request.url());
});

const megabytes = statSync(file).size / 1e6;
console.log(`${file}: ${megabytes.toFixed(2)} MB`);
expect(megabytes <= Number(mostMegabytes), `${megabytes.toFixed(1)} MB are at most ${mostMegabytes}`);
const before = Date.now();
await page.goto(pathToFileURL(resolve(file)).href);
await page.waitForFunction(() => document.documentElement.dataset.ready !== undefined, null, { timeout: 60000 });
const seconds = (Date.now() - before) / 1000;
console.log(`  interactive after ${seconds.toFixed(2)} s`);
expect(seconds <= 5, "interactive within 5 s");
expect((await page.evaluate(() => document.documentElement.dataset.ready)) === "view", "the view is there");
await page.bringToFront();

const canvas = page.locator(".view canvas");
await canvas.scrollIntoViewIfNeeded();
const shot = async () => {
  await page.evaluate(() => document.activeElement.blur()); // its frame is no part of the picture
  await page.waitForTimeout(60);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return canvas.screenshot();
};
const first = await shot();
writeFileSync(`${folder}/${name}-view.png`, first);
const share = await filled(helper, first);
expect(share > 0.05 && share < 0.95, `the picture is not blank: ${(100 * share).toFixed(0)} % of it is mesh`);

await page.bringToFront();
let base = first;
for (const box of await page.locator(".controls input[id^=show-]").all()) {
  const id = await box.getAttribute("id");
  if (await box.isDisabled()) {
    console.log(`       ${id}: nothing to show`);
    continue;
  }
  const isBare = ["show-insidePoles", "show-outliers", "show-outsidePoles", "show-leftOut"].includes(id);
  // What lies within or behind the surface is looked at without it.
  if (isBare) await page.locator("#show-mesh").uncheck();
  if (isBare) base = await shot();
  const was = await box.isChecked();
  await box.setChecked(!was);
  const turned = await shot();
  writeFileSync(`${folder}/${name}-${id}.png`, turned);
  const changed = await difference(helper, base, turned);
  await page.bringToFront();
  expect(changed > 0, `${id} changes the picture: ${(100 * changed).toFixed(3)} % of it`);
  await box.setChecked(was);
  if (isBare) await page.locator("#show-mesh").check();
  base = await shot();
  expect((await difference(helper, first, base)) === 0, `${id} back again is as before`);
  await page.bringToFront();
}

await page.locator("#cut-on").check();
const cut = await shot();
writeFileSync(`${folder}/${name}-cut.png`, cut);
expect((await difference(helper, first, cut)) > 0.01, "the cut takes something away");
await page.bringToFront();
await canvas.focus();
for (let i = 0; i < 8; ++i) await page.keyboard.press(",");
expect((await difference(helper, cut, await shot())) > 0.002, "the cut moves, by key");
await page.bringToFront();
await canvas.focus();
await page.keyboard.press("x");
const other = await shot();
expect((await difference(helper, cut, other)) > 0.01, "the cut takes another axis, by key");
await page.bringToFront();
await canvas.focus();
await page.keyboard.press("f");
expect((await difference(helper, other, await shot())) > 0.01, "the cut keeps the other side, by key");
await page.bringToFront();
await canvas.focus();
await page.keyboard.press("c");
expect((await difference(helper, first, await shot())) === 0, "the cut goes, by key");
await page.bringToFront();
await canvas.focus();
for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowRight");
expect((await difference(helper, first, await shot())) > 0.01, "arrows turn it");
await page.bringToFront();
const area = await canvas.boundingBox();
const turnedByKey = await shot();
const began = Date.now();
await page.mouse.move(area.x + area.width / 2, area.y + area.height / 2);
await page.mouse.down();
await page.mouse.move(area.x + area.width / 2 + 120, area.y + area.height / 2 + 40, { steps: 8 });
await page.mouse.up();
const dragged = await shot();
console.log(`  a drag of 8 steps took ${((Date.now() - began) / 1000).toFixed(2)} s`);
expect((await difference(helper, turnedByKey, dragged)) > 0.01, "a drag turns it");
await page.bringToFront();

const words = await page.locator("main").innerText();
for (const word of ["Measured", "Invented", "Thrown away", "Is the mesh sound?", "SHA-256"])
  expect(words.includes(word), `the page says "${word}"`);
expect((await page.locator(".stills img").count()) === 6, "six still pictures");
expect(!/undefined|NaN|\[object/.test(words), "no word that is none");
await page.evaluate(() => document.querySelectorAll("details").forEach((part) => (part.open = false)));
await page.screenshot({ path: `${folder}/${name}-light.png`, fullPage: true });
await page.emulateMedia({ colorScheme: "dark" });
await shot();
await page.screenshot({ path: `${folder}/${name}-dark.png`, fullPage: true });
await page.setViewportSize({ width: 420, height: 800 });
await shot();
await page.screenshot({ path: `${folder}/${name}-narrow.png` });
expect(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), "fits a narrow window");
await page.emulateMedia({ colorScheme: "light" });
await page.setViewportSize({ width: 1280, height: 900 });
await page.pdf({ path: `${folder}/${name}.pdf`, printBackground: true });
expect(said.length === 0, `nothing on the console ${said.join(" | ")}`);
expect(asked.length === 0, `nothing asked of a network ${asked.join(" ")}`);
await browser.close();
process.exit(faults.length > 0 ? 1 : 0);
