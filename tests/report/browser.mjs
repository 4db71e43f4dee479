// What the browser tests share. Arguments: SAMPLES NODE_MODULES.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

let context;
let profile;

/** Starts the browser; ends the test with exit code 77, skipped, where there is none. */
export async function openers() {
  const [samples, packages] = process.argv
    .slice(2)
    .map((path) => resolve(path));
  const executablePath = [
    "/usr/bin/chromium",
    "/usr/bin/chromium-browser",
    "/usr/bin/google-chrome",
  ].find(existsSync);
  if (!executablePath) {
    console.log(
      "SKIPPED: no Chromium is installed, so the report has not been opened in a browser",
    );
    process.exit(process.env.CI ? 1 : 77);
  }
  const { chromium } = createRequire(join(packages, "index.js"))(
    "playwright-core",
  );
  const screenshots = join(samples, "screenshots");
  mkdirSync(screenshots, { recursive: true });
  profile = mkdtempSync(join(tmpdir(), "keyblock-browser-"));
  context = await chromium.launchPersistentContext(profile, {
    executablePath,
    headless: true,
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });

  /** Opens a sample, after running a script in its page if one is given; the returned `complaints` collect what must not happen. */
  async function open(
    name,
    { width = 1400, height = 1000, colorScheme = "light", script } = {},
  ) {
    const page = await context.newPage();
    if (script) await page.addInitScript(script);
    await page.setViewportSize({ width, height });
    await page.emulateMedia({ colorScheme });
    const complaints = [];
    page.on("console", (message) => {
      if (["error", "warning"].includes(message.type()))
        complaints.push(`console ${message.type()}: ${message.text()}`);
    });
    page.on("pageerror", (error) => complaints.push(`uncaught: ${error}`));
    page.on("requestfailed", (request) =>
      complaints.push(`failed request: ${request.url()}`),
    );
    page.on("request", (request) => {
      if (!/^(file|data|blob):/.test(request.url()))
        complaints.push(`request to the network: ${request.url()}`);
    });
    const begin = performance.now();
    await page.goto(pathToFileURL(join(samples, name, "report.html")).href);
    await page.waitForFunction(
      () => document.documentElement.dataset.ready === "true",
      null,
      {
        timeout: 20_000,
      },
    );
    page.complaints = complaints;
    page.seconds = (performance.now() - begin) / 1000;
    await settle(page); // charts are drawn once they know their size
    return page;
  }

  /** Brings every plot into being and saves the whole page. */
  async function shoot(page, name) {
    await settle(page);
    await page.screenshot({
      path: join(screenshots, `${name}.png`),
      fullPage: true,
    });
  }
  return { samples, screenshots, open, shoot };
}

/** Closes a page on which nothing went wrong. */
export async function close(page) {
  assert.deepEqual(page.complaints, []);
  await page.close();
}

export const settle = (page) =>
  page.evaluate(
    () =>
      new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r))),
  );
/** Moves the time slider of a run's report. */
export async function slideTo(page, frame) {
  await page.$eval(
    "#time-slider",
    (slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    },
    frame,
  );
  await settle(page);
}

export const text = (page, selector) =>
  page.evaluate((s) => document.querySelector(s)?.innerText ?? "", selector);
export const sidewaysOverflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

/** Runs tests {name: function} one after the other; the exit code is 1 when one fails. */
export async function run(tests) {
  let failed = 0;
  for (const [name, test] of Object.entries(tests)) {
    try {
      await test();
      console.log(`ok      ${name}`);
    } catch (error) {
      failed++;
      console.log(`FAILED  ${name}\n${error.stack}`);
    }
  }
  await context.close();
  rmSync(profile, { recursive: true, force: true });
  console.log(`${Object.keys(tests).length - failed} passed, ${failed} failed`);
  process.exitCode = failed > 0 ? 1 : 0;
}
