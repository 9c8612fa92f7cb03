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

function thresholdLine(g, x, height, threshold) {
  g.append("line").attr("class", "threshold").attr("x1", x(threshold)).attr("x2", x(threshold))
    .attr("y1", 0).attr("y2", height);
}

// Draws shares of each class, so that a rare class is visible beside a frequent one.
function drawHistogram(card, predicate) {
  const { edges, inside, outside } = predicate.distribution;
  const { g, width, height } = cardDrawing(card, "Distances of the frames labelled true and false");
  const x = scale(d3.extent([...edges, predicate.threshold]), [0, width]);
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
  thresholdLine(g, x, height, predicate.threshold);
  xAxis(g, x, height, predicate.expression);
  yAxis(g, y, "share of the frames", 4);
  const key = element("p", { class: "key" });
  for (const { name, all } of [parts[1], parts[0]])
    key.append(element("span", { class: `swatch ${name}` }),
      `${name === "inside" ? "true" : "false"}: ${counted(all, "frame")} `);
  key.append(element("span", { class: "swatch threshold" }),
    `threshold ${measured(predicate.threshold)}`);
  card.lastChild.append(key);
}

function drawCurve(card, title, points, operating, labels) {
  const { g, width, height } = cardDrawing(card, title);
  const x = scale([0, 1], [0, width]);
  const y = scale([0, 1], [height, 0]);
  xAxis(g, x, height, labels[0]);
  yAxis(g, y, labels[1]);
  path(g, points, x, y, "curve");
  if (operating)
    g.append("circle").attr("class", "operating").attr("r", 5).attr("cx", x(operating[0]))
      .attr("cy", y(operating[1]))
      .append("title").text("the threshold of the spec");
}

function drawScores(card, predicate) {
  const { ranks, scores, k, n } = predicate.scores;
  const { g, width, height } =
    cardDrawing(card, `Scores of the calibration: the threshold lies beyond rank ${k} of ${n}`);
  const shown = scores.map((score, i) => [score, ranks[i]]).filter((p) => Number.isFinite(p[0]));
  const sign = predicate.comparison.startsWith("<") ? 1 : -1;
  const x = scale(spanOf([...shown.map((p) => p[0]), sign * predicate.threshold]), [0, width]);
  const y = scale([0, n + 1], [height, 0]);
  xAxis(g, x, height, sign > 0 ? "score" : "score (the distance, negated)");
  yAxis(g, y, "rank");
  g.selectAll("circle").data(shown).enter().append("circle")
    .attr("class", (p) => (p[1] === k ? "score chosen" : "score")).attr("r", 2.5)
    .attr("cx", (p) => x(p[0])).attr("cy", (p) => y(p[1]));
  thresholdLine(g, x, height, sign * predicate.threshold);
}

function predicateCard(predicate) {
  const card = element("article", { class: "card", "data-predicate": predicate.shown },
    element("h3", {}, predicate.shown));
  const { distribution } = predicate;
  if (distribution) {
    drawHistogram(card, predicate);
    if (distribution.curve.length > 1) {
      const at = distribution.operating;
      const auroc = figures?.predicates[predicate.name]?.auroc;
      drawCurve(card, `ROC, area ${rate(auroc)}`, distribution.curve.map((p) => [p[0], p[1]]),
        at && [at[0], at[1]], ["false positive rate", "recall"]);
      drawCurve(card, "Precision and recall", distribution.curve.map((p) => [p[1], p[2]]),
        at && [at[1], at[2]], ["recall", "precision"]);
    }
  }
  if (predicate.scores) drawScores(card, predicate);
  return card;
}

function showPredicates() {
  const shown = data.predicates.filter((predicate) => predicate.distribution || predicate.scores);
  document.getElementById("predicates").hidden = shown.length === 0;
  fill("predicate-cards", ...shown.map(predicateCard));
}
