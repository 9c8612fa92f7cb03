// The page of `etlc watch`: each event is a step with its frame, and both are shown together.

const kDrawMs = 100;  // the timelines are drawn at most so often; the frame and the table always
const kQuietMs = 2000;
const view = { steps: [], timelines: null, held: false, busy: false, waiting: null, drawn: 0,
  heard: performance.now() };

const numbers = ["distance", "robustness", "lower", "upper"];
const decoded = (value) => (value === null ? NaN : Number(value));

// Makes the tracks of the report from the steps; a step that the page has missed is a gap.
function episodeOf(steps) {
  const first = steps[0].step;
  const count = steps[steps.length - 1].step - first + 1;
  const tracks = {};
  const makeTracks = (of, items, make) => {
    tracks[of] = items.map(() => [make()]);
    for (const one of steps)
      one[of].forEach((value, index) => { tracks[of][index][0][one.step - first] = value; });
  };
  for (const of of numbers)
    makeTracks(of, of === "distance" ? data.predicates : data.monitors,
      () => new Float64Array(count).fill(NaN));
  makeTracks("holds", data.predicates, () => new Uint8Array(count).fill(3));
  makeTracks("status", data.monitors, () => new Uint8Array(count).fill(3));
  return { first, steps: count, buckets: 0, tracks };
}

function drawTimelines() {
  if (view.steps.length === 0) return;
  const before = view.held && view.timelines;
  view.drawn = performance.now();
  view.timelines = before || new Timelines(document.getElementById("tracks"),
    episodeOf(view.steps), { move: () => {}, drawn: () => {} });
  view.timelines.draw();
  view.timelines.moveTo(-1);  // no cursor
}

function valueCell(value) {
  return element("td", { class: "number" }, measured(value));
}

function showReadout(one) {
  const head = element("tr", { class: "head" }, element("th", {}, when(one.step)),
    element("th", {}, "value"), element("th", {}, "threshold"), element("th", {}, "said"));
  const predicates = data.predicates.map((predicate, index) =>
    element("tr", { "data-predicate": predicate.shown }, element("th", {}, predicate.shown),
      valueCell(one.distance[index]),
      element("td", {}, `${predicate.comparison} ${levelsText(predicate)}`),
      saidCell(one.holds[index], "predicate")));
  const monitors = data.monitors.map((monitor, index) =>
    element("tr", { "data-monitor": monitor.name }, element("th", {}, monitor.name),
      valueCell(one.robustness[index]), element("td", {}, ">= 0"),
      saidCell(verdictCode(one.status[index], index), "monitor")));
  fill("readout", element("tbody", {}, head, ...predicates, ...monitors));
  document.getElementById("readout").dataset.step = one.step;
}

function showFrame(image, one) {
  const canvas = document.getElementById("frame");
  const caption = document.getElementById("picture-step");
  canvas.dataset.step = image ? one.step : "";
  caption.textContent = image ? `the frame of ${when(one.step)}` : `no frame at ${when(one.step)}`;
  if (!image) return;
  canvas.width = image.width;
  canvas.height = image.height;
  canvas.getContext("2d").drawImage(image, 0, 0);
}

// Shows the newest step; those that come while a frame is decoded are left out.
async function show(one) {
  view.waiting = one;
  if (view.busy) return;
  view.busy = true;
  while (view.waiting) {
    const next = view.waiting;
    view.waiting = null;
    let image = null;
    if (next.frame) {
      image = new Image();
      image.src = next.frame;
      await image.decode().catch(() => { image = null; });
    }
    if (view.held) break;
    showFrame(image, next);
    showReadout(next);
    if (performance.now() - view.drawn >= kDrawMs) drawTimelines();
  }
  view.busy = false;
}

// Reads a step, whose numbers JSON cannot hold all; returns it with its frame, and keeps it without.
function take(one) {
  const { frame, ...rest } = one;
  for (const of of numbers) rest[of] = rest[of].map(decoded);
  const last = view.steps[view.steps.length - 1];
  if (last && rest.step <= last.step) return null;
  view.steps.push(rest);
  while (rest.step - view.steps[0].step >= data.past) view.steps.shift();
  return { ...rest, frame };
}

function hear(event) {
  const said = JSON.parse(event.data);
  view.heard = performance.now();
  if (said.past) {
    view.steps = [];
    said.past.forEach(take);
  }
  const one = said.past ? view.steps[view.steps.length - 1] : take(said);
  document.getElementById("progress").textContent = one ? counted(one.step + 1, "step") : "";
  if (one && !view.held) show(one);
  if (said.past && !view.held) drawTimelines();
}

function say(trouble) {
  const place = document.getElementById("trouble");
  place.textContent = trouble;
  place.hidden = trouble === "";
}

function hold() {
  view.held = !view.held;
  document.getElementById("hold").classList.toggle("chosen", view.held);
  if (view.held) return;
  drawTimelines();
}

function begin() {
  beginTheme();
  document.querySelector("figure").hidden = !data.frames;
  document.title = `${data.spec.name}: etlc watch`;
  document.getElementById("title").textContent = data.spec.name;
  document.getElementById("subtitle").textContent = data.source;
  document.getElementById("hold").addEventListener("click", hold);
  listenTo({ " ": hold, d: switchTheme });
  onOtherWidth(drawTimelines);
  const events = new EventSource("events");
  events.onmessage = hear;
  events.onopen = () => { view.heard = performance.now(); };
  setInterval(() => {
    const quiet = performance.now() - view.heard;
    if (events.readyState !== EventSource.OPEN) say("etlc watch does not answer: it has ended");
    else if (quiet > kQuietMs) say(`nothing has arrived for ${Math.round(quiet / 1000)} s`);
    else say("");
  }, 250);
}

begin();
