// The selected episode: its values at the cursor and the explanations of its verdicts.

const view = { row: null, episode: null, timelines: null, step: 0, why: 0 };

// Returns the values of a track at a step: one, or the least and the greatest of its bucket.
function valueAt(episode, of, index, step) {
  const series = episode.tracks[of]?.[index];
  if (!series) return [];
  return series.map((values) => values[placeOf(episode, values.length, step)]);
}

// Returns the index of a step in a series.
function placeOf(episode, count, step) {
  if (count === episode.steps) return step;
  return Math.min(Math.floor((step + 0.5) * count / episode.steps), count - 1);
}

const valueText = (values) =>
  values.length === 2 && values[0] !== values[1]
    ? `${measured(values[0])} … ${measured(values[1])}` : measured(values[0]);

function readoutRow(lane, step) {
  const of = lane.kind === "predicate" ? "distance" : "robustness";
  const row = element("tr", { "data-lane": lane.name }, element("th", {}, lane.name),
    element("td", { class: "number" }, valueText(valueAt(view.episode, of, lane.index, step))),
    saidCell(lane.said[step], lane.kind));
  row.append(lane.truth ? saidCell(lane.truth[step], lane.kind) : element("td", {}));
  return row;
}

function inputRows(step) {
  return (view.episode.tracks.input ?? []).map(([values], index) =>
    element("tr", {}, element("th", {}, data.inputs[index].name), element("td", {}),
      saidCell(values[step], "predicate"), element("td", {})));
}

function showReadout() {
  const head = element("tr", { class: "head" }, element("th", {}, when(view.step)),
    element("th", {}, "value"), element("th", {}, "said"),
    element("th", {}, data.has_truth ? "true" : ""));
  const nearest = data.predicates.map((predicate, index) => {
    const [row] = valueAt(view.episode, "nearest", index, view.step);
    return row === undefined ? null : `${predicate.shown}: row ${row} of ${predicate.target}`;
  }).filter((text) => text !== null);
  fill("readout", element("tbody", {}, head,
    ...view.timelines.lanes.map((lane) => readoutRow(lane, view.step)), ...inputRows(view.step),
    element("tr", {}, element("td", { colspan: 4, class: "quiet" },
      nearest.length > 0 ? `nearest: ${nearest.join(", ")}` : ""))));
}

function showWhy() {
  const { why } = view.episode;
  const chosen = why.find((of) => of.monitor === view.why) ?? why[0];
  view.timelines.mark(chosen);
  if (!chosen) {
    fill("why");
    return;
  }
  const buttons = element("div", { class: "orders" }, ...why.map((of) => {
    const button = element("button", { type: "button", class: of === chosen ? "chosen" : "" },
      data.monitors[of.monitor].name);
    button.addEventListener("click", () => {
      view.why = of.monitor;
      showWhy();
    });
    return button;
  }));
  const goTo = element("button", { type: "button", class: "go" }, `go to ${when(chosen.step)}`);
  goTo.addEventListener("click", () => moveCursor(chosen.step));
  fill("why", element("h4", {}, "Why"), buttons, goTo,
    element("pre", { "data-monitor": data.monitors[chosen.monitor].name },
      ...unbroken(chosen.text)));
}

function moveCursor(step) {
  if (!view.episode) return;
  view.step = Math.max(0, Math.min(view.episode.steps - 1, step));
  view.timelines.moveTo(view.step);
  showReadout();
  movePlanes();
  movePictures();
}

function summaryOf(row) {
  const verdicts = row.outcomes.map((outcome, index) => {
    const since = outcome.finalAt === null ? "" : ` from ${when(outcome.finalAt)} on`;
    return `${data.monitors[index].name}: ${verdictWord(endOf(outcome, index))}${since}`;
  });
  if (row.missing > 0) verdicts.push(`${counted(row.missing, "sample")} missing`);
  return verdicts.join(" · ");
}

// Returns where to begin: where the first wrong monitor begins to stay wrong, or else where a
// predicate is first called wrong.
function errorOf(row) {
  const lane = view.timelines.lanes.find((of) => of.kind === "monitor" && of.name === row.wrong[0]);
  if (!lane?.truth) return row.firstError;
  const isWrong = (step) => differs(lane.said[step], lane.truth[step]);
  let step = lane.said.length - 1;
  while (step > 0 && !isWrong(step)) step--;
  while (step > 0 && isWrong(step - 1)) step--;
  return isWrong(step) ? [step, lane.name] : row.firstError;
}

// Returns what was said and what is true there, or else the first alarm.
function headlineOf(row, error) {
  if (error) {
    const [step, name] = error;
    const lane = view.timelines.lanes.find((of) => of.name === name);
    const word = (codes) => {
      const short = saidCell(codes[step], lane.kind).textContent;
      return { "so far": "satisfied so far", "not yet": "not yet satisfied" }[short] ?? short;
    };
    const both = lane?.truth && step < lane.said.length
      ? `${word(lane.said)}; in truth it is ${word(lane.truth)}` : "wrong";
    return `Wrong at ${when(step)}: ${name} is called ${both}.`;
  }
  const alarm = row.outcomes.findIndex((of) => of.alarm !== null && of.alarm === row.alarm);
  if (alarm >= 0) return `Alarm at ${when(row.alarm)}: ${data.monitors[alarm].name} is violated.`;
  return data.has_truth ? "Nothing is called wrong in it." : "It raised no alarm.";
}

async function selectEpisode(row) {
  list.selected = row;
  markSelected();
  const episode = row.series === null ? null : await unpack(row.series);
  if (list.selected !== row) return;  // another one was chosen meanwhile
  document.getElementById("episode-name").textContent = row.path;
  document.getElementById("episode-summary").textContent = summaryOf(row);
  if (row.series === null) {
    view.episode = null;
    for (const id of ["headline", "readout", "why", "planes", "pictures", "nearest"]) fill(id);
    fill("tracks", element("p", {}, "No timelines: they were left out to keep this page small."));
    return;
  }
  view.row = row;
  view.episode = episode;
  view.timelines = new Timelines(document.getElementById("tracks"), episode,
    { move: moveCursor, drawn: () => { showWhy(); moveCursor(view.step); } });
  const broken = row.outcomes.findIndex((outcome) => outcome.alarm !== null);
  const wrong = data.monitors.findIndex((monitor) => row.wrong.includes(monitor.name));
  view.why = wrong >= 0 ? wrong : Math.max(broken, 0);
  const error = errorOf(row);
  document.getElementById("headline").textContent = headlineOf(row, error);
  view.step = error?.[0] ??
    episode.why.find((of) => of.monitor === view.why)?.step ?? 0;
  view.timelines.draw();
  showPlanes();
  showPictures();
  showWhy();
  moveCursor(view.step);
}
