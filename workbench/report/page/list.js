// The list of episodes, worst first, with sorting and filters.

// Names the members of a row that workbench/report/document.cpp writes.
const episodes = data.rows.map(
  ([path, frames, outcomes, missing, judged, parts, buckets, series, pictures], place) => {
    const finite = outcomes.filter((of) => of[0] <= 1).map((of) => of[1])
      .filter((value) => value !== null);
    const alarms = outcomes.map((of) => of[2]).filter((step) => step !== null);
    return {
      place, path, frames, missing, parts, buckets, series, pictures,
      outcomes: outcomes.map(([status, robustness, alarm, finalAt]) =>
        ({ status, robustness, alarm, finalAt })),
      wrong: judged?.[0] ?? [], wrongShare: judged?.[1] ?? null, unknown: judged?.[2] ?? null,
      firstError: judged?.[3] ?? null,
      margin: finite.length > 0 ? Math.min(...finite.map(Math.abs)) : Infinity,
      alarm: alarms.length > 0 ? Math.min(...alarms) : Infinity,
    };
  });

const orders = {
  worst: { title: "Worst", help: "wrong verdicts, then the share of wrong frames; without truths " +
    "alarms, then the least robustness", key: (episode) => episode.place },
  margin: { title: "Margin", help: "the smallest change that would flip a last verdict",
    key: (episode) => episode.margin },
  alarm: { title: "Alarm", help: "the step of the first alarm", key: (episode) => episode.alarm },
  name: { title: "Name", help: "the file", key: (episode) => episode.path },
};

const rowsAtOnce = 120;

const list = { order: "worst", filter: "", shown: [], drawn: 0, selected: null };

// Returns the code of the last verdict; the worst of a sliding monitor.
const endOf = (outcome, index) =>
  verdictCode(statusOf(outcome.status) + (outcome.finalAt === null ? 0 : 4), index);

function statusDot(outcome, index) {
  const code = endOf(outcome, index);
  return element("span", { class: `dot ${codeClass(code)}`,
    title: `${data.monitors[index].name}: ${verdictWord(code)}` });
}

function rowElement(episode) {
  const errors = !data.has_truth ? null
    : episode.wrong.length > 0 ? `${episode.wrong.length} wrong: ${episode.wrong.join(", ")}`
    : episode.wrongShare === null ? "no truth known"
    : [[episode.wrongShare, "wrong"], [episode.unknown, "unknown"]]
      .filter(([share]) => share > 0).map(([share, what]) => `${percent(share)} of frames ${what}`)
      .join(", ") || "all right";
  const row = element("div", { class: "row", role: "option", "data-place": episode.place },
    element("span", { class: "name", title: episode.path }, baseName(episode.path)),
    element("span", { class: "dots" }, ...episode.outcomes.map(statusDot)),
    element("span", { class: episode.wrong.length > 0 ? "error" : "quiet" },
      errors ?? counted(episode.frames, "step")),
    element("span", { class: "quiet" },
      Number.isFinite(episode.alarm) ? `alarm ${episode.alarm}` : "",
      Number.isFinite(episode.margin) ? ` ±${measured(episode.margin)}` : ""));
  row.addEventListener("click", () => selectEpisode(episode));
  return row;
}

function drawMoreRows() {
  const box = document.getElementById("rows");
  const end = Math.min(list.drawn + rowsAtOnce, list.shown.length);
  for (; list.drawn < end; list.drawn++) box.append(rowElement(list.shown[list.drawn]));
  markSelected();
}

function markSelected() {
  for (const row of document.getElementById("rows").children) {
    const isSelected = row.dataset.place === String(list.selected?.place);
    row.classList.toggle("selected", isSelected);
    row.setAttribute("aria-selected", isSelected);
    if (isSelected) bringIntoSight(row);
  }
}

function drawList() {
  const { key } = orders[list.order];
  list.shown = episodes.filter((episode) => episode.path.toLowerCase().includes(list.filter));
  list.shown.sort((a, b) => {
    const [x, y] = [key(a), key(b)];
    return x < y ? -1 : x > y ? 1 : a.place - b.place;
  });
  list.drawn = 0;
  document.getElementById("rows").replaceChildren();
  drawMoreRows();
}

function neighbour(step) {
  const at = list.shown.indexOf(list.selected) + step;
  if (at < 0 || at >= list.shown.length) return;
  while (at >= list.drawn) drawMoreRows();
  selectEpisode(list.shown[at]);
}

function leftOut() {
  const found = [];
  const unlisted = data.episodes - episodes.length;
  const without = episodes.filter((episode) => episode.series === null).length;
  const rounded = episodes.filter((episode) => episode.series !== null && episode.parts > 0);
  const reduced = episodes.filter((episode) => episode.series !== null && episode.buckets > 0);
  if (unlisted > 0)
    found.push(`${counted(unlisted, "better episode")} not listed`);
  if (without > 0) found.push(`${counted(without, "listed episode")} without timelines`);
  if (rounded.length > 0)
    found.push(`numbers of ${counted(rounded.length, "episode")} rounded to 1/` +
      `${d3.min(rounded, (episode) => episode.parts)} of their span, or finer`);
  if (reduced.length > 0)
    found.push(`${counted(reduced.length, "episode")} reduced to the least and greatest numbers ` +
      "of every few steps");
  if (found.length === 0) return "";
  return `To keep this page small: ${found.join("; ")}. Verdicts and truths are exact. ` +
    "etlc report --size sets its size.";
}

function showList() {
  const box = document.getElementById("list");
  const buttons = element("div", { class: "orders" });
  for (const [name, order] of Object.entries(orders)) {
    const button = element("button", { type: "button", title: order.help, "data-order": name },
      order.title);
    button.addEventListener("click", () => {
      list.order = name;
      for (const other of buttons.children) other.classList.toggle("chosen", other === button);
      drawList();
    });
    button.classList.toggle("chosen", name === list.order);
    buttons.append(button);
  }
  box.prepend(buttons);
  document.getElementById("filter").addEventListener("input", (event) => {
    list.filter = event.target.value.toLowerCase();
    drawList();
  });
  const rows = document.getElementById("rows");
  rows.addEventListener("scroll", () => {
    if (rows.scrollTop + rows.clientHeight > rows.scrollHeight - 200) drawMoreRows();
  });
  document.getElementById("left-out").textContent = leftOut();
  document.getElementById("workbench").classList.toggle("one", data.episodes === 1);
  drawList();
}
