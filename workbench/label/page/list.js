// The list of episodes: labelled, proposed, or neither.

const isOpen = (episode, predicate) =>
  !store.labels[episode][predicate] && !data.episodes[episode].recorded[predicate];
const isLabelled = (episode) => data.predicates.every((_, index) => !isOpen(episode, index));

// Returns what is shown as proposed, by predicate; null where nothing is.
function proposedFor(episode) {
  const marks = store.proposals.get(episode)?.marks
    .map((of, index) => (isOpen(episode, index) ? of : null));
  return marks?.some((of) => of) ? marks : null;
}

// Returns whether nobody has labelled the predicate, once the keys that wait are written.
function staysOpen(episode, predicate) {
  let open = isOpen(episode, predicate);
  for (const key of store.waiting) {
    const isAbout = key.episode === episode && (key.marks?.[predicate] ||
      (key.action !== "accept" && key.predicate === predicate));
    if (!isAbout) continue;
    if (["accept", "begin", "end", "never"].includes(key.action)) open = false;
    if (key.action === "forget") open = !data.episodes[episode].recorded[predicate];
  }
  return open;
}

const list = { filter: "", rows: [] };

function rowState(episode) {
  if (isLabelled(episode)) return "labelled";
  const proposal = store.proposals.get(episode);
  return proposal ? `${Math.round(proposal.doubt * 100)} % in doubt` : "";
}

function showRow(episode) {
  const row = list.rows[episode];
  const { name, path, steps } = data.episodes[episode];
  const dots = data.predicates.map((predicate, index) => element("span", {
    class: `dot ${isOpen(episode, index) ? "unknown" : "satisfied"}`,
    title: `${predicate}: ${isOpen(episode, index) ? "not labelled" : "labelled"}` }));
  row.replaceChildren(element("span", { class: "name", title: path }, name),
    element("span", { class: "dots" }, ...dots),
    element("span", { class: "quiet" },
      [counted(steps, "step"), rowState(episode)].filter((text) => text).join(", ")));
}

function markSelected() {
  list.rows.forEach((row, episode) => {
    row.classList.toggle("selected", episode === view.episode);
    if (episode === view.episode) bringIntoSight(row);
  });
}

function filterRows() {
  data.episodes.forEach(({ path }, episode) => {
    list.rows[episode].hidden = !path.toLowerCase().includes(list.filter);
  });
}

function beginList() {
  list.rows = data.episodes.map((_, episode) => {
    const row = element("div", { class: "row", "data-place": episode });
    row.addEventListener("click", () => chooseEpisode(episode));
    return row;
  });
  fill("rows", ...list.rows);
  list.rows.forEach((_, episode) => showRow(episode));
  const field = document.getElementById("filter");
  field.addEventListener("input", () => {
    list.filter = field.value.toLowerCase();
    filterRows();
  });
}

function neighbour(step) {
  const shown = list.rows.map((_, episode) => episode)
    .filter((episode) => episode === view.episode || !list.rows[episode].hidden);
  const next = shown[shown.indexOf(view.episode) + step];
  if (next !== undefined) chooseEpisode(next);
}

// The most doubtful episode that is not labelled; without proposals the next one in the list.
function nextOpen() {
  const count = data.episodes.length;
  const inOrder = data.episodes.map((_, index) => (view.episode + 1 + index) % count);
  const next = [...store.proposals.keys(), ...inOrder].find((episode) =>
    episode !== view.episode && data.predicates.some((_, index) => staysOpen(episode, index)));
  if (next !== undefined) chooseEpisode(next);
}

function showProgress() {
  const done = data.episodes.filter((_, episode) => isLabelled(episode)).length;
  const more = store.isBusy ? ", learning from them …"
    : store.whyNone ? `, not proposed: ${store.whyNone}` : "";
  document.getElementById("progress").textContent =
    `${done} of ${counted(data.episodes.length, "episode")} labelled${more}`;
}
