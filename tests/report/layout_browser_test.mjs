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
};

await run(tests);
