// The camera's frame at the cursor: the exact one, or the last one that has arrived.

const camera = { busy: false, wanted: "" };

function showPictures() {
  if (!data.episodes[view.episode].frames) {
    fill("pictures");
    return;
  }
  if (document.getElementById("frame")) {
    drawFrame(null, "…");  // not that of the episode before
    return;
  }
  fill("pictures", element("figure", {}, element("canvas", { id: "frame" }),
    element("figcaption", { id: "picture-step" })));
}

function drawFrame(image, caption) {
  const canvas = document.getElementById("frame");
  document.getElementById("picture-step").textContent = caption;
  if (image) Object.assign(canvas, { width: image.width, height: image.height });
  const pen = canvas.getContext("2d");
  if (image) pen.drawImage(image, 0, 0);
  else pen.clearRect(0, 0, canvas.width, canvas.height);
}

async function fetchFrame(place) {
  const answer = await fetch(`frame/${place}`);
  if (!answer.ok) throw new Error(await answer.text());
  return createImageBitmap(await answer.blob());
}

// Draws the frame that is wanted last; those in between are left out where they come too slowly,
// and so is one of an episode that is no longer shown.
async function moveCamera() {
  camera.wanted = `${view.episode}/${view.step}`;
  if (camera.busy || !document.getElementById("frame")) return;
  camera.busy = true;
  let place = "";
  while (place !== camera.wanted) {
    place = camera.wanted;
    const [episode, step] = place.split("/").map(Number);
    let image = null;
    let caption = `the camera at ${when(step)}`;
    try {
      image = await fetchFrame(place);
    } catch (error) {
      caption = `No frame: ${error.message}`;
    }
    const canvas = document.getElementById("frame");
    if (!canvas) break;
    if (episode !== view.episode) continue;
    drawFrame(image, caption);
    canvas.dataset.place = place;
  }
  camera.busy = false;
}
