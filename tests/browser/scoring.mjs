// The numbers of the questionnaire of examples/methods, in Node: (7.1) on answers that were made up.
//
//     node tests/browser/scoring.mjs

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const source = readFileSync(new URL("../../examples/methods/scoring.js", import.meta.url), "utf8");
const { weightedMean, scores, toCsv, fromCsv } = new Function(`${source}; return { weightedMean, scores, toCsv, fromCsv };`)();

// Weights 1, 4, 5 and values 5, 3, 1: (5 + 12 + 5) / 10, by hand; the plain mean would be 3.
assert.equal(weightedMean([[1, 5], [4, 3], [5, 1]]), 2.2);
assert.equal(weightedMean([]), null);

const row = (participant, background, difficulty, film, similarity, regularity) =>
  ({ participant, background, difficulty, film, similarity, regularity });
const rows = [
  row("a", 1, 5, "graph", 5, 4), row("a", 1, 5, "law", 1, 1), row("a", 1, 5, "repeat", 4, null),
  row("b", 4, 3, "graph", 3, 2), row("b", 4, 3, "law", 2, 5), row("b", 4, 3, "repeat", 5, null),
  row("c", 5, 1, "graph", 1, 1),
];
const all = scores(rows);
assert.equal(all.participants, 3);
assert.equal(all.difficulty, 2.2, "each participant counts once, however many films");
assert.deepEqual(all.films.graph, { answers: 3, similarity: 2.2, regularity: 1.7 });
assert.deepEqual(all.films.law, { answers: 2, similarity: 9 / 5, regularity: 21 / 5 });
assert.deepEqual(all.films.repeat, { answers: 2, similarity: 24 / 5, regularity: null });

assert.deepEqual(fromCsv(toCsv(rows)), rows);
assert.equal(toCsv([row("x,\n\"y\"", 1, 1, "law", 1, 1)]).split("\n")[1], "x   y,1,1,law,1,1");
const head = "participant,background,difficulty,film,similarity,regularity\n";
for (const bad of ["", "a,b\n", `${head}a,0,1,law,1,1`, `${head}a,1,6,law,1,1`, `${head}a,1,1,law,x,1`, `${head}a,1,1,law,1`, `${head},1,1,law,1,1`]) {
  assert.throws(() => fromCsv(bad), /line/);
}
console.log("the questionnaire's numbers are those of (7.1)");
