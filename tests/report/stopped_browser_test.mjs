// stopped_browser_test.mjs SAMPLES NODE_MODULES: reports of runs that did not reach their end, in headless Chromium.
import assert from "node:assert/strict";
import { close, openers, run, slideTo, text } from "./browser.mjs";

const { open, shoot } = await openers();

async function labelAt(page, frame) {
  await slideTo(page, frame);
  return page.textContent("#time-label");
}

const cells = (page, row) =>
  page.$$eval(`${row} > *`, (all) => all.map((e) => e.innerText.trim()));

const tests = {
  async "an interrupted run says how much of its plan was done"() {
    const page = await open("interrupted");
    assert.match(
      await text(page, "#verdict .attention"),
      /interrupted within “first earthquake”, after 6\.00 of 10 s; “after” was not run\./,
    );
    assert.match(
      await text(page, "#stages tbody tr:nth-child(3)"),
      /first earthquake\s*interrupted[\s\S]*6\.00 of 10/,
    );
    assert.match(
      await text(page, "#stages tbody tr:last-child"),
      /after\s*not run/,
    );
    assert.match(
      await text(page, "#damage tbody tr:last-child"),
      /6\.00 of 10 s, peak 0\.24 g, interrupted/,
    );
    assert.match(
      await text(page, ".pictures figure:last-child"),
      /Within “first earthquake”[\s\S]*6\.00 of 10 s/,
    );
    assert.match(
      await labelAt(page, 89),
      /^first earthquake · 6\.00 of 10 s · run time 6\.00 s/,
    );
    assert.match(
      await text(page, "#quality"),
      /All checks of the computation are passed/,
    );
    await shoot(page, "interrupted-1400");
    await close(page);
  },

  async "times within short stages have the digits they need"() {
    const page = await open("short");
    assert.match(
      await labelAt(page, 14),
      /^first earthquake · 0\.0480 of 0\.08 s · run time 0\.0480 s/,
    );
    assert.match(
      await text(page, ".pictures figure:last-child"),
      /0\.0480 of 0\.08 s/,
    );
    await close(page);
  },

  async "a run that was killed shows no number that nobody measured"() {
    const page = await open("killed");
    assert.match(
      await text(page, ".verdict"),
      /^\d+ blocks? \([\d.]+\sm²\) ha(s|ve) fallen since the excavation \(tunnel\), all by the shaking; [\d.]+ m² more are loosened\.$/,
    );
    const findings = await text(page, "#verdict");
    assert.match(
      findings,
      /The run was cut off within “first earthquake”, after 6\.00 of 10 s, step 5,000; “after” was not run\./,
    );
    assert.match(
      findings,
      /By the end of “excavated” joints had slipped by up to 400 µm/,
    );
    const facts = await text(page, "#run .facts");
    assert.match(facts, /Wall time\s*not known/);
    assert.match(facts, /Per step\s*–/);
    const stage = await cells(page, "#stages tbody tr:nth-child(3)");
    assert.match(stage[5], /^2\.31 \(0\.24 g\)$/);
    assert.equal(stage.at(-1), "–");
    const damage = await cells(page, "#damage tbody tr:last-child");
    assert.match(damage[1], /^\d+\s*\+\d+$/);
    assert.equal(damage[5], "–");
    const checks = await page.$$eval("#quality tbody tr", (rows) =>
      rows.map((r) => [...r.children].map((c) => c.innerText)),
    );
    assert.equal(checks.filter((c) => c[1] === "not known").length, 5);
    for (const check of checks)
      assert.equal(check[3], check[1] === "not known" ? "–" : "✓ passed");
    assert.match(
      await text(page, "#quality .finding"),
      /5 of 8 checks cannot be made/,
    );
    assert.match(await text(page, "#quality .facts"), /not known/);
    assert.equal(await page.locator(".aside .plot").count(), 3); // with the ground motion
    await shoot(page, "killed-1400");
    await close(page);
  },
};

await run(tests);
