// result_browser_test.mjs SAMPLES NODE_MODULES: what a run's report says of its result, in headless Chromium.
import assert from "node:assert/strict";
import { join } from "node:path";
import {
  close,
  openers,
  run,
  settle,
  sidewaysOverflow,
  slideTo,
  text,
} from "./browser.mjs";

const { screenshots, open, shoot } = await openers();
/** What the table of stages says of the equilibrium of each. */
const equilibria = async (page) => {
  const titles = await page.$$eval("#stages thead th", (all) =>
    all.map((e) => e.firstChild.textContent),
  );
  return page.$$eval(
    "#stages tbody tr",
    (rows, k) => rows.map((r) => r.children[k].innerText.trim()),
    titles.indexOf("Equilibrium"),
  );
};
const label = (page) => page.textContent("#time-label");

const tests = {
  async "odd input leaves no green box, and a lower bound is called one"() {
    const page = await open("odd_input");
    const quality = await text(page, "#quality");
    assert.doesNotMatch(quality, /All checks of the computation are passed/);
    assert.match(
      quality,
      /1 of \d checks needs attention: input that seems odd\./,
    );
    assert.match(quality, /Input that seems odd\s+2 warnings, listed above/);
    const warnings = page.locator("#quality .warnings li");
    assert.equal(await warnings.count(), 2);
    assert.match(
      await warnings.first().innerText(),
      /^rock\.density = 2\.6 kg\/m3 \(line 14\): usual is 1000 to 4000/,
    );
    const damage = await text(page, "#damage");
    assert.match(damage, /Closure, vertical \(lower bound\)/);
    assert.match(damage, /Closure, horizontal \(lower bound\)/);
    assert.match(damage, /Closure is a lower bound: blocks of order 1/);
    assert.match(await text(page, "#verdict"), /this is a lower bound/);
    assert.equal(await sidewaysOverflow(page), 0);
    await shoot(page, "odd-input-1400");
    await close(page);
    const other = await open("tunnel");
    assert.doesNotMatch(await text(other, "#damage"), /lower bound/);
    assert.equal(await other.locator("#quality .warnings").count(), 0);
    await close(other);
  },

  async "elements are drawn with their force, and told by the pointer"() {
    const page = await open("anchored");
    const plain = await open("tunnel");
    await slideTo(page, 1000);
    assert.match(
      await text(page, "#animation .legends"),
      /Force of the elements over their limit[\s\S]*100 % without a limit: the largest in the run, boundary 2,000 kN\/m/,
    );
    assert.doesNotMatch(
      await text(plain, "#animation .legends"),
      /Force of the elements/,
    );
    // Upwards from the bottom of the picture the pointer comes upon the base.
    const canvas = page.locator("#animation canvas").first();
    await canvas.scrollIntoViewIfNeeded();
    const box = await canvas.boundingBox();
    let words = "";
    for (let up = 25; up < 0.4 * box.height && !/kind/.test(words); up += 5) {
      await page.mouse.move(
        box.x + 0.2 * box.width,
        box.y + box.height - up,
      );
      await settle(page);
      words = (await text(page, ".tooltip")).replace(/\s+/g, " ");
    }
    assert.match(words, /^boundary\.base kind boundary force 2,000 kN\/m/);
    assert.match(
      await text(page, "#histories"),
      /load cell \(spring anchor <1>\)[\s\S]*Force\s*kN\/m[\s\S]*Elongation\s*mm/,
    );
    assert.match(await text(page, "#damage"), /Largest utilization/);
    assert.doesNotMatch(await text(plain, "#damage"), /utilization/);
    await shoot(page, "anchored-1400");
    await close(page);
    await close(plain);
  },

  async "an opening in parts has its ground reaction curve"() {
    const page = await open("marginal");
    const release = page.locator("#release");
    assert.equal(await release.count(), 1);
    const words = await text(page, "#release");
    assert.match(words, /^Ground reaction/);
    assert.match(words, /Closure\s*mm\s*crown\s*springline\s*mean of the wall/);
    assert.equal(await release.locator(".plot").count(), 1);
    await release.scrollIntoViewIfNeeded();
    await release.locator("canvas").waitFor();
    assert.equal(await sidewaysOverflow(page), 0);
    await shoot(page, "release-1400");
    await close(page);
    const other = await open("tunnel");
    assert.equal(await other.locator("#release").count(), 0);
    await close(other);
  },

  async "a marginal case says so and lists its moving blocks"() {
    const page = await open("marginal");
    assert.match(
      await text(page, ".verdict"),
      /^5 blocks \(2\.55\sm²\) have fallen: 2 blocks \(0\.75\sm²\) before the shaking, and the shaking added 3 blocks \(1\.8\sm²\); the opening/,
    );
    const findings = await text(page, "#verdict .findings");
    const words =
      "“in situ”: mechanism of 1 block \\(0\\.6\\sm²\\) and " +
      "“excavated”: 2 blocks moving, 1 block falling, equilibrium of the others not reached \\(1\\.8\\sm² in all\\)";
    assert.match(
      findings,
      new RegExp(`This case is marginal: ${words}\\. What falls may depend`),
    );
    assert.match(
      findings,
      /2 of 7 other checks need attention: steps that did not converge and largest true overlap of two blocks\./,
    );
    assert.match(
      findings,
      /7 slivers merged, 3 of them across a joint that runs through\. Teeth of rock of up to 12\smm hold the joint there\./,
    );
    assert.match(findings, /1 sliver left in the model, as the scenario asks\./);
    // One of them is listed in both stages.
    assert.match(
      await text(page, "#verdict details:not(.falls details) > summary"),
      /^3 blocks moving at the end of a static stage/,
    );
    assert.equal(await page.locator("#verdict tbody tr").count(), 4);
    assert.match(await text(page, "#verdict thead"), /Mass\s*t\/m/);
    assert.deepEqual(
      await page.$$eval("#verdict tbody tr", (rows) =>
        rows.map((r) => r.children[2].textContent),
      ),
      ["mechanism", "partly held", "falling", "partly held"],
    );
    assert.deepEqual(await equilibria(page), [
      "mechanism of 1 block",
      "2 blocks moving, 1 block falling, equilibrium of the others not reached",
      "–",
      "–",
    ]);
    assert.ok((await page.locator("#quality td.attention").count()) >= 3);
    assert.match(
      await text(page, "#quality tbody"),
      /2\.4\s*mm, of blocks 3 and 7, at 1\.50\s*s in “shake”/,
    );
    assert.match(
      await text(page, "#quality tbody tr:last-child"),
      new RegExp(`Marginal static stages\\s*${words}`),
    );
    await page.locator("#verdict button.link").first().click();
    assert.match(await label(page), /^in situ/);
    await page.locator("#verdict button.link").nth(1).click();
    assert.match(await label(page), /^excavated/);
    await shoot(page, "marginal-1400");
    await close(page);
  },

  async "slips have the digits they need, and the limit that they are measured by"() {
    const page = await open("tunnel");
    assert.match(
      await text(page, "#verdict"),
      /31\.7\sm of joint slipped by more than 1 mm and 11\.2\sm opened by more than 1 mm\./,
    );
    assert.match(
      await text(page, "#verdict"),
      /slipped by up to 73\.1 mm;[^]*In place at the end: up to 19\.6 mm/,
    );
    // The wall point in the crown is on a fallen block.
    assert.match(
      await text(page, "#verdict"),
      /Closure of the opening: vertical –, horizontal −2\.1 mm \(–: a point of the wall is on a block that has fallen\)\./,
    );
    const joints = "#damage .table-box:nth-of-type(2)";
    const columns = await page.$$eval(`${joints} thead th`, (all) =>
      all.map((e) => e.firstChild.textContent),
    );
    const last = await page.$$eval(`${joints} tbody tr:last-child > *`, (all) =>
      all.map((e) => e.innerText.trim()),
    );
    assert.equal(last[columns.indexOf("Closure, vertical")], "–");
    assert.match(last[columns.indexOf("Largest slip ever")], /^73\.1/);
    await close(page);
    const still = await open("far_and_still");
    const titles = await still.$$eval(`${joints} thead th`, (all) =>
      all.map((e) => e.firstChild.textContent),
    );
    const row = await still.$$eval(
      `${joints} tbody tr:first-child > *`,
      (all) => all.map((e) => e.firstChild.textContent),
    );
    const slips = [
      "Largest slip in place",
      "Largest slip ever",
      "Mean slip in place",
    ];
    assert.deepEqual(
      slips.map((title) => row[titles.indexOf(title)]),
      ["0.013", "0.013", "0.00072"],
    );
    await close(still);
  },

  async "a run without frames has tables and plots"() {
    const page = await open("no_frames");
    assert.equal(await page.locator("canvas:not(.uplot canvas)").count(), 0);
    assert.ok((await page.locator(".plot").count()) >= 10);
    assert.deepEqual(await equilibria(page), [
      "in equilibrium after moving 0.031 m",
      "not reached",
      "–",
      "–",
    ]);
    assert.match(await text(page, "#stages"), /31 mm/);
    assert.match(
      await text(page, "#verdict .findings"),
      /This case is marginal: “excavated”: equilibrium not reached\. /,
    );
    await shoot(page, "no_frames-1400");
    await close(page);
  },

  async "an empty result is shown as such"() {
    const page = await open("empty");
    assert.match(await text(page, ".verdict"), /No frame was recorded/);
    await close(page);
  },

  async "a run without excavation says whether it stands, and has the measures that apply"() {
    const page = await open("no_excavation");
    const columns = await page.$$eval("#damage thead th", (all) =>
      all.map((e) => e.firstChild.textContent),
    );
    assert.deepEqual(columns, [
      "At the end of",
      "Hinges",
      "Largest rotation",
      "Largest slip in place",
      "Largest slip ever",
    ]);
    assert.equal(await page.locator("#damage tbody tr").count(), 4);
    assert.equal(await text(page, ".badge"), "Stands");
    const result = await text(page, "#verdict");
    assert.match(result, /It stands at the end of “after”\./);
    assert.match(
      result,
      /The largest displacement is 31\.2 mm \(bent brick\) and the largest rotation of a block is 0\.09°\./,
    );
    assert.match(
      result,
      /4 joints between blocks in place are hinges: open at one end by more than 1 mm/,
    );
    assert.doesNotMatch(result, /no excavation|What falls/);
    await shoot(page, "no_excavation-1400");
    await close(page);
  },

  async "a wall that stands where it was moved to is not said to be as before"() {
    const page = await open("fallen_stone");
    assert.equal(await text(page, ".badge"), "Stands, moved by up to 500 m");
    assert.ok(await page.locator(".badge.attention").isVisible());
    await close(page);
  },

  async "a collapse is called one"() {
    const page = await open("collapsed");
    assert.equal(await text(page, ".badge"), "Has collapsed");
    assert.ok(await page.locator(".badge.bad").isVisible());
    const result = await text(page, "#verdict");
    assert.match(
      result,
      /A part of it has collapsed: 1 of \d+ blocks has fallen\. The first fell in “first earthquake”\./,
    );
    assert.match(
      result,
      /Weight of fallen rock\s*13\.4 kN\/m \(1 block, 0\.6 m²\)/,
    );
    assert.doesNotMatch(result, /pressure|wall/);
    await shoot(page, "collapsed-1400");
    await close(page);
  },

  async "what falls is told as an engineer asks it"() {
    const page = await open("tunnel");
    assert.equal(await text(page, ".badge"), "Rock falls");
    await page.locator(".falls summary").click();
    const result = await text(page, "#verdict");
    assert.match(
      result,
      /Weight of fallen rock\s*[\d.]+ kN\/m \(\d+ blocks?, [\d.]+ m²\)/,
    );
    assert.match(
      result,
      /Largest block\s*[\d.]+ kN\/m \([\d.]+ m², block \d+\)/,
    );
    assert.match(result, /Depth behind the wall\s*crown [\d.]+ m/);
    assert.match(result, /Largest block over its width\s*[\d.]+ kPa/);
    assert.match(result, /keyblock limit SCENARIO\.toml --key excavation\.\S+\.pressure --from \S+ --to 0/);
    assert.match(result, /All checks of the computation are passed/);
    assert.match(result, /One realization of the joints \(number 3\)/);
    await close(page);
  },

  async "ground and loads are listed, and program facts come last"() {
    const page = await open("tunnel");
    const facts = await page.$$eval("#ground dl > div", (all) =>
      all.map((e) => [...e.children].map((c) => c.innerText.trim())),
    );
    const found = Object.fromEntries(facts);
    assert.equal(found["K₀"], "0.8");
    assert.equal(found["Depth"], "80 m of rock above the model");
    assert.equal(found["Young's modulus E"], "12 GPa");
    assert.match(
      found["Set “bed joints”"],
      /^dip 0° towards 90°.*spacing 0\.6 m/,
    );
    assert.match(
      found["PGA in “first earthquake”"],
      /^2\.31\sm\/s² \(0\.24\sg\)$/,
    );
    for (const word of ["hash", "Degrees of freedom"])
      assert.doesNotMatch(await text(page, "#verdict"), new RegExp(word));
    assert.match(await text(page, "#run"), /Degrees of freedom/);
    await close(page);
  },

  async "the first screen of a laptop has the result, its picture and what falls"() {
    const page = await open("tunnel", { width: 1366, height: 768 });
    for (const part of [
      ".badge",
      ".verdict",
      ".final canvas",
      ".final figcaption",
      ".falls",
      ".result .findings",
      "#ground",
    ]) {
      const box = await page.locator(part).first().boundingBox();
      assert.ok(
        box.y >= 0 && box.y + box.height <= 768,
        `${part}: ${box.y} + ${box.height}`,
      );
    }
    const parts = [];
    for (const part of [".words", ".final", "#ground"])
      parts.push(await page.locator(part).boundingBox());
    for (const [left, right] of [parts.slice(0, 2), parts.slice(1)])
      assert.ok(
        right.x > left.x + left.width - 1 && right.y < left.y + left.height,
      );
    await page.screenshot({ path: join(screenshots, "first-screen-1366.png") });
    await close(page);
    const phone = await open("tunnel", { width: 390, height: 844 });
    assert.ok((await sidewaysOverflow(phone)) <= 0);
    const tops = [];
    for (const part of [".verdict", ".final canvas", ".answers", "#ground"])
      tops.push((await phone.locator(part).boundingBox()).y);
    assert.deepEqual(
      [...tops].sort((a, b) => a - b),
      tops,
    );
    await phone.screenshot({ path: join(screenshots, "first-screen-390.png") });
    await close(phone);
  },
};

await run(tests);
