// The camera picture at the cursor, or the last one before it, and the nearest row of each
// target that is made of pictures.

let sheet = null;  // the pictures of the episode, one below the other; null: they are files

function showPictures() {
  const { row } = view;
  const { pictures } = row;
  sheet = null;
  fill("pictures");
  fill("nearest");
  if (!pictures) return;
  const caption = element("figcaption", { id: "picture-step" });
  if (pictures.width === 0) {
    fill("pictures", element("figure", {}, element("img", { id: "frame", alt: "" }), caption));
    return;
  }
  const canvas = element("canvas",
    { id: "frame", width: pictures.width, height: pictures.height });
  fill("pictures", element("figure", {}, canvas, caption));
  const image = new Image();
  image.addEventListener("load", () => {
    if (list.selected !== row) return;  // another episode was chosen meanwhile
    sheet = image;
    movePictures();
  });
  image.src = pictures.files[0];
}

// Shows one for each predicate that measures from such a target.
function showNearest() {
  fill("nearest", ...data.predicates.map((predicate, index) => {
    const [row] = valueAt(view.episode, "nearest", index, view.step);
    const address = data.target_pictures[predicate.target]?.[row];
    if (!address) return null;
    const name = `nearest of ${predicate.target}: row ${row}`;
    return element("figure", { "data-predicate": predicate.shown, "data-row": row },
      element("img", { src: address, alt: name }), element("figcaption", {}, name));
  }).filter((figure) => figure !== null));
}

function movePictures() {
  showNearest();
  const { pictures } = view.row;
  if (!pictures) return;
  const at = Math.max(d3.bisectRight(pictures.steps, view.step) - 1, 0);
  const step = pictures.steps[at];
  const frame = document.getElementById("frame");
  frame.dataset.step = step;
  document.getElementById("picture-step").textContent = `the camera at ${when(step)}`;
  if (pictures.width === 0) {
    frame.src = pictures.files[at];
    frame.alt = `camera, ${when(step)}`;
  } else if (sheet) {
    const { width, height } = pictures;
    frame.getContext("2d").drawImage(sheet, 0, at * height, width, height, 0, 0, width, height);
  }
}
