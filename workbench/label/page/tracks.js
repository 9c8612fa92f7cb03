// The predicates of an episode as tracks on the timelines of the report: a lane with the labels,
// and below it a grey strip with what is proposed.

laneSize.label = 24;

const codesOf = (intervals, steps) => {
  const codes = new Uint8Array(steps);
  for (const [start, end, code] of intervals) codes.fill(code, start, end);
  return codes;
};

const stripWords = ["violated", "satisfied", "unknown"];

class LabelTracks extends Timelines {
  makeLanes() {
    const { steps, marks, recorded, proposed } = this.episode;
    return data.predicates.map((name, index) => ({
      kind: "label", index, name,
      labels: marks[index] && codesOf(marks[index], steps),
      text: recorded[index] ? "labelled in the recording"
        : !marks[index] ? "not labelled"
        : marks[index].length === 0 ? "never true" : "",
      said: proposed[index] && codesOf(proposed[index], steps),
    }));
  }

  drawLane(lane, inner) {
    const isChosen = lane.index === this.episode.predicate;
    const g = this.g.append("g").attr("class", `lane label${isChosen ? " chosen" : ""}`)
      .attr("data-lane", lane.name).attr("transform", `translate(0,${lane.top})`);
    const title = g.append("text").attr("class", "lane-title").attr("y", 13);
    title.append("tspan").attr("class", "name").text(`${lane.index + 1}  ${lane.name}`);
    title.append("tspan").attr("class", "formula").attr("dx", 8).text(lane.text);
    g.append("rect").attr("class", "ground").attr("y", laneSize.title).attr("width", inner)
      .attr("height", lane.chart);
    const below = g.append("g").attr("clip-path", "url(#lane-clip)");
    const draw = (codes, kind, top, height) => this.rects(below.append("g"), codes, () => true)
      .attr("class", ([, , code]) => `strip ${kind} ${stripWords[code]}`)
      .attr("y", top).attr("height", height);
    if (lane.labels) draw(lane.labels, "truth", laneSize.title, lane.chart);
    if (!lane.said) return;
    const top = laneSize.title + lane.chart + 2;
    draw(lane.said, "proposed", top, laneSize.strip);
    g.append("text").attr("class", "strip-label").attr("x", -6).attr("y", top + 6.5)
      .attr("text-anchor", "end").text("proposed");
  }
}
