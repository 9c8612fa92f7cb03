// The episode on the page, its keys, and the start of the page.

// `moves` counts how often somebody has chosen an episode.
const view = { episode: 0, step: 0, predicate: 0, timelines: null, domain: null, moves: 0 };
const play = { timer: null, speed: 1, begun: 0, from: 0 };

function drawTracks() {
  const { steps, recorded } = data.episodes[view.episode];
  const proposed = proposedFor(view.episode);
  view.timelines = new LabelTracks(document.getElementById("tracks"), {
    steps, recorded, predicate: view.predicate, marks: store.labels[view.episode],
    proposed: proposed ?? data.predicates.map(() => null),
  }, { move: moveCursor, drawn: () => {
    view.domain = view.timelines.domain;
    view.timelines.moveTo(view.step);
  } });
  view.timelines.domain = view.domain ?? view.timelines.whole();
  view.timelines.draw();
  view.timelines.moveTo(view.step);
}

// Shows the labels of an episode after a change, or of all: null.
function showLabels(episode) {
  if (episode === null) list.rows.forEach((_, index) => showRow(index));
  else showRow(episode);
  if (episode === null || episode === view.episode) drawTracks();
  showProgress();
}

function moveCursor(step) {
  view.step = Math.max(0, Math.min(data.episodes[view.episode].steps - 1, step));
  view.timelines.moveTo(view.step);
  document.getElementById("episode-summary").textContent =
    `${when(view.step)} of ${counted(data.episodes[view.episode].steps, "step")}` +
    (play.timer ? `, ${play.speed} times its speed` : "");
  moveCamera();
}

function selectEpisode(episode) {
  stop();
  Object.assign(view, { episode, step: 0, domain: null });
  history.replaceState(null, "", `#${episode}`);  // a reload comes back to it
  document.getElementById("episode-name").textContent = data.episodes[episode].path;
  markSelected();
  showPictures();
  drawTracks();
  moveCursor(0);
}

function chooseEpisode(episode) {
  view.moves++;
  selectEpisode(episode);
}

function choosePredicate(predicate) {
  if (predicate >= data.predicates.length) return;
  view.predicate = predicate;
  drawTracks();
}

function stop() {
  clearInterval(play.timer);
  play.timer = null;
}

function start() {
  const { steps } = data.episodes[view.episode];
  if (view.step === steps - 1) moveCursor(0);
  Object.assign(play, { begun: performance.now(), from: view.step });
  const seconds = data.spec.step_seconds || 0.1;
  play.timer = setInterval(() => {
    const passed = (performance.now() - play.begun) / 1000 / seconds * play.speed;
    if (play.from + passed >= steps - 1) stop();
    moveCursor(play.from + Math.floor(passed));
  }, 20);
}

function changeSpeed(factor) {
  play.speed = Math.max(0.25, Math.min(16, play.speed * factor));
  if (play.timer) {
    stop();
    start();
  }
}

// Goes to the next or last step at which a label or a proposal of the predicate changes.
function toEdge(direction) {
  const lane = view.timelines.lanes[view.predicate];
  const edges = [lane.labels, lane.said].filter((codes) => codes)
    .flatMap((codes) => runsOf(codes).map(([first]) => first));
  edges.push(0, data.episodes[view.episode].steps - 1);
  const beyond = edges.filter((edge) => (edge - view.step) * direction > 0);
  if (beyond.length > 0) moveCursor(direction > 0 ? Math.min(...beyond) : Math.max(...beyond));
}

function step(event, by) {
  stop();
  moveCursor(view.step + by * (event.shiftKey ? 10 : 1));
}

const keys = {
  " ": () => (play.timer ? stop() : start()),
  ",": () => changeSpeed(0.5),
  ".": () => changeSpeed(2),
  ArrowLeft: (event) => step(event, -1),
  ArrowRight: (event) => step(event, 1),
  Home: () => moveCursor(0),
  End: () => moveCursor(Infinity),
  "[": () => toEdge(-1),
  "]": () => toEdge(1),
  ArrowUp: () => neighbour(-1),
  ArrowDown: () => neighbour(1),
  k: () => neighbour(-1),
  j: () => neighbour(1),
  n: nextOpen,
  p: () => choosePredicate((view.predicate + 1) % data.predicates.length),
  b: () => press("begin"),
  e: () => press("end"),
  x: () => press("remove"),
  f: () => press("never"),
  "?": () => press("unknown"),
  c: () => press("forget"),
  a: () => press("accept"),
  u: () => press("undo"),
  U: () => press("redo"),
  r: () => firstDo("reload"),
  o: () => firstDo("claim"),
  Escape: dropWaiting,
  "+": () => view.timelines.zoomAbout(view.step, 0.5),
  "-": () => view.timelines.zoomAbout(view.step, 2),
  0: () => view.timelines.zoom(view.timelines.whole()),
  d: switchTheme,
};
// The letters of the keys that go to etlc, to say which of them wait.
const letterOf = { begin: "b", end: "e", remove: "x", never: "f", unknown: "?", forget: "c",
  accept: "a", undo: "u", redo: "U" };

for (let digit = 1; digit <= 9; digit++) keys[digit] = () => choosePredicate(digit - 1);

const keyTable = [
  ["space", "play, pause"], [", .", "slower, faster"], ["← →", "a step; with Shift 10"],
  ["[ ]", "the last, the next change"], ["1 … 9 p", "choose the predicate"],
  ["b", "it holds from here on"], ["e", "it holds up to here"], ["x", "remove the interval here"],
  ["f", "it never holds"], ["?", "nobody knows here"], ["c", "clear: not labelled"],
  ["a", "accept what is proposed"], ["u U", "undo, redo"], ["n", "next to label"],
  ["↑ ↓ k j", "episode before, after"], ["+ - 0", "zoom"], ["d", "dark or light"],
];

function begin() {
  beginTheme();
  document.title = `${data.spec.name}: etlc label`;
  document.getElementById("title").textContent = data.spec.name;
  document.getElementById("subtitle").textContent = `labels go to ${data.tables.join(", ")}`;
  fill("keys", ...keyTable.map(([key, does]) => element("tr", {},
    element("th", {}, ...key.split(" ").map((one) => element("kbd", {}, one))),
    element("td", {}, does))));
  beginList();
  selectEpisode(Math.min(Number(location.hash.slice(1)) || 0, data.episodes.length - 1));
  listenTo(keys);
  onOtherWidth(drawTracks);
  window.addEventListener("pagehide", () => navigator.sendBeacon("act",
    JSON.stringify({ page: store.page, action: "release" })));
  keepFresh();
}

begin();
