// browser_test.mjs SAMPLES NODE_MODULES: opens the sample reports in headless Chromium and uses them as a reader would.
// Screenshots are left in SAMPLES/screenshots. Exit code 77: skipped, as there is no Chromium.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { join } from "node:path";
import {
  close,
  openers,
  run,
  settle,
  slideTo,
  sidewaysOverflow,
  text,
} from "./browser.mjs";

const { samples, screenshots, open, shoot } = await openers();
const canvas = ".canvas-box canvas";
const pixels = (page, selector = canvas) =>
  page.evaluate((s) => document.querySelector(s).toDataURL(), selector);
const label = (page) => page.textContent("#time-label");
const marker = (page, plot = ".aside .now-line") =>
  page.evaluate((s) => document.querySelector(s).style.transform, plot);

const tests = {
  async "shows the run in the order an engineer reads it"() {
    const page = await open("tunnel");
    const headings = await page.$$eval("h2", (all) =>
      all.map((e) => e.textContent),
    );
    assert.deepEqual(headings, [
      "Result",
      "Stages",
      "Damage by stage",
      "The blocks before and after each stage",
      "Animation",
      "Histories of chosen points",
      "Quality of the computation",
      "From joints to blocks",
      "How it was computed",
      "Conventions",
    ]);
    assert.equal(await text(page, "h1"), "Brick wall <synthetic> & shaken");
    assert.equal(await page.title(), "Brick wall <synthetic> & shaken");
    const facts = await text(page, "#run");
    assert.match(facts, /18446744073709551615, 3/);
    assert.match(facts, /9f2c44d1a07be863/);
    assert.match(
      await page.textContent("#run pre"),
      /<\/script><b>not markup<\/b>/,
    );
    assert.match(
      await text(page, ".verdict"),
      /^\d+ blocks? \([\d.]+\sm²\) ha(s|ve) fallen, all by the shaking; the opening \(tunnel\) is [\d.]+\s% filled/,
    );
    assert.equal(await page.locator("#verdict .attention").count(), 0);
    assert.equal(await page.locator("#quality td.attention").count(), 0);
    assert.equal(await page.locator("#damage tbody tr").count(), 2 * 3);
    assert.match(await text(page, "#damage tbody tr:nth-child(2)"), /\+\d/);
    assert.equal(await page.locator(".pictures figure").count(), 5);
    assert.equal(await sidewaysOverflow(page), 0);
    await slideTo(page, 78);
    await shoot(page, "tunnel-1400");
    await close(page);
  },

  async "the slider moves time, blocks and cursors"() {
    const page = await open("tunnel");
    await slideTo(page, 62);
    const before = [
      await label(page),
      await pixels(page),
      await marker(page),
      await marker(page, "#quality .now-line"),
    ];
    await slideTo(page, 88);
    const after = [
      await label(page),
      await pixels(page),
      await marker(page),
      await marker(page, "#quality .now-line"),
    ];
    before.forEach((value, k) =>
      assert.notEqual(value, after[k], `thing ${k} did not change`),
    );
    assert.match(after[0], /first earthquake · [\d.]+ of 10 s/);
    await close(page);
  },

  async "play runs to the end and pauses; keys work"() {
    const page = await open("tunnel");
    await slideTo(page, 60);
    const before = await label(page);
    await page.click("#play");
    await page.waitForFunction(
      (old) => document.querySelector("#time-label").textContent !== old,
      before,
    );
    assert.match(await text(page, "#play"), /Pause/);
    await page.click("#play");
    assert.match(await text(page, "#play"), /Play/);
    await slideTo(page, 60);
    await page.focus(canvas);
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.inputValue("#time-slider"), "61");
    await page.keyboard.press("Shift+ArrowLeft");
    assert.equal(await page.inputValue("#time-slider"), "51");
    await page.keyboard.press("End");
    assert.equal(await page.inputValue("#time-slider"), "119");
    await page.keyboard.press("Home");
    await page.keyboard.press("Space");
    await page.waitForFunction(
      () => Number(document.querySelector("#time-slider").value) > 2,
    );
    await page.keyboard.press("Space");
    assert.match(await text(page, "#play"), /Play/);
    await close(page);
  },

  async "every colouring draws another picture, with its legend"() {
    const page = await open("tunnel");
    await slideTo(page, 115);
    const seen = new Set();
    const blocksBy = page.locator("#animation select").nth(0);
    const jointsBy = page.locator("#animation select").nth(1);
    for (const value of [
      "displacement",
      "mean",
      "major",
      "minor",
      "shear",
      "status",
      "order",
      "plain",
    ]) {
      await blocksBy.selectOption(value);
      await settle(page);
      seen.add(await pixels(page));
      if (value !== "plain")
        assert.notEqual(await text(page, "#animation .legends"), "");
    }
    for (const value of ["slip", "opening", "state", "set"]) {
      await jointsBy.selectOption(value);
      await settle(page);
      seen.add(await pixels(page));
      await page
        .locator("#animation")
        .screenshot({ path: join(screenshots, `joints-${value}.png`) });
    }
    assert.equal(seen.size, 12);
    await close(page);
  },

  async "the pointer names blocks, the wheel zooms, dragging pans, a double click fits"() {
    const page = await open("tunnel");
    await slideTo(page, 115);
    await page.locator(canvas).scrollIntoViewIfNeeded();
    const box = await page.locator(canvas).boundingBox();
    const [x, y] = [box.x + 0.3 * box.width, box.y + 0.8 * box.height];
    await page.mouse.move(x, y);
    await settle(page);
    assert.match(
      await text(page, ".tooltip"),
      /block \d+[\s\S]*status[\s\S]*in place[\s\S]*displacement[\s\S]*σxx/,
    );
    await page.mouse.move(box.x + 2, box.y - 30);
    await settle(page);
    const fitted = await pixels(page);
    await page.mouse.move(x, y);
    await page.mouse.click(x, y);
    await page.mouse.wheel(0, -400);
    await page.mouse.move(box.x + 2, box.y - 30);
    await settle(page);
    const zoomed = await pixels(page);
    assert.notEqual(zoomed, fitted);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y - 40);
    await page.mouse.up();
    await page.mouse.move(box.x + 2, box.y - 30);
    await settle(page);
    assert.notEqual(await pixels(page), zoomed);
    await page.mouse.dblclick(x, y);
    await page.mouse.move(box.x + 2, box.y - 30);
    await settle(page);
    assert.equal(await pixels(page), fitted);
    await close(page);
  },

  async "a click on a plot moves the animation there"() {
    const page = await open("tunnel");
    const over = page.locator(".aside .u-over").first();
    await over.scrollIntoViewIfNeeded();
    const box = await over.boundingBox();
    await page.mouse.click(box.x + 0.5 * box.width, box.y + 20);
    const x = Number(/translateX\(([\d.]+)px\)/.exec(await marker(page))[1]);
    assert.ok(
      Math.abs(x - 0.5 * box.width) < 3,
      `cursor at ${x} of ${box.width}`,
    );
    assert.match(await label(page), /first earthquake/);
    await close(page);
  },

  async "zooming a plot takes its line along, a double click only ends the zoom"() {
    const page = await open("tunnel");
    await slideTo(page, 78);
    const [name, moved] = [await label(page), await marker(page)];
    const over = page.locator(".aside .u-over").first();
    await over.scrollIntoViewIfNeeded();
    const box = await over.boundingBox();
    await page.mouse.move(box.x + 5, box.y + 20);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.7 * box.width, box.y + 20, { steps: 5 });
    await page.mouse.up();
    await settle(page);
    const hidden = () => page.$eval(".aside .now-line", (line) => line.hidden);
    assert.ok((await hidden()) || (await marker(page)) !== moved);
    await page.mouse.dblclick(box.x + 0.2 * box.width, box.y + 20);
    await settle(page);
    assert.equal(await label(page), name);
    assert.equal(await marker(page), moved);
    assert.ok(!(await hidden()));
    await close(page);
  },

  async "no label of an axis is cut off at the left"() {
    const script = () => {
      const { prototype } = CanvasRenderingContext2D;
      const fillText = prototype.fillText;
      window.labels = [];
      prototype.fillText = function (text, x, y) {
        const width = this.measureText(text).width;
        const shares = { right: 1, end: 1, center: 0.5 };
        const left = x - width * (shares[this.textAlign] ?? 0);
        const at = this.getTransform().transformPoint({ x: left, y });
        window.labels.push({ text, left: at.x });
        fillText.call(this, text, x, y);
      };
    };
    for (const width of [400, 1400]) {
      const page = await open("far_and_still", { width, script });
      await page.locator(canvas).scrollIntoViewIfNeeded();
      await page.locator(".zoom-buttons button").first().click();
      await settle(page);
      await page.locator("#quality .plot").last().scrollIntoViewIfNeeded();
      await settle(page);
      const labels = await page.evaluate(() => window.labels);
      const cut = labels.filter((l) => l.left < 0).map((l) => l.text);
      assert.deepEqual(cut, []);
      const written = labels.map((l) => l.text);
      assert.ok(written.includes("6,691,590"), written.join("; "));
      assert.ok(
        written.some((t) => / × 10⁻/.test(t)),
        written.join("; "),
      );
      assert.ok(written.includes("10⁻⁶"), written.join("; "));
      await shoot(page, `far_and_still-${width}`);
      await close(page);
    }
  },

  async "labels of colour bars keep clear of each other"() {
    for (const width of [400, 1400]) {
      const page = await open("tunnel", { width });
      for (const value of ["displacement", "mean", "major", "minor", "shear"]) {
        await page.locator("#animation select").first().selectOption(value);
        await settle(page);
        await settle(page);
        const gaps = await page.$$eval(
          "#animation .legend-ticks span",
          (spans) => {
            const boxes = spans
              .map((span) => span.getBoundingClientRect())
              .sort((a, b) => a.left - b.left);
            return boxes.slice(1).map((box, k) => box.left - boxes[k].right);
          },
        );
        assert.ok(gaps.length >= 1);
        assert.ok(Math.min(...gaps) >= 4, `${value}: ${gaps}`);
      }
      await close(page);
    }
  },

  async "a picture can be enlarged and closed again"() {
    const page = await open("tunnel");
    await page.locator(".picture").nth(3).click();
    assert.ok(await page.locator("dialog[open] canvas").isVisible());
    await page.screenshot({ path: join(screenshots, "enlarged.png") });
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("dialog[open]").count(), 0);
    await close(page);
  },

  async "fits a narrow window, a dark screen and paper"() {
    const page = await open("marginal", { width: 800 });
    await slideTo(page, 78);
    assert.ok((await sidewaysOverflow(page)) <= 0);
    await shoot(page, "marginal-800");
    await page.pdf({ path: join(screenshots, "marginal.pdf"), format: "A4" });
    await close(page);
    const dark = await open("tunnel", { colorScheme: "dark" });
    await slideTo(dark, 78);
    await shoot(dark, "tunnel-dark");
    await close(dark);
  },

  async "a report as large as the demo's opens within two seconds"() {
    const page = await open("large");
    const megabytes =
      statSync(join(samples, "large", "report.html")).size / 1e6;
    console.log(
      `  ${megabytes.toFixed(2)} MB, ready after ${page.seconds.toFixed(2)} s`,
    );
    assert.ok(megabytes < 15);
    assert.ok(
      page.seconds < 2 * (process.env.CI ? 3 : 1.5),
      `${page.seconds} s`,
    );
    await slideTo(page, 200);
    await shoot(page, "large-1400");
    await close(page);
  },

  async "rock of blocks smaller than pixels has no pattern"() {
    const page = await open("tiny_blocks");
    // Along a row of pixels the displacement is the same, and dark on light paper.
    const spread = await page
      .locator(".picture canvas")
      .nth(1)
      .evaluate((canvas) => {
        const { width, height } = canvas;
        const row = [width / 4, height / 3, width / 2, 1].map(Math.round);
        const { data } = canvas.getContext("2d").getImageData(...row);
        const green = data.filter((_, k) => k % 4 === 1);
        return Math.max(...green) - Math.min(...green);
      });
    await shoot(page, "tiny-blocks-1400");
    assert.ok(spread <= 8, `${spread} of 255`);
    await close(page);
  },
};

await run(tests);
