// study_browser_test.mjs SAMPLES NODE_MODULES: opens the reports of made-up studies in headless Chromium and uses them as a
// reader would. Screenshots are left in SAMPLES/screenshots. Exit code 77: skipped, as there is no Chromium.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import {
  close,
  openers,
  run,
  settle,
  sidewaysOverflow,
  text,
} from "./browser.mjs";

const { samples, open, shoot } = await openers();
const study = (name) =>
  JSON.parse(readFileSync(join(samples, name, "study.json"), "utf8"));
const drawing = (page, id, k = 0) =>
  page.$$eval(
    `#${id} .chart-target svg`,
    (all, n) => all[n]?.outerHTML ?? "",
    k,
  );
/** Of the first screen (0) and of the maps below. */
const pixels = (page, k) =>
  page.$$eval(":is(#verdict, #map) canvas", (all, n) => all[n].toDataURL(), k);
const select = (page, label, value) =>
  page
    .locator(".selection label", { hasText: label })
    .locator("select")
    .selectOption(value);

const tests = {
  async "tells the result first, then how sure it is, then the runs"() {
    const page = await open("study");
    const headings = await page.$$eval("h2", (all) =>
      all.map((e) => e.textContent),
    );
    assert.deepEqual(headings, [
      "Result",
      "Fragility",
      "Probability of damage",
      "How much, and how sure",
      "Where rock falls",
      "Measures of damage",
      "Worst and median run",
      "Every realization at the end",
      "All runs",
      "Failed and missing runs",
      "How it was computed",
    ]);
    assert.equal(await text(page, "h1"), "Tunnel <synthetic> & shaken");
    assert.equal(await page.title(), "Tunnel <synthetic> & shaken");
    const verdict = await text(page, ".verdict");
    const found =
      /^With scale of first earthquake 1\.0, order 1, rock falls in (\d+) of (\d+) realizations \((\d+)\u2060–\u2060(\d+)\s%\)\. The shaking brings rock down in (\d+) of \d+ realizations \(.*\)\. Before it, under gravity alone, rock had fallen in (\d+) of \d+ \(.*\)\.$/.exec(
        verdict,
      );
    assert.ok(found, verdict);
    const own = study("study").combinations.find(
      (c) => c.values.join() === "1.0,1",
    );
    assert.deepEqual(
      [1, 2, 3, 5, 6].map((k) => Number(found[k])),
      [
        own.falls.exceeded,
        own.n,
        Math.round(100 * own.falls.low),
        own.added.falls.exceeded,
        own.before.falls.exceeded,
      ],
    );
    const all = await text(page, "#verdict");
    assert.match(all, /Not enough realizations: \d+ of 8 combinations/);
    assert.match(all, /13 runs failed and 2 runs of 960 are missing/);
    assert.match(all, /\d+ of \d+ checked runs are marginal/);
    assert.match(await text(page, "#method"), /18446744073709551615/);
    assert.equal(await sidewaysOverflow(page), 0);
    assert.doesNotMatch(await text(page, "#measures"), /have none|differences/);
    await shoot(page, "study-1400");
    await close(page);
  },

  async "fragility has a curve, points and a band for every group, and switches"() {
    const page = await open("study");
    const count = (selector) => page.locator(`#fragility ${selector}`).count();
    assert.equal(await count("path.curve"), 2);
    assert.equal(await count("path.band"), 2);
    assert.equal(await count("g.point"), 8);
    const [level, intensity] = [0, 1].map((k) =>
      page.locator("#fragility select").nth(k),
    );
    const pga = await drawing(page, "fragility");
    assert.match(pga, /PGA \(m\/s²\)/);
    await intensity.selectOption("arias_m_s");
    const arias = await drawing(page, "fragility");
    assert.match(arias, /Arias intensity \(m\/s\)/);
    assert.notEqual(arias, pga);
    await intensity.selectOption("pgv_m_s");
    await level.selectOption("severe");
    // Nothing is that severe: points, no curve, and the table says why.
    assert.equal(await count("path.curve"), 0);
    assert.equal(await count("g.point"), 8);
    assert.match(
      await text(page, "#fragility table"),
      /no curve: no run exceeds the level/,
    );
    await close(page);
  },

  async "where there is no curve, neither the page nor its headline gives a median"() {
    const page = await open("study_since");
    assert.equal(await page.locator("#fragility path.curve").count(), 0);
    assert.equal(await page.locator("#fragility g.point").count(), 2);
    const findings = await text(page, "#verdict .findings");
    assert.match(findings, /No fragility curve of “\w+” over PGA: /);
    assert.doesNotMatch(findings, /Half of the realizations/);
    await close(page);
    const fitted = await open("study");
    assert.match(
      await text(fitted, "#verdict .findings"),
      /Half of the realizations exceed “\w+” at a PGA of [\d.]+ m\/s² \([\d.]+ … [\d.]+\), order 1; β of the fragility curve is [\d.]+ \(/,
    );
    await close(fitted);
  },

  async "the first screen of a laptop has the map, the answer, and what falls"() {
    const page = await open("study", { width: 1366, height: 768 });
    for (const selector of [
      "#verdict .verdict",
      "#verdict canvas",
      "#verdict table",
      "#verdict .where .legend",
    ]) {
      const box = await page.locator(selector).boundingBox();
      assert.ok(box.y >= 0 && box.y + box.height <= 768, selector);
    }
    const rows = await page.$$eval("#verdict tbody tr", (all) =>
      all.map((r) => [...r.children].map((e) => e.firstChild.textContent)),
    );
    const c = study("study").combinations.find(
      (x) => x.values.join() === "1.0,1",
    );
    const parts = [c.before, c.added, c];
    assert.deepEqual(rows[0], [
      "Rock falls in",
      ...parts.map((p) => `${p.falls.exceeded} of ${p.falls.n}`),
    ]);
    assert.deepEqual(rows[2], [
      "More than 0.8\u00a0m² (moderate)",
      ...parts.map((p) => `${p.levels[1].exceeded} of ${p.levels[1].n}`),
    ]);
    const area = rows.find((r) => r[0] === "Area (m²)").slice(1);
    const wanted = parts.flatMap((p) =>
      [0.5, 0.95].map(
        (q) => p.measures.fallen_area_m2.quantiles.find((x) => x.p === q).value,
      ),
    );
    area.forEach((x, k) => {
      assert.ok(Math.abs(Number(x) - wanted[k]) <= 0.05 * wanted[k], x);
    });
    for (const what of [
      "Weight (kN/m)",
      "Largest block (kN/m)",
      "Largest block over its width (kPa)",
      "Depth behind the wall (m)",
    ])
      assert.ok(
        rows.some((r) => r[0] === what),
        what,
      );
    const hidden = await page.$eval(
      ".first-screen .table-box",
      (e) => e.scrollWidth - e.clientWidth,
    );
    assert.equal(hidden, 0);
    const facts = await text(page, "#ground");
    assert.match(facts, /Joints: friction φ\s+30°/);
    assert.match(facts, /PGA\s+0\.214 … 1\.07\sm\/s² \(0\.02 … 0\.11\sg\)/);
    await page.screenshot({
      path: join(samples, "screenshots", "study-first-screen.png"),
    });
    const since = await open("study_since", { width: 1366, height: 768 });
    const ground = await since.locator("#ground").boundingBox();
    assert.ok(ground.y + ground.height <= 768, JSON.stringify(ground));
    await close(since);
    // The selection changes both.
    const row = await text(page, "#verdict tbody tr:first-child");
    const before = await pixels(page, 0);
    await select(page, "scale", "0.4");
    await settle(page);
    assert.notEqual(await pixels(page, 0), before);
    assert.notEqual(await text(page, "#verdict tbody tr:first-child"), row);
    await close(page);
  },

  async "the selection changes curves, maps, tables and pictures"() {
    const page = await open("study");
    const state = async () => [
      await drawing(page, "distribution", 0),
      await drawing(page, "distribution", 1),
      await pixels(page, 1),
      await pixels(page, 2),
      await text(page, "#measures tbody"),
      await text(page, "#extremes"),
      await text(page, "#gallery"),
    ];
    const before = await state();
    await select(page, "scale", "0.4");
    await select(page, "order", "2");
    await settle(page);
    const after = await state();
    before.forEach((value, k) =>
      assert.notEqual(value, after[k], `thing ${k} did not change`),
    );
    assert.match(
      await text(page, "#gallery .chosen"),
      /^scale of first earthquake 0\.4, order 2: 60 realizations/,
    );
    await select(page, "measure", "slip_max_m");
    assert.match(
      await drawing(page, "distribution", 0),
      /largest slip in place \(mm\)/,
    );
    // A click on a combination chooses it.
    await page.locator("#measures button.link").first().click();
    assert.match(await text(page, "#map .chosen"), /earthquake 0\.2, order 1/);
    await close(page);
  },

  async "every realization has its picture, which leads to its report"() {
    const page = await open("study");
    await select(page, "scale", "0.2");
    const figures = page.locator("#gallery figure");
    assert.equal(await figures.count(), 60);
    assert.equal(await page.locator("#gallery .failed").count(), 1);
    assert.match(await figures.nth(7).innerText(), /killed by signal 9/);
    assert.ok((await page.locator("#gallery .marginal").count()) > 0);
    const image = page.locator("#gallery img").first();
    await image.scrollIntoViewIfNeeded();
    await page.waitForFunction(
      () => document.querySelector("#gallery img").naturalWidth > 0,
    );
    assert.equal(await page.locator("#extremes img").count(), 2);
    await page.locator("#gallery select").selectOption("area");
    const worst = await figures.first().locator("strong").innerText();
    assert.ok(
      (await text(page, "#extremes")).includes(worst.replace("R", "r")),
      worst,
    );
    await page.locator("#gallery a").first().click();
    await page.waitForURL(/runs\/r\d+-s0\.2-o1\/report\.html$/);
    await close(page);
  },

  async "runs sort by any column, and more of them are shown when asked"() {
    const page = await open("study");
    const titles = await page.$$eval("#runs thead th", (all) =>
      all.map((e) => e.innerText),
    );
    const area = titles.findIndex((title) => title.startsWith("fallen area"));
    const first = () =>
      page.$$eval(
        "#runs tbody tr",
        (rows, k) => rows.map((r) => r.children[k].textContent),
        area,
      );
    assert.equal((await first()).length, 100);
    await page.locator("#runs button.sort", { hasText: "fallen area" }).click();
    const numbers = (await first()).map(Number);
    assert.ok(numbers.every((x, k) => k === 0 || x <= numbers[k - 1]));
    assert.ok(numbers[0] > 0);
    await page.locator("#runs button.sort", { hasText: "fallen area" }).click();
    assert.equal(Number((await first())[0]), 0);
    await page.locator("#runs button", { hasText: "Show more" }).click();
    assert.equal((await first()).length, 600);
    assert.equal(await page.locator("#failed tbody tr").count(), 13);
    for (const file of ["runs.csv", "study.json"])
      assert.equal(await page.locator(`#runs a[href="${file}"]`).count(), 1);
    await close(page);
  },

  async "the pointer reads curves and maps"() {
    const page = await open("study");
    const chart = page.locator("#distribution .chart-target").first();
    await chart.scrollIntoViewIfNeeded();
    const box = await chart.boundingBox();
    await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
    assert.match(await text(page, "#distribution .reading"), /^\s*[\d.]+ %$/);
    const map = page.locator("#map canvas").first();
    await map.scrollIntoViewIfNeeded();
    const place = await map.boundingBox();
    await page.mouse.move(
      place.x + 0.5 * place.width,
      place.y + 0.22 * place.height,
    );
    assert.match(
      await text(page, "#map .hint"),
      /^x .*, y .* m: \d+ of 59 realizations/,
    );
    await close(page);
  },

  async "a small study without levels, maps and pictures shows what there is"() {
    const page = await open("study_small");
    assert.equal(await page.locator("#fragility, #map, #gallery").count(), 0);
    assert.match(
      await text(page, ".verdict"),
      /^Rock falls in 2 of 2 realizations \(.*\)\. The shaking brings rock down in 2 of 2/,
    );
    assert.match(
      await text(page, "#verdict .findings"),
      /^[\d.]+\sm² of rock falls on average of 2 realizations: [\d.]+\sm² before the shaking, [\d.]+\sm² by it\.\n/,
    );
    assert.equal(await page.locator("#runs tbody tr").count(), 2);
    await shoot(page, "study_small-1400");
    await close(page);
  },

  async "points at one intensity stand over an axis with numbers"() {
    const page = await open("study_one_intensity");
    const at = study("study_one_intensity").fragility[0].points.intensity;
    assert.equal(at.length, 1);
    const numbers = await page.$$eval("#fragility .axes text", (all) =>
      all
        .filter((e) => e.getAttribute("text-anchor") === "middle")
        .map((e) => Number(e.textContent))
        .filter((x) => !Number.isNaN(x)),
    );
    assert.ok(numbers.length >= 2, numbers.join());
    assert.ok(numbers[0] < at[0] && at[0] < numbers.at(-1), numbers.join());
    assert.match(await text(page, "#fragility table"), /no curve: every run/);
    await shoot(page, "study_one_intensity-1400");
    await close(page);
  },

  async "measures that begin later are told apart from pictures of all that happened"() {
    const page = await open("study_since");
    assert.match(
      await text(page, ".verdict"),
      /the shaking brings rock down in \d of 3 realizations \(.*\)\. Before it, under gravity alone, (rock|nothing) had fallen/,
    );
    for (const id of ["map", "extremes", "gallery"])
      assert.match(
        await text(page, `#${id} .hint`),
        /since the first excavation: what gravity brought down before the shaking, too/,
      );
    assert.match(
      await text(page, "#map"),
      /Fallen or loosened since the first excavation/,
    );
    assert.match(
      await text(page, "#gallery figcaption"),
      /m² fallen by the shaking/,
    );
    for (const id of ["distribution", "measures", "runs"])
      assert.match(
        await text(page, `#${id} .hint`),
        /Measures are differences: .* less what was there at the end of “excavated”, the last stage before the shaking/,
      );
    assert.match(
      await text(page, "#measures caption"),
      /bootstrap intervals; fewer than 5 realizations have none/,
    );
    await shoot(page, "study_since-1400");
    await close(page);
  },

  async "counts of realizations are whole, and bands end at the axes"() {
    const page = await open("study_since");
    const chart = page.locator("#distribution .chart-target svg").nth(1);
    const marks = await chart.evaluate((e) =>
      [...e.querySelectorAll(".axes text")]
        .filter((t) => t.getAttribute("text-anchor") === "middle")
        .map((t) => Number(t.textContent)),
    );
    assert.deepEqual(marks, [1, 2, 3]);
    const [clip, frame] = await chart.evaluate((e) => {
      const band = e.querySelector(".band").parentNode;
      const id = /#([\w-]+)/.exec(band.getAttribute("clip-path"))[1];
      const box = e.querySelector(`#${id} rect`);
      const [y, height] = ["y", "height"].map((k) =>
        Number(box.getAttribute(k)),
      );
      const path = e.querySelector(".frame").getAttribute("d");
      const [, top, bottom] = /^M\S+ (\S+)V(\S+)H/.exec(path).map(Number);
      return [
        [y, y + height],
        [top, bottom],
      ];
    });
    assert.deepEqual(clip, frame);
    await close(page);
  },

  async "that nothing has fallen yet is not called precise"() {
    const page = await open("study_still");
    const all = await text(page, "#verdict");
    assert.match(
      all,
      /Not enough realizations: 1 of 1 combination is known less well/,
    );
    assert.match(all, /No variation yet in 1 combination/);
    assert.doesNotMatch(all, /Enough realizations: every/);
    await close(page);
  },

  async "a study without an opening says how far blocks move where none falls"() {
    const page = await open("study_wall");
    assert.match(
      await text(page, ".verdict"),
      /^With .*, blocks fall in none of 8 realizations \(probability below \d+\s%, with 95\s% confidence\)\. The largest displacement is [\d.]+\smm in the median and [\d.]+\smm at 95 %; the largest rotation is [\d.]+° in the median/,
    );
    const rows = await page.$$eval(".what-falls tbody th", (all) =>
      all.map((e) => e.innerText),
    );
    assert.equal(rows[0], "Blocks fall in");
    assert.ok(rows.includes("Largest displacement (mm)"), rows.join());
    assert.ok(!rows.includes("Largest block over its width (kPa)"), rows.join());
    assert.doesNotMatch(await text(page, "#verdict"), /[Rr]ock falls|opening/);
    await close(page);
  },

  async "a study without runs says so"() {
    const page = await open("study_empty");
    assert.match(await text(page, ".verdict"), /No run has ended/);
    await close(page);
  },

  async "a study with many pictures holds some of them, says so, and opens soon"() {
    const page = await open("study_large");
    assert.match(
      await text(page, "#gallery .hint"),
      /This page holds the pictures of 1,500 runs/,
    );
    assert.ok((await page.locator("#gallery .no-picture").count()) > 0);
    assert.equal(await page.locator("#extremes img").count(), 2);
    console.log(`  ready after ${page.seconds.toFixed(2)} s`);
    assert.ok(page.seconds < 3 * (process.env.CI ? 3 : 1.5));
    await close(page);
  },
};

await run(tests);
