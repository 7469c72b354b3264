// The questionnaire's page: one film after the other, in random order.

const element = id => document.getElementById(id);
const content = JSON.parse(element("content").textContent);
const order = [...content.films];
for (let i = order.length - 1; i > 0; i--) {
  const j = Math.floor(Math.random() * (i + 1));
  [order[i], order[j]] = [order[j], order[i]];
}
const answers = new Map();
let loaded = [], at = -1;
const gif = data => `data:image/gif;base64,${data}`;

/** Five buttons of which one is chosen. */
function scale(name, question, ends, value) {
  const choice = n => `<label><input type="radio" name="${name}" value="${n}" ${n === value ? "checked" : ""}>${n}</label>`;
  return `<fieldset><legend>${question}</legend><span class="scale"><small>${ends[0]}</small>${[1, 2, 3, 4, 5].map(choice).join("")}<small>${ends[1]}</small></span></fieldset>`;
}
const chosen = name => Number(document.querySelector(`input[name="${name}"]:checked`)?.value) || null;
const person = {};

function show() {
  const page = element("page"), film = order[at];
  if (at < 0) {
    page.innerHTML = `<h1>Falling leaves and paper: how good are these films?</h1>
      <p>You will see ${order.length} films of falling paper beside a measured fall, and nine leaves that are moved in the same way. Nothing you
      answer leaves this page unless you save it.</p>
      <p><label>Your name, or any other word: <input id="participant" value="${plain(person.participant ?? "")}"></label></p>`
      + scale("background", "Are you familiar with graphical programming of game development (animation, physics engines), fluid mechanics (aerodynamics), or graphics tools (Maya, Blender)?",
        ["not familiar", "very sophisticated"], person.background)
      + scale("difficulty", "Is it easy to simulate the motion of lightweight objects (leaf, paper)?", ["very easy", "very difficult"], person.difficulty);
  } else if (film) {
    const given = answers.get(film.key) ?? {};
    page.innerHTML = `<h1>Film ${at + 1} of ${order.length}</h1>
      <div class="films"><figure><img src="${gif(content.measured)}" alt="a measured fall"><figcaption>a measured fall</figcaption></figure>
      <figure><img src="${gif(film.track)}" alt="the fall to judge"><figcaption>this film</figcaption></figure>`
      + (film.leaves ? `<figure><img src="${gif(film.leaves)}" alt="nine leaves"><figcaption>nine leaves, moved in the same way</figcaption></figure>` : "") + `</div>`
      + scale("similarity", "Is the fall similar to the measured one? (The dot is the paper's center; how it turns was not measured.)", ["not similar", "very similar"], given.similarity)
      + (film.leaves ? scale("regularity", "Are motion patterns apparent in how the leaves fall (flutter, tumbling, spirals …)?", ["not apparent", "very apparent"], given.regularity) : "");
  } else {
    page.innerHTML = `<h1>Thank you</h1><div id="table"></div>
      <p><button id="save">Save the answers as CSV</button>
      <label class="button">Add answers of others <input id="load" type="file" accept=".csv" multiple hidden></label></p><p id="problem"></p>
      <p><small>E is Σ w E<sub>i</sub> / Σ w over all participants, w their background. In the thesis (19 participants, other films): graph-based similarity
      4.24 and regularity 4.0, stochastic 3.64 and 3.4, pattern-driven 4.11 and 3.9; difficulty 4.49.</small></p>`;
    element("save").onclick = save;
    element("load").onchange = load;
    table();
  }
  element("back").hidden = at < 0;
  element("next").hidden = at >= order.length;
  element("missing").textContent = "";
}

/** Keeps what is chosen on this page; whether that is all. */
function keep() {
  const film = order[at];
  if (at < 0) {
    Object.assign(person, { participant: plain(element("participant").value) || `guest ${Math.floor(1e6 * Math.random())}`,
      background: chosen("background"), difficulty: chosen("difficulty") });
    return person.background !== null && person.difficulty !== null;
  }
  if (!film) return true;
  const given = { similarity: chosen("similarity"), regularity: film.leaves ? chosen("regularity") : null };
  answers.set(film.key, given);
  return given.similarity !== null && (!film.leaves || given.regularity !== null);
}

const own = () => [...answers].map(([film, given]) => ({ ...person, film, ...given }));

function table() {
  const all = scores([...loaded, ...own()]), number = x => x === null || x === undefined ? "" : x.toFixed(2);
  const row = film => `<tr><td>${film.name}</td><td>${number(all.films[film.key]?.similarity)}</td><td>${number(all.films[film.key]?.regularity)}</td></tr>`;
  element("table").innerHTML = `<p>${all.participants} participant${all.participants === 1 ? "" : "s"}; difficulty ${number(all.difficulty)}</p>
    <table><tr><th>film</th><th>similarity</th><th>regularity</th></tr>${content.films.map(row).join("")}</table>`;
}

function save() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([toCsv(own())], { type: "text/csv" }));
  link.download = `answers-${person.participant.replace(/\W+/g, "-")}.csv`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

async function load(event) {
  element("problem").textContent = "";
  for (const file of event.target.files) {
    try {
      const rows = fromCsv(await file.text());
      // One who is there already is not counted twice.
      const known = new Set([person.participant, ...loaded.map(row => row.participant)]);
      loaded.push(...rows.filter(row => !known.has(row.participant)));
    } catch (problem) {
      element("problem").textContent += `${file.name}: ${problem.message}. `;
    }
  }
  table();
}

element("next").onclick = () => {
  if (!keep()) {
    element("missing").textContent = "Please answer every question.";
    return;
  }
  at++;
  show();
};
element("back").onclick = () => { keep(); at--; show(); };
window.questionnaire = { own, order, get at() { return at; } };
show();
