// The labels, which etlc keeps: every key goes to it at once, with the episode that it is about,
// and is shown once it is on disk. Until then it waits here, in its order, and the page says so.
// Answers may come late: they never change what the keys that follow are about.

const store = {
  page: Array.from(crypto.getRandomValues(new Uint32Array(4)), (n) => n.toString(16)).join(""),
  version: 0, labels: data.episodes.map(() => data.predicates.map(() => null)),
  proposed: 0, proposals: new Map(), whyNone: "", isBusy: false,
  waiting: [], pressed: 0, isSending: false, trouble: "", refusal: "", holds: true,
};

const changedElsewhere = "Another program has changed the labels on disk. r: read them again.";
const noAnswer = "etlc label does not answer: is it still running?";

function say(trouble) {
  const box = document.getElementById("trouble");
  store.trouble = trouble;
  box.textContent = trouble;
  box.hidden = trouble === "";
}

const waitingText = () =>
  store.waiting.length > 0 ? ` ${counted(store.waiting.length, "key")} not written.` : "";

const nameOf = (episode) => data.episodes[episode].name;

// Says what is not on disk yet, or what a late answer was about.
function note(text) {
  const box = document.getElementById("note");
  box.textContent = text;
  box.hidden = text === "";
}

function showWaiting() {
  const most = 3;
  const shown = store.waiting.slice(0, most)
    .map(({ action, episode }) => `${letterOf[action]} in ${nameOf(episode)}`);
  const more = store.waiting.length - shown.length;
  if (more > 0) shown.push(`${more} more`);
  note(shown.length > 0 ? `not written yet: ${shown.join(", ")}` : "");
  const waiting = new Set(store.waiting.map((key) => key.episode));
  list.rows.forEach((row, episode) => row.classList.toggle("waiting", waiting.has(episode)));
  document.body.dataset.waiting = store.waiting.length;
}

async function post(path, content) {
  const answer = await fetch(path, {
    method: "POST", headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ page: store.page, ...content }),
  });
  return { ok: answer.ok, json: await answer.json() };
}

// Says what stopped the first waiting key, and how to go on. Returns whether it tries again itself.
function sayRefusal({ kind, error }) {
  if (kind === "elsewhere") say(`${error}. o: label here instead.${waitingText()}`);
  else if (kind === "changed")
    say(`${error}. r: read it again and go on. Esc: drop the keys.${waitingText()}`);
  else if (kind === "disk") say(`${error}. It is tried again. Esc: drop the keys.${waitingText()}`);
  else say(error);
  return kind === "disk";
}

// Shows the labels after a key. Only undo and redo change the episode, if nobody has gone on.
function takeAnswer(key, json) {
  if (json.version < store.version) return;
  // More than one change has been made since the last answer: refresh() asks for all of them.
  if (json.version <= store.version + 1) store.version = json.version;
  const { episode } = json;
  if (episode === undefined) return;
  store.labels[episode] = json.labels;
  showLabels(episode);
  if (key.action !== "undo" && key.action !== "redo") return;
  if (key.moves !== view.moves) note(`${key.action} in ${nameOf(episode)}`);
  else if (episode !== view.episode) selectEpisode(episode);
}

const later = () => setTimeout(send, 1000);

// Sends the waiting keys, one after the other.
async function send() {
  if (store.isSending) return;
  store.isSending = true;
  while (store.waiting.length > 0) {
    const [key] = store.waiting;
    let answer;
    try {
      answer = await post("act", key);
    } catch {
      say(`${noAnswer}${waitingText()}`);
      later();
      break;
    }
    const { ok, json } = answer;
    if (!ok && json.kind !== "refused") {
      if (sayRefusal(json)) later();
      break;
    }
    store.waiting.shift();
    showWaiting();
    if (ok) takeAnswer(key, json);
    else store.refusal = `${letterOf[key.action]} in ${nameOf(key.episode)}: ${json.error}`;
    say(store.refusal);
  }
  store.isSending = false;
}

// Its number tells etlc whether it has a key already, of which the page did not get the answer.
function press(action) {
  const { episode, predicate, step, moves } = view;
  const marks = action === "accept" ? proposedFor(episode) : null;
  store.refusal = action === "accept" && !marks ? `nothing is proposed for ${nameOf(episode)}` : "";
  if (store.waiting.length === 0 || store.refusal) say(store.refusal);
  if (store.refusal) return;
  store.pressed++;
  store.waiting.push({ action, number: store.pressed, episode, predicate, step, marks, moves });
  showWaiting();
  send();
}

// Drops the keys that wait, but not one that is on its way.
function dropWaiting() {
  store.waiting.splice(store.isSending ? 1 : 0);
  showWaiting();
  say("");
}

// Does `action` before the keys that wait, which then go on.
async function firstDo(action) {
  try {
    const { ok, json } = await post("act", { action });
    if (!ok) {
      sayRefusal(json);
      return;
    }
    say("");
    await refresh();
    send();
  } catch {
    say(`${noAnswer}${waitingText()}`);
  }
}

// Asks for labels and proposals that are newer than those shown.
async function refresh() {
  const { json } = await post("state", { version: store.version, proposed: store.proposed });
  store.isBusy = json.busy;
  if (!json.holds) sayRefusal({ kind: "elsewhere", error: "This page is open elsewhere, too" });
  const isBack = json.holds && !store.holds;
  store.holds = json.holds;
  const isNew = json.labels && json.version >= store.version;  // else a key's answer overtook it
  if (isNew) Object.assign(store, { labels: json.labels, version: json.version });
  if (json.proposals) {
    store.proposals = new Map(json.proposals.map((one) => [one.episode, one]));
    store.whyNone = json.why_none;
    store.proposed = json.proposed;
  }
  if (isBack) say("");
  if (isBack) send();
  if (json.changed && !store.trouble) say(changedElsewhere);
  if (!json.changed && store.trouble === changedElsewhere) say("");
  if (store.trouble === noAnswer) say("");
  if (isNew || json.proposals) showLabels(null);
  showProgress();
}

async function keepFresh() {
  try {
    if (!store.isSending) await refresh();
  } catch {
    say(`${noAnswer}${waitingText()}`);
  }
  setTimeout(keepFresh, 1000);
}
