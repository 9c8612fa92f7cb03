// Keys, colours, and the start of the page.

const keys = {
  ArrowLeft: (event) => moveCursor(view.step - (event.shiftKey ? 10 : 1)),
  ArrowRight: (event) => moveCursor(view.step + (event.shiftKey ? 10 : 1)),
  Home: () => moveCursor(0),
  End: () => moveCursor(Infinity),
  ArrowUp: () => neighbour(-1),
  ArrowDown: () => neighbour(1),
  k: () => neighbour(-1),
  j: () => neighbour(1),
  "+": () => view.timelines?.zoomAbout(view.step, 0.5),
  "-": () => view.timelines?.zoomAbout(view.step, 2),
  0: () => view.timelines?.zoom(view.timelines.whole()),
  d: () => chooseTheme(document.documentElement.dataset.theme !== "dark"),
};

function chooseTheme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  document.getElementById("theme").textContent = dark ? "Light" : "Dark";
}

function listenToKeys() {
  document.addEventListener("keydown", (event) => {
    if (event.target.tagName === "INPUT" || event.ctrlKey || event.altKey || event.metaKey) return;
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}

function begin() {
  chooseTheme(matchMedia("(prefers-color-scheme: dark)").matches);
  document.getElementById("theme").addEventListener("click", (event) => keys.d(event));
  showFigures();
  showPredicates();
  showList();
  listenToKeys();
  let width = window.innerWidth;
  window.addEventListener("resize", () => {
    if (window.innerWidth === width || !view.timelines) return;
    width = window.innerWidth;
    view.timelines.zoom(view.timelines.domain);
  });
  if (list.shown.length > 0) selectEpisode(list.shown[0]);
}

begin();
