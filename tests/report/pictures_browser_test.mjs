// pictures_browser_test.mjs SAMPLES NODE_MODULES: figures leave the page, and the page fits a laptop.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { close, openers, run, settle, slideTo } from "./browser.mjs";

const { open } = await openers();
const laptop = { width: 1366, height: 768 };

async function saved(page, where, kind) {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page
      .locator(where)
      .first()
      .locator(".save button", { hasText: kind })
      .click(),
  ]);
  return {
    name: download.suggestedFilename(),
    bytes: readFileSync(await download.path()),
  };
}

const tests = {
  async "on a laptop the picture, the slider and Play are in view together"() {
    for (const sample of ["tunnel", "fallen_stone", "collapsed"]) {
      const page = await open(sample, laptop);
      await page.$eval("#animation .animation", (e) => e.scrollIntoView());
      await settle(page);
      for (const part of [".animation canvas", "#time-slider", "#play"]) {
        const [top, bottom] = await page.$eval(part, (e) => {
          const box = e.getBoundingClientRect();
          return [box.top, box.bottom];
        });
        assert.ok(
          top >= 0 && bottom <= laptop.height,
          `${sample} ${part}: ${top} to ${bottom}`,
        );
      }
      await close(page);
    }
  },

  async "the keyboard reaches Play by one Tab and Enter"() {
    const page = await open("tunnel", laptop);
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    assert.equal(await page.evaluate(() => document.activeElement.id), "play");
    await close(page);
  },

  async "every canvas says what it shows"() {
    const page = await open("tunnel");
    const silent = await page.$$eval("canvas", (all) =>
      all
        .filter(
          (c) =>
            c.getAttribute("role") !== "img" || !c.getAttribute("aria-label"),
        )
        .map((c) => c.outerHTML),
    );
    assert.deepEqual(silent, []);
    await close(page);
  },

  async "a picture is saved with title, time, legend and scale bar"() {
    const page = await open("tunnel");
    await slideTo(page, 5);
    const svg = await saved(page, ".animation", "SVG");
    assert.match(svg.name, /^[a-z0-9-]+-displacement-[\d.]+s\.svg$/);
    const words = svg.bytes.toString();
    assert.match(words, /Displacement of the blocks/);
    assert.match(words, /run time|static/);
    assert.match(words, />[\d.]+ (m|mm)<\/text>/);
    assert.equal(
      await page.evaluate(
        (text) =>
          new DOMParser().parseFromString(text, "image/svg+xml").documentElement
            .nodeName,
        words,
      ),
      "svg",
    );
    const png = await saved(page, ".animation", "PNG");
    assert.equal(png.bytes.readUInt32BE(16), 3 * 1100);
    const csv = (await saved(page, ".animation", "CSV")).bytes.toString();
    assert.match(csv, /^block,name,status,ux_m,uy_m,sxx_pa/);
    await close(page);
  },

  async "a plot is saved with its axes and its numbers"() {
    const page = await open("tunnel");
    const svg = await saved(page, "#quality .plot", "SVG");
    assert.match(svg.bytes.toString(), /<path[^>]* d="M/);
    const csv = (await saved(page, "#quality .plot", "CSV")).bytes.toString();
    assert.ok(csv.split("\n").length > 10);
    await close(page);
  },

  async "joints are darker than any block beside them, whatever colours one sees"() {
    const page = await open("tunnel");
    await page
      .locator(".animation .controls label", { hasText: "Joints by" })
      .locator("select")
      .selectOption("slip");
    await settle(page);
    // L* of CIELAB.
    const [blocks, joints] = await page.$$eval(
      ".animation .legend-bar",
      (bars) =>
        bars.slice(0, 2).map((bar) =>
          [
            ...bar.style.background.matchAll(/rgb\((\d+), (\d+), (\d+)\)/g),
          ].map((m) => {
            const [r, g, b] = m.slice(1).map((c) => {
              const s = Number(c) / 255;
              return s > 0.04045 ? ((s + 0.055) / 1.055) ** 2.4 : s / 12.92;
            });
            const y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            return y > 0.008856 ? 116 * Math.cbrt(y) - 16 : 903.3 * y;
          }),
        ),
    );
    assert.ok(blocks.length > 20 && joints.length > 20);
    const apart = Math.min(...blocks) - Math.max(...joints);
    assert.ok(apart > 8, `${apart} of L*`);
    await close(page);
  },

  async "all frames are recorded as a film"() {
    const page = await open("fallen_stone");
    const film = await saved(page, ".animation", "Film");
    assert.match(film.name, /^[a-z0-9-]+\.webm$/);
    assert.equal(film.bytes.readUInt32BE(0), 0x1a45dfa3); // EBML
    await close(page);
  },

  async "marks are drawn over the blocks and have a legend"() {
    const page = await open("tunnel");
    await slideTo(page, 5);
    const picture = () =>
      page.$eval(".animation canvas", (c) => c.toDataURL());
    const before = await picture();
    const choice = page
      .locator(".animation .controls label", { hasText: "Over them" })
      .locator("select");
    const names = await choice.locator("option").evaluateAll((all) =>
      all.map((o) => o.value),
    );
    assert.ok(names.includes("stress") && names.includes("forces"));
    for (const name of ["stress", "forces", "outline"]) {
      await choice.selectOption(name);
      await settle(page);
      if (name === "stress") assert.notEqual(await picture(), before);
      assert.ok(
        await page.locator(".animation .legend-note").last().isVisible(),
      );
    }
    await close(page);
  },
};

await run(tests);
