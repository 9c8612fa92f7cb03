// Words and elements that all parts of the page use. Text from the data is only ever set as text.

const data = JSON.parse(document.getElementById("report").textContent);
const figures = JSON.parse(document.getElementById("figures").textContent);

const statusWords = ["violated", "satisfied", "unknown", "undecided"];
const isFinal = (code) => code >= 4;
const statusOf = (code) => code % 4;

// Returns what a verdict is called: one that may still change is "not yet" or "so far".
const verdictWord = (code) =>
  (isFinal(code) ? statusWords : ["not yet", "so far", "unknown", "undecided"])[statusOf(code)];
// Returns the code of a monitor's verdict: that of a sliding one about a position never changes.
const verdictCode = (code, monitor) =>
  code + (data.monitors[monitor].sliding && code < statusWords.indexOf("undecided") ? 4 : 0);

// Whether what is said is wrong; unknown is not.
const differs = (said, is) => statusOf(is) <= 1 && statusOf(said) === 1 - statusOf(is);
// Returns the classes of a verdict, or of what a predicate is called.
const codeClass = (code) => statusWords[statusOf(code)] + (isFinal(code) ? " final" : "");

function saidCell(code, kind) {
  const words = ["no", "yes", "unknown", "undecided"];
  return element("td", { class: `said ${kind} ${codeClass(code)}` },
    kind === "monitor" ? verdictWord(code) : words[statusOf(code)]);
}

// element("td", {class: "number"}, "0.5", child, ...)
function element(name, attributes, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes ?? {})) made.setAttribute(key, value);
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

function fill(id, ...children) {
  document.getElementById(id).replaceChildren(...children);
}

// Returns the children of an element that shows a formula: no line breaks inside "[0, 8 s]" or
// between a number and its unit.
function unbroken(text) {
  const children = [];
  let at = 0;
  for (const match of text.matchAll(/\[[^[\]]{1,30}\]|[\d.]+ (?:us|ms|s|min|h|steps?)\b/g)) {
    children.push(text.slice(at, match.index), element("span", { class: "whole" }, match[0]));
    at = match.index + match[0].length;
  }
  return [...children, text.slice(at)];
}

// Formats a figure as etlc's tables do: "0.950".
const rate = (value) => (value === null || value === undefined ? "–" : value.toFixed(3));

function measured(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "missing";
  if (value === Infinity) return "∞";
  if (value === -Infinity) return "−∞";
  return String(Number(value.toPrecision(5))).replace("-", "−");
}

// The one or two thresholds of a predicate, ascending; JSON has no infinities.
const levelsOf = (predicate) => predicate.thresholds.map(Number);
const levelsText = (predicate) => levelsOf(predicate).map(measured).join(" to ");

const percent = (share) => `${(100 * share).toFixed(1)} %`;

const counted = (n, noun) => `${n.toLocaleString("en")} ${noun}${n === 1 ? "" : "s"}`;

function when(step) {
  const seconds = data.spec.step_seconds;
  return seconds > 0 ? `step ${step} (${Number((step * seconds).toPrecision(6))} s)`
    : `step ${step}`;
}

const baseName = (path) => path.slice(path.lastIndexOf("/") + 1);
