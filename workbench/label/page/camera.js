// The camera's frame at the cursor: the exact one, or the last one that has arrived.

const camera = { busy: false, wanted: "" };

function showPictures() {
  if (!data.episodes[view.episode].frames) {
    fill("pictures");
    return;
  }
  if (document.getElementById("frame")) return;
  fill("pictures", element("figure", {}, element("canvas", { id: "frame" }),
    element("figcaption", { id: "picture-step" })));
}

async function drawFrame(place) {
  const answer = await fetch(`frame/${place}`);
  if (!answer.ok) throw new Error(await answer.text());
  const image = await createImageBitmap(await answer.blob());
  const canvas = document.getElementById("frame");
  if (!canvas) return;
  canvas.width = image.width;
  canvas.height = image.height;
  canvas.getContext("2d").drawImage(image, 0, 0);
}

// Draws the frame that is wanted last; those in between are left out where they come too slowly.
async function moveCamera() {
  camera.wanted = `${view.episode}/${view.step}`;
  if (camera.busy || !document.getElementById("frame")) return;
  camera.busy = true;
  let place = "";
  while (place !== camera.wanted) {
    place = camera.wanted;
    let caption = `the camera at ${when(Number(place.split("/")[1]))}`;
    try {
      await drawFrame(place);
    } catch (error) {
      caption = `No frame: ${error.message}`;
    }
    const canvas = document.getElementById("frame");
    if (!canvas) break;
    canvas.dataset.place = place;
    document.getElementById("picture-step").textContent = caption;
  }
  camera.busy = false;
}
