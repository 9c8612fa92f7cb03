// Shared by all charts: a drawing with margins, axes, and a line through points.

// A drawing of `width` x `height` pixels whose origin is at the margins.
function drawing(parent, width, height, margin) {
  const svg = d3.select(parent).append("svg")
    .attr("width", width).attr("height", height).attr("viewBox", `0 0 ${width} ${height}`);
  return svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
}

const scale = (domain, range) => d3.scale.linear().domain(domain).range(range);

function xAxis(g, x, height, label, ticks = 5) {
  g.append("g").attr("class", "axis").attr("transform", `translate(0,${height})`)
    .call(d3.svg.axis().scale(x).orient("bottom").ticks(ticks).tickSize(4));
  if (label)
    g.append("text").attr("class", "label").attr("x", (x.range()[0] + x.range()[1]) / 2)
      .attr("y", height + 30).attr("text-anchor", "middle").text(label);
}

function yAxis(g, y, label, ticks = 4) {
  g.append("g").attr("class", "axis")
    .call(d3.svg.axis().scale(y).orient("left").ticks(ticks).tickSize(4));
  if (label)
    g.append("text").attr("class", "label").attr("transform", "rotate(-90)")
      .attr("x", -(y.range()[0] + y.range()[1]) / 2).attr("y", -38)
      .attr("text-anchor", "middle").text(label);
}

// Draws one or two thresholds across a chart, and shades what is between them. `ends` are those of
// the axis, where an infinite threshold lies; `across` is how far the lines go, along x or y.
function drawLevels(g, levels, at, ends, across, along = "x") {
  const [to, size] = along === "x" ? ["y", "height"] : ["x", "width"];
  const places = levels.map((level) =>
    (Number.isFinite(level) ? at(level) : ends[level > 0 ? 1 : 0]));
  if (places.length > 1)
    g.append("rect").attr("class", "between").attr(along === "x" ? "width" : "height", across)
      .attr(to, Math.min(...places)).attr(size, Math.abs(places[1] - places[0]));
  levels.filter(Number.isFinite).forEach((level) =>
    g.append("line").attr("class", "threshold").attr(`${along}2`, across)
      .attr(`${to}1`, at(level)).attr(`${to}2`, at(level)));
}

// Draws a line through [x, y] pairs of data, with gaps where y is not finite.
function path(g, points, x, y, name) {
  const line = d3.svg.line().x((p) => x(p[0])).y((p) => y(p[1]))
    .defined((p) => Number.isFinite(p[1]));
  return g.append("path").attr("class", name).attr("d", line(points));
}

// Returns the span of the finite values, widened so that no line lies on an edge.
function spanOf(values) {
  const finite = values.filter(Number.isFinite);
  let [low, high] = finite.length > 0 ? d3.extent(finite) : [0, 1];
  if (low === high) [low, high] = [low - 0.5, high + 0.5];
  const room = (high - low) * 0.06;
  return [low - room, high + room];
}
