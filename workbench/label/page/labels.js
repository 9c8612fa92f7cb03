// The labels, which etlc keeps: every key goes to it at once, and is shown once it is on disk.
// Keys that could not be written wait here, in their order, until they can be, or are dropped.

const store = {
  page: Array.from(crypto.getRandomValues(new Uint32Array(4)), (n) => n.toString(16)).join(""),
  version: 0, labels: data.episodes.map(() => data.predicates.map(() => null)),
  proposed: 0, proposals: new Map(), whyNone: "", isBusy: false,
  waiting: [], isSending: false, trouble: "", holds: true,
};

function say(trouble) {
  const box = document.getElementById("trouble");
  store.trouble = trouble;
  box.textContent = trouble;
  box.hidden = trouble === "";
}

const waitingText = () =>
  store.waiting.length > 0 ? ` ${counted(store.waiting.length, "key")} not written.` : "";

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

function takeAnswer(json) {
  store.version = json.version;
  if (json.episode === undefined) return;
  store.labels[json.episode] = json.labels;
  showLabels(json.episode);
}

const later = () => setTimeout(send, 1000);

// Sends the waiting keys, one after the other.
async function send() {
  if (store.isSending) return;
  store.isSending = true;
  while (store.waiting.length > 0) {
    document.body.dataset.waiting = store.waiting.length;
    let answer;
    try {
      answer = await post("act", store.waiting[0]);
    } catch {
      say(`etlc label does not answer: is it still running?${waitingText()}`);
      later();
      break;
    }
    const { ok, json } = answer;
    if (!ok && json.kind !== "refused") {
      if (sayRefusal(json)) later();
      break;
    }
    store.waiting.shift();
    if (ok) takeAnswer(json);
    say(ok ? "" : json.error);
  }
  document.body.dataset.waiting = store.waiting.length;
  store.isSending = false;
}

function press(action) {
  store.waiting.push({ action, episode: view.episode, predicate: view.predicate, step: view.step });
  send();
}

function dropWaiting() {
  store.waiting = [];
  document.body.dataset.waiting = 0;
  say("");
}

// Does `action` before the keys that wait, which then go on.
async function firstDo(action) {
  const { ok, json } = await post("act", { action });
  if (!ok) {
    sayRefusal(json);
    return;
  }
  say("");
  await refresh();
  send();
}

// Asks for labels and proposals that are newer than those shown.
async function refresh() {
  const { json } = await post("state", { version: store.version, proposed: store.proposed });
  store.isBusy = json.busy;
  if (!json.holds) sayRefusal({ kind: "elsewhere", error: "This page is open elsewhere, too" });
  const isBack = json.holds && !store.holds;
  store.holds = json.holds;
  if (json.labels) store.labels = json.labels;
  store.version = json.version;
  if (json.proposals) {
    store.proposals = new Map(json.proposals.map((one) => [one.episode, one]));
    store.whyNone = json.why_none;
    store.proposed = json.proposed;
  }
  if (isBack) say("");
  if (isBack) send();
  if (json.changed && !store.trouble)
    say("Another program has changed the labels on disk. r: read them again.");
  if (json.labels || json.proposals) showLabels(null);
  showProgress();
}

async function keepFresh() {
  try {
    if (!store.isSending) await refresh();
  } catch {
    say(`etlc label does not answer: is it still running?${waitingText()}`);
  }
  setTimeout(keepFresh, 1000);
}
