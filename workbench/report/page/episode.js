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

function saidCell(code, kind) {
  const words = kind === "monitor" ? statusWords : ["no", "yes", "unknown", "undecided"];
  const status = statusOf(code);
  return element("td", { class: `said ${kind} ${statusWords[status]}` },
    words[status] + (isFinal(code) ? ", for good" : ""));
}

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
    const final = outcome.finalAt === null ? "" : `, for good at ${when(outcome.finalAt)}`;
    return `${data.monitors[index].name}: ${statusWords[outcome.status]}${final}`;
  });
  if (row.firstError)
    verdicts.push(`first wrong: ${row.firstError[1]} at ${when(row.firstError[0])}`);
  if (row.missing > 0) verdicts.push(`${counted(row.missing, "sample")} missing`);
  return verdicts.join(" · ");
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
    for (const id of ["readout", "why", "planes", "pictures", "nearest"]) fill(id);
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
  view.step = row.firstError?.[0] ??
    episode.why.find((of) => of.monitor === view.why)?.step ?? 0;
  view.timelines.draw();
  showPlanes();
  showPictures();
  showWhy();
  moveCursor(view.step);
}
