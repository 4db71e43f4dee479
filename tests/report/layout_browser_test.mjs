// layout_browser_test.mjs SAMPLES NODE_MODULES: reports on paper, in windows that change, and with blocks that fly away.
import assert from "node:assert/strict";
import { join } from "node:path";
import {
  close,
  openers,
  run,
  settle,
  sidewaysOverflow,
  text,
} from "./browser.mjs";

const { screenshots, open, shoot } = await openers();

/** As a browser does it before and after printing. */
async function onPaper(page, check) {
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  await check();
  await page.emulateMedia({ media: "screen" });
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
}

const tableWidths = (page) =>
  page.$$eval(".table-box table", (all) =>
    all.map((t) => t.offsetWidth - t.parentElement.clientWidth),
  );
const shown = (page, selector) =>
  page.$eval(selector, (e) => getComputedStyle(e).display !== "none");

/** Keeps in window.labels what is written on canvases, and in which figure. */
function keepLabels() {
  const { prototype } = CanvasRenderingContext2D;
  const fillText = prototype.fillText;
  window.labels = [];
  prototype.fillText = function (words, x, y) {
    const figure = this.canvas.closest("figure")?.getAttribute("aria-label");
    window.labels.push({ words, figure });
    fillText.call(this, words, x, y);
  };
}
const script = keepLabels;

const tests = {
  async "paper has all rows and columns of a table, and charts as wide as it"() {
    const page = await open("study");
    const chart = page.locator("#fragility .chart-target");
    const box = await chart.boundingBox();
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 50);
    assert.ok(await shown(page, "#fragility .hair"));
    const size = () =>
      page.$eval("#runs table", (e) => getComputedStyle(e).fontSize);
    const before = await size();
    await onPaper(page, async () => {
      const hidden = await page.$eval(
        "#runs .table-box",
        (e) => e.scrollHeight - e.clientHeight,
      );
      assert.equal(hidden, 0);
      const beyond = await tableWidths(page);
      assert.ok(Math.max(...beyond) <= 0, beyond.join());
      assert.ok(!(await shown(page, "#fragility .hair")));
      assert.ok(!(await shown(page, "#runs button.screen-only")));
      assert.match(await text(page, "#runs"), /Printed are 100; all are in/);
      const [target, drawing] = await chart.evaluate((e) => [
        e.clientWidth,
        Number(e.firstChild.getAttribute("width")),
      ]);
      assert.equal(drawing, target);
      assert.ok(target < 700, `${target} px`);
    });
    assert.equal(await size(), before);
    await page.pdf({
      path: join(screenshots, "study-hover.pdf"),
      format: "A4",
    });
    await close(page);
  },

  async "paper has all columns of a run's tables"() {
    const page = await open("marginal", { width: 1400 });
    await onPaper(page, async () => {
      const beyond = await tableWidths(page);
      assert.ok(Math.max(...beyond) <= 0, beyond.join());
    });
    await close(page);
  },

  async "the enlarged picture follows the window and the theme"() {
    const page = await open("tunnel");
    await page.locator(".picture").nth(3).click();
    const width = () =>
      page.$eval("dialog canvas", (e) => [
        e.clientWidth,
        e.parentElement.clientWidth - 32,
      ]);
    const picture = () => page.$eval("dialog canvas", (e) => e.toDataURL());
    const [wide] = await width();
    await page.setViewportSize({ width: 600, height: 800 });
    await settle(page);
    const [narrow, room] = await width();
    assert.ok(narrow < wide && narrow === room, `${narrow} of ${room} px`);
    const light = await picture();
    await page.emulateMedia({ colorScheme: "dark" });
    await settle(page);
    assert.notEqual(await picture(), light);
    await page.screenshot({ path: join(screenshots, "enlarged-dark.png") });
    await close(page);
  },

  async "stages under the slider lie beside each other, however short"() {
    for (const width of [400, 1400]) {
      const page = await open("fallen_stone", { width });
      const boxes = await page.$$eval(".stage-part", (all) =>
        all.map((e) => {
          const { left, right } = e.getBoundingClientRect();
          return [left, right];
        }),
      );
      assert.equal(boxes.length, 4);
      boxes.forEach(([left, right], k) => {
        assert.ok(right - left >= 12, `${k}: ${right - left} px`);
        if (k > 0) assert.ok(left >= boxes[k - 1][1] - 0.5, `${k}: overlap`);
      });
      await page.locator(".stage-part").first().click();
      assert.match(await text(page, "#time-label"), /^in situ/);
      await close(page);
    }
  },

  async "pictures hold the blocks that left their place, or say how many they do not"() {
    const page = await open("fallen_stone", { script });
    const labels = async () =>
      (await page.evaluate(() => window.labels.splice(0))).map((l) => l.words);
    await page.locator(".picture").last().click();
    await settle(page);
    const written = await labels();
    assert.ok(written.includes("1 block outside of the picture"));
    // The stone that fell by 4 m, from the bottom of the wall, is in the picture.
    assert.ok(written.includes("−4"), written.join("; "));
    assert.ok(!written.includes("−10"), written.join("; "));
    await page.keyboard.press("Escape");
    await shoot(page, "fallen_stone-1400");
    await labels();
    await page.locator(".picture").first().click();
    await settle(page);
    assert.ok(!(await labels()).some((l) => /outside/.test(l)));
    await close(page);
    const tunnel = await open("tunnel", { script });
    await tunnel.locator(".picture").last().click();
    await settle(tunnel);
    const inTunnel = await tunnel.evaluate(() =>
      window.labels.filter((l) => !l.figure).map((l) => l.words),
    );
    assert.ok(!inTunnel.some((l) => /outside|^−/.test(l)), inTunnel.join("; "));
    await close(tunnel);
  },

  async "an axis of nothing but zeros ends at 1"() {
    const page = await open("fallen_stone", { script });
    await page.locator("#quality .plot").last().scrollIntoViewIfNeeded();
    await settle(page);
    const labels = await page.evaluate(() => window.labels);
    const written = labels
      .filter((l) => /^Closed contacts/.test(l.figure))
      .map((l) => l.words);
    assert.ok(written.includes("1"), written.join("; "));
    assert.ok(!written.includes("100"), written.join("; "));
    await close(page);
  },

  async "captions and checks are read in a narrow window without scrolling"() {
    const page = await open("marginal", { width: 400 });
    assert.ok((await sidewaysOverflow(page)) <= 0);
    const right = await page.$$eval("caption span", (all) =>
      all.map((e) => e.getBoundingClientRect().right),
    );
    assert.ok(Math.max(...right) <= 400, right.join());
    const checks = page.locator("#quality .table-box");
    const beyond = await checks.evaluate((e) => e.scrollWidth - e.clientWidth);
    assert.equal(beyond, 0);
    await shoot(page, "marginal-400");
    await close(page);
  },

  async "a study fits narrow windows, a dark screen and paper"() {
    const narrow = await open("study", { width: 400 });
    assert.ok((await sidewaysOverflow(narrow)) <= 0);
    await shoot(narrow, "study-400");
    await close(narrow);
    const page = await open("study", { width: 800 });
    assert.ok((await sidewaysOverflow(page)) <= 0);
    await page.pdf({
      path: join(screenshots, "study.pdf"),
      format: "A4",
    });
    await close(page);
    const dark = await open("study", { colorScheme: "dark" });
    await shoot(dark, "study-dark");
    await close(dark);
  },
};

await run(tests);
