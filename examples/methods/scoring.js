// The questionnaire's numbers, without the page: thesis § 7.2.

const COLUMNS = ["participant", "background", "difficulty", "film", "similarity", "regularity"];

/** (7.1): Σ w E / Σ w over pairs of a weight and a value; null of none. */
function weightedMean(pairs) {
  const weight = pairs.reduce((sum, [w]) => sum + w, 0);
  return weight > 0 ? pairs.reduce((sum, [w, value]) => sum + w * value, 0) / weight : null;
}

/** Rows of answers, one for each participant and film, as E of the difficulty and, by film, of similarity and regularity. */
function scores(rows) {
  const participants = new Map(rows.map(row => [row.participant, row]));
  const films = {};
  for (const film of new Set(rows.map(row => row.film))) {
    const of = rows.filter(row => row.film === film);
    const mean = question => weightedMean(of.filter(row => row[question] !== null).map(row => [row.background, row[question]]));
    films[film] = { answers: of.length, similarity: mean("similarity"), regularity: mean("regularity") };
  }
  const difficulty = weightedMean([...participants.values()].map(row => [row.background, row.difficulty]));
  return { participants: participants.size, difficulty, films };
}

/** Text without what would end a field. */
const plain = text => String(text).replace(/[",\r\n]/g, " ").trim();

function toCsv(rows) {
  const line = row => COLUMNS.map(column => plain(row[column] ?? "")).join(",");
  return [COLUMNS.join(","), ...rows.map(line)].join("\n") + "\n";
}

/** What toCsv wrote; throws an error that names the line if it is something else. */
function fromCsv(text) {
  const lines = text.trim().split(/\r?\n/);
  if (lines[0] !== COLUMNS.join(",")) throw new Error("line 1: not a file of answers");
  return lines.slice(1).map((line, index) => {
    const fields = line.split(",");
    const number = (column, optional) => {
      const field = fields[COLUMNS.indexOf(column)];
      if (optional && field === "") return null;
      if (!/^[1-5]$/.test(field)) throw new Error(`line ${index + 2}: ${column} is '${field}', not 1 to 5`);
      return Number(field);
    };
    if (fields.length !== COLUMNS.length || !fields[0] || !fields[3]) throw new Error(`line ${index + 2}: not an answer`);
    return { participant: fields[0], background: number("background"), difficulty: number("difficulty"), film: fields[3],
      similarity: number("similarity", true), regularity: number("regularity", true) };
  });
}
