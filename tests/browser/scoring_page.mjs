// Answers the questionnaire that examples/methods wrote, in a headless Chromium.
//
//     node --experimental-websocket tests/browser/scoring_page.mjs out/scoring.html [FOLDER FOR SCREENSHOTS]
//
// Exit code 0: everything is as it should be, or there is no Chromium (and a line says so).

import assert from "node:assert/strict";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { pause, withTab } from "./chromium.mjs";

const [page, folder] = process.argv.slice(2);

await withTab(folder, async ({ send, evaluate, screenshot, size }) => {
  const until = async what => {
    for (let tries = 0; tries < 200; tries++) {
      if (await evaluate(what)) return;
      await pause(50);
    }
    assert.fail(`${what}: not within ten seconds`);
  };
  const open = async () => {
    await send("Page.navigate", { url: "about:blank" });
    await send("Page.navigate", { url: pathToFileURL(resolve(page)).href });
    await until("document.readyState === 'complete' && window.questionnaire !== undefined");
    return evaluate("questionnaire.order.map(film => film.key)");
  };
  const orders = [];
  for (let i = 0; i < 5; i++) orders.push((await open()).join());
  assert(new Set(orders).size > 1, "the order is random");
  await size(900, 900);
  await screenshot("scoring-begin");
  const next = () => evaluate(`document.getElementById("next").click()`);
  const choose = (name, value) => evaluate(`document.querySelector('input[name="${name}"][value="${value}"]').click()`);
  await choose("background", 4);
  await next();
  assert.equal(await evaluate("questionnaire.at"), -1, "every question has to be answered");
  await choose("difficulty", 5);
  await next();
  const films = await evaluate("questionnaire.order.length");
  for (let i = 0; i < films; i++) {
    assert.equal(await evaluate("questionnaire.at"), i);
    await until("[...document.images].every(image => image.complete && image.naturalWidth > 0)");
    assert(!await evaluate("questionnaire.order.some(film => document.body.innerText.includes(film.name))"), "nobody is told which method it is");
    if (i < 2) await screenshot(`scoring-${i}`);
    await choose("similarity", 1 + i % 5);
    if (await evaluate("questionnaire.order[questionnaire.at].leaves !== null")) await choose("regularity", 5);
    await next();
  }
  await screenshot("scoring-end");
  const rows = await evaluate("fromCsv(toCsv(questionnaire.own()))");
  assert.equal(rows.length, films);
  assert(rows.every(row => row.background === 4 && row.difficulty === 5 && row.similarity >= 1));
  assert.equal(rows.filter(row => row.regularity === 5).length, films - 1, "all but the repeat of the measured fall have leaves");
  const shown = await evaluate(`document.getElementById("table").innerText`);
  assert.match(shown, /1 participant; difficulty 5\.00/);
});
