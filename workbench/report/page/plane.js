// The episode's path through an embedding, coloured by time, and the targets, in the plane of
// the first two principal components.

const planeSize = { width: 290, height: 240 };
const planeMargin = { left: 34, right: 8, top: 8, bottom: 34 };

const timeColours = d3.scale.linear().domain([0, 0.5, 1])
  .range(["#46327e", "#1f9e89", "#fde725"]).interpolate(d3.interpolateHcl);

let planeDots = [];

function planePoints(index) {
  const { x, y } = view.episode.tracks;
  return Array.from(x[index][0], (value, i) => [value, y[index][0][i]]);
}

function planeTitle(plane) {
  if (plane.dimension === 2) return plane.point;
  const parts = plane.explained.map((part) => `${Math.round(part * 100)} %`).join(" and ");
  const of = plane.by_direction ? "directions of " : "";
  return `${of}${plane.point}: principal components with ${parts} of the variance`;
}

function drawPlane(plane, index) {
  const figure = element("figure", { class: "plane" },
    element("figcaption", {}, planeTitle(plane)));
  const points = planePoints(index);
  const known = points.filter((p) => Number.isFinite(p[0]));
  const rows = plane.targets.flatMap((target) => target.rows);
  const width = planeSize.width - planeMargin.left - planeMargin.right;
  const height = planeSize.height - planeMargin.top - planeMargin.bottom;
  const x = scale(spanOf([...known.map((p) => p[0]), ...rows.map((r) => r[1])]), [0, width]);
  const y = scale(spanOf([...known.map((p) => p[1]), ...rows.map((r) => r[2])]), [height, 0]);
  const g = drawing(figure, planeSize.width, planeSize.height, planeMargin);
  xAxis(g, x, height, "", 4);
  yAxis(g, y, "", 4);
  path(g, points, x, y, "way");
  g.append("g").selectAll("circle").data(points).enter().append("circle").attr("class", "time")
    .filter((p) => Number.isFinite(p[0])).attr("r", 2.2)
    .attr("cx", (p) => x(p[0])).attr("cy", (p) => y(p[1]))
    .attr("fill", (p) => timeColours(points.indexOf(p) / points.length));
  plane.targets.forEach((target, number) => {
    const shape = d3.svg.symbol().size(44).type(d3.svg.symbolTypes[(number + 2) % 6]);
    g.append("g").selectAll("path").data(target.rows).enter().append("path")
      .attr("class", `target target-${number % 4}`).attr("d", shape)
      .attr("transform", (r) => `translate(${x(r[1])},${y(r[2])})`)
      .append("title").text((r) => `${target.name}, row ${r[0]}`);
  });
  const key = element("p", { class: "key" });
  plane.targets.forEach((target, number) => key.append(
    element("span", { class: `swatch target-${number % 4}` }), `${target.name} `));
  figure.append(key);
  const dot = g.append("circle").attr("class", "here").attr("r", 5);
  planeDots.push({ dot, points, x, y });
  return figure;
}

function showPlanes() {
  planeDots = [];
  fill("planes", ...data.planes.map(drawPlane));
}

function movePlanes() {
  for (const { dot, points, x, y } of planeDots) {
    const point = points[placeOf(view.episode, points.length, view.step)];
    const isKnown = Number.isFinite(point[0]);
    dot.classed("hidden", !isKnown);
    if (isKnown) dot.attr("cx", x(point[0])).attr("cy", y(point[1]));
  }
}
