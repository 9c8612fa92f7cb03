// The top of the page: figures of `etlc evaluate`, its baselines, and the origins of thresholds.

function figureCell(of, key) {
  const interval = of[`${key}_interval`];
  const cell = element("td", { class: "number", "data-figure": key }, rate(of[key]));
  if (interval)
    cell.append(element("small", {}, ` ${rate(interval[0])}–${rate(interval[1])}`));
  return cell;
}

const baselineCell = (of, name, key) =>
  element("td", { class: "number blind", "data-figure": `${name}.${key}` }, rate(of[name]?.[key]));

function headRow(...titles) {
  const row = element("tr", {});
  for (const [title, help] of titles) row.append(element("th", { title: help }, title));
  return element("thead", {}, row);
}

const blindHeads = [
  ["always true", "F1 of always claiming true"],
  ["always false", "F1 of always claiming false"],
  ["duration", "F1 of a clock: true from one number of steps to another, and nothing else"],
];

function blindCells(of, key) {
  return ["always_true", "always_false", "duration"].map((name) => baselineCell(of, name, key));
}

// Columns for what is unknown, where anything is.
const unknownHeads = [["unknown", "share of the frames or steps at which it is neither"],
  ["wrong when decided", "share of the others at which it is wrong"]];
const unknownCells = (of) =>
  [figureCell(of, "unknown"), figureCell(of, "wrong_when_decided")];
const anyUnknown = (all) => all.some((of) => of.unknown > 0);

function predicateTable() {
  const all = Object.entries(figures.predicates);
  const isUnknown = anyUnknown(all.map(([, of]) => of));
  const body = element("tbody", {});
  for (const [name, of] of all)
    body.append(element("tr", { "data-predicate": name }, element("th", {}, name),
      figureCell(of, "f1"), figureCell(of, "precision"), figureCell(of, "recall"),
      figureCell(of, "auroc"), ...blindCells(of, "f1"),
      ...(isUnknown ? unknownCells(of) : []),
      element("td", { class: "number" }, counted(of.positives, "frame"))));
  return element("table", {}, headRow(["", ""], ["F1", "by frames, with its 95 % interval"],
    ["precision", "share of its claims that are true"],
    ["recall", "share of the true cases that it claims"],
    ["AUROC", "how well the distance separates the frames, at any threshold"],
    ...blindHeads, ...(isUnknown ? unknownHeads : []),
    ["labelled true", "frames at which the truth holds"]), body);
}

function delayText(detection) {
  if (detection.turns === 0) return "–";
  const mean = detection.mean_seconds ?? detection.mean_steps;
  const unit = detection.mean_seconds === undefined ? "steps" : "s";
  const missed = detection.missed > 0 ? `, ${detection.missed} missed` : "";
  if (mean === null) return `${detection.missed} missed`;
  return `${Number(mean.toPrecision(3))} ${unit}${missed}`;
}

function monitorTable() {
  const isUnknown = anyUnknown(Object.values(figures?.monitors ?? {})
    .filter((of) => of.evaluable).map((of) => of.steps));
  // By outcome alone nothing is known of single verdicts.
  const isJudged = Object.values(figures?.monitors ?? {}).some((of) => of.evaluable || !of.outcomes);
  const body = element("tbody", {});
  for (const monitor of data.monitors) {
    const of = figures?.monitors[monitor.name];
    const row = element("tr", { "data-monitor": monitor.name },
      element("th", {}, monitor.name),
      element("td", { class: "formula" }, ...unbroken(monitor.formula)));
    body.append(row);
    if (!isJudged) continue;
    if (!of.evaluable) {
      row.append(element("td", { colspan: isUnknown ? 9 : 7 }, of.outcomes ? "by outcome, below"
        : `no labels for ${of.without_truth.join(", ")}: not evaluated`));
      continue;
    }
    row.append(figureCell(of, "episode_agreement"), figureCell(of, "step_agreement"),
      figureCell(of.episodes, "f1"), ...blindCells(of.episodes, "f1"),
      ...(isUnknown ? unknownCells(of.steps) : []),
      element("td", { class: "number" }, delayText(of.detection)));
  }
  const heads = [["", ""], ["formula", ""]];
  if (isJudged)
    heads.push(["episodes right", "share of the episodes whose last verdict is correct"],
      ["steps right", "share of the steps whose verdict is correct"],
      ["F1", "by episodes, with its 95 % interval"],
      ...blindHeads, ...(isUnknown ? unknownHeads : []),
      ["delay", "mean time from the true change to the monitor's"]);
  return element("table", {}, headRow(...heads), body);
}

const warningText = ({ warning_median_steps: steps }) => steps === null ? "–"
  : data.spec.step_seconds > 0 ? `${Number((steps * data.spec.step_seconds).toPrecision(3))} s`
  : counted(steps, "step");

// The monitors as detectors of failures, above three rules that read no sample.
function outcomeTable() {
  const all = Object.entries(figures.monitors).filter(([, of]) => of.outcomes);
  if (all.length === 0) return [];
  const rates = ["false_alarm_rate", "detection_rate", "balanced_accuracy"];
  const body = element("tbody", {});
  for (const [name, { outcomes }] of all)
    body.append(element("tr", { "data-outcomes": name }, element("th", {}, name),
      ...rates.map((key) => figureCell(outcomes, key)), figureCell(outcomes, "auroc"),
      element("td", { class: "number" }, warningText(outcomes))));
  const { successes, failures, ...first } = all[0][1].outcomes;
  for (const rule of ["always", "never", "duration"])
    body.append(element("tr", { class: "blind" }, element("th", {}, rule),
      ...rates.map((key) => element("td", { class: "number" }, rate(first[`${rule}_${key}`])))));
  return [element("h2", {}, `${counted(failures, "failure")} among ` +
    counted(successes + failures, "episode")), element("table", {}, headRow(["", ""],
    ["false alarms", "share of the successes with an alarm, with its 95 % interval"],
    ["detected", "share of the failures with an alarm"],
    ["balanced accuracy", "mean of the share detected and of the share without a false alarm"],
    ["AUROC", "how well the least upper bound separates failures from successes"],
    ["warning", "median time from the alarm to the failure or the end"]), body)];
}

function provenanceTable() {
  const body = element("tbody", {});
  const add = (name, formula, text) => body.append(element("tr", {}, element("th", {}, name),
    element("td", { class: "formula" }, ...unbroken(formula)), element("td", {}, text)));
  const addUnknown = (name, place) => {
    if (data.unknown[place] > 0)
      add(name, "unknown", `at ${unknownShare(place)} of the steps of these episodes`);
  };
  data.predicates.forEach((predicate, place) => {
    add(predicate.shown, `${predicate.expression} ${predicate.comparison} ${levelsText(predicate)}`,
      predicate.provenance);
    addUnknown(predicate.shown, place);
  });
  data.monitors.forEach((monitor, index) => {
    if (monitor.calibrated) add(monitor.name, "calibrated", monitor.calibrated);
    for (const guarantee of monitor.guarantees) add(monitor.name, "guarantee", guarantee);
    addUnknown(monitor.name, data.predicates.length + index);
  });
  return element("table", {}, body);
}

function remarks() {
  const found = [`${counted(data.episodes, "episode")}, ${counted(data.steps, "step")}.`];
  if (!data.has_truth) found.push(`Without truths: ${data.why_no_truth}.`);
  for (const input of data.inputs) {
    const missing = input.missing + input.out_of_range + input.stale;
    if (missing > 0)
      found.push(`${input.name}: ${counted(missing, "sample")} missing` +
        (input.stale > 0 ? `, ${input.stale} of them stale` : "") +
        (input.held > 0 ? `, ${input.held} held.` : "."));
  }
  if (data.inputs.every((input) => input.missing + input.out_of_range + input.stale === 0))
    found.push("No sample is missing.");
  found.push(...(figures?.reservations ?? []));
  return found.join(" ");
}

function showFigures() {
  document.title = `${data.spec.name}: etlc report`;
  document.getElementById("title").textContent = data.spec.name;
  document.getElementById("subtitle").textContent = data.spec.path;
  document.getElementById("spec").textContent = data.spec.text;
  document.getElementById("remarks").textContent = remarks();
  fill("monitor-figures", monitorTable());
  if (figures) {
    const isLabelled = Object.keys(figures.predicates).length > 0;
    fill("predicate-figures", ...outcomeTable(),
      ...(isLabelled ? [element("h2", {}, "Predicates"), predicateTable()] : []));
  }
  fill("provenance", element("h2", {}, "Thresholds and guarantees"), provenanceTable());
}
