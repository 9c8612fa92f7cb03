// A card for each predicate: distances inside and outside, curves over all thresholds, and the
// scores behind a calibrated threshold.

const cardSize = { width: 340, height: 210 };
const cardMargin = { left: 52, right: 12, top: 10, bottom: 40 };

function cardDrawing(card, title) {
  const figure = element("figure", {}, element("figcaption", {}, title));
  card.append(figure);
  const g = drawing(figure, cardSize.width, cardSize.height, cardMargin);
  return {
    g,
    width: cardSize.width - cardMargin.left - cardMargin.right,
    height: cardSize.height - cardMargin.top - cardMargin.bottom,
  };
}

const drawThresholds = (g, levels, x, height) =>
  drawLevels(g, levels, x, x.range(), height, "y");

const unknownShare = (place) => percent(data.unknown[place] / data.steps);

// Draws shares of each class, so that a rare class is visible beside a frequent one.
function drawHistogram(card, predicate) {
  const { edges, inside, outside } = predicate.distribution;
  const { g, width, height } = cardDrawing(card, "Distances of the frames labelled true and false");
  const levels = levelsOf(predicate);
  const x = scale(d3.extent([...edges, ...levels.filter(Number.isFinite)]), [0, width]);
  const parts = [["outside", outside], ["inside", inside]].map(([name, counts]) => {
    const all = d3.sum(counts);
    return { name, all, parts: counts.map((count) => (all > 0 ? count / all : 0)) };
  });
  const y = scale([0, d3.max(parts, (of) => d3.max(of.parts)) || 1], [height, 0]);
  for (const { name, parts: heights } of parts) {
    const corners = heights.flatMap((part, i) => [[edges[i], part], [edges[i + 1], part]]);
    const area = d3.svg.area().x((p) => x(p[0])).y0(height).y1((p) => y(p[1]));
    g.append("path").attr("class", `histogram ${name}`).attr("d", area(corners));
  }
  drawThresholds(g, levels, x, height);
  xAxis(g, x, height, predicate.expression);
  yAxis(g, y, "share of the frames", 4);
  const key = element("p", { class: "key" });
  const addKey = (name, text) => key.append(element("span", { class: "whole" },
    element("span", { class: `swatch ${name}` }), text), " ");
  for (const { name, all } of [parts[1], parts[0]])
    addKey(name, `${name === "inside" ? "true" : "false"}: ${counted(all, "frame")}`);
  addKey("threshold",
    `threshold ${levelsText(predicate)}` + (levels.length > 1 ? ", unknown between" : ""));
  const place = data.predicates.indexOf(predicate);
  if (data.unknown[place] > 0)
    addKey("unknown", `unknown at ${unknownShare(place)} of the steps`);
  card.lastChild.append(key);
}

function drawCurve(card, title, points, operating, labels) {
  const { g, width, height } = cardDrawing(card, title);
  const x = scale([0, 1], [0, width]);
  const y = scale([0, 1], [height, 0]);
  xAxis(g, x, height, labels[0]);
  yAxis(g, y, labels[1]);
  path(g, points, x, y, "curve");
  for (const [level, at] of operating)
    g.append("circle").attr("class", "operating").attr("r", 5).attr("cx", x(at[0]))
      .attr("cy", y(at[1]))
      .append("title").text(`the threshold of the spec, ${measured(level)}`);
}

function drawScores(card, predicate, { scores, k, n }, against) {
  const { g, width, height } = cardDrawing(card, `Scores of the calibration${against}: ` +
    (k > n ? `${n} are too few for a threshold` : `rank ${k} of ${n}`));
  const shown = scores.filter((p) => Number.isFinite(p[0]));
  const levels = levelsOf(predicate);
  const x = scale(spanOf([...shown.map((p) => p[0]), ...levels]), [0, width]);
  const y = scale([0, n + 1], [height, 0]);
  xAxis(g, x, height, predicate.expression);
  yAxis(g, y, "rank");
  g.selectAll("circle").data(shown).enter().append("circle")
    .attr("class", (p) => (p[1] === k ? "score chosen" : "score")).attr("r", 2.5)
    .attr("cx", (p) => x(p[0])).attr("cy", (p) => y(p[1]));
  drawThresholds(g, levels, x, height);
}

function predicateCard(predicate) {
  const card = element("article", { class: "card", "data-predicate": predicate.shown },
    element("h3", {}, predicate.shown));
  const { distribution } = predicate;
  if (distribution) {
    drawHistogram(card, predicate);
    if (distribution.curve.length > 1) {
      const levels = levelsOf(predicate);
      const at = distribution.operating.map((point, i) => [levels[i], point]);
      const auroc = figures?.predicates[predicate.name]?.auroc;
      drawCurve(card, `ROC, area ${rate(auroc)}`, distribution.curve.map((p) => [p[0], p[1]]),
        at.map(([level, p]) => [level, [p[0], p[1]]]), ["false positive rate", "recall"]);
      drawCurve(card, "Precision and recall", distribution.curve.map((p) => [p[1], p[2]]),
        at.map(([level, p]) => [level, [p[1], p[2]]]), ["recall", "precision"]);
    }
  }
  const against = predicate.scores.length > 1
    ? [" against misses", " against false positives"] : [""];
  predicate.scores.forEach((side, i) => drawScores(card, predicate, side, against[i]));
  return card;
}

function showPredicates() {
  const shown = [
    ...data.predicates.filter((predicate) => predicate.distribution || predicate.scores.length > 0),
    ...data.monitors.map((monitor) => monitor.duration).filter((duration) => duration),
  ];
  document.getElementById("predicates").hidden = shown.length === 0;
  fill("predicate-cards", ...shown.map(predicateCard));
}
