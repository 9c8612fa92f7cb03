// The keys and the start of the page.

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
  d: switchTheme,
};

function begin() {
  beginTheme();
  showFigures();
  showPredicates();
  showList();
  listenTo(keys);
  onOtherWidth(() => view.timelines?.zoom(view.timelines.domain));
  if (list.shown.length > 0) selectEpisode(list.shown[0]);
}

begin();
