// The timelines of an episode: one drawing, one time axis, a lane for each predicate and monitor.
// A lane has a chart, and strips below it: predictions, truths, and where they differ.

const laneSize = { title: 18, predicate: 64, monitor: 54, strip: 7, gap: 12 };
const laneMargin = { left: 62, right: 14 };

// Returns the runs of equal codes as [first, end, code].
function runsOf(codes) {
  const runs = [];
  for (let i = 0; i < codes.length; i++) {
    if (runs.length > 0 && runs[runs.length - 1][2] === codes[i]) runs[runs.length - 1][1] = i + 1;
    else runs.push([i, i + 1, codes[i]]);
  }
  return runs;
}

// Returns [step, value] pairs of a track; for a reduced one the least and greatest of each bucket.
function pointsOf(episode, series) {
  if (episode.buckets === 0) return Array.from(series[0], (value, step) => [step, value]);
  const points = [];
  const width = episode.steps / episode.buckets;
  for (let bucket = 0; bucket < episode.buckets; bucket++) {
    const step = Math.min((bucket + 0.5) * width, episode.steps - 1);
    points.push([step, series[0][bucket]], [step, series[1][bucket]]);
  }
  return points;
}

class Timelines {
  constructor(parent, episode, listeners) {
    this.parent = parent;
    this.episode = episode;
    this.listeners = listeners;
    this.first = episode.first ?? 0;  // the number of the first step
    this.domain = this.whole();
    this.lanes = this.makeLanes();
  }

  whole() { return [0, Math.max(this.episode.steps - 1, 1)]; }

  makeLanes() {
    const { tracks } = this.episode;
    const lanes = [];
    data.predicates.forEach((predicate, index) => {
      if (!tracks.distance?.[index]) return;
      lanes.push({ kind: "predicate", index, name: predicate.shown,
        text: `${predicate.expression} ${predicate.comparison} ${levelsText(predicate)}`,
        points: pointsOf(this.episode, tracks.distance[index]), levels: levelsOf(predicate),
        said: tracks.holds[index][0], truth: tracks.truth?.[index]?.[0] });
    });
    data.monitors.forEach((monitor, index) => {
      const codes = (of) => of?.[index]?.[0].map((code) => verdictCode(code, index));
      lanes.push({ kind: "monitor", index, name: monitor.name, text: monitor.formula, levels: [0],
        points: pointsOf(this.episode, tracks.robustness[index]), said: codes(tracks.status),
        bounds: monitor.sliding ? null : [tracks.lower, tracks.upper].map((of) =>
          pointsOf(this.episode, of?.[index] ?? tracks.robustness[index])),
        truth: codes(tracks.monitor_truth) });
    });
    return lanes;
  }

  draw() {
    this.parent.replaceChildren();
    const width = Math.max(this.parent.clientWidth, 320);
    const inner = width - laneMargin.left - laneMargin.right;
    let height = 4;
    for (const lane of this.lanes) {
      lane.top = height;
      lane.chart = laneSize[lane.kind];
      lane.strips = lane.truth ? 3 : 1;
      height += laneSize.title + lane.chart + lane.strips * (laneSize.strip + 2) + laneSize.gap;
    }
    this.height = height;
    this.x = scale(this.domain, [0, inner]);
    this.g = drawing(this.parent, width, height + 36,
      { left: laneMargin.left, top: 0 }).attr("class", "timelines");
    this.g.append("clipPath").attr("id", "lane-clip").append("rect").attr("width", inner)
      .attr("height", height);
    const hatch = this.g.append("pattern").attr("id", "unknown").attr("width", 4).attr("height", 4)
      .attr("patternUnits", "userSpaceOnUse").attr("patternTransform", "rotate(45)");
    hatch.append("rect").attr("width", 4).attr("height", 4);
    hatch.append("line").attr("y2", 4);
    for (const lane of this.lanes) this.drawLane(lane, inner);
    const seconds = data.spec.step_seconds;
    const shown = this.x.copy().domain(this.domain.map((step) =>
      (step + this.first) * (seconds > 0 ? seconds : 1)));
    xAxis(this.g, shown, height, seconds > 0 ? "time, s" : "step", 8);
    this.marks = this.g.append("g").attr("class", "marks").attr("clip-path", "url(#lane-clip)");
    this.cursor = this.g.append("g").attr("class", "cursor");
    this.cursor.append("line").attr("y1", 0).attr("y2", height);
    this.addInteraction(inner);
  }

  drawLane(lane, inner) {
    const g = this.g.append("g").attr("class", `lane ${lane.kind}`)
      .attr("data-lane", lane.name).attr("transform", `translate(0,${lane.top})`);
    const title = g.append("text").attr("class", "lane-title").attr("y", 13);
    title.append("tspan").attr("class", "name").text(lane.name);
    title.append("tspan").attr("class", "formula").attr("dx", 8).text(lane.text);
    const chart = g.append("g").attr("transform", `translate(0,${laneSize.title})`);
    lane.y = scale(spanOf([...lane.levels, ...lane.points.map((p) => p[1])]), [lane.chart, 0]);
    const inside = chart.append("g").attr("clip-path", "url(#lane-clip)");
    if (lane.kind === "predicate") this.drawBands(inside, lane);
    else this.drawBounds(inside, lane);
    drawLevels(inside, lane.levels, lane.y, [lane.chart, 0], inner);
    path(inside, lane.points, this.x, lane.y, "series");
    yAxis(chart, lane.y, "", 3);
    const below = g.append("g").attr("clip-path", "url(#lane-clip)");
    let at = laneSize.title + lane.chart + 2;
    const strip = (codes, kind, label) => {
      this.drawStrip(below, codes, at, kind);
      g.append("text").attr("class", "strip-label").attr("x", -6).attr("y", at + 6.5)
        .attr("text-anchor", "end").text(label);
      at += laneSize.strip + 2;
    };
    strip(lane.said, "said", "said");
    if (!lane.truth) return;
    strip(lane.truth, "truth", "true");
    const wrong = Array.from(lane.truth, (is, step) =>
      differs(lane.said[step], is) ? 1 : 0);
    strip(wrong, "wrong", "wrong");
  }

  rects(g, codes, wanted) {
    const runs = runsOf(codes).filter(([, , code]) => wanted(code));
    return g.selectAll(null).data(runs).enter().append("rect")
      .attr("x", ([first]) => this.x(first - 0.5))
      .attr("width", ([first, end]) => Math.max(this.x(end - 0.5) - this.x(first - 0.5), 1));
  }

  drawBands(g, lane) {
    this.rects(g.append("g"), lane.said, (code) => code === 1).attr("class", "band")
      .attr("y", 0).attr("height", lane.chart);
  }

  drawStrip(g, codes, top, kind) {
    this.rects(g.append("g"), codes, (code) => kind !== "wrong" || code === 1)
      .attr("class", ([, , code]) =>
        `strip ${kind} ${codeClass(code)}`)
      .attr("y", top).attr("height", laneSize.strip);
  }

  // Shades the area between the bounds of a prefix monitor's robustness, until they meet.
  drawBounds(g, lane) {
    if (lane.bounds) {
      const [lower, upper] = lane.bounds;
      const within = (y) => Math.max(0, Math.min(lane.chart, y));
      const end = (value, infinite) => (Number.isFinite(value) ? within(lane.y(value)) : infinite);
      const area = d3.svg.area().x((p) => this.x(p[0]))
        .y0((p, i) => end(p[1], lane.chart)).y1((p, i) => end(upper[i][1], 0))
        .defined((p) => !Number.isNaN(p[1]));
      g.append("path").attr("class", "bounds").attr("d", area(lower));
    }
    const final = lane.said.findIndex(isFinal);
    if (final < 0 || data.monitors[lane.index].sliding) return;
    g.append("line").attr("class", "final").attr("x1", this.x(final)).attr("x2", this.x(final))
      .attr("y2", lane.chart).append("title").text(`for good from ${when(final + this.first)} on`);
  }

  addInteraction(inner) {
    const brush = d3.svg.brush().x(this.x);
    const overlay = this.g.append("g").attr("class", "brush").call(brush);
    overlay.selectAll("rect").attr("height", this.height);
    brush.on("brushend", () => {
      const [from, to] = brush.extent();
      d3.select(overlay.node()).call(brush.clear());
      if ((to - from) * inner > 6 * (this.domain[1] - this.domain[0])) this.zoom([from, to]);
    });
    overlay.on("mousemove", () => {
      this.listeners.move(Math.round(this.x.invert(d3.mouse(overlay.node())[0])));
    });
    overlay.on("dblclick", () => this.zoom(this.whole()));
  }

  zoom(domain) {
    const [first, last] = this.whole();
    this.domain = [Math.max(domain[0], first), Math.min(domain[1], last)];
    this.draw();
    this.listeners.drawn();
  }

  // Zooms by a factor about a step.
  zoomAbout(step, factor) {
    const [from, to] = this.domain;
    const width = Math.max((to - from) * factor, 4);
    this.zoom([step - width / 2, step + width / 2]);
  }

  moveTo(step) {
    const x = this.x(step);
    const isSeen = step >= this.domain[0] && step <= this.domain[1];
    this.cursor.select("line").attr("x1", x).attr("x2", x)
      .classed("hidden", !isSeen);
  }

  // Marks the samples that explain a verdict, and the one whose robustness it has.
  mark(why) {
    this.marks.selectAll("*").remove();
    if (!why) return;
    const laneOf = (mark) => this.lanes.find((lane) =>
      lane.kind === "predicate" && lane.index === mark.predicate);
    for (const mark of why.samples) {
      const lane = laneOf(mark);
      if (!lane) continue;
      this.marks.append("rect").attr("class", "sample").attr("x", this.x(mark.first - 0.5))
        .attr("width", Math.max(this.x(mark.last + 0.5) - this.x(mark.first - 0.5), 2))
        .attr("y", lane.top + laneSize.title).attr("height", lane.chart)
        .append("title").text(`${why.status} depends on this`);
    }
    const lane = why.critical && laneOf(why.critical);
    if (!lane) return;
    const step = why.critical.first;
    const value = valueAt(this.episode, "distance", lane.index, step)[0];
    const y = lane.top + laneSize.title + (Number.isFinite(value) ? lane.y(value) : lane.chart / 2);
    this.marks.append("circle").attr("class", "critical").attr("r", 6).attr("cx", this.x(step))
      .attr("cy", y).append("title").text(`the critical sample, ${when(step)}`);
  }
}
