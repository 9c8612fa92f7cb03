// Keys, colours and the size of the window, which all pages treat alike.

function chooseTheme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  document.getElementById("theme").textContent = dark ? "Light" : "Dark";
}

const switchTheme = () => chooseTheme(document.documentElement.dataset.theme !== "dark");

function beginTheme() {
  chooseTheme(matchMedia("(prefers-color-scheme: dark)").matches);
  document.getElementById("theme").addEventListener("click", switchTheme);
}

// Calls the function that `keys` has for a key, unless somebody types into a field.
function listenTo(keys) {
  document.addEventListener("keydown", (event) => {
    if (event.target.tagName === "INPUT" || event.ctrlKey || event.altKey || event.metaKey) return;
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}

function onOtherWidth(draw) {
  let width = window.innerWidth;
  window.addEventListener("resize", () => {
    if (window.innerWidth === width) return;
    width = window.innerWidth;
    draw();
  });
}

// Scrolls the list, not the page.
function bringIntoSight(row) {
  const box = row.parentElement;
  const top = row.offsetTop;
  if (top < box.scrollTop) box.scrollTop = top;
  const bottom = top + row.offsetHeight;
  if (bottom > box.scrollTop + box.clientHeight) box.scrollTop = bottom - box.clientHeight;
}
